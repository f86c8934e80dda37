"""`Solved`: contact of a section at some phases, for elastic gears and for plain sums of tooth pairs."""

from dataclasses import dataclass

import numpy as np

MARKS = ("crack_closed_phases", "tip_in_fillet_phases")  # entries of a curve's `meta` that list single phases


@dataclass(frozen=True, slots=True)
class Solved:
    """Contact at some phases, per unit width.

    `geometry.pair.contacts.Contacts` describes `order` (pairs,). `closing` (phases,) is the approach by the load beyond the first
    touch [mm], `tangent` (phases,) the tangent stiffness [N/mm per mm]. `line_load` (phases, pairs) is in N/mm, `pressure`
    (phases, pairs) in MPa (nan in corner contact, where it is unbounded). `closed` are the phases at which crack faces touch and
    are kept from passing through each other, `fillet` those at which a tip is in its mate's fillet. `unloaded` (phases,) is the
    approach at which the first pair touches [mm], None if it is zero everywhere. `supports` (phases,) is the deflection of the
    supports of the hubs [mm], None for rigid ones. `left_out` (phases,) is the model error of `closing`, without the
    discretisation error.

    Light loads close a millionth of the distances between modified flanks. Therefore `closing` is solved for directly, and never
    is a difference of approaches.
    """

    order: np.ndarray
    closing: np.ndarray
    tangent: np.ndarray
    line_load: np.ndarray
    pressure: np.ndarray
    closed: tuple = ()
    fillet: tuple = ()
    unloaded: np.ndarray | None = None
    supports: np.ndarray | None = None
    left_out: np.ndarray | None = None

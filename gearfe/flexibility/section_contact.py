"""`Solved`: what a section's contact gives at some phases, whether gears share the load or a plain sum of pairs does."""

from dataclasses import dataclass

import numpy as np

MARKS = ("crack_closed_phases", "tip_in_fillet_phases")  # what a curve's `meta` says of single phases


@dataclass(frozen=True, slots=True)
class Solved:
    """Contact at some phases, per unit width.

    `order` (pairs,) as in `geometry.pair.contacts.Contacts`, `closing` (phases,) how far the load moves the gears beyond the
    first touch [mm], `tangent` (phases,) [N/mm per mm], `line_load` (phases, pairs) [N/mm], `pressure` (phases, pairs) [MPa] (nan
    in corner contact, where it is unbounded), `closed` the phases at which crack faces touch and were kept from passing through
    each other, `fillet` those at which a tip presses into its mate's fillet, `unloaded` (phases,) the approach at which the first
    pair touches [mm], None if it is zero everywhere, `supports` (phases,) what the supports of the hubs give way [mm], None of
    rigid ones, `left_out` (phases,) the part of `closing` that the model of contact may be off by, besides its discretisation.

    Light loads close by a millionth of what modified flanks lie apart: `closing` is solved for, never a difference of approaches.
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

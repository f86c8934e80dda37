"""`contact_pattern`: where and how hard the flanks of a pair press over the mesh cycle."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from geometry.damage.kinds import Damage
from geometry.pair.flanks import Misalignment, flank_forms
from geometry.pair.gear_pair import GearPair
from geometry.tooth.modified import Flank

from ..contact.solid import Contact3D, pair_stiffness3d
from ..material import Material
from ..supports.shaft import Shaft
from ..supports.support import Support
from ..threads import single
from .inputs import by_gear, forces_of, overlap, phase_array, two_materials
from .supported import check_integral, supports_of


@single
def contact_pattern(
    pair: GearPair,
    force: float,
    material: Material | tuple[Material, Material],
    *,
    flanks: Mapping[str, Flank] | None = None,
    misalignment: Misalignment | None = None,
    supports: Mapping[str, Support | Shaft] | None = None,
    damage: Mapping[str, Sequence[Damage]] | None = None,
    phases: int | ArrayLike = 24,
    face: str | None = None,
    groove: float = 0.0,
) -> Contact3D:
    """Contact of a pair over the mesh cycle by ``ritz3d``: every contact line with its loads and pressures.

    `gearfe.plot_contact` draws it, ``phase=None`` the pattern of all phases; where a tip corner or an end face carries the most,
    it is marked as edge contact.

    Parameters
    ----------
    pair : GearPair
    force : float
        Along the line of action [N].
    material : Material or (Material, Material)
    flanks, misalignment, supports, damage, phases, face, groove
        As of `mesh_stiffness`.

    Returns
    -------
    Contact3D
        `cells` holds for each phase the pieces of the contact lines: where they are, their loads [N] and pressures [MPa].

    Raises
    ------
    ValueError
        If an input is impossible; the message says which.

    Examples
    --------
    >>> import math, gearfe as gf
    >>> rack = dict(m_n=3.0, alpha_n=math.radians(20), b=12.0)
    >>> pair = gf.GearPair(gf.Gear(z=24, r_bore=15.0, **rack), gf.Gear(z=30, r_bore=18.0, **rack))
    >>> askew = gf.Misalignment(F_beta=0.02)
    >>> found = gf.contact_pattern(pair, 2000.0, gf.Material(E=207e3, nu=0.3), misalignment=askew, phases=[0.75])
    >>> [round(z, 6) for z, _ in found.cells[0].at_ends(pair)]
    [0.0]
    """
    forces = forces_of(pair, force, None)
    if len(forces) > 1:
        raise ValueError(f"force = {force!r}, but the pattern is that of one force")
    cracks, pits = by_gear(pair, damage)
    face = face or ("helical" if pair.gear_1.beta else "spur")
    forms = flank_forms(pair, flanks, misalignment)
    phase = np.asarray(phase_array(phases, "cycle", pair, overlap(pair, face, groove)))
    options = {"pits": pits, "cracks": cracks, "flanks": forms, "face": face, "groove": groove}
    options["supports"] = supports_of(pair, supports, forces, face)
    check_integral(pair, options["supports"], "ritz3d", face)
    return pair_stiffness3d(pair, forces[0], two_materials(material), phase, **options)

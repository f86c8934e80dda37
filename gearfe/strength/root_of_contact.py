"""Root stress along the width under the contact load of a pair."""

import numpy as np

from ..contact.bodies import seen_gears
from ..contact.wide_contact import Contact3D
from ..core.case import Case
from ..core.material import Material
from ..core.threads import single
from ..flexibility.finite_elements.line_load import check_spread
from ..geometry.pair.gear_pair import GearPair
from .root_stress import RootStress, stress_under_line

SAMPLES = 2001  # number of heights at which the load is summed


@single
def root_stress_of_contact(
    pair: GearPair | Case,
    contact: Contact3D,
    index: int,
    material: Material | None = None,
    *,
    gear: str = "pinion",
    order: int = 0,
    half_width: float | None = None,
    refine: float = 1.0,
) -> RootStress:
    """Compute the root stress along the width of a tooth under its share of the contact load of a pair.

    Loads of other tooth pairs are omitted. Heights are counted from the end that touches first. The load per width is
    interpolated linearly between the cells of a contact line.

    Parameters
    ----------
    pair : GearPair or Case
    contact : Contact3D
        Of `gearfe.contact_pattern`, of a spur or helical pair without damage.
    index : int
        Number of the phase in `contact`.
    material : Material, optional
        Of the gear; default that of the case.
    gear : {"pinion", "wheel"}
    order : int
        Of the tooth pair, as in ``contact.order``.
    half_width, refine
        See `gearfe.root_stress_along_width`. A phase of the pair in the example takes about 7 s at ``refine=0.5``, and
        30 s and 3 GB at 1.

    Returns
    -------
    RootStress

    Raises
    ------
    ValueError
        If there is no such phase, gear or loaded tooth pair, or the pair is a herringbone pair.

    Examples
    --------
    >>> import math, gearfe as gf
    >>> rack = dict(m_n=2.0, alpha_n=math.radians(20), b=6.0)
    >>> pinion, wheel = gf.Gear(z=13, x=0.3, r_bore=8.0, beta=0.26, **rack), gf.Gear(z=16, x=0.2, r_bore=10.0, beta=-0.26, **rack)
    >>> pair, steel = gf.GearPair(pinion, wheel), gf.Material(E=207e3, nu=0.3)
    >>> contact = gf.contact_pattern(pair, 1800.0, steel, phases=[0.6])
    >>> gf.root_stress_of_contact(pair, contact, 0, steel).largest  # doctest: +SKIP
    """
    if isinstance(pair, Case):
        material = pair.materials[gear == "wheel"] if material is None else material
        pair = pair.pair
    if material is None:
        raise ValueError("material = None, but give the Material of this gear")
    if gear not in ("pinion", "wheel"):
        raise ValueError(f"gear = {gear!r}, but it must be 'pinion' or 'wheel'")
    if not -len(contact.cells) <= index < len(contact.cells):
        raise ValueError(f"index = {index!r}, but the contact has {len(contact.cells)} phases")
    cells = contact.cells[index]
    if (cells.half != 0).any():
        raise ValueError(
            "root stress of a herringbone pair is computed for one half: give the contact of that half, a helical pair"
        )
    loaded = np.flatnonzero((cells.order == order) & (cells.load > 0))
    if not loaded.size:
        raise ValueError(
            f"order = {order}: this tooth pair carries no load at phase {index}; loaded pairs are "
            f"{sorted(set(cells.order.tolist()))}"
        )
    number = 0 if gear == "pinion" else 1
    body, offset = seen_gears(pair, "helical", 0.0)[number]
    loaded = loaded[np.argsort(cells.depth[loaded])]
    z, rolls = cells.depth[loaded] + offset, cells.rolls[number][loaded]
    _check_own(body, z, rolls)
    load = _along(z, cells.width[loaded], cells.load[loaded], body.b)
    slope = np.polyfit(z, rolls, 1, w=cells.load[loaded]) if loaded.size > 1 else (0.0, rolls[0])
    spread = check_spread(body, half_width)
    return stress_under_line(body, lambda at: np.polyval(slope, at), load, material, spread=spread, refine=refine)


def _check_own(gear, z, rolls):
    """Raise ValueError if lines at heights `z` and roll lengths `rolls` [mm] are off the flank, as for another pair."""
    (low, high), slack = gear.flank_rolls, 1e-6 * gear.m_n
    if rolls.min() < low - slack or rolls.max() > high + slack or z.min() < 0 or z.max() > gear.b:
        raise ValueError(
            f"contact at roll lengths {rolls.min():.4g} to {rolls.max():.4g} mm and heights {z.min():.4g} to {z.max():.4g} mm, "
            f"but the flank of z = {gear.z} covers roll lengths {low:.4g} to {high:.4g} mm and heights 0 to {gear.b:g} mm: give "
            "a contact that was computed for this pair"
        )


def _along(z, width, load, b):
    """Return the load per width as a function of z, linear between cell centres, with the same total as the cells."""
    ends = np.concatenate([[z[0] - width[0] / 2], z, [z[-1] + width[-1] / 2]])
    per_width = load / width
    per_width = np.concatenate([per_width[:1], per_width, per_width[-1:]])
    at = np.linspace(0.0, b, SAMPLES)
    scale = load.sum() / np.trapezoid(np.interp(at, ends, per_width, left=0.0, right=0.0), at)
    return lambda place: scale * np.interp(place, ends, per_width, left=0.0, right=0.0)

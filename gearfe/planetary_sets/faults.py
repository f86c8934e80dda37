"""Flanks and damage of the gears of a set, in the tooth numbers of each mesh (`gearfe.planetary_sets.standing`)."""

from dataclasses import replace
from typing import Any

import numpy as np

from ..geometry.damage.missing import MissingTooth
from ..geometry.pair.flanks import flank_forms
from ..geometry.tooth.modified import Flank
from .case import planet_name
from .standing import standing


def faults(case: Any, inner: bool, planet: int, first: int) -> tuple[Any, Any, bool]:
    """Return flank forms (None: involutes) and damage of pinion and wheel of a mesh, and whether their teeth differ.

    `inner` is true for the mesh with the ring. `first` is the wheel's tooth that meets the pinion's tooth 0: C or D of
    `Standing`. Damage counts teeth in each gear's own frame, as `gearfe.flexibility.plane.Flexibility` does.
    """
    pair, names = case.pairs[inner], (planet_name(planet), "ring") if inner else ("sun", planet_name(planet))
    flanks = [case.flanks.get(name, Flank()) for name in names]
    # In pair j the pinion's tooth is j (a planet in a ring: -j), and the wheel's is first - j.
    teeth = np.arange(pair.gear_1.z) * (-1 if inner else 1), first - np.arange(pair.gear_2.z)
    back = -1 if inner else 1, 1  # A following tooth on one side is a leading tooth on the other side.
    centres = flanks[0].eccentric_tooth, first - flanks[1].eccentric_tooth
    pair_flanks = {}
    for side, flank, tooth, sign, centre in zip(("pinion", "wheel"), flanks, teeth, back, centres, strict=True):
        lists = {"pitch": _reordered(flank.pitch, tooth, sign), "tooth_scale": _reordered(flank.tooth_scale, tooth)}
        pair_flanks[side] = replace(flank, **lists, eccentric_tooth=centre)
    forms = flank_forms(pair, pair_flanks)
    damage_1, damage_2 = (case.damage.get(name, ()) for name in names)
    if inner:  # The planet is mirrored: flanks loaded by the sun are unloaded in this mesh.
        damage_1 = tuple(turned(one, -one.tooth) for one in damage_1)
    damage_2 = tuple(replace(one, tooth=one.tooth - first) for one in damage_2)
    differs = bool(damage_1 or damage_2 or [form for form in forms or () if form.differs])
    return forms, (damage_1, damage_2), differs


def _reordered(values, teeth, sign=1):
    """Return values per tooth in the order of `teeth`, times `sign`. The result is empty if there are no values."""
    return tuple((sign * np.array(values)[teeth % teeth.size]).tolist()) if values else ()


def first_pass(case: Any) -> float:
    """Return the position of the sun [pitches] nearest to 0 at which the first damaged tooth enters a mesh, else 0.

    A planet's damaged tooth is counted in the mesh that loads its damaged flank.
    """
    found = [(name, one) for name, own in case.damage.items() for one in own]
    if not found:
        return 0.0
    (name, one), stand = found[0], standing(case.gears, np.array(case.planet_angles), [0.0])
    inner = name == "ring" or (name != "sun" and one.side == "unloaded")
    phases = (stand.outer, stand.inner)[inner][0]
    pinion = {"sun": one.tooth + 0 * stand.planet, "ring": stand.ring - one.tooth}
    teeth = pinion.get(name, -one.tooth + (0 if inner else 1) * stand.planet)
    z, here = case.gear_of(name).z, [planet_name(k) == name or name in pinion for k in range(case.planets)]
    places = (-(phases + teeth)[here] + z / 2) % z - z / 2
    return float(places[np.abs(places).argmin()])


def turned(damage: Any, tooth: int) -> Any:
    """Return damage moved to the other side of a tooth. A missing tooth has no side."""
    side = {} if isinstance(damage, MissingTooth) else {"side": "unloaded" if damage.side == "loaded" else "loaded"}
    return replace(damage, tooth=tooth, **side)

"""Flanks and cracks of a set's gears, by the tooth numbers of the pair of each mesh (`gearfe.planetary_sets.standing`)."""

from dataclasses import replace
from typing import Any

import numpy as np

from ..geometry.pair.flanks import flank_forms
from ..geometry.tooth.modified import Flank
from .case import planet_name


def faults(case: Any, inner: bool, planet: int, first: int) -> tuple[Any, Any, bool]:
    """Flank forms (None: involutes) and cracks of pinion and wheel of a mesh, and whether its teeth differ.

    `inner`: it is the mesh with the ring. `first` is the wheel's tooth that meets the pinion's tooth 0: C or D of `Standing`.
    Cracks count teeth in each gear's own frame, as `gearfe.flexibility.plane.Flexibility` does.
    """
    pair, names = case.pairs[inner], (planet_name(planet), "ring") if inner else ("sun", planet_name(planet))
    flanks = [case.flanks.get(name, Flank()) for name in names]
    # the pinion's tooth in pair j is tooth j, of a planet in a ring -j; the wheel's is first - j
    teeth = [np.arange(gear.z) * (-1 if inner and k == 0 else 1) for k, gear in enumerate((pair.gear_1, pair.gear_2))]
    teeth[1] = first - teeth[1]
    pair_flanks = {}
    for k, (side, flank, tooth) in enumerate(zip(("pinion", "wheel"), flanks, teeth, strict=True)):
        back = -1 if inner and k == 0 else 1  # a tooth behind on one side is ahead on the other side
        moved = tuple(back * flank.pitch[t % len(teeth[k])] for t in tooth.tolist()) if flank.pitch else ()
        scaled = tuple(flank.tooth_scale[t % len(teeth[k])] for t in tooth.tolist()) if flank.tooth_scale else ()
        centre = flank.eccentric_tooth if k == 0 else first - flank.eccentric_tooth
        pair_flanks[side] = replace(flank, pitch=moved, tooth_scale=scaled, eccentric_tooth=centre)
    forms = flank_forms(pair, pair_flanks)
    cracks_1, cracks_2 = (case.damage.get(name, ()) for name in names)
    if inner:  # mirrored: flanks loaded by the sun are unloaded here
        cracks_1 = tuple(replace(c, tooth=-c.tooth, side="unloaded" if c.side == "loaded" else "loaded") for c in cracks_1)
    cracks_2 = tuple(replace(c, tooth=c.tooth - first) for c in cracks_2)
    differs = bool(cracks_1 or cracks_2) or any(form.differs for form in forms or ())
    return forms, (cracks_1, cracks_2), differs

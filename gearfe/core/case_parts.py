"""Parts of a `Case`: materials, forces, damage by gear, overlap ratio."""

import math
import warnings
from dataclasses import replace
from typing import Any

import numpy as np

from ..geometry.damage.crack import check_apart
from ..geometry.damage.hollow import warning_together
from ..geometry.damage.kinds import BROKEN, by_side, check_broken, parts_of, split
from ..geometry.pair.gear_pair import GearPair
from .checks import numbers
from .material import Material
from .supports.held import REFUSE

SIDES = (("pinion", 1), ("wheel", -1))  # In the wheel's own frame, its tooth of pair k is -k.
LIGHTEST = 1e-12  # smallest force or torque; below, contact terms overflow


def two_materials(material: Any) -> tuple[Material, Material]:
    """Materials of pinion and wheel."""
    materials = (material, material) if isinstance(material, Material) else material
    if not isinstance(materials, (tuple, list)) or len(materials) != 2 or not all(isinstance(m, Material) for m in materials):
        raise ValueError(f"material = {material!r}, but give one Material or a pair (pinion, wheel)")
    return materials[0], materials[1]


def overlap(pair: GearPair, face: str | None, groove: float) -> float:
    """Return the overlap ratio of a pair (of one half if `face` is herringbone), or 0 for spur gears."""
    width = pair.b_w
    if face == "herringbone":
        width = (width - groove) / 2
    return pair.eps_beta_of(width) if face in ("helical", "herringbone") else 0.0


def forces_of(pair: GearPair, force: Any, torque: Any) -> list[float]:
    """Return forces along the line of action [N] as a list. Torques on the pinion [N m] are converted by ``T / r_b``."""
    if (force is None) == (torque is None):
        raise ValueError(
            f"force = {force!r}, torque = {torque!r}, but give one of them: the force along the line of action [N] or the torque "
            "on the pinion [N m]"
        )
    name, unit, given = ("force", " N", force) if torque is None else ("torque", " N m", torque)
    values = np.atleast_1d(numbers(name, given, f" [{unit.strip()}]"))
    if values.ndim > 1 or values.size == 0:
        raise ValueError(f"{name} = {given!r}, but give one {name} or a non-empty list of {name}s [{unit.strip()}]")
    for value in values.tolist():
        if not (math.isfinite(value) and value >= LIGHTEST):
            least = f", at least {LIGHTEST:g}{unit}" if value > 0 else ""
            raise ValueError(
                f"{name} = {value}{unit}, but the load must press the flanks together: give a finite {name} > 0{least}"
            )
    return (values if torque is None else values * (1e3 / pair.gear_1.r_b)).tolist()


def check_load(pair: GearPair, force: float, materials: tuple[Material, Material]) -> None:
    """Raise ValueError for a force that would exceed small strains even for the stiffest gears. Nothing is solved.

    Raises
    ------
    ValueError
        If ``force / (b E / 5)``, with the stiffer E, is more than `REFUSE` modules. No gear mesh is as stiff as b E / 5.
    """
    width, stiffest = pair.b_w, max(material.E for material in materials)
    least = 5 * force / (width * stiffest) / pair.gear_1.m_n
    if least > REFUSE:
        raise ValueError(
            f"force = {force:g} N on {width:g} mm: the gears would approach by more than {100 * least:.3g} % of the module, but "
            f"teeth that bend so far (limit {100 * REFUSE:g} %) break: give a smaller force, forces in N, lengths in mm, E in MPa"
        )


def by_gear(pair: GearPair, damage: Any) -> tuple[tuple[tuple[Any, ...], ...], ...]:
    """Return cracks, hollows (pits, spalls) and broken teeth of pinion and wheel, numbered in each gear's own frame."""
    cracks, pits, broken = [], [], []
    for (_, sense), gear, defects in zip(SIDES, pair.gears, by_side(damage), strict=True):
        defects = parts_of(gear, defects)
        hollows = [[one for one in split(defects)[1] if (one.tooth, one.side) == place] for place in _flanks(defects)]
        together = (warning_together(gear, found) for found in hollows)
        for text in filter(None, (*(defect._warning(gear) for defect in defects), *together)):
            warnings.warn(text, stacklevel=5)
        own = [replace(defect, tooth=sense * defect.tooth) for defect in defects]
        weakens, removes = split(own)
        check_apart(gear, split(defects)[0])
        cracks.append(weakens)
        pits.append(removes)
        broken.append(tuple(dict.fromkeys(defect for defect in own if isinstance(defect, BROKEN))))
        check_broken(gear, defects)
    return tuple(cracks), tuple(pits), tuple(broken)


def _flanks(defects):
    """Return the flanks with hollows as (tooth, side)."""
    return dict.fromkeys((one.tooth, one.side) for one in split(defects)[1])

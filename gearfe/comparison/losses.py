"""Loss of mesh stiffness by damage. Damaged and healthy gears are compared at the same phases by the same method.

All numbers of a damaged pair refer to one mesh cycle in the middle of the engagement of its damaged tooth. The tooth is in
contact during the whole cycle. A healthy pair has the same mean over this cycle as over any other. A chip is at the tip. Its
cycle is the last one of a pinion tooth and the first one of a wheel tooth.
"""

import math
from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.case import Case
from ..core.checks import COARSEST
from ..geometry.damage.chip import Chip
from ..geometry.damage.kinds import Damage, called, told
from ..geometry.pair.gear_pair import GearPair
from ..stiffness.curve import StiffnessCurve
from ..stiffness.estimate import other_solves
from ..stiffness.methods import METHODS
from ..stiffness.phases import phase_array
from ..stiffness.solve import Solve, solve

ALONE = {"single": "carries alone", "double": "carries with one neighbour", "triple": "carries with two neighbours"}
SIDES = ("pinion", "wheel")
LARGEST = "most at a phase"  # row of the phase with the largest loss


def damage_phases(case: Case, phases: int, tooth: int | None = None, sides: Collection[str] = SIDES) -> NDArray:
    """Phases ``(phases,)`` of the mesh cycle in which a tooth, by default the damaged one, is in the middle of its engagement.

    If its damage on the gears `sides` is chips only, it is the cycle in which the tip is in contact: the last one of a pinion
    tooth, the first one of a wheel tooth. Of chips of both gears, it is that of the deeper one. Phases are multiples of
    ``1 / phases``, and differ from those of a healthy cycle by whole cycles.

    Examples
    --------
    >>> from gearfe import Case, Gear, GearPair, Material
    >>> rack = dict(m_n=2.0, alpha_n=0.349, b=20.0)
    >>> pair = GearPair(Gear(z=21, r_bore=7.4, **rack), Gear(z=31, r_bore=11.4, **rack))
    >>> print(f"{pair.eps_alpha:.3f}", damage_phases(Case(pair, 1000.0, Material(E=207e3, nu=0.3)), 4))
    1.615 [0.5  0.75 1.   1.25]
    """
    tooth = (case.first_tooth or 0) if tooth is None else tooth
    span, own = case.pair.eps_alpha + case.overlap(), damaged_pairs(case).get(tooth, {})
    found = {side: damage for side, damage in own.items() if side in sides}
    depths = {side: max(getattr(one, "depth", 0.0) for one in damage) for side, damage in found.items() if _chipped(damage)}
    ends = {"pinion": span - 0.5, "wheel": 0.5}
    middle = ends[max(depths, key=lambda side: depths[side])] if depths and len(depths) == len(found) else span / 2
    return (math.ceil((middle - tooth - 0.5) * phases - 1e-9) + np.arange(phases)) / phases


def engaged_phases(case: Case, phases: int) -> NDArray:
    """Phases ``(n,)`` of the engagements of damaged teeth, and a quarter of a cycle at both ends, in steps of ``1 / phases``."""
    return phase_array(phases, "tooth", case.pair, case.overlap(), case.damaged_pairs or (0,))


def damaged_pairs(case: Case) -> dict[int, dict[str, list[Damage]]]:
    """Return the damage by number of the tooth pair and by side.

    Pair k has the teeth k modulo z of both gears: tooth 3 of 17 and tooth 20 of 38 are pair 20.
    """
    given = case.damage or {}
    z = {"pinion": case.pair.gear_1.z, "wheel": case.pair.gear_2.z}
    pairs = dict.fromkeys(hurt.tooth for found in given.values() for hurt in found)
    return {
        pair: {
            side: here for side, found in given.items() if (here := [one for one in found if not (one.tooth - pair) % z[side]])
        }
        for pair in pairs
    }


def _chipped(damage):
    return all(isinstance(one, Chip) for one in damage)


class DamagedTeeth(NamedTuple):
    """Damaged teeth of one tooth pair that share a mesh cycle.

    Attributes
    ----------
    pair : int
        Number of the tooth pair, see `damaged_pairs`.
    sides : tuple of str
        Gears whose teeth they are. A chip and other damage in one tooth pair have different mesh cycles, as have chips of both.
    kind : str
        Their adjective, see `kind_of`.
    words : str
        Their description. Teeth are named unless tooth 0 of the pinion is the only damaged one.
    """

    pair: int
    sides: tuple[str, ...]
    kind: str
    words: str

    def phases(self, case: Case, phases: int) -> NDArray:
        """Return the phases of their mesh cycle, see `damage_phases`."""
        return damage_phases(case, phases, self.pair, self.sides)


def damaged_teeth(case: Case, returns: Mapping[tuple[str, int], str] | None = None) -> list[DamagedTeeth]:
    """Return the damaged teeth of a case by mesh cycle.

    `returns` has their engagement frequencies as text (`gearfe.comparison.returns.returns_of`).

    Examples
    --------
    >>> import gearfe as gf
    >>> rack = dict(m_n=2.0, alpha_n=0.349, b=20.0)
    >>> pair = gf.GearPair(gf.Gear(z=21, r_bore=7.4, **rack), gf.Gear(z=31, r_bore=11.4, **rack))
    >>> cracks = [gf.Crack(length=2.0, angle=1.05), gf.Crack(length=1.5, angle=1.05, tooth=5)]
    >>> [one.words for one in damaged_teeth(gf.Case(pair, 1000.0, gf.Material(), damage={"wheel": cracks}))]
    ['tooth 0 of the wheel: 2 mm crack at 60.2 degrees', 'tooth 5 of the wheel: 1.5 mm crack at 60.2 degrees']
    """
    found = damaged_pairs(case)
    plain = [(pair, list(sides)) for pair, sides in found.items()] == [(0, ["pinion"])]
    out = []
    for pair, own in found.items():
        apart = len(own) > 1 and any(map(_chipped, own.values()))
        for sides in ([side] for side in own) if apart else [list(own)]:
            damage = {side: own[side] for side in sides}
            name = " and ".join(f"tooth {hurt[0].tooth} of the {side}" for side, hurt in damage.items())
            often = "; ".join(filter(None, ((returns or {}).get((side, hurt[0].tooth)) for side, hurt in damage.items())))
            unloaded = all(getattr(one, "side", "") == "unloaded" for found in damage.values() for one in found)
            what = told_damage(case.pair, damage) + " on the unloaded flank" * unloaded
            words = f"{'' if plain else f'{name}: '}{what}{often and f' ({often})'}"
            out.append(DamagedTeeth(pair, tuple(sides), kind_of(damage), words))
    return out


def within(curve: StiffnessCurve, phases: NDArray | None) -> StiffnessCurve:
    """Return the part of a curve at some of its phases, or the whole curve if None."""
    if phases is None:
        return curve
    rows = np.flatnonzero(np.abs(curve.phase[:, None] - phases).min(axis=1) < 1e-9)
    names = ("phase", "k", "k_tangent", "deflection", "force", "pressure", "error", "unloaded", "support_deflection")
    arrays = {name: value for name in names if (value := getattr(curve, name)) is not None}
    return replace(curve, **{name: value[rows] for name, value in arrays.items()})


def told_cycle(phases: NDArray | None, kind: str = "") -> str:
    """Describe the phases to which zones and means refer. `kind` is a result of `kind_of`. Phases are None for several pairs."""
    middle = f"that has the {kind} tooth in the middle of its engagement"
    where = "in which the tip of the chipped tooth is in contact" if kind == "chipped" else middle
    over = f"the mesh cycle {where}" if kind else "the mesh cycle" if phases is None or np.ptp(phases) < 1 else "all mesh cycles"
    span = "" if phases is None else f", phases {phases.min():.3g} to {phases.max():.3g}"
    return f"zones, mean and max are over {over}{span}"


def loss(healthy: StiffnessCurve, hurt: StiffnessCurve) -> dict[str, float]:
    """Return the relative loss of stiffness by zone, and the largest loss at any phase (`LARGEST`)."""
    before, after = healthy.zones(), hurt.zones()
    return {zone: 1 - after[zone] / before[zone] for zone in before} | {LARGEST: float((1 - hurt.k / healthy.k).max())}


def loss_errors(healthy: StiffnessCurve, hurt: StiffnessCurve, case: Case, how: Solve) -> dict[str, float]:
    """Return the estimated error of the losses by zone: their change if both gears are solved with a coarser discretisation.

    The coarser solve is that of the error estimate of k. The result is empty if it would be too coarse. Three-dimensional
    finite elements take minutes, so the relative errors of both stiffnesses are added instead. This bound is much wider. It is
    also used for broken teeth.
    """
    losses, method = loss(healthy, hurt), str(how.method)
    if method == "fe3d" or (any(case.broken) and healthy.error is not None and hurt.error is not None):
        before, after = healthy.zone_errors(), hurt.zone_errors()
        widest = {zone: (1 - losses[zone]) * (before[zone] + after[zone]) for zone in before.keys() & after.keys()}
        return widest | {LARGEST: max(widest.values(), default=math.nan)}
    options = other_solves(how.refine, METHODS[method].order)[0]
    if options["refine"] < COARSEST:
        return {}
    rough = loss(*(solve(each_case, replace(how, **options)) for each_case in (case.healthy, case)))
    return {zone: abs(losses[zone] - rough[zone]) for zone in losses}


def told_damage(pair: GearPair, damage: Mapping[str, Iterable[Damage]] | None) -> str:
    """Describe damage in words.

    Examples
    --------
    >>> import gearfe as gf
    >>> scene = gf.load_scene("compound_planetary").pair()
    >>> told_damage(scene.pair, scene.damage["crack30"])
    '3.07 mm crack at 45 degrees (level 0.3)'
    """
    return told({"pinion": pair.gear_1, "wheel": pair.gear_2}, damage or {})


def kind_of(damage: Mapping[str, Iterable[Damage]] | None) -> str:
    """Return the adjective of a tooth with such damage, see `gearfe.geometry.damage.kinds.called`."""
    return called(hurt for damages in (damage or {}).values() for hurt in damages)


def headline(said: str, kind: str, found: Mapping[str, float], doubt: Mapping[str, float]) -> str:
    """One sentence on the loss of stiffness, from the results of `told_damage`, `kind_of`, `loss` and `loss_errors`.

    >>> headline("2 mm crack at 60 degrees", "cracked", {"single": 0.158, "mean": 0.0951}, {"single": 0.0021})
    '2 mm crack at 60 degrees: the mesh is 15.8 ± 0.3 % softer where the cracked tooth carries alone; 9.5 % on average'
    """
    alone = next((name for name in ALONE if name in found), None)
    zone = None if kind == "chipped" else alone  # For a chipped tooth the zone of single contact is the one of its intact flank.
    where = f"where the {kind} tooth {ALONE[zone]}" if zone else f"as the {kind} tooth passes"
    where = where.replace("carries", "would carry") if kind == "missing" else where
    most = percent_with_doubt(found[zone or LARGEST], doubt.get(zone or LARGEST, math.nan))
    return (
        f"{said}: the mesh is {most} softer {where}; {percent_with_doubt(found['mean'], doubt.get('mean', math.nan))} on average"
    )


def percent_with_doubt(value: float, doubt: float) -> str:
    """Return a ratio in percent with its error, which is rounded up: ``15.8 ± 0.3 %``. The error is optional."""
    if not math.isfinite(doubt):
        return f"{100 * value:z.1f} %"
    return f"{100 * value:z.1f} ± {rounded_up(100 * doubt):.1f} %"


def rounded_up(percent: float) -> float:
    """Return an error in percent with one decimal, rounded up."""
    return max(math.ceil(10 * percent), 1) / 10


def tooth_stiffness(curve: StiffnessCurve, tooth: int) -> NDArray:
    """Stiffness ``(n,)`` of one tooth pair, its force divided by the common approach [N/m]."""
    return curve.force[:, curve.order == tooth].sum(axis=1) / curve.deflection

"""How far analytical stiffness is from finite elements: tables of error by zone, with what each value cost."""

import math
import os
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.case import Case, CaseOptions, case_of
from ..core.checks import one_of
from ..core.markdown import table_row
from ..core.material import Material
from ..core.steps import steps
from ..core.units import in_newton_per_um
from ..geometry.mesh.mesher import gmsh_session
from ..geometry.pair.gear_pair import GearPair
from ..scene.load import Scene, load_scene
from ..stiffness.curve import StiffnessCurve
from ..stiffness.limits import check_count
from ..stiffness.methods import METHODS, ROWS, fitted
from ..stiffness.solve import Solve, solve
from .losses import (
    damage_phases,
    engaged_phases,
    headline,
    kind_of,
    loss,
    loss_errors,
    percent_with_doubt,
    told_cycle,
    told_teeth,
    why_not,
    within,
)
from .own_model import OwnModel, own_curve, own_models

REFERENCE, REFERENCE_SOLID = "fe", "ritz3d"  # of sections, and where the third dimension is needed
REFERENCES = (REFERENCE, REFERENCE_SOLID, "fe3d")
FORMULATIONS = tuple(row.name for row in ROWS if row.kind != "solid" and row.name != REFERENCE)  # of spur gears
ESTIMATE, HEALTHY = "error of the reference", "the same without damage"
ZONES = ("single", "double", "triple", "mean", "max")


@dataclass(frozen=True, slots=True)
class Comparison:
    """Curves by method, the first being the reference, and the seconds each took; of damage, healthy curves beside them.

    Imports, the error estimate of the reference and healthy curves beside damaged ones are not counted.

    Attributes
    ----------
    pair_name : str
    curves : dict of str to StiffnessCurve
        By method. Of a damaged pair over the whole engagement of the damaged tooth.
    seconds : dict of str to float
    healthy : dict of str to StiffnessCurve
        The same pair without its damage, at the same phases; empty of a healthy pair, and without models of the user's own.
    doubt : dict of str to float
        Estimated error of what damage takes by the reference, by zone, as a part of the healthy stiffness.
    damage, kind : str
        The damage in words, and what its tooth is called: "cracked", "pitted" or "damaged".
    left_out : dict of str to str
        Methods without a curve, and why.
    teeth : dict of str to (ndarray, dict)
        Of several damaged teeth: by tooth and damage in words the phases of its mesh cycle, and the doubt as above.
    cycle : ndarray, optional
        The phases that zones, mean and max are over, default all: of a damaged pair the mesh cycle in which the damaged tooth is
        in the middle of its engagement, so that it is in contact all the time.
    """

    pair_name: str
    curves: dict[str, StiffnessCurve]
    seconds: dict[str, float]
    healthy: dict[str, StiffnessCurve] = field(default_factory=dict)
    doubt: dict[str, float] = field(default_factory=dict)
    damage: str = ""
    kind: str = ""
    left_out: dict[str, str] = field(default_factory=dict)
    cycle: NDArray | None = None
    teeth: dict[str, tuple[NDArray, dict[str, float]]] = field(default_factory=dict)

    @property
    def reference(self) -> StiffnessCurve:
        """The curve the others are compared with."""
        return next(iter(self.curves.values()))

    def rows(self) -> Iterator[tuple[str, float, float, dict[str, tuple[float, float]]]]:
        """Rows (zone, reference k [N/m], its relative error estimate, {method: (k [N/m], relative error)})."""
        reference = within(self.reference, self.cycle)
        truth, doubt = reference.zones(), reference.zone_errors()
        others = {name: within(curve, self.cycle).zones() for name, curve in list(self.curves.items())[1:]}
        for zone in sorted(truth, key=lambda z: ZONES.index(z) if z in ZONES else 2):
            beside = {name: (z[zone], z[zone] / truth[zone] - 1) for name, z in others.items()}
            yield zone, truth[zone], doubt.get(zone, math.nan), beside

    def losses(self, cycle: NDArray | None = None) -> dict[str, dict[str, float]]:
        """What damage takes of the stiffness [-] by method and zone, and at the phase where it takes most; empty if healthy.

        Over the phases of a `cycle`, by default those of the comparison.
        """
        over = self.cycle if cycle is None else cycle
        compared = {name: (healthy, self.curves[name]) for name, healthy in self.healthy.items()}
        return {name: loss(*(within(curve, over) for curve in curves)) for name, curves in compared.items()}

    @property
    def headline(self) -> str:
        """The answer in one sentence: what damage takes; of a healthy pair its mean stiffness and who is how far off it."""
        name = next(iter(self.curves))
        if self.healthy:
            teeth = self.teeth or {self.damage: (self.cycle, self.doubt)}
            told = (headline(said, self.kind, self.losses(cycle)[name], doubt) for said, (cycle, doubt) in teeth.items())
            return "; ".join(told)
        mean = next(row for row in self.rows() if row[0] == "mean")
        doubt = f" ± {in_newton_per_um(mean[1] * mean[2], 2)}" if math.isfinite(mean[2]) else ""
        others = ", ".join(f"{other} {100 * error:+.1f} %" for other, (_, error) in mean[3].items())
        return f"healthy mesh stiffness {in_newton_per_um(mean[1])}{doubt} N/um in the mean by {name}" + (
            others and f"; {others}"
        )

    @property
    def definition(self) -> str:
        """What the zones and the mean are over."""
        return told_cycle(within(self.reference, self.cycle).phase, self.kind)

    def reasons(self) -> dict[str, str]:
        """Methods without a curve by why they have none: names with commas."""
        whys = dict.fromkeys(self.left_out.values())
        return {why: ", ".join(name for name, reason in self.left_out.items() if reason == why) for why in whys}

    def table(self) -> str:
        """Markdown table: per zone the reference [N/um] and every formulation with its error; last row the seconds."""
        names = list(self.curves)
        lines = [
            "| zone | " + " | ".join([f"{names[0]} [N/um] | estimate", *(f"{n} [N/um] | error" for n in names[1:])]) + " |",
            "|---" * (2 * len(names) + 1) + "|",
        ]
        for zone, truth, doubt, others in self.rows():
            cells = [f"{in_newton_per_um(k)} | {100 * error:+.1f} %" for k, error in others.values()]
            lines.append(f"| {zone} | " + " | ".join([f"{in_newton_per_um(truth)} | ± {100 * doubt:.2f} %", *cells]) + " |")
        cost = [f"{self.seconds[names[0]]:.3f} | ", *(f"{self.seconds[n]:.4f} | " for n in names[1:])]
        lines.append("| seconds | " + " | ".join(cost) + " |")
        return "\n".join(lines)

    def loss_table(self) -> str:
        """Markdown table: per zone the reference [N/um] healthy and damaged, and what damage takes by each method.

        The last row is the phase at which it takes most. Empty for a healthy pair.
        """
        if not self.healthy:
            return ""
        losses, name = self.losses(), next(iter(self.healthy))
        zones = [zone for zone, *_ in self.rows()]
        before, after = (within(by_name[name], self.cycle).zones() for by_name in (self.healthy, self.curves))
        head = ["zone", f"healthy {name} [N/um]", f"{self.kind} {name} [N/um]", f"loss by {name}"]
        lines = [table_row([*head, *(f"by {other}" for other in list(losses)[1:])]), "|---" * (3 + len(losses)) + "|"]
        for zone in (*zones, *(set(losses[name]) - set(zones))):
            cells = [in_newton_per_um(by_name[zone]) if zone in by_name else "" for by_name in (before, after)]
            others = [f"{100 * losses[other][zone]:.1f} %" for other in list(losses)[1:]]
            lines.append(
                table_row([zone, *cells, percent_with_doubt(losses[name][zone], self.doubt.get(zone, math.nan)), *others])
            )
        return "\n".join(lines)


class OwnPair(CaseOptions, total=False):
    """Load and material of a pair of one's own, and the options of its `Case`."""

    force: float
    torque: float
    material: Material | tuple[Material, Material]


def compare(
    scene: Scene | Case | GearPair | str | os.PathLike[str] | None = None,
    pair: str | GearPair | None = None,
    *,
    case: str | None = None,
    models: Sequence[OwnModel] | Mapping[str, OwnModel] = (),
    phases: int | ArrayLike = 64,
    refine: float = 1.0,
    reference: str | None = None,
    **given: Unpack[OwnPair],
) -> Comparison:
    """Compare every formulation that models it with the reference, on one pair of a scene or of your own, healthy or damaged.

    The reference is finite elements of the section; where pits or helical teeth need the third dimension, `ritz3d`. A damaged
    pair is compared with itself without damage, too, at the same phases.

    Parameters
    ----------
    scene : Scene, str, path or Case, optional
        A scene, the name of a built-in one, or its file; or a `Case`, or a pair of your own, see `pair`.
    pair : str or GearPair, optional
        Name of the scene's pair; default the first. Or, without a scene, a pair of your own with `force` or `torque`, and
        `material`.
    case : str, optional
        Name of a case of damage: the phases then are those of the mesh cycle in which its tooth is in the middle of its
        engagement.
    models : sequence or dict of str to model
        Your own: functions ``f(phase) -> k`` [N/m] of the total mesh stiffness, ``PairModel(f)`` of one tooth pair,
        ``OwnFlexibility(f)`` of one gear, or files with stated units (see `gearfe.comparison.own_model` and `gearfe.read_model`).
    phases : int or array
        As in `mesh_stiffness`.
    refine : float
        Resolution of the reference.
    reference : str, optional
        ``"fe3d"``: finite elements of whole gears, minutes for each; or another of fe and ritz3d than the default.
    **given
        Of a pair of your own, as of `Case`: ``force`` along the line of action [N] or ``torque`` on the pinion [N m],
        ``material``, ``damage``, ``face``, ``groove``, ``flanks`` and so on.

    Returns
    -------
    Comparison
        Its ``headline`` is the answer in one sentence; ``left_out`` says why a formulation has no curve.

    Raises
    ------
    ValueError
        If there is no such scene, pair or case, or a pair of your own comes without its load or material.
    """
    chosen, pair_name = _chosen(scene, pair, case, given)
    methods, left_out = _methods(chosen, reference)
    named = own_models(models, taken=(REFERENCE, *FORMULATIONS))
    cycle, cycles = None, {}
    if chosen.damaged and np.ndim(phases) == 0:
        count = check_count(phases)
        cycles = {said: damage_phases(chosen, count, number) for number, said in told_teeth(chosen).items()}
        phases, cycle = engaged_phases(chosen, count), next(iter(cycles.values()))
    for method in methods:  # what they and gmsh load is no part of their seconds
        METHODS[method].load()
    with gmsh_session():
        pass
    curves: dict[str, StiffnessCurve] = {}
    seconds, healthy, doubt = {}, {}, {}
    work = (*methods, ESTIMATE, *([HEALTHY] if chosen.damaged else []))
    cost = {methods[0]: 3.0, ESTIMATE: 6.0, HEALTHY: 6.0}
    for method in steps(work, lambda name: name, [cost.get(name, 0.3) for name in work]):
        if method == ESTIMATE:
            curves[methods[0]] = solve(chosen, Solve(methods[0], phases, refine=refine, error=True))
            continue
        if method == HEALTHY:
            healthy, doubt = _healthy(chosen, curves, Solve(methods[0], phases, refine=refine), cycle)
            continue
        started = time.perf_counter()
        known, variants, _ = fitted(method, chosen)
        how = Solve(method, phases, variants=variants, cache=False, refine=refine if method == methods[0] else 1.0)
        try:
            curves[method] = solve(known, how)
        except ValueError as error:
            if method == methods[0]:
                raise
            left_out[method] = str(error)
            continue
        seconds[method] = time.perf_counter() - started
    for name, model in named.items():
        started = time.perf_counter()
        curves[name] = own_curve(name, model, chosen.pair, curves[methods[0]])
        seconds[name] = time.perf_counter() - started
    teeth = {}
    if len(cycles) > 1:
        how = Solve(methods[0], phases, refine=refine)
        teeth = {said: (at, _doubt_of(chosen, healthy, curves, how, at)) for said, at in cycles.items()}
    damage_and_kind = (next(iter(told_teeth(chosen).values())), kind_of(chosen.damage)) if chosen.damaged else ("", "")
    return Comparison(pair_name, curves, seconds, healthy, doubt, *damage_and_kind, left_out, cycle, teeth)


def _healthy(chosen, curves, reference, cycle):
    """Curves of the same methods without the damage, and the doubt of what it takes by the reference (a `Solve`)."""
    out = {}
    for method in curves:
        known, variants, _ = fitted(method, chosen.healthy)
        how = replace(reference, method=method, variants=variants)
        how = replace(how, error=method == "fe3d") if method == reference.method else replace(how, refine=1.0)
        out[method] = solve(known, how)
    return out, _doubt_of(chosen, out, curves, reference, cycle)


def _doubt_of(chosen, healthy, curves, reference, cycle):
    """Estimated error of what damage takes by the reference, over the phases of a cycle."""
    beside = (within(by_method[reference.method], cycle) for by_method in (healthy, curves))
    return loss_errors(*beside, chosen, reference if cycle is None else replace(reference, phases=cycle))


def _chosen(scene, pair, case, given):
    """`Case` and its name: of a scene, or of one's own."""
    if isinstance(scene, (Case, GearPair)) and pair is None:
        scene, pair = None, scene
    if isinstance(pair, (Case, GearPair)):
        if scene is not None or case is not None:
            raise ValueError("a pair of your own has no scene and no case: leave them out, and give its damage as damage=")
        return _own(pair, given)
    stated = [name for name, value in given.items() if value not in (None, 0.0)]
    if stated:
        raise ValueError(f"{stated[0]} is stated by the scene: leave it out, or give pair=GearPair(...) instead of a scene")
    if isinstance(scene, (str, os.PathLike)):
        scene = load_scene(scene)
    if not isinstance(scene, Scene):
        raise ValueError(
            f"scene = {scene!r}, but give a Scene, the name or file of one, or pair=GearPair(...) with force= and material="
        )
    return scene.case(pair, case), pair or next(iter(scene.pairs))


def _own(pair, given):
    load = [given.get(name) for name in ("force", "torque")]
    if isinstance(pair, GearPair) and (given.get("material") is None or load == [None, None]):
        raise ValueError(
            "a pair of your own needs its load and material: force= [N] or torque= [N m], and material=Material(...)"
        )
    case = case_of(pair, **given)
    if len(case.forces) > 1:
        raise ValueError(f"force = {load[0]!r}, torque = {load[1]!r}, but one load is compared at a time")
    return replace(case, force=case.forces[0]), f"{case.pair.gear_1.z}/{case.pair.gear_2.z}"


def _methods(case, reference):
    """Reference and formulations for a case that have it whole, a ring's body included; why others are left out."""
    if reference is not None:
        one_of("reference", reference, REFERENCES)
    solid, ring = case.why_wide, case.pair.gear_2.internal
    if reference == REFERENCE and solid:
        raise ValueError(f"reference = {reference!r}, a transverse section, but {solid}: use 'ritz3d' or 'fe3d'")
    first = reference or (REFERENCE_SOLID if solid else REFERENCE)
    rows = [row for row in ROWS if row.rings == "yes" or not ring]
    if solid:
        others = [row.name for row in rows if row.kind == "sum" or (row.name == REFERENCE_SOLID)]
    else:
        others = [row.name for row in rows if row.name in (REFERENCE, *FORMULATIONS) and (row.cracks or not case.damaged)]
    methods = tuple(dict.fromkeys([first, *others]))
    return methods, {row.name: why_not(row, case, solid) for row in ROWS if row.name not in methods}

"""How far analytical stiffness is from finite elements: tables of error by zone, with what each value cost."""

import os
import time
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from numpy.typing import ArrayLike

from geometry.damage.crack import Crack
from geometry.damage.pit import Pit
from geometry.pair.gear_pair import GearPair

from ..material import Material
from ..scene.load import Scene, ScenePair, load_scene
from ..steps import part, steps
from ..stiffness.curve import StiffnessCurve
from ..stiffness.inputs import by_gear, forces_of, two_materials, why_solid
from ..stiffness.methods import METHODS, ROWS, fitted
from ..stiffness.solve import mesh_stiffness
from ..units import in_newton_per_um
from .own_model import OwnModel, own_curve, own_models

REFERENCE, REFERENCE_SOLID = "fe", "ritz3d"  # of sections, and where the third dimension is needed
FORMULATIONS = tuple(row.name for row in ROWS if row.kind != "solid" and row.name != REFERENCE)  # of spur gears
ESTIMATE = "error of the reference"
ZONES = ("single", "double", "triple", "mean", "max")


@dataclass(frozen=True, slots=True)
class Comparison:
    """Curves by method, the first being the reference, and the seconds each took.

    Imports and the error estimate of the reference are not counted.
    """

    pair_name: str
    curves: dict[str, StiffnessCurve]
    seconds: dict[str, float]

    @property
    def reference(self) -> StiffnessCurve:
        """The curve the others are compared with."""
        return next(iter(self.curves.values()))

    def rows(self) -> Iterator[tuple[str, float, float, dict[str, tuple[float, float]]]]:
        """Rows (zone, reference k [N/m], its relative error estimate, {method: (k [N/m], relative error)})."""
        truth, doubt = self.reference.zones(), self.reference.zone_errors()
        others = {name: curve.zones() for name, curve in list(self.curves.items())[1:]}
        for zone in sorted(truth, key=lambda z: ZONES.index(z) if z in ZONES else 2):
            yield (
                zone,
                truth[zone],
                doubt.get(zone, float("nan")),
                {name: (z[zone], z[zone] / truth[zone] - 1) for name, z in others.items()},
            )

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


def compare(
    scene: Scene | GearPair | str | os.PathLike[str] | None = None,
    pair: str | GearPair | None = None,
    *,
    case: str | None = None,
    models: Sequence[OwnModel] | Mapping[str, OwnModel] = (),
    phases: int | ArrayLike = 64,
    refine: float = 1.0,
    force: float | None = None,
    torque: float | None = None,
    material: Material | tuple[Material, Material] | None = None,
    damage: Mapping[str, Any] | None = None,
    face: str | None = None,
    groove: float = 0.0,
) -> Comparison:
    """Compare every formulation that models it with the reference, on one pair of a scene or of your own, healthy or damaged.

    The reference is finite elements of the section; where pits or helical teeth need the third dimension, `ritz3d`.

    Parameters
    ----------
    scene : Scene, str or path, optional
        A scene, the name of a built-in one, or its file; or a pair of your own, see `pair`.
    pair : str or GearPair, optional
        Name of the scene's pair; default the first. Or, without a scene, a pair of your own with `force` or `torque`, and
        `material`.
    case : str, optional
        Name of a case of damage: the phases then are those of the damaged tooth's whole engagement.
    models : sequence or dict of str to model
        Your own: functions ``f(phase) -> k`` [N/m] of the total mesh stiffness, ``PairModel(f)`` of one tooth pair,
        ``OwnFlexibility(f)`` of one gear, or files with stated units (see `gearfe.studies.own_model` and `gearfe.read_model`).
    phases : int or array
        As in `mesh_stiffness`.
    refine : float
        Resolution of the reference.
    force, torque, material, damage, face, groove
        Of a pair of your own, as of `mesh_stiffness`: force along the line of action [N] or torque on the pinion [N m].

    Returns
    -------
    Comparison
        Without the formulations that have no value for this damage; a warning says why.

    Raises
    ------
    ValueError
        If there is no such scene, pair or case, or a pair of your own comes without its load or material.
    """
    own_case = {"force": force, "torque": torque, "material": material, "damage": damage, "face": face, "groove": groove}
    chosen, pair_name, case = _chosen(scene, pair, case, own_case)
    methods = _methods(chosen, case)
    own = own_models(models, taken=(REFERENCE, *FORMULATIONS))
    run = chosen.case(case) | {"phases": phases, "span": "tooth" if case else "cycle"}
    with part("", 0.0, 0.0):
        mesh_stiffness(chosen.pair, chosen.force, chosen.materials, method="ritz", phases=1)  # imports what methods load lazily
    for method in methods:
        METHODS[method].load()
    curves, seconds = {}, {}
    cost = {methods[0]: 3.0, ESTIMATE: 6.0}
    for method in steps((*methods, ESTIMATE), lambda name: name, [cost.get(name, 0.3) for name in (*methods, ESTIMATE)]):
        if method == ESTIMATE:
            curves[methods[0]] = mesh_stiffness(**run, method=methods[0], refine=refine, error=True)
            continue
        started = time.perf_counter()
        options: dict[str, Any] = {"refine": refine} if method == methods[0] else {}
        try:
            curves[method] = mesh_stiffness(**fitted(method, run)[0], method=method, cache=False, **options)
        except ValueError as error:
            if method == methods[0]:
                raise
            warnings.warn(f"{method} has no value here: {error}", stacklevel=2)
            continue
        seconds[method] = time.perf_counter() - started
    for name, model in own.items():
        started = time.perf_counter()
        curves[name] = own_curve(name, model, chosen.pair, curves[methods[0]])
        seconds[name] = time.perf_counter() - started
    return Comparison(pair_name, curves, seconds)


def _chosen(scene, pair, case, own):
    """`ScenePair`, its name and its case: of a scene, or of a pair of one's own."""
    if isinstance(scene, GearPair) and pair is None:
        scene, pair = None, scene
    if isinstance(pair, GearPair):
        if scene is not None or case is not None:
            raise ValueError("a pair of your own has no scene and no case: leave them out, and give its damage as damage=")
        return _own(pair, **own)
    given = [name for name, value in own.items() if value not in (None, 0.0)]
    if given:
        raise ValueError(f"{given[0]} is stated by the scene: leave it out, or give pair=GearPair(...) instead of a scene")
    if isinstance(scene, (str, os.PathLike)):
        scene = load_scene(scene)
    if not isinstance(scene, Scene):
        raise ValueError(
            f"scene = {scene!r}, but give a Scene, the name or file of one, or pair=GearPair(...) with force= and material="
        )
    return scene.pair(pair), pair or next(iter(scene.pairs)), case


def _own(pair, *, force, torque, material, damage, face, groove):
    if material is None or (force is None and torque is None):
        raise ValueError(
            "a pair of your own needs its load and material: force= [N] or torque= [N m], and material=Material(...)"
        )
    forces = forces_of(pair, force, torque)
    if len(forces) > 1:
        raise ValueError(f"force = {force!r}, torque = {torque!r}, but one load is compared at a time")
    by_gear(pair, damage)
    damage = {side: [one] if isinstance(one, (Crack, Pit)) else list(one or ()) for side, one in (damage or {}).items()}
    cases = {"given": damage} if any(damage.values()) else {}
    made = ScenePair(pair, two_materials(material), forces[0], face, groove, cases)
    return made, f"{pair.gear_1.z}/{pair.gear_2.z}", "given" if cases else None


def _methods(chosen, case):
    """Reference and formulations for a pair of a scene: those that have it whole, a ring's body included."""
    damage = [one for found in chosen.case(case).get("damage", {}).values() for one in found]
    rows = [row for row in ROWS if row.rings == "yes" or not chosen.pair.gear_2.internal]
    if why_solid(chosen.pair, chosen.face, damage):
        return (REFERENCE_SOLID, *(row.name for row in rows if row.kind == "sum"))
    return (REFERENCE, *(row.name for row in rows if row.name in FORMULATIONS and (row.cracks or not damage)))

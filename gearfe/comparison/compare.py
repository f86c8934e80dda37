"""`compare`: stiffness by every formulation and by the reference, for pairs and damage cases, with errors and cost."""

import os
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.case import Case, CaseOptions, case_of
from ..core.case_parts import overlap
from ..core.checks import one_of
from ..core.material import Material
from ..geometry.mesh.mesher import gmsh_session
from ..geometry.pair.gear_pair import GearPair
from ..scene.load import Scene, load_scene
from ..scene.parts import DAMAGE
from ..scene.scene_pair import ScenePair
from ..scene.stored import read_curves
from ..stiffness.curve import StiffnessCurve
from ..stiffness.limits import check_count
from ..stiffness.methods import METHODS, RING_FOUNDATIONS, ROWS, SUMS, Method
from ..stiffness.solve import Solve
from .comparison import Comparison, Key
from .losses import damage_phases, damaged_teeth, engaged_phases, kind_of
from .own_model import OwnModel, own_curve, own_models
from .returns import returns_of
from .solved_curves import compared

REFERENCE, REFERENCE_SOLID = "fe", "ritz3d"  # reference methods of sections, and of gears that need three dimensions
REFERENCES = (REFERENCE, REFERENCE_SOLID, "fe3d")
FORMULATIONS = tuple(row.name for row in ROWS if row.kind != "solid" and row.name != REFERENCE)  # formulations for spur gears
STORED = 32  # phases per cycle of stored curves


class OwnPair(CaseOptions, total=False):
    """Load and material of a user-defined pair, and further options of its `Case`."""

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
    """Compare every suitable formulation with the reference, for one pair of a scene or a user-defined one.

    The reference is finite elements of the section, or `ritz3d` for pits and helical teeth, which need three dimensions. A
    damaged pair is also compared with the healthy pair at the same phases.

    Parameters
    ----------
    scene : Scene, str, path or Case, optional
        A scene, the name of a built-in one, or its file; or a `Case`; or a user-defined pair, see `pair`.
    pair : str or GearPair, optional
        Name of the scene's pair; default the first. Or, without a scene, a user-defined pair with `force` or `torque`, and
        `material`.
    case : str, optional
        Name of a case of damage: the phases then are those of the mesh cycle in which its tooth is in the middle of its
        engagement.
    models : sequence or dict of str to model
        User-defined models: functions ``f(phase) -> k`` [N/m] of the total mesh stiffness, ``PairModel(f)`` of one tooth pair,
        ``OwnFlexibility(f)`` of one gear, or files with stated units (see `gearfe.comparison.own_model` and `gearfe.read_model`).
        A tuple ``(damaged, healthy)`` of two of them adds the losses by that model. Of two `PairModel` or two tables over the
        radius the damaged one counts for the damaged teeth, the healthy one for all others.
    phases : int or array
        As in `mesh_stiffness`.
    refine : float
        Resolution of the reference.
    reference : str, optional
        ``"fe3d"``: finite elements of whole gears, minutes for each; or another of fe and ritz3d than the default.
    **given
        Arguments of `Case` for a user-defined pair: ``force`` along the line of action [N] or ``torque`` on the pinion [N m],
        ``material``, ``damage``, ``face``, ``groove``, ``flanks`` and so on.

    Returns
    -------
    Comparison
        Its ``headline`` is the answer in one sentence; ``left_out`` has the reason for each formulation without a curve.

    Raises
    ------
    ValueError
        If there is no such scene, pair or case, or a user-defined pair has no load or material.
    """
    chosen, key = _chosen(scene, pair, case, given)
    methods, left_out = _methods(chosen, reference)
    named = own_models(models, taken=(REFERENCE, *FORMULATIONS))
    returns = {} if isinstance(scene, (Case, GearPair, type(None))) else returns_of(_loaded(scene), *key)
    plan, cycles = _beside(key, chosen, phases, returns)
    for method in methods:  # Libraries are loaded before the timed part.
        METHODS[method].load()
    with gmsh_session():
        pass
    how = Solve(refine=refine, error=True)
    found = compared(plan, (key,), methods, how, cycles, fresh=True, left_out=left_out)
    for name, model in named.items():
        started = time.perf_counter()
        model, healthy = model if isinstance(model, tuple) else (model, None)
        if healthy is not None:
            if not chosen.damaged:
                raise ValueError(f"model {name!r} has a damaged and a healthy part: state the case of damage")
            found.solved[key[0], None, name] = own_curve(name, healthy, chosen.pair, found.solved[key[0], None, methods[0]])
        found.solved[*key, name] = own_curve(name, model, chosen.pair, found.solved[*key, methods[0]], healthy)
        found.times[*key, name] = time.perf_counter() - started
    return found


def compare_cases(
    scene: Scene, cases: Iterable[Key] | None = None, *, phases: int = 64, reference: str | None = None
) -> Comparison:
    """Compare the converged methods and the closed forms on all pairs of a scene in all their cases of damage.

    The reference is finite elements: of the section where two dimensions are sufficient, otherwise of whole gears in three
    dimensions, which take minutes per gear. Results for built-in scenes are read from a supplied file. If no file has results
    for these gears, loads and damages, the reference is the energy model `ritz3d`.

    Parameters
    ----------
    scene : Scene
    cases : iterable of (str, str or None), optional
        Pair and case, each pair with None (healthy) too; default all, pairs without damage too.
    phases : int
        Number in the mesh cycle; where curves on file are read, theirs.
    reference : "fe3d", optional
        Compute finite elements of whole gears that are not on file.

    Raises
    ------
    ValueError
        If the scene has no damage.
    """
    if not scene.cases:
        raise ValueError(f"scene {scene.name} has no cases of damage: add {' or '.join(map('[[{}]]'.format, DAMAGE))} tables")
    every = [(name, case) for name, pair in scene.pairs.items() for case in (None, *pair.damage)]
    wide = any(scene.case(*key).why_wide for key in every)
    stored = read_curves(scene) if wide else {}
    asked = tuple(every if cases is None else cases)
    solid = wide and (reference == "fe3d" or stored.keys() >= {*asked})
    first = REFERENCES[wide + solid]
    methods = (*dict.fromkeys([first, REFERENCE_SOLID if wide else "ritz"]), *SUMS)
    plan = {key: (case := scene.case(*key), damage_cycle(case) if stored else damage_phases(case, phases)) for key in asked}
    filed = plan.keys() & stored.keys() if solid else ()
    known = {(*key, "fe3d"): _on_file(plan[key][0], *stored[key]) for key in filed}
    return compared(plan, asked, methods, Solve(), known=known)


def beside_health(
    case: Case, how: Solve, pair: str = "pair", *, returns: Mapping[tuple[str, int], str] | None = None
) -> Comparison:
    """Compare a damaged pair with its healthy state by one method. A healthy pair gives its curve alone.

    For a damaged pair, a number of phases in a mesh cycle is spread over the whole engagement of the damaged tooth.
    `damaged_teeth` describes `returns`.
    """
    key = (pair, kind_of(case.damage) if case.damaged else None)
    (plan, cycles), (row, why) = _beside(key, case, how.phases, returns), how.chosen(case)
    found = compared(plan, (key,), (row.name,), how, cycles)
    for curve in found.solved.values():
        curve.meta["why"] = why
    return replace(found, times={})


def _beside(key, case, phases, returns=None):
    """Return cases and phases by key, healthy pairs included, and the phases of the zones and the kind of each damaged tooth."""
    cycles = {}
    if case.damaged and np.ndim(phases) == 0:
        count = check_count(phases)
        cycles = {one.words: (one.phases(case, count), one.kind) for one in damaged_teeth(case, returns)}
        phases = engaged_phases(case, count)
    return {key: (case, phases)} | ({(key[0], None): (case.healthy, phases)} if case.damaged else {}), cycles


def damage_cycle(chosen: Case | ScenePair) -> NDArray:
    """Return the phases ``(STORED,)`` of stored curves: one mesh cycle around the middle of the damaged tooth's engagement."""
    length = chosen.pair.eps_alpha + overlap(chosen.pair, chosen.face, chosen.groove)
    tooth = (chosen.first_tooth or 0) if isinstance(chosen, Case) else 0
    return length / 2 - 0.5 - tooth + (np.arange(STORED) + 0.5) / STORED


def _on_file(case, phase, k, tooth, estimate, seconds):
    """Return a stored curve of finite elements (`read_curves`) and its computing time [s].

    The file contains the stiffness of the damaged tooth pair only, so the forces of the other pairs are unknown.
    """
    deflection, nothing = case.forces[0] / k, np.full((k.size, 1), np.nan)
    meta = {"method": "fe3d", "force_N": case.forces[0], "face": case.runs, "eps_alpha": case.pair.eps_alpha}
    meta |= {"stored": True}
    error = None if np.isnan(estimate) else estimate * k
    order, force = np.array([case.first_tooth or 0]), (tooth * deflection)[:, None]
    return StiffnessCurve(phase, k, nothing[:, 0], deflection, order, force, nothing, error, meta), seconds


def _chosen(scene, pair, case, given):
    """Return `Case` and key of a scene's pair or a user-defined one."""
    if isinstance(scene, (Case, GearPair)) and pair is None:
        scene, pair = None, scene
    if isinstance(pair, (Case, GearPair)):
        if scene is not None or case is not None:
            raise ValueError("a user-defined pair has no scene and no case: leave them out, and give its damage as damage=")
        return _own(pair, given)
    stated = [name for name, value in given.items() if value not in (None, 0.0)]
    if stated:
        raise ValueError(f"{stated[0]} is stated by the scene: omit it, or give pair=GearPair(...) instead of a scene")
    scene = _loaded(scene)
    if not isinstance(scene, Scene):
        raise ValueError(
            f"scene = {scene!r}, but give a Scene, the name or file of one, or pair=GearPair(...) with force= and material="
        )
    return scene.case(pair, case), (pair or next(iter(scene.pairs)), case)


def _loaded(scene):
    return load_scene(scene) if isinstance(scene, (str, os.PathLike)) else scene


def _own(pair, given):
    load = [given.get(name) for name in ("force", "torque")]
    if isinstance(pair, GearPair) and (given.get("material") is None or load == [None, None]):
        raise ValueError(
            "a user-defined pair needs its load and material: force= [N] or torque= [N m], and material=Material(...)"
        )
    case = case_of(pair, **given)
    if len(case.forces) > 1:
        raise ValueError(f"force = {load[0]!r}, torque = {load[1]!r}, but one load is compared at a time")
    name = f"{case.pair.gear_1.z}/{case.pair.gear_2.z}"
    return replace(case, force=case.forces[0]), (name, kind_of(case.damage) if case.damaged else None)


def _methods(case, reference):
    """Return the reference and the formulations that model a case completely, and reasons for the others."""
    one_of("reference", reference or REFERENCE, REFERENCES)
    solid = case.why_wide
    if reference == REFERENCE and solid:
        raise ValueError(f"reference = {reference!r} models a transverse section, but {solid}: use 'ritz3d' or 'fe3d'")
    first, own = (REFERENCE_SOLID, (REFERENCE_SOLID, *SUMS)) if solid else (REFERENCE, (REFERENCE, *FORMULATIONS))
    rows = [row for row in ROWS if row.name in own and _models(row, case)]
    methods = tuple(dict.fromkeys([reference or first, *(row.name for row in rows)]))
    return methods, {row.name: why_not(row, case, solid) for row in ROWS if row.name not in methods}


def _models(row, case):
    """Return True if a formulation supports the damage and the gears of a case."""
    hurt, ring = case.damaged and not case.why_wide, case.pair.gear_2.internal
    return (row.cracks or not hurt) and (row.rings == "yes" or not ring)


def why_not(row: Method, case: Case, solid: str) -> str:
    """Return the reason why a comparison has no column for a method.

    `solid` is the reason why three dimensions are required, if there is one.
    """
    pair = case.pair
    if pair.gear_2.internal and row.rings != "yes" and row.rings not in RING_FOUNDATIONS:
        return "not for rings"
    if pair.gear_2.internal and row.rings != "yes":
        return f"not for rings: it {RING_FOUNDATIONS[row.rings]}"
    if row.name == "fe3d" and solid:
        return "takes minutes for each gear; use --reference fe3d (reference='fe3d')"
    if row.kind == "solid":
        return "a two-dimensional model is sufficient here; for narrow gears use --reference ritz3d (reference='ritz3d')"
    if solid and row.kind == "section":
        return f"a transverse section, but {solid}"
    return "for healthy gears only" if case.damaged and not row.cracks else "left out"

"""Machine of a scene: the table of models that `build_machine` uses, and the errors of a scene.

A model is one file with its bodies, stages and springs, a function ``(scene, case, **options) -> Machine``, and one row in the
table here.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from ...core.checks import one_of
from ...scene.load import Scene
from ...stiffness.curve import StiffnessCurve
from .compound_planetary import scene_compound
from .force_law import ForceLaw
from .gearbox import scene_gearbox
from .helical_pair import scene_pair
from .herringbone_planetary import scene_herringbone
from .impact import impact_helical, impact_planetary
from .mesh_curves import Samples
from .mesh_errors import with_errors
from .pitted_planetary import scene_planetary
from .scene_curves import own_forces, pair_backlash
from .sensor import with_sensors
from .stages import Fault
from .tables import Machine

MACHINES: dict[str, dict[str, Callable[..., Machine]]] = {  # by model: builder for each contact type
    "planetary": {"linear": scene_planetary, "impact": impact_planetary},
    "compound_planetary": {"linear": scene_compound},
    "helical_pair": {"linear": scene_pair, "impact": impact_helical},
    "herringbone_planetary": {"linear": scene_herringbone},
    "gearbox": {"linear": scene_gearbox},
}
EVEN = 1e-9  # tolerance for equally spaced phases
ROUGH = 8  # phases per cycle of the curves from which the forces at rest are computed
STATED = ("herringbone_planetary",)  # models whose scene states masses and inertias


def build_machine(
    scene: Scene, case: str | None = None, *, phases: int = 64, method: str = "auto", loads: Sequence[float] = (1.0,)
) -> Machine:
    """Build the machine of a scene for `gearfe.simulate`. The contact of its pairs is solved under the loads of the meshes.

    If a planetary scene has a ``[set]`` table, each mesh has the compliance that the whole set adds to the isolated pair. The set
    is that of `gearfe.build_set` without damage, in its section. Sets that do not repeat with the mesh cycle (a ring on pads)
    add nothing: use `gearfe.with_set`. The impact law has a coefficient, to which a set adds nothing.

    Parameters
    ----------
    scene : Scene
        With a ``[machine]`` table.
    case : str, optional
        Case of damage; None: healthy.
    phases : int
        Phases per mesh cycle of the curves. Further ones are added where pairs enter or leave (`gearfe.mesh_cycle`, `fine`).
    method : str
        As in `mesh_stiffness`.
    loads : sequence of float
        Loads that the contact of each pair is solved under, as multiples of the largest force of its meshes at rest, which the
        load that the scene states for the pair need not be. One of them makes stiffnesses over the phase that are true of this
        load alone, by default of the meshes' own. Several make force laws (`machine.force_law.ForceLaw`), for loads
        that change and for resonances: ``(1 / 16, 1 / 4, 1 / 2, 1, 2)``. Their mesh forces bend where pairs come in, with
        harmonics far above the mesh frequency: `gearfe.simulate` filters them out above half of its rate. Not under the impact
        law, which has a coefficient.

    Returns
    -------
    gearfe.dynamics.machine.tables.Machine
        Its `stages` and `notes` hold mesh, fault and carrier frequencies, and the forces of the pairs' meshes at rest.

    Raises
    ------
    ValueError
        If the scene has no machine, no such case, or an unknown model.
    """
    build, contact = _builder(scene, case)
    if contact == "impact" and tuple(loads) != (1.0,):
        raise ValueError(
            f"loads = {tuple(loads)}: the impact law has a stiffness coefficient and no curves at several loads; use contact = "
            "'linear'"
        )
    if contact == "impact":
        return with_scene_errors(scene, with_sensors(scene, build(scene, case)))
    if not len(loads) or not all(math.isfinite(multiple) and multiple > 0 for multiple in loads):
        raise ValueError(f"loads = {loads}, but give multiples of the meshes' own forces, one or more, above 0")
    rough = build(scene, case, phases=ROUGH, method=method, loads=None)
    forces = own_forces(rough)
    play = [pair_backlash(scene, mesh.stiffness.meta["scene_pair"]) for mesh in rough.meshes]
    several = {name: ([force * multiple for multiple in loads], force) for name, force in forces.items()}
    out = build(scene, case, phases=phases, method=method, loads=several)
    stated = {name: pair.force for name, pair in scene.pairs.items() if name in forces}
    out = replace(out, notes=out.notes | {"mesh forces at rest [N]": forces, "loads stated for the pairs [N]": stated})
    meshes = tuple(replace(mesh, backlash=own or mesh.backlash) for mesh, own in zip(out.meshes, play, strict=True))
    out = _in_set(scene, replace(out, meshes=meshes), forces)
    return with_scene_errors(scene, with_flanks(with_sensors(scene, out)))


def _in_set(scene, machine, forces):
    """Return the machine with the compliance that the set of its scene adds to isolated pairs, if the scene has a set."""
    if scene.set is None or scene.machine["model"] != "planetary":
        return machine
    from ...planetary_sets.added import added_compliance  # imported here, because only sets need it and it takes 0.1 s
    from .with_set import with_added

    added = added_compliance(scene, forces[scene.set.pairs[0]])
    return machine if added is None else with_added(machine, added)


def flat_machine(scene: Scene, case: str | None = None) -> Machine:
    """Return the machine of a scene with constant mesh stiffness, for its frequencies and faults. Nothing is solved.

    ValueError if `build_machine` rejects the scene.
    """
    build, contact = _builder(scene, case)
    options = {} if contact == "impact" else {"phases": ROUGH, "method": None, "loads": None}
    return with_sensors(scene, build(scene, case, **options))


def damaged_teeth(scene: Scene, case: str | None) -> Sequence[Fault]:
    """Return the `Fault` of each damaged or deviating tooth in a case. The result is empty without a valid machine."""
    try:
        build = MACHINES[scene.machine["model"]]["linear"]
        return build(scene, case, phases=ROUGH, method=None, loads=None).faults
    except (KeyError, ValueError):  # `build_machine` raises the error with its reason.
        return ()


def _builder(scene, case):
    """Return the function that builds the machine of a scene, and its contact law."""
    if not scene.machine:
        raise ValueError(f"scene {scene.name} has no [machine] table: add one with model, speed_rpm and torque_Nm")
    scene.check_case(case)
    model, contact = scene.machine["model"], scene.machine.get("contact", "linear")
    one_of("[machine] model", model, MACHINES)
    one_of("[machine] contact", contact, ("linear", "impact"))
    if contact not in MACHINES[model]:
        raise ValueError(f"[machine] contact = 'impact': the model {model!r} has linear contact only")
    if scene.machine.get("bodies") and model not in STATED:
        raise ValueError(f"[machine.bodies]: the model {model!r} computes masses and inertias from its gears: omit the table")
    _check_contact(scene, case, contact)
    return MACHINES[model][contact], contact


def _check_contact(scene, case, contact):
    """Raise ValueError for flanks and broken teeth that the contact law of a machine does not model."""
    hurt = {name: pair.case(case) for name, pair in scene.pairs.items() if case in pair.damage}
    if contact == "impact":
        for name, pair in scene.pairs.items():
            if pair.flanks or pair.misalignment:
                raise ValueError(
                    f"[pair.{name}] has flanks or misalignment, but the impact law neglects flank deviations: use "
                    "contact = 'linear'"
                )
            if name in hurt and any(hurt[name].broken):
                raise ValueError(
                    f"[pair.{name}] has a broken tooth in case {case!r}, but the impact law is limited to unbroken teeth: use "
                    "contact = 'linear'"
                )
    elif any(one.missing and not pair_backlash(scene, name) for name, one in hurt.items()):
        raise ValueError(
            "[machine] backlash_um: a missing tooth lets the contact open, so that the machine needs a backlash; give one, "
            "such as backlash_um = 100.0"
        )


def with_flanks(machine):
    """Return the machine with the unloaded transmission error in all meshes with modified flanks."""
    errors = {
        mesh.name: _unloaded(mesh.stiffness)
        for mesh in machine.meshes
        if isinstance(mesh.stiffness, (StiffnessCurve, ForceLaw)) and mesh.stiffness.unloaded is not None
    }
    return with_errors(machine, profile=errors) if errors else machine


def _unloaded(curve):
    """Return the unloaded transmission error at equally spaced phases of a curve or a force law."""
    phase = curve.phase
    at = phase[0] + np.arange(round(1 / np.diff(phase).max())) * np.diff(phase).max()
    kept = np.abs(phase[:, None] - at).min(axis=1) < EVEN
    return Samples(phase[kept], curve.unloaded[kept])


def with_scene_errors(scene, machine):
    """Return the machine with the errors that its scene states for the driven (last) stage."""
    keys = ("profile_error_um", "runout_um", "misplaced_um", "misplaced_y_um")
    profile, runout, *shift = (1e-6 * scene.machine.get(key, 0.0) for key in keys)
    if not (profile or runout or any(shift)):
        return machine
    stage = machine.stages[-1]
    place = dict.fromkeys(stage.follower, tuple(shift)) if any(shift) else None
    return with_errors(machine, profile=profile, runout=dict.fromkeys(stage.driver, (runout, stage.turning, 0.0)), place=place)

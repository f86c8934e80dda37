"""From a scene to its machine: stiffness curves of all its pairs, healthy and damaged, in the model the scene names."""

import math
from dataclasses import replace

from geometry.damage.pit import Pit
from geometry.pair.gear_pair import GearPair
from geometry.pair.planetary import PlanetarySet

from ..stiffness.solve import mesh_stiffness
from .compound import compound_planetary
from .gear_mesh import ToothDamage
from .herringbone import herringbone_planetary
from .impact import impact_helical, impact_planetary, pits_of
from .layout import Body
from .mesh_errors import with_errors
from .stages import disc, gear_pair, pitted_planetary

DENSITY = 7850.0  # kg/m3
BEARING = {"x": 1e8, "y": 1e8, "z": 1e8}  # N/m, assumed for the helical pair


def build_machine(scene, case=None, *, phases=64, method="auto"):
    """Machine of a scene for `gearfe.simulate`, with the stiffness curves of its pairs.

    Parameters
    ----------
    scene : Scene
        With a ``[machine]`` table.
    case : str, optional
        Case of damage; None: healthy.
    phases : int
        Per mesh cycle, of the curves.
    method : str
        As in `mesh_stiffness`.

    Returns
    -------
    gearfe.machine.tables.Machine
        Its `notes` hold mesh, fault and carrier frequencies.

    Raises
    ------
    ValueError
        If the scene has no machine, no such case, or an unknown model.
    """
    if not scene.machine:
        raise ValueError(f"scene {scene.name} has no [machine] table: add one with model, speed_rpm and torque_Nm")
    if case is not None and not any(case in pair.damage for pair in scene.pairs.values()):
        known = sorted({name for pair in scene.pairs.values() for name in pair.damage})
        raise ValueError(f"scene {scene.name} has no case {case!r}; it has {', '.join(known) or 'none'}")
    made = {
        "planetary": _planetary,
        "compound_planetary": _compound,
        "helical_pair": _pair,
        "herringbone_planetary": _herringbone,
    }
    model = scene.machine["model"]
    if model not in made:
        raise ValueError(f"[machine] model = {model!r}, but it must be one of {', '.join(made)}")
    contact, speed = scene.machine.get("contact", "linear"), scene.machine["speed_rpm"] * math.pi / 30
    if contact not in ("linear", "impact"):
        raise ValueError(f"[machine] contact = {contact!r}, but it must be 'linear' or 'impact'")
    if contact == "impact":
        if model not in ("planetary", "helical_pair"):
            raise ValueError(f"[machine] contact = 'impact': the model {model!r} has linear contact only")
        return _erring(scene, (_impact_stage if model == "planetary" else _impact_pair)(scene, case, speed))
    out = made[model](scene, case, speed, scene.machine["torque_Nm"], {"phases": phases, "method": method})
    play = scene.machine.get("backlash_um")
    return _erring(scene, out.with_meshes(backlash=1e-6 * play) if play else out)


def _erring(scene, machine):
    """The machine with the errors that its scene states."""
    profile, runout, shift = (1e-6 * scene.machine.get(key, 0.0) for key in ("profile_error_um", "runout_um", "misplaced_um"))
    if not (profile or runout or shift):
        return machine
    bodies = dict.fromkeys(dof.partition(".")[0] for dof in machine.dofs)
    drivers = [name for name in bodies if name in ("sun", "sun2", "pinion", "sunL", "sunR")]
    moved = [name for name in bodies if name in ("planet1", "b1", "wheel", "planet1L", "planet1R")]
    mesh = next(m for m in machine.meshes if any(m.row[machine.dofs.index(f"{name}.x")] for name in drivers))
    turning = abs(mesh.frequency) / mesh.teeth[0]  # relative to the carrier
    place = {name: (shift, 0.0) for name in moved} if shift else None
    return with_errors(machine, profile=profile, runout={name: (runout, turning, 0.0) for name in drivers}, place=place)


def _impact_stage(scene, case, speed):
    chosen = {name: scene.pairs[name] for name in ("sun_planet", "planet_ring")}
    for name, one in chosen.items():
        if name != "sun_planet" and pits_of(one.damage.get(case, {})):
            raise ValueError("the impact law knows pits of the sun only: use contact = 'linear'")
    found = pits_of(chosen["sun_planet"].damage.get(case, {}))
    materials = {name: one.materials for name, one in chosen.items()}
    return impact_planetary(_stage(scene, scene.machine["n_planets"]), materials, found, scene.machine, speed)


def _impact_pair(scene, case, speed):
    chosen = scene.pair()
    return impact_helical(chosen.pair, chosen.materials, pits_of(chosen.damage.get(case, {})), scene.machine, speed)


def curves(pair, case, options):
    """Curve of a scene's pair over one cycle, and that of its damaged tooth's engagement (None if healthy), by one method."""
    damage = pair.damage.get(case, {})
    if options["method"] == "auto" and any(isinstance(one, Pit) or not one.through for found in damage.values() for one in found):
        options = options | {"method": "ritz3d"}
    healthy = mesh_stiffness(**pair.case(), **options)
    return healthy, mesh_stiffness(**pair.case(case), **options, span="tooth") if damage else None


def _both(scene, case, options, kinds):
    """Healthy curves by kind of mesh, and damage of the sun's tooth 0, from ``kinds[kind]``, a scene pair's name."""
    for kind, name in kinds.items():
        if case in scene.pairs[name].damage and not kind.startswith("sun"):
            raise ValueError(f"case {case!r} damages {name}, but in this machine only the sun has damage: use its cases")
    found = {name: curves(scene.pairs[name], case, options) for name in dict.fromkeys(kinds.values())}
    healthy = {kind: found[name][0] for kind, name in kinds.items()}
    hurt = {kind: found[name][1] for kind, name in kinds.items() if found[name][1] is not None}
    return healthy, hurt


def _stage(scene, n):
    outer, inner = scene.pairs["sun_planet"].pair, scene.pairs["planet_ring"].pair
    return PlanetarySet(outer.gear_1, outer.gear_2, inner.gear_2, n, outer.a)


def _planetary(scene, case, speed, torque, options):
    kinds = {"sun_planet": "sun_planet", "planet_ring": "planet_ring"}
    healthy, hurt = _both(scene, case, options, kinds)
    damage = {"sun": (0, hurt)} if hurt else None
    stage = _stage(scene, scene.machine["n_planets"])
    return pitted_planetary(stage, healthy, damage=damage, speed=speed, torque=torque, zeta=0.02)


def _compound(scene, case, speed, torque, options):
    kinds = {"sun1_p": "sun_planet", "p_ring": "planet_ring_1", "sun2_b": "sun_planet", "b_c": "planet_planet"}
    kinds["c_ring"] = "planet_ring_2"
    healthy, hurt = _both(scene, case, options, kinds)
    damage = {"sun2": (0, {"sun2_b": hurt["sun2_b"]})} if hurt else None
    pairs = {kind: scene.pairs[name].pair for kind, name in kinds.items()}
    n = scene.machine["n_planets"]
    return compound_planetary(healthy, pairs=pairs, damage=damage, speed=speed, torque=torque, n_planets=n)


def _pair(scene, case, speed, torque, options):
    chosen = scene.pair()
    healthy, hurt = curves(chosen, case, options)
    bodies = []
    for name, gear in (("pinion", chosen.pair.gear_1), ("wheel", chosen.pair.gear_2)):
        made = disc(gear, DENSITY, 0.0)
        bodies.append(Body(name, made.mass, made.inertia, "x y z theta"))
    damage = () if hurt is None else (ToothDamage(0, 0, hurt),)
    settings = {"support": BEARING, "torsion": (1e4, 0.0), "damage": damage}
    return gear_pair(chosen.pair, bodies, healthy, speed=speed, torque=torque, **settings)


def _herringbone(scene, case, speed, torque, options):
    halves = {}
    for name, one in scene.pairs.items():
        width = (min(one.pair.gear_1.b, one.pair.gear_2.b) - one.groove) / 2
        gears = (replace(gear, b=width) for gear in (one.pair.gear_1, one.pair.gear_2))
        halves[name] = replace(one, pair=GearPair(*gears, one.pair.a), force=one.force / 2, face="helical", groove=0.0)
    half = replace(scene, pairs=halves)
    healthy, hurt = _both(half, case, options, {"sun_planet": "sun_planet", "planet_ring": "planet_ring"})
    damage = {"sun": (0, hurt)} if hurt else None
    return herringbone_planetary(_stage(half, scene.machine["n_planets"]), healthy, damage=damage, speed=speed, torque=torque)

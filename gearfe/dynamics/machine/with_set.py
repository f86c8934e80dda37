"""Dynamic model with the mesh stiffnesses of a planetary set. No deflection is counted twice."""

import math
from dataclasses import replace
from typing import Any

import numpy as np

from ...core.units import NEWTON_PER_UM
from ...geometry.aliases import Floats
from ...geometry.damage.missing import missing_teeth
from ...geometry.renamed import warn_renamed
from ...planetary_sets.added import AddedCompliance, cycles_of
from ...planetary_sets.curves import SetCurves
from ...planetary_sets.rim_supports import RimBed, RimSupports
from .mesh_excitation import harmonics
from .springs import Spring
from .tables import Machine

NAMES = ("sun_planet{}", "planet_ring{}")
RINGS = ("lumped", "body")
BODY, AXES = "ring", ("x", "y", "theta")
EVEN = 1e-6  # tolerance for equally spaced positions [mesh cycles]
SAME = 1e-6  # relative tolerance of radii and directions
PERFECT = 1e-12  # Smaller gaps are rounding errors [m].


def with_set(machine: Machine, curves: SetCurves, *, ring: str) -> Machine:
    """Return the machine with the mesh stiffnesses of a planetary set, one curve for each mesh of each planet.

    `SetCurves.k` contains the deflection of a mesh without the rotations and shifts of sun and planet. Rotations, pins and a
    floating sun are therefore those of the machine, and its bearings of planets and sun should be those of the set. The motion
    of the ring is part of k or of the machine. In both cases, the rotation of its sun under the torque of the set equals that
    of the set.

    Parameters
    ----------
    machine : Machine
        With a mesh for each planet of the set, seen from the carrier, as `planetary`, `pitted_planetary` and `build_machine`
        make them; without damage.
    curves : SetCurves
        Over whole mesh cycles at equally spaced positions, as many as the set takes to repeat.
    ring : {"lumped", "body"}
        ``"lumped"``: k contains all deflections of the ring gear and its supports. The ring and its inertia are removed from the
        machine. ``"body"``: the ring is a body of the machine. On an elastic bed or elastic pads its springs are those of a rigid
        ring, and their deflection under the set's loads is removed from k. The rest in k is the bending of teeth and ring, also
        between the pads. A ring that is held, or on rigid pads, has no such motion: all of it stays in k, and the springs of the
        machine's ring are those of its housing, in series with it.

    Returns
    -------
    Machine
        Its meshes contain the errors of modified flanks and pin positions. Meshes whose curves last several mesh cycles have the
        `frequency` of one period of their curve. Unloaded meshes (k = 0) carry no force.

    Raises
    ------
    ValueError
        If machine and set do not fit each other; the message states what to change.

    Notes
    -----
    k is valid for the loads of the set's solution. The coupling of planets by the torsion of the sun and the bending of the ring
    is in the k of each mesh under those loads. A machine couples its meshes by its bodies only. Loads that planets share in
    another way, as in vibration, therefore act on a k that is not exact. Teeth in contact at a tip corner, off the line of
    action, rotate the ring by some per cent less than the row of a mesh gives. On very soft springs more than all deflections of
    the set would then be removed, which is an error.
    """
    if ring == "in k":
        warn_renamed('ring = "in k"', '"lumped"')
        ring = "lumped"
    if ring not in RINGS:
        raise ValueError(f"ring = {ring!r}, but give 'lumped' (its motion is part of k) or 'body' (of the machine)")
    cycles, case = _cycles(curves), curves.meta["case"]
    if any(missing_teeth(case.gear_of(name), own) for name, own in case.damage.items()):
        raise ValueError(
            "a missing tooth opens meshes, but a linear stiffness stays closed: give the damage to the machine, without a set"
        )
    at = _places(machine, case)
    machine = _still(machine) if ring == "lumped" else _on_springs(machine, case)
    k = curves.k if ring == "lumped" else _without_body(machine, curves, at[1])
    first, meshes = machine.meshes[at[0][0]], list(machine.meshes)
    phase = (first.phase - float(curves.position[0])) / cycles
    for inner, row in enumerate(at):
        for planet, number in enumerate(row):
            mesh, gap = meshes[number], curves.gap[inner, :, planet]
            moved = replace(mesh, stiffness=k[inner, :, planet], frequency=first.frequency / cycles, phase=phase)
            if np.abs(gap).max() > PERFECT:
                moved = replace(moved, error=(*mesh.error, *harmonics(gap, moved.frequency, phase)))
            meshes[number] = moved
    notes = machine.notes | {"meshes of a set": repr(curves), "motion of the ring": ring}
    return replace(machine, meshes=tuple(meshes), notes=notes)


def with_added(machine: Machine, added: AddedCompliance) -> Machine:
    """Return a machine of isolated pairs with the additional compliance of the set, in healthy and damaged teeth alike.

    Stiffness and damage may be of any kind, and of any method that gives curves or force laws. `notes` has both mean stiffnesses.
    """
    meshes = {mesh.name: mesh for mesh in machine.meshes}
    first = meshes[NAMES[0].format(1)].phase
    for kind, name in enumerate(NAMES):
        for planet in range(added.added.shape[2]):
            mesh = meshes[name.format(planet + 1)]

            def inside(curve, mesh=mesh, at=(kind, planet)):
                return curve.with_compliance(added.at(*at, curve.phase - mesh.phase + first))

            damage = tuple(replace(one, curve=inside(one.curve)) for one in mesh.damage)
            meshes[mesh.name] = replace(mesh, stiffness=inside(mesh.stiffness), damage=damage)
    out = replace(machine, meshes=tuple(meshes.values()))
    firsts = [list(meshes).index(name.format(1)) for name in NAMES]
    told = {
        f"mean stiffness {where} [N/um]": dict(zip(added.pairs, one.mean_stiffness()[firsts] / NEWTON_PER_UM, strict=True))
        for where, one in (("in the set", out), ("of isolated pairs", machine))
    }
    return replace(out, notes=machine.notes | told)


def _cycles(curves):
    """Return the number of mesh cycles that the positions cover.

    ValueError unless the positions are equally spaced over whole periods of the set.
    """
    at = curves.position
    step = np.ptp(at) / max(at.size - 1, 1)
    cycles = round(at.size * step)
    if not cycles or not np.allclose(np.diff(at), step, rtol=0, atol=EVEN) or abs(at.size * step - cycles) > EVEN:
        raise ValueError(
            f"{at.size} positions of the set are not equally spaced over whole mesh cycles: give their number, n >= 2"
        )
    needed = cycles_of(curves.meta["case"])
    if cycles % needed:
        raise ValueError(
            f"positions over {cycles} mesh cycles, but this set repeats after {needed}: "
            f"give planetary_stiffness(case, n, cycles={needed})"
        )
    return cycles


def _places(machine, case):
    """Return the numbers of the machine's meshes by ``[inner][planet]``, after checks that they agree with the set."""
    own = {mesh.name: number for number, mesh in enumerate(machine.meshes)}
    out: list[list[int]] = []
    for name, pair, back in zip(NAMES, case.pairs, (1, -1), strict=True):
        asked = [name.format(planet + 1) for planet in range(case.planets)]
        lost = [one for one in asked if one not in own]
        if lost or name.format(case.planets + 1) in own:
            raise ValueError(
                f"the set has {case.planets} planets, but the machine has the meshes {', '.join(own)}: give both the same number"
            )
        for one, angle in zip(asked, case.planet_angles, strict=True):
            _check(machine, machine.meshes[own[one]], pair, angle + back * (math.pi / 2 - pair.alpha_wt))
        out.append([own[one] for one in asked])
    return out


def _check(machine, mesh, pair, direction):
    """Raise ValueError unless a mesh is undamaged, and has the base radii of `pair` and the line of action `direction` [rad]."""
    turns, along, across = (
        [mesh.row[i] for i, dof in enumerate(machine.dofs) if dof.endswith(f".{axis}")] for axis in ("theta", *"xy")
    )
    want = 1e-3 * np.array([pair.gear_1.r_b, pair.gear_2.r_b])
    radii = np.abs([one for one in turns if one])
    if not np.isclose(radii[:, None], want, rtol=SAME, atol=0).any(axis=1).all():
        told = (", ".join(f"{1e3 * one:.6g}" for one in found) for found in (radii, want))
        raise ValueError("mesh {} has base radii of {} mm, but in the set of {} mm".format(mesh.name, *told))
    if any(abs(x * math.sin(direction) - y * math.cos(direction)) > SAME for x, y in zip(along, across, strict=True)):
        raise ValueError(
            f"mesh {mesh.name} has another direction than in the set: build the machine with the planet_angles of the set"
        )
    if mesh.damage:
        raise ValueError(f"mesh {mesh.name} is damaged: give the damage to the PlanetaryCase, and a healthy machine")


def _still(machine):
    """Return the machine without the degrees of freedom of its ring."""
    turn = f"{BODY}.theta"
    if turn not in machine.dofs:
        raise ValueError(f"the machine has no body {BODY!r}: give ring = 'body'")
    place = machine.dofs.index(turn)
    if not machine.K[place, place] > 0:
        raise ValueError("the ring of this machine rotates freely, but a lumped ring is fixed: give ring = 'body'")
    stays = np.array([not dof.startswith(f"{BODY}.") for dof in machine.dofs])

    def cut(rows):
        return tuple(replace(one, row=one.row[stays]) for one in rows if one.row[stays].any())

    meshes = [replace(one, friction=tuple((row[stays], weight) for row, weight in one.friction)) for one in machine.meshes]
    return replace(
        machine,
        dofs=tuple(np.array(machine.dofs)[stays].tolist()),
        mass=machine.mass[stays],
        springs=cut(machine.springs),
        meshes=cut(meshes),
        loads=cut(machine.loads),
        rotors={name: speed for name, speed in machine.rotors.items() if name != BODY},
    )


def ring_springs(case: Any) -> Floats:
    """Stiffness of a rigid ring on the bed or pads of a `PlanetaryCase` in x, y and rotation [N/m, N m/rad] (inf if rigid).

    For n pads of radial stiffness k_r and tangential stiffness k_t these are ``n (k_r + k_t) / 2`` and ``n k_t R**2``. For a bed,
    n is its length.
    """
    ring, radius = case.ring, float(case.ring_gear.held)
    if isinstance(ring, RimBed):
        n = 2 * math.pi * radius * case.width
    elif isinstance(ring, RimSupports):
        n = float(ring.count)
        if ring.pushes or ring.count < 3:
            raise ValueError("unilateral lugs, or fewer than 3 pads, are not linear springs of a body: give ring = 'lumped'")
    else:
        return np.full(3, math.inf)
    across = 1e3 * n * (ring.radial + ring.tangential) / 2
    return np.array([across, across, 1e-3 * n * ring.tangential * radius**2])


def _on_springs(machine, case):
    """Return the machine with its ring on the springs of the set. The damping ratios are kept.

    Rigid supports keep its springs.
    """
    springs = list(machine.springs)
    for axis, k in zip(AXES, ring_springs(case), strict=True):
        dof = f"{BODY}.{axis}"
        if dof not in machine.dofs or math.isinf(k):
            continue
        row, place = machine.row(dof), machine.dofs.index(dof)
        old = [one for one in springs if one.row[place]]
        if any((one.row != row).any() for one in old):
            raise ValueError(f"the ring of the machine has springs to other bodies: {', '.join(one.name for one in old)}")
        damping = sum(one.c for one in old) * math.sqrt(k / sum(one.k for one in old)) if old else 0.0
        springs = [one for one in springs if not one.row[place]] + [Spring(f"{BODY}-ground {axis}", row, float(k), damping)]
    return replace(machine, springs=tuple(springs))


def _without_body(machine, curves, inner):
    """Return `SetCurves.k` without the deflection of the ring's springs. `inner` are the numbers of the ring's meshes."""
    place = [machine.dofs.index(f"{BODY}.{axis}") for axis in AXES if f"{BODY}.{axis}" in machine.dofs]
    gives = 1 / ring_springs(curves.meta["case"])[[AXES.index(machine.dofs[i].split(".")[1]) for i in place]]
    rows = np.array([machine.meshes[number].row[place] for number in inner])
    moved = curves.force[1] @ (rows * gives) @ rows.T
    with np.errstate(divide="ignore", invalid="ignore"):
        left = np.where(curves.k[1] > 0, curves.force[1] / curves.k[1] - moved, 1.0)
        if (left <= 0).any():
            raise ValueError("the springs of the ring deflect a mesh more than the whole set does: give ring = 'lumped'")
        return np.array([curves.k[0], np.where(curves.k[1] > 0, curves.force[1] / left, 0.0)])

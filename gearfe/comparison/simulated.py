"""Simulated records of the machine of a scene, healthy and damaged."""

import math
from dataclasses import replace
from numbers import Real

import numpy as np

from ..core.steps import part, steps
from ..dynamics.machine.lines import DIGITS, gear_lines
from ..dynamics.machine.of_scene import build_machine, flat_machine
from ..dynamics.motion import run_checks
from ..dynamics.motion.propagator import cycle_rate
from ..dynamics.motion.reference import SOLVERS
from ..dynamics.motion.response import Response
from ..dynamics.motion.step_control import default_step
from .record_length import resolving_seconds
from .settled import recorded

DURATIONS = (1.0, 5.0)  # shortest and longest default record [s]
RANGE = 1e-4  # Smaller lines, relative to the RMS value, are below the dynamic range of recorders (80 dB; 16 bits have 96 dB).


def responses(scene, case=None, *, duration=None, channel=None, method="fast", phases=64, loads=(1.0,), progress=None):
    """Return the `Response` of a scene's machine by case: ``"healthy"`` and, on request, a case of damage.

    `duration` [s] begins when the free vibrations have decayed to a thousandth (`recorded`). By default it resolves the
    sidebands of the damage, within the limits `DURATIONS`. A `channel` that does not exist raises ValueError before the run.
    `phases` are those of the stiffness curves, per mesh cycle. `gearfe.build_machine` describes `loads`, `gearfe.simulate`
    `method` and `progress`.
    """
    check_run(DURATIONS[0] if duration is None else duration, method)
    if channel is not None:
        channel_unit(flat_machine(scene), channel)
    scene.check_case(case)
    if duration is not None:
        check_length(scene, duration)
    in_case = [one for pair in scene.pairs.values() for damages in pair.damage.get(case, {}).values() for one in damages]
    section = scene.machine.get("contact") == "impact" or all(hurt.through for hurt in in_case)
    curves = "auto" if section else "ritz3d"  # One method must be used for all compared cases.
    names = ("healthy", case) if case else ("healthy",)
    with part("", 0.0, 0.5):
        machines = {
            name: build_machine(scene, None if name == "healthy" else name, phases=phases, method=curves, loads=loads)
            for name in steps(names, lambda name: f"stiffness curves, {name}")
        }
    if duration is None:
        duration = resolving_duration(list(machines.values())[-1])
    rate = math.ceil(duration / min(default_step(one) for one in machines.values())) / duration
    with part("", 0.5, 1.0):
        return {
            name: recorded(machines[name], duration, rate, method=method, progress=progress)
            for name in steps(names, lambda name: f"motion, {name}")
        }


def resolving_duration(machine):
    """Length [s] of a record that resolves the sidebands of a machine's damage, within `DURATIONS`."""
    _, fault, turning, carrier = fault_lines(machine)
    needed = resolving_seconds(fault, turning, carrier)
    return min(max(DURATIONS[0], math.ceil(10 * needed) / 10), DURATIONS[1])


def channel_unit(machine, channel):
    """Return the unit of a channel. Raises ValueError if responses of the machine have no such channel."""
    n = 2 * len(machine.dofs)
    return Response(machine, np.empty(0), np.empty((0, n)), np.eye(n)).unit(channel)


def check_run(duration, method="fast"):
    """Raise ValueError for an invalid duration or method of a run, before curves are computed for it."""
    if isinstance(duration, bool) or not isinstance(duration, Real) or not 0 < duration < math.inf:
        raise ValueError(f"duration = {duration!r} s, but it must be positive and finite")
    if method != "fast" and method not in SOLVERS:
        raise ValueError(f"method = {method!r}, but it must be 'fast' or one of {', '.join(SOLVERS)}")


def check_length(scene, duration):
    """Raise ValueError for a record of `duration` [s] that no step or memory permits, before curves are computed for it.

    The steps counted resolve the mesh cycles alone, so that a record that fits is never rejected.
    """
    machine = flat_machine(scene)
    rate = max(cycle_rate(machine), 1 / duration)
    run_checks.check_run(duration, rate=rate)
    run_checks.check_memory(machine, duration, duration * rate, True)


def fault_lines(machine):
    """Return the stage of the first faulty gear (default: last), and its fault, shaft and carrier frequency [Hz] or None."""
    if not machine.stages:
        raise ValueError("the machine has no stages, so that its spectral lines are unknown: give stages=(Stage(...),)")
    main = machine.faults[0] if machine.faults else None
    stage = machine.stages[-1] if main is None else machine.stage_of(main.gear)
    if main is None:
        return stage, None, None, stage.carrier
    several = main.frequency if main.frequency > main.turning * (1 + 1e-9) else None
    return stage, several, main.turning, stage.carrier


def simulated_gear(scene, case, gear, duration=None):
    """Return the mesh force of a gear of a scene as `Signal` by case, with the angle of the gear's shaft.

    The cases are healthy and `case`. White noise of `RANGE` of the rms is added, as in any recorder. Without noise the
    difference signal of a healthy gear would contain only interpolation errors.
    """
    lines, found = gear_lines(scene, gear), responses(scene, case, duration=duration)
    machine = list(found.values())[-1].machine
    hurt = {one.gear for one in machine.faults}
    meshes = [one for one in machine.meshes if abs(abs(one.frequency) / lines.mesh - 1) < 1e-6]
    named = [lines.body] if lines.body in hurt or gear not in scene.gears else [one for one in hurt if one.rstrip(DIGITS) == gear]
    mesh = next((one for body in named for one in meshes if body in one.name), meshes[0])
    channel = f"force {mesh.name}"
    out, noise = {}, np.random.default_rng(0)
    for name, one in found.items():
        signal = one.signal(channel, lines.turning)
        values = signal.values + RANGE * signal.values.std() * noise.standard_normal(signal.values.size)
        out[f"simulated {name}"] = replace(signal, values=values, name=f"simulated {name}")
    return out

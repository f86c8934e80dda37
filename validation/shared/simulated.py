"""Records of the machines of the scenes after their transient, at the sampling rates of the articles."""

import math
from dataclasses import replace
from functools import cache

import numpy as np

import gearfe as gf
from gearfe.dynamics.machine.loads import pulses
from gearfe.dynamics.motion.step_control import default_step
from gearfe.dynamics.motion.thinned import REACH

PHASES = {"herringbone": 32}  # phases per mesh cycle, fewer for smooth stiffness curves


def by_name(*functions):
    """Return functions by name. The names are ids of references."""
    return {one.__name__: one for one in functions}


@cache
def scene(name):
    """Return a built-in scene."""
    return gf.load_scene(name)


@cache
def machine(name, case=None, method="ritz3d"):
    """Return the machine of a scene in a case of damage. All compared machines use one method."""
    return gf.build_machine(scene(name), case, method=method, phases=PHASES.get(name, 64))


@cache
def own_law(name, case=None, *, pulsed=True):
    """Return the machine of a scene under the impact law of its article.

    If `pulsed`, the carrier has the torque pulses that the scene states.
    """
    table = dict(scene(name).machine)
    if not pulsed:
        table["impact"] = {key: value for key, value in table["impact"].items() if not key.startswith("pulse")}
    return gf.build_machine(replace(scene(name), machine=table | {"contact": "impact"}), case)


@cache
def periodic(name, case=None, method="ritz3d"):
    """Return displacements and velocities at the start of a period of the steady motion, or None if none is found."""
    try:
        found = gf.steady_state(machine(name, case, method)).response
    except RuntimeError:
        return None
    return found.q[0], found.v[0]


def record(made, seconds, rate, settle, start=None):
    """Return the response of `made` after the time `settle`, `seconds` long, at `rate` samples per second."""
    options = {}
    if (made.law["power"] == 1).all():  # With linear contact no step is halved.
        options["step"] = 1 / rate / math.ceil(1 / rate / default_step(made) * (1 - 1e-9))
    whole = gf.simulate(made, settle + seconds + REACH / rate, rate=rate, initial=start, **options)
    first = math.ceil(settle * rate - 1e-6)
    return whole.part(slice(first, first + round(seconds * rate)))


def signal(response, channel):
    """Return a channel as a signal."""
    rate = 1 / float(response.time[1] - response.time[0])
    return gf.Signal(np.asarray(response[channel], dtype=float), rate, response.unit(channel), channel)


def spectrum(one):
    """Return the amplitude spectrum of the oscillation about the mean."""
    return gf.spectrum(replace(one, values=one.values - one.values.mean()))


def noisy(one, level):
    """Return the signal with Gaussian noise of `level` times its standard deviation."""
    noise = level * one.values.std() * np.random.default_rng(0).standard_normal(one.values.size)
    return replace(one, values=one.values + noise)


def amplitude(found, frequency, tolerance=None):
    """Return the amplitude of a spectrum near a frequency."""
    return gf.find_lines(found, {"line": frequency}, tolerance)["line"][1]


def knocked(made, load, options, seconds):
    """Return the machine with the pulses of a scene's ``[machine.impact]`` table, which increase the magnitude of `load`."""
    count, loads = math.ceil(seconds / options["pulse_period_s"]), []
    for one in made.loads:
        if one.name == load:
            base = float(one.value)
            peak = base + math.copysign(options["pulse_Nm"], base)
            train = pulses(
                base, peak, options["pulse_period_s"], options["pulse_width_s"], count, start=options["pulse_period_s"]
            )
            one = replace(one, value=train)
        loads.append(one)
    return replace(made, loads=tuple(loads))


def told(response):
    """Return the settings of a simulation in one sentence."""
    made, time = response.machine, response.time
    step, law = float(time[1] - time[0]), made.law
    impact = law["power"] != 1
    power = f"exponent {law['power'].max():g}"
    parts = [f"impact law, {power}, STEP damping" if impact.any() else "linear stiffness curves"]
    rubbed = sum(bool(mesh.friction) for mesh in made.meshes)
    parts += [f"Coulomb friction in {rubbed} meshes"] if rubbed else []
    play = {f"{1e6 * one:g}" for one in law["backlash"] if math.isfinite(one) and one > 0}
    parts.append(f"backlash {', '.join(sorted(play))} um" if play else "meshes never open")
    sizes = sorted({f"{1e6 * size:.3g} um at {f:.4g} Hz" for mesh in made.meshes for size, f, _ in mesh.error})
    parts += [f"errors in the meshes of {', '.join(sizes)}"] if sizes else []
    for load in made.loads:
        parts += [_pulsed(load)] if np.ndim(load.value) and not callable(load.value) else []
    parts.append(f"{step * len(time):.4g} s after {float(time[0]):.4g} s, {1 / step:.6g} samples per second")
    return "; ".join(parts)


def _pulsed(load):
    times, values = load.value
    height, period, width = abs(values[1] - values[0]), times[4] - times[0], times[3] - times[0]
    return f"pulses of {height:g} N m for {1e3 * width:g} ms every {period:g} s on the {load.name}"

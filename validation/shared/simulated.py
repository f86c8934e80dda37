"""Records of the machines of the scenes: the motion once settled, sampled as the articles sample it."""

import math
from dataclasses import replace
from functools import cache

import numpy as np

import gearfe as gf
from gearfe.machine.tables import pulses
from gearfe.motion.simulate import default_step

PHASES = {"herringbone": 32}  # per mesh cycle of its stiffness curves, which are smooth


@cache
def scene(name):
    """A built-in scene."""
    return gf.load_scene(name)


@cache
def machine(name, case=None, method="ritz3d"):
    """Machine of a scene in a case of damage; one method for all that is compared."""
    return gf.build_machine(scene(name), case, method=method, phases=PHASES.get(name, 64))


@cache
def periodic(name, case=None, method="ritz3d"):
    """Displacements and velocities at the start of a period of the steady motion, None if none is found."""
    try:
        found = gf.steady_state(machine(name, case, method)).response
    except RuntimeError:
        return None
    return found.q[0], found.v[0]


def record(made, seconds, rate, settle, start=None):
    """Response of `made` from `settle` on, `seconds` long, `rate` samples per second; `start` as of `gearfe.simulate`."""
    finer = math.ceil(1 / rate / default_step(made))
    whole = gf.simulate(made, settle + seconds, dt=1 / rate / finer, every=finer, initial=start)
    kept = whole.time >= settle - 1e-9
    count = round(seconds * rate)
    return replace(whole, time=whole.time[kept][:count], states=whole.states[kept][:count])


def signal(response, channel, name=None):
    """A channel as a signal."""
    rate = 1 / float(response.time[1] - response.time[0])
    return gf.Signal(np.asarray(response[channel], dtype=float), rate, response.unit(channel), name or channel)


def spectrum(one):
    """Amplitude spectrum of the oscillation about the mean."""
    return gf.spectrum(replace(one, values=one.values - one.values.mean()))


def noisy(one, level, seed=0):
    """The signal with Gaussian noise of `level` times its standard deviation."""
    noise = level * one.values.std() * np.random.default_rng(seed).standard_normal(one.values.size)
    return replace(one, values=one.values + noise)


def amplitude(found, frequency, tolerance=None):
    """Amplitude of a spectrum near a frequency."""
    return gf.find_lines(found, {"line": frequency}, tolerance)["line"][1]


def knocked(made, load, *, height, period, width, seconds):
    """The machine with pulses on the load named `load`: `height` times its steady value more, every `period` [s]."""
    loads = []
    for one in made.loads:
        if one.name == load:
            base = float(one.value)
            train = pulses(base, base * (1 + height), period, width, math.ceil(seconds / period), start=period / 2)
            one = replace(one, value=train)
        loads.append(one)
    return replace(made, loads=tuple(loads))

"""Records of the machines of the scenes after their transient, at the sampling rates of the articles."""

import math
from dataclasses import replace
from functools import cache

import numpy as np

import gearfe as gf
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


def amplitude(found, frequency, tolerance=None):
    """Return the amplitude of a spectrum near a frequency."""
    return gf.find_lines(found, {"line": frequency}, tolerance)["line"][1]


class Heard:
    """Signals of a machine by its cases, and their spectra, each computed once."""

    def __init__(self, source, through, added=None, quiet=None):
        """Store where the signals come from.

        Parameters
        ----------
        source : callable
            Response or signal of a case.
        through : callable
            Signal of what `source` returns.
        added : callable, optional
            Noise of a case and a number of samples, in standard deviations of the signal of the case `quiet`.
        quiet : hashable
        """
        self.clean = cache(lambda case: through(source(case)))
        self.added, self.quiet = added, quiet
        self.spectrum = cache(lambda case: spectrum(self(case)))

    def __call__(self, case):
        """Signal of a case with its noise."""
        one = self.clean(case)
        if self.added is None:
            return one
        noise = self.clean(self.quiet).values.std() * self.added(case, one.values.size)
        return replace(one, values=one.values + noise)

    def line(self, case, frequency, tolerance=None):
        """Amplitude of a line."""
        return amplitude(self.spectrum(case), frequency, tolerance)

    def sidebands(self, case, mesh, fault):
        """Mean amplitude of both lines `fault` from a line `mesh` [Hz]."""
        return (self.line(case, mesh - fault) + self.line(case, mesh + fault)) / 2

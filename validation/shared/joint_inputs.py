"""Joint draws of the inputs that the articles do not print: ranges, draws, and machines changed by a draw."""

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy.stats import qmc

DRAWS, SEED = 20, 31
SUPPORTS = {"load": (0.25, 4.0), "supports": (0.1, 10.0), "drive": (0.1, 10.0), "damping": (0.5, 5.0), "noise": (1e-3, 1.0)}
MODE = {"mode_over_f_m": (0.3, 5.0), "mode_damping": (0.01, 0.1)}
RANGES = {  # by page: limits of each input, drawn uniformly in the logarithm
    "planetary_pitting": SUPPORTS | {"pulses": (0.25, 4.0), "play": (0.1, 2.0), "path": (0.01, 100.0)},
    "compound_planetary": SUPPORTS | {"mesh_damping": (0.2, 5.0), "play": (0.1, 2.0)} | MODE,
    "helical_pitting": SUPPORTS | {"mesh_damping": (0.1, 10.0), "play": (0.1, 2.0)} | MODE,
    "herringbone_machine": SUPPORTS
    | {"mesh_damping": (0.2, 2.0), "groove": (0.1, 10.0), "errors": (0.1, 3.0), "play": (0.1, 2.0)}
    | MODE,
}
MEANT = {
    "load": "torque",
    "supports": "bearings",
    "drive": "shaft to the motor",
    "damping": "damping ratio of supports",
    "noise": "noise, of the signal's standard deviation",
    "pulses": "pulses, of the load",
    "play": "backlash",
    "path": "foundation under the ring, to the sensor",
    "mesh_damping": "damping of meshes",
    "groove": "stiffness of the groove",
    "errors": "errors of the meshes",
    "mode_over_f_m": "mode of the housing, of f_m",
    "mode_damping": "its damping ratio",
}


@dataclass(frozen=True, slots=True)
class Draw:
    """One draw of the inputs of a page: names and values. Caches of records use it as key."""

    page: str
    number: int
    values: tuple[tuple[str, float], ...]

    def __getitem__(self, name):
        return dict(self.values).get(name, 1.0)


def draws(page):
    """Return `DRAWS` points of a Latin hypercube over the logarithmic ranges of the inputs of a page."""
    low, high = (np.log([ends[i] for ends in RANGES[page].values()]) for i in (0, 1))
    cube = qmc.LatinHypercube(low.size, rng=np.random.default_rng(SEED)).random(DRAWS)
    values = np.exp(low + cube * (high - low))
    return [Draw(page, i, tuple(zip(RANGES[page], map(float, one), strict=True))) for i, one in enumerate(values)]


def changed(made, draw):
    """Return the machine with the loads, springs, damping, errors and backlash of a draw. Stiffness curves are unchanged."""
    springs = []
    for one in made.springs:
        word = one.name.rpartition(" ")[2]
        factor = draw["groove"] if " groove " in one.name else draw["drive"] if word == "theta" else draw["supports"]
        springs.append(replace(one, k=factor * one.k, c=math.sqrt(factor) * draw["damping"] * one.c))
    meshes = []
    for one in made.meshes:
        more = {name: draw["mesh_damping"] * getattr(one, name) for name in ("damping", "damping_per_stiffness", "zeta")}
        error = tuple((draw["errors"] * size, frequency, angle) for size, frequency, angle in one.error)
        meshes.append(replace(one, error=error, backlash=draw["play"] * one.backlash, **more))
    loads = tuple(replace(one, value=_loaded(one.value, draw)) for one in made.loads)
    return replace(made, springs=tuple(springs), meshes=tuple(meshes), loads=loads)


def _loaded(value, draw):
    if np.ndim(value) == 0:
        return draw["load"] * value
    times, values = value
    return times, draw["load"] * (values[0] + draw["pulses"] * (np.asarray(values) - values[0]))


def adding(draw, channel):
    """Return the noise of a draw on a channel for `simulated.Heard`, its own for each case. None without a draw."""
    if draw is None:
        return None

    def noise(case, count):
        name = " ".join(map(str, case)) if isinstance(case, tuple) else case
        return draw["noise"] * np.random.default_rng([SEED, draw.number, *f"{name} {channel}".encode()]).standard_normal(count)

    return noise


def through_mode(one, draw, mesh):
    """Return a signal transmitted through a housing with one mode: the steady response to each line of a periodic record."""
    frequency = np.fft.rfftfreq(one.values.size, 1 / one.rate) / (draw["mode_over_f_m"] * mesh)
    answer = 1 / (1 - frequency**2 + 2j * draw["mode_damping"] * frequency)
    return replace(one, values=np.fft.irfft(answer * np.fft.rfft(one.values), one.values.size))

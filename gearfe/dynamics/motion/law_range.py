"""Check of the loads in a run against those of a force law or stiffness curve, and interpolation error between its phases."""

import math
import warnings
from dataclasses import replace

import numpy as np
import scipy

from ...stiffness.curve import StiffnessCurve
from ...stiffness.finer import repeated
from ..machine.force_law import ForceLaw
from ..machine.mesh_curves import ALIKE, FINE, changed, cycle_table

LOOKS = 20_000  # number of times at which mesh forces are compared with the loads of their laws
# least number of samples of a stretch over which forces are averaged (at least one mesh cycle), and most stretches
LEAST, PARTS = 40, 50
OTHER = 0.1  # relative difference between mean force and the curve's load that is reported
IDLE = 1e-3  # Meshes with a smaller mean force, relative to the curve's load, count as unloaded.
FEWEST = 10  # least number of samples of a stiffness whose interpolation error is reported
NEARLY = 0.01  # Loads that change the stiffness by less than this part are within the range of a curve.


def compared(response):
    """Compare mesh forces with the loads of their curves and laws. Return the response with the result in `stats`.

    ``stats["loads"]`` lists the meshes whose forces are outside the loads of the law. A warning names forces above a law.
    ``stats["error_phases"]`` is the result of `between_phases`, if stiffnesses are functions of the phase only.

    The forces are compared at `LOOKS` random times of the run, because equal steps can coincide with one position of every
    vibration. For a stiffness over the phase, the forces are averaged over segments of one mesh cycle or more. A load that
    varies slowly can differ from that of the curve although its mean over the run does not.
    """
    machine = response.machine
    between = between_phases(machine)
    if between is not None:
        response = replace(response, stats=response.stats | {"error_phases": between})
    if not any(isinstance(mesh.stiffness, (ForceLaw, StiffnessCurve)) for mesh in machine.meshes):
        return response
    some = response.raw.part(_looks(len(response.time)))
    told = {"above": [], "other": []}
    for mesh, own in zip(machine.meshes, some.mesh().T, strict=True):
        given, most = mesh.stiffness, float(np.abs(own).max())
        if isinstance(given, ForceLaw) and most > given.load[-1]:
            told["above"].append(f"{mesh.name} {most:.4g} N, its force law up to {given.load[-1]:.4g} N")
        if isinstance(given, StiffnessCurve) and "force_N" in given.meta:
            told["other"] += _other(mesh, own, some.time[-1] - some.time[0])
    if told["above"]:
        warnings.warn(
            f"forces above the loads solved: {'; '.join(told['above'])}. Beyond them a law continues with its tangent: give it "
            "larger loads (gf.force_law, or loads= of gf.build_machine)",
            stacklevel=4,
        )
    found = [*told["above"], *told["other"]]
    return replace(response, stats=response.stats | {"loads": found}) if found else response


def _looks(count):
    """Return the samples to evaluate: all of a short run, otherwise one random sample in each of `LOOKS` equal parts."""
    if count <= LOOKS:
        return slice(None)
    return ((np.arange(LOOKS) + np.random.default_rng(0).random(LOOKS)) * (count / LOOKS)).astype(np.int64)


def between_phases(machine):
    """Return the largest RMS interpolation error of stiffnesses over the phase, relative to their spread, or None.

    Curves are the healthy cycle of each mesh and the engagement of each tooth that differs. The cubics through every second
    sample are compared with those through all. This is the error of half as many samples. For a smooth curve it is eight to
    sixteen times the error with all samples. For a curve with kinks at the entry of pairs it is two to ten times that error.
    `gearfe.law_error` is the same for force laws. The interpolation of the unloaded transmission error is not included.
    """
    curves = {id(m.stiffness): m for m in machine.meshes if not isinstance(m.stiffness, ForceLaw)}
    found = [_left_out(mesh) for mesh in curves.values() if len(mesh.cycle.cells) >= FEWEST and len(mesh.cycle.cells) % 2 == 0]
    hurt = {id(one.curve): (mesh, i) for mesh in machine.meshes for i, one in enumerate(mesh.damage)}
    found += [_left_out_tooth(mesh, i) for mesh, i in hurt.values() if not isinstance(mesh.damage[i].curve, ForceLaw)]
    return max(found, default=None)


def _left_out_tooth(mesh, i):
    """Error of the curve of a tooth that differs. As in `ToothDamage.change`, unequal phases have cubics of the change."""
    hurt, (_, first, _) = mesh.damage[i], mesh.changes[i]
    phase, values = (np.asarray(one, dtype=float) for one in (hurt.curve.phase, hurt.curve.k))
    spread = float(np.ptp(values))
    if phase.size < FEWEST or not spread > 1e-9 * values.mean():
        return 0.0
    if np.ptp(np.diff(phase)) > ALIKE * np.diff(phase).mean():
        usual = [(1.0, 0.0, mesh.cycle), *(mesh.changes[:i] if hurt.every else ())]
        values = values - changed(usual, first + phase)
    at = np.linspace(phase[0], phase[-1], math.ceil(FINE * (phase[-1] - phase[0])))
    whole = scipy.interpolate.PchipInterpolator(phase, values)(at)
    found = []
    for start in (0, 1):  # A kink can coincide with the samples of one half.
        kept = np.unique([0, *range(start, phase.size, 2), phase.size - 1])
        off = scipy.interpolate.PchipInterpolator(phase[kept], values[kept])(at) - whole
        found.append(float(np.sqrt(np.mean(off**2)) / spread))
    return max(found)


def _left_out(mesh):
    values = mesh.cycle.cells[:, 0]
    spread = float(np.ptp(values))
    if not spread > 1e-9 * values.mean():
        return 0.0
    if isinstance(mesh.stiffness, StiffnessCurve):
        phase, at = np.unique(mesh.stiffness.phase % 1.0)[::2], np.arange(FINE) / FINE
        off = scipy.interpolate.PchipInterpolator(*repeated(phase, mesh.cycle(phase), 1.0))(at) - mesh.cycle(at)
    else:
        off = cycle_table(values[::2])((np.arange(values.size // 2) + 0.5) * 2 / values.size) - values[1::2]
    return float(np.sqrt(np.mean(off**2)) / spread)


def _other(mesh, own, seconds):
    """Return a message on a mesh whose mean force differs from the load of its stiffness curve, or None."""
    stated = mesh.stiffness.meta["force_N"]
    count = min(own.size // LEAST, PARTS, math.floor(seconds * abs(mesh.frequency)))
    means = np.abs([part.mean() for part in np.array_split(own, max(count, 1))])
    low, high, mean = float(means.min()), float(means.max()), abs(float(own.mean()))
    if mean < IDLE * stated or max(high / stated - 1, 1 - low / stated) <= OTHER:
        return []
    swing = f", {low:.4g} to {high:.4g} N alternately" if high - low > OTHER * stated else ""
    return [
        f"{mesh.name} {mean:.4g} N on average{swing}, its stiffness is that of {stated:.4g} N{_holds(mesh.stiffness, stated)}"
    ]


def _holds(curve, stated):
    """Return in words the range of loads in which the mean stiffness of a curve changes by at most `NEARLY`.

    ``k = F / x`` gives ``d ln k / d ln F = 1 - k / (dF / dx)``.
    """
    power = 1 - float(np.mean(np.asarray(curve.k) / np.asarray(curve.k_tangent)))
    if not power > 1e-6:
        return ""
    low, high = (stated * math.exp(sign * min(NEARLY / power, 10.0)) for sign in (-1, 1))
    return f", within {100 * NEARLY:g} % from {low:.4g} to {high:.4g} N"

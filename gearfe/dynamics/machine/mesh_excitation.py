"""Displacement excitation of a mesh: the transmission error of modified flanks, tabulated over the mesh phase.

A mesh of a machine pushes with ``k(phase) (x - e(phase))``. Under a slowly changing force F the flanks approach by their
transmission error ``te = unloaded + F / k_secant``. There are three equivalent formulations:

- about rest: the secant k at the curve's load and ``e = unloaded``. It is exact at that load for any phase. Small vibrations
  about it have the secant stiffness, which is a few per cent too soft (the tangent is stiffer).
- about the load: the tangent k and ``e = te - F / k_tangent``. It is exact at that load and for small vibrations about it, and
  wrong far from it, also where contact is lost.
- a constant k and ``e = te - F / k``: it is exact at that load and neglects the changes of k in the vibration (forced, not
  parametric, excitation). The *loaded* error together with a varying k counts the deflection twice.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...geometry.aliases import Floats
from ...geometry.checks import is_finite, shown
from ...stiffness.curve import StiffnessCurve
from .mesh_curves import Samples

SMALLEST = 1e-9  # Smaller harmonics, relative to the largest one, are omitted.
ABOUT = ("rest", "load")


def mesh_excitation(curve: StiffnessCurve, about: str = "rest") -> tuple[Samples, Samples]:
    """Return mesh stiffness and displacement excitation that reproduce the transmission error of a curve at its load.

    Parameters
    ----------
    curve : StiffnessCurve
        Over whole mesh cycles.
    about : {"rest", "load"}
        ``rest``: secant stiffness and unloaded error, for runs in which the load changes or contact is lost. ``load``: tangent
        stiffness and what makes it exact at the curve's load, for small vibrations about it. See the module.

    Returns
    -------
    stiffness, error : Samples
        For `GearMesh` [N/m], and for ``with_errors(profile={mesh: error})`` [m].

    Raises
    ------
    ValueError
        If `about` is neither.
    """
    if about not in ABOUT:
        raise ValueError(f"about = {about!r}, but it must be one of {', '.join(ABOUT)}")
    if about == "rest":
        unloaded = np.zeros(curve.phase.size) if curve.unloaded is None else curve.unloaded
        return Samples(curve.phase, curve.k), Samples(curve.phase, unloaded)
    return Samples(curve.phase, curve.k_tangent), Samples(curve.phase, curve.te - curve.meta["force_N"] / curve.k_tangent)


def harmonics(error: Any, frequency: float, phase: float) -> list[tuple[float, float, float]]:
    """Return a tabulated error as sinusoids (amplitude, frequency, phase of a sine) through all its samples.

    Parameters
    ----------
    error : float, array or Samples
        A number: the amplitude of one sine at mesh frequency. An array: samples over one mesh cycle [m], equally spaced from
        phase 0. `Samples`: phases that are equally spaced over one mesh cycle or more (a revolution), and the error there [m].
    frequency, phase : float
        Of the mesh [Hz], and at t = 0.

    Raises
    ------
    ValueError
        If it is none of these, or not over whole mesh cycles.
    """
    if not isinstance(error, (Samples, list, tuple)) and np.ndim(error) == 0:
        if not is_finite(error):
            raise ValueError(
                f"profile = {shown(error)}, but give an amplitude [m], samples over a mesh cycle, or Samples(phase, error)"
            )
        return [(float(error), frequency, 2 * np.pi * (phase % 1.0))] if error else []
    first, cycles, values = _samples(error)
    n = values.size
    parts = np.fft.rfft(values) / n
    parts[1 : (n + 1) // 2] *= 2
    out = []
    for m in np.flatnonzero(np.abs(parts) > SMALLEST * np.abs(parts).max(initial=0.0)).tolist():
        # phase of the cosine, written as a sine
        angle = np.angle(parts[m]) + np.pi / 2 + 2 * np.pi * m * (phase - first) / cycles
        out.append((float(abs(parts[m])), m * frequency / cycles, float(angle % (2 * np.pi))))
    return out


def _samples(error: Any) -> tuple[float, int, Floats]:
    """Return first phase, number of mesh cycles and equally spaced values of a tabulated error."""
    if not isinstance(error, (Samples, Sequence, np.ndarray)):
        raise ValueError(f"profile = {error!r}, but give an amplitude [m], samples over a mesh cycle, or Samples(phase, error)")
    try:
        values = np.asarray(error.k if isinstance(error, Samples) else error, dtype=float)
        places = (
            np.asarray(error.phase, dtype=float) if isinstance(error, Samples) else np.arange(values.size) / max(values.size, 1)
        )
    except (TypeError, ValueError) as wrong:
        raise ValueError(f"profile = {error!r}: an error by phase needs numbers [m]") from wrong
    if values.ndim != 1 or values.size < 2 or places.shape != values.shape or not np.isfinite([places, values]).all():
        raise ValueError(f"profile with values of shape {values.shape}: give a row of finite numbers [m], one for each phase")
    step = (places[-1] - places[0]) / (values.size - 1)
    cycles = round(step * values.size)
    even = np.abs(np.diff(places) - step).max() < 1e-9 and abs(step * values.size - cycles) < 1e-6
    if not even or cycles < 1:
        raise ValueError(
            f"profile at {values.size} phases from {places[0]:.6g} to {places[-1]:.6g}: give equally spaced phases over whole "
            "mesh cycles, the last one a step before the end, as mesh_stiffness does by default"
        )
    return float(places[0]), cycles, values

"""Additional phases of a stiffness curve where pairs enter and leave, because interpolation would smooth these kinks."""

from collections.abc import Callable
from dataclasses import fields, replace

import numpy as np
import scipy

from ..geometry.aliases import Floats
from .curve import StiffnessCurve, joined

HALVINGS = 5  # maximum number of times that a distance between phases is halved
BENT = 5e-4  # limit of the area of an interpolation error, relative to the deflection range times the first phase step


def finer(
    curve: StiffnessCurve,
    solved: Callable[[Floats], StiffnessCurve],
    period: float | None = None,
    usual: StiffnessCurve | None = None,
) -> StiffnessCurve:
    """Return the curve with additional phases wherever the area of its interpolation error exceeds `BENT`.

    The error at a sample is its distance from the cubic through two neighbours on either side. Vibration is the response to
    the area of the error, so that errors over short distances matter less.

    Parameters
    ----------
    curve : StiffnessCurve
        Its phases rise.
    solved : callable
        Curve at phases ``(n,)``.
    period : float, optional
        Mesh cycles after which the curve repeats; None: it does not repeat.
    usual : StiffnessCurve, optional
        One mesh cycle. The difference of the curve from it is interpolated instead of the curve.

    Returns
    -------
    StiffnessCurve
        Its phases rise. The smallest distance is the first one divided by at most ``2**HALVINGS``.
    """
    first = np.diff(curve.phase).max()
    for _ in range(HALVINGS):
        phases = _middles(curve, BENT * first * np.ptp(curve.deflection), period, usual)
        if not phases.size:
            break
        curve = _in_order(joined([curve, solved(phases)]))
    return curve


def repeated(phase: Floats, values: Floats, period: float) -> tuple[Floats, Floats]:
    """Return periodic values ``(..., n)`` with three more samples at each end of the rising phases."""
    near = slice(-min(3, phase.size), None), slice(3)
    phase = np.concatenate([phase[near[0]] - period, phase, phase[near[1]] + period])
    return phase, np.concatenate([values[..., near[0]], values, values[..., near[1]]], axis=-1)


def _middles(curve, most, period, usual):
    """Return middles of phase intervals in which the area of the error exceeds `most` [m cycles]."""
    phase, values = curve.phase, _errors(curve)
    if usual is not None:
        values = values - scipy.interpolate.PchipInterpolator(*repeated(usual.phase, _errors(usual), 1.0), axis=1)(phase % 1.0)
    if period is not None:
        phase, values = repeated(phase, values, period)
    if phase.size < 5:
        return np.zeros(0)
    off, wide = np.zeros(values.shape), np.diff(phase)
    off[:, 2:-2] = np.abs(_left_out(phase, values))
    middle = (phase[:-1] + wide / 2)[(np.maximum(off[:, :-1], off[:, 1:]) * wide > most).any(axis=0)]
    return middle if period is None else middle[(middle > curve.phase[0]) & (middle < curve.phase[0] + period)]


def _errors(curve):
    """Return deflection and unloaded transmission error ``(2, n)`` [m]."""
    return np.array([curve.deflection, np.zeros(curve.k.size) if curve.unloaded is None else curve.unloaded])


def _left_out(x, y):
    """Return inner samples ``(rows, n - 4)`` minus the cubics (Lagrange) through two neighbours on each side."""
    sides = [np.arange(2, x.size - 2) + by for by in (-2, -1, 1, 2)]
    out = y[:, 2:-2].copy()
    for one in sides:
        weight = np.prod([(x[2:-2] - x[other]) / (x[one] - x[other]) for other in sides if other is not one], axis=0)
        out -= weight * y[:, one]
    return out


def _in_order(curve):
    """Return the curve sorted by phase."""
    rows = np.argsort(curve.phase, kind="stable")
    given = {own.name: getattr(curve, own.name) for own in fields(curve) if own.name not in ("order", "meta")}
    return replace(curve, **{name: value[rows] for name, value in given.items() if value is not None})

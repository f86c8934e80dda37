"""Further phases of a stiffness curve where it bends: pairs enter and leave there, and interpolation would smooth the kink."""

from collections.abc import Callable
from dataclasses import fields, replace

import numpy as np
from scipy.interpolate import PchipInterpolator

from ..geometry.aliases import Floats
from .curve import StiffnessCurve, joined

HALVINGS = 4  # maximum number of times that a distance between phases is halved
BENT = 5e-4  # error of interpolation, as part of the range of k and of the first distance, above which a distance is halved


def finer(
    curve: StiffnessCurve,
    solved: Callable[[Floats], StiffnessCurve],
    period: float | None = None,
    usual: StiffnessCurve | None = None,
) -> StiffnessCurve:
    """Return the curve with further phases wherever its cubic interpolation is not exact to `BENT`.

    A distance between two phases is halved if the curve without one of them, through four neighbours, differs there by more.

    Parameters
    ----------
    curve : StiffnessCurve
        Its phases rise.
    solved : callable
        Curve at phases ``(n,)``.
    period : float, optional
        Mesh cycles after which the curve repeats; None: it does not repeat.
    usual : StiffnessCurve, optional
        One mesh cycle, whose difference from the curve is interpolated instead of the curve.

    Returns
    -------
    StiffnessCurve
        Its phases rise; the smallest distance is the first one divided by ``2**HALVINGS``.
    """
    first = np.diff(curve.phase).max()
    for _ in range(HALVINGS):
        phases = _between(curve, first, period, usual)
        if not phases.size:
            break
        curve = _in_order(joined([curve, solved(phases)]))
    return curve


def _between(curve, first, period, usual):
    """Phases in the middle of distances that are to be halved, `first` being the distance before any was halved."""
    phase, values = curve.phase, _values(curve)
    most = BENT * first * np.ptp(values, axis=1)
    if usual is not None:
        values = values - _repeated(usual, phase)
    if period is not None:
        phase = np.concatenate([phase[-3:] - period, phase, phase[:3] + period])
        values = np.concatenate([values[:, -3:], values, values[:, :3]], axis=1)
    if phase.size < 5:
        return np.zeros(0)
    off, wide = np.zeros(values.shape), np.diff(phase)
    off[:, 2:-2] = np.abs(_left_out(phase, values))
    bent = (np.maximum(off[:, :-1], off[:, 1:]) * wide > most[:, None]).any(axis=0)
    middle = (phase[:-1] + wide / 2)[bent & (wide > 1.5 * first / 2**HALVINGS)]
    return middle if period is None else middle[(middle > curve.phase[0]) & (middle < curve.phase[0] + period)]


def _values(curve):
    """Stiffness and unloaded transmission error ``(2, n)``."""
    return np.array([curve.k, np.zeros(curve.k.size) if curve.unloaded is None else curve.unloaded])


def _repeated(cycle, phase):
    """`_values` of a mesh cycle at any phases, by monotone cubics."""
    last = slice(-2, None)
    at = np.concatenate([cycle.phase[last] - 1, cycle.phase, cycle.phase[:2] + 1])
    values = _values(cycle)
    values = np.concatenate([values[:, last], values, values[:, :2]], axis=1)
    return PchipInterpolator(at, values, axis=1)(phase % 1.0)


def _left_out(x, y):
    """Return values ``(rows, n - 4)`` at inner samples minus the cubics (Lagrange) through two neighbours on either side."""
    sides = [np.arange(2, x.size - 2) + by for by in (-2, -1, 1, 2)]
    out = y[:, 2:-2].copy()
    for one in sides:
        weight = np.prod([(x[2:-2] - x[other]) / (x[one] - x[other]) for other in sides if other is not one], axis=0)
        out -= weight * y[:, one]
    return out


def _in_order(curve):
    """Return the curve with rising phases."""
    rows = np.argsort(curve.phase, kind="stable")
    given = {own.name: getattr(curve, own.name) for own in fields(curve) if own.name not in ("order", "meta")}
    return replace(curve, **{name: value[rows] for name, value in given.items() if value is not None})

"""Stiffness over the mesh phase as tables, and its changes by damaged teeth."""

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike

from ...core.checks import numbers
from ...geometry.aliases import Floats
from ...stiffness.curve import StiffnessCurve
from ...stiffness.finer import repeated
from .force_law import ForceLaw
from .phase_table import SMOOTH, PhaseTable, smooth_table, table

FINE = 4096  # most samples per cycle after resampling of curves with unequal phases


@dataclass(frozen=True, slots=True)
class Samples:
    """Stiffness samples over the phase from other sources: contact coefficients, or curves of other programs.

    Parameters
    ----------
    phase : ndarray, shape (n,)
        Mesh phases.
    k : ndarray, shape (n,)
        Stiffness there [N/m^power]; of errors their values [m].
    """

    phase: Floats
    k: Floats


Curve = StiffnessCurve | Samples  # stiffness over the phase


Stiffness = float | Floats | Curve | ForceLaw | PhaseTable  # types of stiffness that `GearMesh` accepts
Change = tuple[float, float, PhaseTable]  # period [mesh cycles], first cycle, and the change over the phase from that cycle on
ALIKE = 1e-6  # tolerance of equal samples of two curves [mesh cycles, cells]


def changed(changes: Iterable[Change], phase: ArrayLike, value: Callable[[PhaseTable, Any], Any] = PhaseTable.__call__) -> Any:
    """Sum all changes at unwrapped phases. The default sums the values of their tables, `value` gives other values."""
    running: Floats = np.asarray(phase, dtype=float)
    out = np.zeros(running.shape)
    for z, first, change in changes:
        tooth_phase = tooth_phase_of(running, z, first, change.start)
        inside = tooth_phase < change.end
        if inside.any():
            out = out + np.where(inside, value(change, np.minimum(tooth_phase, change.end)), 0.0)
    return out


def tooth_phase_of(running, z, first, start):
    """Return phases relative to an event, counted from `start`. The event recurs every z mesh cycles from phase `first` on."""
    on = running - first - start
    return on - z * np.floor(on / z) + start


def cells_of(changes: Iterable[Change], start: float, width: float, count: int) -> Floats | None:
    """Return the summed cubic coefficients ``(count, 4)`` of `changes` in cells of equal `width` from the phase `start` on.

    The result is None if the cells of a change have another width, or other ends.
    """
    out = np.zeros((count, 4))
    for z, first, change in changes:
        place = (start - first - change.start) / change.width
        if abs(change.width - width) > ALIKE * width or abs(place - round(place)) > ALIKE:
            return None
        cell = (round(place) + np.arange(count)) % round(z / width)
        inside = cell < len(change.cells)
        out[inside] += change.cells[cell[inside]]
    return out


def evenly(phase: Floats, values: Floats, period: float | None = None, start: float | None = None) -> tuple[Floats, Floats]:
    """Return equal steps no longer than the smallest step of `phase`, at most `FINE` per cycle, and values by monotone cubics.

    With a `period` [mesh cycles] the values repeat. The steps begin at the first phase or at `start`.
    """
    count = min(round(1 / np.diff(phase).min()), FINE)
    steps = math.floor((phase[-1] - phase[0]) * count + ALIKE) + 1 if period is None else round(period * count)
    at = (phase[0] if start is None else start) + np.arange(steps) / count
    if period is not None:
        phase, values = repeated(phase, values, period)
    return at, scipy.interpolate.PchipInterpolator(phase, values)(at)


def cycle_table(stiffness: Stiffness) -> PhaseTable:
    """Return the `PhaseTable` over one cycle of a number, equally spaced samples, a `StiffnessCurve`, `Samples`, or a law.

    Samples are interpolated by smooth cubics (`machine.phase_table.smooth_table`), a `StiffnessCurve` by `table`.
    """
    if isinstance(stiffness, PhaseTable):
        return stiffness
    if isinstance(stiffness, ForceLaw):
        stiffness = Samples(*stiffness.at(stiffness.force))
    if not isinstance(stiffness, (StiffnessCurve, Samples)):
        values = np.atleast_1d(numbers("stiffness", stiffness, ""))
    else:
        phase = np.asarray(stiffness.phase, dtype=float) % 1.0
        order = np.argsort(phase, kind="stable")
        phase, values = phase[order], np.asarray(stiffness.k, dtype=float)[order]
        if not np.allclose(phase, np.arange(phase.size) / phase.size, atol=1e-9):
            phase, first = np.unique(phase, return_index=True)
            values = evenly(phase, values[first], 1.0, 0.0)[1]
    if values.ndim != 1 or not values.size or not np.isfinite(values).all() or (values < 0).any():
        raise ValueError("stiffness: give a number, samples over one cycle or a StiffnessCurve, finite and not negative [N/m]")
    if isinstance(stiffness, StiffnessCurve) or values.size < SMOOTH:  # The curve has kinks where pairs enter.
        return table(values, 0.0, 1.0 / values.size, periodic=True)
    return smooth_table(values)

"""Stiffness over the mesh phase as tables, and its changes by damaged teeth."""

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import PchipInterpolator

from ...core.checks import numbers
from ...geometry.aliases import Floats
from ...stiffness.curve import StiffnessCurve
from .force_law import ForceLaw
from .phase_table import SMOOTH, PhaseTable, smooth_table, table

FINE = 1024  # samples per cycle after resampling of curves with unequal phases


@dataclass(frozen=True, slots=True)
class Samples:
    """Stiffness at phases from other sources: contact coefficients, or curves of other programs.

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
    """Sum all changes at unwrapped phases. By default the values of their tables are summed, otherwise those of `value`."""
    running: Floats = np.asarray(phase, dtype=float)
    out = np.zeros(running.shape)
    for z, first, change in changes:
        tooth_phase = tooth_phase_of(running, z, first, change.start)
        inside = tooth_phase < change.end
        if inside.any():
            out = out + np.where(inside, value(change, np.minimum(tooth_phase, change.end)), 0.0)
    return out


def tooth_phase_of(running, z, first, start):
    """Return phases relative to an event, counted from `start`. It recurs every z mesh cycles from phase `first` on."""
    on = running - first - start
    return on - z * np.floor(on / z) + start


def cells_of(changes: Iterable[Change], start: float, width: float, count: int) -> Floats | None:
    """Return coefficients ``(count, 4)`` of the sum of changes in cells from a phase on, or None if cells differ."""
    out = np.zeros((count, 4))
    for z, first, change in changes:
        place = (start - first - change.start) / change.width
        if abs(change.width - width) > ALIKE * width or abs(place - round(place)) > ALIKE:
            return None
        cell = (round(place) + np.arange(count)) % round(z / width)
        inside = cell < len(change.cells)
        out[inside] += change.cells[cell[inside]]
    return out


def evenly(phase: Floats, values: Floats, period: float | None) -> tuple[Floats, Floats]:
    """Phases `FINE` per mesh cycle, and values there by monotone cubics through those at uneven rising phases.

    With a `period` [mesh cycles] the values repeat.
    """
    low, high = math.ceil(phase[0] * FINE - ALIKE), math.floor(phase[-1] * FINE + ALIKE) + 1
    if period is not None:
        high, near = low + round(period * FINE), min(3, phase.size)
        phase = np.concatenate([phase[-near:] - period, phase, phase[:near] + period])
        values = np.concatenate([values[-near:], values, values[:near]])
    at = np.arange(low, high) / FINE
    return at, PchipInterpolator(phase, values)(at)


def cycle_table(stiffness: Stiffness) -> PhaseTable:
    """`PhaseTable` over one cycle of a number, of equally spaced samples, of a `StiffnessCurve`, of `Samples`, or of a law.

    Through samples smooth cubics (`machine.phase_table.smooth_table`), through a `StiffnessCurve` those of `table`.
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
        if np.allclose(phase, np.arange(phase.size) / phase.size, atol=1e-9):
            pass
        elif isinstance(stiffness, Samples):
            values = np.interp(np.arange(FINE) / FINE, phase, values, period=1.0)
        else:
            phase, first = np.unique(phase, return_index=True)
            at, values = evenly(phase, values[first], 1.0)
            values = np.roll(values, round(at[0] * FINE))
    if values.ndim != 1 or not values.size or not np.isfinite(values).all() or (values < 0).any():
        raise ValueError("stiffness: give a number, samples over one cycle or a StiffnessCurve, finite and not negative [N/m]")
    if isinstance(stiffness, StiffnessCurve) or values.size < SMOOTH:  # The curve has kinks where pairs enter.
        return table(values, 0.0, 1.0 / values.size, periodic=True)
    return smooth_table(values)

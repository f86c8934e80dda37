"""Order tracking: order spectrum, synchronous average (TSA), and residual signal without healthy mesh orders."""

import math
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike

from ..core.checks import whole
from ..core.memory import check_memory
from ..core.time_limit import check_time
from ..geometry.aliases import Floats
from .given import samples
from .series import Signal
from .spectrum import Spectrum, amplitudes

MOST = 10**8  # limit of samples per revolution
FINEST, ALWAYS = 64, 2**22  # limit of samples relative to the record, and a number that is always allowed
BYTES, SECONDS = 40.0, 1.2e-7  # memory [bytes] and time [s] per sample, measured with 1e8 samples
SLOWEST = 1 / 16  # lowest speed relative to the mean; below it, angular resampling would multiply the samples


def by_turn(signal: Signal, samples_per_turn: int | None = None) -> Floats:
    """Resample to equal steps of the shaft angle, with one row per revolution ``(turns, samples_per_turn)``.

    The values are interpolated by splines of degree 5. Their relative amplitude error at frequency f is ``(f / (rate -
    f))**6``: 2e-6 at a tenth of the rate, 1e-3 at a quarter, 7 % at 1/2.56. By default a row has as many samples as the
    revolution at the lowest speed, to avoid aliasing. ValueError without a shaft (`angle` or `shaft_frequency`), for less than
    one revolution, for a speed near zero, or for too few samples per revolution.
    """
    angle = signal.shaft_angle / (2 * math.pi)
    angle = angle - angle[0]
    step = np.diff(angle)
    if step.min() < SLOWEST * step.mean():
        raise ValueError(
            f"{signal.name}: the shaft slows down to {step.min() * signal.rate:.3g} Hz from {step.mean() * signal.rate:.3g} "
            "on average; cut out standstill and start"
        )
    needed = math.ceil(1 / step.min() - 1e-6)
    count = needed if samples_per_turn is None else whole("samples_per_turn", samples_per_turn, 1)
    if count > MOST:
        raise ValueError(f"{signal.name}: {count} samples per turn, but at most {MOST} are allowed: give fewer")
    if count < needed:
        raise ValueError(
            f"samples_per_turn = {count}, but {signal.name} has {needed} per turn at its lowest speed: give at least {needed}"
        )
    turns = math.floor(angle[-1] + 1 / count + 1e-9)
    if turns < 1 or angle.size < 6:
        raise ValueError(f"{signal.name} covers {angle[-1]:.3g} revolutions with {angle.size} samples; one revolution is needed")
    if turns * count > max(FINEST * signal.values.size, ALWAYS):
        raise ValueError(
            f"samples_per_turn = {count}, but more than {FINEST} times the samples of {signal.name} add no information: "
            f"give at most {FINEST * needed}"
        )
    _check_size(turns * count, count)
    grid = np.minimum(np.arange(turns * count) / count, angle[-1])
    return scipy.interpolate.make_interp_spline(angle, signal.values, k=5)(grid).reshape(turns, count)


def _check_size(size, count):
    """Raise ValueError for more samples than memory and the limit of computing time permit."""
    what, remedy = f"samples_per_turn = {count}: {size} samples", "give fewer samples per turn"
    check_memory(what, BYTES * size, remedy)
    check_time(what, SECONDS * size, remedy)


def order_spectrum(signal: Signal, *, samples_per_turn: int | None = None, window: str | tuple[Any, ...] = "hann") -> Spectrum:
    """Compute the one-sided amplitude spectrum over shaft orders (order tracking), for variable speed.

    `by_turn` resamples to whole turns, so that the orders 1, 2, ... are bins; the resolution is ``1 / turns``.

    Parameters
    ----------
    signal : Signal
        One that has `angle` or `shaft_frequency` of the shaft.
    samples_per_turn : int, optional
        See `by_turn`; default: as many as a turn has where the shaft is slowest.
    window : str or tuple
        A window of `scipy.signal.get_window`.

    Returns
    -------
    Spectrum
        In the unit of the signal, over orders (per turn) from 0 to half of the samples per turn.

    Raises
    ------
    ValueError
        If the signal has neither `angle` nor `shaft_frequency`, covers less than one whole turn or has fewer than 6 samples; if
        the shaft slows down to less than a sixteenth of its mean speed; if `samples_per_turn` is no whole number, smaller than
        the samples of a turn where the shaft is slowest, or above 1e8; if scipy has no such window.

    References
    ----------
    K. R. Fyfe, E. D. S. Munck, Mech. Syst. Signal Process. 11(2) (1997) 187-205.
    """
    turns = by_turn(signal, samples_per_turn)
    return amplitudes(turns.ravel(), float(turns.shape[1]), window, signal.unit, signal.name, "order")


def synchronous_average(signal: Signal, samples_per_turn: int | None = None, *, turns_per_period: int = 1) -> tuple[Floats, int]:
    """Compute the average over the revolutions of a shaft (TSA). Other components decrease with ``1 / sqrt(periods)``.

    Parameters
    ----------
    signal : Signal
        One that has `angle` or `shaft_frequency` of the shaft; for a sun or a planet those of the gear relative to the carrier.
    samples_per_turn : int, optional
        Samples per revolution, see `by_turn`.
    turns_per_period : int
        Revolutions in one period, for components that repeat only after several revolutions (hunting tooth).

    Returns
    -------
    average : ndarray, shape (samples_per_turn * turns_per_period,)
        Average in the unit of the signal, from the angle of its first sample.
    periods : int
        Number of averaged periods; revolutions at the end that make no whole period are discarded.

    Raises
    ------
    ValueError
        If the signal has neither `angle` nor `shaft_frequency`, covers less than one revolution or has fewer than 6 samples. If
        the shaft slows down to less than a sixteenth of its mean speed. If `samples_per_turn` is no whole number, smaller than
        the samples of a revolution at the lowest speed, or above 1e8. If `turns_per_period` is no whole number from 1, or above
        the number of revolutions.

    References
    ----------
    P. D. McFadden, Mech. Syst. Signal Process. 1(1) (1987) 83-95.
    """
    turns = by_turn(signal, samples_per_turn)
    periods = turns.shape[0] // whole("turns_per_period", turns_per_period, 1)
    if periods < 1:
        raise ValueError(f"turns_per_period = {turns_per_period}, but {signal.name} has {turns.shape[0]} whole revolutions")
    rows = turns[: periods * turns_per_period].reshape(periods, -1)
    return rows.mean(axis=0), periods


def mesh_coherence(signal: Signal, teeth: int) -> float:
    """Return the share of the mesh line that the synchronous average preserves (1 if revolutions have equal phases).

    ::

        c_j = Fourier coefficient of revolution j at the mesh order with the largest line among its first three
        coherence**2 = (|mean c_j|**2 - s**2 / n) / (mean |c_j|**2 - s**2),   s**2 = mean |c_j+1 - c_j|**2 / 2

    s is the noise. A smaller value means that the angle of the shaft does not follow its speed. nan if there are fewer than 4
    revolutions, or the noise exceeds the line. ValueError as `synchronous_average`.
    """
    turns = by_turn(signal)
    orders = [order for order in (teeth, 2 * teeth, 3 * teeth) if 2 * order < turns.shape[1]]
    if len(turns) < 4 or not orders:
        return math.nan
    c = np.fft.rfft(turns, axis=1)[:, orders]
    noise = np.mean(np.abs(np.diff(c, axis=0)) ** 2, axis=0) / 2
    whole = np.mean(np.abs(c) ** 2, axis=0) - noise
    kept = np.abs(c.mean(axis=0)) ** 2 - noise / len(c)
    most = int(np.argmax(whole))
    return float(np.sqrt(max(kept[most], 0.0) / whole[most])) if whole[most] > noise[most] else math.nan


def residual_signal(average: ArrayLike, teeth: int, *, sidebands: int = 0, shaft_orders: int = 2) -> Floats:
    """Remove the orders of a healthy gear from a synchronous average. A local fault remains as a peak.

    Removed are the mean, the shaft orders 1 to `shaft_orders`, the mesh orders n `teeth`, and with ``sidebands=1`` also
    n `teeth` +- 1: the difference signal.

    Parameters
    ----------
    average : ndarray, shape (n,)
        Synchronous average over one turn.
    teeth : int
    sidebands, shaft_orders : int

    Returns
    -------
    ndarray, shape (n,)
        In the unit of `average`.

    Raises
    ------
    ValueError
        If `average` is not a row of two or more finite numbers; if `teeth` is no whole number from 2 to ``n / 2``; if `sidebands`
        or `shaft_orders` are no whole numbers from 0 on, or so many that nothing is left: ``2 sidebands + 1`` or `shaft_orders`
        not below `teeth`.

    References
    ----------
    J. J. Zakrajsek, D. P. Townsend, H. J. Decker, NASA TM 105950 (1993): residual and difference signal, FM4, NA4.
    """
    average = samples("average", average)
    top = average.size // 2
    sidebands, shaft_orders = whole("sidebands", sidebands, 0), whole("shaft_orders", shaft_orders, 0)
    if not 2 <= whole("teeth", teeth, 2) <= top:
        raise ValueError(f"teeth = {teeth}, but an average of {average.size} samples holds the orders 0 to {top}")
    if not (0 <= 2 * sidebands + 1 < teeth and 0 <= shaft_orders < teeth):
        raise ValueError(
            f"sidebands = {sidebands}, shaft_orders = {shaft_orders}: they remove all orders between mesh harmonics {teeth} apart"
        )
    transform = np.fft.rfft(average)
    order = np.arange(top + 1)
    to_mesh = np.abs((order + teeth // 2) % teeth - teeth // 2)
    transform[(to_mesh <= sidebands) & (order >= teeth - sidebands) | (order <= shaft_orders)] = 0
    return np.fft.irfft(transform, average.size)

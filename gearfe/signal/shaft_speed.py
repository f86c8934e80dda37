"""Shaft speed without a tachometer: the angle of a shaft from lines of the signal itself, at constant or variable speed."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from scipy.interpolate import make_interp_spline
from scipy.ndimage import median_filter
from scipy.signal import fftconvolve, get_window, stft

from ..core.checks import number, whole
from .given import hertz
from .series import Signal

WIDTH = 4  # width of a line with a Hann window, and its largest shift between windows with half overlap [bins]
FINE = 4  # trial speeds per bin of the highest harmonic
ROUNDS = 3  # rounds of phase demodulation
BROAD = 32  # median window for the level of resonances and noise [line widths]
PARTS = 4  # number of parts of a record, each of which must show the speed
# Threshold relative to chance. White noise reached at most 1.09 in 160 records, lines at least 1.4. Of later records, it
# rejected 300 of 300 of white noise, 113 of 150 of noise through resonances, and none of 150 with lines.
CLEAR = 1.2
LOOK = "look at gearfe.plot_spectrogram; give a range that the speed does not leave and no other line crosses, or other harmonics"
GOLDEN = (math.sqrt(5) - 1) / 2


def with_estimated_speed(
    signal: Signal, order: float, speeds: tuple[float, float], *, harmonics: int = 3, seconds: float | None = None
) -> Signal:
    """Estimate the angle of a signal's shaft from a line and its harmonics, such as those of the mesh.

    The first step finds a speed path in a spectrogram. At each time it selects the speed whose harmonics exceed the broad
    background most (logarithms), while no line moves by more than its width between two windows. The second step corrects the
    path by the phase of the line along it (Bonnardot et al.). The result depends on the signal-to-noise ratio of the line.
    Check it with ``gearfe.plot_spectrogram``, and give a range of speeds in which no other line has the same course. White noise
    is rejected, but noise through a resonance as narrow as a line is taken for a line.

    Parameters
    ----------
    signal : Signal
    order : float
        Events per turn of the shaft: its teeth.
    speeds : (float, float)
        Slowest and fastest turns per second of the shaft [Hz].
    harmonics : int
        Of the line, those below half of the rate at the fastest.
    seconds : float, optional
        Length of a window; default: that in which a line that sweeps through the range in the record moves by one bin.

    Returns
    -------
    Signal
        Its `angle` begins at 0; the angle of the shaft itself at that time is not known.

    Raises
    ------
    ValueError
        If the range is empty, the line lies above half of the rate in it, the record is too short, in a quarter of it no line
        follows a speed of the range better than chance would have it, or the angle found turns back.

    References
    ----------
    - Q. Leclere, H. Andre, J. Antoni, Mech. Syst. Signal Process. 81 (2016) 371-386: several orders at once.
    - F. Bonnardot et al., Mech. Syst. Signal Process. 19(4) (2005) 766-785: angle from the phase of a mesh line.
    """
    ends: Any = speeds if np.shape(speeds) == (2,) else (speeds, speeds)
    low, high = ends
    for name, value in {"order": order, "speeds[0]": low, "speeds[1]": high}.items():
        hertz(name, value)
    if not low < high:
        raise ValueError(f"speeds = {speeds} Hz, but give the lowest and then the highest speed")
    count = min(whole("harmonics", harmonics, 1), int(signal.rate / 2 / (order * high)))
    if count < 1:
        raise ValueError(f"order {order:g} reaches {order * high:g} Hz, but {signal.name} shows up to {signal.rate / 2:g} Hz")
    if seconds is None:
        seconds = max(math.sqrt(signal.duration / (order * (high - low) * count)), 2 * WIDTH / (order * low))
    size = 2 * round(min(number("seconds", seconds), signal.duration) * signal.rate / 2)
    if not WIDTH * 2 <= size <= signal.values.size // 4:
        raise ValueError(
            f"{signal.name}: windows of {seconds:.3g} s in a record of {signal.duration:.3g} s, but four or more are needed: "
            "record longer, or give a slowest speed that is higher, or seconds="
        )
    time, speed = _path(signal, order, (low, high), count, size)
    angle = make_interp_spline(time, 2 * np.pi * speed, k=min(3, time.size - 1)).antiderivative()
    turned = _straight_ends(angle, time, speed, signal.time)
    for _ in range(ROUNDS):
        turned = turned - _lag(signal, order, turned, size)
    back = np.flatnonzero(np.diff(turned) <= 0)
    if back.size:
        raise ValueError(f"{signal.name}: the estimated angle reverses at {signal.time[back[0]]:.3g} s: {LOOK}")
    return replace(signal, angle=turned - turned[0], shaft_frequency=None)


def _path(signal, order, speeds, count, size):
    """Return window centres and speeds, along the path with the largest line amplitudes.

    Raises ValueError if noise would give as much.
    """
    x = signal.values - signal.values.mean()
    frequency, time, lines = stft(x, signal.rate, nperseg=size, noverlap=size // 2, nfft=2 * size, boundary=None, padded=False)
    bin_ = signal.rate / size
    tried = np.linspace(*speeds, max(8, math.ceil(FINE * count * order * (speeds[1] - speeds[0]) / bin_)))
    power = np.abs(lines) + 1e-6 * np.abs(lines).max() + 1e-300
    # Resonances and noise are wider than a line, so a line at constant frequency is kept.
    floor = median_filter(np.median(power, axis=1), BROAD * WIDTH, mode="nearest")
    level = np.log(power / floor[:, None])
    score = sum(np.array([np.interp(k * order * tried, frequency, frame) for frame in level.T]) for k in range(1, count + 1))
    step = max(1, math.ceil(WIDTH * bin_ / (count * order) / (tried[1] - tried[0])))
    path = _followed(score, step)
    _check_followed(signal, order, time, score, step, path)
    return time, _between(score, tried, path)


def _followed(score, step):
    """Return the path with the largest sum among paths that move by at most `step` speeds per window (R. Bellman)."""
    total, came = score[0], []
    for frame in score[1:]:
        reach = sliding_window_view(np.pad(total, step, constant_values=-np.inf), 2 * step + 1)
        best = reach.argmax(axis=1)
        came.append(best + np.arange(best.size) - step)
        total = total[came[-1]] + frame
    path = [int(np.argmax(total))]
    for before in reversed(came):
        path.append(before[path[-1]])
    return np.array(path[::-1])


def _check_followed(signal, order, time, score, step, path):
    """Raise ValueError if the speed path is hardly better than chance, tested with randomly shifted windows."""
    turned = np.array([np.roll(frame, int(i * GOLDEN * frame.size)) for i, frame in enumerate(score)])
    rows = np.arange(len(path))
    chance = turned[rows, _followed(turned, step)].mean()
    for part in np.array_split(rows, PARTS):
        if not score[part, path[part]].mean() > CLEAR * chance:
            raise ValueError(
                f"{signal.name}: from {time[part[0]]:.3g} to {time[part[-1]]:.3g} s no line of order {order:g} stands out at any "
                f"speed of the range: {LOOK}"
            )


def _between(score, tried, path):
    """Return the speeds of a path, refined to the maximum of a parabola through adjacent scores."""
    inner = np.clip(path, 1, len(tried) - 2)
    rows = np.arange(len(path))
    left, here, right = (score[rows, inner + i] for i in (-1, 0, 1))
    bend = left - 2 * here + right
    off = np.where(bend < 0, (left - right) / 2 / np.where(bend < 0, bend, -1.0), 0.0)
    return tried[path] + np.where(path == inner, np.clip(off, -1, 1), 0.0) * (tried[1] - tried[0])


def _straight_ends(angle, time, speed, t):
    """Return an angle at times `t`. Before the first and after the last window the speed is constant."""
    inside = np.clip(t, time[0], time[-1])
    return angle(inside) + 2 * np.pi * ((t - inside) * np.where(t < time[0], speed[0], speed[-1]))


def _lag(signal, order, turned, size):
    """Return the lag of a line behind an angle [rad of the shaft], smoothed over a window."""
    window = get_window("hann", size + 1, fftbins=False)
    wave = (signal.values - signal.values.mean()) * np.exp(-1j * order * turned)
    slow = fftconvolve(wave, window, mode="same") / fftconvolve(np.ones(wave.size), window, mode="same")
    phase = np.unwrap(np.angle(slow))
    return -(phase - phase[phase.size // 2]) / order

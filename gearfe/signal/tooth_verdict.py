"""Verdict on a local tooth fault of a gear, from the synchronous average of a record."""

import math
from typing import NamedTuple

import numpy as np

from .gear_indicators import SHARP, gear_indicators, has_mesh_line
from .orders import mesh_coherence, residual_signal, synchronous_average
from .series import Signal

# threshold of the kurtosis above 3, in standard deviations for noise; white noise exceeds it in under 0.1 % of averages
SIGMAS = 6.0
# Healthy gears exceed these limits in less than 1 % of cases, see tests/signal/test_false_alarms.py.
RISE = 2.5  # limit of FM4 relative to the healthy record, whose difference signal has the same variance
ALONE = 24.0  # limit of FM4 if there is no healthy record
FEWEST = 4  # least number of revolutions, two for each half of the record


class ToothVerdict(NamedTuple):
    """Verdict on a local tooth fault.

    Attributes
    ----------
    level : {"likely", "possible", "not seen"}
        "likely" if FM4 is above `limit` in the whole record and in both halves, and the largest impulse keeps its angle.
        "possible" if only the whole record exceeds the limit, or, without a healthy record, only the limit of noise.
    FM4, limit : float
        Kurtosis of the difference signal, and the value that a fault exceeds.
    healthy : float
        FM4 of the healthy record; nan without one.
    angle : float
        Angle of the shaft at the largest impulse [rad]: from the mark of the tachometer, or where the record has angle 0.
    apart : float
        Difference of this angle between the two halves of the record [rad].
    revolutions : int
    """

    level: str
    FM4: float
    limit: float
    healthy: float
    angle: float
    apart: float
    revolutions: int

    def told(self, teeth: int) -> str:
        """Return the verdict in sentences, with the conditions that would change it."""
        against = "" if math.isnan(self.healthy) else f" against {self.healthy:.3g} of the healthy record"
        text = f"tooth fault of the {teeth}-tooth gear: {self.level}; FM4 {self.FM4:.3g}{against}, limit {self.limit:.3g}"
        if self.level == "not seen":
            return (
                f"{text}. This verdict rests on FM4 alone, the kurtosis of the average over {self.revolutions} revolutions. "
                "Faults smaller than the deviations of healthy teeth or the noise stay below the limit. A longer record reduces "
                "the noise only."
            )
        last, before = entered_teeth(self.angle, teeth)
        place = (
            f", once per revolution, at {math.degrees(self.angle):.0f} degrees. If tooth 0 enters the mesh at 0 degrees, tooth "
            f"{before} and then tooth {last} entered up to there"
        )
        if self.level == "likely":
            change = ", or if the healthy record is of another gear" * (RISE * self.healthy >= self.FM4)
            return f"{text}{place}. The verdict changes if another record has FM4 below the limit or another angle{change}."
        if self.limit >= self.FM4:
            return f"{text}. Deviations of healthy teeth from each other do this, too: compare with a healthy record of the gear."
        moves = f"its halves differ: the largest impulse moves by {math.degrees(self.apart):.0f} degrees"
        halves = moves if self.apart >= 2 * math.pi / teeth else "FM4 of one half of the record is below the limit"
        return f"{text}, but {halves}. An impulse that is not bound to the gear, or a short record, does this: record longer."


def entered_teeth(angle: float, teeth: int) -> tuple[int, int]:
    """Return the last two teeth that entered the mesh up to an angle of the shaft [rad], if tooth 0 enters at angle 0.

    Tooth n enters n pitches before tooth 0, so that tooth numbers decrease with the angle. A damaged tooth excites vibration
    while it is in mesh. Near resonance the largest impulse is one or two pitches later.

    >>> [entered_teeth(2 * math.pi * (cycle + 0.5) / 17, 17) for cycle in (0, 1, 12)]
    [(0, 1), (16, 0), (5, 6)]
    """
    last = -math.floor(angle * teeth / (2 * math.pi)) % teeth
    return last, (last + 1) % teeth


def _largest(average, teeth):
    """Return the shaft angle at which the residual signal of an average has its largest magnitude [rad]."""
    return 2 * math.pi * int(np.argmax(np.abs(residual_signal(average, teeth, sidebands=1)))) / average.size


def _of_healthy(healthy, average, teeth):
    """Return FM4 of the healthy record, and the ratio of its residual variance to that of `average` (at most 1)."""
    if healthy is None:
        return math.nan, 1.0
    sound = synchronous_average(healthy)[0]
    before, now = (float(np.var(residual_signal(one, teeth, sidebands=1))) for one in (sound, average))
    return gear_indicators(sound, teeth)["FM4"], min(1.0, before / now) if now else 1.0


def tooth_verdict(record: Signal, teeth: int, healthy: Signal | None = None) -> ToothVerdict:
    """Judge whether a gear has a local tooth fault, from the synchronous average of a record with the shaft angle.

    ::

        limit = 3 + SIGMAS sqrt(24 / n) + (RISE FM4_healthy - 3) min(1, v_healthy / v)^2,  ALONE without a healthy record

    FM4 of n samples of white noise has the mean 3 and the variance 24 / n. v are the variances of the difference signals. Fourth
    cumulants of independent parts add, so that the deviations of healthy teeth count by their part of the signal: rounding
    errors of a simulated healthy record do not hide a fault. The angles of the largest impulse in the difference
    signals of both halves of the record must agree within one tooth.

    Parameters
    ----------
    record : Signal
        With `angle` or `shaft_frequency` of the gear's shaft.
    teeth : int
    healthy : Signal, optional
        Record of the same gear with its shaft, when it was healthy.

    Raises
    ------
    ValueError
        As `gearfe.synchronous_average` and `gearfe.gear_indicators`, or if the record has fewer than `FEWEST` revolutions,
        or if its average keeps less than `SHARP` of the mesh line or has none.
    """
    average, revolutions = synchronous_average(record)
    if revolutions < FEWEST:
        raise ValueError(f"{record.name}: {revolutions} revolutions, but a verdict needs {FEWEST} or more")
    if mesh_coherence(record, teeth) < SHARP or not has_mesh_line(np.abs(np.fft.rfft(average)), teeth):
        raise ValueError(
            f"{record.name}: its average is smeared, or is not of a gear of {teeth} teeth: give the angle of its shaft, the "
            "ratio of its speed to the tachometer's, or estimate the speed from the mesh lines"
        )
    known, part = _of_healthy(healthy, average, teeth)
    halves = _halves(record, average.size, revolutions)
    noise = 3 + SIGMAS * math.sqrt(24 / average.size)
    limit = max(noise, ALONE) if math.isnan(known) else noise + (RISE * known - 3) * part**2
    values = [gear_indicators(one, teeth)["FM4"] for one in (average, *halves)]
    angle, *angles = (_largest(one, teeth) for one in (average, *halves))
    apart = abs((angles[0] - angles[1] + math.pi) % (2 * math.pi) - math.pi)
    angle = float(angle + record.shaft_angle[0]) % (2 * math.pi)
    seen, both = values[0] > limit, min(values[1:]) > limit and apart < 2 * math.pi / teeth
    level = "likely" if seen and both else "possible" if seen or (healthy is None and values[0] > noise) else "not seen"
    return ToothVerdict(level, values[0], limit, known, angle, apart, revolutions)


def _halves(record, count, revolutions):
    """Return the synchronous averages of the first and the second half of the revolutions of a record."""
    turned = (record.shaft_angle - record.shaft_angle[0]) / (2 * math.pi)
    middle = int(np.searchsorted(turned, revolutions // 2))
    return [synchronous_average(part, count)[0] for part in (record[: middle + 1], record[middle:])]

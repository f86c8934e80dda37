"""Spectrum lines and condition indicators of simulated or measured signals, healthy and damaged."""

import math
import re
from dataclasses import dataclass, replace

import numpy as np

from ..core.table import Column, Table
from ..signal.demodulation import Demodulated, demodulate
from ..signal.indicator_table import indicator_table, tabulate_indicators
from ..signal.indicators import LOBES
from ..signal.spectra import spectrum
from ..signal.spectral_lines import BINS, expected_lines, find_lines
from .record_length import resolving_seconds, too_short
from .simulated import RANGE

NEAR = 50  # half-width of the window for the noise floor [bins]
# Ratio of the median to the lower quartile of noise amplitudes (Rayleigh distribution).
QUARTILE = math.sqrt(math.log(2) / math.log(4 / 3))
FLOOR = 5.0  # least ratio of a line to its noise floor; noise in five bins reaches it once in millions of cases
PULSES = 2  # least number of fault harmonics in an envelope; tooth pulses have many, run-out and planet position errors have one
WIDE = 0.01  # relative distance between a bin and the expected frequency from which both are stated
RISE = 2.0  # least ratio of a fault line to the same line of the healthy machine
WORDS = {"f_m": "mesh frequency", "f_fault": "fault frequency", "f_r": "shaft frequency", "f_carrier": "carrier frequency"}


@dataclass(frozen=True, slots=True)
class Analysis:
    """Spectra and indicators of one channel of some responses, or of a measured signal, by case.

    `signals` are the analysed signals. `fault` is the fault frequency [Hz], `lines` are the expected frequencies by name [Hz],
    `spectra` by case, `amplitudes` by case and line. `gearfe.indicator_table` describes `indicators`. `resolving` is the record
    length in seconds that resolves the sidebands of the fault (`resolving_seconds`).
    """

    channel: str
    signals: dict
    fault: float | None
    lines: dict
    spectra: dict
    amplitudes: dict
    indicators: dict
    resolving: float = 0.0

    @property
    def too_short(self):
        """Remedy if the record is too short to resolve the lines of the fault.

        The result is empty if it is long enough.
        """
        return too_short(min(signal.duration for signal in self.signals.values()), self.resolving)

    @property
    def unit(self):
        """Unit of the channel."""
        return next(iter(self.signals.values())).unit

    def standing(self):
        """Names of the mesh lines above the noise and, in a damaged case, of the significant fault lines.

        A line of a fault or of a carrier is significant above three limits: `FLOOR` times the noise of the bins around it,
        `RANGE` times the rms of the record and, if there is a healthy machine, `RISE` times the healthy machine's line.
        """
        return [name for name in self.lines if re.fullmatch(r"(\d+ )?f_m", name) or self._stands(name)]

    def _stands(self, name):
        healthy, *others = self.spectra
        floors = {case: FLOOR * _floor(of_case, self.lines[name]) for case, of_case in self.spectra.items()}
        least = {case: max(floor, RANGE * float(self.signals[case].values.std())) for case, floor in floors.items()}
        if not others:
            return self.amplitudes[healthy][name] > least[healthy]
        grown = RISE * self.amplitudes[healthy][name]
        return any(self.amplitudes[case][name] > max(least[case], grown) for case in others)

    def lines_table(self):
        """`Table` of the amplitudes of the lines that stand out (see `standing`), by case."""
        columns = ["line", Column("frequency", "Hz", "{:.2f}"), *(Column(case, self.unit, "{:.3g}") for case in self.spectra)]
        sizes = self.amplitudes.values()
        return Table(columns, [[in_words(n), self.lines[n], *(of_case[n] for of_case in sizes)] for n in self.standing()])

    def hidden_lines(self):
        """Sentence on the lines that do not stand out. The result is empty if all do."""
        shown = self.standing()
        hidden = [f"{in_words(name)} ({value:.2f} Hz)" for name, value in self.lines.items() if name not in shown]
        if not hidden:
            return ""
        against = f" or {RISE:g} times the healthy one" if len(self.spectra) > 1 else ""
        least = f"{FLOOR:g} times the noise around it, {RANGE:g} of the record's rms{against}"
        return "\n\n".join(filter(None, (f"lines not shown, below {least}: {', '.join(hidden)}", self.too_short)))

    def envelope(self):
        """Return the `Demodulated` of the last case at the fault frequency, and a sentence on the lines of its envelope.

        The sentence lists the lines if at least `PULSES` of them are significant.
        """
        demodulated, risen, compared = self._demodulated()
        low, high = demodulated.kurtogram.band
        none = f"fewer than {PULSES} lines of the fault have {FLOOR:g} times their noise floor" + (
            f" and {RISE:g} times healthy" if compared else ""
        )
        none += f"; {self.too_short}" if self.too_short else ""
        name = list(self.signals)[-1]
        return demodulated, f"{name}: squared envelope from {low:.0f} to {high:.0f} Hz, its most impulsive band: " + (
            "; ".join(risen.values()) or none
        )

    def beside_verdict(self):
        """Sentence on the fault lines of the envelope, printed after a verdict based on FM4.

        The result is empty without a fault frequency.
        """
        if not self.fault:
            return ""
        risen = self._demodulated()[1]
        lines = (
            f"shows {len(risen)} lines of the fault: {'; '.join(risen.values())}. Judge by both" if risen else "shows no fault"
        )
        return f" The envelope {lines}."

    def _demodulated(self):
        """`Demodulated` of the last case, its significant lines in words, and whether a healthy case is compared."""
        healthy, *others = self.signals.values()
        last = others[-1] if others else healthy
        demodulated = demodulate(last, self.fault)
        before = demodulate(healthy, self.fault, band=demodulated.kurtogram.band).lines if others else {}
        expected = {name: k * self.fault for k, name in enumerate(demodulated.lines, 1)}
        risen = {name: text for name, f in expected.items() if (text := _risen(demodulated, name, f, before.get(name)))}
        return demodulated, risen if len(risen) >= PULSES else {}, bool(before)

    def indicators_table(self):
        """`Table` of the indicators by case, with increments over healthy."""
        return tabulate_indicators(self.indicators)

    def plot(self, path=None, title=""):
        """Spectra below each other under a `title` (default: the channel). Returns the figure."""
        from ..figures.vibration_plots import plot_spectra

        return plot_spectra(self.spectra, self.lines, path, title=title or self.channel)


def in_words(line):
    """Spell out the name of a spectral line.

    >>> in_words("2 f_m - f_fault")
    '2 x mesh frequency - fault frequency'
    """
    return re.sub(
        r"\bf_\w+", lambda match: WORDS.get(match[0], f"faults of the {match[0][2:]}"), re.sub(r"(\d+) (?=f_)", r"\1 x ", line)
    )


def _floor(found, frequency):
    """Return the noise floor of a spectrum around a frequency, excluding the line itself.

    Where lines are dense, their lobes fill more than half of the bins.
    """
    near, values = found.within(*(frequency + sign * NEAR * found.resolution for sign in (-1, 1)))
    return QUARTILE * float(np.quantile(values[np.abs(near - frequency) > BINS * found.resolution], 0.25))


def _risen(found: Demodulated, name, expected, before):
    """Describe a line of an envelope if it exceeds its noise floor and its value in the healthy record.

    The result is empty if not. A bin at more than 1 % from the `expected` frequency [Hz] is stated with it.
    """
    frequency, size = found.lines[name]
    if size <= FLOOR * found.background or (before and size <= RISE * before[1]):
        return ""
    over = f"{size / found.background:.3g} times its noise floor" if found.background else f"{size:.3g} {found.spectrum.unit}"
    times = size / before[1] if before and before[1] else 0.0
    healthy = f", {'over 1000' if times > 1000 else f'{times:.3g}'} times healthy" if times else ""
    bins = f" (expected at {expected:.2f})" if abs(frequency / expected - 1) > WIDE else ""
    return f"{in_words(name)} at {frequency:.2f} Hz{bins}, {over}{healthy}"


def analyse(signals, mesh, fault=None, *, turning=None, carrier=None, channel="signal", others=None):
    """Compute the `Analysis` of simulated or measured signals by case. The first case is the healthy one.

    All frequencies are in Hz. `mesh` is the mesh frequency, `fault` that of the faulty tooth, `turning` the rotational
    frequency of its gear relative to the carrier (lines ``f_r``; one of both is sufficient), and `carrier` that of the
    carrier. `others` holds the fault frequencies of further gears by name. Carrier lines that the spectrum cannot resolve are
    omitted.
    """
    _check_frequencies(mesh=mesh, fault=fault, turning=turning, carrier=carrier)
    spectra = {
        case: spectrum(replace(of_case, values=of_case.values - of_case.values.mean())) for case, of_case in signals.items()
    }
    first = next(iter(spectra.values()))
    if mesh is not None and mesh >= first.frequency[-1]:
        raise ValueError(
            f"mesh = {mesh:g} Hz, but {channel} contains frequencies up to {first.frequency[-1]:g} Hz only, half of its rate"
        )
    lines = {} if mesh is None else _lines(mesh, fault, turning, carrier, first.resolution)
    for name, value in (others or {}).items():
        lines |= _fault_lines(mesh, name, value)
    lines = {name: value for name, value in lines.items() if value < first.frequency[-1]}
    faulty = fault or turning
    placed = {case: find_lines(of_case, lines, between=True) for case, of_case in spectra.items()}
    amplitudes = {case: {name: line[1] for name, line in of_case.items()} for case, of_case in placed.items()}
    known = (mesh, faulty) if mesh and faulty else (None, None)
    table = indicator_table(signals, *known, healthy=next(iter(signals)))
    resolving = resolving_seconds(fault, turning, carrier)
    return Analysis(channel, signals, faulty, lines, spectra, amplitudes, table, resolving)


def _fault_lines(mesh, name, value):
    """Frequencies of the lines of a further faulty tooth, by names that contain the name of its gear."""
    beside = expected_lines(mesh, value, count=1, harmonics=2)
    return {line.replace("f_fault", f"f_{name}"): at for line, at in beside.items() if "f_fault" in line}


def _check_frequencies(**frequencies):
    for name, value in frequencies.items():
        if value is not None and not 0 < value < math.inf:
            raise ValueError(f"{name} = {value!r} Hz, but a frequency is positive and finite")


def _lines(mesh, fault, turning, carrier, resolution):
    """Return the frequencies of lines by name [Hz]: fault, rotation of the gear, and carrier.

    The fault has two harmonics, and two sidebands at each of two mesh harmonics. The rotation has one harmonic and one
    sideband, or two of each if there is no fault frequency.
    """
    lines = expected_lines(mesh, fault, count=2, harmonics=2)
    if turning is not None:
        turns = expected_lines(mesh, turning, count=1 if fault else 2, harmonics=1 if fault else 2)
        lines |= {name.replace("f_fault", "f_r"): value for name, value in turns.items()}
    apart = min((abs(other - carrier) for other in (fault, turning) if other), default=math.inf) if carrier else 0.0
    if carrier and carrier > LOBES * resolution and apart > LOBES / 2 * resolution:
        lines |= expected_lines(mesh, None, carrier, count=1)
    return lines

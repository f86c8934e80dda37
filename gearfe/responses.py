"""A scene's machine, healthy and damaged, and what its vibration shows: spectrum lines and condition indicators."""

from dataclasses import dataclass, replace

import numpy as np

from geometry.pit import Pit

from .dynamics import simulate
from .indicators import indicator_table, table_text
from .scene_machine import build_machine
from .signals import Signal, spectrum
from .spectral_lines import expected_lines, find_lines

SETTLE = 0.5  # of the duration, before it, left out


@dataclass(frozen=True, slots=True)
class Analysis:
    """Spectra and indicators of one channel of some responses, by case.

    `lines` are the expected frequencies by name [Hz], `spectra` by case, `amplitudes` by case and line, `indicators` as of
    `gearfe.indicators.indicator_table`.
    """

    channel: str
    unit: str
    lines: dict
    spectra: dict
    amplitudes: dict
    indicators: dict

    def lines_text(self):
        """Amplitudes as Markdown."""
        rows = [["line", "Hz", *self.spectra], ["---"] * (2 + len(self.spectra))]
        for name, frequency in self.lines.items():
            rows.append([name, f"{frequency:.2f}", *(f"{self.amplitudes[case][name]:.3g}" for case in self.spectra)])
        return "\n".join(f"| {' | '.join(row)} |" for row in rows)

    def indicators_text(self):
        """Indicators as Markdown, increments against healthy in brackets."""
        return table_text(self.indicators)

    def plot(self, path=None):
        """Spectra below each other; returns the figure."""
        from .plots import plot_spectra

        return plot_spectra(self.spectra, self.lines, path)


def responses(scene, case=None, *, duration=1.0, method="fast", phases=64):
    """Responses of a scene's machine, healthy and, if asked for, in a case of damage.

    Parameters
    ----------
    scene : Scene
    case : str, optional
    duration : float
        Kept, after half as much in which the motion settles [s].
    method : str
        Of `gearfe.simulate`.
    phases : int
        Of the stiffness curves, per mesh cycle.

    Returns
    -------
    dict of str to Response
        ``"healthy"`` and the case.
    """
    if not duration > 0:
        raise ValueError(f"duration = {duration} s, but it must be positive")
    damage = [one for pair in scene.pairs.values() for found in pair.damage.get(case, {}).values() for one in found]
    curves = (
        "ritz3d" if any(isinstance(one, Pit) or not one.through for one in damage) else "auto"
    )  # one method for what is compared
    out = {}
    for name in ("healthy", *([case] if case else [])):
        made = build_machine(scene, None if name == "healthy" else name, phases=phases, method=curves)
        whole = simulate(made, (1 + SETTLE) * duration, method=method)
        kept = whole.time >= SETTLE * duration
        out[name] = replace(whole, time=whole.time[kept], states=whole.states[kept])
    return out


def analysis(found, channel=None):
    """Spectrum lines and indicators of a channel of `responses`.

    Parameters
    ----------
    found : dict of str to Response
    channel : str, optional
        Default: the force of the first mesh of the driven stage.

    Returns
    -------
    Analysis
    """
    first = next(iter(found.values()))
    notes = first.machine.notes
    mesh = _last(notes, "mesh frequenc")
    driven = [one.name for one in first.machine.meshes if abs(one.frequency - mesh) < 1e-6 * mesh]
    channel = channel or f"force {driven[0]}"
    fault = _last(notes, "fault frequenc") or _first(notes, "turning frequencies")
    lines = expected_lines(mesh, fault, count=2, harmonics=2)
    signals, spectra = {}, {}
    for case, one in found.items():
        values, rate = np.asarray(one[channel], dtype=float), 1 / (one.time[1] - one.time[0])
        signals[case] = Signal(values, rate, one.unit(channel), name=case)
        spectra[case] = spectrum(replace(signals[case], values=values - values.mean()))
    amplitudes = {case: {name: two[1] for name, two in find_lines(one, lines).items()} for case, one in spectra.items()}
    table = indicator_table(signals, mesh, fault)
    return Analysis(channel, first.unit(channel), lines, spectra, amplitudes, table)


def _last(notes, start):
    """Last frequency of the note whose name starts so, None without one (the last stage is the driven one)."""
    for name, value in notes.items():
        if name.startswith(start):
            return float(np.atleast_1d(value)[-1])
    return None


def _first(notes, start):
    for name, value in notes.items():
        if name.startswith(start):
            return float(np.atleast_1d(value)[0])
    return None

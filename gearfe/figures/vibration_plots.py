"""Plots (matplotlib) of vibration: spectra, kurtogram, phase portraits."""

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from ..core.files import save_figure
from ..geometry.aliases import Floats, StrPath
from ..signal.tooth_verdict import entered_teeth
from .look import COLOURS, MARKS, blank, look

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..signal.kurtogram import Kurtogram
    from ..signal.spectrum import Spectrum
    from ..signal.time_frequency import Spectrogram

LETTER = 0.014  # letter height relative to the axes width, to keep names apart


def plot_spectra(
    spectra: Mapping[str, "Spectrum"],
    lines: Mapping[str, float] | None = None,
    path: StrPath | None = None,
    top: float | None = None,
    *,
    dpi: int = 120,
    title: str = "",
) -> "Figure":
    """Draw spectra of one unit below each other, with dotted and named expected lines. Save to `path` if given.

    Parameters
    ----------
    spectra : dict of str to gearfe.signal.spectra.Spectrum
    lines : dict of str to float, optional
        See `gearfe.expected_lines`.
    path : path, optional
    top : float, optional
        Largest frequency or order; default 1.2 times the last line.
    dpi : int
        Dots per inch of the picture.
    title : str
        What is shown: scene, case, channel.
    """
    if not spectra:
        raise ValueError("spectra: give at least one")
    figure, rows = blank((9, 1 + 2 * len(spectra)), len(spectra), 1, sharex=True, sharey=True, squeeze=False)
    rows = rows[:, 0]
    largest = max(curve.values.max() for curve in spectra.values())
    for axes, (name, spectrum) in zip(rows, spectra.items(), strict=True):
        axes.semilogy(spectrum.frequency, spectrum.values, linewidth=0.8, color=COLOURS[0])
        axes.set_ylim(1e-6 * largest, 2 * largest)  # All spectra share the axes, so the limits must include each of them.
        axes.set_ylabel(f"[{spectrum.unit}]")
        axes.set_title(name, loc="right", fontsize=9, pad=3)
        for value in (lines or {}).values():
            axes.axvline(value, linestyle=":", linewidth=0.7, color="gray", zorder=0)
    if title:
        figure.suptitle(title, fontsize=10)
    end = 1.2 * max(lines.values()) if lines and top is None else top
    end = spectrum.frequency[-1] if end is None else end
    rows[-1].set_xlim(0, end)
    for name, place in _apart({name: value for name, value in (lines or {}).items() if value <= end}, LETTER * end).items():
        rows[0].annotate(
            name, (place, 1.02), xycoords=("data", "axes fraction"), rotation=90, fontsize=7, ha="center", va="bottom"
        )
    rows[-1].set_xlabel("order" if spectrum.axis == "order" else f"frequency [{spectrum.axis}]")
    return save_figure(figure, path, dpi=dpi)


def _apart(places, least):
    """Return places of labels by name, at least `least` apart and as near to the labelled values as possible."""
    names = sorted(places, key=places.get)
    wanted = np.array([places[name] for name in names], dtype=float)
    shifted = wanted.copy()
    for _ in range(len(names)):
        gaps = least - np.diff(shifted)
        push = np.where(gaps > 0, gaps / 2, 0.0)
        shifted += np.append(0.0, push) - np.append(push, 0.0)
    return dict(zip(names, shifted.tolist(), strict=True))


def plot_averages(
    averages: Mapping[str, tuple[Floats, Floats]], teeth: int, path: StrPath | None = None, *, unit: str = "", title: str = ""
) -> "Figure":
    """Draw synchronous averages and their difference signals over the angle of the shaft, by record.

    The largest difference is labelled by `entered_teeth` of a gear of `teeth`. Save to `path` if given.
    """
    figure, rows = blank((9, 0.5 + 2.4 * len(averages)), len(averages), 2, sharex=True, sharey="col", squeeze=False)
    for pair, (name, shown) in zip(rows, averages.items(), strict=True):
        for axes, values, told in zip(pair, shown, ("average", "difference signal"), strict=True):
            angle = 360 * np.arange(values.size) / values.size
            axes.plot(angle, values, linewidth=0.8, color=COLOURS[0])
            axes.set_title(f"{name}: {told}", fontsize=9)
            axes.set_ylabel(f"[{unit}]")
        most = int(np.argmax(np.abs(shown[1])))
        last, before = entered_teeth(math.radians(angle[most]), teeth)
        label = f"{angle[most]:.0f}°, teeth {before}, {last}"
        pair[1].annotate(label, (angle[most], shown[1][most]), fontsize=8, color=COLOURS[1])
    for axes in rows[-1]:
        axes.set(xlabel="angle of the shaft [degrees]; tooth 0 enters at 0", xlim=(0, 360))
    if title:
        figure.suptitle(title, fontsize=10)
    return save_figure(figure, path, dpi=120)


def plot_trend(rows: Mapping[str, Mapping[str, float]], path: StrPath | None = None) -> "Figure":
    """Draw indicators of records in the order of their measurement, relative to the first record.

    Save to `path` if given.
    """
    figure, axes = blank((9, 4))
    names = list(next(iter(rows.values())))
    for number, name in enumerate(names):
        values = np.array([row.get(name, np.nan) for row in rows.values()])
        axes.semilogy(values / values[0], label=name, marker=MARKS[number % len(MARKS)], **look(number))
    axes.set_xticks(range(len(rows)), list(rows), rotation=60, fontsize=7, ha="right")
    axes.set_ylabel("value over that of the first record")
    axes.legend(loc="center left", bbox_to_anchor=(1, 0.5), fontsize=8)
    return save_figure(figure, path, dpi=120)


def plot_kurtogram(kurtogram: "Kurtogram", path: StrPath | None = None, title: str = "") -> "Figure":
    """Draw a `gearfe.signal.kurtogram.Kurtogram` under a `title`, and frame the best band. Save to `path` if given."""
    from matplotlib import cm, colormaps, colors

    figure, axes = blank((7, 4))
    levels = np.unique(kurtogram.level)
    top = kurtogram.kurtosis.max()
    low = kurtogram.centre - kurtogram.bandwidth / 2
    for row, level in enumerate(levels):
        in_row = kurtogram.level == level
        shades = colormaps["viridis"](np.clip(kurtogram.kurtosis[in_row] / max(top, 1e-300), 0, 1))
        axes.barh(row, kurtogram.bandwidth[in_row], 1.0, left=low[in_row], color=shades, align="center")
    scale = cm.ScalarMappable(colors.Normalize(0, max(top, 1e-300)), "viridis")
    figure.colorbar(scale, ax=axes, label="spectral kurtosis [-] (0: noise; below it as 0)")
    best = kurtogram.best
    row = int(np.searchsorted(levels, kurtogram.level[best]))
    axes.barh(row, kurtogram.bandwidth[best], 1.0, left=low[best], fill=False, edgecolor="#d55e00", linewidth=2)
    axes.set_yticks(range(levels.size), [f"{level:.3g}" for level in levels])
    axes.invert_yaxis()
    axes.set(xlabel="frequency [Hz]", ylabel="level")
    best_band = f"kurtosis up to {top:.3g}, in {kurtogram.band[0]:.0f} to {kurtogram.band[1]:.0f} Hz"
    axes.set_title(f"{title}: {best_band}" if title else best_band, fontsize=9)
    return save_figure(figure, path, dpi=120)


def plot_spectrogram(spectrogram: "Spectrogram", path: StrPath | None = None, title: str = "") -> "Figure":
    """Draw a `gearfe.signal.time_frequency.Spectrogram` with a range of 80 dB under a `title`. Save to `path` if given."""
    figure, axes = blank((9, 4))
    largest = max(float(spectrogram.values.max()), 1e-300)
    shown = 20 * np.log10(np.maximum(spectrogram.values / largest, 1e-4))
    drawn = axes.pcolormesh(spectrogram.time, spectrogram.frequency, shown, cmap="viridis", shading="nearest", rasterized=True)
    figure.colorbar(drawn, ax=axes, label=f"amplitude [dB re {largest:.3g} {spectrogram.unit}]")
    axes.set(xlabel="time [s]", ylabel="frequency [Hz]")
    axes.set_title(title or spectrogram.name, fontsize=9)
    return save_figure(figure, path, dpi=120)


def plot_cepstrum(found: "Spectrum", path: StrPath | None = None, title: str = "") -> "Figure":
    """Draw a cepstrum (`gearfe.cepstrum`) from a thousandth of its length on. Save to `path` if given."""
    figure, axes = blank((9, 3))
    first = max(1, found.values.size // 1000)  # The beginning of the cepstrum contains the spectral envelope and is not drawn.
    axes.plot(found.frequency[first:], found.values[first:], linewidth=0.7)
    axes.set(xlabel="quefrency [s]", ylabel="cepstrum [-]")
    axes.set_title(title or found.name, fontsize=9)
    return save_figure(figure, path, dpi=120)


def plot_phase(
    portrait: tuple[Floats, Floats],
    section: Floats | None = None,
    unit: str = "m",
    path: StrPath | None = None,
    title: str = "",
) -> "Figure":
    """Draw a phase portrait (`gearfe.phase_portrait`) with the points of a Poincare section.

    Save to `path` if given.
    """
    if portrait[0].shape != portrait[1].shape:
        raise ValueError(
            f"portrait: {portrait[0].size} displacements and {portrait[1].size} velocities, but give the same number of both"
        )
    figure, axes = blank((5, 4))
    axes.plot(*portrait, linewidth=0.4, color=COLOURS[0])
    if section is not None and np.shape(section)[1:] != (2,):
        raise ValueError(f"section of shape {np.shape(section)}: give displacement and velocity of each point (n, 2)")
    if section is not None:
        axes.plot(*np.transpose(section), ".", color=COLOURS[1], markersize=5, label="Poincaré section")
        axes.legend(fontsize=8)
    axes.ticklabel_format(scilimits=(-2, 3))
    axes.set_title(title, fontsize=10)
    axes.set(xlabel=f"displacement [{unit}]", ylabel=f"velocity [{unit}/s]")
    return save_figure(figure, path, dpi=120)

"""Lines of a measured or computed spectrum, named by the frequencies of a scene's machine."""

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from scipy.ndimage import median_filter

from ..core.table import Column, Table
from ..dynamics.machine.lines import scene_lines
from ..dynamics.machine.of_scene import flat_machine
from ..scene.load import Scene
from ..signal.spectral_lines import between_bins
from ..signal.spectrum import Spectrum

AROUND = 50  # half-width of the median window [bins]
NEAR = 2  # largest distance between a line and its named frequency [bins]
ROTATIONS, BEARINGS, SIDEBANDS = 5, 3, 30  # harmonics of shafts and of bearing faults; largest sideband order of meshes


class Named(NamedTuple):
    """A spectral line between bins: frequency [Hz], amplitude, ratio of its bin to the local median, name (empty if unknown)."""

    frequency: float
    amplitude: float
    times: float
    name: str


def named_lines(found: Spectrum, scene: Scene, times: float = 10.0) -> tuple[list[Named], float]:
    """Lines of a spectrum above the local median, with the simplest name that the scene's machine gives them.

    Names are harmonics of rotations and bearing faults, mesh harmonics up to the end of the spectrum, and their sidebands at the
    rotations of the stage, which a local fault has many of. Harmonics come before sidebands, and low ones before high ones. Equal
    frequencies of several parts have all their names.

    Parameters
    ----------
    found : Spectrum
        Of amplitudes, over frequency [Hz].
    scene : Scene
        At the speed of the record.
    times : float
        Least amplitude over the local median.

    Returns
    -------
    lines : list of Named
        By rising frequency.
    covered : float
        Part of the bins that some name would fit: the probability that a line by chance is named.
    """
    values, step = found.values, found.resolution
    floor = median_filter(values, 2 * AROUND + 1, mode="mirror")
    inner = values[1:-1]
    peak = np.flatnonzero((inner >= values[:-2]) & (inner > values[2:]) & (inner >= times * floor[1:-1])) + 1
    names = sorted(_names(scene, float(found.frequency[-1])))
    places = np.array([frequency for _, frequency, _ in names])
    fits = np.zeros(values.size, dtype=bool)
    for place in np.rint(places / step).astype(int):
        fits[max(place - NEAR, 0) : place + NEAR + 1] = True
    out = []
    for i in peak:
        frequency, amplitude = between_bins(found, int(i))
        near = [names[j] for j in np.flatnonzero(np.abs(places - frequency) <= NEAR * step)]
        same = [text for rank, place, text in near if rank == near[0][0] and math.isclose(place, near[0][1])]
        ratio = float(values[i] / floor[i]) if floor[i] else math.inf
        out.append(Named(frequency, amplitude, ratio, " or ".join(dict.fromkeys(same))))
    return out, float(fits.mean())


def _names(scene, top) -> Iterator[tuple[int, float, str]]:
    """Yield rank, frequency and text of all named lines below `top` [Hz]."""
    for line in scene_lines(scene):
        bearing = line.name[:2] in ("FT", "BP", "BS")
        mesh = line.name == "mesh frequency"
        most = math.floor(top / line.frequency) if mesh else BEARINGS if bearing else ROTATIONS
        for k in range(1, most + 1):
            if k * line.frequency < top and "hunting" not in line.name:
                times = f"{k} x " if k > 1 else ""
                yield k + ROTATIONS * bearing, k * line.frequency, f"{times}{line.name}, {line.part}"
    for stage in flat_machine(scene).stages:
        spacings = {f"f({body})": value for body, value in stage.returns.items()} | {f"f({stage.driver[0]})": stage.turning}
        spacings |= {"carrier": abs(stage.carrier)} if stage.carrier else {}
        for n in range(1, math.floor(top / stage.mesh) + 1):
            for name, spacing in spacings.items():
                # Sidebands of higher order would overlap with those of the next harmonic.
                most = min(SIDEBANDS, math.floor(stage.mesh / spacing / 2))
                for j in (*range(-most, 0), *range(1, most + 1)):
                    text = f"{n} x mesh frequency {'+' if j > 0 else '-'} {abs(j)} {name}, stage {stage.name}"
                    yield 100 + abs(j), n * stage.mesh + j * spacing, text


def named_table(found: Spectrum, scene: Scene, times: float = 10.0) -> tuple[Table, str]:
    """Return the table of `named_lines`, and a sentence with the number of named lines."""
    lines, covered = named_lines(found, scene, times)
    columns = [
        Column("frequency", "Hz", "{:.2f}"),
        Column("amplitude", found.unit, "{:.3g}"),
        Column("times the median", "", "{:.3g}"),
        "name",
    ]
    named = sum(bool(line.name) for line in lines)
    told = f"{named} of {len(lines)} lines of {times:g} times the local median are named"
    return Table(columns, [list(line) for line in lines]), f"{told}; names fit {100 * covered:.2g} % of all bins"

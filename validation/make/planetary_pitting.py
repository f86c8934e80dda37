"""Printed numbers of articles S0 and S1 (planetary stage with pitted sun teeth), computed by gearfe."""

from functools import cache, partial

import numpy as np

import gearfe as gf

from ..shared.laws import beside, tables
from ..shared.simulated import amplitude, by_name, scene, spectrum, told
from .planetary_numbers import CASES, NAME, QUICK, lengths, speeds  # noqa: F401
from .planetary_repeats import (  # noqa: F401
    JUDGED_ON,
    PRINTED,
    ROUNDING,
    about_impacts,
    about_spectra,
    drawn,
    further,
    section,
    spread,
    strewn,
    write_repeats,
)
from .planetary_runs import (  # noqa: F401
    ALONE,
    FINE,
    FORCE,
    LINEAR,
    OWN,
    RATE,
    ROWS,
    SECONDS,
    SENSOR,
    SETTLE,
    STEADY,
    finer,
    linear,
    record_of,
    ring_path,
    sidebands_of,
    spectrum_of,
    values_of,
)  # fmt: skip

PATHS = {"raised cosine": lambda: None, "ring on its bearing": ring_path}


@cache
def _housing(case, path="raised cosine"):
    """Return the spectrum of the ring mesh forces at a sensor on the ring, through a transfer path, without pulses."""
    return spectrum(gf.housing_signal(record_of(case, False), window=PATHS[path]()))


def sc_simulated(law=OWN):
    """Return the sideband centroid by S0's definition for the force of a sun mesh, under impacts."""
    return {case: values_of(case, True, law=law)["SC (S0)"] for case in CASES}


def _measured(name, law=OWN):
    """Return an indicator of the acceleration of the ring, under impacts."""
    return {case: values_of(case, True, SENSOR, law)[name] for case in CASES}


MEASURED = {  # by reference: indicator
    "sc_measured": "SC (S0)", "rms": "rms", "kurtosis": "kurtosis", "shape_factor": "shape factor", "amplitudes": "peak",
}  # fmt: skip


def rms_without_pulses(law=OWN):
    """Return the RMS value of the ring acceleration without impacts."""
    return {case: values_of(case, False, SENSOR, law)["rms"] for case in CASES}


@cache
def folded(law=OWN):
    """Return the healthy force at 240 and 320 Hz over its mesh line, at 10 000 samples per second (S0) and at `FINE`."""
    found = spectrum_of("healthy", False, law=law), finer("healthy", law)
    return [(amplitude(one, 240.0) + amplitude(one, 320.0)) / 2 / amplitude(one, 280.0) for one in found]


@cache
def carrier_lines(case, path="raised cosine"):
    """Return the mean housing amplitude [N] of lines one carrier frequency from multiples of the sun's relative rotation.

    Multiples of 3 are omitted, because a healthy stage with equal planets has lines there.
    """
    _, carrier, mesh, fault = speeds()
    turn, carrier = fault / scene(NAME).machine["n_planets"], carrier / 60
    found = _housing(case, path)
    beside = [mesh + k * turn + side * carrier for k in (-5, -4, -2, -1, 1, 2, 4, 5) for side in (-1, 1)]
    return float(np.mean([amplitude(found, f, 0.4) for f in beside]))


@cache
def main_line(case, path="raised cosine"):
    """Return the amplitude [N] of the largest line among f_m and f_m +- 3 f_c."""
    _, carrier, mesh, _ = speeds()
    return max(amplitude(_housing(case, path), mesh + 3 * j * carrier / 60, 0.4) for j in (-1, 0, 1))


@cache
def housing_lines(path="raised cosine"):
    """Return `carrier_lines` in percent of `main_line`. Values below a millionth of it are zero."""
    parts = {case: carrier_lines(case, path) / main_line(case, path) for case in ("healthy", *CASES)}
    return {case: 100 * part if part > 1e-6 else 0.0 for case, part in parts.items()}


def passing(path):
    """Return amplitudes of the healthy mesh line and of the planet-pass lines 3 f_c from it [% of the larger]."""
    _, carrier, mesh, _ = speeds()
    places = {"f_m - 3 f_c": mesh - carrier / 20, "f_m": mesh, "f_m + 3 f_c": mesh + carrier / 20}
    found = {name: 100 * amplitude(_housing("healthy", path), f, 0.4) / main_line("healthy", path) for name, f in places.items()}
    return {name: value if value > 1e-4 else 0.0 for name, value in found.items()}


def seen(path):
    """Return whether the statement on sidebands at the carrier frequency holds for a transfer path."""
    lines = housing_lines(path)
    return {"holds": min(lines[case] for case in CASES) > max(1.0, 10 * lines["healthy"])}


def statements(law=OWN):
    """Evaluate the statements of the articles on spectra and indicators."""
    mesh, fault = speeds()[2:]
    out = about_spectra(law) | about_impacts(law)
    out["a healthy machine has no fault sidebands, sampled as in S0"] = folded(law)[0] < 0.01
    out["a healthy machine has no fault sidebands, sampled finer"] = folded(law)[1] < 0.01
    if law == OWN:
        out |= {"sidebands at the carrier frequency beside the sun's harmonics": seen("raised cosine")["holds"]}
        out |= {"the window of SC allows 349.8 and 352.9 Hz": mesh + fault >= 349.8}
    return out


def finer_sidebands(law=OWN):
    """Return the mean amplitude [N] at f_m +- f_fault, sampled at `FINE`. Rounding errors are set to zero."""
    mesh, fault = speeds()[2:]
    found = {case: finer(case, law) for case in ("healthy", *CASES)}
    side = {case: (amplitude(one, mesh - fault) + amplitude(one, mesh + fault)) / 2 for case, one in found.items()}
    return {case: value if value > ROUNDING else 0.0 for case, value in side.items()}


def also():
    """Evaluate the statements of `sources/statements.toml`."""
    healthy, *pitted = finer_sidebands().values()
    return further() | {"pits raise sidebands 40 Hz beside 280 Hz, sampled finer": min(pitted) > 10 * healthy}


def sidebands(law=OWN):
    """Return the force sidebands [N] that decide the first two statements, and the mesh line."""
    lines = {case: sidebands_of(case, law) for case in ("healthy", *CASES)}
    return lines | {"healthy, mesh line": amplitude(spectrum_of("healthy", False, law=law), speeds()[2])}


def runs():
    """Return the settings of the simulations."""
    return {
        OWN: told(record_of("healthy", True)),
        OWN + STEADY: told(record_of("healthy", False)),
        ROWS: told(record_of("healthy", True, ROWS)),
        LINEAR: told(record_of("healthy", True, LINEAR)),
        LINEAR + STEADY: told(record_of("healthy", False, LINEAR)),
    }


def write_more():
    """Write the tables of the statements under all force laws."""
    beside("planetary_pitting", BESIDE, OWN, ROWS, LINEAR, ALONE)
    write_repeats()
    beside("planetary_pitting_paths", BY_PATH, *PATHS)


def more():
    """Return further sections of the page."""
    laws = tables("planetary_pitting", BOTH, OWN, ROWS, LINEAR, ALONE)
    paths = ["## The path to a sensor on the ring", "", *tables("planetary_pitting_paths", BOTH_PATHS, *PATHS)]
    return ["## One line of pits, or rows of five", "", *laws, *section(), *paths, CENTROID, ""]


CENTROID = "What the two formulas of SC do on synthetic lines: [sideband_centroid.md](sideband_centroid.md)."
BOTH = (
    "The articles' formula, L = 2 b - N l, has the N = 5, 10, 15 pits of a level on one line of contact. The verdicts use such "
    "pits on the pitch circle, 1 mm wide, so that 5, 10 and 15 of the 20 mm are lost at once. The cases mild_rows, moderate_rows "
    "and severe_rows have rows of five on one, two and three lines. The last two columns have one line and the linear stiffness "
    "curves of the pitted teeth, in the whole set and as isolated pairs. The impact law has a coefficient instead of curves, so "
    "that the set changes no verdict"
)


BOTH_PATHS = (
    "The articles print no transmission path from mesh to sensor. The verdicts use the raised cosine. The other path is "
    "`gf.ring_window` of the ring between its root circle and rim, on a foundation of 1e8 N/m. A ring with a centre line of"
    " constant length has no mean response over a revolution of the carrier. The mesh line of equal planets in phase then "
    "vanishes, and the lines 3 f_c from it remain. The sun makes 84/21 = 4 revolutions relative to the carrier in one "
    "revolution of the carrier. Lines one carrier frequency from the sun's harmonics are therefore also lines of the "
    "passing planets. With several harmonics in the path, a healthy stage has them, too. Impact law, without pulses"
)


PICTURES = {
    "planetary_pitting_lines": "Total contact line of the pitted sun tooth, with S0's half chord dashed "
    "(tables/planetary_pitting_lines.csv)",
    "planetary_pitting_spectra": "Force of a sun mesh under the impact law, without pulses",
    "planetary_pitting_housing": "Signal of a sensor on the housing: forces of the ring's meshes, without pulses of the carrier",
}


def draw(folder):
    """Draw the pictures of the page."""
    from gearfe.figures.vibration_plots import plot_spectra

    from ..shared.plots import plot_lengths

    phase, ours, printed = lengths()
    plot_lengths(
        phase, ours, printed, folder / "planetary_pitting_lines.png", title=f"{NAME}, sun_planet", told="S0's half chord"
    )
    names = ["phase", *(f"L {name} [mm]" for name in ours), *(f"L {name} by S0's chord [mm]" for name in printed)]
    columns = np.transpose([phase, *ours.values(), *printed.values()])[::4]
    np.savetxt(folder / "tables" / "planetary_pitting_lines.csv", columns, "%.6g", ",", header=",".join(names), comments="")
    lines = gf.expected_lines(*speeds()[2:], count=2, harmonics=2)
    spectra = {case: spectrum_of(case, False) for case in ("healthy", *CASES)}
    plot_spectra(
        spectra, lines, folder / "planetary_pitting_spectra.png", 800.0, dpi=60, title=f"{NAME}, force of a sun mesh, impact law"
    )
    carrier, turn = speeds()[1] / 60, speeds()[3] / scene(NAME).machine["n_planets"]
    lines = {"f_m": speeds()[2], "f_m + f_1 + f_c": speeds()[2] + turn + carrier, "f_m + f_1 - f_c": speeds()[2] + turn - carrier}
    heard = {case: _housing(case) for case in ("healthy", *CASES)}
    plot_spectra(
        heard, lines, folder / "planetary_pitting_housing.png", 400.0, dpi=70, title=f"{NAME}, ring's forces at the housing"
    )


SIMULATED = by_name(sc_simulated, housing_lines, statements) | {"further": also}
SIMULATED |= {reference: partial(_measured, name) for reference, name in MEASURED.items()}
RUN_OF = dict.fromkeys(SIMULATED, OWN) | {"housing_lines": OWN + STEADY}
BESIDE = {
    "SC, force [Hz]": sc_simulated,
    "SC, ring acceleration [Hz]": SIMULATED["sc_measured"],
    "RMS [m/s^2]": SIMULATED["rms"],
    "RMS without pulses [m/s^2]": rms_without_pulses,
    "kurtosis": SIMULATED["kurtosis"],
    "shape factor": SIMULATED["shape_factor"],
    "peak [m/s^2]": SIMULATED["amplitudes"],
    "sidebands f_m +- 40 Hz [N]": sidebands,
    f"the same, sampled {FINE:g} times a second [N]": finer_sidebands,
    "bandwidth of the sidebands [Hz]": spread,
    "force of the damaged tooth over the others'": strewn,
    "the articles say": statements,
}
BY_PATH = {
    "healthy [% of the largest of the three]": passing,
    "lines one carrier turn beside the sun's harmonics [% of that]": housing_lines,
    "sidebands at the carrier frequency beside the sun's harmonics": seen,
}

"""Printed numbers of articles S0 and S1 (planetary stage with pitted sun teeth), computed by gearfe."""

from functools import cache, partial

import numpy as np

import gearfe as gf

from ..shared.simulated import amplitude, by_name, scene, spectrum
from .planetary_numbers import CASES, NAME, QUICK, lengths, speeds  # noqa: F401
from .planetary_repeats import JUDGED_ON, PRINTED, about_impacts, about_spectra, drawn, further  # noqa: F401
from .planetary_runs import FORCE, OWN, RATE, SECONDS, SENSOR, SETTLE, finer  # noqa: F401

ROUNDING = 1e-9  # rounding limit of sidebands of the mesh force [N]


@cache
def _housing(case):
    """Spectrum of the forces of the ring meshes at a sensor on the ring, by a raised cosine and without pulses."""
    return spectrum(gf.housing_signal(OWN.records((case, False))))


def sc_simulated():
    """Return the sideband centroid by S0's definition for the force of a sun mesh, under impacts."""
    return {case: OWN.values(case, True)["SC (S0)"] for case in CASES}


def _measured(name):
    """Return an indicator of the acceleration of the ring, under impacts."""
    return {case: OWN.values(case, True, SENSOR)[name] for case in CASES}


MEASURED = {  # by reference: indicator
    "sc_measured": "SC (S0)", "rms": "rms", "kurtosis": "kurtosis", "shape_factor": "shape factor", "amplitudes": "peak",
}  # fmt: skip


def folded():
    """Return the healthy force at 240 and 320 Hz over its mesh line, at 10 000 samples per second (S0) and at `FINE`."""
    found = OWN.channel(FORCE).spectrum(("healthy", False)), finer("healthy")
    return [(amplitude(one, 240.0) + amplitude(one, 320.0)) / 2 / amplitude(one, 280.0) for one in found]


def carrier_lines(case):
    """Return the mean housing amplitude [N] of lines one carrier frequency from multiples of the sun's relative rotation.

    Multiples of 3 are omitted, because a healthy stage with equal planets has lines there.
    """
    _, carrier, mesh, fault = speeds()
    turn, carrier = fault / scene(NAME).machine["n_planets"], carrier / 60
    beside = [mesh + k * turn + side * carrier for k in (-5, -4, -2, -1, 1, 2, 4, 5) for side in (-1, 1)]
    return float(np.mean([amplitude(_housing(case), f, 0.4) for f in beside]))


@cache
def housing_lines():
    """Return the same in percent of the largest line of f_m and f_m +- 3 f_c, zero where it is below a millionth of it."""
    _, carrier, mesh, _ = speeds()
    cases = ("healthy", *CASES)
    most = {case: max(amplitude(_housing(case), mesh + j * carrier / 20, 0.4) for j in (-1, 0, 1)) for case in cases}
    parts = {case: carrier_lines(case) / most[case] for case in cases}
    return {case: 100 * part if part > 1e-6 else 0.0 for case, part in parts.items()}


def statements():
    """Evaluate the statements of the articles on spectra and indicators."""
    mesh, fault = speeds()[2:]
    lines = housing_lines()
    return (
        about_spectra()
        | about_impacts()
        | {
            "a healthy machine has no fault sidebands, sampled as in S0": folded()[0] < 0.01,
            "a healthy machine has no fault sidebands, sampled finer": folded()[1] < 0.01,
            "sidebands at the carrier frequency beside the sun's harmonics": min(lines[case] for case in CASES)
            > max(1.0, 10 * lines["healthy"]),
            "the window of SC allows 349.8 and 352.9 Hz": mesh + fault >= 349.8,
        }
    )


def also():
    """Statements of `sources/statements.toml`. Sidebands [N] below 1e-9 are rounding errors."""
    mesh, fault = speeds()[2:]
    found = {case: finer(case) for case in ("healthy", *CASES)}
    side = {case: (amplitude(one, mesh - fault) + amplitude(one, mesh + fault)) / 2 for case, one in found.items()}
    healthy, *pitted = (value if value > ROUNDING else 0.0 for value in side.values())
    return further() | {"pits raise sidebands 40 Hz beside 280 Hz, sampled finer": min(pitted) > 10 * healthy}


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
    spectra = {case: OWN.channel(FORCE).spectrum((case, False)) for case in ("healthy", *CASES)}
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

"""The printed numbers of articles S0 and S1 (planetary stage with pitted sun teeth), computed."""

from functools import cache

import numpy as np

import gearfe as gf

from ..shared.laws import beside, tables
from ..shared.simulated import amplitude, knocked, machine, own_law, record, scene, signal, spectrum, told
from . import centroid
from .planetary_numbers import CASES, NAME, QUICK, lengths, speeds  # noqa: F401

SECONDS, SETTLE = 2.0, 0.25
RATE = 10000.0  # S0: 100 000 steps in 10 s
FINE = 256 * 280.0  # above twice the highest natural frequency, 16.5 kHz; a multiple of f_m
OWN, LINEAR = "impact law", "linear stiffness"
STEADY = ", no pulses"
FORCE, SENSOR = "force sun_planet1", "ring.y acceleration"


@cache
def _record(case, impact, law=OWN):
    """Response of a case with or without pulses on the carrier, under S0's law or with linear stiffness curves."""
    name, options = None if case == "healthy" else case, scene(NAME).machine["impact"]
    if law == OWN:
        made = own_law(NAME, name, pulsed=impact)
    else:
        made = machine(NAME, name)
        made = knocked(made, "carrier torque", options, SECONDS + SETTLE) if impact else made
    return record(made, SECONDS, RATE, SETTLE)


@cache
def _values(case, impact, channel=FORCE, law=OWN):
    """Indicators of a channel."""
    return signal(_record(case, impact, law), channel).indicators(*speeds()[2:])


@cache
def _spectrum(case, impact, channel=FORCE, law=OWN):
    return spectrum(signal(_record(case, impact, law), channel))


BEARING = 1e8  # N/m, of the ring: the default of `gf.pitted_planetary`


def ring_path():
    """Window of a ring-fixed sensor: the thin ring between root circle and rim of the scene, on its bearing as a foundation."""
    ring = scene(NAME).pairs["planet_ring"].pair.gear_2
    thick, radius = 1e-3 * (ring.r_rim - ring.r_f), 5e-4 * (ring.r_rim + ring.r_f)
    bending = 1e6 * scene(NAME).pairs["planet_ring"].materials[1].E * 1e-3 * ring.b * thick**3 / 12
    return gf.ring_window(radius, bending, BEARING / (np.pi * radius))


PATHS = {"raised cosine": lambda: None, "ring on its bearing": ring_path}


@cache
def _housing(case, path="raised cosine"):
    """Spectrum of the forces in the ring's meshes as a sensor on the ring hears them through a path, without pulses."""
    return spectrum(gf.housing_signal(_record(case, False), window=PATHS[path]()))


def sc_simulated(law=OWN):
    """S0's definition on the force of a sun mesh, under impacts."""
    return {case: _values(case, True, law=law)["SC (S0)"] for case in CASES}


def sc_measured(law=OWN):
    """S0's definition on the acceleration of the ring, under impacts."""
    return _measured("SC (S0)", law)


def _measured(name, law):
    return {case: _values(case, True, SENSOR, law)[name] for case in CASES}


def rms(law=OWN):
    """Of the acceleration of the ring, under impacts."""
    return _measured("rms", law)


def kurtosis(law=OWN):
    """Of the same."""
    return _measured("kurtosis", law)


def shape_factor(law=OWN):
    """Of the same."""
    return _measured("shape factor", law)


def amplitudes(law=OWN):
    """Largest acceleration of the ring, under impacts."""
    return _measured("peak", law)


def _sidebands(case, law=OWN):
    """Mean amplitude of the force at f_m +- f_fault without pulses [N]."""
    mesh, fault = speeds()[2:]
    found = _spectrum(case, False, law=law)
    return (amplitude(found, mesh - fault) + amplitude(found, mesh + fault)) / 2


@cache
def folded(law=OWN):
    """Healthy force at 240 Hz over its mesh line: 10 000 samples per second as in S0, and `FINE`."""
    made = own_law(NAME, pulsed=False) if law == OWN else machine(NAME)
    finer = spectrum(signal(record(made, 0.3, FINE, SETTLE), FORCE))
    return [amplitude(one, 240.0) / amplitude(one, 280.0) for one in (_spectrum("healthy", False, law=law), finer)]


@cache
def carrier_lines(case, path="raised cosine"):
    """Mean amplitude [N] on the housing one carrier turn beside multiples of the sun's turns relative to the carrier.

    Multiples by 3 are left out: there a healthy stage with equal planets has lines of its own.
    """
    _, carrier, mesh, fault = speeds()
    turn, carrier = fault / scene(NAME).machine["n_planets"], carrier / 60
    found = _housing(case, path)
    beside = [mesh + k * turn + side * carrier for k in (-5, -4, -2, -1, 1, 2, 4, 5) for side in (-1, 1)]
    return float(np.mean([amplitude(found, f, 0.4) for f in beside]))


@cache
def main_line(case, path="raised cosine"):
    """Amplitude [N] of the largest of f_m and f_m +- 3 f_c: a window without a mean leaves nothing at f_m itself."""
    _, carrier, mesh, _ = speeds()
    return max(amplitude(_housing(case, path), mesh + 3 * j * carrier / 60, 0.4) for j in (-1, 0, 1))


@cache
def housing_lines(path="raised cosine"):
    """The same in percent of `main_line`, zero where it is below a millionth of it."""
    parts = {case: carrier_lines(case, path) / main_line(case, path) for case in ("healthy", *CASES)}
    return {case: 100 * part if part > 1e-6 else 0.0 for case, part in parts.items()}


def passing(path):
    """Amplitudes of the healthy mesh line and of what the passing planets put 3 f_c beside it [% of the larger]."""
    _, carrier, mesh, _ = speeds()
    places = {"f_m - 3 f_c": mesh - carrier / 20, "f_m": mesh, "f_m + 3 f_c": mesh + carrier / 20}
    found = {name: 100 * amplitude(_housing("healthy", path), f, 0.4) / main_line("healthy", path) for name, f in places.items()}
    return {name: value if value > 1e-4 else 0.0 for name, value in found.items()}


def seen(path):
    """Whether the statement on sidebands at the carrier's frequency holds through a path."""
    lines = housing_lines(path)
    return {"holds": min(lines[case] for case in CASES) > max(1.0, 10 * lines["healthy"])}


def statements(law=OWN):
    """What the articles say of spectra and indicators; see the scene for the words."""
    mesh, fault = speeds()[2:]
    side = {case: _sidebands(case, law) for case in ("healthy", *CASES)}
    knocked_peak = {impact: np.ptp(signal(_record("healthy", impact, law), FORCE).values) for impact in (False, True)}
    rate = 1 / scene(NAME).machine["impact"]["pulse_period_s"]
    beside = [amplitude(_spectrum("healthy", impact, law=law), mesh + rate, 1 / SECONDS) for impact in (False, True)]
    s0, s1 = ([_values(case, True, law=law)[name] for case in CASES] for name in ("SC (S0)", "SC (S1)"))
    calm = [_values(case, False, law=law)["SC (S1)"] for case in CASES]
    out = {
        "pits raise sidebands 40 Hz beside 280 Hz": min(side[case] for case in CASES) > 10 * side["healthy"],
        "they grow with severity": side["healthy"] < side["mild"] < side["moderate"] < side["severe"],
        "impacts raise the force": knocked_peak[True] > 1.1 * knocked_peak[False],
        "impacts bring close sidebands of the mesh line": beside[1] > 10 * beside[0],
        "SC by S0's formula rises with severity": bool((np.diff(s0) > 0.1).all()),
        "SC by S1's formula rises with severity": bool((np.diff(s1) > 0.01 * s1[0]).all()),
        "SC by S1's formula is little affected by impacts": max(abs(a / b - 1) for a, b in zip(s1, calm, strict=True)) < 0.1,
        "a healthy machine has no such sidebands, sampled as in S0": folded(law)[0] < 0.01,
        "a healthy machine has no such sidebands, sampled finer": folded(law)[1] < 0.01,
    }
    if law == OWN:
        out |= {"sidebands at the carrier's frequency beside them": seen("raised cosine")["holds"]}
        out |= {"the window of SC allows 349.8 and 352.9 Hz": mesh + fault >= 349.8}
    return out


def sidebands(law=OWN):
    """Sidebands of the force [N] behind the first two statements, and the mesh line."""
    lines = {case: _sidebands(case, law) for case in ("healthy", *CASES)}
    return lines | {"healthy, mesh line": amplitude(_spectrum("healthy", False, law=law), speeds()[2])}


def runs():
    """What the simulations were made with."""
    return {
        OWN: told(_record("healthy", True)),
        OWN + STEADY: told(_record("healthy", False)),
        LINEAR: told(_record("healthy", True, LINEAR)),
        LINEAR + STEADY: told(_record("healthy", False, LINEAR)),
    }


def write_more():
    """Table of both laws."""
    beside("planetary_pitting", BESIDE, OWN, LINEAR)
    beside("planetary_pitting_paths", BY_PATH, *PATHS)


def more():
    """Lines of the page beside the verdicts."""
    laws = tables("planetary_pitting", BOTH, OWN, LINEAR)
    paths = ["## The path to a sensor on the ring", "", *tables("planetary_pitting_paths", BOTH_PATHS, *PATHS)]
    return [*laws, *paths, *centroid.section()]


BOTH = (
    "The same quantities under the articles' own law, which is judged above, and with the linear stiffness curves of the pitted "
    "teeth; the healthy sidebands are what 'pits raise sidebands' compares with"
)


BOTH_PATHS = (
    "What the path from mesh to sensor changes: the raised cosine by which the verdicts are judged, and `gf.ring_window` of the "
    "ring between its root circle and rim, on a foundation as stiff as its bearing, 1e8 N/m; none of it is printed. A ring whose "
    "centre line keeps its length gives nothing on average over a turn of the carrier: the mesh line of equal planets in "
    "phase goes and what is 3 f_c beside it stays. The sun turns 84/21 = 4 times in a turn of the carrier relative to it, so "
    "that lines one carrier turn beside the sun's harmonics lie where the passing planets put theirs: through a path with more "
    "harmonics than one a healthy stage has them too. Impact law, without pulses"
)


PICTURES = {
    "planetary_pitting_lines": "Total contact line of the pitted sun tooth, with S0's half chord dashed "
    "(tables/planetary_pitting_lines.csv)",
    "planetary_pitting_spectra": "Force of a sun mesh under the impact law, without pulses",
    "planetary_pitting_housing": "Forces in the ring's meshes as a sensor on the housing hears them, without pulses",
}


def draw(folder):
    """Pictures of the page."""
    from gearfe.pictures.stiffness_plots import plot_lengths
    from gearfe.pictures.vibration_plots import plot_spectra

    phase, ours, printed = lengths()
    plot_lengths(
        phase, ours, printed, folder / "planetary_pitting_lines.png", title=f"{NAME}, sun_planet", told="S0's half chord"
    )
    names = ["phase", *(f"L {name} [mm]" for name in ours), *(f"L {name} by S0's chord [mm]" for name in printed)]
    columns = np.transpose([phase, *ours.values(), *printed.values()])[::4]
    np.savetxt(folder / "tables" / "planetary_pitting_lines.csv", columns, "%.6g", ",", header=",".join(names), comments="")
    lines = gf.expected_lines(*speeds()[2:], count=2, harmonics=2)
    spectra = {case: _spectrum(case, False) for case in ("healthy", *CASES)}
    plot_spectra(
        spectra, lines, folder / "planetary_pitting_spectra.png", 800.0, dpi=60, title=f"{NAME}, force of a sun mesh, impact law"
    )
    carrier, turn = speeds()[1] / 60, speeds()[3] / scene(NAME).machine["n_planets"]
    lines = {"f_m": speeds()[2], "f_m + f_1 + f_c": speeds()[2] + turn + carrier, "f_m + f_1 - f_c": speeds()[2] + turn - carrier}
    heard = {case: _housing(case) for case in ("healthy", *CASES)}
    plot_spectra(
        heard, lines, folder / "planetary_pitting_housing.png", 400.0, dpi=70, title=f"{NAME}, ring's forces at the housing"
    )


SIMULATED = {
    "sc_simulated": sc_simulated,
    "sc_measured": sc_measured,
    "rms": rms,
    "kurtosis": kurtosis,
    "shape_factor": shape_factor,
    "amplitudes": amplitudes,
    "housing_lines": housing_lines,
    "statements": statements,
}
RUN_OF = dict.fromkeys(SIMULATED, OWN) | {"housing_lines": OWN + STEADY}
BESIDE = {
    "SC, force [Hz]": sc_simulated,
    "SC, ring acceleration [Hz]": sc_measured,
    "RMS [m/s^2]": rms,
    "kurtosis": kurtosis,
    "shape factor": shape_factor,
    "peak [m/s^2]": amplitudes,
    "sidebands f_m +- 40 Hz [N]": sidebands,
    "the articles say": statements,
}
BY_PATH = {
    "healthy [% of the largest of the three]": passing,
    "lines one carrier turn beside the sun's harmonics [% of that]": housing_lines,
    "sidebands at the carrier's frequency beside them": seen,
}

"""The printed numbers of article S2 (two-stage compound planetary gearbox with a cracked sun tooth), computed."""

import csv
import math
from fractions import Fraction
from functools import cache

import numpy as np
from scipy.signal import resample_poly

import gearfe as gf
from gearfe.files import written
from gearfe.machine.compound_planetary import compound_planetary
from gearfe.units import in_newton_per_um

from ..shared.places import TABLES
from ..shared.simulated import amplitude, machine, noisy, record, scene, signal, spectrum, told
from .compound_numbers import LEVELS, NAME, QUICK, beams, converged, frequencies  # noqa: F401

PHASES, PARTS = TABLES / "compound_planetary_phases.csv", TABLES / "compound_planetary_parts.csv"
HEARD = "linear stiffness"
RATE, SECONDS, SETTLE = 5120.0, 3.3, 0.5  # the rate of S2
SAMPLED = 24 * 2184.0  # Hz, 2184 is the least common multiple of both mesh frequencies: what folds, folds onto multiples of 14 Hz
NOISE = 0.5  # of the standard deviation of the healthy signal; assumed
SENSOR = "ring.theta acceleration"  # planets in phase cancel in x and y


@cache
def _made(case):
    """Machine: healthy, a case of the scene (sun 2), or ``sun 1`` with the tooth of the case `crack80`."""
    if case != "sun 1":
        return machine(NAME, case, "auto")
    pairs = scene(NAME).pairs
    kinds = {"sun1_p": "sun_planet", "p_ring": "planet_ring_1", "sun2_b": "sun_planet", "b_c": "planet_planet"}
    kinds["c_ring"] = "planet_ring_2"
    curves = {name: gf.mesh_stiffness(**pairs[name].case(), phases=64) for name in set(kinds.values())}
    hurt = gf.mesh_stiffness(**pairs["sun_planet"].case("crack80"), phases=64, span="tooth")
    geometry = {kind: pairs[name].pair for kind, name in kinds.items()}
    healthy = {kind: curves[name] for kind, name in kinds.items()}
    return compound_planetary(healthy, pairs=geometry, damage={"sun1": (0, {"sun1_p": hurt})})


@cache
def _response(case):
    return record(_made(case), SECONDS, SAMPLED, SETTLE)


@cache
def _whole(case):
    """Angular acceleration of the ring as simulated."""
    return signal(_response(case), SENSOR)


@cache
def heard(case):
    """The same behind an anti-aliasing filter, at the rate of S2."""
    ratio = Fraction(round(RATE), round(SAMPLED))
    values = resample_poly(_whole(case).values, ratio.numerator, ratio.denominator)
    cut = slice(round(0.05 * RATE), round((SECONDS - 0.05) * RATE))  # where the filter has its whole length
    return gf.Signal(values[cut], RATE, _whole(case).unit, case or "healthy")


@cache
def _noisy(case):
    """With noise of one size for all cases."""
    level = NOISE * heard(None).values.std()
    return noisy(heard(case), level / heard(case).values.std())


def kurtosis():
    """Of 1 s of the signals with noise."""
    cut = {name: _noisy(case) for name, case in (("healthy", None), ("sun 1 broken", "sun 1"), ("sun 2 broken", "crack80"))}
    return {name: gf.Signal(one.values[: round(RATE)], RATE, one.unit).indicators()["kurtosis"] for name, one in cut.items()}


@cache
def _kurtogram(case):
    found = gf.fast_kurtogram(_noisy(case), levels=7)
    return float(found.level[found.best]), float(found.centre[found.best]), found.band


def kurtogram_level():
    """Level of the largest kurtosis; the article's program prints 5.58 as 5.5."""
    return {
        name: math.floor(10 * _kurtogram(case)[0]) / 10 for name, case in (("sun 1 broken", "sun 1"), ("sun 2 broken", "crack80"))
    }


def kurtogram_centre():
    """Centre of its band [Hz]."""
    return {name: _kurtogram(case)[1] for name, case in (("sun 1 broken", "sun 1"), ("sun 2 broken", "crack80"))}


def _stands_out(found, frequency, near=3.0):
    """Whether the line at a frequency is three times the median of what is less than `near` [Hz] beside it."""
    beside = found.within(frequency - near, frequency + near)[1]
    return amplitude(found, frequency) > 3 * np.median(beside)


def _sideband(case, mesh, fault):
    """Amplitude of the first sidebands of a stage over its mesh line, without noise."""
    found = spectrum(_whole(case))
    return (amplitude(found, mesh - fault) + amplitude(found, mesh + fault)) / 2


def statements():
    """What S2 says of its spectra; see the scene for the words."""
    mesh, fault = frequencies()
    grown = [_sideband(case, mesh[1], fault[1]) for case in LEVELS.values()]
    healthy = _sideband(None, mesh[1], fault[1])
    one = _sideband("sun 1", mesh[0], fault[0]), _sideband(None, mesh[0], fault[0])
    found = spectrum(_whole(None))
    size = sum(amplitude(found, n * f) ** 2 for f in mesh for n in range(1, 141))
    squared = {case: gf.squared_envelope_spectrum(_noisy(case), _kurtogram(case)[2]) for case in ("sun 1", "crack80")}
    sun, planet = scene(NAME).gears["sun"], scene(NAME).gears["planet"]
    return {
        "root circles smaller than base circles (external gears)": sun.r_f < sun.r_b and planet.r_f < planet.r_b,
        "healthy: only mesh frequencies and their harmonics": size / 2 > 0.99 * _whole(None).values.var(),
        "crack in sun 1: sidebands f_m1 +- 16.8 Hz": one[0] > 10 * one[1],
        "crack in sun 2: sidebands f_m2 +- 18.2 Hz": grown[3] > 10 * healthy,
        "sidebands grow with the crack": bool((np.diff(grown[:4]) > 0).all()),
        "10 %: sidebands too small to be identified": grown[0] < 0.1 * grown[3],
        "squared envelope of the best band has 16.8 Hz (sun 1)": _stands_out(squared["sun 1"], fault[0]),
        "squared envelope of the best band has 18.2 Hz (sun 2)": _stands_out(squared["crack80"], fault[1]),
    }


def write_more():
    """Tables: phases of the meshes, and what each ingredient leaves of the stiffness."""
    made = _made(None)
    with written(PHASES) as target, open(target, "w", encoding="utf-8", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(("mesh", "against planet 1", "in its planet's chain"))
        for name, pair in made.notes["relative phases"].items():
            out.writerow((name, *(f"{value:.6g}" for value in pair)))
    chosen = scene(NAME).pairs["sun_planet"].case()
    with written(PARTS) as target, open(target, "w", encoding="utf-8", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(("model", "mean k [N/m]"))
        with_ground = gf.mesh_stiffness(**chosen, method="textbook", variants={"root": "prism"}, phases=400).k.mean()
        out.writerow(("the article's beams: Hertz, bending, shear, axial", f"{beams('sun_planet').k.mean():.6g}"))
        out.writerow(("with the foundation after Sainsot", f"{with_ground:.6g}"))
        out.writerow(("converged energy model", f"{converged('sun_planet'):.6g}"))


def more():
    """Lines of the page beside the verdicts."""
    with open(PARTS, encoding="utf-8", newline="") as file:
        parts = list(csv.reader(file))[1:]
    first = float(parts[0][1])
    lines = [
        "What the foundation is worth, sun and planet, the same inferred gears:",
        "",
        "| model | mean k [N/um] | of the first |",
    ]
    lines += ["|---|---|---|", *(f"| {name} | {in_newton_per_um(float(k))} | {float(k) / first:.2f} |" for name, k in parts), ""]
    with open(PHASES, encoding="utf-8", newline="") as file:
        head, *rows = csv.reader(file)
    lines += ["Phases of the meshes in cycles (S2's Table 2 is lost):", "", f"| {' | '.join(head)} |", "|---" * len(head) + "|"]
    return [*lines, *(f"| {name} | {float(a):.4f} | {float(b):.4f} |" for name, a, b in rows), ""]


def runs():
    """What the simulations were made with."""
    return {HEARD: told(_response(None)) + f"; then an anti-aliasing filter and {RATE:g} samples per second"}


PICTURES = {
    "compound_planetary_k": "Stiffness of sun and planet over the engagement of a cracked tooth, converged energy model",
    "compound_planetary_spectra": "Angular acceleration of the ring",
    "compound_planetary_waves": "Angular acceleration of the ring with noise, as S2 shows its signals",
    "compound_planetary_envelopes": "Squared envelope spectra of the bands with the largest kurtosis",
    "compound_planetary_kurtogram": "Kurtogram, sun 2 with a tooth of 80 %",
}


def draw(folder):
    """Pictures of the page."""
    from gearfe.pictures.stiffness_plots import plot_curves
    from gearfe.pictures.vibration_plots import plot_spectra, plot_waves

    chosen, run = scene(NAME).pairs["sun_planet"], {"method": "ritz", "phases": 96, "span": "tooth"}
    curves = {"healthy": gf.mesh_stiffness(**chosen.case(), **run)}
    curves |= {level: gf.mesh_stiffness(**chosen.case(case), **run) for level, case in LEVELS.items()}
    plot_curves(curves, folder / "compound_planetary_k.png")
    (one, two), (slow, quick) = frequencies()
    lines = {"f_m1": one, "f_m2": two, "f_m1 - f_1": one - slow, "f_m2 + f_2": two + quick, "2 f_m1": 2 * one, "2 f_m2": 2 * two}
    cases = {"healthy": None, "sun 1, 80 %": "sun 1", "sun 2, 30 %": "crack30", "sun 2, 80 %": "crack80"}
    spectra = {name: spectrum(_whole(case)) for name, case in cases.items()}
    plot_spectra(spectra, lines, folder / "compound_planetary_spectra.png", 450.0, dpi=70)
    broken = {"sun 1, 80 %": "sun 1", "sun 2, 80 %": "crack80"}
    plot_waves(
        {"healthy": _noisy(None)} | {name: _noisy(case) for name, case in broken.items()}, folder / "compound_planetary_waves.png"
    )
    envelopes = {name: gf.squared_envelope_spectrum(_noisy(case), _kurtogram(case)[2]) for name, case in broken.items()}
    faults = {"f_1": slow, "2 f_1": 2 * slow, "f_2": quick, "2 f_2": 2 * quick}
    plot_spectra(envelopes, faults, folder / "compound_planetary_envelopes.png", 60.0, dpi=70)
    gf.plot_kurtogram(gf.fast_kurtogram(_noisy("crack80"), levels=7), folder / "compound_planetary_kurtogram.png")


SIMULATED = {
    "kurtosis": kurtosis,
    "kurtogram_level": kurtogram_level,
    "kurtogram_centre": kurtogram_centre,
    "statements": statements,
}
RUN_OF = dict.fromkeys(SIMULATED, HEARD)

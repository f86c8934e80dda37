"""Printed numbers of article S2 (two-stage compound planetary gearbox with a cracked sun tooth), computed by gearfe."""

import math
from fractions import Fraction
from functools import cache

import numpy as np
from scipy.signal import resample_poly

import gearfe as gf
from gearfe.core.units import in_newton_per_um

from ..shared.joint_inputs import Draw, changed, noise, through_mode
from ..shared.laws import beside, tables
from ..shared.places import TABLES
from ..shared.simulated import amplitude, machine, noisy, record, scene, signal, spectrum, told
from ..shared.table_rows import rows_of, write_table
from .compound_numbers import LEVELS, NAME, QUICK, beams, converged, frequencies, left, of_mesh_lines  # noqa: F401

PHASES, PARTS = TABLES / "compound_planetary_phases.csv", TABLES / "compound_planetary_parts.csv"
HEARD = "linear stiffness"
TEETH = {  # by case of this page: table and case of the scene, and the body with the damaged tooth
    "sun 1": ("crack", "crack70", "sun1"),
    "sun 1, 80 %": ("crack", "crack80", "sun1"),
    "sun 1 broken": ("missing_tooth", "broken", "sun1"),
    "sun 2 broken": ("missing_tooth", "broken", "sun2"),
}
# interpretations of a broken tooth in sun 1 and in sun 2
BROKEN, CRACKED = ("sun 1 broken", "sun 2 broken"), ("sun 1, 80 %", "crack80")
RATE, SECONDS, SETTLE = 5120.0, 3.3, 0.5  # [Hz, s, s] sampling rate of S2, record, discarded start
SAMPLED = 24 * 2184.0  # [Hz] 2184 is the least common multiple of both mesh frequencies, so aliases fall on multiples of 14 Hz.
NOISE = 0.5  # assumed noise, relative to the standard deviation of the healthy signal
SENSOR = "ring.theta acceleration"  # In x and y the forces of planets in phase cancel.
SUN, HOUSING = "sun2.theta velocity", "ring's acceleration through a mode"
CRACK = (f"{SENSOR}, crack of 80 %", SENSOR, CRACKED)  # name, channel, interpretation of the damage
# [s] record and discarded start of a draw; 10/7 s contains whole periods of all lines, which are 1.4 Hz apart
DRAWN, DRAWN_SETTLE = 10 / 7, 0.5
BAND = (500.0, 1000.0)  # [Hz] band in which S2 reports more and larger sidebands for the broken sun 2
ABOVE = 3.0  # A line counts as larger above this multiple of the healthy line.
HIGHEST = 2000.0  # [Hz] limit below which S2 expects the dominant frequencies


@cache
def _made(case):
    """Return the machine: healthy, a case of the scene (sun 2), or a case of `TEETH`."""
    if case not in TEETH:
        return machine(NAME, case, "auto")
    table, name, body = TEETH[case]
    return gf.build_machine(gf.load_scene(NAME, {f"{table}.{name}.body": body}), name)


@cache
def _response(case, law=HEARD):
    """Return the response of a machine.

    `law` is that of the scene, another backlash [m] (0: meshes never open) or a draw of the inputs.
    """
    if isinstance(law, Draw):
        return record(changed(_made(case), law), DRAWN, SAMPLED, DRAWN_SETTLE)
    return record(_made(case) if law == HEARD else _made(case).with_meshes(backlash=law), SECONDS, SAMPLED, SETTLE)


@cache
def _whole(case, law=HEARD, channel=SENSOR):
    """Return a simulated channel, by default the angular acceleration of the ring."""
    one = signal(_response(case, law), SENSOR if channel == HOUSING else channel)
    return through_mode(one, law, frequencies()[0][1]) if channel == HOUSING else one


@cache
def heard(case, law=HEARD, channel=SENSOR):
    """Apply an anti-aliasing filter to `_whole` and resample it at the rate of S2."""
    ratio = Fraction(round(RATE), round(SAMPLED))
    values = resample_poly(_whole(case, law, channel).values, ratio.numerator, ratio.denominator)
    length = DRAWN if isinstance(law, Draw) else SECONDS
    cut = slice(round(0.05 * RATE), round((length - 0.05) * RATE))  # Only this part has the full filter length.
    return gf.Signal(values[cut], RATE, _whole(case, law, channel).unit, case or "healthy")


@cache
def _noisy(case, law=HEARD, channel=SENSOR):
    """Return a signal with added noise, whose level is the same in all cases."""
    one, healthy = heard(case, law, channel), heard(None, law, channel).values.std()
    if isinstance(law, Draw):
        more = law["noise"] * healthy * noise(law, f"{case} {channel}", one.values.size)
        return gf.Signal(one.values + more, one.rate, one.unit, one.name)
    return noisy(one, NOISE * healthy / one.values.std())


def kurtosis(law=HEARD, channel=SENSOR, broken=BROKEN):
    """Return the kurtosis of 1 s of the signals with noise."""
    return {name: _of_second(case, law, channel) for name, case in zip(("healthy", *BROKEN), (None, *broken), strict=True)}


@cache
def _kurtogram(case, law=HEARD, channel=SENSOR):
    # The record length limits the number of levels.
    found = gf.fast_kurtogram(_noisy(case, law, channel), levels=5 if isinstance(law, Draw) else 7)
    return float(found.level[found.best]), float(found.centre[found.best]), found.band


def kurtogram_level():
    """Return the level of the largest kurtosis. The article's program prints 5.58 as 5.5."""
    return {name: math.floor(10 * _kurtogram(name)[0]) / 10 for name in BROKEN}


def kurtogram_centre():
    """Return the centre of the band with the largest kurtosis [Hz]."""
    return {name: _kurtogram(name)[1] for name in BROKEN}


def _stands_out(found, frequency, near=3.0):
    """Return whether the line at a frequency exceeds three times the median of the bins within `near` [Hz] of it."""
    beside = found.within(frequency - near, frequency + near)[1]
    return amplitude(found, frequency) > 3 * np.median(beside)


def _sideband(case, mesh, fault, law=HEARD, channel=SENSOR):
    """Return the amplitude of the first sidebands of a stage, without noise."""
    found = spectrum(_whole(case, law, channel))
    return (amplitude(found, mesh - fault) + amplitude(found, mesh + fault)) / 2


def statements(law=HEARD, channel=SENSOR, broken=BROKEN):
    """Evaluate statements of article S2 on its spectra, for one reading of a broken tooth."""
    mesh, fault = frequencies()
    grown = [_sideband(case, mesh[1], fault[1], law, channel) for case in LEVELS.values()]
    healthy = _sideband(None, mesh[1], fault[1], law, channel)
    one = [_sideband(case, mesh[0], fault[0], law, channel) for case in ("sun 1", None)]
    squared = {
        case: gf.squared_envelope_spectrum(_noisy(case, law, channel), _kurtogram(case, law, channel)[2]) for case in broken
    }
    sun, planet = scene(NAME).gears["sun"], scene(NAME).gears["planet"]
    return {
        "root circles smaller than base circles (external gears)": sun.r_f < sun.r_b and planet.r_f < planet.r_b,
        "healthy: only mesh frequencies and their harmonics": of_mesh_lines(_whole(None, law, channel)) > 0.99,
        "crack in sun 1: sidebands f_m1 +- 16.8 Hz": one[0] > 10 * one[1],
        "crack in sun 2: sidebands f_m2 +- 18.2 Hz": grown[3] > 10 * healthy,
        "sidebands grow with the crack": bool((np.diff(grown[:4]) > 0).all()),
        "10 %: sidebands too small to be identified": grown[0] < 0.1 * grown[3],
        "squared envelope of the best band has 16.8 Hz (sun 1)": _stands_out(squared[broken[0]], fault[0]),
        "squared envelope of the best band has 18.2 Hz (sun 2)": _stands_out(squared[broken[1]], fault[1]),
        "dominant frequencies are below 2000 Hz": below(law, channel) > 0.5,
        "sun 2 broken: more sidebands from 500 to 1000 Hz": more_lines(law, channel, broken)[0] > 0.5,
        "most of them larger than the healthy ones": more_lines(law, channel, broken)[1] > 0.5,
        "broken teeth raise the kurtosis": _of_second(None, law, channel) < min(_of_second(c, law, channel) for c in broken),
    }


def further():
    """Evaluate the statements of `sources/statements.toml`."""
    return statements() | {"dominant frequencies are below 2000 Hz, of sun 2's velocity": below(channel=SUN) > 0.5}


def below(law=HEARD, channel=SENSOR):
    """Return the part of the healthy signal's power below `HIGHEST`, as simulated, without noise and filter."""
    found = spectrum(_whole(None, law, channel))
    frequency, height = found.within(0.0, found.frequency[-1])
    return float((height[frequency < HIGHEST] ** 2).sum() / (height**2).sum())


def more_lines(law=HEARD, channel=SENSOR, broken=BROKEN):
    """Return the shares of lines at distances f_2 in `BAND` above `ABOVE` times the healthy line, and above this line.

    Lines at mesh harmonics are omitted.
    """
    mesh, fault = frequencies()
    hurt, healthy = (spectrum(_noisy(case, law, channel)) for case in (broken[1], None))
    places = [n * mesh[1] + k * fault[1] for n in range(7) for k in range(-5, 6) if k]
    places = [f for f in places if BAND[0] < f < BAND[1] and min(abs(f - m * round(f / m)) for m in mesh) > 3.0]
    ratio = np.array([amplitude(hurt, f) / amplitude(healthy, f) for f in places])
    return float((ratio > ABOVE).mean()), float((ratio > 1.0).mean())


def _of_second(case, law=HEARD, channel=SENSOR):
    """Return the kurtosis of 1 s of a signal with noise."""
    one = _noisy(case, law, channel)
    return gf.Signal(one.values[: round(RATE)], RATE, one.unit).indicators()["kurtosis"]


PRINTED = {  # by quantity compared with draws: key of the reference
    f"{word}, {channel}": reference
    for channel in (SENSOR, HOUSING, CRACK[0])
    for word, reference in (("kurtosis", "kurtosis"), ("centre", "kurtogram_centre"))
}


def drawn(draw):
    """Evaluate the statements with the inputs of a draw, by statement and channel. Also return kurtoses and kurtograms."""
    holds, numbers = {}, {}
    for name, channel, broken in ((SENSOR, SENSOR, BROKEN), (SUN, SUN, BROKEN), (HOUSING, HOUSING, BROKEN), CRACK):
        for word, found in statements(draw, channel, broken).items():
            holds.setdefault(word, {})[name] = bool(found)
        numbers[f"kurtosis, {name}"] = list(kurtosis(draw, channel, broken).values())
        numbers[f"centre, {name}"] = [_kurtogram(case, draw, channel)[1] for case in broken]
    del holds["root circles smaller than base circles (external gears)"]
    for one in (_response, _whole, heard, _noisy, _kurtogram):
        one.cache_clear()
    return {"holds": holds, "numbers": numbers}


def write_more():
    """Write two tables: phases of the meshes, and remaining stiffness for each part of the model."""
    made = _made(None)
    beside("compound_planetary", BESIDE, *VIEWS)
    phases = [(name, *map(float, pair)) for name, pair in made.notes["relative phases"].items()]
    write_table(PHASES, ("mesh", "against planet 1", "in its planet's chain"), phases)
    chosen = scene(NAME).pairs["sun_planet"].case()
    parts = {
        "the article's beams: Hertz, bending, shear, axial": beams("sun_planet").k.mean(),
        "with the foundation after Sainsot": gf.mesh_stiffness(
            chosen, method="textbook", variants={"root": "prism"}, phases=400
        ).k.mean(),
        "converged energy model": converged("sun_planet"),
    }
    write_table(PARTS, ("model", "mean k [N/m]"), parts.items())


def more():
    """Return further sections of the page."""
    parts = [row.values() for row in rows_of(PARTS)]
    first = float(rows_of(PARTS)[0]["mean k [N/m]"])
    lines = [
        "Effect of the foundation, sun and planet, inferred gears:",
        "",
        "| model | mean k [N/um] | of the first |",
    ]
    lines += ["|---|---|---|", *(f"| {name} | {in_newton_per_um(float(k))} | {float(k) / first:.2f} |" for name, k in parts), ""]
    lines += tables("compound_planetary", SAID_OF, *VIEWS)
    rows = rows_of(PHASES)
    lines += ["Phases of the meshes in cycles (S2's Table 2 is lost):", "", f"| {' | '.join(rows[0])} |", "|---|---|---|"]
    return [*lines, *(f"| {name} | {float(a):.4f} | {float(b):.4f} |" for name, a, b in map(dict.values, rows)), ""]


VIEWS = {  # by column: force law, channel and interpretation of a broken tooth
    SENSOR: (HEARD, SENSOR, BROKEN),
    SUN: (HEARD, SUN, BROKEN),
    "crack of 80 %": (HEARD, SENSOR, CRACKED),
    "backlash 0.02 mm": (2e-5, SENSOR, BROKEN),
    "backlash 0.2 mm": (2e-4, SENSOR, BROKEN),
    "no backlash": (0.0, SENSOR, BROKEN),
}
BESIDE = {
    f"power of the healthy signal below {HIGHEST:g} Hz [%]": lambda view: {"": 100 * below(*VIEWS[view][:2])},
    "places of sidebands of sun 2, 500 to 1000 Hz [%]": lambda view: dict(
        zip(("3 times the healthy lines", "above the healthy lines"), (100 * x for x in more_lines(*VIEWS[view])), strict=True)
    ),
    "mean stiffness over the engagement of the broken tooth [% of healthy]": lambda view: {
        "": 100 * left("crack80" if VIEWS[view][2] == CRACKED else "broken")
    },
    "kurtosis with noise": lambda view: kurtosis(*VIEWS[view]),
    "the article says": lambda view: statements(*VIEWS[view]),
}
SAID_OF = (
    "The verdicts and draws use the first column. A broken tooth is `gearfe.MissingTooth`, and the backlash is 0.1 mm. The "
    "second column is the velocity of sun 2, which S2 shows. In the third, a broken tooth is the crack of 80 %. The last three "
    "columns have another backlash. Where no other pair is on the path of contact, the gears rotate by a gap until tip corners "
    "of the neighbours touch. With backlash, the meshes open there. Without backlash, the meshes cannot open, and the gap is an "
    "error that they follow"
)


def runs():
    """Return the settings of the simulations."""
    return {HEARD: told(_response(None)) + f"; then an anti-aliasing filter and {RATE:g} samples per second"}


PICTURES = {
    "compound_planetary_k": "Stiffness of sun and planet over the engagement of a cracked tooth, converged energy model",
    "compound_planetary_spectra": "Angular acceleration of the ring",
    "compound_planetary_waves": "Angular acceleration of the ring with noise, as S2 shows its signals",
    "compound_planetary_envelopes": "Squared envelope spectra of the bands with the largest kurtosis",
    "compound_planetary_kurtogram": "Kurtogram, sun 2 with a missing tooth",
}


def draw(folder):
    """Draw the pictures of the page."""
    from gearfe.figures.stiffness_plots import plot_curves
    from gearfe.figures.vibration_plots import plot_spectra

    from ..shared.plots import plot_waves

    chosen, run = scene(NAME).pairs["sun_planet"], {"method": "ritz", "phases": 96, "span": "tooth"}
    curves = {"healthy": gf.mesh_stiffness(chosen.case(), **run)}
    curves |= {level: gf.mesh_stiffness(chosen.case(case), **run) for level, case in LEVELS.items()}
    plot_curves(curves, folder / "compound_planetary_k.png", f"{NAME}, sun_planet, cracks of the sun")
    (one, two), (slow, quick) = frequencies()
    lines = {"f_m1": one, "f_m2": two, "f_m1 - f_1": one - slow, "f_m2 + f_2": two + quick, "2 f_m1": 2 * one, "2 f_m2": 2 * two}
    cases = {"healthy": None, "sun 1, 70 %": "sun 1", "sun 2, 30 %": "crack30", "sun 2, 70 %": "crack70"}
    spectra = {name: spectrum(_whole(case)) for name, case in cases.items()}
    plot_spectra(spectra, lines, folder / "compound_planetary_spectra.png", 450.0, dpi=70, title=NAME)
    broken = {"sun 1, tooth missing": BROKEN[0], "sun 2, tooth missing": BROKEN[1]}
    waves = {"healthy": _noisy(None)} | {name: _noisy(case) for name, case in broken.items()}
    plot_waves(waves, folder / "compound_planetary_waves.png", title=f"{NAME}, with noise")
    envelopes = {name: gf.squared_envelope_spectrum(_noisy(case), _kurtogram(case)[2]) for name, case in broken.items()}
    faults = {"f_1": slow, "2 f_1": 2 * slow, "f_2": quick, "2 f_2": 2 * quick}
    plot_spectra(envelopes, faults, folder / "compound_planetary_envelopes.png", 60.0, dpi=70, title=f"{NAME}, squared envelopes")
    gf.plot_kurtogram(
        gf.fast_kurtogram(_noisy(BROKEN[1]), levels=7),
        folder / "compound_planetary_kurtogram.png",
        f"{NAME}, sun 2, tooth missing",
    )


SIMULATED = {
    "kurtosis": kurtosis,
    "kurtogram_level": kurtogram_level,
    "kurtogram_centre": kurtogram_centre,
    "statements": statements,
    "further": further,
}
RUN_OF = dict.fromkeys(SIMULATED, HEARD)

"""Printed numbers of article S2 (two-stage compound planetary gearbox with a cracked sun tooth), computed by gearfe."""

import math
from fractions import Fraction
from functools import cache
from typing import NamedTuple

import numpy as np
from scipy.signal import resample_poly

import gearfe as gf

from ..shared.joint_inputs import adding, changed, through_mode
from ..shared.simulated import Heard, amplitude, machine, record, scene, signal
from .compound_numbers import LEVELS, NAME, QUICK, frequencies, of_mesh_lines  # noqa: F401

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


class View(NamedTuple):
    """A channel as simulated, with noise at the rate of S2, and the cases of a broken tooth in sun 1 and in sun 2."""

    whole: Heard
    noisy: Heard
    broken: tuple = BROKEN
    levels: int = 7  # The length of the record limits the levels of the kurtogram.

    def band(self, case):
        """Level, centre [Hz] and band of the largest spectral kurtosis."""
        found = gf.fast_kurtogram(self.noisy(case), levels=self.levels)
        return float(found.level[found.best]), float(found.centre[found.best]), found.band


def recorded(draw=None):
    """Return the response as a function of the case, of the scene or with the inputs of a draw."""
    if draw is None:
        return cache(lambda case: record(_made(case), SECONDS, SAMPLED, SETTLE))
    return cache(lambda case: record(changed(_made(case), draw), DRAWN, SAMPLED, DRAWN_SETTLE))


def heard(records, channel=SENSOR, draw=None, broken=BROKEN):
    """Return a channel, by default the angular acceleration of the ring."""
    seconds = SECONDS if draw is None else DRAWN
    cut = slice(round(0.05 * RATE), round((seconds - 0.05) * RATE))  # Only this part has the full filter length.

    def through(response):
        one = signal(response, SENSOR if channel == HOUSING else channel)
        return through_mode(one, draw, frequencies()[0][1]) if channel == HOUSING else one

    def resampled(one):
        """Apply an anti-aliasing filter and resample at the rate of S2."""
        ratio = Fraction(round(RATE), round(SAMPLED))
        values = resample_poly(one.values, ratio.numerator, ratio.denominator)
        return gf.Signal(values[cut], RATE, one.unit)

    def assumed(case, count):
        return NOISE * np.random.default_rng(0).standard_normal(count)

    whole = Heard(records, through)
    noisy = Heard(whole, resampled, adding(draw, channel) or assumed)
    return View(whole, noisy, broken, 7 if draw is None else 5)


RECORDS = recorded()
OWN = heard(RECORDS)


def kurtosis(view=OWN):
    """Return the kurtosis of 1 s of the signals with noise."""
    return {name: _of_second(view, case) for name, case in zip(("healthy", *BROKEN), (None, *view.broken), strict=True)}


def kurtogram_level():
    """Return the level of the largest kurtosis. The article's program prints 5.58 as 5.5."""
    return {name: math.floor(10 * OWN.band(name)[0]) / 10 for name in BROKEN}


def kurtogram_centre():
    """Return the centre of the band with the largest kurtosis [Hz]."""
    return {name: OWN.band(name)[1] for name in BROKEN}


def _stands_out(found, frequency, near=3.0):
    """Return whether the line at a frequency exceeds three times the median of the bins within `near` [Hz] of it."""
    beside = found.within(frequency - near, frequency + near)[1]
    return amplitude(found, frequency) > 3 * np.median(beside)


def statements(view=OWN):
    """Evaluate statements of article S2 on its spectra, for one reading of a broken tooth."""
    mesh, fault = frequencies()
    grown = [view.whole.sidebands(case, mesh[1], fault[1]) for case in LEVELS.values()]
    healthy = view.whole.sidebands(None, mesh[1], fault[1])
    one = [view.whole.sidebands(case, mesh[0], fault[0]) for case in ("sun 1", None)]
    squared = [gf.squared_envelope_spectrum(view.noisy(case), view.band(case)[2]) for case in view.broken]
    sun, planet = scene(NAME).gears["sun"], scene(NAME).gears["planet"]
    most, all_of = more_lines(view)
    return {
        "root circles smaller than base circles (external gears)": sun.r_f < sun.r_b and planet.r_f < planet.r_b,
        "healthy: only mesh frequencies and their harmonics": of_mesh_lines(view.whole(None)) > 0.99,
        "crack in sun 1: sidebands f_m1 +- 16.8 Hz": one[0] > 10 * one[1],
        "crack in sun 2: sidebands f_m2 +- 18.2 Hz": grown[3] > 10 * healthy,
        "sidebands grow with the crack": bool((np.diff(grown[:4]) > 0).all()),
        "10 %: sidebands too small to be identified": grown[0] < 0.1 * grown[3],
        "squared envelope of the best band has 16.8 Hz (sun 1)": _stands_out(squared[0], fault[0]),
        "squared envelope of the best band has 18.2 Hz (sun 2)": _stands_out(squared[1], fault[1]),
        "dominant frequencies are below 2000 Hz": below(view) > 0.5,
        "sun 2 broken: more sidebands from 500 to 1000 Hz": most > 0.5,
        "most of them larger than the healthy ones": all_of > 0.5,
        "broken teeth raise the kurtosis": _of_second(view, None) < min(_of_second(view, case) for case in view.broken),
    }


def further():
    """Evaluate the statements of `sources/statements.toml`."""
    return statements() | {"dominant frequencies are below 2000 Hz, of sun 2's velocity": below(heard(RECORDS, SUN)) > 0.5}


def below(view=OWN):
    """Return the part of the healthy signal's power below `HIGHEST`, as simulated, without noise and filter."""
    found = view.whole.spectrum(None)
    frequency, height = found.within(0.0, found.frequency[-1])
    return float((height[frequency < HIGHEST] ** 2).sum() / (height**2).sum())


def more_lines(view=OWN):
    """Return the shares of lines at distances f_2 in `BAND` above `ABOVE` times the healthy line, and above this line.

    Lines at mesh harmonics are omitted.
    """
    mesh, fault = frequencies()
    places = [n * mesh[1] + k * fault[1] for n in range(7) for k in range(-5, 6) if k]
    places = [f for f in places if BAND[0] < f < BAND[1] and min(abs(f - m * round(f / m)) for m in mesh) > 3.0]
    ratio = np.array([view.noisy.line(view.broken[1], f) / view.noisy.line(None, f) for f in places])
    return float((ratio > ABOVE).mean()), float((ratio > 1.0).mean())


def _of_second(view, case):
    """Return the kurtosis of 1 s of a signal with noise."""
    one = view.noisy(case)
    return gf.Signal(one.values[: round(RATE)], RATE, one.unit).indicators()["kurtosis"]


PRINTED = {  # by quantity compared with draws: key of the reference
    f"{word}, {channel}": reference
    for channel in (SENSOR, HOUSING, CRACK[0])
    for word, reference in (("kurtosis", "kurtosis"), ("centre", "kurtogram_centre"))
}


def drawn(draw):
    """Evaluate the statements with the inputs of a draw, by statement and channel. Also return kurtoses and kurtograms."""
    holds, numbers, records = {}, {}, recorded(draw)
    for name, channel, broken in ((SENSOR, SENSOR, BROKEN), (SUN, SUN, BROKEN), (HOUSING, HOUSING, BROKEN), CRACK):
        one = heard(records, channel, draw, broken)
        for word, found in statements(one).items():
            holds.setdefault(word, {})[name] = bool(found)
        numbers[f"kurtosis, {name}"] = list(kurtosis(one).values())
        numbers[f"centre, {name}"] = [one.band(case)[1] for case in broken]
    del holds["root circles smaller than base circles (external gears)"]
    return {"holds": holds, "numbers": numbers}


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
    spectra = {name: OWN.whole.spectrum(case) for name, case in cases.items()}
    plot_spectra(spectra, lines, folder / "compound_planetary_spectra.png", 450.0, dpi=70, title=NAME)
    broken = {"sun 1, tooth missing": BROKEN[0], "sun 2, tooth missing": BROKEN[1]}
    waves = {"healthy": OWN.noisy(None)} | {name: OWN.noisy(case) for name, case in broken.items()}
    plot_waves(waves, folder / "compound_planetary_waves.png", title=f"{NAME}, with noise")
    envelopes = {name: gf.squared_envelope_spectrum(OWN.noisy(case), OWN.band(case)[2]) for name, case in broken.items()}
    faults = {"f_1": slow, "2 f_1": 2 * slow, "f_2": quick, "2 f_2": 2 * quick}
    plot_spectra(envelopes, faults, folder / "compound_planetary_envelopes.png", 60.0, dpi=70, title=f"{NAME}, squared envelopes")
    gf.plot_kurtogram(
        gf.fast_kurtogram(OWN.noisy(BROKEN[1]), levels=7),
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

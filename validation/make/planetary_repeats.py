"""Part of the page `planetary_pitting`: statements, repeats with other impacts, and results of input draws."""

import numpy as np

from ..shared.laws import beside, tables
from ..shared.simulated import amplitude, scene
from .planetary_numbers import CASES, speeds
from .planetary_runs import (
    CARRIER,
    FORCE,
    HOUSING,
    OWN,
    SENSOR,
    bandwidth_of,
    forget,
    rises,
    sidebands_of,
    signal_of,
    spectrum_of,
    standing_out,
    values_of,
)  # fmt: skip

IMPACTS = (0.5, 1.0, 2.0)  # Factors of the scene's pulses give three repetitions of each severity level.
INDICATORS = {"SC by S0's formula [Hz]": "SC (S0)", "SC by S1's formula [mm/s^2]": "SC (S1)", "RMS [m/s^2]": "rms"}
INDICATORS |= {"kurtosis": "kurtosis", "shape factor": "shape factor"}
ACCELERATES = "impacts raise the carrier's angular acceleration"
SIZES = {"peak to peak": np.ptp, "RMS": np.std}
STANDS_OUT = 1.5  # threshold of an outstanding mesh cycle, as for article S3
ROUNDING = 1e-9  # rounding limit of sidebands of the mesh force [N]
MEASURED, RISES = ("rms", "kurtosis", "shape factor", "peak"), "{} rises with severity"
# The articles print these values for the measured acceleration.
JUDGED_ON = dict.fromkeys((RISES.format(word) for word in MEASURED), SENSOR)


def about_spectra(law=OWN, channel=FORCE):
    """Evaluate statements of the articles on the signal of a channel."""
    side = {case: sidebands_of(case, law, channel) for case in ("healthy", *CASES)}
    s0, s1 = ([values_of(case, True, channel, law)[name] for case in CASES] for name in ("SC (S0)", "SC (S1)"))
    calm = [values_of(case, False, channel, law)["SC (S1)"] for case in CASES]
    return {
        "pits raise sidebands 40 Hz beside 280 Hz": min(side[case] for case in CASES) > 10 * side["healthy"],
        "they grow with severity": side["healthy"] < side["mild"] < side["moderate"] < side["severe"],
        "bandwidth of the sidebands grows with severity": rises(lambda case: bandwidth_of(case, law, channel)),
        "the fault's impulse stands out from those of the mesh": standing_out("severe", law, channel) > STANDS_OUT,
        "SC by S0's formula rises with severity": bool((np.diff(s0) > 0.1).all()),
        "SC by S1's formula rises with severity": bool((np.diff(s1) > 0.01 * s1[0]).all()),
        "SC by S1's formula is little affected by impacts": max(abs(a / b - 1) for a, b in zip(s1, calm, strict=True)) < 0.1,
    }


def about_impacts(law=OWN):
    """Evaluate statements on impacts by the force of a sun mesh and the acceleration of the carrier."""
    rate, mesh = 1 / scene("planetary_pitting").machine["impact"]["pulse_period_s"], speeds()[2]
    peak = [np.ptp(signal_of("healthy", impact, law=law).values) for impact in (False, True)]
    found = [spectrum_of("healthy", impact, law=law) for impact in (False, True)]
    beside = [amplitude(one, mesh + rate, one.resolution / 2) for one in found]
    carrier = [signal_of("healthy", impact, CARRIER, law).values for impact in (False, True)]
    return {
        **{f"{ACCELERATES}, {name}": bool(size(carrier[1]) > 1.1 * size(carrier[0])) for name, size in SIZES.items()},
        "impacts raise the force": peak[1] > 1.1 * peak[0],
        "impacts bring close sidebands of the mesh line": beside[1] > 10 * beside[0],
    }


def repeated(name, law=OWN):
    """Return an indicator of the ring's acceleration by level, three repeats each."""
    return {case: [values_of(case, impact, SENSOR, law)[name] for impact in IMPACTS] for case in CASES}


def apart(found, *, rising=True):
    """Return whether the ranges of successive levels do not overlap. Unless `rising`, they may also decrease."""
    ranges = [(min(found[case]), max(found[case])) for case in CASES]
    up, down = (all(a[1] < b[0] for a, b in zip(order, order[1:], strict=False)) for order in (ranges, ranges[::-1]))
    return up or (down and not rising)


def further():
    """Evaluate the statements of `sources/statements.toml`."""
    peaks = [np.ptp(signal_of("healthy", impact).values) for impact in (False, *IMPACTS)]
    out = {}
    for title, name in INDICATORS.items():
        word, found = title.partition(" [")[0], repeated(name)
        if word.startswith("SC"):
            out[f"three repeats: {word} tells the levels apart"] = apart(found)
        else:
            out[f"three repeats: {word} does not tell the levels apart"] = not apart(found, rising=False)
    return (
        about_spectra()
        | about_impacts()
        | out
        | {"the larger the impacts, the larger the force": bool((np.diff(peaks) > 0).all())}
    )


def repeats():
    """Return for each indicator a function of the law: least and largest of three repeats by level."""

    def ranged(name):
        def values(which):
            pick = min if which == "least" else max
            scale = 1e3 if name == "SC (S1)" else 1.0
            return {case: scale * pick(found) for case, found in repeated(name).items()}

        return values

    return {title: ranged(name) for title, name in INDICATORS.items()}


def spread(law=OWN):
    """Return the bandwidth of the sidebands [Hz] by level."""
    return {case: bandwidth_of(case, law) for case in CASES}


def strewn(law=OWN):
    """Return the deviation of the damaged tooth's force over that of the other teeth."""
    return {case: standing_out(case, law) for case in CASES}


def write_repeats():
    """Write the table of the repeats."""
    beside("planetary_pitting_repeats", repeats(), "least", "largest")


def section():
    """Return the lines of the section."""
    return ["## Three repeats of each level", "", *tables("planetary_pitting_repeats", TEXT, "least", "largest")]


TEXT = (
    "S1 measured each level three times under impacts. SC separated the levels and increased with them. RMS, kurtosis and shape "
    "factor did not. The table has the acceleration of the ring under pulses of 125, 250 and 500 N m, with the article's law. "
    "Levels are separated if the ranges of their repeats do not overlap. SC must also increase"
)


def drawn(draw):
    """Evaluate statements with the inputs of a draw, by statement and channel. Also return ring indicators."""
    holds = {name: {CARRIER if ACCELERATES in name else FORCE: bool(found)} for name, found in about_impacts(draw).items()}
    for channel in (FORCE, SENSOR, HOUSING):
        for name, found in about_spectra(draw, channel).items():
            holds.setdefault(name, {})[channel] = bool(found)
        for word in MEASURED:
            risen = rises(lambda case, word=word, channel=channel: values_of(case, True, channel, draw)[word])
            holds.setdefault(RISES.format(word), {})[channel] = risen
    numbers = {word: [values_of(case, True, SENSOR, draw)[word] for case in CASES] for word in PRINTED}
    forget()
    return {"holds": holds, "numbers": numbers}


PRINTED = {  # by quantity of the articles compared with draws: key of the reference
    "rms": "rms",
    "kurtosis": "kurtosis",
    "shape factor": "shape_factor",
    "peak": "amplitudes",
    "SC (S0)": "sc_measured",
}

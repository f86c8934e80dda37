"""Part of the page `planetary_pitting`: statements, repeats with other impacts, and results of input draws."""

import numpy as np

from ..shared.simulated import scene
from .planetary_numbers import CASES, speeds
from .planetary_runs import CARRIER, FORCE, HOUSING, OWN, SENSOR, Machine, bandwidth_of, rises, sidebands_of, standing_out

IMPACTS = (0.5, 1.0, 2.0)  # Factors of the scene's pulses give three repetitions of each severity level.
INDICATORS = {"SC by S0's formula": "SC (S0)", "SC by S1's formula": "SC (S1)", "RMS": "rms"}
INDICATORS |= {"kurtosis": "kurtosis", "shape factor": "shape factor"}
ACCELERATES = "impacts raise the carrier's angular acceleration"
SIZES = {"peak to peak": np.ptp, "RMS": np.std}
STANDS_OUT = 1.5  # threshold of an outstanding mesh cycle, as for article S3
MEASURED, RISES = ("rms", "kurtosis", "shape factor", "peak"), "{} rises with severity"
# The articles print these values for the measured acceleration.
JUDGED_ON = dict.fromkeys((RISES.format(word) for word in MEASURED), SENSOR)


def about_spectra(machine=OWN, channel=FORCE):
    """Evaluate statements of the articles on the signal of a channel."""
    heard = machine.channel(channel)
    side = {case: sidebands_of(case, heard) for case in ("healthy", *CASES)}
    s0, s1 = ([machine.values(case, True, channel)[name] for case in CASES] for name in ("SC (S0)", "SC (S1)"))
    calm = [machine.values(case, False, channel)["SC (S1)"] for case in CASES]
    return {
        "pits raise sidebands 40 Hz beside 280 Hz": min(side[case] for case in CASES) > 10 * side["healthy"],
        "they grow with severity": side["healthy"] < side["mild"] < side["moderate"] < side["severe"],
        "bandwidth of the sidebands grows with severity": rises(lambda case: bandwidth_of(case, heard)),
        "the fault's impulse stands out from those of the mesh": standing_out("severe", heard, force=channel == FORCE)
        > STANDS_OUT,
        "SC by S0's formula rises with severity": bool((np.diff(s0) > 0.1).all()),
        "SC by S1's formula rises with severity": bool((np.diff(s1) > 0.01 * s1[0]).all()),
        "SC by S1's formula is little affected by impacts": max(abs(a / b - 1) for a, b in zip(s1, calm, strict=True)) < 0.1,
    }


def about_impacts(machine=OWN):
    """Evaluate statements on impacts by the force of a sun mesh and the acceleration of the carrier."""
    rate, mesh = 1 / scene("planetary_pitting").machine["impact"]["pulse_period_s"], speeds()[2]
    keys, force = [("healthy", impact) for impact in (False, True)], machine.channel(FORCE)
    peak = [np.ptp(force(key).values) for key in keys]
    beside = [force.line(key, mesh + rate, force.spectrum(key).resolution / 2) for key in keys]
    carrier = [machine.channel(CARRIER)(key).values for key in keys]
    return {
        **{f"{ACCELERATES}, {name}": bool(size(carrier[1]) > 1.1 * size(carrier[0])) for name, size in SIZES.items()},
        "impacts raise the force": peak[1] > 1.1 * peak[0],
        "impacts bring close sidebands of the mesh line": beside[1] > 10 * beside[0],
    }


def repeated(name):
    """Return an indicator of the ring's acceleration by level, three repeats each."""
    return {case: [OWN.values(case, impact, SENSOR)[name] for impact in IMPACTS] for case in CASES}


def apart(found, *, rising=True):
    """Return whether the ranges of successive levels do not overlap. Unless `rising`, they may also decrease."""
    ranges = [(min(found[case]), max(found[case])) for case in CASES]
    up, down = (all(a[1] < b[0] for a, b in zip(order, order[1:], strict=False)) for order in (ranges, ranges[::-1]))
    return up or (down and not rising)


def further():
    """Evaluate the statements of `sources/statements.toml`."""
    peaks = [np.ptp(OWN.channel(FORCE)(("healthy", impact)).values) for impact in (False, *IMPACTS)]
    out = {}
    for word, name in INDICATORS.items():
        found = repeated(name)
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


def drawn(draw):
    """Evaluate statements with the inputs of a draw, by statement and channel. Also return ring indicators."""
    machine = Machine(draw)
    holds = {name: {CARRIER if ACCELERATES in name else FORCE: bool(found)} for name, found in about_impacts(machine).items()}
    for channel in (FORCE, SENSOR, HOUSING):
        for name, found in about_spectra(machine, channel).items():
            holds.setdefault(name, {})[channel] = bool(found)
        for word in MEASURED:
            risen = rises(lambda case, word=word, channel=channel: machine.values(case, True, channel)[word])
            holds.setdefault(RISES.format(word), {})[channel] = risen
    return {"holds": holds, "numbers": {word: [machine.values(case, True, SENSOR)[word] for case in CASES] for word in PRINTED}}


PRINTED = {  # by quantity of the articles compared with draws: key of the reference
    "rms": "rms",
    "kurtosis": "kurtosis",
    "shape factor": "shape_factor",
    "peak": "amplitudes",
    "SC (S0)": "sc_measured",
}

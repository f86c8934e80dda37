"""Printed numbers of article S3 (helical pair with pitted pinion teeth), computed by gearfe."""

from functools import cache

import numpy as np

import gearfe as gf

from ..shared.joint_inputs import adding, changed, through_mode
from ..shared.simulated import Heard, own_law, record, signal
from .helical_numbers import CASES, NAME, QUICK, frequencies, lines_of_lost_length, pair  # noqa: F401

SECONDS, SETTLE = 0.48, 0.24  # [s] 20 revolutions of the pinion, after 10 discarded ones
RATE = 128 * 2500 / 60 * 17  # [Hz] a multiple of the mesh frequency
FORCE = "force mesh"
PINION, HOUSING = "pinion.y acceleration", "pinion's acceleration through a mode"
HIGH = 1.1  # threshold of a high impact, relative to the largest deviation of the healthy signal
SLIGHTLY = 0.1  # largest change that counts as slight, relative to the healthy mesh line


def heard(records, channel=FORCE, draw=None):
    """Return a channel under S3's law without pulses, its load shared by contact lines, or with the inputs of a draw."""

    def through(response):
        one = signal(response, PINION if channel == HOUSING else channel)
        return through_mode(one, draw, frequencies()["f_m"]) if channel == HOUSING else one

    return Heard(records, through, adding(draw, channel), "minor")


def recorded(draw=None):
    """Return the response as a function of the case."""

    @cache
    def response(case):
        made = own_law(NAME, None if case == "healthy" else case, pulsed=False)
        return record(made, SECONDS, RATE, SETTLE) if draw is None else record(changed(made, draw), SECONDS, RATE, 2 * SETTLE)

    return response


OWN = heard(recorded())


def simulated():
    """Return shaft and mesh frequency of the severe case from its spectrum [Hz]."""
    lines = gf.find_lines(OWN.spectrum("severe"), frequencies())
    return {name: lines[name][0] for name in frequencies()}


def _low(case, n, heard=OWN):
    """Return the amplitude at n f_r [N]."""
    return heard.line(case, n * frequencies()["f_r"])


def _largest(case, heard=OWN):
    """Return which of f_r, 2 f_r, 3 f_r has the largest amplitude."""
    return 1 + int(np.argmax([_low(case, n, heard) for n in (1, 2, 3)]))


def _side(case, n, m, heard=OWN):
    """Return the mean amplitude at n f_m +- m f_r [N]."""
    turn, mesh = frequencies().values()
    return heard.sidebands(case, n * mesh, m * turn)


def _impacts(case, heard=OWN):
    """Return the largest deviation of one tooth in the averaged revolution over the median of all teeth."""
    force = heard(case).values
    turn = round(RATE / frequencies()["f_r"])
    own = np.abs(force - force.mean())[: force.size // turn * turn].reshape(-1, turn).mean(axis=0)
    by_tooth = own[: turn // 17 * 17].reshape(17, -1).max(axis=1)
    return float(by_tooth.max() / np.median(by_tooth))


def _high(case, heard=OWN):
    """Count the mesh cycles per revolution whose largest deviation exceeds `HIGH` times that of the healthy signal."""
    deviation = {name: np.abs(one - one.mean()) for name in ("healthy", case) for one in (heard(name).values,)}
    cycle = round(RATE / frequencies()["f_m"])
    own = deviation[case][: deviation[case].size // cycle * cycle].reshape(-1, cycle).max(axis=1)
    return float((own > HIGH * deviation["healthy"].max()).mean() * pair().gear_1.z)


def _mesh_lines(case, heard=OWN):
    """Return the lines at f_m and 2 f_m over the healthy ones."""
    return [heard.line(case, n * frequencies()["f_m"]) / heard.line("healthy", n * frequencies()["f_m"]) for n in (1, 2)]


def statements(heard=OWN):
    """Evaluate the statements of article S3 on its spectra."""
    mesh = frequencies()["f_m"]
    main = heard.line("healthy", mesh) ** 2 + heard.line("healthy", 2 * mesh) ** 2
    power = heard("healthy").values.var()
    minor, severe = ([_low(case, n, heard) for n in (1, 2, 3)] for case in ("minor", "severe"))
    sides = {case: [_side(case, n, m, heard) for n in (1, 2) for m in (1, 2)] for case in ("healthy", *CASES)}
    whole = max(_low("healthy", n, heard) for n in (1, 2, 3))
    lines = [line for case in ("minor", "severe") for line in _mesh_lines(case, heard)]
    out = {
        "healthy: f_m and 2 f_m dominate": main / 2 > 0.5 * power,
        "healthy: no sidebands": max(sides["healthy"]) < 0.01 * min(sides["severe"]),
        "minor and severe: f_r, 2 f_r, 3 f_r appear": min(minor + severe) > 10 * whole,
        "they grow from minor to severe": all(a < b for a, b in zip(minor, severe, strict=True)),
        "sidebands grow from minor to severe": all(a < b for a, b in zip(sides["minor"], sides["severe"], strict=True)),
        "severe: impacts once a turn stand out": _impacts("severe", heard) > 1.5,
        "minor: no such impacts": _impacts("minor", heard) < 1.5,
        "multi: 2 f_r is the largest low line": _largest("multi", heard) == 2,
        "severe: f_r is the largest low line": _largest("severe", heard) == 1,
        "multi: sidebands at 2 f_r above those at f_r": sides["multi"][1] > sides["multi"][0],
        "severe: sidebands at f_r above those at 2 f_r": sides["severe"][0] > sides["severe"][1],
        "multi: fewer high impacts than severe": _high("multi", heard) < _high("severe", heard),
        "minor and severe: f_m and 2 f_m change slightly": max(abs(one - 1) for one in lines) < SLIGHTLY,
    }
    if heard is OWN:
        same, opposite = lines_of_lost_length((0, 0, 0)), lines_of_lost_length((0, 0, 8))
        out["multi, all pits on one tooth: lost contact line has most at 2 f_r"] = bool(same[1] > same[0])
        out["multi, two pits on tooth 0 and one on tooth 8: the same"] = bool(opposite[1] > opposite[0])
    return out


def drawn(draw):
    """Evaluate the statements with the inputs of a draw, by statement and channel."""
    holds, records = {}, recorded(draw)
    for channel in (FORCE, PINION, HOUSING):
        for name, found in statements(heard(records, channel, draw)).items():
            holds.setdefault(name, {})[channel] = bool(found)
    return {"holds": holds, "numbers": {}}


PICTURES = {"helical_pitting_spectra": "Mesh force under the article's own law, low lines and those about the mesh frequency"}


def draw(folder):
    """Draw the pictures of the page."""
    from gearfe.figures.vibration_plots import plot_spectra

    lines = gf.expected_lines(frequencies()["f_m"], frequencies()["f_r"], count=2)
    spectra = {case: OWN.spectrum(case) for case in ("healthy", *CASES)}
    plot_spectra(
        spectra, lines, folder / "helical_pitting_spectra.png", 900.0, dpi=70, title="helical_pitting, mesh force, impact law"
    )


SIMULATED = {"simulated": simulated, "statements": statements, "further": statements}

"""Printed numbers of article S3 (helical pair with pitted pinion teeth), computed by gearfe."""

from dataclasses import replace
from functools import cache

import numpy as np

import gearfe as gf

from ..shared.joint_inputs import Draw, changed, noise, through_mode
from ..shared.laws import beside, tables
from ..shared.simulated import amplitude, machine, own_law, periodic, record, signal, spectrum, told
from .helical_numbers import CASES, NAME, QUICK, frequencies, lines_of_lost_length, pair  # noqa: F401

SECONDS, SETTLE = 0.48, 0.24  # [s] 20 revolutions of the pinion, after 10 discarded ones
RATE = 128 * 2500 / 60 * 17  # [Hz] a multiple of the mesh frequency
FORCE = "force mesh"
PINION, HOUSING = "pinion.y acceleration", "pinion's acceleration through a mode"
OWN, LINEAR = "impact law", "linear stiffness"
HIGH = 1.1  # threshold of a high impact, relative to the largest deviation of the healthy signal
SLIGHTLY = 0.1  # largest change that counts as slight, relative to the healthy mesh line


@cache
def _found(case, law=OWN, channel=FORCE):
    """Return the spectrum of a channel, by default of the mesh force."""
    return spectrum(_heard(case, law, channel))


@cache
def _heard(case, law=OWN, channel=FORCE):
    """Return a channel. A draw adds noise, relative to the standard deviation of the minor case."""
    one = _clean(case, law, channel)
    if not isinstance(law, Draw):
        return one
    size = law["noise"] * _clean("minor", law, channel).values.std()
    return replace(one, values=one.values + size * noise(law, f"{case} {channel}", one.values.size))


@cache
def _clean(case, law, channel):
    one = signal(_record(case, law), PINION if channel == HOUSING else channel)
    return through_mode(one, law, frequencies()["f_m"]) if channel == HOUSING else one


@cache
def _record(case, law=OWN):
    """Return the response of a case under the law of S3, with linear stiffness curves, or of a `Draw`."""
    name = None if case == "healthy" else case
    if isinstance(law, Draw):
        return record(changed(own_law(NAME, name, pulsed=False), law), SECONDS, RATE, 2 * SETTLE)
    if law == OWN:
        return record(own_law(NAME, name, pulsed=False), SECONDS, RATE, SETTLE)
    return record(machine(NAME, name), SECONDS, RATE, SETTLE, periodic(NAME, name))


def simulated():
    """Return shaft and mesh frequency of the severe case from its spectrum [Hz]."""
    lines = gf.find_lines(_found("severe"), frequencies())
    return {name: lines[name][0] for name in frequencies()}


def _low(case, n, law=OWN, channel=FORCE):
    """Return the amplitude at n f_r [N]."""
    return amplitude(_found(case, law, channel), n * frequencies()["f_r"])


def _largest(case, law=OWN, channel=FORCE):
    """Return which of f_r, 2 f_r, 3 f_r has the largest amplitude."""
    return 1 + int(np.argmax([_low(case, n, law, channel) for n in (1, 2, 3)]))


def _side(case, n, m, law=OWN, channel=FORCE):
    """Return the mean amplitude at n f_m +- m f_r [N]."""
    turn, mesh = frequencies().values()
    found = _found(case, law, channel)
    return (amplitude(found, n * mesh - m * turn) + amplitude(found, n * mesh + m * turn)) / 2


def _impacts(case, law=OWN, channel=FORCE):
    """Return the largest deviation of one tooth in the averaged revolution over the median of all teeth."""
    force = _heard(case, law, channel).values
    turn = round(RATE / frequencies()["f_r"])
    own = np.abs(force - force.mean())[: force.size // turn * turn].reshape(-1, turn).mean(axis=0)
    by_tooth = own[: turn // 17 * 17].reshape(17, -1).max(axis=1)
    return float(by_tooth.max() / np.median(by_tooth))


def _high(case, law=OWN, channel=FORCE):
    """Count the mesh cycles per revolution whose largest deviation exceeds `HIGH` times that of the healthy signal."""
    deviation = {name: np.abs(one - one.mean()) for name in ("healthy", case) for one in (_heard(name, law, channel).values,)}
    cycle = round(RATE / frequencies()["f_m"])
    own = deviation[case][: deviation[case].size // cycle * cycle].reshape(-1, cycle).max(axis=1)
    return float((own > HIGH * deviation["healthy"].max()).mean() * pair().gear_1.z)


def _mesh_lines(case, law=OWN, channel=FORCE):
    """Return the lines at f_m and 2 f_m over the healthy ones."""
    found, healthy = _found(case, law, channel), _found("healthy", law, channel)
    return [amplitude(found, n * frequencies()["f_m"]) / amplitude(healthy, n * frequencies()["f_m"]) for n in (1, 2)]


def statements(law=OWN, channel=FORCE):
    """Evaluate the statements of article S3 on its spectra."""
    mesh = frequencies()["f_m"]
    healthy = _found("healthy", law, channel)
    main = amplitude(healthy, mesh) ** 2 + amplitude(healthy, 2 * mesh) ** 2
    power = _heard("healthy", law, channel).values.var()
    minor, severe = ([_low(case, n, law, channel) for n in (1, 2, 3)] for case in ("minor", "severe"))
    sides = {case: [_side(case, n, m, law, channel) for n in (1, 2) for m in (1, 2)] for case in ("healthy", *CASES)}
    whole = max(_low("healthy", n, law, channel) for n in (1, 2, 3))
    lines = [line for case in ("minor", "severe") for line in _mesh_lines(case, law, channel)]
    out = {
        "healthy: f_m and 2 f_m dominate": main / 2 > 0.5 * power,
        "healthy: no sidebands": max(sides["healthy"]) < 0.01 * min(sides["severe"]),
        "minor and severe: f_r, 2 f_r, 3 f_r appear": min(minor + severe) > 10 * whole,
        "they grow from minor to severe": all(a < b for a, b in zip(minor, severe, strict=True)),
        "sidebands grow from minor to severe": all(a < b for a, b in zip(sides["minor"], sides["severe"], strict=True)),
        "severe: impacts once a turn stand out": _impacts("severe", law, channel) > 1.5,
        "minor: no such impacts": _impacts("minor", law, channel) < 1.5,
        "multi: 2 f_r is the largest low line": _largest("multi", law, channel) == 2,
        "severe: f_r is the largest low line": _largest("severe", law, channel) == 1,
        "multi: sidebands at 2 f_r above those at f_r": sides["multi"][1] > sides["multi"][0],
        "severe: sidebands at f_r above those at 2 f_r": sides["severe"][0] > sides["severe"][1],
        "multi: fewer high impacts than severe": _high("multi", law, channel) < _high("severe", law, channel),
        "minor and severe: f_m and 2 f_m change slightly": max(abs(one - 1) for one in lines) < SLIGHTLY,
    }
    if law == OWN:
        same, opposite = lines_of_lost_length((0, 0, 0)), lines_of_lost_length((0, 0, 8))
        out["multi, all pits on one tooth: lost contact line has most at 2 f_r"] = bool(same[1] > same[0])
        out["multi, two pits on tooth 0 and one on tooth 8: the same"] = bool(opposite[1] > opposite[0])
    return out


def drawn(draw):
    """Evaluate the statements with the inputs of a draw, by statement and channel."""
    holds = {}
    for channel in (FORCE, PINION, HOUSING):
        for name, found in statements(draw, channel).items():
            holds.setdefault(name, {})[channel] = bool(found)
    for one in (_found, _heard, _clean, _record):
        one.cache_clear()
    return {"holds": holds, "numbers": {}}


def _many(law=OWN):
    """Count the high impacts per revolution by case."""
    return {case: _high(case, law) for case in CASES}


def _of_mesh(law=OWN):
    """Return the mesh lines of the pitted pinion over those of the healthy one."""
    return {f"{case}, {n} f_m": _mesh_lines(case, law)[n - 1] for case in CASES for n in (1, 2)}


def _by_turn(law=OWN):
    """Return the lines of the force at f_r, 2 f_r, 3 f_r [N] by case."""
    return {f"{case}, {n} f_r": _low(case, n, law) for case in CASES for n in (1, 2, 3)}


def _about_mesh(law=OWN):
    """Return mean sidebands [N] at f_m +- f_r and +- 2 f_r by case, and the healthy mesh lines."""
    out = {f"{case}, f_m +- {m} f_r": _side(case, 1, m, law) for case in CASES for m in (1, 2)}
    mesh = frequencies()["f_m"]
    return out | {f"healthy, {n} f_m": amplitude(_found("healthy", law), n * mesh) for n in (1, 2, 3)}


def _standing_out(law=OWN):
    """Return the largest force of the damaged tooth over that of the other teeth."""
    return {case: _impacts(case, law) for case in CASES}


BESIDE = {
    "low lines [N]": _by_turn,
    "lines about f_m [N]": _about_mesh,
    "largest force of the damaged tooth over the others'": _standing_out,
    "high impacts in a turn: mesh cycles beyond 1.1 times the healthy pair's largest deviation": _many,
    "line over that of the healthy pair": _of_mesh,
    "the article says": statements,
}
BOTH = (
    "The verdicts use S3's law (impact force, load shared by the lengths of the contact lines). The second column uses the "
    "linear stiffness curves of the pitted teeth"
)


def runs():
    """Return the settings of the simulations."""
    return {OWN: told(_record("healthy")), LINEAR: told(_record("healthy", LINEAR))}


def write_more():
    """Write the table of both contact laws."""
    beside("helical_pitting", BESIDE, OWN, LINEAR)


def more():
    """Return further sections of the page."""
    return tables("helical_pitting", BOTH, OWN, LINEAR)


PICTURES = {"helical_pitting_spectra": "Mesh force under the article's own law, low lines and those about the mesh frequency"}


def draw(folder):
    """Draw the pictures of the page."""
    from gearfe.figures.vibration_plots import plot_spectra

    lines = gf.expected_lines(frequencies()["f_m"], frequencies()["f_r"], count=2)
    spectra = {case: _found(case) for case in ("healthy", *CASES)}
    plot_spectra(
        spectra, lines, folder / "helical_pitting_spectra.png", 900.0, dpi=70, title="helical_pitting, mesh force, impact law"
    )


SIMULATED = {"simulated": simulated, "statements": statements, "further": statements}
RUN_OF = dict.fromkeys(SIMULATED, OWN)

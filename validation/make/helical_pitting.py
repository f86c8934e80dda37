"""The printed numbers of article S3 (helical pair with pitted pinion teeth), computed."""

from dataclasses import replace
from functools import cache

import numpy as np

import gearfe as gf
from gearfe.machine.contact_law import hertz_coefficient
from geometry.pair.lines import total_length

from ..shared.laws import beside, tables
from ..shared.simulated import amplitude, machine, own_law, periodic, record, scene, signal, spectrum, told

NAME = "helical_pitting"
CASES = ("minor", "severe", "multi")
SECONDS, SETTLE = 0.48, 0.24  # 20 turns of the pinion, after 10
RATE = 128 * 2500 / 60 * 17  # a multiple of f_m
FORCE = "force mesh"
OWN, LINEAR = "impact law", "linear stiffness"


def pair():
    """The pair."""
    return scene(NAME).pair().pair


def frequencies():
    """Turning frequency of the pinion and mesh frequency [Hz]."""
    turn = scene(NAME).machine["speed_rpm"] / 60
    return {"f_r": turn, "f_m": turn * pair().gear_1.z}


def theory():
    """Of the article's table."""
    return frequencies()


@cache
def _found(case, law=OWN):
    """Spectrum of the simulated mesh force."""
    return spectrum(signal(_record(case, law), FORCE))


@cache
def _record(case, law=OWN):
    """Response of a case under S3's law, its load shared by contact lines, or with linear stiffness curves."""
    name = None if case == "healthy" else case
    if law == OWN:
        return record(own_law(NAME, name, pulsed=False), SECONDS, RATE, SETTLE)
    return record(machine(NAME, name), SECONDS, RATE, SETTLE, periodic(NAME, name))


def simulated():
    """Lines of the severe case: the turning frequency and the mesh frequency, as the spectrum shows them."""
    lines = gf.find_lines(_found("severe"), frequencies())
    return {name: lines[name][0] for name in frequencies()}


def measured():
    """At 2500 rpm."""
    return frequencies()


def errors_simulated():
    """Errors [%] of the article's table from its own printed values."""
    return {name: 100 * abs(1 - b / a) for name, a, b in (("f_r", 41.67, 41.62), ("f_m", 708.33, 708.09))}


def errors_measured():
    """The same for its measurement."""
    return {name: 100 * abs(1 - b / a) for name, a, b in (("f_r", 41.67, 41.23), ("f_m", 708.33, 707.48))}


def one_speed():
    """Pinion speed [rpm] of the printed simulated and measured mesh frequency over that of the turning frequency."""
    rows = {"simulated": (41.62, 708.09), "measured": (41.23, 707.48)}
    return {name: mesh / turn / pair().gear_1.z for name, (turn, mesh) in rows.items()}


def impact_period():
    """One turn of the pinion [s]."""
    return {"severe": 1 / frequencies()["f_r"]}


def hertz():
    """Coefficient of the impact law at the pitch point, with the radii across the contact line."""
    radii = pair().curvature_radii(pair().pitch_phase) / np.cos(pair().gear_1.beta_b)
    return {"pitch point": hertz_coefficient(float(radii[0]), float(radii[1]), scene(NAME).pair().materials)}


def contact_ratios():
    """Transverse, overlap and total contact ratio."""
    over = pair().eps_beta
    return {"transverse": pair().eps_alpha, "overlap": over, "total": pair().eps_alpha + over}


def line_length():
    """Of all contact lines over a cycle [mm], and the least with pits."""
    length = total_length(pair(), np.arange(400) / 400)
    out = {"mean": length.mean(), "least": length.min(), "most": length.max()}
    phase = np.linspace(-0.1, sum(contact_ratios()[name] for name in ("transverse", "overlap")) + 0.1, 1200)
    whole = total_length(pair(), phase)
    for case in CASES:
        pits = scene(NAME).pair().damage[case]["pinion"]
        out[f"{case}, most lost"] = (whole - total_length(pair(), phase, pits=(pits, ()))).max()
    return {name: float(value) for name, value in out.items()}


def _low(case, n, law=OWN):
    """Amplitude at n f_r [N]."""
    return amplitude(_found(case, law), n * frequencies()["f_r"])


def _largest(case, law=OWN):
    """Which of f_r, 2 f_r, 3 f_r has the largest amplitude."""
    return 1 + int(np.argmax([_low(case, n, law) for n in (1, 2, 3)]))


def _side(case, n, m, law=OWN):
    """Mean amplitude at n f_m +- m f_r [N]."""
    turn, mesh = frequencies().values()
    found = _found(case, law)
    return (amplitude(found, n * mesh - m * turn) + amplitude(found, n * mesh + m * turn)) / 2


def _impacts(case, law=OWN):
    """Largest force within a turn over the median of the others' largest, folded by tooth: one tooth must stand out."""
    force = signal(_record(case, law), FORCE).values
    turn = round(RATE / frequencies()["f_r"])
    own = np.abs(force - force.mean())[: force.size // turn * turn].reshape(-1, turn).mean(axis=0)
    by_tooth = own[: turn // 17 * 17].reshape(17, -1).max(axis=1)
    return float(by_tooth.max() / np.median(by_tooth))


def _lines_of_lost_length(teeth):
    """Amplitudes at f_r and 2 f_r of the contact line [mm] lost to the case `multi` with its pits on these pinion teeth."""
    count = 64
    pits = [replace(pit, tooth=tooth) for pit, tooth in zip(scene(NAME).pair().damage["multi"]["pinion"], teeth, strict=True)]
    phase = np.arange(17 * count) / count
    lost = total_length(pair(), phase) - total_length(pair(), phase, pits=(pits, ()))
    return 2 * np.abs(np.fft.rfft(lost))[1:3] / lost.size


def statements(law=OWN):
    """What S3 says of its spectra; see the scene for the words."""
    mesh = frequencies()["f_m"]
    healthy = _found("healthy", law)
    main = amplitude(healthy, mesh) ** 2 + amplitude(healthy, 2 * mesh) ** 2
    power = signal(_record("healthy", law), FORCE).values.var()
    minor, severe = ([_low(case, n, law) for n in (1, 2, 3)] for case in ("minor", "severe"))
    sides = {case: [_side(case, n, m, law) for n in (1, 2) for m in (1, 2)] for case in ("healthy", *CASES)}
    out = {
        "healthy: f_m and 2 f_m dominate": main / 2 > 0.5 * power,
        "healthy: no sidebands": max(sides["healthy"]) < 0.01 * min(sides["severe"]),
        "minor and severe: f_r, 2 f_r, 3 f_r appear": min(minor + severe) > 10 * max(_low("healthy", n, law) for n in (1, 2, 3)),
        "they grow from minor to severe": all(a < b for a, b in zip(minor, severe, strict=True)),
        "sidebands grow from minor to severe": all(a < b for a, b in zip(sides["minor"], sides["severe"], strict=True)),
        "severe: impacts once a turn stand out": _impacts("severe", law) > 1.5,
        "minor: no such impacts": _impacts("minor", law) < 1.5,
        "multi: 2 f_r is the largest low line": _largest("multi", law) == 2,
        "severe: f_r is the largest low line": _largest("severe", law) == 1,
        "multi: sidebands at 2 f_r above those at f_r": sides["multi"][1] > sides["multi"][0],
        "severe: sidebands at f_r above those at 2 f_r": sides["severe"][0] > sides["severe"][1],
    }
    if law == OWN:
        same, opposite = _lines_of_lost_length((0, 0, 0)), _lines_of_lost_length((0, 0, 8))
        out["multi, all pits on one tooth: lost contact line has most at 2 f_r"] = bool(same[1] > same[0])
        out["multi, two pits on tooth 0 and one on tooth 8: the same"] = bool(opposite[1] > opposite[0])
    return out


def _by_turn(law=OWN):
    """Lines of the force at f_r, 2 f_r, 3 f_r [N] by case."""
    return {f"{case}, {n} f_r": _low(case, n, law) for case in CASES for n in (1, 2, 3)}


def _about_mesh(law=OWN):
    """Mean sidebands [N] at f_m +- f_r and +- 2 f_r by case, and the healthy mesh lines."""
    out = {f"{case}, f_m +- {m} f_r": _side(case, 1, m, law) for case in CASES for m in (1, 2)}
    mesh = frequencies()["f_m"]
    return out | {f"healthy, {n} f_m": amplitude(_found("healthy", law), n * mesh) for n in (1, 2, 3)}


def _standing_out(law=OWN):
    """How far the damaged tooth's largest force stands out."""
    return {case: _impacts(case, law) for case in CASES}


BESIDE = {
    "low lines [N]": _by_turn,
    "lines about f_m [N]": _about_mesh,
    "largest force of the damaged tooth over the others'": _standing_out,
    "the article says": statements,
}
BOTH = (
    "The same under S3's own law (impact force, load shared by the lengths of the contact lines), which is judged above, "
    "and with the "
    "linear stiffness curves of the pitted teeth"
)


def runs():
    """What the simulations were made with."""
    return {OWN: told(_record("healthy")), LINEAR: told(_record("healthy", LINEAR))}


def write_more():
    """Table of both laws."""
    beside("helical_pitting", BESIDE, OWN, LINEAR)


def more():
    """Lines of the page beside the verdicts."""
    return tables("helical_pitting", BOTH, OWN, LINEAR)


PICTURES = {"helical_pitting_spectra": "Mesh force under the article's own law, low lines and those about the mesh frequency"}


def draw(folder):
    """Pictures of the page."""
    from gearfe.pictures.vibration_plots import plot_spectra

    lines = gf.expected_lines(frequencies()["f_m"], frequencies()["f_r"], count=2)
    spectra = {case: _found(case) for case in ("healthy", *CASES)}
    plot_spectra(
        spectra, lines, folder / "helical_pitting_spectra.png", 900.0, dpi=70, title="helical_pitting, mesh force, impact law"
    )


QUICK = {
    "theory": theory,
    "measured": measured,
    "errors_simulated": errors_simulated,
    "errors_measured": errors_measured,
    "one_speed": one_speed,
    "impact_period": impact_period,
    "hertz_coefficient": hertz,
    "contact_ratios": contact_ratios,
    "line_length": line_length,
}
SIMULATED = {"simulated": simulated, "statements": statements}
RUN_OF = {"simulated": OWN, "statements": OWN}

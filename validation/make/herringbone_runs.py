"""Common records of the stage of S4 for its page, evaluation of its statements, and results of input draws."""

from dataclasses import replace
from functools import cache

import numpy as np

import gearfe as gf

from ..shared.joint_inputs import Draw, changed, noise, through_mode
from ..shared.simulated import PHASES, amplitude, machine, periodic, record, scene, signal, spectrum
from .herringbone_numbers import NAME, speeds

SECONDS, SETTLE = 0.3, 0.075  # [s] 8 revolutions of the sun relative to the carrier, after 2 discarded ones
UNSETTLED = 0.4875  # [s] discarded start if no steady motion is found: 13 revolutions
RATE = 64 * 480.0
STATES = {"healthy": None, "crack 30 %": "crack30", "6 pits": "pits6", "case 2": "case2", "case 3": "case3", "case 4": "case4"}
SUN, TURNING, HOUSING = "sunL.x", "sunL.theta acceleration", "ring's acceleration through a mode"
RING = "ring.y acceleration"
UM = 1e6
ERRING, PERFECT = "with errors", "without errors"
ROUNDING = 1e-9  # rounding limit [um]; cancelling forces leave 1e-13
CLOSE = 0.1  # tolerance of equality, relative to the change caused by the crack alone
CRACK60 = "crack60"  # case 3 without its pits, an additional case that the scene does not contain


@cache
def made(case):
    """Return the machine of a case of the scene, or of `CRACK60`."""
    if case != CRACK60:
        return machine(NAME, case)
    damage = {
        name: {side: [d for d in found if isinstance(d, gf.Crack)] for side, found in one.damage.get("case3", {}).items()}
        for name, one in scene(NAME).pairs.items()
    }
    return gf.build_machine(scene(NAME).with_damage(CRACK60, damage), CRACK60, method="ritz3d", phases=PHASES[NAME])


@cache
def record_of(case, errors=ERRING):
    """Return the response of a case with the assumed errors, without errors, or of a `Draw`."""
    if isinstance(errors, Draw):
        return settled(changed(made(case), errors))
    if errors == PERFECT:
        return record(made(case).with_meshes(error=(), backlash=0.0), SECONDS, RATE, 4 * SETTLE)
    return settled(made(case)) if case == CRACK60 else record(made(case), SECONDS, RATE, SETTLE, periodic(NAME, case))


def settled(own):
    """Return the response of a machine in its periodic motion. If none is found, it begins after the transient."""
    try:
        found = gf.steady_state(own).response
    except RuntimeError:
        return record(own, SECONDS, RATE, UNSETTLED)
    return record(own, SECONDS, RATE, SETTLE, (found.q[0], found.v[0]))


@cache
def heard(case, errors=ERRING, channel=TURNING):
    """Return a channel. A draw adds noise, relative to the standard deviation of the healthy one."""
    one = clean(case, errors, channel)
    if not isinstance(errors, Draw):
        return one
    size = errors["noise"] * clean(None, errors, channel).values.std()
    return replace(one, values=one.values + size * noise(errors, f"{case} {channel}", one.values.size))


@cache
def clean(case, errors, channel):
    """Return the channel without noise."""
    one = signal(record_of(case, errors), RING if channel == HOUSING else channel)
    return through_mode(one, errors, speeds()[2]) if channel == HOUSING else one


@cache
def found_in(case, errors=ERRING, channel=TURNING):
    """Return the spectrum of a channel."""
    return spectrum(heard(case, errors, channel))


@cache
def range_of(case, errors=ERRING):
    """Return the least and largest sun displacement along x [um]."""
    x = UM * signal(record_of(case, errors), SUN).values
    return tuple(float(end) if abs(end) > ROUNDING else 0.0 for end in (x.min(), x.max()))


@cache
def section_of(case, errors=ERRING):
    """Return the Poincare section ``(points, 2)`` at f_m of the sun's rotation, scaled by the range of the motion."""
    response = record_of(case, errors)
    x, v = signal(response, "sunL.theta"), signal(response, "sunL.theta velocity")
    points = gf.poincare_section(x, speeds()[2], v)
    size = np.ptp(np.stack([x.values, v.values]), axis=1)
    return (points - points.mean(axis=0)) / size


def points_of(case, errors=ERRING):
    """Return the number of points of the Poincare section that differ by more than 0.5 %."""
    return len({tuple(np.round(point / 0.005).astype(int)) for point in section_of(case, errors)})


def _scattered(case, errors):
    return float(np.sqrt((section_of(case, errors) ** 2).sum(axis=1).mean()))


def impulse_of(case, errors=ERRING, channel=TURNING):
    """Return the largest difference of a channel from that of the healthy machine."""
    return float(np.abs(heard(case, errors, channel).values - heard(None, errors, channel).values).max())


def beside_crack(errors=ERRING, channel=TURNING):
    """Return the RMS change by the pits of case 3 over that by its crack alone."""
    whole, crack, both = (heard(case, errors, channel).values for case in (None, CRACK60, "case3"))
    return float((both - crack).std() / (crack - whole).std())


def line_of(case, frequency, errors=ERRING, channel=TURNING):
    """Return the amplitude of a line."""
    return amplitude(found_in(case, errors, channel), frequency)


def about_motion(errors=ERRING, channel=TURNING):
    """Evaluate statements of article S4 on its motions and spectra, for the signal of a channel."""
    _, _, mesh, fault = speeds()
    own = sum(line_of(None, n * mesh, errors, channel) ** 2 for n in range(1, 31)) / 2
    side = {
        name: (line_of(case, mesh - fault, errors, channel) + line_of(case, mesh + fault, errors, channel)) / 2
        for name, case in STATES.items()
    }
    points = {name: points_of(case, errors) for name, case in STATES.items()}
    impulse = {name: impulse_of(case, errors, channel) for name, case in STATES.items() if case}
    scattered = [_scattered(STATES[name], errors) for name in ("healthy", "6 pits", "crack 30 %")]
    at_fault = {name: line_of(case, fault, errors, channel) for name, case in STATES.items()}
    return {
        "healthy: only the mesh frequency and its harmonics": own > 0.98 * heard(None, errors, channel).values.var(),
        "healthy: sun's x does not vanish": max(map(abs, range_of(None, errors))) > 0.01,
        "healthy: Poincare map of few points": points["healthy"] <= 2,
        "crack 30 %: sidebands at f_m +- 80 Hz": side["crack 30 %"] > 10 * side["healthy"],
        "crack 30 %: line at 80 Hz": at_fault["crack 30 %"] > 10 * at_fault["healthy"],
        "crack 30 %: Poincare map of more points": points["crack 30 %"] > points["healthy"],
        "6 pits: sidebands lower than of the crack": side["6 pits"] < side["crack 30 %"],
        "6 pits: impulses smaller than of the crack": impulse["6 pits"] < impulse["crack 30 %"],
        "6 pits: phase portrait between healthy and cracked": scattered[0] < scattered[1] < scattered[2],
        "case 2: sidebands above crack or pits alone": side["case 2"] > max(side["crack 30 %"], side["6 pits"]),
        "case 2: impulses above crack or pits alone": impulse["case 2"] > max(impulse["crack 30 %"], impulse["6 pits"]),
        "case 3: close to the 60 % crack alone": beside_crack(errors, channel) < CLOSE,
        "case 4: sidebands above case 2": side["case 4"] > side["case 2"],
        "case 4: line at 80 Hz above case 2": at_fault["case 4"] > at_fault["case 2"],
    }


PRINTED = {"span": "displacement_span"}  # by quantity compared with draws: key of the reference


def drawn(draw):
    """Evaluate the statements with the inputs of a draw, by statement and channel. Also return ranges of the sun along x."""
    holds = {}
    for channel in (TURNING, SUN, HOUSING):
        found = about_motion(draw, channel)
        hurt, whole = (heard(case, draw, channel).indicators() for case in ("case4", None))
        growth = {name: hurt[name] / whole[name] for name in ("kurtosis", "crest factor")}
        found["kurtosis changes more than the crest factor"] = growth["kurtosis"] > growth["crest factor"]
        for name, held in found.items():
            holds.setdefault(name, {})[channel] = bool(held)
    for name in ("healthy: sun's x does not vanish", *(name for name in holds if "Poincare" in name or "portrait" in name)):
        holds[name] = {"sun's motion": holds[name][TURNING]}
    ranges = [range_of(case, draw) for case in STATES.values()]
    numbers = {"span": [high - low for low, high in ranges]}
    numbers["opened"] = [float(record_of(case, draw).stats.get("losses", 0)) for case in STATES.values()]
    for one in (record_of, heard, clean, found_in, range_of, section_of):
        one.cache_clear()
    return {"holds": holds, "numbers": numbers}

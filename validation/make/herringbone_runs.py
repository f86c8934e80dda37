"""Common records of the stage of S4 for its page, evaluation of its statements, and results of input draws."""

from functools import cache

import numpy as np

import gearfe as gf

from ..shared.joint_inputs import adding, changed, through_mode
from ..shared.simulated import PHASES, Heard, machine, periodic, record, scene, signal
from .herringbone_numbers import NAME, speeds

SECONDS, SETTLE = 0.3, 0.075  # [s] 8 revolutions of the sun relative to the carrier, after 2 discarded ones
UNSETTLED = 0.4875  # [s] discarded start if no steady motion is found: 13 revolutions
RATE = 64 * 480.0
STATES = {"healthy": None, "crack 30 %": "crack30", "6 pits": "pits6", "case 2": "case2", "case 3": "case3", "case 4": "case4"}
SUN, TURNING, HOUSING = "sunL.x", "sunL.theta acceleration", "ring's acceleration through a mode"
RING = "ring.y acceleration"
UM = 1e6
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


def recorded(draw=None):
    """Return the response as a function of the case, with the errors that the scene assumes or the inputs of a draw."""

    @cache
    def response(case):
        if draw is not None:
            return settled(changed(made(case), draw))
        return settled(made(case)) if case == CRACK60 else record(made(case), SECONDS, RATE, SETTLE, periodic(NAME, case))

    return response


record_of = recorded()


def settled(own):
    """Return the response of a machine in its periodic motion. If none is found, it begins after the transient."""
    try:
        found = gf.steady_state(own).response
    except RuntimeError:
        return record(own, SECONDS, RATE, UNSETTLED)
    return record(own, SECONDS, RATE, SETTLE, (found.q[0], found.v[0]))


def heard(records, channel=TURNING, draw=None):
    """Return a channel, by default the angular acceleration of the sun."""

    def through(response):
        one = signal(response, RING if channel == HOUSING else channel)
        return through_mode(one, draw, speeds()[2]) if channel == HOUSING else one

    return Heard(records, through, adding(draw, channel))


OWN = heard(record_of)


def range_of(response):
    """Return the least and largest sun displacement along x [um]."""
    x = UM * signal(response, SUN).values
    return tuple(float(end) if abs(end) > ROUNDING else 0.0 for end in (x.min(), x.max()))


def section_of(response):
    """Return the Poincare section ``(points, 2)`` at f_m of the sun's rotation, scaled by the range of the motion."""
    x, v = signal(response, "sunL.theta"), signal(response, "sunL.theta velocity")
    points = gf.poincare_section(x, speeds()[2], v)
    size = np.ptp(np.stack([x.values, v.values]), axis=1)
    return (points - points.mean(axis=0)) / size


def points_of(response):
    """Return the number of points of the Poincare section that differ by more than 0.5 %."""
    return len({tuple(np.round(point / 0.005).astype(int)) for point in section_of(response)})


def _scattered(response):
    return float(np.sqrt((section_of(response) ** 2).sum(axis=1).mean()))


def about_motion(records=record_of, heard=OWN):
    """Evaluate statements of article S4 on its motions and spectra, for the signal of a channel."""
    _, _, mesh, fault = speeds()
    own = sum(heard.line(None, n * mesh) ** 2 for n in range(1, 31)) / 2
    side = {name: heard.sidebands(case, mesh, fault) for name, case in STATES.items()}
    points = {name: points_of(records(case)) for name, case in STATES.items()}
    whole, crack, both = (heard(case).values for case in (None, CRACK60, "case3"))
    # Largest difference from the healthy machine.
    impulse = {name: float(np.abs(heard(case).values - whole).max()) for name, case in STATES.items() if case}
    scattered = [_scattered(records(STATES[name])) for name in ("healthy", "6 pits", "crack 30 %")]
    at_fault = {name: heard.line(case, fault) for name, case in STATES.items()}
    return {
        "healthy: only the mesh frequency and its harmonics": own > 0.98 * whole.var(),
        "healthy: sun's x does not vanish": max(map(abs, range_of(records(None)))) > 0.01,
        "healthy: Poincare map of few points": points["healthy"] <= 2,
        "crack 30 %: sidebands at f_m +- 80 Hz": side["crack 30 %"] > 10 * side["healthy"],
        "crack 30 %: line at 80 Hz": at_fault["crack 30 %"] > 10 * at_fault["healthy"],
        "crack 30 %: Poincare map of more points": points["crack 30 %"] > points["healthy"],
        "6 pits: sidebands lower than of the crack": side["6 pits"] < side["crack 30 %"],
        "6 pits: impulses smaller than of the crack": impulse["6 pits"] < impulse["crack 30 %"],
        "6 pits: phase portrait between healthy and cracked": scattered[0] < scattered[1] < scattered[2],
        "case 2: sidebands above crack or pits alone": side["case 2"] > max(side["crack 30 %"], side["6 pits"]),
        "case 2: impulses above crack or pits alone": impulse["case 2"] > max(impulse["crack 30 %"], impulse["6 pits"]),
        "case 3: close to the 60 % crack alone": (both - crack).std() < CLOSE * (crack - whole).std(),
        "case 4: sidebands above case 2": side["case 4"] > side["case 2"],
        "case 4: line at 80 Hz above case 2": at_fault["case 4"] > at_fault["case 2"],
    }


PRINTED = {"span": "displacement_span"}  # by quantity compared with draws: key of the reference


def drawn(draw):
    """Evaluate the statements with the inputs of a draw, by statement and channel. Also return ranges of the sun along x."""
    holds, records = {}, recorded(draw)
    for channel in (TURNING, SUN, HOUSING):
        one = heard(records, channel, draw)
        found = about_motion(records, one)
        hurt, whole = (one(case).indicators() for case in ("case4", None))
        growth = {name: hurt[name] / whole[name] for name in ("kurtosis", "crest factor")}
        found["kurtosis changes more than the crest factor"] = growth["kurtosis"] > growth["crest factor"]
        for name, held in found.items():
            holds.setdefault(name, {})[channel] = bool(held)
    for name in ("healthy: sun's x does not vanish", *(name for name in holds if "Poincare" in name or "portrait" in name)):
        holds[name] = {"sun's motion": holds[name][TURNING]}
    found = [records(case) for case in STATES.values()]
    numbers = {"span": [float(np.ptp(range_of(one))) for one in found]}
    numbers["opened"] = [float(one.stats.get("losses", 0)) for one in found]
    return {"holds": holds, "numbers": numbers}

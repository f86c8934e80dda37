"""A part of the page `herringbone_machine`: contact of back flanks, and stiff or flexible relief groove."""

from dataclasses import replace
from functools import cache

import numpy as np

import gearfe as gf

from ..shared.laws import beside, tables
from ..shared.simulated import record, signal
from .herringbone_numbers import speeds
from .herringbone_runs import RATE, SECONDS, UNSETTLED, made, record_of, settled

# [N m] torques on the sun; S4 states the first, the last moves the flanks across the backlash
LOADS = (400.0, 100.0, 25.0, 6.0, 0.0, -100.0)
# stiffness of the relief groove relative to the assumed value
GROOVES = {"stiff, 0.2 mm": 100.0, "20 mm": 1.0, "flexible, 2 m": 0.01}
MODES = 3.0  # Modes below this multiple of the mesh frequency are counted.
MESH = "sun_planet1L"


@cache
def loaded(case, torque):
    """Return the response under another torque of the sun, balanced by the torque of the carrier."""
    own = made(case)
    part = torque / LOADS[0]
    loads = tuple(replace(one, value=part * one.value) for one in own.loads)
    return record(replace(own, loads=loads), SECONDS, RATE, UNSETTLED)


def opened(case):
    """Return by torque the time shares [%] in which the first sun mesh is open, and in which its back flanks touch."""
    out = {}
    for torque in LOADS:
        found = loaded(case, torque)
        play = next(one.backlash for one in found.machine.meshes if one.name == MESH)
        x = np.asarray(found.raw[f"compression {MESH}"])  # compression of the drive flanks, negative inside the backlash
        out[f"{torque:g} N m, open"] = 100 * float(((x < 0) & (x > -play)).mean())
        out[f"{torque:g} N m, back flank"] = 100 * float((x <= -play).mean())
    return out


def error_of(case):
    """Return the range of the transmission error along the first sun mesh [um]."""
    return 1e6 * float(np.ptp(signal(record_of(case), f"compression {MESH}").values))


@cache
def grooved(factor, halves="LR"):
    """Return the response of case 2 with damage in these halves, and with the groove stiffness times `factor`."""
    own = made("case2")
    springs = [
        replace(one, k=factor * one.k, c=np.sqrt(factor) * one.c) if " groove " in one.name else one for one in own.springs
    ]
    meshes = [one if one.name[-1] in halves else replace(one, damage=()) for one in own.meshes]
    return settled(replace(own, springs=tuple(springs), meshes=tuple(meshes)))


def apart(factor, halves="LR"):
    """Return the standard deviation of the sun halves' relative rotation over that of their common rotation."""
    left, right = (signal(grooved(factor, halves), f"sun{half}.theta").values for half in "LR")
    return float((left - right).std() / ((left + right) / 2).std())


def modes(factor):
    """Return the natural frequencies below `MODES` f_m."""
    values, _ = gf.natural_frequencies(grooved(factor).machine)
    return float((values < MODES * speeds()[2]).sum())


def statements():
    """Evaluate the statements of article S4 on damage and groove."""
    stiff, _, soft = GROOVES.values()
    return {
        "damage raises the transmission error": error_of("case4") > 1.01 * error_of(None),
        "groove stiff: the halves act nearly as one gear": apart(stiff, "L") < 0.01,
        "groove flexible: the halves move against each other": apart(soft, "L") > 10 * apart(stiff, "L"),
        "groove flexible: there are more modes": modes(soft) > modes(stiff),
        "a fault in one half moves the halves more than one in both": apart(1.0, "L") > 10 * apart(1.0),
    }


def write_play():
    """Write the tables of backlash and groove."""
    columns = {"healthy": None, "case 4": "case4"}
    beside("herringbone_machine_play", {"time [%]": lambda name: opened(columns[name])}, *columns)
    rows = {
        "fault in one half, halves apart [% of their motion]": lambda name: {"": 100 * apart(GROOVES[name], "L")},
        "fault in both": lambda name: {"": 100 * apart(GROOVES[name])},
        f"modes below {MODES:g} f_m": lambda name: {"": modes(GROOVES[name])},
    }
    beside("herringbone_machine_groove", rows, *GROOVES)


def section():
    """Return the lines of the section."""
    return [
        "## Backlash and groove",
        "",
        *tables("herringbone_machine_play", PLAY, "healthy", "case 4"),
        *tables("herringbone_machine_groove", GROOVE, *GROOVES),
    ]


PLAY = (
    "Share of time in which the first sun mesh is open or in contact on its back flank, by the torque of the sun. The scene "
    "assumes errors and a backlash of 96 um. S4 has 400 N m and prints no backlash. With reversed torque, the mesh crosses the "
    "backlash once, from rest on the driving flanks"
)
GROOVE = (
    "The scene assumes a shaft of 20 mm under the relief groove. The other shafts are a hundred times as stiff (0.2 mm) and as "
    "soft (2 m). Case 2 has its damage in one half or in both. The first rows give the relative motion of the sun's halves, "
    "divided by their common motion"
)

"""The printed numbers of article S4 but its stiffness table (herringbone stage with crack and pits in the sun), computed."""

import csv
from dataclasses import replace
from functools import cache

import numpy as np

import gearfe as gf
from gearfe.files import written
from gearfe.machine.of_scene import with_scene_errors

from ..shared.laws import beside, tables
from ..shared.places import TABLES
from ..shared.simulated import PHASES, amplitude, machine, periodic, record, scene, signal, spectrum, told
from .herringbone_numbers import NAME, QUICK, speeds  # noqa: F401

MOVED = TABLES / "herringbone_machine_errors.csv"
SECONDS, SETTLE = 0.3, 0.075  # 8 turns of the sun relative to the carrier, after 2
RATE = 64 * 480.0
STATES = {"healthy": None, "crack 30 %": "crack30", "6 pits": "pits6", "case 2": "case2", "case 3": "case3", "case 4": "case4"}
PITTED = {"light": "case1", "moderate": "case2", "severe": "case4"}
CRACKS = (0.1, 0.6)
GROWN = {("case1", 0.1): "case1", ("case2", 0.6): "case3"}  # pits of a case and crack: a case of the scene
SUN, TURNING = "sunL.x", "sunL.theta acceleration"
UM = 1e6
ERRING, PERFECT = "with errors", "without errors"
ERRORS = ("profile_error_um", "runout_um", "misplaced_y_um", "backlash_um")
ROUNDING = 1e-9  # um: what cancels leaves 1e-13


def degrees():
    """Of freedom."""
    return {"whole machine": float(len(machine(NAME).dofs))}


@cache
def _record(case, errors=ERRING):
    """Response of a case with the errors that the scene assumes, or without any."""
    if errors == ERRING:
        return record(machine(NAME, case), SECONDS, RATE, SETTLE, periodic(NAME, case))
    return record(machine(NAME, case).with_meshes(error=(), backlash=0.0), SECONDS, RATE, 4 * SETTLE)


@cache
def _range(case, errors=ERRING):
    """Least and largest sun displacement along x [um]."""
    x = UM * signal(_record(case, errors), SUN).values
    return tuple(float(end) if abs(end) > ROUNDING else 0.0 for end in (x.min(), x.max()))


def displacement_upper():
    """Of the sun along x [um]."""
    return {name: _range(case)[1] for name, case in STATES.items()}


def displacement_lower():
    """Of the sun along x [um]."""
    return {name: _range(case)[0] for name, case in STATES.items()}


def displacement_span():
    """Upper less lower end [um]."""
    return {name: _range(case)[1] - _range(case)[0] for name, case in STATES.items()}


def healthy_spectrum():
    """Of the sun along x [um]."""
    found, mesh = spectrum(signal(_record(None), SUN)), speeds()[2]
    lines = {f"{n} f_m" if n > 1 else "f_m": UM * amplitude(found, n * mesh) for n in (1, 2, 3)}
    return {name: value if value > ROUNDING else 0.0 for name, value in lines.items()}


def largest_displacement():
    """Largest modulus of the sun along x [um]."""
    cases = {"healthy": None, "30 % + 6 pits": "test6", "30 % + 12 pits": "test12"}
    return {name: max(map(abs, _range(case))) for name, case in cases.items()}


def measured_displacement():
    """Measured on the housing: ours is that of the sun."""
    return largest_displacement()


@cache
def _indicators(pitted, crack):
    """Indicators of the sun's angular acceleration with the pits of a case and a crack, and of the healthy machine."""
    if pitted is None or (pitted, crack) in GROWN:
        found = _record(GROWN.get((pitted, crack)))
    else:
        found = record(_grown(pitted, crack), SECONDS, RATE, 4 * SETTLE)
    return signal(found, TURNING).indicators(*speeds()[2:])


def _grown(pitted, crack):
    """The machine with the pits of a case and a crack of a level."""
    pairs = {}
    for name, one in scene(NAME).pairs.items():
        damage = {
            side: [replace(d, level=crack) if isinstance(d, gf.Crack) else d for d in found]
            for side, found in one.damage.get(pitted, {}).items()
        }
        pairs[name] = replace(one, damage={"grown": damage} if damage else {})
    return gf.build_machine(replace(scene(NAME), pairs=pairs), "grown", method="ritz3d", phases=PHASES[NAME])


def _increments(name, pick):
    healthy = _indicators(None, 0.0)[name]
    out = {}
    for level, case in PITTED.items():
        values = [_indicators(case, crack)[name] for crack in CRACKS]
        out[level] = pick(100 * (value / healthy - 1) for value in values)
    return out


def crest_least():
    """Increments [%] of the crest factor, least over the cracks."""
    return _increments("crest factor", min)


def crest_most():
    """Largest over the cracks."""
    return _increments("crest factor", max)


def kurtosis_least():
    """Increments [%] of the kurtosis, least over the cracks."""
    return _increments("kurtosis", min)


def kurtosis_most():
    """Largest over the cracks."""
    return _increments("kurtosis", max)


def _sideband(pick):
    return {level: pick(_indicators(case, crack)["sideband index"] for crack in CRACKS) for level, case in PITTED.items()}


def sideband_least():
    """Sideband index of the sun's angular acceleration [rad/s2], least over the cracks."""
    return _sideband(min)


def sideband_most():
    """Largest over the cracks."""
    return _sideband(max)


def poincare():
    """Points of the Poincare section by state."""
    return {name: float(poincare_points(case)) for name, case in STATES.items()}


@cache
def poincare_points(case):
    """Distinct points of the Poincare section at f_m of the sun's rotation, over the eight turns."""
    response = _record(case)
    x, v = signal(response, "sunL.theta"), signal(response, "sunL.theta velocity")
    points = gf.poincare_section(x, speeds()[2], v)
    size = np.ptp(np.stack([x.values, v.values]), axis=1)
    cells = {tuple(np.round(point / (0.005 * size)).astype(int)) for point in points - points.mean(axis=0)}
    return len(cells)


def _line(case, frequency, channel=TURNING):
    return amplitude(spectrum(signal(_record(case), channel)), frequency)


def statements():
    """What S4 says of its motions and spectra; see the scene for the words."""
    _, _, mesh, fault = speeds()
    found = spectrum(signal(_record(None), TURNING))
    own = sum(amplitude(found, n * mesh) ** 2 for n in range(1, 31)) / 2
    side = {name: (_line(case, mesh - fault) + _line(case, mesh + fault)) / 2 for name, case in STATES.items()}
    points = {name: poincare_points(case) for name, case in STATES.items()}
    least = {name: increments for name, increments in (("crest", crest_most()), ("kurtosis", kurtosis_most()))}
    return {
        "healthy: only the mesh frequency and its harmonics": own > 0.98 * signal(_record(None), TURNING).values.var(),
        "healthy: sun's x does not vanish": max(map(abs, _range(None))) > 0.01,
        "healthy: Poincare map of few points": points["healthy"] <= 2,
        "crack 30 %: sidebands at f_m +- 80 Hz": side["crack 30 %"] > 10 * side["healthy"],
        "crack 30 %: line at 80 Hz": _line(STATES["crack 30 %"], fault) > 10 * _line(None, fault),
        "crack 30 %: Poincare map of more points": points["crack 30 %"] > points["healthy"],
        "6 pits: sidebands lower than of the crack": side["6 pits"] < side["crack 30 %"],
        "case 2: sidebands above crack or pits alone": side["case 2"] > max(side["crack 30 %"], side["6 pits"]),
        "case 4: sidebands above case 2": side["case 4"] > side["case 2"],
        "kurtosis changes more than the crest factor": least["kurtosis"]["severe"] > least["crest"]["severe"],
    }


@cache
def _moved(**changes):
    """Healthy sun's mean place, range along x and line at f_m [um] with errors of the scene changed."""
    own = scene(NAME)
    made = machine(NAME).with_meshes(error=(), backlash=1e-6 * own.machine["backlash_um"])
    table = own.machine | changes
    erred = with_scene_errors(replace(own, machine=table), made)
    x = signal(record(erred, SECONDS, RATE, 4 * SETTLE), SUN)
    line = UM * amplitude(spectrum(x), speeds()[2])
    return UM * float(x.values.mean()), UM * float(np.ptp(x.values)), line


def write_more():
    """Tables: with and without errors, and what each error does."""
    beside("herringbone_machine", BESIDE, ERRING, PERFECT)
    own = scene(NAME).machine
    with written(MOVED) as target, open(target, "w", encoding="utf-8", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(("errors", "mean x [um]", "range of x [um]", "line at f_m [um]"))
        rows = {"as assumed": {}} | {
            f"{key} = {factor * own[key]:g}": {key: factor * own[key]} for key in ERRORS[:3] for factor in (0, 2)
        }
        for name, changes in rows.items():
            out.writerow((name, *(f"{value:.6g}" for value in _moved(**changes))))


def more():
    """Lines of the page beside the verdicts."""
    with open(MOVED, encoding="utf-8", newline="") as file:
        head, *rows = csv.reader(file)
    lines = [
        "What each assumed error does to the healthy sun along x (from rest; of the transient some is left):",
        "",
        f"| {' | '.join(head)} |",
        "|---" * len(head) + "|",
    ]
    lines += [f"| {row[0]} | {' | '.join(f'{float(value):.3g}' for value in row[1:])} |" for row in rows]
    return [*lines, "", *tables("herringbone_machine", BOTH, ERRING, PERFECT)]


def _ranges(errors=ERRING):
    """Range of the sun along x [um] by state."""
    return {name: _range(case, errors)[1] - _range(case, errors)[0] for name, case in STATES.items()}


def _means(errors=ERRING):
    """Mean place of the sun along x [um] by state."""
    return {name: UM * float(signal(_record(case, errors), SUN).values.mean()) for name, case in STATES.items()}


def _of_turning(indicator):
    """Function of the errors: an indicator of the sun's angular acceleration by state."""
    mesh, fault = speeds()[2:]
    return lambda errors=ERRING: {
        name: signal(_record(case, errors), TURNING).indicators(mesh, fault)[indicator] for name, case in STATES.items()
    }


BESIDE = {
    "sun x, mean [um]": _means,
    "sun x, range [um]": _ranges,
    "sun's angular acceleration, crest factor": lambda errors: _of_turning("crest factor")(errors),
    "its kurtosis": lambda errors: _of_turning("kurtosis")(errors),
    "its sideband index [rad/s^2]": lambda errors: _of_turning("sideband index")(errors),
}
BOTH = "With the errors that the scene assumes, which is judged above, and without any"


def runs():
    """What the simulations were made with."""
    return {ERRING: told(_record(None)), PERFECT: told(_record(None, PERFECT))}


PICTURES = {
    "herringbone_machine_spectra": "Angular acceleration of the sun",
    "herringbone_machine_phase": "Phase portraits of the sun's rotation, with its Poincare points once a mesh cycle",
}


def draw(folder):
    """Pictures of the page."""
    from gearfe.pictures.vibration_plots import plot_phases, plot_spectra

    lines = gf.expected_lines(*speeds()[2:], count=2, harmonics=2)
    spectra = {name: spectrum(signal(_record(case), TURNING)) for name, case in STATES.items()}
    plot_spectra(spectra, lines, folder / "herringbone_machine_spectra.png", 1300.0, dpi=60, title=f"herringbone, {TURNING}")
    portraits = {}
    for name, case in STATES.items():
        x, v = signal(_record(case), "sunL.theta"), signal(_record(case), "sunL.theta velocity")
        portraits[name] = gf.phase_portrait(x, v), gf.poincare_section(x, speeds()[2], v)
    plot_phases(portraits, "rad", folder / "herringbone_machine_phase.png", title="herringbone, sunL.theta")


SIMULATED = {
    "degrees": degrees,
    "displacement_upper": displacement_upper,
    "displacement_lower": displacement_lower,
    "displacement_span": displacement_span,
    "healthy_spectrum": healthy_spectrum,
    "largest_displacement": largest_displacement,
    "measured_displacement": measured_displacement,
    "crest_least": crest_least,
    "crest_most": crest_most,
    "kurtosis_least": kurtosis_least,
    "kurtosis_most": kurtosis_most,
    "sideband_least": sideband_least,
    "sideband_most": sideband_most,
    "poincare_points": poincare,
    "statements": statements,
}
RUN_OF = dict.fromkeys(set(SIMULATED) - {"degrees"}, ERRING)

"""Printed numbers of article S4 except its stiffness table (herringbone stage with damaged sun), computed by gearfe."""

from dataclasses import replace
from functools import cache, partial

import numpy as np

import gearfe as gf
from gearfe.dynamics.machine.of_scene import with_scene_errors

from ..shared.laws import beside, tables
from ..shared.places import TABLES
from ..shared.simulated import PHASES, amplitude, by_name, machine, record, scene, signal, spectrum, told
from ..shared.table_rows import rows_of, write_table
from . import herringbone_play as play
from .herringbone_numbers import NAME, QUICK, speeds  # noqa: F401
from .herringbone_runs import (  # noqa: F401
    ERRING,
    PERFECT,
    PRINTED,
    RATE,
    ROUNDING,
    SECONDS,
    SETTLE,
    STATES,
    SUN,
    TURNING,
    UM,
    about_motion,
    beside_crack,
    drawn,
    found_in,
    impulse_of,
    points_of,
    range_of,
    record_of,
)  # fmt: skip

MOVED = TABLES / "herringbone_machine_errors.csv"
PITTED = {"light": "case1", "moderate": "case2", "severe": "case4"}
CRACKS = (0.1, 0.6)
GROWN = {("case1", 0.1): "case1", ("case2", 0.6): "case3"}  # case of the scene: (case of its pits, crack level)
ERRORS = ("profile_error_um", "runout_um", "misplaced_y_um", "backlash_um")


def degrees():
    """Return the degrees of freedom of the whole machine."""
    return {"whole machine": float(len(machine(NAME).dofs))}


def _displacement(end):
    """Return the upper limit (1) or lower limit (0) of the sun displacement along x [um]."""
    return {name: range_of(case)[end] for name, case in STATES.items()}


def displacement_span():
    """Return the range of the sun displacement along x [um]."""
    return _ranges()


def healthy_spectrum():
    """Return the lines of the sun displacement along x [um]."""
    found, mesh = spectrum(signal(record_of(None), SUN)), speeds()[2]
    lines = {f"{n} f_m" if n > 1 else "f_m": UM * amplitude(found, n * mesh) for n in (1, 2, 3)}
    return {name: value if value > ROUNDING else 0.0 for name, value in lines.items()}


def largest_displacement():
    """Return the largest absolute displacement of the sun along x [um]."""
    cases = {"healthy": None, "30 % + 6 pits": "test6", "30 % + 12 pits": "test12"}
    return {name: max(map(abs, range_of(case))) for name, case in cases.items()}


def measured_displacement():
    """Return the largest displacement of the sun. The article measured the housing instead."""
    return largest_displacement()


@cache
def _indicators(pitted, crack):
    """Return indicators of the sun's angular acceleration with the pits of a case and a crack, or of the healthy machine."""
    if pitted is None or (pitted, crack) in GROWN:
        found = record_of(GROWN.get((pitted, crack)))
    else:
        found = record(_grown(pitted, crack), SECONDS, RATE, 4 * SETTLE)
    return signal(found, TURNING).indicators(*speeds()[2:])


def _grown(pitted, crack):
    """Return the machine with the pits of a case and with a crack of a level."""
    damage = {
        name: {
            side: [replace(d, level=crack) if isinstance(d, gf.Crack) else d for d in found]
            for side, found in one.damage.get(pitted, {}).items()
        }
        for name, one in scene(NAME).pairs.items()
    }
    return gf.build_machine(scene(NAME).with_damage("grown", damage), "grown", method="ritz3d", phases=PHASES[NAME])


def _over_cracks(name, pick):
    """Return the least or largest value of an indicator over the cracks: sideband index [rad/s2], others as increment [%]."""
    healthy, out = _indicators(None, 0.0)[name], {}
    for level, case in PITTED.items():
        values = [_indicators(case, crack)[name] for crack in CRACKS]
        out[level] = pick(values if name == "sideband index" else [100 * (value / healthy - 1) for value in values])
    return out


def poincare_points():
    """Return the number of Poincare points by state."""
    return {name: float(points_of(case)) for name, case in STATES.items()}


def statements():
    """Evaluate the statements of article S4 on its motions and spectra."""
    changes = _over_cracks("kurtosis", max)["severe"] > _over_cracks("crest factor", max)["severe"]
    return about_motion() | {"kurtosis changes more than the crest factor": changes}


def further():
    """Evaluate the statements of `sources/statements.toml`."""
    return about_motion() | play.statements()


@cache
def _moved(**changes):
    """Return the healthy sun's mean position, range along x and line at f_m [um], with one assumed error changed at a time."""
    own = scene(NAME)
    made = machine(NAME).with_meshes(error=(), backlash=1e-6 * own.machine["backlash_um"])
    table = own.machine | changes
    erred = with_scene_errors(replace(own, machine=table), made)
    x = signal(record(erred, SECONDS, RATE, 4 * SETTLE), SUN)
    line = UM * amplitude(spectrum(x), speeds()[2])
    return UM * float(x.values.mean()), UM * float(np.ptp(x.values)), line


def write_more():
    """Write two tables: with and without errors, and the effect of each error."""
    beside("herringbone_machine", BESIDE, ERRING, PERFECT)
    play.write_play()
    own = scene(NAME).machine
    rows = {"as assumed": {}}
    rows |= {f"{key} = {factor * own[key]:g}": {key: factor * own[key]} for key in ERRORS[:3] for factor in (0, 2)}
    header = "errors", "mean x [um]", "range of x [um]", "line at f_m [um]"
    write_table(MOVED, header, [(name, *map(float, _moved(**changes))) for name, changes in rows.items()])


def more():
    """Return further sections of the page."""
    rows = rows_of(MOVED)
    lines = [
        "Effect of each assumed error on the healthy sun along x (from rest, with a part of the transient):",
        "",
        f"| {' | '.join(rows[0])} |",
        "|---|---|---|---|",
    ]
    for name, *values in map(dict.values, rows):
        lines.append(f"| {name} | {' | '.join(f'{float(value):.3g}' for value in values)} |")
    return [*lines, "", *tables("herringbone_machine", BOTH, ERRING, PERFECT), *play.section()]


def _ranges(errors=ERRING):
    """Return the range of the sun along x [um] by state."""
    return {name: range_of(case, errors)[1] - range_of(case, errors)[0] for name, case in STATES.items()}


def _means(errors=ERRING):
    """Return the mean position of the sun along x [um] by state."""
    return {name: UM * float(signal(record_of(case, errors), SUN).values.mean()) for name, case in STATES.items()}


def _impulses(errors=ERRING):
    """Return the largest difference of the sun's angular acceleration from the healthy one, by state."""
    return {name: impulse_of(case, errors) for name, case in STATES.items() if case}


def _of_turning(indicator):
    """Return a function of the errors that computes an indicator of the sun's angular acceleration by state."""
    mesh, fault = speeds()[2:]
    return lambda errors=ERRING: {
        name: signal(record_of(case, errors), TURNING).indicators(mesh, fault)[indicator] for name, case in STATES.items()
    }


BESIDE = {
    "sun x, mean [um]": _means,
    "sun x, range [um]": _ranges,
    "sun's angular acceleration, crest factor": lambda errors: _of_turning("crest factor")(errors),
    "its kurtosis": lambda errors: _of_turning("kurtosis")(errors),
    "its sideband index [rad/s^2]": lambda errors: _of_turning("sideband index")(errors),
    "its largest difference from the healthy one [rad/s^2]": _impulses,
    "what pits add to the crack of case 3, of what the crack changes": lambda errors: {"case 3": beside_crack(errors)},
}
BOTH = "The verdicts use the errors that the scene assumes. The second column has no errors"


def runs():
    """Return the settings of the simulations."""
    return {ERRING: told(record_of(None)), PERFECT: told(record_of(None, PERFECT))}


PICTURES = {
    "herringbone_machine_spectra": "Angular acceleration of the sun",
    "herringbone_machine_phase": "Phase portraits of the sun's rotation, with its Poincare points once a mesh cycle",
}


def draw(folder):
    """Draw the pictures of the page."""
    from gearfe.figures.vibration_plots import plot_spectra

    from ..shared.plots import plot_phases

    lines = gf.expected_lines(*speeds()[2:], count=2, harmonics=2)
    spectra = {name: spectrum(signal(record_of(case), TURNING)) for name, case in STATES.items()}
    plot_spectra(spectra, lines, folder / "herringbone_machine_spectra.png", 1300.0, dpi=60, title=f"herringbone, {TURNING}")
    portraits = {}
    for name, case in STATES.items():
        x, v = signal(record_of(case), "sunL.theta"), signal(record_of(case), "sunL.theta velocity")
        portraits[name] = gf.phase_portrait(x, v), gf.poincare_section(x, speeds()[2], v)
    plot_phases(portraits, "rad", folder / "herringbone_machine_phase.png", title="herringbone, sunL.theta")


SIMULATED = by_name(degrees, displacement_span, healthy_spectrum, largest_displacement, measured_displacement, poincare_points)
SIMULATED |= by_name(statements, further)
SIMULATED |= {"displacement_upper": partial(_displacement, 1), "displacement_lower": partial(_displacement, 0)}
SIMULATED |= {
    f"{reference}_{end}": partial(_over_cracks, name, pick)
    for reference, name in (("crest", "crest factor"), ("kurtosis", "kurtosis"), ("sideband", "sideband index"))
    for end, pick in (("least", min), ("most", max))
}
RUN_OF = dict.fromkeys(set(SIMULATED) - {"degrees"}, ERRING)

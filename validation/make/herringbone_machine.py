"""Printed numbers of article S4 except its stiffness table (herringbone stage with damaged sun), computed by gearfe."""

from dataclasses import replace
from functools import cache, partial

import numpy as np

import gearfe as gf

from ..shared.simulated import PHASES, amplitude, by_name, machine, record, scene, signal, spectrum
from .herringbone_numbers import NAME, QUICK, speeds  # noqa: F401
from .herringbone_runs import (  # noqa: F401
    OWN,
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
    drawn,
    made,
    points_of,
    range_of,
    record_of,
    settled,
)

PITTED = {"light": "case1", "moderate": "case2", "severe": "case4"}
CRACKS = (0.1, 0.6)
# stiffness of the relief groove relative to the assumed value
STIFF, SOFT = 100.0, 0.01
MODES = 3.0  # Modes below this multiple of the mesh frequency are counted.
GROWN = {("case1", 0.1): "case1", ("case2", 0.6): "case3"}  # case of the scene: (case of its pits, crack level)


def degrees():
    """Return the degrees of freedom of the whole machine."""
    return {"whole machine": float(len(machine(NAME).dofs))}


def _displacement(end):
    """Return the upper limit (1) or lower limit (0) of the sun displacement along x [um]."""
    return {name: range_of(record_of(case))[end] for name, case in STATES.items()}


def displacement_span():
    """Return the range of the sun displacement along x [um]."""
    return {name: float(np.ptp(range_of(record_of(case)))) for name, case in STATES.items()}


def healthy_spectrum():
    """Return the lines of the sun displacement along x [um]."""
    found, mesh = spectrum(signal(record_of(None), SUN)), speeds()[2]
    lines = {f"{n} f_m" if n > 1 else "f_m": UM * amplitude(found, n * mesh) for n in (1, 2, 3)}
    return {name: value if value > ROUNDING else 0.0 for name, value in lines.items()}


def largest_displacement():
    """Return the largest absolute displacement of the sun along x [um]."""
    cases = {"healthy": None, "30 % + 6 pits": "test6", "30 % + 12 pits": "test12"}
    return {name: max(map(abs, range_of(record_of(case)))) for name, case in cases.items()}


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
    return {name: float(points_of(record_of(case))) for name, case in STATES.items()}


def error_of(case):
    """Range of the transmission error along the first sun mesh [um]."""
    return 1e6 * float(np.ptp(signal(record_of(case), "compression sun_planet1L").values))


@cache
def grooved(factor, halves="LR"):
    """Return the response of case 2 with damage in these halves, and the groove's shaft stiffness times `factor`."""
    own = made("case2")
    springs = [
        replace(one, k=factor * one.k, c=np.sqrt(factor) * one.c) if " groove " in one.name else one for one in own.springs
    ]
    meshes = [one if one.name[-1] in halves else replace(one, damage=()) for one in own.meshes]
    return settled(replace(own, springs=tuple(springs), meshes=tuple(meshes)))


def apart(factor, halves="LR"):
    """Return the standard deviation of the relative rotation of the sun's halves, over that of their common rotation."""
    left, right = (signal(grooved(factor, halves), f"sun{half}.theta").values for half in "LR")
    return float((left - right).std() / ((left + right) / 2).std())


def modes(factor):
    """Natural frequencies below `MODES` f_m."""
    values, _ = gf.natural_frequencies(grooved(factor).machine)
    return float((values < MODES * speeds()[2]).sum())


def about_groove():
    """Statements of article S4 on damage and groove."""
    return {
        "damage raises the transmission error": error_of("case4") > 1.01 * error_of(None),
        "groove stiff: the halves act nearly as one gear": apart(STIFF, "L") < 0.01,
        "groove flexible: the halves move against each other": apart(SOFT, "L") > 10 * apart(STIFF, "L"),
        "groove flexible: there are more modes": modes(SOFT) > modes(STIFF),
        "a fault in one half moves the halves more than one in both": apart(1.0, "L") > 10 * apart(1.0),
    }


def statements():
    """Evaluate the statements of article S4 on its motions and spectra."""
    changes = _over_cracks("kurtosis", max)["severe"] > _over_cracks("crest factor", max)["severe"]
    return about_motion() | {"kurtosis changes more than the crest factor": changes}


def further():
    """Evaluate the statements of `sources/statements.toml`."""
    return about_motion() | about_groove()


PICTURES = {
    "herringbone_machine_spectra": "Angular acceleration of the sun",
    "herringbone_machine_phase": "Phase portraits of the sun's rotation, with its Poincare points once a mesh cycle",
}


def draw(folder):
    """Draw the pictures of the page."""
    from gearfe.figures.vibration_plots import plot_spectra

    from ..shared.plots import plot_phases

    lines = gf.expected_lines(*speeds()[2:], count=2, harmonics=2)
    spectra = {name: OWN.spectrum(case) for name, case in STATES.items()}
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

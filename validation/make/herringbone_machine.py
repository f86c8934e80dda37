"""The printed numbers of article S4 but its stiffness table (herringbone stage with crack and pits in the sun), computed."""

import math
from dataclasses import replace
from functools import cache

import numpy as np

import gearfe as gf
from gearfe.energy.closed.beam import SAINSOT

from ..shared.simulated import PHASES, amplitude, machine, periodic, record, scene, signal, spectrum

NAME = "herringbone"
SECONDS, SETTLE = 0.3, 0.075  # 8 turns of the sun relative to the carrier, after 2
RATE = 64 * 480.0
STATES = {"healthy": None, "crack 30 %": "crack30", "6 pits": "pits6", "case 2": "case2", "case 3": "case3", "case 4": "case4"}
PITTED = {"light": "case1", "moderate": "case2", "severe": "case4"}
CRACKS = (0.1, 0.6)
GROWN = {("case1", 0.1): "case1", ("case2", 0.6): "case3"}  # pits of a case and crack: a case of the scene
SUN, TURNING = "sunL.x", "sunL.theta acceleration"
UM = 1e6
ROUNDING = 1e-9  # um: what cancels leaves 1e-13


def speeds():
    """Frequencies [Hz] of sun, carrier, mesh and fault."""
    sun, ring, run = scene(NAME).gears["sun"].z, scene(NAME).gears["ring"].z, scene(NAME).machine
    turn = run["speed_rpm"] / 60
    carrier = turn / (1 + ring / sun)
    mesh = (turn - carrier) * sun
    return turn, carrier, mesh, run["n_planets"] * mesh / sun


def mesh_frequency():
    """By the relative speed of the sun, and by the printed form with the planet's teeth."""
    turn, carrier, mesh, _ = speeds()
    planet = scene(NAME).gears["planet"].z
    return {
        "(f_s - f_c) z_s": mesh,
        "(f_s - f_c) z_p as printed": (turn - carrier) * planet,
        "f_c z_r": carrier * scene(NAME).gears["ring"].z,
    }


def fault_frequency():
    """As printed, and how often the damaged tooth meshes."""
    _, _, mesh, fault = speeds()
    run, sun = scene(NAME).machine, scene(NAME).gears["sun"].z
    return {"f_m / (z_s N) as printed": mesh / (sun * run["n_planets"]), "N f_m / z_s": fault}


def periods():
    """Of sun and fault [s]."""
    turn, _, _, fault = speeds()
    return {"sun": 1 / turn, "fault": 1 / fault}


def mesh_period():
    """Printed 60 / (n_1 z_1) over the period of the mesh."""
    turn, _, mesh, _ = speeds()
    return {"60 / (n_1 z_1) as printed": mesh / (turn * scene(NAME).gears["sun"].z)}


def impulses():
    """Of one damaged sun tooth: in a turn of the sun, and in a turn relative to the carrier."""
    turn, carrier, _, fault = speeds()
    return {"turn of the sun": fault / turn, "turn relative to the carrier": fault / (turn - carrier)}


def sainsot():
    """Coefficients of the foundation polynomials."""
    names = [f"{row} {column}" for row in ("L", "M", "P", "Q") for column in "ABCDEF"]
    return dict(zip(names, map(float, SAINSOT.ravel()), strict=True))


def degrees():
    """Of freedom."""
    return {"whole machine": float(len(machine(NAME).dofs))}


def masses():
    """Of discs up to the reference circle, without bore, 60 mm wide [kg]."""
    out = {}
    for name in ("sun", "planet"):
        gear = scene(NAME).gears[name]
        out[name] = 7850e-9 * math.pi * gear.r**2 * gear.b
    return out


def inertias():
    """Of discs of the printed mass up to the reference circle, of the ring as a hoop of that radius [kg m2]."""
    out = {}
    for name, part in (("sun", 0.5), ("planet", 0.5), ("ring", 1.0)):
        out[name] = part * scene(NAME).machine["bodies"][name][0] * (1e-3 * scene(NAME).gears[name].r) ** 2
    return out


def pit_counts():
    """Pits of the cases in the table of stiffness, from the scene."""
    found = scene(NAME).pairs["sun_planet"].damage
    count = {case: sum(isinstance(one, gf.Pit) for one in found[case]["pinion"]) for case in ("case2", "case4")}
    return {
        "simulated, moderate": count["case2"],
        "measured, moderate": count["case2"],
        "measured, severe": count["case4"],
    }


@cache
def _record(case):
    made, start = machine(NAME, case), periodic(NAME, case)
    return record(made, SECONDS, RATE, SETTLE, start)


@cache
def _range(case):
    """Least and largest sun displacement along x [um]."""
    x = UM * signal(_record(case), SUN).values
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


def measured_range():
    """Not computed: the housing is not modelled."""
    return {"healthy, lower": None, "healthy, upper": None}


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


PICTURES = {
    "herringbone_machine_spectra": "Angular acceleration of the sun",
    "herringbone_machine_phase": "Phase portraits of the sun's rotation, with its Poincare points once a mesh cycle",
}


def draw(folder):
    """Pictures of the page."""
    from gearfe.pictures.vibration_plots import plot_phases, plot_spectra

    lines = gf.expected_lines(*speeds()[2:], count=2, harmonics=2)
    spectra = {name: spectrum(signal(_record(case), TURNING)) for name, case in STATES.items()}
    plot_spectra(spectra, lines, folder / "herringbone_machine_spectra.png", 1300.0, dpi=60)
    portraits = {}
    for name, case in STATES.items():
        x, v = signal(_record(case), "sunL.theta"), signal(_record(case), "sunL.theta velocity")
        portraits[name] = gf.phase_portrait(x, v), gf.poincare_section(x, speeds()[2], v)
    plot_phases(portraits, "rad", folder / "herringbone_machine_phase.png")


QUICK = {
    "mesh_frequency": mesh_frequency,
    "fault_frequency": fault_frequency,
    "periods": periods,
    "mesh_period": mesh_period,
    "impulses": impulses,
    "sainsot": sainsot,
    "masses": masses,
    "inertias": inertias,
    "pit_counts": pit_counts,
    "measured_range": measured_range,
}
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

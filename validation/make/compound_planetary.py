"""The printed numbers of article S2 (two-stage compound planetary gearbox with a cracked sun tooth), computed."""

import math
from fractions import Fraction
from functools import cache

import numpy as np
from scipy.signal import resample_poly

import gearfe as gf
from gearfe.machine.compound_planetary import compound_planetary

from ..shared.simulated import amplitude, machine, noisy, record, scene, signal, spectrum

NAME = "compound_planetary"
LEVELS = {"10 %": "crack10", "30 %": "crack30", "50 %": "crack50", "70 %": "crack70", "80 %": "crack80"}
BEAMS = {"root": "prism", "foundation": "none"}  # S2: Hertz, bending, shear and axial terms after Liang; no foundation
PAIRS = {
    "s1_sun_planet": "sun_planet",
    "s1_ring_planet": "planet_ring_1",
    "s2_sun_planet": "sun_planet",
    "s2_planet_planet": "planet_planet",
    "s2_ring_planet": "planet_ring_2",
}
RATE, SECONDS, SETTLE = 5120.0, 3.3, 0.5  # the rate of S2
SAMPLED = 24 * 2184.0  # Hz, 2184 is the least common multiple of both mesh frequencies: what folds, folds onto multiples of 14 Hz
NOISE = 0.5  # of the standard deviation of the healthy signal; assumed
SENSOR = "ring.theta acceleration"  # planets in phase cancel in x and y


@cache
def beams(pair, phases=400, span="cycle"):
    """Stiffness curve of a pair with the article's four components."""
    return gf.mesh_stiffness(**scene(NAME).pairs[pair].case(), method="textbook", variants=BEAMS, phases=phases, span=span)


def mean_stiffness():
    """Mean over the cycle [N/m]."""
    return {(name, pair): float(beams(pair).k.mean()) for name, pair in PAIRS.items()}


def stiffness_ratio():
    """Means over that of sun and planet."""
    k = {name: float(beams(pair).k.mean()) for name, pair in PAIRS.items()}
    return {name: k[name] / k["s2_sun_planet"] for name in ("s2_planet_planet", "s1_ring_planet", "s2_ring_planet")}


def broken_tooth():
    """What is left of the mean over the broken tooth's engagement, if it carries nothing."""
    curve = beams("sun_planet", span="tooth")
    own = curve.force[:, np.flatnonzero(curve.order == 0)[0]]
    engaged = own > 0
    return {"sudden break": float((curve.k * (1 - own / curve.force.sum(axis=1)))[engaged].mean() / curve.k[engaged].mean())}


def frequencies():
    """Mesh frequencies and fault frequencies of both stages [Hz]."""
    one, two = scene(NAME).pairs["planet_ring_1"].pair, scene(NAME).pairs["planet_ring_2"].pair
    sun, run = scene(NAME).gears["sun"].z, scene(NAME).machine
    ratios = sun / one.gear_2.z, sun / two.gear_2.z
    carrier = run["speed_rpm"] * ratios[1] / sum(ratios)  # (n2 - nc) z_s2 / z_r2 = nc z_s1 / z_r1
    mesh = carrier / 60 * sun, (run["speed_rpm"] - carrier) / 60 * sun
    return mesh, tuple(run["n_planets"] * f / sun for f in mesh)


def mating_time():
    """Contact ratio over the mesh frequency of stage 2 [s]."""
    return {"sun 2": scene(NAME).pairs["sun_planet"].pair.eps_alpha / frequencies()[0][1]}


def crack_step():
    """Length of 20 % of a crack that reaches the centre-line with 50 % [mm], by where it starts."""
    from geometry.damage.crack import crack_path

    sun = scene(NAME).gears["sun"]
    half = sun.r_b * math.sin(sun.base_half_angle)  # the source's tooth below the base circle is a prism
    start, tip = crack_path(sun, gf.Crack(level=0.5)).T
    return {
        "from the foot of the article's tooth": 0.4 * half / math.sin(math.radians(45)),
        "from the 30-degree tangent": 0.4 * float(np.hypot(*(tip - start))),
    }


def input_speed():
    """Speed of sun 2 from the two printed fault frequencies [rpm]."""
    n = scene(NAME).machine["n_planets"]
    return {"from 16.8 and 18.2 Hz": 60 * (16.8 + 18.2) / n}


def pulse_intervals():
    """Mesh periods [s]."""
    return {f"stage {i + 1}": 1 / f for i, f in enumerate(frequencies()[0])}


def fault_frequencies():
    """N f_m / z_s."""
    return {f"sun {i + 1}": f for i, f in enumerate(frequencies()[1])}


def fault_period():
    """Its inverse."""
    return {"sun 1": 1 / frequencies()[1][0]}


def measured_mesh():
    """At 700 rpm."""
    return {f"stage {i + 1}": f for i, f in enumerate(frequencies()[0])}


def measured_fault():
    """At 700 rpm."""
    return fault_frequencies()


def measured_period():
    """At 700 rpm."""
    return {f"sun {i + 1}": 1 / f for i, f in enumerate(frequencies()[1])}


def measured_speed():
    """Input speed that the measured lines stand for over 700 rpm: of one record the mesh and the fault lines must agree."""
    mesh, fault = frequencies()
    return {
        "mesh lines of both stages": (180.6 / mesh[1]) / (167.3 / mesh[0]),
        "fault lines": (17.67 / fault[1]) / (16.23 / fault[0]),
    }


def same_instant():
    """Whether planet i meets sun 1 and the ring at their pitch points at the same time."""
    phases = machine(NAME, None, "auto").notes["phases"]
    sun, ring = (scene(NAME).pairs[name].pair.pitch_phase for name in ("sun_planet", "planet_ring_1"))
    apart = (phases["p1_ring"] - ring - phases["sun1_p1"] + sun) % 1.0
    return {"stage 1": min(apart, 1 - apart) < 1e-6}


@cache
def _made(case):
    """Machine: healthy, a case of the scene (sun 2), or ``sun 1`` with the tooth of the case `crack80`."""
    if case != "sun 1":
        return machine(NAME, case, "auto")
    pairs = scene(NAME).pairs
    kinds = {"sun1_p": "sun_planet", "p_ring": "planet_ring_1", "sun2_b": "sun_planet", "b_c": "planet_planet"}
    kinds["c_ring"] = "planet_ring_2"
    curves = {name: gf.mesh_stiffness(**pairs[name].case(), phases=64) for name in set(kinds.values())}
    hurt = gf.mesh_stiffness(**pairs["sun_planet"].case("crack80"), phases=64, span="tooth")
    geometry = {kind: pairs[name].pair for kind, name in kinds.items()}
    healthy = {kind: curves[name] for kind, name in kinds.items()}
    return compound_planetary(healthy, pairs=geometry, damage={"sun1": (0, {"sun1_p": hurt})})


@cache
def _whole(case):
    """Angular acceleration of the ring as simulated."""
    return signal(record(_made(case), SECONDS, SAMPLED, SETTLE), SENSOR)


@cache
def heard(case):
    """The same behind an anti-aliasing filter, at the rate of S2."""
    ratio = Fraction(round(RATE), round(SAMPLED))
    values = resample_poly(_whole(case).values, ratio.numerator, ratio.denominator)
    cut = slice(round(0.05 * RATE), round((SECONDS - 0.05) * RATE))  # where the filter has its whole length
    return gf.Signal(values[cut], RATE, _whole(case).unit, case or "healthy")


@cache
def _noisy(case):
    """With noise of one size for all cases."""
    level = NOISE * heard(None).values.std()
    return noisy(heard(case), level / heard(case).values.std())


def kurtosis():
    """Of 1 s of the signals with noise."""
    cut = {name: _noisy(case) for name, case in (("healthy", None), ("sun 1 broken", "sun 1"), ("sun 2 broken", "crack80"))}
    return {name: gf.Signal(one.values[: round(RATE)], RATE, one.unit).indicators()["kurtosis"] for name, one in cut.items()}


@cache
def _kurtogram(case):
    found = gf.fast_kurtogram(_noisy(case), levels=7)
    return float(found.level[found.best]), float(found.centre[found.best]), found.band


def kurtogram_level():
    """Level of the largest kurtosis; the article's program prints 5.58 as 5.5."""
    return {
        name: math.floor(10 * _kurtogram(case)[0]) / 10 for name, case in (("sun 1 broken", "sun 1"), ("sun 2 broken", "crack80"))
    }


def kurtogram_centre():
    """Centre of its band [Hz]."""
    return {name: _kurtogram(case)[1] for name, case in (("sun 1 broken", "sun 1"), ("sun 2 broken", "crack80"))}


def _stands_out(found, frequency, low=5.0, high=60.0):
    """Whether the line at a frequency is three times the median of its neighbourhood."""
    around = found.within(low, high)[1]
    return amplitude(found, frequency) > 3 * np.median(around)


def _sideband(case, mesh, fault):
    """Amplitude of the first sidebands of a stage over its mesh line, without noise."""
    found = spectrum(_whole(case))
    return (amplitude(found, mesh - fault) + amplitude(found, mesh + fault)) / 2


def statements():
    """What S2 says of its spectra; see the scene for the words."""
    mesh, fault = frequencies()
    grown = [_sideband(case, mesh[1], fault[1]) for case in LEVELS.values()]
    healthy = _sideband(None, mesh[1], fault[1])
    one = _sideband("sun 1", mesh[0], fault[0]), _sideband(None, mesh[0], fault[0])
    found = spectrum(_whole(None))
    size = sum(amplitude(found, n * f) ** 2 for f in mesh for n in range(1, 141))
    squared = {case: gf.squared_envelope_spectrum(_noisy(case), _kurtogram(case)[2]) for case in ("sun 1", "crack80")}
    sun, planet = scene(NAME).gears["sun"], scene(NAME).gears["planet"]
    return {
        "root circles smaller than base circles (external gears)": sun.r_f < sun.r_b and planet.r_f < planet.r_b,
        "healthy: only mesh frequencies and their harmonics": size / 2 > 0.99 * _whole(None).values.var(),
        "crack in sun 1: sidebands f_m1 +- 16.8 Hz": one[0] > 10 * one[1],
        "crack in sun 2: sidebands f_m2 +- 18.2 Hz": grown[3] > 10 * healthy,
        "sidebands grow with the crack": bool((np.diff(grown[:4]) > 0).all()),
        "10 %: sidebands too small to be identified": grown[0] < 0.1 * grown[3],
        "squared envelope of the best band has 16.8 Hz (sun 1)": _stands_out(squared["sun 1"], fault[0]),
        "squared envelope of the best band has 18.2 Hz (sun 2)": _stands_out(squared["crack80"], fault[1]),
    }


def crack_levels():
    """Least stiffness over the engagement of a cracked tooth over the healthy one, by level and method."""
    chosen = scene(NAME).pairs["sun_planet"]
    out = {}
    for level, case in LEVELS.items():
        for method, options in (("ritz", {}), ("textbook", {"variants": BEAMS | {"crack_model": "straight"}})):
            run = {"method": method, "phases": 64, "span": "tooth"} | options
            whole = gf.mesh_stiffness(**chosen.case(), **run).k
            out[f"{level}, {method}"] = float((gf.mesh_stiffness(**chosen.case(case), **run).k / whole).min())
    return out


PICTURES = {
    "compound_planetary_k": "Stiffness of sun and planet over the engagement of a cracked tooth, converged energy model",
    "compound_planetary_spectra": "Angular acceleration of the ring",
}


def draw(folder):
    """Pictures of the page."""
    from gearfe.pictures.stiffness_plots import plot_curves
    from gearfe.pictures.vibration_plots import plot_spectra

    chosen, run = scene(NAME).pairs["sun_planet"], {"method": "ritz", "phases": 96, "span": "tooth"}
    curves = {"healthy": gf.mesh_stiffness(**chosen.case(), **run)}
    curves |= {level: gf.mesh_stiffness(**chosen.case(case), **run) for level, case in LEVELS.items()}
    plot_curves(curves, folder / "compound_planetary_k.png")
    (one, two), (slow, quick) = frequencies()
    lines = {"f_m1": one, "f_m2": two, "f_m1 - f_1": one - slow, "f_m2 + f_2": two + quick, "2 f_m1": 2 * one, "2 f_m2": 2 * two}
    cases = {"healthy": None, "sun 1, 80 %": "sun 1", "sun 2, 30 %": "crack30", "sun 2, 80 %": "crack80"}
    spectra = {name: spectrum(_whole(case)) for name, case in cases.items()}
    plot_spectra(spectra, lines, folder / "compound_planetary_spectra.png", 450.0, dpi=70)


QUICK = {
    "mean_stiffness": mean_stiffness,
    "stiffness_ratio": stiffness_ratio,
    "broken_tooth": broken_tooth,
    "mating_time": mating_time,
    "crack_step": crack_step,
    "input_speed": input_speed,
    "pulse_intervals": pulse_intervals,
    "fault_frequencies": fault_frequencies,
    "fault_period": fault_period,
    "measured_mesh": measured_mesh,
    "measured_fault": measured_fault,
    "measured_period": measured_period,
    "measured_speed": measured_speed,
    "same_instant": same_instant,
    "crack_levels": crack_levels,
}
SIMULATED = {
    "kurtosis": kurtosis,
    "kurtogram_level": kurtogram_level,
    "kurtogram_centre": kurtogram_centre,
    "statements": statements,
}

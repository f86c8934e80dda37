"""The printed numbers of articles S0 and S1 (planetary stage with pitted sun teeth), computed."""

from functools import cache

import numpy as np

import gearfe as gf
from gearfe.machine.contact_law import hertz_coefficient
from geometry.damage.pit import Pit
from geometry.pair.lines import total_length

from ..shared.simulated import amplitude, knocked, machine, periodic, record, scene, signal, spectrum

NAME = "planetary_pitting"
CASES = ("mild", "moderate", "severe")
SECONDS, SETTLE = 0.45, 0.15  # 6 turns of the sun relative to the carrier
RATE = 256 * 280.0  # above twice the highest natural frequency, 16.5 kHz; a multiple of f_m
IMPACT = {"height": 0.5, "period": 0.15, "width": 0.02}  # of the carrier's load; assumed, the articles print none
BINS = 61440 / 307200  # Hz, of the measured spectra
FORCE, SENSOR = "force sun_planet1", "ring.y acceleration"


def stage():
    """Pairs sun-planet and planet-ring."""
    return scene(NAME).pairs["sun_planet"], scene(NAME).pairs["planet_ring"]


def speeds():
    """Sun, carrier [rpm], mesh and fault frequency [Hz]."""
    outer, inner = stage()
    sun, ring = outer.pair.gear_1.z, inner.pair.gear_2.z
    run = scene(NAME).machine
    carrier = run["speed_rpm"] * sun / (sun + ring)
    mesh = (run["speed_rpm"] - carrier) / 60 * sun
    return run["speed_rpm"], carrier, mesh, run["n_planets"] * mesh / sun


def hertz():
    """K at the pitch point."""
    outer, _ = stage()
    radii = outer.pair.curvature_radii(outer.pair.pitch_phase)
    return {"sun and planet": hertz_coefficient(float(radii[0]), float(radii[1]), outer.materials)}


def base_radii():
    """Base radii."""
    return {name: scene(NAME).gears[name].r_b for name in ("sun", "planet")}


def carrier_speed():
    """Ring held."""
    return {"sun at 1000 rpm": speeds()[1]}


def mesh_frequency():
    """Of all meshes."""
    return {"simulated": speeds()[2]}


def mesh_period():
    """Its inverse."""
    return {"simulated": 1 / speeds()[2]}


def fault_frequency():
    """A damaged sun tooth meets every planet once a turn relative to the carrier."""
    return {"simulated": speeds()[3]}


def fault_interval():
    """Its inverse."""
    return {"simulated": 1 / speeds()[3]}


def measured_lines():
    """The nearest bins of the measured spectra to carrier and fault frequency at 1000 rpm."""
    return {name: round(value / BINS) * BINS for name, value in (("carrier", speeds()[1] / 60), ("fault", speeds()[3]))}


def ring_shift():
    """Profile shift with which planet and ring mesh at the centre distance of sun and planet without backlash."""
    outer, inner = stage()
    run = scene(NAME).machine
    made = gf.PlanetarySet(outer.pair.gear_1, outer.pair.gear_2, inner.pair.gear_2, run["n_planets"], outer.pair.a)
    return {"ring": made.closing_shift()}


def contact_ratio():
    """By the involute geometry; S0's formula is the same for equal shifts."""
    outer, inner = stage()
    return {"sun and planet": outer.pair.eps_alpha, "planet and ring": inner.pair.eps_alpha}


def lengths(count=400):
    """Phases over the tooth's engagement, length of all contact lines [mm] by case, and S0's formulas for the same rows.

    S0: a pit takes the chord ``l = sqrt((D/2)**2 - (D/2 - d)**2)`` (half of a circle's chord), d the distance of the contact
    from the pit's edge; N pits take N l.
    """
    outer, _ = stage()
    pair = outer.pair
    phase = (np.arange(count) + 0.5) / count * (pair.eps_alpha + 0.5) - 0.25
    out = {"healthy": total_length(pair, phase)}
    printed = {}
    for case in CASES:
        pits = outer.damage[case]["pinion"]
        out[case] = total_length(pair, phase, pits=(pits, ()))
        printed[case] = out["healthy"] - sum(_printed_chord(pair, phase, pit) for pit in pits)
    return phase, out, printed


def _printed_chord(pair, phase, pit: Pit):
    """S0's l(t) [mm] of one pit; d is the distance along the profile from the pit's edge to the contact."""
    roll = pair.path[0] + phase * pair.p_bt
    arc = (roll**2 + pair.gear_1.r_b**2 - pit.radius**2) / (2 * pair.gear_1.r_b)
    half = pit.axes[0]
    touching = (phase >= 0) & (phase < pair.eps_alpha)
    return np.where(touching, np.sqrt(np.maximum(half**2 - np.minimum(abs(arc), half) ** 2, 0.0)), 0.0)


def line_length():
    """Shortest and longest total contact line; with pits the shortest."""
    _, ours, _ = lengths()
    out = {"double contact, no pits": ours["healthy"].max(), "single contact, no pits": ours["healthy"].min()}
    return out | {f"{case}, least": ours[case].min() for case in CASES}


@cache
def _record(case, impact):
    name = None if case == "healthy" else case
    made = machine(NAME, name)
    start = periodic(NAME, name)
    if impact:
        made = knocked(made, "carrier torque", seconds=SECONDS + SETTLE, **IMPACT)
    return record(made, SECONDS, RATE, SETTLE, start)


@cache
def _values(case, impact, channel=FORCE):
    """Indicators of a channel."""
    return signal(_record(case, impact), channel).indicators(*speeds()[2:])


@cache
def _spectrum(case, impact, channel=FORCE):
    return spectrum(signal(_record(case, impact), channel))


def sc_simulated():
    """S0's definition on the force of a sun mesh, under impacts."""
    return {case: _values(case, True)["SC (S0)"] for case in CASES}


def sc_measured():
    """S0's definition on the acceleration of the ring, under impacts."""
    return {case: _values(case, True, SENSOR)["SC (S0)"] for case in CASES}


def _measured(name):
    return {case: _values(case, True, SENSOR)[name] for case in CASES}


def rms():
    """Of the acceleration of the ring, under impacts."""
    return _measured("rms")


def kurtosis():
    """Of the same."""
    return _measured("kurtosis")


def shape_factor():
    """Of the same."""
    return _measured("shape factor")


def amplitudes():
    """Largest acceleration of the ring, under impacts."""
    return _measured("peak")


def _sidebands(case, impact=False):
    """Mean amplitude of the force at f_m +- f_fault [N]."""
    mesh, fault = speeds()[2:]
    found = _spectrum(case, impact)
    return (amplitude(found, mesh - fault) + amplitude(found, mesh + fault)) / 2


@cache
def folded():
    """Healthy force at 240 Hz over its mesh line: 10 000 samples per second as in S0, and `RATE`."""
    start = periodic(NAME)
    out = []
    for rate in (10000.0, RATE):
        found = spectrum(signal(record(machine(NAME), 0.3, rate, SETTLE, start), FORCE))
        out.append(amplitude(found, 240.0) / amplitude(found, 280.0))
    return out


def statements():
    """What the articles say of spectra and indicators; see the scene for the words."""
    mesh, fault = speeds()[2:]
    side = {case: _sidebands(case) for case in ("healthy", *CASES)}
    knocked_peak = {impact: np.ptp(signal(_record("healthy", impact), FORCE).values) for impact in (False, True)}
    beside = [amplitude(_spectrum("healthy", impact), mesh + 1 / IMPACT["period"], 1 / SECONDS) for impact in (False, True)]
    s0, s1 = ([_values(case, True)[name] for case in CASES] for name in ("SC (S0)", "SC (S1)"))
    calm = [_values(case, False)["SC (S1)"] for case in CASES]
    return {
        "pits raise sidebands 40 Hz beside 280 Hz": min(side[case] for case in CASES) > 10 * side["healthy"],
        "they grow with severity": side["mild"] < side["moderate"] < side["severe"],
        "sidebands at the carrier's frequency beside them": None,
        "impacts raise the force": knocked_peak[True] > 1.1 * knocked_peak[False],
        "impacts bring close sidebands of the mesh line": beside[1] > 10 * beside[0],
        "SC by S0's formula rises with severity": bool((np.diff(s0) > 0.1).all()),
        "SC by S1's formula rises with severity": bool((np.diff(s1) > 0.01 * s1[0]).all()),
        "SC by S1's formula is little affected by impacts": max(abs(a / b - 1) for a, b in zip(s1, calm, strict=True)) < 0.1,
        "a healthy machine has no such sidebands, sampled as in S0": folded()[0] < 0.01,
        "a healthy machine has no such sidebands, sampled finer": folded()[1] < 0.01,
        "the window of SC allows 349.8 and 352.9 Hz": mesh + fault >= 349.8,
    }


PICTURES = {
    "planetary_pitting_lines": "Total contact line of the pitted sun tooth, with S0's half chord dashed "
    "(tables/planetary_pitting_lines.csv)",
    "planetary_pitting_spectra": "Force of a sun mesh, without impacts",
}


def draw(folder):
    """Pictures of the page."""
    from gearfe.pictures.stiffness_plots import plot_lengths
    from gearfe.pictures.vibration_plots import plot_spectra

    phase, ours, printed = lengths()
    plot_lengths(phase, ours, printed, folder / "planetary_pitting_lines.png")
    names = ["phase", *(f"L {name} [mm]" for name in ours), *(f"L {name} by S0's chord [mm]" for name in printed)]
    columns = np.transpose([phase, *ours.values(), *printed.values()])[::4]
    np.savetxt(folder / "tables" / "planetary_pitting_lines.csv", columns, "%.6g", ",", header=",".join(names), comments="")
    lines = gf.expected_lines(*speeds()[2:], count=2, harmonics=2)
    spectra = {case: _spectrum(case, False) for case in ("healthy", *CASES)}
    plot_spectra(spectra, lines, folder / "planetary_pitting_spectra.png", 800.0, dpi=70)


QUICK = {
    "hertz_coefficient": hertz,
    "base_radius": base_radii,
    "carrier_speed": carrier_speed,
    "mesh_frequency": mesh_frequency,
    "mesh_period": mesh_period,
    "fault_frequency": fault_frequency,
    "fault_interval": fault_interval,
    "measured_lines": measured_lines,
    "ring_shift": ring_shift,
    "contact_ratio": contact_ratio,
    "line_length": line_length,
}
SIMULATED = {
    "sc_simulated": sc_simulated,
    "sc_measured": sc_measured,
    "rms": rms,
    "kurtosis": kurtosis,
    "shape_factor": shape_factor,
    "amplitudes": amplitudes,
    "statements": statements,
}

"""The page `measured`: measured gearboxes of others, as far as their numbers are public, beside simulations of the same gears."""

import math
from dataclasses import replace
from itertools import product

import numpy as np

import gearfe as gf
from gearfe.comparison.settled import recorded
from gearfe.dynamics.machine.gear_pair import gear_pair_machine
from gearfe.dynamics.machine.layout import Body
from gearfe.dynamics.machine.member import gear_member
from gearfe.dynamics.machine.mesh_curves import Samples, cycle_table
from gearfe.dynamics.machine.scene_curves import stage_of
from gearfe.dynamics.machine.tooth_damage import ToothDamage
from validation.shared.places import SOURCES

TURNS, SETTLED = 8, 3  # turns of the carrier that are kept, and that are left out before
SPEED = 1000 * math.pi / 30  # rad/s of the driving gear: no source prints one; amplitudes are compared with each other only
PRINTED = {  # first carrier sideband over the mesh line: left, right
    "normal": ((0.92, 1.11), (0.10, 0.36)),
    "planet": ((1.70, 3.71), None),
    "sun": ((0.86, 1.18), (0.40, 1.20)),
}
MISPLACED = (5e-6, 20e-6, 60e-6)  # m, of one planet along the circle of the planets
RISE = 1.02  # from which a sideband counts as raised
LEVELS = (0.3, 0.6)  # of the crack of the faulty tooth
PLACES = (  # of the faulty tooth: condition, pair, which of its gears
    ("sun", "sun_planet", "pinion"),
    ("planet, sun side", "sun_planet", "wheel"),
    ("planet, ring side", "planet_ring", "pinion"),
)
QUIET = 1e-3  # energy ratio below which there is no difference signal to judge
PER_TURN = 17 * 64  # samples in a turn of the spur pinion
PHM_TEETH, PHM_HZ, PHM_RATE, PHM_PULSES = (32, 96, 48, 80), (30, 35, 40, 45, 50), 200e3 / 3, 10
PHM_MODULES, PHM_BORES = (1.5, 2.0, 3.0), (0.2, 0.6)  # mm; over the pitch radius


def stage():
    """The planetary set of the scene, its torque, and the stiffness of its healthy meshes by `ritz`."""
    scene = gf.load_scene(SOURCES / "planetary_31_31_95.toml")
    run = {"phases": 32, "method": "ritz"}
    return (
        stage_of(scene),
        scene.machine["torque_Nm"],
        {n: gf.mesh_stiffness(one.case(), **run) for n, one in scene.pairs.items()},
    )


def faults():
    """``{condition: {fault: damage}}`` of `gearfe.pitted_planetary`: a cracked tooth of the sun, or of planet 1, either side."""
    pairs = {name: one.case() for name, one in gf.load_scene(SOURCES / "planetary_31_31_95.toml").pairs.items()}
    out = {"normal": {"none": None}, "sun": {}, "planet": {}}
    for level, (where, name, side) in product(LEVELS, PLACES):
        hurt = gf.mesh_stiffness(pairs[name], damage={side: [gf.Crack(level=level)]}, phases=32, method="ritz", span="tooth")
        body = "sun" if where == "sun" else "planet1"
        out[where.partition(",")[0]][f"{where} {level}"] = {body: (0, {name: hurt})}
    return out


def ratios(made):
    """Carrier sidebands at the left and the right of the mesh line, over it, as a sensor on the ring receives them."""
    carrier, mesh = made.notes["carrier frequency [Hz]"], made.notes["mesh frequency [Hz]"]
    response = gf.simulate(made, (SETTLED + TURNS) / carrier, rate=32 * mesh)
    heard = gf.housing_signal(response)
    kept = heard.values[-round(TURNS / carrier * heard.rate) :]
    found = gf.spectrum(gf.Signal(kept, heard.rate, heard.unit))
    lines = gf.find_lines(found, {"left": mesh - carrier, "mesh": mesh, "right": mesh + carrier}, between=True)
    return lines["left"][1] / lines["mesh"][1], lines["right"][1] / lines["mesh"][1]


def planetary():
    """``{(condition, misplacement, fault): (left, right)}`` over all that is not printed."""
    gears, torque, curves = stage()
    out = {}
    for name, found in faults().items():
        for shift, (fault, damage) in product(MISPLACED, found.items()):
            made = gf.pitted_planetary(gears, curves, damage=damage, speed=SPEED, torque=torque)
            out[name, shift, fault] = ratios(gf.with_errors(made, place={"planet2": _along(shift, 2 * math.pi / 3)}))
    return out


def perfect():
    """Line at the left and mesh line over the right one, of a set without errors and faults."""
    gears, torque, curves = stage()
    left, right = ratios(gf.pitted_planetary(gears, curves, speed=SPEED, torque=torque))
    return left / right, 1 / right


def _along(shift, angle):
    return -shift * math.sin(angle), shift * math.cos(angle)


def ranges(found):
    """Smallest and largest of left and right by condition."""
    out = {}
    for name in PRINTED:
        rows = np.array([pair for (own, *_), pair in found.items() if own == name])
        out[name] = tuple((float(low), float(high)) for low, high in zip(rows.min(axis=0), rows.max(axis=0), strict=True))
    return out


def trends(found):
    """Of how many scanned sets a planet's fault raises the left sideband, and a sun's the right one."""
    rises = {}
    for name, side in (("planet", 0), ("sun", 1)):
        pairs = [(pair[side], found["normal", shift, "none"][side]) for (own, shift, _), pair in found.items() if own == name]
        rises[name] = sum(hurt > RISE * calm for hurt, calm in pairs), len(pairs)
    return rises


def spur(speed):
    """Indicators of the 17/38 pair's pinion, healthy and with a broken tooth, from the acceleration of its bearing."""
    chosen = gf.load_scene(SOURCES / "spur_17_38.toml").pairs["pinion_wheel"]
    curve = gf.mesh_stiffness(chosen.case(), phases=64, method="ritz")
    gears = chosen.pair
    phase = np.arange(-16, math.ceil((gears.eps_alpha + 0.25) * 64) + 1) / 64
    share = np.where((phase > gears.eps_alpha - 1) & (phase < 1), 0.05, np.where((phase > 0) & (phase < gears.eps_alpha), 0.6, 1))
    broken = (ToothDamage(0, 0, Samples(phase, share * cycle_table(curve)(phase % 1.0))),)
    made_of = [(name, gear_member(gear, 7850.0, 0.0)) for name, gear in (("pinion", gears.gear_1), ("wheel", gears.gear_2))]
    bodies = tuple(Body(name, one.mass, one.inertia, "x y theta") for name, one in made_of)
    signals = {}
    for name, damage in (("healthy", ()), ("broken", broken)):
        made = gear_pair_machine(
            gears, bodies, curve, speed=speed, torque=28.0, support={"x": 1e8, "y": 1e8}, torsion=(1e4, 0.0), zeta=0.02,
            damage=damage,
        ).with_meshes(zeta=0.05, backlash=1e-4)  # fmt: skip
        turn = 2 * math.pi / speed
        response = recorded(made, 10 * turn, 4 * PER_TURN / turn)
        fine = gf.Signal(np.asarray(response["pinion.y acceleration"]), 4 * PER_TURN / turn, "m/s^2", name)
        values = gf.decimate(fine, PER_TURN / turn).values[PER_TURN : 9 * PER_TURN]  # without what the filter sees of the ends
        signals[name] = gf.Signal(values, PER_TURN / turn, "m/s^2", name, shaft_frequency=1 / turn)
    return gf.gear_indicator_table(signals, 17)


def phm_rows():
    """Line frequencies of the PHM 2009 spur train by the speed of its input shaft."""
    one, two, three, four = PHM_TEETH
    return [(f, f * one, f * one / two, f * one / two * three, f * one / two * three / four) for f in PHM_HZ]


def phm_angle():
    """Largest error of the angle [turns] that ten square pulses a turn give at the set's rate, at each speed."""
    out = []
    for f in PHM_HZ:
        turns = f * np.arange(round(PHM_RATE)) / PHM_RATE + 0.013
        pulses = gf.Signal((turns * PHM_PULSES % 1 < 0.5).astype(float), PHM_RATE, "V", "tacho")
        got = gf.with_tachometer(gf.Signal(turns, PHM_RATE, "1"), pulses, PHM_PULSES)
        off = got.angle / (2 * math.pi) - got.values
        out.append(float(np.ptp(off)) / 2)
    return out


def phm_stiffness():
    """Mean stiffness over width [N/(mm um)] of both meshes of the train by what is not printed: module, bore by pitch radius."""
    out = {}
    pairs = gf.load_scene(SOURCES / "phm_2009.toml").pairs
    for (name, one), module, part in product(pairs.items(), PHM_MODULES, PHM_BORES):
        gears = [replace(g, m_n=module, r_bore=part * g.z * module / 2) for g in (one.pair.gear_1, one.pair.gear_2)]
        run = one.case().as_dict() | {"pair": gf.GearPair(*gears)}
        out[name, module, part] = 1e-6 * gf.mesh_stiffness(**run, phases=32, method="ritz").zones()["mean"] / gears[0].b
    return out


def sideband_rows(found):
    """Rows of the printed and the computed ranges."""
    ours = ranges(found)
    for name, (left, right) in PRINTED.items():
        yield [name, _told(left), _told(ours[name][0]), _told(right), _told(ours[name][1])]


def indicator_rows():
    """Rows of the indicators at three speeds; a quiet healthy pair has no FM4 and NA4."""
    for rpm in (600, 1200, 1800):
        calm, hurt = spur(rpm * math.pi / 30).values()
        cells = [f"{one[name]:.3g}" for name in ("FM4", "NA4", "energy ratio") for one in (calm, hurt)]
        if calm["energy ratio"] < QUIET:
            cells[::2] = ["–", "–", f"< {QUIET:g}"]
        yield [f"{rpm} rpm", *cells]


def train_rows():
    """Rows of the frequencies of the PHM 2009 train and the error of its tachometer's angle."""
    for row, off in zip(phm_rows(), phm_angle(), strict=True):
        yield [*(f"{one:.6g}" for one in row), f"{off:.2g}"]


def bore_rows():
    """Rows of the range of the stiffness of both meshes over the modules."""
    found = phm_stiffness()
    for part in PHM_BORES:
        values = [[found[name, module, part] for module in PHM_MODULES] for name in ("first", "second")]
        yield [f"{part:g}", *(f"{min(one):.3g} to {max(one):.3g}" for one in values)]


def _told(pair):
    return "–" if pair is None else f"{pair[0]:.2f} to {pair[1]:.2f}"

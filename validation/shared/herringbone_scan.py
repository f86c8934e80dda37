"""Article S4's ten rows under every reading of what it does not print: a space-filling scan, and which readings bear its claim.

`ritz3d` of a reading is read from the nodes of `herringbone_scan_nodes` (its compliance less that of the plane section is linear
in the logarithms of the bores; the crack's part a polynomial of its length; load, rim, root and pits as factors, measured one at
a time); `check` computes readings directly. The closed forms are evaluated for every reading, their pits as the same factors.
"""

import csv
import math
import time
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator
from scipy.stats import qmc

import gearfe as gf
from gearfe.energy.closed import published, textbook
from gearfe.energy.closed.slices import faces, stations
from gearfe.flexibility.hertz import linear_hertz
from gearfe.stiffness.inputs import overlap
from gearfe.studies.case_table import printed_cases

from . import herringbone_scan_nodes as nodes
from . import machine
from .herringbone_scan_nodes import BORES, FLAT, GROUPS, LENGTHS, PAIRS, PHASES, SCENE
from .places import TABLES

NAME = "herringbone_scan"
SIZE, SEED = 1024, 20
RANGES = {  # of the Sobol sample
    "group": (0.0, float(len(GROUPS))),
    "length": (
        0.5,
        1.5,
    ),  # of a crack of level 1, in chords; 0.71 the way to the centre-line, 1.41 that of `gearfe.Crack`, at 45 degrees
    "sun": (0.30, 0.85),  # bores, parts of the root radius
    "planet": (0.30, 0.85),
    "load": (-2.0, 2.0),  # binary logarithm of the part of 400 N m
    "tip": (0.20, 0.38),  # rack tip radius [m_n]
    "rim": (80.0, 95.0),  # outer radius of the ring, held [mm]
    "radius": (0.5, 1.0),  # of a pit [mm]
    "depth": (0.2, 0.5),  # of a pit [mm]
    "shift": (-0.6, 0.6),  # of the pits from the pitch circle [mm]
    "own": (
        0.0,
        2.0,
    ),  # 0: the formulas' crack as long as that of `ritz3d`; 1: the same part of their beam's foot
}
READINGS = ("printed", "external")  # foundation of the ring in `published`
STEPS = (
    0.0,
    0.03,
    0.06,
    0.1,
    0.15,
    0.2,
    0.3,
    0.4,
    0.5,
    0.6,
    0.65,
    0.7,
    0.75,
    0.8,
    0.85,
    0.9,
)  # crack lengths of the closed forms [chords]
LEVELS = {"1": (0.1, "3 pits"), "2": (0.3, "7 pits"), "3": (0.6, "7 pits, deep crack"), "4": (0.3, "14 pits")}


@dataclass(frozen=True, slots=True)
class Reading:
    """One reading of what S4 does not print; see `RANGES`, `group` numbers `GROUPS`."""

    group: int
    length: float
    sun: float
    planet: float
    load: float
    tip: float
    rim: float
    radius: float
    depth: float
    shift: float
    own: int

    def bores(self, pair):
        """Bores of the external gears of a pair [parts of the root radius]."""
        return (self.sun, self.planet) if pair == "sun_planet" else (self.planet,)


def readings(size=SIZE):
    """Readings of a scrambled Sobol sequence; every beginning of it fills the space."""
    points = qmc.Sobol(len(RANGES), seed=SEED).random_base2(math.ceil(math.log2(size)))[:size]
    scaled = qmc.scale(points, *np.array(list(RANGES.values())).T).round(4)
    return [Reading(min(int(row[0]), len(GROUPS) - 1), *row[1:-1], min(int(row[-1]), 1)) for row in scaled.tolist()]


def sensitivity():
    """Stiffness of the committed variations by (variation, pair, case, column) [N/m]."""
    with (TABLES / f"{SCENE}_sensitivity.csv").open(encoding="utf-8", newline="") as file:
        return {
            (row["variation"], row["pair"], row["case"], name.split()[0]): float(row[name])
            for row in csv.DictReader(file)
            for name in row
            if "[N/m]" in name
        }


def known_groups(known):
    """Groups all of whose nodes are in the table."""
    named = {}
    for name in nodes.jobs():
        if name[0].isdigit():
            named.setdefault(int(name.split()[0]), []).append(name in known)
    return [group for group, found in named.items() if all(found)]


SCENE_READING = Reading(0, math.sqrt(2), 0.5, 0.5, 0.0, 0.38, 87.0, 0.5, 0.2, 0.0, 1)  # the scene's; bores to 0.4 %


class Ritz3D:
    """`ritz3d` of a reading, from the nodes; those of the scene's reading are the committed ones at full resolution.

    `anchor` holds what that takes, by pair and case: the coarseness of the nodes and of their interpolation.
    """

    def __init__(self):
        self.known, self.seconds = nodes.load()
        self.factors = sensitivity()
        self.plane = {}
        for pair in PAIRS:
            for which in range(len(BORES[pair][0])):
                found = [float(1 / self.known[f"plane {pair} {which} {bore}"][0]) for bore in FLAT]
                self.plane[pair, which] = CubicSpline(np.log(FLAT), found)
        self.made, self.anchor = {}, {}
        scene = gf.load_scene(SCENE).pairs["sun_planet"].pair
        bores = [gear.r_bore / gear.r_f for gear in (scene.gear_1, scene.gear_2)]
        base = replace(SCENE_READING, sun=bores[0], planet=bores[1])
        for row in csv.DictReader((TABLES / f"{SCENE}.csv").read_text(encoding="utf-8").splitlines()):
            if row["method"] == "ritz3d":
                case = None if row["case"] == "healthy" else row["case"]
                full = float(row["mean [N/m]"])
                self.anchor[row["pair"], case] = full / self.stiffness(base, row["pair"], case, anchored=False).mean()

    def _node(self, group, pair, bores, length):
        if not length:
            group = nodes.healthy(group)
        return 1 / self.known[f"{group} {pair} {' '.join(map(str, bores))} {length}"]

    def _flat(self, pair, bores, half):
        at = np.log(bores)
        return sum(self.plane[pair, which](x) for which, x in enumerate(at)) * GROUPS[0][2] / half

    def _crack(self, group, pair, bores):
        """Compliance beyond that of the plane section, as a function of the crack's length [chords]."""
        key = group, pair, bores
        if key not in self.made:
            found = np.array([self._node(group, pair, bores, t) for t in LENGTHS])
            there = np.isfinite(found).all(axis=1)
            t, found = np.array(LENGTHS)[there], found[there]
            powers = np.linalg.solve(t[1:, None] ** np.arange(2, 1 + t.size), found[1:] - found[0])
            self.made[key] = t[-1], found[0] - self._flat(pair, bores, GROUPS[group][2]), powers
        longest, start, powers = self.made[key]
        return lambda t: start + sum(t ** (2 + i) * row for i, row in enumerate(powers)) if t <= longest else np.nan * start

    def stiffness(self, reading, pair, case, *, anchored=True):
        """K ``(PHASES,)`` [N/m]."""
        bores, half = reading.bores(pair), GROUPS[reading.group][2]
        t = LEVELS[case[-1]][0] * reading.length if case else 0.0
        corners = BORES[pair]
        parts = [self._crack(reading.group, pair, corner)(t) for corner in corners]
        low, high = np.log(corners[0][0]), np.log(corners[1][0])
        away = [(math.log(bore) - low) / (high - low) for bore in bores]
        rest = parts[0] + sum(x * (part - parts[0]) for x, part in zip(away, parts[1:], strict=True))
        k = self.factor(reading, pair, case) / (self._flat(pair, bores, half) + rest)
        return self.anchor[pair, case] * k if anchored else k

    def factor(self, reading, pair, case):
        """What load, root, rim and pits change, each as measured alone."""
        low, high = (math.log(self._varied(name, pair, case)) for name in ("a quarter of the load", "four times the load"))
        x = reading.load
        log = x * (high - low) / 4 + x**2 * (high + low) / 8
        base = self._single(pair, "as in the scene")
        log += (0.38 - reading.tip) / 0.18 * math.log(self._single(pair, "tip radius 0.2") / base)
        if pair == "planet_ring":
            name, reach = ("rim 80 mm", -7.0) if reading.rim < 87 else ("rim 95 mm", 8.0)
            log += (reading.rim - 87) / reach * math.log(self._single(pair, name) / base)
        return math.exp(log) * (self.pits(reading, pair, case) if case else 1.0)

    def _single(self, pair, what):
        return self.known[f"single {pair} {what}"].mean()

    def _varied(self, what, pair, case, column="ritz3d"):
        case = case or "healthy"
        return self.factors[what, pair, case, column] / self.factors["as in the scene", pair, case, column]

    def pits(self, reading, pair, case):
        """Factor of the pits on `ritz3d`."""
        what = LEVELS[case[-1]][1]
        length = nodes.PITS[what][0]
        bare = 1 / self._node(0, pair, BORES[pair][0], length)
        factor = self.known[f"pits {pair} {what}"].mean() / bare.mean()
        return (factor * self.varied_pits(reading, pair, case, "ritz3d")) ** (GROUPS[0][2] / GROUPS[reading.group][2])

    def varied_pits(self, reading, pair, case, column):
        """Factor of other pits than those of the scene."""
        near = "tip" if reading.shift > 0 else "root"
        log = (reading.radius - 0.5) / 0.5 * math.log(self._varied("pits of 2 mm diameter", pair, case, column))
        log += (reading.depth - 0.2) / 0.3 * math.log(self._varied("pits 0.5 mm deep", pair, case, column))
        return math.exp(
            log + abs(reading.shift) / 0.6 * math.log(self._varied(f"pits 0.6 mm nearer the {near}", pair, case, column))
        )


class Closed:
    """`published` or `textbook` of a pair of a group for any bores and crack length; pits left out.

    The plain sum of `gearfe.energy.closed.plain_sum`, with the beams at its stations kept, which no bore changes.
    """

    def __init__(self, formulas, pair, group):
        chosen = gf.load_scene(SCENE).pairs[pair]
        angle, start, half = GROUPS[group]
        self.formulas, self.materials = formulas, chosen.materials
        self.bodies = lru_cache(maxsize=2)(self._bodies)
        self.pair = nodes.changed(chosen.pair, half=half)
        phase = nodes.cycle(self.pair, chosen.face)
        self.at = stations(self.pair, phase, ((), ()), faces(self.pair, chosen.face, 0.0))
        contact = published.contact if formulas is published else linear_hertz
        self.rest = contact(self.materials) + self._beams(self.pair.gear_2, 1, self.at.roll_2, ())
        own = self.at.order[self.at.column] == 0
        roll, back = np.unique(self.at.roll_1[own].round(9), return_inverse=True)
        whole, table = self._beams(self.pair.gear_1, 0, self.at.roll_1, ()), []
        for t in STEPS:
            damage = nodes.cracked(self.pair, t, angle, start)
            found = whole.copy()
            try:
                found[own] = self._beams(self.pair.gear_1, 0, roll, tuple(damage.get("pinion", ())))[back]
            except ValueError as error:
                if "leave nothing of the tooth" not in str(error):
                    raise
                break  # longer cracks leave no section at the tip: the formulas have no value
            table.append(found)
        self.longest = STEPS[len(table) - 1]
        foot = self.pair.gear_1
        self.foot = 2 * foot.r_b * math.sin(foot.base_half_angle) / nodes.chord(foot, start)  # the beam's, in chords
        self.tooth = PchipInterpolator(STEPS[: len(table)], np.array(table), extrapolate=False)

    def _beams(self, gear, which, roll, cracks):
        return self.formulas.components(gear, self.materials[which], roll, cracks=cracks, foundation="none").total

    def _bodies(self, bores, foundation):
        gears = zip((self.pair.gear_1, self.pair.gear_2), (*bores, None), strict=False)
        own = [gear if gear.internal else replace(gear, r_bore=bore * gear.r_f) for gear, bore in gears]
        case = zip(own, self.materials, (self.at.roll_1, self.at.roll_2), strict=True)
        return sum(self.formulas.body(*each, foundation=foundation)[0] for each in case)

    def stiffness(self, bores, length, foundation):
        """K ``(PHASES,)`` [N/m]; nan for cracks that leave no section of the tooth's tip."""
        if length > self.longest:
            return np.full(PHASES, np.nan)
        each = self.at.weight / (self.tooth(length) + self.rest + self.bodies(bores, foundation))
        return 1e3 * self.pair.gear_1.b * np.bincount(self.at.phase, each, minlength=PHASES)


@lru_cache(maxsize=64)
def closed(name, pair, group):
    """`Closed`, kept."""
    return Closed({"published": published, "textbook": textbook}[name], pair, group)


@lru_cache(maxsize=64)
def closed_pits(pair, case, foundation):
    """Factor of S4's pits on `published` in a case, with the crack of the node that `ritz3d` has its own at."""
    chosen, (length, *pits) = gf.load_scene(SCENE).pairs[pair], nodes.PITS[LEVELS[case[-1]][1]]
    own = nodes.changed(chosen.pair, bores=BORES["sun_planet"][0])
    crack = nodes.cracked(own, length, *GROUPS[0][:2])["pinion"]
    run = {"phases": nodes.cycle(own, chosen.face), "face": chosen.face, "variants": {"foundation": foundation}}
    k = [
        gf.mesh_stiffness(own, chosen.force, chosen.materials, method="published", damage={"pinion": found}, **run).k.mean()
        for found in ([*crack, *nodes.with_pits(own, *pits)], crack)
    ]
    return k[0] / k[1]


def closed_curve(ritz, reading, pair, case, foundation):
    """`published` of a reading with its pits, ``(PHASES,)`` [N/m]."""
    t = LEVELS[case[-1]][0] * reading.length if case else 0.0
    own = closed("published", pair, reading.group)
    k = own.stiffness(reading.bores(pair), t * own.foot if reading.own else t, foundation)
    if not case:
        return k
    factor = closed_pits(pair, case, foundation) * ritz.varied_pits(reading, pair, case, "published")
    return k * factor ** (GROUPS[0][2] / GROUPS[reading.group][2])


@lru_cache(maxsize=1)
def rows():
    """(pair, case or None) of the ten rows."""
    return tuple(printed_cases(gf.load_scene(SCENE)))


def curves(ritz, reading):
    """Stiffness ``(PHASES,)`` [N/m] by (pair, case, kind): `ritz3d`, `published` in both `READINGS`; healthy `textbook` too."""
    out = {}
    for pair, case in rows():
        out[pair, case, "ritz3d"] = ritz.stiffness(reading, pair, case)
        for foundation in READINGS:
            out[pair, case, foundation] = closed_curve(ritz, reading, pair, case, foundation)
        if case is None:
            out[pair, case, "textbook"] = closed("textbook", pair, reading.group).stiffness(reading.bores(pair), 0.0, "external")
    return out


@lru_cache(maxsize=32)
def most_pairs(name, group):
    """Phases ``(PHASES,)`` at which as many tooth pairs as ever in the cycle are in contact; at the others it is one less."""
    chosen = gf.load_scene(SCENE).pairs[name]
    pair = nodes.changed(chosen.pair, half=GROUPS[group][2])
    length = pair.eps_alpha + overlap(pair, chosen.face, 0.0)
    behind = nodes.cycle(pair, chosen.face)[:, None] + np.arange(-math.ceil(length), math.ceil(length) + 1)
    count = ((behind >= 0) & (behind < length)).sum(axis=1)
    return count == count.max()


def numbers(found, group):
    """Columns of a reading: by row and kind mean and maximum [GN/m], largest drop [%], errors by zone and of the worst phase [%].

    Of `external` only those of planet and ring, since sun and planet have no other foundation in it.
    """
    out = {}
    for (pair, case, kind), k in found.items():
        row = f"{pair} {case or 'healthy'} {kind}"
        if kind != "external" or pair == "planet_ring":
            out[f"{row} mean"], out[f"{row} max"] = k.mean() / 1e9, k.max() / 1e9
            if case and kind != "external":
                out[f"{row} drop"] = 100 * float((1 - k / found[pair, None, kind]).max())
        if kind == "printed":
            truth, most = found[pair, case, "ritz3d"], most_pairs(pair, group)
            out[f"{row} phase"] = 100 * float(np.abs(k / truth - 1).max())
            for zone, part in (("most", most), ("fewest", ~most)):
                out[f"{row} {zone}"] = 100 * float(k[part].mean() / truth[part].mean() - 1) if part.any() else math.nan
    return out


def direct(reading):
    """`ritz3d` of a reading solved for just its gears, damage and load, as coarse as the nodes: mean [N/m] by row."""
    scene, out = gf.load_scene(SCENE), {}
    angle, start, half = GROUPS[reading.group]
    for name, case in rows():
        chosen = scene.pairs[name]
        pair = nodes.changed(chosen.pair, bores=reading.bores(name), half=half, tip=reading.tip, rim=reading.rim)
        damage = {}
        if case:
            level, what = LEVELS[case[-1]]
            damage = nodes.cracked(pair, level * reading.length, angle, start)
            _, count, lines = nodes.PITS[what]
            pits = nodes.with_pits(pair, count, lines)
            own = {"axes": (reading.radius,) * 2, "depth": reading.depth}
            damage["pinion"] += [gf.Pit(pit.radius + reading.shift, pit.z, **own) for pit in pits]
        out[name, case] = nodes.coarse(chosen, pair, damage, load=2.0**reading.load * half / GROUPS[0][2]).mean()
    return out


def table(name):
    """Path of a table of the scan."""
    return TABLES / f"{NAME}{name}.csv"


def load(name=""):
    """Rows of a table of the scan as dicts of text; none if it is not there."""
    if not table(name).exists():
        return []
    with table(name).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def compute():
    """Every reading whose group is known, from the nodes; returns the table's rows as dicts of numbers."""
    ritz = Ritz3D()
    groups, found = known_groups(ritz.known), []
    started = time.process_time()
    for number, reading in enumerate(readings()):
        if reading.group in groups:
            own = {key: getattr(reading, key) for key in Reading.__slots__}
            found.append({"number": number, **own, **numbers(curves(ritz, reading), reading.group)})
    seconds = time.process_time() - started
    with table("").open("w", encoding="utf-8", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(found[0])
        out.writerows([f"{v:.4g}" if isinstance(v, float) else v for v in row.values()] for row in found)
    with table("_run").open("w", encoding="utf-8", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["readings", "groups", "seconds of nodes", "seconds of readings", "machine"])
        out.writerow([len(found), len(groups), f"{ritz.seconds:.0f}", f"{seconds:.0f}", machine.describe()])


def check(wanted):
    """Solve readings directly, by their numbers, those not yet in the table of checks; each is kept at once."""
    known = {int(row["number"]) for row in load("_checks")}
    header = ["number", *(f"{pair} {case or 'healthy'}" for pair, case in rows()), "seconds"]
    for number in [number for number in wanted if number not in known]:
        started = time.process_time()
        found = direct(readings()[number])
        values = [f"{found[key] / 1e9:.5g}" for key in rows()]
        nodes.keep(table("_checks"), header, [number, *values, f"{time.process_time() - started:.2f}"])
        print(f"reading {number} solved directly: {time.process_time() - started:.1f} s", flush=True)

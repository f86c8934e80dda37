"""Article S4's ten rows under every reading of what it does not print: a space-filling scan, and which readings bear its claim.

`ritz3d` of a reading is read from the nodes of `herringbone_scan_nodes` (its compliance less that of the plane section is linear
in the logarithms of the bores; the crack's part a polynomial of its length; load, rim, root and pits as factors, measured one at
a time); `check` computes readings directly. The closed forms are evaluated for every reading, their pits as the same factors.
"""

import csv
import math
import time
from dataclasses import replace
from functools import lru_cache

import numpy as np
from scipy.interpolate import CubicSpline

import gearfe as gf
from gearfe.comparison.case_table import printed_cases
from gearfe.core.case import overlap

from . import herringbone_scan_nodes as nodes
from .herringbone_scan_closed import LEVELS, closed, closed_curve
from .herringbone_scan_nodes import BORES, FLAT, GROUPS, LENGTHS, PAIRS, SCENE
from .herringbone_scan_readings import RANGES, SCENE_READING, SIZE, Reading, readings  # noqa: F401
from .places import TABLES

NAME = "herringbone_scan"
READINGS = ("printed", "external")  # foundation of the ring in `published`


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
    for number, reading in enumerate(readings()):
        if reading.group in groups:
            own = {key: getattr(reading, key) for key in Reading.__slots__}
            found.append({"number": number, **own, **numbers(curves(ritz, reading), reading.group)})
    with table("").open("w", encoding="utf-8", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(found[0])
        out.writerows([f"{v:.4g}" if isinstance(v, float) else v for v in row.values()] for row in found)


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

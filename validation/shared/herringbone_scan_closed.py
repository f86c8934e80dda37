"""The closed forms of every reading of S4, evaluated with beams kept that no bore changes, their pits as factors."""

import math
from dataclasses import replace
from functools import lru_cache

import numpy as np
from scipy.interpolate import PchipInterpolator

import gearfe as gf
from gearfe.flexibility.energy.closed import published, textbook
from gearfe.flexibility.energy.closed.section import ToothDamage
from gearfe.flexibility.energy.closed.slices import stations
from gearfe.flexibility.hertz import linear_hertz

from . import herringbone_scan_nodes as nodes
from .herringbone_scan_nodes import BORES, GROUPS, PHASES, SCENE

# crack lengths of the closed forms [chords]
STEPS = (0.0, 0.03, 0.06, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9)
LEVELS = {"1": (0.1, "3 pits"), "2": (0.3, "7 pits"), "3": (0.6, "7 pits, deep crack"), "4": (0.3, "14 pits")}


class Closed:
    """`published` or `textbook` of a pair of a group for any bores and crack length; pits left out.

    The plain sum of `gearfe.flexibility.energy.closed.plain_sum`, with the beams at its stations kept, which no bore changes.
    """

    def __init__(self, formulas, pair, group):
        chosen = gf.load_scene(SCENE).pairs[pair]
        angle, start, half = GROUPS[group]
        self.formulas, self.materials = formulas, chosen.materials
        self.bodies = lru_cache(maxsize=2)(self._bodies)
        self.pair = nodes.changed(chosen.pair, half=half)
        phase = nodes.cycle(self.pair, chosen.face)
        self.at = stations(gf.Case(self.pair, 1.0, self.materials, face=chosen.face), phase)
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
                if "nothing of the tooth" not in str(error):
                    raise
                break  # longer cracks leave no section at the tip: the formulas have no value
            table.append(found)
        self.longest = STEPS[len(table) - 1]
        foot = self.pair.gear_1
        self.foot = 2 * foot.r_b * math.sin(foot.base_half_angle) / nodes.chord(foot, start)  # the beam's, in chords
        self.tooth = PchipInterpolator(STEPS[: len(table)], np.array(table), extrapolate=False)

    def _beams(self, gear, which, roll, cracks):
        return self.formulas.components(gear, self.materials[which], roll, damage=ToothDamage(cracks), foundation="none").total

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

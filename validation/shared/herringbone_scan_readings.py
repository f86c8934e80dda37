"""The readings of article S4: what it does not print, drawn to fill the space of what may be meant."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.stats import qmc

from .herringbone_scan_nodes import GROUPS

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


SCENE_READING = Reading(0, math.sqrt(2), 0.5, 0.5, 0.0, 0.38, 87.0, 0.5, 0.2, 0.0, 1)  # the scene's; bores to 0.4 %

"""A part of the page `speed`: where the time of a new pair goes, stage by stage, beside what the processor could do."""

import importlib
import math
import sys
import time

import numpy as np

import gearfe as gf

from ..shared.speed_page import stages

PAIRS = 15  # new pairs of a section
SIZES = (64, 128, 256, 1024)  # of the square matrices whose products tell what the processor can do
SHAPES = {  # floating point operations of a routine by its arguments
    "dpotrf": lambda a, **_: len(a) ** 3 / 3,
    "dtrsm": lambda _, a, b, side=0, **__: b.size * len(a),
    "dsyrk": lambda _, a, trans=0, **__: a.size * a.shape[1 if trans else 0],
    "_eliminated": lambda ids, _, stop: _elimination(int(ids.searchsorted(stop)), len(ids)),
}
SECTION = (
    ("do the gears interfere?", "gearfe.geometry.pair.interference", "overlap"),
    ("gmsh", "gearfe.geometry.mesh.mesher", "triangulate"),
    ("drawing the sector", "gearfe.geometry.mesh.sector", "sector"),
    ("matrices of the triangles", "gearfe.flexibility.energy.ritz.panel", "_local"),
    ("loads on the flank", "gearfe.flexibility.energy.ritz.panel", "_loads"),
    ("condensing: elimination", "gearfe.flexibility.condense", "_eliminated"),
    ("condensing: the rest", "gearfe.flexibility.condense", "condense"),
    ("joining the sectors", "gearfe.flexibility.energy.ritz.join", "join"),
    ("the rest of a gear", "gearfe.flexibility.energy.ritz.plane", "flexibility"),
    ("which teeth touch where", "gearfe.geometry.pair.modified", "flank_contacts"),
    ("flexibility along the contacts", "gearfe.contact.rows", "corner_rows"),
    ("sharing the load", "gearfe.contact.sharing", "line_contacts"),
    ("the rest", "gearfe.stiffness.solve", "mesh_stiffness"),
)
SOLID = (
    ("order of elimination", "gearfe.flexibility.energy.ritz.dissection", "dissect"),
    ("matrices of the triangles", "gearfe.flexibility.energy.ritz.leaf", "leaf"),
    ("elimination: Cholesky", "gearfe.flexibility.energy.ritz.elimination", "dpotrf"),
    ("elimination: division", "gearfe.flexibility.energy.ritz.elimination", "dtrsm"),
    ("elimination: products", "gearfe.flexibility.energy.ritz.elimination", "dsyrk"),
    ("elimination: moving numbers", "gearfe.flexibility.energy.ritz.elimination", "front"),
    ("joining: Cholesky", "gearfe.flexibility.energy.ritz.join", "dpotrf"),
    ("joining: division", "gearfe.flexibility.energy.ritz.join", "dtrsm"),
    ("joining: products", "gearfe.flexibility.energy.ritz.join", "dsyrk"),
    ("joining: moving numbers", "gearfe.flexibility.energy.ritz.join", "join"),
    ("the rest of a gear", "gearfe.flexibility.energy.ritz.solid", "flexibility3d"),
    ("cells along the contact", "gearfe.contact.cells", "cells_of"),
    ("flexibility between cells", "gearfe.contact.bodies", "between"),
    ("the rest: sharing the load", "gearfe.stiffness.solve", "mesh_stiffness"),
)


def _elimination(gone, count):
    """Operations of eliminating so many of a number of unknowns: factor, division, product."""
    left = count - gone
    return gone**3 / 3 + gone**2 * left + gone * left**2


class Clock:
    """Processor seconds and floating point operations of stages, each without those that it calls."""

    def __init__(self, wanted):
        """Put a clock around every function of `wanted`: label, module and name; where it was imported to, too."""
        self.seconds, self.work = (dict.fromkeys([label for label, *_ in wanted], 0.0) for _ in range(2))
        self._inside, self._before = [], []
        for label, place, name in wanted:
            module = importlib.import_module(place)
            function = getattr(module, name)
            routine = name in SHAPES  # in this module alone
            loaded = [one for key, one in sys.modules.items() if key.partition(".")[0] in ("gearfe", "geometry")]
            for other in [module] if routine else loaded:
                for key in [key for key, value in vars(other).items() if value is function]:
                    self._before.append((other, key, function))
                    setattr(other, key, self._timed(label, function, SHAPES.get(name)))

    def _timed(self, label, function, operations):
        def timed(*given, **named):
            started = time.process_time()
            self._inside.append(0.0)
            try:
                return function(*given, **named)
            finally:
                taken = time.process_time() - started
                self.seconds[label] += taken - self._inside.pop()
                if self._inside:
                    self._inside[-1] += taken
                if operations:
                    self.work[label] += operations(*given, **named)

        return timed

    def stop(self):
        """Take the clocks away."""
        for module, key, function in reversed(self._before):
            setattr(module, key, function)

    def rows(self, runs):
        """``[label, seconds, floating point operations]`` of one run."""
        return [[label, seconds / runs, self.work[label] / runs] for label, seconds in self.seconds.items()]


def new_pairs(cracked):
    """Work: new pairs of sections, 64 phases each, no gear of which was solved before."""
    steel, rack = gf.Material(E=207e3, nu=0.25), {"m_n": 2.0, "alpha_n": math.radians(20), "b": 20.0}
    damage = {"pinion": [gf.Crack(level=0.4)]} if cracked else None

    def work():
        for i in range(PAIRS):
            one, two = (gf.Gear(z=z, r_bore=0.35 * z, **rack) for z in (18 + i, 40 + i))
            gf.mesh_stiffness(gf.GearPair(one, two), 2000.0, steel, damage=damage, cache=False)

    return work


def solid(scene, name, case, phases):
    """Work: a pair of a scene by `ritz3d`."""
    given = gf.load_scene(scene).pair(name).case(case)
    return lambda: gf.mesh_stiffness(given, phases=phases, method="ritz3d", cache=False)


def measured():
    """Billions of operations a second of products of square matrices, and the rows of every problem."""
    problems = {
        f"{PAIRS} new pairs of sections, each": (new_pairs(False), SECTION, PAIRS),
        f"{PAIRS} new pairs of sections, a pinion cracked, each": (new_pairs(True), SECTION, PAIRS),
        "helical_pitting, healthy, 64 phases": (solid("helical_pitting", "pinion_wheel", None, 64), SOLID, 1),
        "herringbone, case 4, 16 phases": (solid("herringbone", "sun_planet", "case4", 16), SOLID, 1),
    }
    found = {}
    for name, (work, wanted, runs) in problems.items():
        work()
        clock = Clock(wanted)
        try:
            work()
        finally:
            clock.stop()
        found[name] = clock.rows(runs)
    return {"speed": {str(size): products(size) for size in SIZES}, "problems": found}


def products(size):
    """Billions of operations a second of the product of two matrices of a size, the best of some."""
    one = np.random.default_rng(0).random((size, size))
    count, best = max(2, int(3e8 / size**3)), math.inf
    for _ in range(5):
        started = time.process_time()
        for _ in range(count):
            one @ one
        best = min(best, (time.process_time() - started) / count)
    return 2 * size**3 / best / 1e9


def text(found):
    """Lines of the page."""
    speeds = ", ".join(f"{value:.0f} ({size})" for size, value in found["speed"].items())
    most = max(found["speed"].values())
    slow = [
        f"{label} of {name}"
        for name, rows in found["problems"].items()
        for label, seconds, work in rows
        if 0 < work < 0.3e9 * most * seconds
    ]
    return [
        "## Where the time goes",
        "",
        "Processor seconds of each stage without those that it calls, one run after a first one; floating point operations are",
        f"those of LAPACK and BLAS, and of condensing a section. Products of square matrices: {speeds} billion a second (rows).",
        "The limit of a problem is what its operations would take at the fastest of these. Stages without a number move and make",
        f"small arrays. Routines that do less than 30 % of the fastest: {'; '.join(slow) or 'none'}. "
        "On small matrices the product",
        "itself is slower.",
        *(line for name, rows in found["problems"].items() for line in ("", *stages(name, rows, most))),
    ]

"""Article S4's finite element column under every layout of its pits: a sample of unprinted values, and a fit for each layout.

What is sampled, fitted and counted is fixed here, and was committed before the first run. A reading is five unprinted values
(`RANGES`) and one of `LAYOUTS`. Its ten stiffnesses are `ritz3d`'s, coarse (`COARSE`), at the phase of the mesh cycle at which
case 4 takes most (of `OFFSETS` from the phase at which the middle of a half touches at the pitch point), since S4's list of
'maximum reduction rates' is 1 - k / k_healthy of its table. S4 'constrains the driven gear and applies rotation to the driving
gear': at the same rotation a damaged gear carries less, ``k / k0 -> (k / k0)**p`` with p the logarithmic slope of the healthy
pair's load over its approach.
"""

import time
from dataclasses import replace
from functools import cache
from itertools import product

import numpy as np
from scipy.optimize import least_squares
from scipy.stats import qmc

import gearfe as gf
from gearfe.core.case import by_gear, overlap
from gearfe.flexibility.solved import SolvedGears
from gearfe.geometry.damage.pit import pit_row
from gearfe.geometry.pair.pit_lines import in_both_halves, pit_line

from .places import TABLES
from .solid_pair import solid_contact
from .table_rows import append, rows_of

SCENE, PAIRS = "herringbone", ("sun_planet", "planet_ring")
PATH = TABLES / "herringbone_layouts.csv"
SIZE, SEED = 64, 31
RANGES = {
    "sun": (0.30, 0.90),  # bore, part of the root radius
    "planet": (0.30, 0.85),
    "rim": (80.0, 95.0),  # outer radius of the ring, held [mm]
    "crack": (0.35, 1.0),  # level of the crack over the printed percentage; 1: 50 % reach the centre-line, 0.71: of the chord
    "pit": (0.3, 1.0),  # radius [mm]; S4 prints a diameter of 1 mm for its test gears, none for its models
}
LAYOUTS = {  # (along, touching or spread over 24 mm, rows in case 4, both halves, mirrored)
    "axis, spread, one half": ("axis", False, 2, False, False),
    "axis, spread, both halves": ("axis", False, 2, True, False),
    "axis, touching, one half": ("axis", True, 1, False, False),
    "axis, touching, both halves": ("axis", True, 1, True, False),
    "contact line, one half": ("contact_line", True, 1, False, False),
    "contact line, both halves": ("contact_line", True, 1, True, False),
    "contact line, two in case 4, both halves": ("contact_line", True, 2, True, False),
    "contact line of the other hand, both halves": ("contact_line", True, 1, True, True),
}  # a column up the profile holds four pits of 1 mm at most, where S4 has 14
CASES = {"case1": (0.1, 3), "case2": (0.3, 7), "case3": (0.6, 7), "case4": (0.3, 14)}  # printed: crack, pits
OFFSETS = np.array([-0.25, -0.06, 0.0, 0.06, 0.25])  # base pitches
COARSE = {"order": 2, "refine": 0.7, "step": 1.5, "axial": 8}  # of the energy model
FORMULAS = {  # `published` at the bores of the layout that fits best: variants, levels over the printed ones, pits' radii [mm]
    "lost": ("hertz", "summed"),
    "root": ("prism", "base"),
    "foot": ("root", "base"),
    "crack": (0.35, 0.5, 0.71, 1.0),
    "pit": (0.4, 0.5, 0.63, 0.8),
}
FITS = 3  # steps of the fit for each layout, each with five derivatives
START = {"diff_step": 0.02, "max_nfev": FITS, "x_scale": [high - low for low, high in RANGES.values()]}
CLAIM, POINTS = 3.0, 2.0  # S4's 'below 3 %'; reductions [percentage points]
ROWS = [(pair, case) for pair in PAIRS for case in (None, *CASES)]
HEADER = [
    "stage",
    "layout",
    *RANGES,
    *(f"{pair} {case or 'healthy'}" for pair, case in ROWS),
    "phase sun",
    "phase ring",
    "seconds",
]


def readings():
    """Sample ``(SIZE, 5)`` of the values of `RANGES`."""
    points = qmc.Sobol(len(RANGES), seed=SEED).random(SIZE)
    return qmc.scale(points, *np.array(list(RANGES.values())).T)


def pits(pair, layout, count, radius):
    """Pits of a layout on the pinion, about the pitch point in the middle of a half; two rows are 0.8 mm apart in radius."""
    along, touching, rows, both, mirrored = LAYOUTS[layout]
    run, out = {"axes": (radius, radius), "depth": 0.2}, []
    rows = rows if count == 14 else 1
    for middle in pair.pitch_radius_1 + (np.array([-0.4, 0.4]) if rows == 2 else np.zeros(1)):
        if touching:
            options = {"middle": pair.gear_1.b / 4, "face": "herringbone", "mirrored": mirrored}
            found = pit_line(pair, 0, along, count // rows, 2 * radius, radius=float(middle), **options, **run)
        else:
            found = pit_row(count // rows, 3.0, 27.0, radius=float(middle), **run)
        out += found + (in_both_halves(pair.gear_1, found, "herringbone") if both else [])
    return out


def changed(pair, bores, rim):
    """The scene's pair with other bores of the external gears, parts of the root radius, and another rim of the ring."""
    bores = iter(bores)
    gears = (replace(g, r_rim=rim) if g.internal else replace(g, r_bore=g.r_f * next(bores)) for g in (pair.gear_1, pair.gear_2))
    return gf.GearPair(*gears, pair.a)


class Model:
    """`ritz3d` of the gears of a reading, whose bodies all layouts share."""

    def __init__(self, values, **numeric):
        self.values = dict(zip(RANGES, values, strict=True))
        self.kept, self.numeric = SolvedGears(), numeric or COARSE

    def pair(self, name):
        """The scene's pair, and the one with the bores and the rim of the reading."""
        chosen = gf.load_scene(SCENE).pairs[name]
        bores = [self.values[key] for key in (("sun", "planet") if name == "sun_planet" else ("planet",))]
        return chosen, changed(chosen.pair, bores, self.values["rim"])

    def middle(self, name):
        """Phase at which the middle of a half touches at the pitch point."""
        chosen, pair = self.pair(name)
        return pair.pitch_phase + overlap(pair, chosen.face, 0.0) / 2

    def damage(self, pair, layout, case):
        """Crack and pits of a case."""
        printed, count = CASES[case]
        return [gf.Crack(level=printed * self.values["crack"]), *pits(pair, layout, count, self.values["pit"])]

    def case(self, name, layout):
        """K ``(5, phases)`` [N/m] of the healthy pair and the four cases."""
        chosen, pair = self.pair(name)
        phase = self.middle(name) + OFFSETS
        run = {"face": chosen.face, "cache": self.kept, **self.numeric}
        forces = [chosen.force, 0.8 * chosen.force]
        whole, less = solid_contact(pair, forces, chosen.materials, phase, **run)
        power = np.log(0.8) / np.log(0.8 * whole.k / less.k)
        out = [whole.k]
        for case in CASES:
            cracks, own = by_gear(pair, {"pinion": self.damage(pair, layout, case)})
            k = solid_contact(pair, chosen.force, chosen.materials, phase, cracks=cracks, pits=own, **run).k
            out.append(whole.k * (k / whole.k) ** power)
        return np.array(out)

    def row(self, layout):
        """Ten stiffnesses [N/um] and, of both pairs, from how far off the pitch point they are; nan where a case cannot be."""
        out, where = [], []
        for name in PAIRS:
            try:
                k = self.case(name, layout)
            except ValueError as error:  # the crack cuts the body, or the row is longer than the flank
                if not any(words in str(error) for words in ("crack of ", "leaves the flank", "pit at ", "pit of ")):
                    raise
                k = np.full((1 + len(CASES), OFFSETS.size), np.nan)
            most = int(np.nanargmax(1 - k[4] / k[0])) if np.isfinite(k).all() else 0
            out += (k[:, most] / 1e6).tolist()
            where.append(float(OFFSETS[most]))
        return np.array(out), where


@cache
def _references():
    return {one.id: one for one in gf.load_scene(SCENE).references}


def printed():
    """S4's finite element column, after the stated correction of its swapped rows [N/um]."""
    rows = _references()["stiffness_fe"].rows
    return np.array([(row.value if row.corrected is None else row.corrected) / 1e6 for row in rows])


def reductions(k):
    """Reductions ``(..., 8)`` [%] of ten stiffnesses ``(..., 10)``."""
    k = np.asarray(k).reshape(*np.shape(k)[:-1], 2, 5)
    return 100 * (1 - k[..., 1:] / k[..., :1]).reshape(*k.shape[:-2], 8)


def keep(row):
    """Append a row to the table."""
    append(PATH, HEADER, [f"{v:.5g}" if isinstance(v, float) else v for v in row])


def load():
    """Rows of the table as dicts of text; none if it is not there."""
    return rows_of(PATH)


def errors(rows):
    """Worst of ten stiffnesses [%], of eight reductions beside the finite elements' own and beside the printed list [points]."""
    k = np.array([[float(row[f"{pair} {case or 'healthy'}"]) for pair, case in ROWS] for row in rows])
    list_of = np.array([row.value for row in _references()["stiffness_reduction"].rows])
    own = reductions(k)
    worst = [np.abs(own - wanted).max(axis=1) for wanted in (reductions(printed()), list_of)]
    return np.abs(100 * (k / printed() - 1)).max(axis=1), *worst


def sample():
    """Every reading of the sample in every layout, those not yet in the table; each is kept at once."""
    done = sum(row["stage"] == "sample" for row in load()) // len(LAYOUTS)
    for number, values in enumerate(readings()):
        if number >= done:
            model = Model(values)
            for layout in LAYOUTS:
                started = time.process_time()
                k, where = model.row(layout)
                keep(["sample", layout, *values.tolist(), *k.tolist(), *where, time.process_time() - started])


def fit(layout):
    """Fit the five values to the ten logarithms of the finite element column, from the best reading of the sample."""
    rows = [row for row in load() if row["stage"] == "sample" and row["layout"] == layout]
    worst = errors(rows)[0]
    if not np.isfinite(worst).any():
        return
    best, started = rows[int(np.nanargmin(worst))], time.process_time()

    def away(values):
        k = Model(values).row(layout)[0]
        return np.where(np.isfinite(k), np.log(k / printed()), 1.0)

    low, high = np.array(list(RANGES.values())).T
    begin = np.clip([float(best[name]) for name in RANGES], low * (1 + 1e-6), high * (1 - 1e-6))
    found = least_squares(away, begin, bounds=(low, high), **START).x
    k, where = Model(found).row(layout)
    keep(["fit", layout, *found.tolist(), *k.tolist(), *where, time.process_time() - started])


def formulas():
    """`published` in every combination of `FORMULAS`, at bores, layout and phase of the best fit, those not yet in the table."""
    best = best_fit()
    done = sum(row["stage"] == "formulas" for row in load())
    for lost, root, foot, crack, pit in list(product(*FORMULAS.values()))[done:]:
        model, out, started = Model([float(best[name]) for name in RANGES]), [], time.process_time()
        model.values |= {"crack": crack, "pit": pit}
        for name in PAIRS:
            chosen, pair = model.pair(name)
            phase = model.middle(name) + float(best["phase sun" if name == "sun_planet" else "phase ring"])
            variants = {"lost": lost, "root": root, "foot": foot} | ({"foundation": "printed"} if pair.gear_2.internal else {})
            run = {"force": chosen.force, "material": chosen.materials, "face": chosen.face, "phases": np.array([phase])}
            for case in (None, *CASES):
                damage = {"pinion": model.damage(pair, best["layout"], case)} if case else None
                k = gf.mesh_stiffness(pair, **run, method="published", variants=variants, damage=damage).k
                out.append(float(k[0]) / 1e6)
        where = [float(best[name]) for name in ("phase sun", "phase ring")]
        what = f"{lost}, {root}, {foot}"
        keep(["formulas", what, *model.values.values(), *out, *where, time.process_time() - started])


def best_fit():
    """The row of the fit whose worst of ten stiffnesses is nearest."""
    rows = [row for row in load() if row["stage"] == "fit"]
    return rows[int(np.nanargmin(errors(rows)[0]))]


def compute():
    """Sample, fit every layout, then the formulas; continues where the table ends."""
    sample()
    done = {row["layout"] for row in load() if row["stage"] == "fit"}
    for layout in LAYOUTS:
        if layout not in done:
            fit(layout)
    formulas()

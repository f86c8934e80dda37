"""The ten rows of scene `herringbone_contact_line`: by `ritz3d`, by the closed forms, and by `fe3d` where it was run."""

import time
from dataclasses import replace

import numpy as np

import gearfe as gf
from gearfe.core.case import overlap
from gearfe.scene.verdicts import judge, text
from gearfe.stiffness.methods import fitted

from .places import TABLES
from .table_rows import append, rows_of

SCENE = "herringbone_contact_line"
OFFSETS = (-0.25, -0.12, -0.09, -0.06, -0.03, 0.0, 0.03, 0.06, 0.09, 0.12, 0.25)  # base pitches from the pitch point
METHODS = {  # name: method, and its variants
    "ritz3d": ("ritz3d", {}),
    "herringbone_article": ("herringbone_article", {}),
    "herringbone_article, summed": ("herringbone_article", {"lost": "summed"}),
    "textbook": ("textbook", {}),
    "fe3d": ("fe3d", {}),
}
QUICK = tuple(name for name in METHODS if name != "fe3d")
REFINE = {"sun_planet": 0.8, "planet_ring": 0.65}  # options of `fe3d`, as in the scene herringbone
CLAIM, POINTS = 3.0, 2.0  # S4's 'below 3 %'; reductions [percentage points]
LESS = 0.8  # relative change of the load, for its effect on k
HEADER = ("method", "pair", "case", *(f"k at {one:+g} [N/um]" for one in OFFSETS), "power", "seconds")


def path(method):
    """Table of a method: finite elements have their own, which is not computed again with the others."""
    return TABLES / f"{SCENE}{'_fe3d' if method == 'fe3d' else ''}.csv"


def rows():
    """(pair, case) of the ten rows."""
    return [(row.pair, row.case) for row in gf.load_scene(SCENE).references[0].rows]


def stored():
    """Rows of the table by (method, pair, case): k ``(offsets,)`` under the same load [N/um], power, seconds."""
    found = [list(row.values()) for name in ("ritz3d", "fe3d") for row in rows_of(path(name))]
    return {tuple(row[:3]): (np.array(row[3:-2], dtype=float), *map(float, row[-2:])) for row in found}


def load():
    """K ``(offsets,)`` [N/um] by (method, pair, case) at the rotation of the healthy pair."""
    known, out = stored(), {}
    for (method, pair, case), (k, *_) in known.items():
        whole, power, _ = known[method, pair, "healthy"]
        out[method, pair, case] = whole * (k / whole) ** power
    return out


def compute(methods=QUICK):
    """Compute the rows that are not in the table; each is kept at once."""
    known = stored()
    for name, pair, case in [(name, *row) for name in methods for row in rows()]:
        if (name, pair, case) not in known:
            started = time.process_time()
            k, power = solved(name, pair, case)
            spent = time.process_time() - started
            append(path(name), HEADER, [name, pair, case, *(f"{v:.6g}" for v in (*k, power)), f"{spent:.2f}"])
            print(f"{name} {pair} {case}: {spent:.1f} s", flush=True)


def solved(name, pair, case):
    """Stiffness ``(offsets,)`` [N/um] of one of `METHODS`, and its exponent: k is proportional to ``F**(1 - 1 / exponent)``."""
    method, variants = METHODS[name]
    chosen = gf.load_scene(SCENE).pairs[pair]
    phase = chosen.pair.pitch_phase + overlap(chosen.pair, chosen.face, chosen.groove) / 2 + np.array(OFFSETS)
    loads = (chosen.force, LESS * chosen.force)
    known, needed, _ = fitted(method, replace(chosen.case(None if case == "healthy" else case), force=loads))
    refine = REFINE[pair] if method == "fe3d" else 1.0
    how = gf.Solve(method, phase, variants=(needed or {}) | (variants or {}), refine=refine)
    k, less = (one.k / 1e6 for one in gf.solve(known, how))
    return k, float((np.log(LESS) / np.log(LESS * k / less)).mean())


def ours(method, found=None):
    """Ten stiffnesses [N/um] at the phase at which case 4 of their pair takes most, and its offset by pair."""
    found, at, out = found or load(), {}, []
    for pair, last in (("sun_planet", "case4"), ("planet_ring", "planet4")):
        at[pair] = int(np.argmax(1 - found[method, pair, last] / found[method, pair, "healthy"]))
    out = [float(found[method, pair, case][at[pair]]) for pair, case in rows()]
    return np.array(out), {pair: OFFSETS[i] for pair, i in at.items()}


def printed():
    """S4's finite element column, after the stated correction of its swapped rows [N/um]."""
    found = next(one for one in gf.load_scene("herringbone").references if one.id == "stiffness_fe")
    return np.array([row.target / 1e6 for row in found.rows])


def reductions(k):
    """Reductions ``(..., 8)`` [%] of ten stiffnesses ``(..., 10)``."""
    k = np.asarray(k).reshape(*np.shape(k)[:-1], 2, 5)
    return 100 * (1 - k[..., 1:] / k[..., :1]).reshape(*k.shape[:-2], 8)


def verdicts(method):
    """Lines: printed numbers of the scene and those of a method."""
    k, references = ours(method)[0], [_by(one, method) for one in gf.load_scene(SCENE).references]
    lost = dict(zip([(case, pair) for pair, case in rows() if case != "healthy"], reductions(k), strict=True))
    values = {(case, pair): 1e6 * v for (pair, case), v in zip(rows(), k, strict=True)}
    made = [row for one in references for row in judge(one, values if one.id == "stiffness_fe" else lost)]
    return text(references, made)


def _by(reference, method):
    """Return a reference whose note has the method."""
    return replace(reference, note=reference.note.replace("`ritz3d`", f"`{method}`"))

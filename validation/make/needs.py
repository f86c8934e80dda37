"""The page `needs`: what gearfe uses of the gears of each built-in scene, and what all of them would cost and change."""

import time

import numpy as np

import gearfe as gf
from gearfe.core.units import in_newton_per_um
from gearfe.scene.load import scene_names

from ..shared import page
from ..shared.kept_rows import kept, stored

TABLE, PHASES = "needs", 16
NUMBERS = ("unknowns", "k", "wide_unknowns", "change", "largest", "section")
HOW = f"""
Each healthy pair is solved as the scene asks for it, and once more by `ritz3d` at full width, at {PHASES} phases of a cycle.
Both solve each gear from one sector, and load the teeth that can carry load at the same time. Change: mean k at full width less
mean k as used, and the largest change at a phase. Section: what the transverse section alone would change for pairs that need
their width. Seconds are CPU seconds without imports and without gears that are known. A damaged case solves its damaged gear
again and no other. The last two columns are the first damaged case of the pair: with its healthy gears known, and all anew.
`python -m validation needs` computes this page.
"""
FULL = """
Nothing in these scenes is solved by `fe3d` unless it is requested. Both whole gears with all teeth in hexahedra take
414 CPU s and 7.4 GB for the cracked and pitted herringbone pair of [speed.md](speed.md). They change k there by 0.17 % in
the mean.
"""


def pairs():
    """Scene and name of every pair of the built-in scenes."""
    return [(scene, name) for scene in scene_names() for name in gf.load_scene(scene).pairs]


def timed(case, method="auto", cache=False):
    """Stiffness curve and CPU seconds of a case."""
    started = time.process_time()
    curve = gf.solve(case, gf.Solve(method, PHASES, cache=cache))
    return curve, round(time.process_time() - started, 2)


def row(scene, name):
    """Numbers of a pair."""
    pair = gf.load_scene(scene).pairs[name]
    curve, seconds = timed(pair.case())
    wide, wide_seconds = timed(pair.case(), "ritz3d")
    section = timed(pair.case(), "ritz")[0] if curve.meta["method"] != "ritz" else curve
    change = wide.k / curve.k - 1
    out = {"method": curve.meta["method"], "why": curve.meta["why"], "seconds": [seconds, wide_seconds]}
    out |= {"unknowns": sum(curve.meta["dofs"]), "k": float(curve.k.mean()), "wide_unknowns": sum(wide.meta["dofs"])}
    out |= {"change": float(wide.k.mean() / curve.k.mean() - 1), "largest": float(np.abs(change).max())}
    out |= {"section": float(section.k.mean() / curve.k.mean() - 1)}
    if pair.damage:
        case = pair.case(next(iter(pair.damage)))
        timed(case.healthy, timed(case)[0].meta["method"], True)
        out |= {"case": next(iter(pair.damage)), "damaged": [timed(case, cache=True)[1], timed(case)[1]]}
    return out


def rows(again=False):
    """All rows; `again`: compute them again."""
    return {key: kept(TABLE, " ".join(key), lambda key=key: row(*key), again) for key in pairs()}


def cheap():
    """Rows on file with what computes them again."""
    for key in pairs():
        known = {name: stored(TABLE)[" ".join(key)][name] for name in NUMBERS}
        yield " ".join(key), known, lambda key=key: row(*key)


def run(again=True):
    """Write the page."""
    found = rows(again)
    plane = [one for one in found.values() if one["method"] == "ritz"]
    low, high = (100 * pick(abs(one["change"]) for one in plane) for pick in (min, max))
    dearer = np.median([one["seconds"][1] / one["seconds"][0] for one in plane])
    answer = (
        f"{len(plane)} of {len(found)} pairs of the scenes need their transverse section alone. Their full width would cost "
        f"{dearer:.0f} times as much and change the mean k by {low:.1f} to {high:.1f} %."
    )
    head = "| scene, pair | used | because | unknowns | s | k [N/um] | full width: unknowns | s | change | largest | section | "
    lines = [head + "damage, s | anew, s |", "|---" * 13 + "|"]
    lines += [_line(*key, one) for key, one in found.items()]
    page.write("needs", answer, lines, HOW, FULL)


def _line(scene, name, one):
    """Row of the table on the page."""
    wide = one["method"] != "ritz"
    percent = [f"{100 * one[key]:+.2f} %" for key in ("change", "largest")]
    changes = ["used", "used", f"{100 * one['section']:+.1f} %"] if wide else [*percent, "used"]
    damage = [f"{one['case']}: {one['damaged'][0]:.2g}", f"{one['damaged'][1]:.2g}"] if "case" in one else ["", ""]
    cells = [f"{scene}, {name}", one["method"], one["why"], f"{one['unknowns']:,}", f"{one['seconds'][0]:.2g}"]
    cells += [in_newton_per_um(one["k"]), f"{one['wide_unknowns']:,}", f"{one['seconds'][1]:.2g}", *changes, *damage]
    return f"| {' | '.join(map(str, cells))} |"

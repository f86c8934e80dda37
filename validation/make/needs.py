"""The page `needs`: what gearfe solves of the gears of each built-in scene, and what their full width would cost and change."""

import time

import numpy as np

import gearfe as gf
from gearfe.core.table import Column, Table
from gearfe.core.units import in_newton_per_um
from gearfe.scene.load import scene_names

from ..shared import page
from ..shared.kept_rows import kept, stored

TABLE, PHASES = "needs", 16
HOW = f"""
Each healthy pair is solved as `method = "auto"` solves it, and once more by `ritz3d` at full width, at {PHASES} phases of a
cycle. Both solve one sector of each gear and join its teeth to the body. Only teeth that can touch at the same time have loads.
Change: k at full width less k as used, in the mean and at the phase of the largest change. Contact lines of helical teeth
cross the width, so that no section represents them. Seconds are CPU seconds with no gear known, without imports. All meshes
of a machine share the curve of their pair. A damaged case solves its damaged gear again, and no other.

Hexahedra of whole gears with all teeth (`fe3d`) are used on request only. [speed.md](speed.md) and [sample.md](sample.md) have
their cost and the change in k.

`python -m validation needs` computes this page.
"""


def timed(case, method):
    """Stiffness curve and CPU seconds of a case with no gear known."""
    started = time.process_time()
    curve = gf.solve(case, gf.Solve(method, PHASES, cache=False))
    return curve, round(time.process_time() - started, 2)


def row(scene, name):
    """Numbers of a pair."""
    case = gf.load_scene(scene).pairs[name].case()
    used, wide = timed(case, "auto"), timed(case, "ritz3d")
    change = wide[0].k / used[0].k - 1
    return {
        "method": used[0].meta["method"],
        "why": used[0].meta["why"],
        "loaded": used[0].order.size,
        "teeth": [gear.z for gear in (case.pair.gear_1, case.pair.gear_2)],
        "k": float(used[0].k.mean()),
        "unknowns": [sum(curve.meta["dofs"]) for curve, _ in (used, wide)],
        "seconds": [seconds for _, seconds in (used, wide)],
        "change": [float(wide[0].k.mean() / used[0].k.mean() - 1), float(change[np.abs(change).argmax()])],
    }


def keys():
    """Scene and name of every pair of the built-in scenes, by the key of its row."""
    return {f"{scene} {name}": (scene, name) for scene in scene_names() for name in gf.load_scene(scene).pairs}


def run(again=True):
    """Write the page; `again`: compute its rows again."""
    rows = {key: kept(TABLE, key, lambda at=at: row(*at), again) for key, at in keys().items()}
    plane = [one for one in rows.values() if one["method"] == "ritz"]
    low, high = (100 * pick(one["change"][0] for one in plane) for pick in (min, max))
    answer = (
        f"{len(plane)} of {len(rows)} pairs of the built-in scenes need their transverse section only. Their full width would "
        f"cost {np.median([one['seconds'][1] / one['seconds'][0] for one in plane]):.0f} times as much (median), and would "
        f"change the mean k by {low:+.1f} to {high:+.1f} %. The other {len(rows) - len(plane)} pairs are helical."
    )
    head = ["pair", "used", "because", "tooth pairs", "of teeth", "unknowns", "s", "k [N/um]"]
    full = ["full width: unknowns", "s", Column("change of mean k [%]", form="{:+.2f}"), Column("largest [%]", form="{:+.2f}")]
    page.write(
        "needs", answer, Table((*head, *full), [_cells(key, one) for key, one in rows.items()]).markdown().splitlines(), HOW
    )


def _cells(key, one):
    """Row of the table on the page."""
    wide = one["method"] != "ritz"
    used = [key.replace(" ", ", "), one["method"], one["why"], one["loaded"], "/".join(map(str, one["teeth"]))]
    used += [f"{one['unknowns'][0]:,}", f"{one['seconds'][0]:.2g}", in_newton_per_um(one["k"])]
    full = [f"{one['unknowns'][1]:,}", f"{one['seconds'][1]:.2g}", *(100 * change for change in one["change"])]
    return used + ([None] * len(full) if wide else full)


def cheap():
    """Rows on file with what computes them again."""
    for key, at in keys().items():
        known = stored(TABLE)[key]
        yield key, [known["k"], *known["change"]], lambda at=at: (lambda one: [one["k"], *one["change"]])(row(*at))

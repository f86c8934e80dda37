"""The page `speed`: seconds and errors of every method, measured in one run on one machine."""

import json
import os
import tempfile
import time

import numpy as np

import gearfe as gf

from ..shared import machine, page, speed_page
from ..shared.places import TABLES
from . import speed_dynamics, speed_three

TABLE = TABLES / "speed.json"
REFINES = (0.5, 1.0, 2.0, 3.0)
ORDERS = (2, 3, 4, 5, 6)
REFERENCE = 6.0
DEFAULTS = ("fe, refine 1", "ritz, order 4")


def median_seconds(work):
    """Median processor time of `work` and its last result: the clock would count what other programs do."""
    seconds = []
    for _ in range(5):
        started = time.process_time()
        result = work()
        seconds.append(time.process_time() - started)
    return float(np.median(seconds)), result


def measure():
    """Measure everything and write the table and the picture."""
    with tempfile.TemporaryDirectory() as folder:
        os.environ["GEARFE_CACHE"] = folder
        found = {"machine": machine.describe(), "three": {"rows": speed_three.rows()}}  # a child's peak counts its parent's
        found |= {
            "sections": sections(),
            "dynamics": {"rows": speed_dynamics.integrators()},
            "steps": speed_dynamics.speeds(),
        }
    page.replace(TABLE, json.dumps(found, indent=1) + "\n")
    speed_page.plot(found)


def run(again=True):
    """Write the page; `again`: measure again."""
    if again:
        measure()
    page.write("speed", *text())


def text():
    """Arguments of `page.text`, from the table."""
    found = json.loads(TABLE.read_text(encoding="utf-8"))
    plane, solid = ({row[1]: row for row in found[part]["rows"]} for part in ("sections", "three"))
    fe, ritz = (next(row for row in plane.values() if row[5] and row[0] == name) for name in ("fe", "ritz"))
    ritz3d = next(row for row in solid.values() if row[5])
    brute = next(row for row in solid.values() if row[0] == "fe3d")
    quick = next(row for row in found["dynamics"]["rows"] if row[5])
    answer = (
        f"A section costs `ritz` {ritz[2]:.2g} s at an error of {100 * ritz[4]:.2g} % and `fe` {fe[2]:.2g} s at "
        f"{100 * fe[4]:.2g} %, "
        f"a herringbone pair `ritz3d` {ritz3d[2]:.2g} s at {100 * ritz3d[4]:.2g} % and hexahedra {brute[2]:.0f} s at "
        f"{100 * brute[4]:.2g} %, and a simulated second of its stage {quick[2]:.2g} s at {100 * quick[4]:.2g} %."
    )
    how = f"""
    `python -m validation speed` measures all of it in one run: {found["machine"]}. Seconds are the processor's. Errors:
    relative, of k at each phase against the finest solution (2-D: finite elements; 3-D: the energy model at the highest
    orders), of mesh forces over their range against DOP853 at rtol 1e-10. So these are errors of discretisation; what all
    methods share is judged in [outlines.md](outlines.md) and [three.md](three.md). Bold, and circled in the picture: the
    defaults.

    ![seconds against error](speed.png)
    """
    return (
        answer,
        how,
        ["## Sections (2-D)", "", found["sections"]["about"], "", *speed_page.table(found["sections"]["rows"])],
        ["## Three dimensions", "", speed_three.ABOUT, "", *speed_page.table(solid.values())],
        [
            """
            ## Integrators

            Herringbone stage with a damaged sun tooth, 55 degrees of freedom, 12 meshes; seconds per simulated second. More:
            [dynamics.md](dynamics.md).
            """,
            "",
            *speed_page.table(found["dynamics"]["rows"]),
            "",
            "At the step that `simulate` chooses, its choice and the outputs included, filtered unless told, best of three;",
            "with a damaged tooth unless healthy:",
            "",
            *speed_page.steps(found["steps"]),
        ],
        ["What decides the cost in three dimensions, and where the time goes: [speed_stages.md](speed_stages.md)."],
    )


def sections():
    """Measured values of sections."""
    scene = gf.load_scene("planetary_pitting").pair()
    case = {"force": scene.force, "material": scene.materials, "cache": False}
    for method in ("fe", "ritz"):
        gf.mesh_stiffness(scene.pair, phases=4, method=method, **case)  # imports, first gmsh start
    truth = gf.mesh_stiffness(scene.pair, method="fe", refine=REFERENCE, **case)
    damage = {"pinion": [gf.Crack(level=0.3)]}
    cracked = gf.mesh_stiffness(scene.pair, method="fe", refine=REFERENCE / 2, damage=damage, **case)
    runs = [(f"fe, refine {refine:g}", {"method": "fe", "refine": refine}) for refine in REFINES]
    runs += [(f"ritz, order {order}", {"method": "ritz", "order": order}) for order in ORDERS]
    runs += [(method, {"method": method}) for method in ("coupled", "textbook", "herringbone_article")]
    rows = [_row(name, truth, lambda o=options: gf.mesh_stiffness(scene.pair, **case, **o)) for name, options in runs]
    for method in ("fe", "ritz"):
        run = {"method": method, "damage": damage}
        rows.append(_row(f"{method}, 30 % crack", cracked, lambda o=run: gf.mesh_stiffness(scene.pair, **case, **o)))
        rows.append(_row(f"{method}, 30 % crack, healthy gears known", cracked, _new_cracks(scene, method)))
    few, many = (median_seconds(lambda n=n: gf.mesh_stiffness(scene.pair, phases=n, **case))[0] for n in (64, 1064))
    one, ten = (
        median_seconds(lambda n=n: gf.mesh_stiffness(scene.pair, [1e3 + 200 * i for i in range(n)], scene.materials))[0]
        for n in (1, 11)
    )
    return {"about": _about(truth, (many - few) / 1000, (ten - one) / 10), "rows": [_line(*row) for row in rows]}


def _about(truth, per_phase, per_load):
    dofs = " + ".join(f"{n:,}" for n in truth.meta["dofs"])
    return (
        "Scene `planetary_pitting`, sun-planet pair, 64 phases, imports excluded, meshing included, median of 5 runs, nothing "
        "cached unless the row says so. "
        f"Reference: finite elements of {dofs} unknowns (refine {REFERENCE:g}; cracked: refine {REFERENCE / 2:g}). "
        f"Each further phase of `ritz` costs {1e3 * per_phase:.2f} ms, each further load (64 phases) {1e3 * per_load:.1f} ms, "
        f"that is {1e3 * per_load / 64:.2f} ms per phase and load."
    )


def _line(name, size, seconds, error):
    """Return a row of `speed_page.table`."""
    family = name if "crack" in name else name.split(",")[0]
    more = " + ".join(f"{n:,}" for n in size) + " unknowns" if size else ""
    return family, name, seconds, float(error.mean()), float(error.max()), int(name in DEFAULTS), more


def _row(name, truth, work):
    seconds, curve = median_seconds(work)
    return name, curve.meta.get("dofs"), seconds, np.abs(curve.k / truth.k - 1)


def _new_cracks(scene, method):
    """Work on a cracked pair whose healthy gears are known, a crack a millionth deeper every time."""
    levels = iter(0.3 + 1e-6 * np.arange(1, 8))

    def new_crack():
        damage = {"pinion": [gf.Crack(level=float(next(levels)))]}
        return gf.mesh_stiffness(scene.pair, scene.force, scene.materials, method=method, damage=damage)

    new_crack()
    return new_crack

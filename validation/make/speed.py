"""Speed against error: seconds and errors of every method, in one run on one machine."""

import os
import tempfile
import time

import numpy as np

import gearfe as gf

from ..shared import machine
from ..shared.speed_page import page, save

REFINES = (0.5, 0.7, 1.0, 1.5, 2.0, 3.0)
ORDERS = (2, 3, 4, 5, 6)
REFERENCE = 6.0
DEFAULTS = ("fe, refine 1", "ritz, order 4")


def median_seconds(work, repeats=5):
    """Median processor time of `work` and its last result: the clock would count what other programs do."""
    seconds = []
    for _ in range(repeats):
        started = time.process_time()
        result = work()
        seconds.append(time.process_time() - started)
    return float(np.median(seconds)), result


def run():
    """Measure, write `speed.md` and `speed.png`, and print the page: with the last measurements of the other two parts."""
    with tempfile.TemporaryDirectory() as folder:
        os.environ["GEARFE_CACHE"] = folder
        _run()


def _run():
    scene = gf.load_scene("planetary_pitting").pair()
    case = {"force": scene.force, "material": scene.materials, "cache": False}
    for method in ("fe", "ritz"):
        gf.mesh_stiffness(scene.pair, phases=4, method=method, **case)  # imports, first gmsh start
    truth = gf.mesh_stiffness(scene.pair, method="fe", refine=REFERENCE, **case)
    damage = {"pinion": [gf.Crack(level=0.3)]}
    cracked = gf.mesh_stiffness(scene.pair, method="fe", refine=REFERENCE / 2, damage=damage, **case)
    runs = [(f"fe, refine {refine:g}", {"method": "fe", "refine": refine}) for refine in REFINES]
    runs += [(f"ritz, order {order}", {"method": "ritz", "order": order}) for order in ORDERS]
    runs += [(method, {"method": method}) for method in ("coupled", "textbook", "published")]
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
    save("speed_two", _about(truth, (many - few) / 1000, (ten - one) / 10), [_line(*row) for row in rows])
    print(page())


def _about(truth, per_phase, per_load):
    dofs = " + ".join(f"{n:,}" for n in truth.meta["dofs"])
    return (
        f"Made by `python -m validation speed` on {machine.describe()}. Scene `planetary_pitting`, sun-planet pair, 64 "
        "phases, processor time, imports excluded, meshing included, median of 5 runs, nothing cached unless the row says so. "
        f"Reference: finite elements of {dofs} unknowns (refine {REFERENCE:g}; cracked: refine {REFERENCE / 2:g}). "
        f"Each further phase of `ritz` costs {1e3 * per_phase:.2f} ms, each further load (64 phases) {1e3 * per_load:.1f} ms, "
        f"that is {1e3 * per_load / 64:.2f} ms per phase and load."
    )


def _line(name, size, seconds, error):
    """Row of `speed_page.COLUMNS`."""
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

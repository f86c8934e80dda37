"""Speed against error: seconds and errors of every method, in one run on one machine."""

import os
import tempfile
import time
from pathlib import Path

from . import machine  # first: it sets the number of threads

import numpy as np  # isort: skip

import gearfe as gf  # isort: skip
from gearfe.export import written  # isort: skip

REFINES = (0.5, 0.7, 1.0, 1.5, 2.0, 3.0)
REFERENCE = 6.0
PAGE = Path(__file__).parent / "speed.md"
PICTURE = Path(__file__).parent / "speed.png"


def median_seconds(work, repeats=5):
    """Median time of `work` and its last result."""
    seconds = []
    for _ in range(repeats):
        started = time.perf_counter()
        result = work()
        seconds.append(time.perf_counter() - started)
    return float(np.median(seconds)), result


def run():
    """Measure, write `speed.md` and `speed.png`, and print the page."""
    with tempfile.TemporaryDirectory() as folder:
        os.environ["GEARFE_CACHE"] = folder
        _run()


def _run():
    scene = gf.load_scene("planetary_pitting").pair()
    case = {"force": scene.force, "material": scene.materials, "cache": False}
    gf.mesh_stiffness(scene.pair, phases=4, **case)  # imports, first gmsh start
    truth = gf.mesh_stiffness(scene.pair, refine=REFERENCE, **case)
    rows = []
    for refine in REFINES:
        seconds, curve = median_seconds(lambda refine=refine: gf.mesh_stiffness(scene.pair, refine=refine, **case))
        rows.append((f"fe, refine {refine:g}", curve.meta["dofs"], seconds, np.abs(curve.k / truth.k - 1)))
    for method in ("textbook", "published"):
        seconds, curve = median_seconds(lambda method=method: gf.mesh_stiffness(scene.pair, method=method, **case))
        rows.append((method, None, seconds, np.abs(curve.k / truth.k - 1)))
    damage = {"pinion": [gf.Crack(level=0.3)]}
    cracked_truth = gf.mesh_stiffness(scene.pair, refine=REFERENCE / 2, damage=damage, **case)
    seconds, curve = median_seconds(lambda: gf.mesh_stiffness(scene.pair, damage=damage, **case))
    rows.append(("fe, 30 % crack", curve.meta["dofs"], seconds, np.abs(curve.k / cracked_truth.k - 1)))
    rows.append(
        (
            "fe, 30 % crack, healthy gears cached",
            curve.meta["dofs"],
            _cached(scene, damage),
            np.abs(curve.k / cracked_truth.k - 1),
        )
    )
    few, many = (median_seconds(lambda n=n: gf.mesh_stiffness(scene.pair, phases=n, **case))[0] for n in (64, 1064))
    one, ten = (
        median_seconds(lambda n=n: gf.mesh_stiffness(scene.pair, [1e3 + i for i in range(n)], scene.materials, cache=False))[0]
        for n in (1, 11)
    )
    page = _page(rows, truth, (many - few) / 1000, (ten - one) / 10)
    with written(PAGE) as name:
        Path(name).write_text(page, encoding="utf-8")
    _plot(rows)
    print(page)


def _cached(scene, damage):
    """Median seconds of a cracked pair whose healthy gears are known, a new crack every time."""
    levels = iter(np.linspace(0.29, 0.31, 6))
    gf.mesh_stiffness(scene.pair, scene.force, scene.materials, damage={"pinion": [gf.Crack(level=float(next(levels)))]})

    def new_crack():
        cracks = [gf.Crack(level=float(next(levels)))]
        return gf.mesh_stiffness(scene.pair, scene.force, scene.materials, damage={"pinion": cracks})

    return median_seconds(new_crack)[0]


def _page(rows, truth, per_phase, per_load):
    dofs = " + ".join(f"{n:,}" for n in truth.meta["dofs"])
    lines = [
        "# Speed against error, 2-D",
        "",
        f"Made by `python -m validation speed` on {machine.describe()}. Scene `planetary_pitting`, sun-planet pair, 64 phases,",
        "imports excluded, meshing included, median of 5 runs, nothing cached unless the row says so. Error of k at each phase",
        f"against finite elements of {dofs} unknowns (refine {REFERENCE:g}; cracked: refine {REFERENCE / 2:g}).",
        "",
        "| method | unknowns | seconds | mean error | max error |",
        "|---|---|---|---|---|",
    ]
    for name, size, seconds, error in rows:
        size = " + ".join(f"{n:,}" for n in size) if size else ""
        bold = "**" if name == "fe, refine 1" else ""
        lines.append(f"| {bold}{name}{bold} | {size} | {seconds:.4f} | {100 * error.mean():.3f} % | {100 * error.max():.3f} % |")
    lines += [
        "",
        "Bold: the default.",
        f"Each further phase of `fe` costs {1e3 * per_phase:.2f} ms, each further load (64 phases) {1e3 * per_load:.1f} ms,",
        f"that is {1e3 * per_load / 64:.2f} ms per phase and load.",
        "",
        "![seconds against error](speed.png)",
        "",
    ]
    return "\n".join(lines)


def _plot(rows):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6, 4), layout="constrained")
    axes = figure.subplots()
    fe = [(seconds, 100 * error.max()) for name, _, seconds, error in rows if name.startswith("fe, refine")]
    axes.loglog(*zip(*fe, strict=True), "o-", label="fe, by resolution")
    for name, _, seconds, error in rows:
        if not name.startswith("fe"):
            axes.loglog(seconds, 100 * error.max(), "s", label=name)
        if name == "fe, refine 1":
            axes.loglog(seconds, 100 * error.max(), "o", ms=12, mfc="none", mec="k", label="default")
    axes.set_xlabel("seconds for 64 phases, one thread")
    axes.set_ylabel("largest error of k [%]")
    axes.grid(True, which="both", alpha=0.3)
    axes.legend()
    with written(PICTURE) as name:
        figure.savefig(name, dpi=100)

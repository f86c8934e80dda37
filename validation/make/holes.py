"""Pits as real holes: the volume that was cut, and what the missing material changes that lost contact does not."""

import time
from pathlib import Path

import numpy as np

import gearfe as gf
from gearfe.contact.solid import pair_stiffness3d
from gearfe.files import written
from gearfe.stiffness.inputs import by_gear, overlap
from gearfe.stress.holed import pressed_tooth

from ..shared import machine
from ..shared.places import PAGES

PAGE = PAGES / "holes.md"
LAYOUTS = (
    *(("herringbone", case) for case in ("case1", "case2", "case4")),
    *(("helical_pitting", case) for case in ("minor", "severe", "multi")),
    *(("planetary_pitting", case) for case in ("mild", "moderate", "severe")),
)
REFINES = (1.0, 1.6)
PHASES = 16


def row(scene, case):
    """Text of one layout, and by how much its missing material changes k at most, relative, on both meshes."""
    found = gf.load_scene(scene).pair()
    pits = {side: [one for one in own if isinstance(one, gf.Pit)] for side, own in found.damage[case].items()}
    pair, run = found.pair, {"face": found.face or "spur", "groove": found.groove}
    phases = (pair.eps_alpha + overlap(pair, **run)) * (np.arange(PHASES) + 0.5) / PHASES
    own = by_gear(pair, pits)[1]
    k = [pair_stiffness3d(pair, found.force, found.materials, phases, pits=p, **run).k for p in (((), ()), own)]
    made, seconds = [], []
    for refine in REFINES:
        started = time.perf_counter()
        made.append(
            pressed_tooth(
                pair, found.force, found.materials, pits, phases=phases, refine=refine, removal=True, **run
            )
        )  # fmt: skip
        seconds.append(time.perf_counter() - started)
    wanted, cut, _ = made[-1].sector.removed
    meshed = [one.sector.removed[2] for one in made]
    extra = [float(one.extra.max()) for one in made]
    count, size = len(pits["pinion"]), "{:g} x {:g}".format(*(2 * v for v in pits["pinion"][0].axes))
    cells = [
        f"{scene}, {case}: {count} of {size} mm", f"{wanted:.5f}", f"{100 * (cut / wanted - 1):+.4f} %",
        " / ".join(f"{100 * (v / wanted - 1):+.1f}" for v in meshed) + " %",
        " / ".join(f"{one.cells.shape[1]:,}" for one in made), " / ".join(f"{one.unknowns:,}" for one in made),
        " / ".join(f"{s:.0f}" for s in seconds), f"{100 * (1 - k[1] / k[0]).max():.2f} %",
        " / ".join(f"{100 * e:.3f}" for e in extra) + " %", f"{phases[made[-1].extra.argmax()]:.2f}",
    ]  # fmt: skip
    return "| " + " | ".join(cells) + " |", extra


def run():
    """Write `holes.md` and print it."""
    head = [
        "# Pits as real holes",
        "",
        f"Made by `python -m validation holes` on {machine.describe()}.",
        "Pits are cut out of the tooth as elliptic cylinders with a flat bottom, the tooth is meshed with straight second-order",
        "tets (`geometry.mesh.holes`, `gearfe.stress.holed`). Volume: an integral over the involutes parallel to the flank, "
        "which knows nothing of the solid; cut: difference of the boundary representation from it (more than 0.2 % is an error, "
        "not a result); meshed: of the tets, whose rims are polygons, on the two meshes.",
        "",
        "Everywhere else in gearfe pits take contact away and no material. What that leaves out: the tooth is solved with and",
        "without its holes on the same mesh, under the same load of the pair along the lines of contact that the pits leave,",
        f"at {PHASES} phases of the engagement. The work of the load on the difference, over force times approach of the pair,",
        "is by how much k would fall if the load did not redistribute: an upper bound of what the missing material does to k.",
        "The largest of all phases is given, beside the largest drop of k by lost contact alone.",
        "",
        "| layout | volume [mm3] | cut | meshed | tets | unknowns | seconds "
        "| k lost by contact | k lost by material, at most | at phase |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    lines, largest = [], []
    print("\n".join(head), flush=True)
    for scene, case in LAYOUTS:
        line, extra = row(scene, case)
        lines.append(line)
        largest.append((extra[-1], abs(extra[-1] - extra[0]), f"{scene}, {case}"))
        print(line, flush=True)
    most, _, name = max(largest)
    step = max(change for _, change, _ in largest)
    end = (
        f"Pits only as lost contact leave out a change of k of at most {100 * most:.2f} % ({name}); "
        f"between the two meshes it moves by no more than {100 * step:.3f} points."
    )
    print(f"\n{end}")
    with written(PAGE) as path:
        Path(path).write_text("\n".join([*head, *lines, "", end]) + "\n", encoding="utf-8")

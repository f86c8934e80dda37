"""The page `holes`: pits cut out of teeth, healthy and cracked, and what that changes beyond lost contact."""

import numpy as np

import gearfe as gf
from gearfe.core.case import by_gear, overlap
from gearfe.strength.holed import pressed_tooth

from ..shared import outsider, page
from ..shared.kept_rows import kept, stored
from ..shared.solid_pair import solid_contact
from . import holed_cracks, outsider_three

LAYOUTS = (
    *(("herringbone", case) for case in ("case1", "case2", "case4")),
    ("herringbone_contact_line", "case2"),
    *(("helical_pitting", case) for case in ("minor", "severe", "multi")),
    *(("planetary_pitting", case) for case in ("mild", "moderate", "severe")),
)
REFINES = (1.0, 1.6)
FINER = {"herringbone": "case4", "helical_pitting": "severe", "planetary_pitting": "severe"}  # solved on both meshes
PHASES = 16
TEXT = f"""
## Pits of the scenes

Everywhere else in gearfe pits take contact away and no material. Here they are cut out as elliptic cylinders with a flat
bottom, the tooth is meshed with straight second-order tets (`gearfe.geometry.mesh.holes`, `gearfe.strength.holed`), and it is
solved with and without its holes on the same mesh, under the same load of the pair along the lines of contact that the pits
leave, at {PHASES} phases of the engagement. The work of the load on the difference, over force times approach of the pair, is
by how much k would fall if the load did not redistribute. The largest of all phases is given, beside the largest drop of k by
lost contact alone. Volume: an integral over the involutes parallel to the flank, which knows nothing of the solid; cut:
difference of the solid from it (more than 0.2 % is an error, not a result); meshed: of the tets, whose rims are polygons. Two
values: on two meshes. Of pits in both halves of a herringbone tooth the volume is that of one half.
"""
SHARED = """
The loads are those that `ritz3d` finds with lost contact, spread over 0.15 modules to either side of their line: wider than
Hertz's pressure, which makes the answer less, since the walls of a pit give way the more, the nearer the pressure is. What both
estimates leave out, CalculiX has: it solves the contact around the holes itself, see [three.md](three.md).
"""
HOW = """
`python -m validation holes` makes this page from `tables/holes.jsonl` and `tables/holed_cracks.jsonl` and computes them.
"""


def row(scene, case):
    """One layout: what is cut out, and what its missing material takes of k by the estimate, at its worst phase, on each mesh."""
    found = gf.load_scene(scene).pair()
    pits = {side: [one for one in own if isinstance(one, gf.Pit)] for side, own in found.damage[case].items()}
    pair, run = found.pair, {"face": found.face or "spur", "groove": found.groove}
    phases = (pair.eps_alpha + overlap(pair, **run)) * (np.arange(PHASES) + 0.5) / PHASES
    own = by_gear(pair, pits)[1]
    k = [solid_contact(pair, found.force, found.materials, phases, pits=p, **run).k for p in (((), ()), own)]
    refines = REFINES if FINER.get(scene) == case else REFINES[:1]
    pitted, options = gf.Case(pair, found.force, found.materials, damage=pits, **run), {"phases": phases, "removal": True}
    made = [pressed_tooth(pitted, refine=refine, **options) for refine in refines]
    wanted, cut, _ = made[-1].sector.removed
    both = " in each half" if len({pit.z > found.pair.gear_1.b / 2 for pit in pits["pinion"]}) > 1 else ""
    size = "{:g} x {:g}".format(*(2 * v for v in pits["pinion"][0].axes))
    return {
        "pits": f"{len(pits['pinion']) // (2 if both else 1)} of {size} mm{both}",
        "volume": float(wanted),
        "cut": float(cut / wanted - 1),
        "meshed": [float(one.sector.removed[2] / wanted - 1) for one in made],
        "lost": float((1 - k[1] / k[0]).max()),
        "extra": [float(one.extra.max()) for one in made],
        "phase": float(phases[made[-1].extra.argmax()]),
    }


def section(again=False):
    """Lines of the layouts of the scenes."""
    lines = [
        *TEXT.strip().splitlines(),
        "",
        "| layout | pits | volume [mm3] | cut | meshed | k lost by contact | k lost by material, estimated | at phase |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for scene, case in LAYOUTS:
        one = kept("holes", f"{scene}, {case}", lambda scene=scene, case=case: row(scene, case), again)
        meshed, extra = (
            " / ".join(f"{100 * v:{kind}}" for v in one[name]) for name, kind in (("meshed", "+.1f"), ("extra", ".3f"))
        )
        lines.append(
            f"| {scene}, {case} | {one['pits']} | {one['volume']:.5f} | {100 * one['cut']:+.4f} % | {meshed} % | "
            f"{100 * one['lost']:.2f} % | {extra} % | {one['phase']:.2f} |"
        )
    return lines


def answer():
    """The first line."""
    rows = stored("holes").values()
    most = max(rows, key=lambda row: row["extra"][-1])
    cracked = max(-row["mean"] for row in stored("holed_cracks").values())
    finest = {name: one for (name, _), one in outsider_three.pitted(outsider.stored()).items()}
    calculix = max(1 - (1 + one["cut"]) / (1 + one["lost"]) for one in finest.values())
    return (
        f"By a linear estimate, which is too low, missing material takes up to {100 * most['extra'][-1]:.2f} % of k at a phase "
        f"in {len(rows)} layouts of pits, and {100 * cracked:.2f} % in the mean of cracked teeth; CalculiX, where it solves the "
        f"contact around two holes of a narrow gear, finds up to {100 * calculix:.1f} %."
    )


def run(again=True):
    """Write the page; `again`: compute its rows again."""
    sections = section(again), holed_cracks.section(again)
    page.write("holes", answer(), HOW.strip().splitlines(), *sections, SHARED.strip().splitlines())

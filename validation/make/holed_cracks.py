"""A part of the page `holes`: pits cut out of cracked teeth, the damaged rows of article S4 with holes and crack in the tooth."""

import gearfe as gf
from gearfe.comparison.compare import damage_cycle
from gearfe.comparison.printed_stiffness import printed_cases
from gearfe.strength.holed import pressed_tooth

from ..shared.herringbone_page import SCENE
from ..shared.kept_rows import kept

EVERY = 8  # of the cycle's 32 phases
FINE = 1.6
FINER = ("sun_planet", "case2")  # solved on a finer mesh, too
TEXT = f"""
## Pits of cracked teeth

The damaged rows of article S4 ([herringbone.md](herringbone.md)) with the pits cut out of the tooth *and* its crack in it: the
damaged tooth and its neighbours in straight second-order tets, once with the holes and once with the same mesh filled, both
cracked, under the loads that `ritz3d` finds along the contact lines that the pits leave. Mean: over the mesh cycle in which the
damaged tooth is in the middle of its engagement ({32 // EVERY} phases). Lost contact: `ritz3d` with contact on the path only.
"""


def solve(pair, case, refine=1.0):
    """One row: k with lost contact, and by how much the missing material changes it, in the mean and at most, relative."""
    chosen = gf.load_scene(SCENE).pairs[pair]
    phases = damage_cycle(chosen)[EVERY // 2 :: EVERY]
    found = pressed_tooth(chosen.case(case), phases=phases, refine=refine, removal=True)
    k, change = found.contact.k, 1 / (1 + found.extra) - 1
    mean = (k * (1 + change)).mean() / k.mean() - 1
    return {"k": float(k.mean()), "mean": float(mean), "largest": float(change.min()), "unknowns": int(found.unknowns)}


def section(again=False):
    """Lines of the page."""
    lines = [
        *TEXT.strip().splitlines(),
        "",
        "| pair | case | k, lost contact [N/um] | mean | largest at a phase | mean, finer mesh |",
        "|---|---|---|---|---|---|",
    ]
    for pair, case in printed_cases(gf.load_scene(SCENE)):
        if case:
            name = f"{pair}, {case}"
            one = kept("holed_cracks", name, lambda pair=pair, case=case: solve(pair, case), again)
            finer = ""
            if (pair, case) == FINER:
                make = lambda pair=pair, case=case: solve(pair, case, FINE)  # noqa: E731
                finer = f"{100 * kept('holed_cracks', f'{name}, finer mesh', make, again)['mean']:+.3f} %"
            cells = f"{one['k'] / 1e6:.1f} | {100 * one['mean']:+.3f} % | {100 * one['largest']:+.3f} %"
            lines.append(f"| {pair} | {case} | {cells} | {finer} |")
    return lines

"""Upper bound of the load carried by the corner of a chip that covers a part of the face width.

Such a chip is a recess, which takes contact away at once. A corner goes on to touch the mate until its gap exceeds the approach
of the gears. The chip with its corner moved up by that distance carries at least as much. A chip of the other side is left out
instead, because its cut may end on the loaded flank too.
"""

import math
from dataclasses import replace

from ..core.case import SIDES, Case
from ..geometry.damage.chip import Chip
from ..geometry.pair.gear_pair import with_tips
from .pieces import beyond


def later_chips(case: Case, approach: float) -> Case | None:
    """Return the case with partial-width chips of less depth, for an `approach` [mm], or None if it has no such chips."""
    gears, found, damage = (case.pair.gear_1, case.pair.gear_2), False, {}
    for k, ((name, _), gear) in enumerate(zip(SIDES, gears, strict=True)):
        own = []
        for one in (case.damage or {}).get(name, ()):
            if isinstance(one, Chip) and not one.through:
                found = True
                if one.side != "loaded":
                    continue
                roll = one.cut(gear)[0]
                short = with_tips(case.pair, [roll if k == side else None for side in (0, 1)])
                last = roll + gear.outward * beyond(short, approach)[1 - k]
                depth = gear.outward * (gear.r_a - math.hypot(last, gear.r_b))
                if depth <= 0:
                    continue
                one = replace(one, depth=depth)
            own.append(one)
        damage[name] = own
    return replace(case, damage=damage) if found else None

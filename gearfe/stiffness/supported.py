"""Supports of a pair's hubs, checked; and what they add to a model that knows no width."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ..supports.shaft import Shaft
from ..supports.support import Support


def supports_of(pair, supports):
    """What holds the hubs of pinion and wheel, None where rigid; None if both are.

    Raises
    ------
    ValueError
        If it is something else, or a shaft does not carry its gear.
    """
    if supports is None:
        return None
    if not isinstance(supports, Mapping):
        raise ValueError(f"supports = {supports!r}, but give them by gear: {{'pinion': Support(...), 'wheel': Shaft(...)}}")
    unknown = set(supports) - {"pinion", "wheel"}
    if unknown:
        raise ValueError(f"supports of {unknown.pop()!r}, but they are given for 'pinion' and 'wheel'")
    for name, one in supports.items():
        if not (one is None or isinstance(one, (Support, Shaft))):
            raise ValueError(f"supports of the {name}: {one!r} is neither a Support nor a Shaft")
    found = tuple(supports.get(name) for name in ("pinion", "wheel"))
    return found if any(found) else None


def check_integral(pair, supports, method, face):
    """ValueError for a gear that is one piece with its shaft where no method has it."""
    for name, gear, held in zip(("pinion", "wheel"), (pair.gear_1, pair.gear_2), supports or (None, None), strict=True):
        if held is None or not held.integral:
            continue
        if method != "fe3d":
            raise ValueError(
                f"the {name} is one piece with its shaft (integral), with method = {method!r}, which holds its bore: use "
                "method = 'fe3d', or a shaft through the bore"
            )
        if gear.internal or face == "herringbone":
            raise ValueError(
                f"the {name} is one piece with its shaft (integral), but rings and herringbone gears cannot be: leave it out"
            )


def at_middle(pair, supports, row, face):
    """Approach by the supports per line load [mm per N/mm] by the method of a `row` that knows no width.

    None of rigid ones, and for methods in three dimensions, which have them in their contact. Both hubs give way along the line
    of action and turn::

        b (1 / radial + r_b**2 / torsion)    of pinion and wheel

    Raises
    ------
    ValueError
        If a force tilts a gear: no section has its load move to one end. If a gear is one piece with its shaft where no method
        has it.
    """
    check_integral(pair, supports, row.name, face)
    if supports is None or row.kind == "solid":
        return None
    out = 0.0
    for name, gear, held in zip(("pinion", "wheel"), (pair.gear_1, pair.gear_2), supports, strict=True):
        if held is None:
            continue
        if held.tilts:
            raise ValueError(
                f"the {name}'s support tilts it under a force, with method = {row.name!r}, which knows no width: use method = "
                "'ritz3d' or 'fe3d', or give a Support without coupling to leave the tilt out"
            )
        hub = held.hub()
        out += float(hub.bending[0, 0] + gear.r_b**2 * hub.torsion)
    return out * min(pair.gear_1.b, pair.gear_2.b)


def yielding(solve, yields):
    """`solve` of `gearfe.stiffness.plane.curve` with supports in series; loads are shared as without them.

    A constant added to all entries of a flexibility adds itself times the load to the approach, and changes no force.
    """
    if yields is None:
        return solve

    def with_supports(line_load):
        found = solve(line_load)
        way = np.full(found.closing.shape, yields * line_load)
        return replace(found, closing=found.closing + way, tangent=1 / (1 / found.tangent + yields), supports=way)

    return with_supports

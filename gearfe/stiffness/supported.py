"""Compliance of the supports of a pair's hubs in two-dimensional models."""

from dataclasses import replace

import numpy as np


def check_integral(case, method):
    """Raise ValueError for a gear in one piece with its shaft if the method does not model it."""
    for name, gear, held in zip(("pinion", "wheel"), case.pair.gears, case.held or (None, None), strict=True):
        if held is None or not held.integral:
            continue
        if method != "fe3d":
            raise ValueError(
                f"the {name} is one piece with its shaft (integral), with method = {method!r}, which holds its bore: use "
                "method = 'fe3d', or a shaft through the bore"
            )
        if gear.internal or case.face == "herringbone":
            raise ValueError(
                f"the {name} is one piece with its shaft (integral), but rings and herringbone gears cannot be integral: omit it"
            )


def check_tilt(case, method):
    """Raise ValueError if a force tilts a gear, for a two-dimensional method: the load of a section cannot move to one end."""
    for name, held in zip(("pinion", "wheel"), case.held or (None, None), strict=True):
        if held is not None and held.tilts:
            raise ValueError(
                f"the {name}'s support tilts it under a force, with method = {method!r}, which is two-dimensional: use method = "
                "'ritz3d' or 'fe3d', or give a Support without coupling to leave the tilt out"
            )


def yielding(solve, case):
    """Return `solve` of `gearfe.stiffness.section_curves.curve` with supports in series. Load sharing is unchanged.

    Both hubs deflect along the line of action and rotate, by ``b (1 / radial + r_b**2 / torsion)`` of pinion and wheel per line
    load [mm per N/mm]. A constant added to all entries of a flexibility adds its product with the load to the approach and does
    not change forces.
    """
    if case.held is None:
        return solve
    pair = case.pair
    hubs = [(gear, held.hub()) for gear, held in zip(pair.gears, case.held, strict=True) if held]
    yields = sum(float(hub.bending[0, 0] + gear.r_b**2 * hub.torsion) for gear, hub in hubs)
    yields *= pair.b_w

    def with_supports(line_load):
        rigid = solve(line_load)
        way = np.full(rigid.closing.shape, yields * line_load)
        return replace(rigid, closing=rigid.closing + way, tangent=1 / (1 / rigid.tangent + yields), supports=way)

    return with_supports

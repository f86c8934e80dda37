"""Approach of the cells of contact lines by the compliance of both hubs: small rigid motions, linear in the loads."""

import numpy as np


def given_way(cells, pair, hubs, bands, beta_b):
    """Return the approach ``(n, n)`` of `Cells` per unit normal force on each cell, by the compliance of the hubs alone [mm/N].

    `hubs` are the `core.supports.hub.Hub` of pinion and wheel, None for a rigid hub. The axial component of the force on a cell
    points away from the end that touches first. `bands` are those of `gearfe.geometry.pair.lines.bands_of`.
    """
    hand = np.sign([last - first for first, last in bands])[cells.half]
    z = cells.z - pair.b_w / 2
    places = cells.roll_1, -pair.gear_2.outward * cells.roll_2
    out = np.zeros((z.size,) * 2)
    for hub, gear, along in zip(hubs, pair.gears, places, strict=True):
        if hub is not None:
            out += hub.given(along, z, hand, gear.r_b, beta_b)
    return out

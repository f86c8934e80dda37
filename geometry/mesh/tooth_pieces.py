"""Half a tooth (whole, chipped or missing) as outline pieces, with four places for each three-node line."""

import math

import numpy as np

from ..tooth.profile import arc_at, fillet_length, flank, roll_at_arc, root_curve, root_half_angle
from .outline import spaced

GROWTH = 0.4  # growth of the edge length per length, away from fine places


def quarters(values):
    """Divide each interval of `values` into four equal ones."""
    return np.interp(np.arange(4 * len(values) - 3) / 4, np.arange(len(values)), values)


def no_tooth(gear, size):
    """Return the root circle as `half_tooth` of a missing tooth."""
    count = max(2, math.ceil(math.pi / gear.z * gear.r_f / (2 * size["root"])))
    angle = quarters(np.linspace(0.0, math.pi / gear.z, count + 1))
    return [("root", np.full(angle.size, gear.r_f), angle, angle)]


def _tip(gear, edge, corner, cut):
    """Return the pieces of `half_tooth` from the middle of the tip to the end of the flank."""
    if cut is None:
        width = gear.half_thickness(gear.r_a) * gear.r_a
        tip = quarters(spaced(0.0, width, 2 * edge, [(width, width, 2 * corner)], 1, GROWTH)) / gear.r_a
        return [("tip", np.full(tip.size, gear.r_a), tip, tip)]
    out = []
    for length, place in cut[1]:
        at = quarters(spaced(0.0, length, 2 * edge, [(length, length, 2 * corner)], 1, GROWTH)) / length
        x, y = place(at)
        out.append(("tip", np.hypot(x, y), np.arctan2(x, y), at))
    return out


def half_tooth(gear, size, away, own, mouth, patches, cut=None):
    """Return the outline of half a tooth from mid-tip to mid-root: pieces (name, radius, angle, parameter).

    A `cut` is the roll length at which the flank ends below the tip circle, and `Chip.top`.
    """
    edge = size["flank"] if own else size["near"] if away <= 1 else size["far"]
    corner, last = min(edge, size["corner"]) if own else edge, gear.roll_a if cut is None else cut[0]
    start, stop = arc_at(gear, gear.roll_f), arc_at(gear, last)
    fine = [(stop, stop, 2 * corner), *([(a, b, 2 * s) for a, b, s in patches] if own else [])]
    rolls = roll_at_arc(gear, spaced(start, stop, 2 * edge, fine, 1, GROWTH))[::-1]
    rolls[[0, -1]] = last, gear.roll_f
    rolls = quarters(rolls)
    below, top = -gear.r_f * (math.pi / gear.z - root_half_angle(gear)), fillet_length(gear)
    root = size["fillet"] if away == 0 else size["root"]
    out = [*_tip(gear, edge, corner, cut), ("flank", *flank(gear, rolls), rolls)]
    mark, fine = (below, []) if mouth is None else (mouth[0], [(mouth[0], mouth[0], 2 * mouth[1])])
    fine += [
        (top + a - start, top + min(b - start, 0.0), 2 * s) for a, b, s in (patches if own else ()) if a < start - 1e-6 * gear.m_n
    ]
    for name, low, high in (("root" if mouth is None else "fillet", mark, top), ("root", below, mark)):
        if high - low > 1e-6 * gear.m_n:
            arcs = quarters(spaced(low, high, 2 * root, fine, 1, GROWTH)[::-1])
            out.append((name, *root_curve(gear, arcs), arcs))
    return out

"""Drawing of a sector of a gear for meshing in tets: outline, crack, circles of smaller edges, cutting tools of pits.

All coordinates are in the frame that rotates with the helix, in which a tooth is a prism.
"""

import math
from itertools import pairwise, product

import numpy as np
from scipy.spatial import cKDTree

from ..damage.chip import chip_of
from ..damage.crack import meshed_path, start_arc
from ..damage.hollow_volume import hollow_frame
from ..damage.missing import missing_teeth
from ..tooth.profile import cartesian, fillet_length, flank, flank_arcs, roll_at_arc, root_curve, root_half_angle


class _Drawing:
    """Points and curves, with the number of each drawn curve."""

    def __init__(self):
        self.points, self.curves = [], []

    def at(self, xy):
        self.points.append(np.asarray(xy, dtype=float).reshape(2))
        return len(self.points) - 1

    def join(self, kind, *ends):
        self.curves.append((kind, list(ends)))
        return len(self.curves) - 1


def section(gear, crack, teeth, broken=()):
    """Return points ``(2, n)``, curves and the loops of each face: one face, or body and cracked tooth."""
    draft, own_teeth = _Drawing(), numbers_of(gear, teeth)
    edge = (0.5 - own_teeth[0]) * (2 * math.pi / gear.z)
    first = draft.at(cartesian(gear.r_f, -edge))
    rim, cuts, last = _toothed(draft, gear, crack, own_teeth, broken, first, closed=teeth is None)
    hole = []
    if teeth is None:
        inner = [draft.at(cartesian(gear.held, 2 * math.pi * k / 3)) for k in range(3)]
        hole = [[draft.join("arc", inner[k], inner[(k + 1) % 3]) for k in range(3)]]
    else:
        inner = [draft.at(cartesian(gear.held, angle)) for angle in (edge, 0.0, -edge)]
        rim += [draft.join("line", last, inner[0]), draft.join("arc", *inner[:2]), draft.join("arc", *inner[1:])]
        rim.append(draft.join("line", inner[2], first))
    loops = [rim]
    if crack is not None:  # the crack's parting line, between its intersections with the outline
        (start, here), (end, there) = cuts
        ahead = crack.side == "unloaded"
        inside = [draft.at(xy) for xy in meshed_path(gear, crack).T[1:]]
        corners = [here, *inside, there] if ahead else [there, *inside, here]
        parting = [draft.join("line", a, b) for a, b in pairwise(corners)][:: 1 if ahead else -1]
        loops = [rim[:start] + parting + rim[end:], [rim[start:end] + parting[::-1]]]
    body = [*hole, loops[0]] if gear.internal else [loops[0], *hole]
    return np.array(draft.points).T, draft.curves, [body, *loops[1:]]


def _toothed(draft, gear, crack, teeth, broken, last, closed):
    """Return numbers of the curves around the teeth from point `last` on, crack intersections, and the last point.

    An intersection is the number of curves before it, and its point.
    """
    out, cuts, first, gone = [], [], last, missing_teeth(gear, broken)
    for tooth, side in product(teeth, ("unloaded", "loaded")):
        mark = None if crack is None or tooth else start_arc(gear, crack)
        pieces = _no_tooth(gear, side) if tooth % gear.z in gone else _half(gear, side, mark, chip_of(gear, broken, tooth))
        for number, (kind, radius, angle, cut) in enumerate(pieces, 1):
            places = cartesian(radius, angle + tooth * (2 * math.pi / gear.z)).T[1:]
            closing = closed and (tooth, side, number) == (teeth[-1], "loaded", len(pieces))
            nodes = [last, *map(draft.at, places[:-1] if closing else places), *([first] if closing else [])]
            if cut and side == "unloaded":
                cuts.append((len(out), last))
            out.append(draft.join(kind, *nodes))
            last = nodes[-1]
            if cut and side == "loaded":
                cuts.append((len(out), last))
    return out, cuts, last


def numbers_of(gear, teeth):
    """Return the numbers of the teeth of a sector around tooth 0, or of the whole gear (None)."""
    count = gear.z if teeth is None else teeth
    return range(-(count // 2), count - count // 2)


def _no_tooth(gear, side):
    """Return the curves of `_half` for a missing tooth."""
    ends = np.array([0.0, math.pi / gear.z])
    return [("arc", np.full(2, gear.r_f), ends if side == "loaded" else -ends[::-1], False)]


def _tip(gear, side, chip):
    """Return the curves of `_half` from the middle of the tip to the flank."""
    if chip is None:
        return [("arc", [gear.r_a] * 2, np.array([0.0, gear.half_thickness(gear.r_a)]), False)]
    out = []
    for _, place in chip.top(gear, side):
        x, y = place(np.linspace(0, 1, 17))
        radius = np.hypot(x, y)
        kind = "arc" if np.ptp(radius) < 1e-9 * gear.r_a else "line" if chip.radius is None else "spline"
        points = slice(None, None, 1 if kind == "spline" else 16)
        out.append((kind, radius[points], np.arctan2(x, y)[points], False))
    return out


def _half(gear, side, mark, chip=None):
    """Return curves of half a tooth clockwise: kind, radii and angles, and whether the crack's mouth is at the lower end."""
    sign = 1 if side == "loaded" else -1
    # Points equidistant in roll length: equidistant in arc, the spline would deviate from the involute near the base circle.
    rolls = np.linspace(gear.roll_a if chip is None else chip.end_roll(gear, side), gear.roll_f, 17)
    arcs = [fillet_length(gear), *([] if mark is None or not 0 < mark < fillet_length(gear) else [mark]), 0.0]
    fillets = [root_curve(gear, np.linspace(a, b, 13)) for a, b in zip(arcs[:-1], arcs[1:], strict=True)]
    half = math.pi / gear.z
    out = [*_tip(gear, side, chip), ("spline", *flank(gear, rolls), False)]
    out += [("spline", radius, angle, mark is not None and k == 0) for k, (radius, angle) in enumerate(fillets)]
    if half - root_half_angle(gear) > 1e-6:
        out.append(("arc", [gear.r_f] * 2, np.array([root_half_angle(gear), half]), False))
    for k, (kind, radius, angle, cut) in enumerate(out):
        out[k] = kind, np.asarray(radius)[::sign], sign * np.asarray(angle)[::sign], cut
    return out[::sign]


def on_outline(gear, radius, angle):
    """Return the nearest places on the outline of all teeth (radius [mm], angle [rad]) to places ``(n,)``."""
    pitch, dense = 2 * math.pi / gear.z, 2000
    tooth = np.round(angle / pitch) * pitch
    arcs = np.linspace(0.0, fillet_length(gear), dense)
    pieces = [
        (np.full(dense, gear.r_a), np.linspace(0.0, gear.half_thickness(gear.r_a), dense)),
        flank(gear, np.linspace(gear.roll_a, gear.roll_f, dense)),
        root_curve(gear, arcs),
        (np.full(dense, gear.r_f), np.linspace(root_half_angle(gear), max(pitch / 2, root_half_angle(gear)), dense)),
    ]
    curve = [np.concatenate([piece[k] for piece in pieces]) for k in (0, 1)]
    nearest = cKDTree(cartesian(*curve).T).query(cartesian(radius, np.abs(angle - tooth)).T)[1]
    return curve[0][nearest], tooth + np.copysign(curve[1][nearest], angle - tooth)


def fine(gear, crack, size, teeth):
    """Return circles of the section with smaller edges: tooth, loaded flank, fillets, mouth and tip of the crack.

    For a whole gear (`teeth` None) also the fillets next to adjacent teeth, which may be loaded.
    """
    middle = (gear.r_a + gear.r_f) / 2
    out = [(0.0, middle, abs(gear.r_a - gear.r_f) / 2, size["tooth"])]
    for arc in np.linspace(*flank_arcs(gear), 8):
        x, y = cartesian(*flank(gear, roll_at_arc(gear, arc)))
        out.append((float(x), float(y), 0.15 * gear.m_n, size["flank"]))
    radius, angle = root_curve(gear, 0.6 * fillet_length(gear))
    for tooth in (-1, 0, 1) if teeth is None else (0,):
        for side in (-angle, angle):
            x, y = cartesian(radius, 2 * math.pi * tooth / gear.z + side)
            out.append((float(x), float(y), 0.4 * fillet_length(gear), size["fillet"]))
    if crack is not None:
        path = meshed_path(gear, crack)
        out.append((*path[:, -1].tolist(), 0.0, size["tip"]))
        out.append((*path[:, 0].tolist(), 0.0, 2 * size["tip"]))
    return out


def tool(gear, hollow, squeeze):
    """Return outline above the flank and extrusion of the cylinder that cuts a hollow, with its width scaled."""
    centre, axes, push, _ = hollow_frame(gear, hollow)
    roll = math.sqrt(hollow.radius**2 - gear.r_b**2)
    above = (0.2 + (max(hollow.axes) ** 2 / roll if gear.internal else 0.0) / hollow.depth) * push
    return hollow._contours((centre - above) * squeeze[:, 0], squeeze * axes), (push + above) * squeeze[:, 0]

"""Outline of a whole gear for meshing. Vertices and edge middles lie exactly on the profile, with given edge lengths."""

import math
from dataclasses import dataclass

import numpy as np

from ..damage.chip import chip_of
from ..damage.missing import missing_teeth
from ..tooth.gear import shortened
from ..tooth.profile import arc_at, cartesian, fillet_length, flank, flank_arcs, lengths, roll_at_arc, root_curve, root_half_angle

NEAR = 3  # teeth on either side of the loaded ones with edge length `size`; the others have `far_size`
MERGED = 1e-6  # Shorter root arcs between two fillets are omitted [m_n].
GROWTH = 0.25  # growth of the edge length per length, away from fine places


@dataclass(frozen=True, slots=True)
class Half:
    """Half a tooth from tip middle to root middle, without the last point. Vertices have even indices, edge middles odd ones.

    `flank`, `fillet` are the vertex numbers of flank (tip to form point) and fillet (form point to root), `mark` that of a
    crack's start.
    """

    radius: np.ndarray
    angle: np.ndarray
    flank: np.ndarray | None = None
    fillet: np.ndarray | None = None
    mark: int | None = None


def stations(gear, spacing, *, tip=None, low=None, patches=(), span=1, growth=GROWTH):
    """Roll lengths [mm] of flank vertices, from the form point to the tip.

    The arc between them is about `spacing` [mm]. It is graded down to `tip` and `low` towards the two ends, where the
    flexibility changes rapidly, and to the size of each patch ``(first arc, last arc, size)`` [mm, from the base circle]. It
    grows by `growth` per length with the distance from these places. The number of intervals is a multiple of `span`.
    """
    start, stop = flank_arcs(gear)
    fine = [*patches, (stop, stop, tip or spacing), (start, start, low or spacing)]
    return roll_at_arc(gear, spaced(start, stop, spacing, fine, span, growth))


def spaced(start, stop, spacing, fine, span=1, growth=GROWTH):
    """Return places from `start` to `stop`, about `spacing` apart, and closer near each ``(first, last, size)`` of `fine`."""
    smallest = min([size for _, _, size in fine], default=spacing)
    parts = 1 + int(4 * (stop - start) / min(smallest, spacing))
    place = start + (stop - start) / parts * np.arange(parts + 1)  # For few points `numpy.linspace` takes several times as long.
    place[-1] = stop
    step = np.full(place.size, float(spacing))
    for first, last, size in fine:
        away = np.maximum(np.maximum(first - place, place - last), 0.0)
        step = np.minimum(step, size + growth * away)
    count, dense = np.zeros(place.size), 1 / step
    np.cumsum((place[1:] - place[:-1]) * (dense[1:] + dense[:-1]) / 2, out=count[1:])
    intervals = span * max(1, math.ceil(count[-1] / span - 1e-6))
    placed = np.interp(count[-1] / intervals * np.arange(intervals + 1), count, place)
    placed[0], placed[-1] = start, stop
    return placed


def doubled(values):
    """Return parameters of vertices, with those of edge middles inserted at odd positions."""
    values = np.asarray(values, dtype=float)
    out = np.empty(2 * values.size - 1)
    out[::2] = values
    out[1::2] = (values[1:] + values[:-1]) / 2
    return out


def half(gear, roll, fillet_size, size, *, mark=None, top=None):
    """Return half a tooth with flank vertices at `roll`. `mark` is an arc of `root_curve` and the edge length there [mm].

    `top` are the pieces of `gearfe.geometry.damage.chip.Chip.top`, without a chip the tip circle.
    """
    width = gear.half_thickness(gear.r_a) * gear.r_a
    corner = arc_at(gear, roll[-1]) - arc_at(gear, roll[-2])
    tip = doubled(spaced(0.0, width, size, [(width, width, min(corner, size))])) / gear.r_a
    tip = (np.full(tip.size, gear.r_a), tip) if top is None else _chipped(top, min(size, fillet_size), corner)
    below, top = -gear.r_f * (math.pi / gear.z - root_half_angle(gear)), fillet_length(gear)
    if mark is None:
        parts = [np.linspace(top, below, max(2, round((top - below) / fillet_size)) + 1)]
    else:
        fine = [(mark[0], mark[0], mark[1])]
        bounds = [(mark[0], top), (below, mark[0])][: 2 if mark[0] - below > MERGED * gear.m_n else 1]
        parts = [spaced(a, b, fillet_size, fine)[::-1] for a, b in bounds]
    root = doubled(np.concatenate([parts[0], *[part[1:] for part in parts[1:]]]))
    pieces = [tip, flank(gear, doubled(roll[::-1])), root_curve(gear, root)]
    radius, angle = (np.concatenate([p[k][:-1] for p in pieces]) for k in (0, 1))
    ends = np.cumsum([p[0].size - 1 for p in pieces]) // 2
    marked = None if mark is None else int(ends[1] + parts[0].size - 1)
    return Half(radius, angle, ends[0] + np.arange(roll.size), ends[1] + np.arange(root.size // 2 + 1), marked)


def bare(gear, size):
    """Return half a pitch of the root circle with edges of about `size` [mm], in place of half a tooth."""
    pitch = math.pi / gear.z
    angle = doubled(np.linspace(0.0, pitch, math.ceil(gear.r_f * pitch / size) + 1))[:-1]
    return Half(np.full(angle.size, gear.r_f), angle, np.zeros(0, dtype=int), np.zeros(0, dtype=int), None)


def chipped_half(gear, chip, side, fillet_size, size, *, roll=None, mark=None):
    """Return half a chipped tooth, as `half`. Its flank vertices are by default at `stations` of the remaining flank."""
    left = stations(shortened(gear, chip.end_roll(gear, side)), size) if roll is None else roll
    return half(gear, left, fillet_size, size, mark=mark, top=chip.top(gear, side))


def _chipped(top, size, corner):
    """Return radius and angle along the pieces of a chipped tip, up to the flank."""
    points = [np.zeros((2, 0))]
    for k, (length, place) in enumerate(top):
        last = k == len(top) - 1
        fine = [(length, length, min(corner, size, length))] if last else []
        points.append(place(doubled(spaced(0.0, length, size, fine)) / length)[:, : None if last else -1])
    x, y = np.hstack(points)
    return np.hypot(x, y), np.arctan2(x, y)


def outline(gear, rolls, *, fillet_size, size, far_size, teeth=None, marks=None, broken=()):
    """Return the outline of all teeth clockwise, starting at the middle of the tip of tooth 0.

    Parameters
    ----------
    gear : Gear
    rolls : dict of int to ndarray
        Roll lengths of the loaded-flank vertices of some teeth (0 <= tooth < z).
    fillet_size, size, far_size : float
        Edge lengths [mm].
    teeth : int, optional
        Real teeth around each of `rolls`; the others become root circle.
    marks : dict of (int, str) to (float, float)
        Crack starts: tooth and side to arc and edge length [mm].
    broken : sequence of (MissingTooth or Chip)
        Teeth that become root circle, or lose their tips; their loaded flanks end where their `rolls` end.

    Returns
    -------
    points : ndarray, shape (2, 2 n)
        Vertices at even places, edge middles at odd [mm].
    flanks, fillets : dict of int to ndarray
        Vertex numbers, flanks from root to tip, fillets from flank to root.
    starts : dict of (int, str) to int
        Vertex numbers of the marks.
    """
    marks, missing = marks or {}, missing_teeth(gear, broken)
    plain, coarse, far = (
        half(gear, stations(gear, s), f, s) for s, f in ((size, fillet_size), (size, size), (far_size, far_size))
    )
    edge = size if missing else far_size
    arc = math.pi / gear.z * doubled(np.linspace(0, 1, max(1, round(math.pi / gear.z * gear.r_f / edge)) + 1))[:-1]
    gone = Half(np.full(arc.size, gear.r_f), arc)

    def choose(tooth, side):
        distance = min(abs((tooth - k + gear.z // 2) % gear.z - gear.z // 2) for k in rolls)
        if tooth in missing or (teeth is not None and distance > teeth // 2):
            return gone
        chip = chip_of(gear, broken, tooth)
        if chip is not None:
            given = rolls.get(tooth) if side == "loaded" else None
            return chipped_half(gear, chip, side, fillet_size, size, roll=given, mark=marks.get((tooth, side)))
        if (tooth, side) in marks or (distance == 0 and side == "loaded"):
            roll = rolls[tooth] if side == "loaded" and tooth in rolls else stations(gear, size)
            return half(gear, roll, fillet_size, size, mark=marks.get((tooth, side)))
        return plain if distance == 0 else coarse if distance <= NEAR else far

    points, places = around(gear, choose)
    flanks, fillets, starts = {}, {}, {}
    for (tooth, side), (piece, first, sense) in places.items():
        if side == "loaded" and tooth in rolls:
            flanks[tooth], fillets[tooth] = (first + piece.flank)[::-1], first + piece.fillet
        if piece.mark is not None:
            starts[tooth, side] = first + sense * piece.mark
    return points, flanks, fillets, starts


def around(gear, choose):
    """Return the outline of all teeth, with the `Half` that `choose` returns for each tooth and side.

    The result has the points ``(2, 2 n)`` [mm], vertices at even and edge middles at odd indices. By tooth and side it has the
    half, the vertex number of its tip middle, and the sense (1 or -1) of the vertex numbers from there to the root.
    """
    radii, angles, places, count = [], [], {}, 0
    for tooth in range(gear.z):
        turn, after = 2 * math.pi * tooth / gear.z, (tooth + 1) % gear.z
        right, left = choose(tooth, "loaded"), choose(after, "unloaded")
        radii += [right.radius, [gear.r_f], left.radius[:0:-1]]
        angles += [turn + right.angle, [turn + math.pi / gear.z], turn + 2 * math.pi / gear.z - left.angle[:0:-1]]
        places[tooth, "loaded"] = right, count, 1
        count += (right.radius.size + left.radius.size) // 2
        places[after, "unloaded"] = left, count, -1
    return cartesian(np.concatenate(radii), np.concatenate(angles)), places


def held_circle(gear):
    """Return the held circle, bore or outside of a ring: vertices at even indices, edge middles at odd."""
    size = min(0.35 * abs(gear.r_f - gear.held), 2 * math.pi * gear.held / 16)
    count = max(12, math.ceil(2 * math.pi * gear.held / size))
    angle = np.linspace(0, 2 * math.pi, 2 * count, endpoint=False)
    return cartesian(gear.held, angle)


def inside(loop, points):
    """Whether points ``(2, n)`` lie inside a closed polygon, by the crossings of a ray."""
    (x, y), (end_x, end_y) = loop[:, :, None], np.roll(loop, -1, axis=1)[:, :, None]
    spans = (y > points[1]) != (end_y > points[1])
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = x + (points[1] - y) / (end_y - y) * (end_x - x)
    return (spans & (points[0] < crossing)).sum(axis=0) % 2 == 1


def along(corners, first, last, largest):
    """Return points ``(2, n)`` on the polyline `corners`.

    Edge lengths change from `first` at the start to `last` at the end [mm].
    """
    ends = lengths(corners)
    fine = [(0.0, 0.0, first), (ends[-1], ends[-1], last)]
    places = [spaced(a, b, largest, fine)[1:] for a, b in zip(ends[:-1], ends[1:], strict=True)]
    place = np.concatenate([[0.0], *places])
    return np.array([np.interp(place, ends, row) for row in corners])

"""Transverse section of a whole gear in curved eight-node quads. All boundary nodes lie exactly on the profile.

A tooth with cracks is a separate surface. A line runs from the mouth along the crack to its tip and on to the mirror image of the
mouth (or to the tip of the crack on the other side). The crack is the part of that line that is opened later.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..damage.chip import chip_of
from ..damage.crack import check_apart, check_single, meshed_path, mirrored, start_arc
from ..damage.missing import missing_teeth
from ..tooth.gear import Gear
from ..tooth.profile import cartesian, lengths, turned
from .mesher import quadrangulate
from .outline import spaced
from .tooth_pieces import GROWTH, half_tooth, no_tooth, quarters

# Edge lengths in modules: loaded flanks, their tip corner, their fillets, other fillets, adjacent teeth, all others,
# largest edge along a crack, edge at its tip
SIZES = {"flank": 0.2, "corner": 0.1, "fillet": 0.2, "root": 0.4, "near": 0.5, "far": 1.2, "crack": 0.3, "crack tip": 0.06}
FINER = 1.0, 1.07, 1.15, 1.24, 1.4, 1.6
# Attempts: refinement, largest edge relative to `SIZES`, algorithm of gmsh. An attempt fails if triangles remain or quads fold.
# Algorithm 8 comes last, because its mesh is not always the same.
ATTEMPTS = tuple(
    (finer, most, algorithm) for own in ((5, 6), (8,)) for most in (math.inf, 1.0) for finer in FINER for algorithm in own
)


@dataclass(frozen=True, slots=True)
class Cut:
    """Line that separates a cracked tooth from the body.

    `edges` (3, n) are start, middle and end of its edges from a mouth on. `crack` (n,) is the number of the crack of each edge,
    -1 on the part that stays closed. `depth` (n,) is the distance [mm] of the edge's middle from the mouth along the crack.
    """

    edges: np.ndarray
    crack: np.ndarray
    depth: np.ndarray


@dataclass(frozen=True, slots=True)
class QuadSection:
    """A section in eight-node quads.

    Attributes
    ----------
    points : ndarray, shape (2, n)
        Nodes [mm]: `corners` vertices first, then the middles of edges.
    quads : ndarray, shape (8, m)
        Corners counter-clockwise, then the middles of the edges 01, 12, 23, 30.
    corners : int
    part : ndarray, shape (m,)
        0 for the body, k + 1 for the tooth above `cuts[k]`.
    held : ndarray, shape (3, n)
        Edges on the held circle: start, middle, end.
    flank : dict of int to ndarray, shape (3, n)
        Edges of loaded flanks from root to tip.
    roll : dict of int to ndarray, shape (n + 1,)
        Roll lengths of their ends [mm]; middles are half-way in roll.
    cuts : tuple of Cut
    fillet : dict of int to ndarray, shape (3, n)
        Edges of the fillets below these flanks, from below to the form point; of a cracked tooth from the crack's mouth on.
    """

    gear: Gear
    points: np.ndarray
    quads: np.ndarray
    corners: int
    part: np.ndarray
    held: np.ndarray
    flank: dict
    roll: dict
    cuts: tuple
    fillet: dict


def quad_section(gear, *, loaded=(0,), cracks=(), broken=(), patches=(), refine=1.0, sizes=None):
    """Mesh the section of `gear` with all teeth and the true rim.

    Parameters
    ----------
    gear : Gear
    loaded : sequence of int
        Teeth whose loaded flanks carry or read loads.
    cracks : sequence of Crack
    broken : sequence of (MissingTooth or Chip)
    patches : sequence of (float, float, float), or dict of int to such
        Finer places on the loaded flanks: first arc, last arc, edge length [mm]; of all, or by tooth. Those of the fillet count.
    refine : float
        Divides all edge lengths.
    sizes : dict, optional
        Edge lengths in modules instead of those of `SIZES`.

    Returns
    -------
    QuadSection

    Raises
    ------
    ValueError
        If a tooth is named twice or an edge length is not positive.
    RuntimeError
        If the quads fold.
    """
    size = {name: length * gear.m_n for name, length in (SIZES | (sizes or {})).items()}
    if not all(math.isfinite(value) and value > 0 for value in (refine, *size.values())):
        raise ValueError(f"refine = {refine}, sizes = {sizes}: edge lengths must be positive")
    teeth = [tooth % gear.z for tooth in loaded]
    if not teeth or len(set(teeth)) != len(teeth):
        raise ValueError(f"teeth {sorted(loaded)} are not distinct teeth of a gear of z = {gear.z}: name at least one, each once")
    check_apart(gear, cracks)
    check_single(gear, cracks)
    by_tooth = patches if isinstance(patches, Mapping) else dict.fromkeys(teeth, patches)
    patches = {tooth % gear.z: places for tooth, places in by_tooth.items()}
    for finer, most, algorithm in ATTEMPTS:
        edges = {name: min(value / refine, most * SIZES[name] * gear.m_n) / finer for name, value in size.items()}
        try:
            return _attempt(gear, teeth, (cracks, broken), patches, edges, algorithm)
        except RuntimeError as error:
            failed = error
    raise failed


def _attempt(gear, teeth, damage, patches, size, algorithm):
    draft, damaged, (cracks, broken) = _Draft(), {}, damage
    for number, crack in enumerate(cracks):
        damaged.setdefault(crack.tooth % gear.z, []).append((number, crack))
    mouths = {tooth: _mouths(gear, size, tooth_cracks) for tooth, tooth_cracks in damaged.items()}
    outline, flanks, fillets, marks = _rim(gear, draft, size, teeth, (mouths, broken), patches)
    # At least two quads across the rim are required: one makes a ring's section 0.2 to 0.5 % too stiff.
    rim = abs(gear.r_f - gear.held)
    count = max(8, math.ceil(math.pi * gear.held / min(rim / 2, 3 * size["far"])))
    turn = quarters(np.linspace(0.0, 2 * math.pi, count + 1))
    bore = draft.add(gear.held * np.array([np.sin(turn), np.cos(turn)]), closed=True)
    body, tops, cuts = list(outline), [], []
    for tooth, tooth_cracks in sorted(damaged.items()):
        line, cut = _cut(gear, draft, size, tooth, tooth_cracks, mouths[tooth], marks)
        ends = {draft.lines[i - 1][0]: k for k, i in enumerate(outline)}
        first, last = ends[marks[tooth, "unloaded"]], ends[marks[tooth, "loaded"]]
        above = [outline[i % len(outline)] for i in range(first, last if last > first else last + len(outline))]
        tops.append([above + line])
        body = [i for i in body if i not in set(above)]
        before = outline[first - 1] if outline[first - 1] in body else body[-1]
        at = body.index(before) + 1
        body[at:at] = [-i for i in line[::-1]]
        cuts.append(cut)
    loops = [bore, body] if gear.internal else [body, bore]
    made = quadrangulate(np.array(draft.points).T, np.array(draft.lines), [loops, *tops], algorithm)
    return _finish(gear, draft, made, bore, flanks, fillets, cuts)


class _Draft:
    """Outline under construction: nodes, three-node lines, and exact middles of both halves of each line."""

    def __init__(self):
        self.points, self.lines, self.middles = [], [], {}

    def add(self, points, *, closed=False, first=None, last=None):
        """Add k lines of five points each along `points` ``(2, 4 k + 1)`` and return their numbers, from 1."""
        numbers, end = [], points.shape[1] - 1
        for i in range(0, points.shape[1], 2):
            number = numbers[0] if closed and i == end else {0: first, end: last}.get(i)
            if number is None:
                number = len(self.points)
                self.points.append(points[:, i])
            numbers.append(number)
        for i, pair in enumerate(zip(numbers[:-1], numbers[1:], strict=True)):
            self.middles[tuple(sorted(pair))] = points[:, 2 * i + 1]
        start = len(self.lines)
        self.lines += [numbers[i : i + 3] for i in range(0, len(numbers) - 1, 2)]
        return list(range(start + 1, len(self.lines) + 1))

    def edges(self, lines):
        """Start and end nodes ``(2, 2 n)`` of the half edges of `lines`."""
        nodes = np.array(self.lines)[np.array(lines) - 1]
        return np.stack([nodes[:, :2], nodes[:, 1:]], axis=1).reshape(-1, 2).T


def _mouths(gear, size, found):
    """Return, by side of a cracked tooth, the arc at which the parting line starts and the edge length there [mm]."""
    ends = {crack.side: (start_arc(gear, crack), lengths(meshed_path(gear, crack))[-1]) for _, crack in found}
    mouths = {side: (arc, min(size["fillet"], length / 4)) for side, (arc, length) in ends.items()}
    (only,) = [*mouths.values()][:1]
    return {side: mouths.get(side, (only[0], size["fillet"])) for side in ("unloaded", "loaded")}


def _pieces(gear, owner, side, size, teeth, damage, patches):
    """Return the pieces of the outline of half a tooth."""
    mouths, broken = damage
    if owner in missing_teeth(gear, broken):
        return no_tooth(gear, size)
    away = min(abs((owner - k + gear.z // 2) % gear.z - gear.z // 2) for k in [*teeth, *mouths])
    chip, loaded = chip_of(gear, broken, owner), side == "loaded" and owner in teeth
    cut = chip and (chip.end_roll(gear, side), chip.top(gear, side))
    return half_tooth(gear, size, away, loaded, mouths.get(owner, {}).get(side), patches.get(owner, ()), cut)


def _rim(gear, draft, size, teeth, damage, patches):
    """Return the toothed outline clockwise from the tip of tooth 0: line numbers, loaded flanks, fillets, end nodes of cracks."""
    lines, flanks, fillets, marks, last = [], {}, {}, {}, None
    halves = [half for k in range(gear.z) for half in ((k, "loaded"), ((k + 1) % gear.z, "unloaded"))]
    for owner, side in halves:
        loaded = side == "loaded" and owner in teeth
        pieces = _pieces(gear, owner, side, size, teeth, damage, patches)
        # number of the piece that follows the flank; 1 without a flank
        below = 1 + next((k for k, piece in enumerate(pieces) if piece[0] == "flank"), 0)
        sign = 1 if side == "loaded" else -1
        for k, (name, radius, angle, params) in list(enumerate(pieces))[::sign]:
            final = (owner, side, k) == (0, "unloaded", 0)
            points = cartesian(radius, 2 * math.pi * owner / gear.z + sign * angle)[:, ::sign]
            added = draft.add(points, first=last, last=draft.lines[0][0] if final else None)
            last = draft.lines[added[-1] - 1][2]
            lines += added
            if name == "flank" and loaded:
                flanks[owner] = draft.edges(added)[::-1, ::-1], params[::-2]
            if k == below and loaded:
                fillets[owner] = draft.edges(added)[::-1, ::-1]
            if name == "fillet":
                marks[owner, side] = (draft.lines[added[0] - 1][0], last)[sign > 0]
    return lines, flanks, fillets, marks


def _cut(gear, draft, size, tooth, found, mouths, marks):
    """Return the lines that separate a cracked tooth from the body, from the loaded side on, and their `Cut`."""
    by_side = {crack.side: (number, crack) for number, crack in found}
    legs, ends, spots = {"loaded": [], "unloaded": []}, {}, {}
    for side, (number, crack) in by_side.items():
        places = lengths(path := meshed_path(gear, crack))
        ends[side], spots[side] = path[:, -1], min(size["crack tip"], places[-1] / 8)
        sizes = [mouths[side][1], *[size["crack"]] * (places.size - 2), spots[side]]
        legs[side] = [(path[:, k : k + 2], number, places[k : k + 2], sizes[k : k + 2]) for k in range(places.size - 1)]
    for side in {"loaded", "unloaded"} - set(by_side):
        ends[side], spots[side] = mirrored(gear, found[0][1]), mouths[side][1]
    middle = (np.column_stack([ends["loaded"], ends["unloaded"]]), -1, np.zeros(2), [spots["loaded"], spots["unloaded"]])
    back = [(path[:, ::-1], number, places[::-1], sizes[::-1]) for path, number, places, sizes in legs["unloaded"][::-1]]
    chain, lines, crack, depth, last = [*legs["loaded"], middle, *back], [], [], [], marks[tooth, "loaded"]
    for k, (path, number, places, sizes) in enumerate(chain):
        length = math.dist(*path.T)
        part = quarters(spaced(0.0, length, 2 * size["crack"], [(0, 0, 2 * sizes[0]), (length, length, 2 * sizes[1])], 1, GROWTH))
        points = turned([np.interp(part, [0.0, length], row) for row in path], 2 * math.pi * tooth / gear.z)
        final = marks[tooth, "unloaded"] if k == len(chain) - 1 else None
        new = draft.add(points, first=last, last=final)
        last = draft.lines[new[-1] - 1][2]
        lines += new
        crack += [number] * (part.size // 2)
        depth += np.interp(part[1::2], [0.0, length], places).tolist()
    return lines, Cut(draft.edges(lines), np.array(crack), np.array(depth))


def _finish(gear, draft, made, bore, flanks, fillets, cuts):
    """Compute the middles of all edges, exact on the outline, and check that no quad folds."""
    points, quads, part = made
    arms = points[:, quads[2:]] - points[:, quads[:2]]
    folded = arms[0, 0] * arms[1, 1] - arms[1, 0] * arms[0, 1] < 0
    quads[:, folded] = quads[::-1, folded]
    pairs = np.sort(np.array([quads, np.roll(quads, -1, axis=0)]).reshape(2, -1), axis=0)
    unique, where = np.unique(pairs, axis=1, return_inverse=True)
    lookup = {pair: i for i, pair in enumerate(map(tuple, unique.T.tolist()))}
    middles = points[:, unique].mean(axis=1)
    for pair, place in draft.middles.items():
        middles[:, lookup[pair]] = place
    tips = {int(tip) for cut in cuts for tip in cut.edges[1, np.flatnonzero(np.diff(cut.crack))]}
    for tip in tips:  # Displacements vary with the square root of the distance from the crack tip.
        at = np.flatnonzero((unique == tip).any(axis=0))
        middles[:, at] = 0.75 * points[:, [tip]] + 0.25 * points[:, unique[:, at].sum(axis=0) - tip]
    count = points.shape[1]

    def with_middle(ends):
        between = [count + lookup[tuple(sorted(pair))] for pair in ends.T.tolist()]
        return np.array([ends[0], between, ends[1]])

    made = QuadSection(
        gear, np.hstack([points, middles]), np.vstack([quads, count + where.reshape(4, -1)]), count, part,
        with_middle(draft.edges(bore)), {k: with_middle(ends) for k, (ends, _) in flanks.items()},
        {k: roll for k, (_, roll) in flanks.items()},
        tuple(Cut(with_middle(cut.edges), cut.crack, cut.depth) for cut in cuts),
        {k: with_middle(ends) for k, ends in fillets.items()},
    )  # fmt: skip
    if jacobian(made).min() <= 0:
        raise RuntimeError(f"z = {gear.z}: a quad of the section folds; change refine or the sizes")
    return made


def jacobian(section):
    """Return the area factor ``(points, m)`` of the maps of quads at 3 x 3 Gauss points and near the corners [mm**2]."""
    at = np.array([-0.95, -math.sqrt(0.6), 0.0, math.sqrt(0.6), 0.95])
    x, y = (v.ravel() for v in np.meshgrid(at, at))
    slopes = [
        [sx * (1 + sy * y) * (2 * sx * x + sy * y) / 4, sy * (1 + sx * x) * (2 * sy * y + sx * x) / 4]
        for sx, sy in ((-1, -1), (1, -1), (1, 1), (-1, 1))
    ]
    slopes += [[-x * (1 - y), (x * x - 1) / 2], [(1 - y * y) / 2, -y * (1 + x)]]
    slopes += [[-x * (1 + y), (1 - x * x) / 2], [(y * y - 1) / 2, -y * (1 - x)]]
    change = np.einsum("kdp,ckm->cdpm", np.array(slopes), section.points[:, section.quads])
    return 4 * (change[0, 0] * change[1, 1] - change[0, 1] * change[1, 0])

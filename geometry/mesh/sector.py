"""Pitch sector of a gear, tooth and rim, in a few large curved triangles for high-order methods.

The outline is exact: every boundary edge carries how its curve departs from its chord, by its own parameter.
"""

import math
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from ..damage.crack import check_sector, meshed_path, start_arc
from ..damage.missing import MissingTooth
from ..damage.seam import open_seam
from ..tooth.gear import shortened
from ..tooth.profile import arc_at, cartesian, fillet, fillet_angle, fillet_length, flank, form_point, roll_at_arc, root_curve
from ..tooth.profile import root_half_angle as root_half
from .mesher import triangulate
from .outline import MERGED, inside, spaced
from .triangle import BULGE, ENDS, GAUSS, jacobians

# Edge lengths [m_n]: loaded flank, other flank, tip corner of the loaded flank, form point with a kink, fillet,
# root arc, sides and tip, crack, crack tip
SIZES = {
    "flank": 0.8,
    "back": 0.8,
    "corner": 0.003,
    "kink": 0.03,
    "fillet": 0.5,
    "root": 0.8,
    "side": 0.8,
    "crack": 0.5,
    "crack tip": 0.004,
}
FLAT = 1e-6  # least area relative to the squared longest edge; three points of a straight crack would enclose no area
ON_LINE = 0.05  # Points of a ring lie on the line of a crack within this distance, relative to the ring's radius.
CUT = 0.2  # Vertices of the held edge closer to a given one than this part of half a pitch are left out.
CHECKED = 6  # polynomial order whose quadrature points are used to check the maps
GROWTH = 1.2  # growth of the edge length per length, away from fine places


@dataclass(frozen=True, slots=True)
class Sector:
    """A sector from half a pitch before the tooth's centre-line (`left`) to half a pitch after it (`right`).

    Attributes
    ----------
    points : ndarray, shape (2, n)
        Vertices [mm].
    triangles : ndarray, shape (3, m)
        Counter-clockwise.
    bulge : dict of (int, int) to ndarray, shape (2, k)
        By boundary edge: (curve - chord) / (1 - s**2) [mm] at k Gauss points s in (-1, 1).
    left, right : ndarray
        Vertices of the sides from the held edge to the root.
    held : ndarray
        Vertices on the held edge.
    flank, roll : ndarray
        Vertices of the loaded flank from root to tip and their roll lengths [mm]; edges are linear in the roll.
    faces : tuple of ndarray, shape (2, k)
        Vertices of the two faces (left, right) of each crack from mouth to tip, the tip shared.
    edge_bulges : ndarray, shape (3, 2, k, m)
        Bulges of the local edges of all triangles, zero inside.
    """

    points: np.ndarray
    triangles: np.ndarray
    bulge: dict
    left: np.ndarray
    right: np.ndarray
    held: np.ndarray
    flank: np.ndarray
    roll: np.ndarray
    faces: tuple = ()
    edge_bulges: np.ndarray = field(init=False)

    def __post_init__(self):
        """Bulges by triangle from those by edge."""
        count, values = self.points.shape[1], np.array(list(self.bulge.values()))
        first, second = np.array(list(self.bulge), dtype=np.int64).T
        keys, values = np.append(first * count + second, second * count + first), np.concatenate([values, values[..., ::-1]])
        order = np.argsort(keys)
        wanted = np.array([self.triangles[a].astype(np.int64) * count + self.triangles[b] for a, b in ENDS])
        at = order[np.minimum(np.searchsorted(keys, wanted, sorter=order), keys.size - 1)]
        found = np.where((keys[at] == wanted)[..., None, None], values[at], 0.0)
        out = np.ascontiguousarray(found.transpose(0, 2, 3, 1))
        object.__setattr__(self, "edge_bulges", out)


def sector(gear, cracks=(), *, broken=None, refine=1.0, sizes=None, cuts=()):
    """`Sector` of a gear with the cracks of its tooth, which may be `broken`: a `MissingTooth` or a `Chip`.

    `refine` divides the edge lengths; `sizes` [m_n] replace those of `SIZES`. The held edge has vertices at the angles `cuts`
    [rad] from the centre-line, positive towards the loaded side. ValueError if `refine` is not positive, RuntimeError if no valid
    triangles were found.
    """
    if not (math.isfinite(refine) and refine > 0):
        raise ValueError(f"refine = {refine}, but it divides the edge lengths: give refine > 0, 1 is the default")
    for finer in (1.0, 1.4, 2.0, 2.8):
        made = _attempt((gear, cracks, broken, tuple(cuts)), SIZES | (sizes or {}), refine, finer)
        if made is not None:
            return made
    raise RuntimeError(f"z = {gear.z}: no valid coarse triangles for this tooth; use method = 'fe'")


def _attempt(described, sizes, refine, finer):
    """Return a sector with all edges but those of the sides divided by `finer`, or None if it folds."""
    gear, cracks, broken, cuts = described
    size = {name: length * gear.m_n / refine / (1.0 if name == "side" else finer) for name, length in sizes.items()}
    size["fillet"] = min(size["fillet"], fillet_length(gear) / 2 / finer)
    pieces = _pieces(gear, size, cracks, broken, cuts)
    first = np.cumsum([0, *(params.size - 1 for _, params, _ in pieces)])
    count = first[-1]
    loop = np.hstack([place(params[:-1]) for _, params, place in pieces])
    chains, around = _chains(gear, size, cracks, loop)
    if chains and not inside(loop, np.hstack([line for _, line in chains] + [around])).all():
        return None  # A chord of the outline cuts the crack off, and gmsh would not terminate.
    points, triangles = triangulate([loop], chains, False, around.T)
    twice = _twice_areas(points, triangles)
    if twice.sum() < 0:
        triangles, twice = triangles[[0, 2, 1]], -twice
    longest = np.hypot(*(points[:, triangles] - points[:, triangles[[1, 2, 0]]])).max(axis=0)
    if (twice <= 2 * FLAT * longest**2).any():
        return None
    points, triangles, faces, doubles = _opened(points, triangles, chains, count)
    vertices = {name: np.arange(first[k], first[k + 1] + 1) % count for k, (name, _, _) in enumerate(pieces)}
    left, right = (_apart(side, triangles, doubles) for side in (vertices["left"], vertices["right"][::-1]))
    rolls = next((params for name, params, _ in pieces if name == "flank"), np.zeros(0))
    made = Sector(
        points, triangles, _bulges(pieces, loop, doubles), left, right, vertices["held"],
        vertices.get("flank", np.zeros(0, dtype=int))[::-1], rolls[::-1], tuple(faces),
    )  # fmt: skip
    bulges = made.edge_bulges
    bent = bulges.any(axis=(0, 1, 2))  # The other triangles are straight, so checking their corners is sufficient.
    (xx, xy), (yx, yy) = jacobians(points, triangles[:, bent], bulges[..., bent], CHECKED).transpose(1, 2, 0, 3)
    return made if (xx * yy - xy * yx).min() > 0 else None


def _apart(side, triangles, doubles):
    """Return a side whose corner is a crack's mouth, ending at the crack face of that side."""
    before, corner = side[-2:]
    if corner in doubles and not ((triangles == before).any(axis=0) & (triangles == corner).any(axis=0)).any():
        return np.append(side[:-1], doubles[int(corner)])
    return side


def _twice_areas(points, triangles):
    """Twice the areas of triangles, negative if their corners run clockwise."""
    corner, second, third = points[:, triangles].transpose(1, 0, 2)
    (x, y), (u, v) = second - corner, third - corner
    return x * v - y * u


def _opened(points, triangles, chains, at):
    """Open the cracks: points, triangles, both faces of each crack, and the second node of each mouth by its first."""
    faces, doubles = [], {}
    for i, (start, line) in enumerate(chains):
        if i % 2 == 0:  # Odd chains only guide the mesh ahead of the crack tip.
            chain = np.append(start, at + np.arange(line.shape[1]))
            points, triangles, double = open_seam(points, triangles, chain)
            faces.append(np.array([chain, double]))
            doubles[start] = int(double[0])
        at += line.shape[1]
    return points, triangles, faces, doubles


def _pieces(gear, size, cracks, broken=None, cuts=()):
    """Return the outline clockwise from the lower left corner: name, parameters of the vertices, and points by parameter."""
    pitch = math.pi / gear.z
    marks = {crack.side: start_arc(gear, crack) for crack in cracks}
    tips = [meshed_path(gear, crack)[:, -1] for crack in cracks]
    thick = abs(gear.r_f - gear.held)
    near_bore = [] if gear.internal else [(thick, thick, 0.5 * gear.held)]
    side = gear.r_f - gear.outward * spaced(
        0.0, thick, max(thick / 2, size["side"]), [(0.0, 0.0, size["side"]), *near_bore], 1, 0.7
    )
    side[-1] = gear.held
    inner = 2 * pitch * gear.held
    close = [(at := gear.held * (pitch - math.atan2(*tip)), at, 0.7 * abs(math.hypot(*tip) - gear.held)) for tip in tips]
    bottom = pitch - spaced(0.0, inner, min(inner, max(1.5 * thick, 0.1 * inner)), close, 1, GROWTH) / gear.held
    bottom[-1] = -pitch
    for cut in cuts:
        near = np.abs(bottom - cut) < CUT * pitch
        near[[0, -1]] = False
        bottom = np.sort(np.append(bottom[~near], cut))[::-1]
    out = [("left", side[::-1], lambda r: cartesian(r, -pitch))]
    ends = [("right", side, lambda r: cartesian(r, pitch)), ("held", bottom, lambda a: cartesian(gear.held, a))]
    if isinstance(broken, MissingTooth):
        count = max(4, math.ceil(2 * pitch * gear.r_f / size["root"]))
        return [*out, ("root", np.linspace(-pitch, pitch, count + 1), lambda a: cartesian(gear.r_f, a)), *ends]
    roots = {name: _roots(gear, size, marks.get(name), tips, name) for name in ("unloaded", "loaded")}
    ends_at = {side: gear if broken is None else shortened(gear, broken.end_roll(gear, side)) for side in roots}
    width = gear.half_thickness(gear.r_a) * gear.r_a
    back = _flank(ends_at["unloaded"], size["back"], size["kink"], max(2 * width, size["corner"]))
    front = _flank(ends_at["loaded"], size["flank"], size["kink"], size["corner"])
    tip = spaced(-width, width, size["root"], [(width, width, min(size["corner"], width))], 1, GROWTH) / gear.r_a
    top = _broken_top(gear, size, broken) if broken else [("tip", tip, lambda a: cartesian(gear.r_a, a))]
    for name, sign in (("unloaded", -1), ("loaded", 1)):
        arc, phi = roots[name]
        part = [
            ("root", arc[::-1], lambda a, sign=sign: cartesian(gear.r_f, sign * a)),
            ("fillet", phi, lambda p, sign=sign: cartesian(*fillet(gear, p)) * np.reshape([sign, 1], (2,) + (1,) * np.ndim(p))),
        ]
        part = [piece for piece in part if piece[1].size > 1]
        if sign < 0:
            out += [*part, ("back", back, lambda r: _flank_points(gear, r, -1)), *top]
        else:
            out.append(("flank", front[::-1], lambda r: _flank_points(gear, r, 1)))
            out += [(kind, params[::-1], place) for kind, params, place in part[::-1]]
    return out + ends


def _broken_top(gear, size, chip):
    """Pieces of a chipped tip from the unloaded flank to the loaded one."""
    out = []
    for side, sign in (("unloaded", -1), ("loaded", 1)):
        pieces = chip.top(gear, side)
        for k, (length, place) in enumerate(pieces[::sign]):
            corner = [(length, length, min(size["corner"], length))] if sign > 0 and k == len(pieces) - 1 else []
            at = spaced(0.0, length, size["root"], corner, 1, GROWTH) / length
            out.append(("tip", at if sign > 0 else at[::-1], partial(_mirrored, place, sign)))
    return out


def _mirrored(place, sign, at):
    points = place(at)
    return points * np.reshape([sign, 1], (2,) + (1,) * (points.ndim - 1))


def _flank_points(gear, roll, sign):
    radius, angle = flank(gear, roll)
    return cartesian(radius, sign * angle)


def _flank(gear, size, kink, corner):
    """Roll lengths of flank vertices from root to tip."""
    start, stop = arc_at(gear, gear.roll_f), arc_at(gear, gear.roll_a)
    kinked = not gear.internal and form_point(gear)[0] > gear.alpha_n + 1e-6
    fine = [(stop, stop, corner), *([(start, start, kink)] if kinked else [])]
    rolls = roll_at_arc(gear, spaced(start, stop, min(size, (stop - start) / 3), fine, 1, GROWTH))
    rolls[[0, -1]] = gear.roll_f, gear.roll_a
    return rolls


def _roots(gear, size, mark, tips, side):
    """Angles of the root arc's vertices from fillet to sector side, and rack tip angles of the fillet's from root to flank."""
    below, top = -gear.r_f * (math.pi / gear.z - root_half(gear)), fillet_length(gear)
    fine, largest = [], size["fillet"]
    arcs = np.linspace(below, top, 200)
    sign = 1 if side == "loaded" else -1
    for tip in tips:
        away = np.hypot(*(cartesian(*root_curve(gear, arcs)) * [[sign], [1]] - tip[:, None]))
        near = arcs[np.argmin(away)]
        fine.append((near, near, 0.7 * away.min()))
    if mark is not None:
        fine.append((mark, mark, min(size["crack"], size["fillet"] / 2)))
    cuts = [0.0, *([mark] if mark is not None and mark > 1e-6 * top else []), top]
    parts = [spaced(a, b, largest, fine, 1, GROWTH) for a, b in zip(cuts[:-1], cuts[1:], strict=True)]
    fillet_arc = np.concatenate([parts[0], *[part[1:] for part in parts[1:]]])
    phi = fillet_angle(gear, fillet_arc)
    root = np.array([0.0])
    if -below > MERGED * gear.m_n:
        root = spaced(below, 0.0, size["root"], [*fine, (0.0, 0.0, largest)], 1, GROWTH)[::-1]
    return root_half(gear) - root / gear.r_f, phi


def _chains(gear, size, cracks, loop):
    """For each crack the rim vertex it starts at with its further vertices, then its tip with those of a line ahead of it.

    Also returns points ``(2, n)`` around tips and kinks, in rings as wide as the edges there.
    """
    out, around, at = [], [np.zeros((2, 0))], loop.shape[1]
    part = np.arange(10) / 10
    rim = (loop[..., None] + (np.roll(loop, -1, axis=1) - loop)[..., None] * part).reshape(2, -1)
    for crack in cracks:
        corners = meshed_path(gear, crack)
        if crack.path is not None:
            check_sector(gear, crack)
        start = int(np.argmin(np.hypot(*(loop - corners[:, :1]))))
        legs = np.hypot(*np.diff(corners, axis=1))
        ends = np.concatenate([[0.0], np.cumsum(legs)])
        tip_size, largest = min(size["crack tip"], legs[-1] / 20), min(size["crack"], ends[-1] / 2)
        fine = [(ends[-1], ends[-1], tip_size)] + [(end, end, 5 * tip_size) for end in ends[1:-1]]
        places = np.concatenate(
            [spaced(a, b, largest, fine, 1, 1.5 * GROWTH)[1:] for a, b in zip(ends[:-1], ends[1:], strict=True)]
        )
        line = np.array([np.interp(places, ends, row) for row in corners])
        reach = min(size["crack"], 0.4 * np.hypot(*(rim - corners[:, -1:])).min())
        ahead = (corners[:, -1] - corners[:, -2]) / legs[-1]
        further = spaced(0.0, reach, reach, [(0.0, 0.0, tip_size)], 1, 1.5 * GROWTH)[1:]
        on_line = corners[:, -1:] + ahead[:, None] * further
        out += [(start, line), (at + line.shape[1] - 1, on_line)]
        at += line.shape[1] + further.size
        taken = np.hstack([rim, line, on_line])
        lines = np.column_stack([corners[:, :-1], corners[:, -1]]), np.column_stack([corners[:, 1:], on_line[:, -1]])
        around.append(_rings(corners[:, -1], further, taken, lines))
        for k in range(1, corners.shape[1] - 1):
            radii = places[places > ends[k] + 1e-9] - ends[k]
            around.append(_rings(corners[:, k], radii[radii <= min(size["crack"], 0.4 * min(legs[k - 1 : k + 1]))], taken, lines))
    return out, np.hstack(around)


def _rings(centre, radii, taken, lines):
    """Six points on each ring about `centre`, those left out that are closer to taken ones than half the ring's radius.

    Also those on `lines` (starts ``(2, n)``, ends), between their vertices: with them they would make triangles of no area.
    """
    angle = np.arange(6) * math.pi / 3
    points = centre[:, None, None] + radii[:, None] * np.array([np.sin(angle), np.cos(angle)])[:, None, :]
    away = np.hypot(*(points[..., None] - taken[:, None, None, :])).min(axis=-1)
    start, along = lines[0][:, None, None, :], (lines[1] - lines[0])[:, None, None, :]
    arm = points[..., None] - start
    part = np.clip((arm * along).sum(axis=0) / (along**2).sum(axis=0), 0.0, 1.0)
    beside = np.hypot(*(arm - part * along)).min(axis=-1)
    return points[:, (away > 0.55 * radii[:, None]) & (beside > ON_LINE * radii[:, None])]


def _bulges(pieces, loop, doubles):
    """Return the deviation of boundary edges from their chords; edges at a crack's mouth under both numbers of the mouth."""
    gauss, count = GAUSS[0], loop.shape[1]
    low, high = (np.concatenate([params[part] for _, params, _ in pieces]) for part in (slice(-1), slice(1, None)))
    inner = (high + low)[:, None] / 2 + (high - low)[:, None] / 2 * gauss
    parts = np.split(inner, np.cumsum([params.size - 1 for _, params, _ in pieces])[:-1])
    curve = np.hstack([place(part.ravel()) for (_, _, place), part in zip(pieces, parts, strict=True)]).reshape(2, -1, BULGE)
    after = np.roll(np.arange(count), -1)
    chord = (loop[..., None] * (1 - gauss) + loop[:, after, None] * (1 + gauss)) / 2
    away = ((curve - chord) / (1 - gauss**2)).transpose(1, 0, 2)
    out = dict(zip(zip(range(count), after.tolist(), strict=True), away, strict=True))
    for a, b in [edge for edge in out if doubles and not doubles.keys().isdisjoint(edge)]:
        out |= {(p, q): out[a, b] for p in {a, doubles.get(a, a)} for q in {b, doubles.get(b, b)}}
    return out

"""Outline of one sector of a gear for `sector`: root, fillets, flanks, tip and held side, with vertices."""

import math
from functools import partial

import numpy as np

from ..damage.crack import meshed_path, start_arc
from ..damage.missing import MissingTooth
from ..tooth.gear import shortened
from ..tooth.profile import (
    cartesian,
    fillet,
    fillet_angle,
    fillet_length,
    flank,
    flank_arcs,
    form_point,
    roll_at_arc,
    root_curve,
)
from ..tooth.profile import root_half_angle as root_half
from .outline import MERGED, spaced

CUT = 0.2  # Vertices of the held edge closer to a given one than this part of half a pitch are left out.
GROWTH = 1.2  # growth of the edge length per length, away from fine places


def outline_pieces(gear, size, cracks, broken=None, cuts=(), radii=()):
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
    side = gear.outward * _with_cuts(gear.outward * side, gear.outward * np.array(radii), CUT * size["side"])
    inner = 2 * pitch * gear.held
    close = [(at := gear.held * (pitch - math.atan2(*tip)), at, 0.7 * abs(math.hypot(*tip) - gear.held)) for tip in tips]
    bottom = pitch - spaced(0.0, inner, min(inner, max(1.5 * thick, 0.1 * inner)), close, 1, GROWTH) / gear.held
    bottom[-1] = -pitch
    bottom = _with_cuts(bottom, cuts, CUT * pitch)
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


def _with_cuts(places, cuts, apart):
    """Return falling numbers that include `cuts`, without inner numbers closer to them than `apart`."""
    near = (np.abs(places[:, None] - np.array(cuts)) < apart).any(axis=1)
    near[[0, -1]] = False
    return np.sort(np.append(places[~near], cuts))[::-1]


def _broken_top(gear, size, chip):
    """Return the pieces of a chipped tip from the unloaded to the loaded flank."""
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
    """Return the roll lengths of flank vertices from root to tip."""
    start, stop = flank_arcs(gear)
    kinked = not gear.internal and form_point(gear)[0] > gear.alpha_n + 1e-6
    fine = [(stop, stop, corner), *([(start, start, kink)] if kinked else [])]
    rolls = roll_at_arc(gear, spaced(start, stop, min(size, (stop - start) / 3), fine, 1, GROWTH))
    rolls[[0, -1]] = gear.roll_f, gear.roll_a
    return rolls


def _roots(gear, size, mark, tips, side):
    """Return angles of the root arc's vertices from fillet to side, and rack tip angles of the fillet's from root to flank."""
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

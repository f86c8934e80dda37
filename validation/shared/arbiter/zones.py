"""Zones in which outlines may be in contact: position, width, and hat function pressures.

The hat functions are on the gear whose corners are further away, because its outline is smooth there and gives the normals. A
zone extends to the places at which the gap exceeds its minimum by ``2 f / (pi E*)``, the end of a Hertzian pressure of f
[N/mm]. Around corners and joints hat functions are finer.
"""

from dataclasses import dataclass, replace

import numpy as np

from .side import Posed

HATS = 5.0  # hat functions per smaller half width of a zone, at refine 1
WIDER = 1.5  # half width of a zone over the estimated half width of contact
CORNER, JOINT, SMALLEST = 12.0, 3.0, 300.0  # refinement factors at corners and at joints; largest factor relative to a half width
GRADE = 0.35  # growth of hat function lengths with the distance from refined points
STILL = np.zeros((2, 2))
GAUSS, WEIGHT = np.polynomial.legendre.leggauss(4)


@dataclass
class Zone:
    """Zone in which tooth pair `order` may touch at phase number `phase`.

    `own`: gear with the hat functions; `s` (n,): their places on its side; `met` (n,): those opposite on the other, nan where
    there is nothing; `middle`, `near`: the place of first touch on both; `force`: estimated [N/mm]; `shift` (2, 2): by how much
    both outlines have moved there elastically (gear; x, y) [mm], so that curved outlines are met where they really are.
    """

    phase: int
    order: int
    own: int
    s: np.ndarray
    met: np.ndarray
    middle: float
    near: float
    force: float
    shift: np.ndarray


class Contact:
    """Geometry of both sides of a pair in a pose, for the zones."""

    def __init__(self, press, sides):
        self.press, self.sides = press, sides

    def posed(self, gear, stand, approach, shift=STILL):
        """Return the side of `gear` for the single tooth pair of `stand`, after an approach and elastic shifts of both gears."""
        press = self.press
        turn = float((stand.turn_1, stand.turn_2)[gear][0]) + press.rates[gear] * approach
        behind = float(press.outlines[gear].pitch(stand.tooth)[0])
        return Posed(self.sides[gear], turn, press.centres[gear], press.mirror[gear], behind, shift[gear])

    def gaps(self, zone_own, stand, approach, s, near, reach, shift=STILL):
        """Return gaps ``(n,)`` along the normals of gear `zone_own` at `s`, opposite positions, points and normals."""
        own, other = (self.posed(gear, stand, approach, shift) for gear in (zone_own, 1 - zone_own))
        points, normals = own.points(s), own.normals(s)
        gap, met = other.opposite(points, normals, near, reach)
        return gap, met, points, normals

    def corners(self, gear):
        """Return the places of convex corners of a side."""
        radii = self.press.outlines[gear].corners
        return self.sides[gear].at_radius(np.array(radii)) if radii else np.array([])


def found(contact, pose, key, approach, shares, modulus, refine):
    """Return the zones of a tooth pair for an estimated approach.

    `pose` has the pose and the touch of that pair alone, `key` its phase number and its own number. `shares(gap)` estimates the
    force [N/mm] of a place that touches at `gap`. `modulus` is E* of both gears.
    """
    (stand, touch), places = pose, []
    m = contact.press.outlines[0].gear.m_n
    for i in np.argsort(touch.approach[:, 0]):
        if not touch.approach[i, 0] < approach:
            break
        own = int(touch.gear[i])
        if _slides(contact.press.outlines[own].pieces, touch, i):
            continue
        s_own = float(contact.sides[own].arc(touch.piece[i], touch.at[i, 0]))
        s_met = float(contact.sides[1 - own].at_radius(touch.met[i, 0]))
        s = (s_own, s_met) if own == 0 else (s_met, s_own)
        if all(abs(s[0] - other[0][0]) > 0.15 * m or abs(s[1] - other[0][1]) > 0.15 * m for other in places):
            places.append((s, float(touch.approach[i, 0])))
    zones = []
    for s, gap in places:
        away = [np.abs(contact.corners(gear) - s[gear]).min(initial=np.inf) for gear in (0, 1)]
        own = int(away[1] > away[0])
        force = shares(gap)
        rise = 2 * force / (np.pi * modulus)
        distance = np.concatenate([[0.0], np.geomspace(1e-5, 0.5, 90)]) * m
        widths = []
        for side in (-1, 1):
            at = s[own] + side * distance
            at = at[(at >= 0) & (at <= contact.sides[own].joints[-1])]
            here, *_ = contact.gaps(own, stand, gap, at, s[1 - own], 1.5 * m)
            over = np.flatnonzero(~(here < rise))
            over = over[over > 0]
            widths.append(distance[over[0]] if over.size else distance[at.size - 1])
        ends = s[own] - WIDER * widths[0], s[own] + WIDER * widths[1]
        blank = Zone(*key, own, None, None, s[own], s[1 - own], force, STILL)
        zones.append(placed(contact, stand, blank, gap, ends, min(widths), refine))
    return zones


def _slides(pieces, touch, i):
    """Return whether a contact at the end of a curve continues one on the next curve of the outline."""
    number, at = int(touch.piece[i]), touch.at[i, 0]
    low, high, _ = pieces[number]
    for end, other in ((low, number - 1), (high, number + 1)):
        beside = np.flatnonzero((touch.gear == touch.gear[i]) & (touch.piece == other))
        if abs(at - end) < 2e-3 * abs(high - low) and beside.size and touch.approach[beside[0], 0] < touch.approach[i, 0]:
            return True
    return False


def placed(contact, stand, zone, approach, ends, width, refine):
    """Return a `Zone` with hat functions between two ends, of ``width / HATS`` and finer ones at corners and joints.

    `zone` has its position, force and shift.
    """
    own, near, reach = zone.own, zone.near, 1.5 * contact.press.outlines[0].gear.m_n
    side = contact.sides[own]
    low, high = max(ends[0], 1e-6), min(ends[1], side.joints[-1] - 1e-6)
    coarse = max(high - low, 1e-9) / 2 / WIDER / HATS / refine
    fine = max(width / HATS / refine, coarse / SMALLEST)
    foci = [(min(max(zone.middle, low), high), fine)]
    sample = np.linspace(low, high, 801)
    _, met, *_ = contact.gaps(own, stand, approach, sample, near, reach, zone.shift)
    for gear in (own, 1 - own):
        corners = contact.corners(gear)
        for joint in contact.sides[gear].joints[1:-1]:
            at = joint
            if gear != own:
                good = np.isfinite(met)
                if good.sum() < 2 or not met[good].min() < joint < met[good].max():
                    continue
                rank = np.argsort(met[good])
                at = float(np.interp(joint, met[good][rank], sample[good][rank]))
            if low < at < high:
                sharp = bool(corners.size) and np.abs(corners - joint).min() < 1e-6
                foci.append((at, max(coarse / (CORNER if sharp else JOINT), coarse / SMALLEST)))
    s_j = graded(low, high, foci, coarse)
    _, opposite, *_ = contact.gaps(own, stand, approach, s_j, near, reach, zone.shift)
    return replace(zone, s=s_j, met=opposite)


def graded(low, high, foci, coarse):
    """Nodes between two ends, as fine as the `foci` (place, size) ask for, at most `coarse` apart."""
    spread = np.concatenate([at + x * fine * 1.3 ** np.arange(60) for at, fine in foci for x in (1, -1)])
    s = np.unique(np.concatenate([np.linspace(low, high, 400), spread[(spread > low) & (spread < high)], [at for at, _ in foci]]))
    size = np.min([fine + GRADE * np.abs(s - at) for at, fine in foci] + [np.full(s.size, coarse)], axis=0)
    total = np.concatenate([[0.0], np.cumsum(np.diff(s) * (1 / size[1:] + 1 / size[:-1]) / 2)])
    nodes = np.interp(np.linspace(0, total[-1], max(6, int(np.ceil(total[-1])) + 1)), total, s)
    for at, _ in foci[1:]:  # Corners and joints must be nodes.
        nearest = int(np.argmin(np.abs(nodes - at)))
        if 0 < nearest < nodes.size - 1:
            nodes[nearest] = at
    return nodes


def hats(s):
    """Return Gauss points ``(q,)`` between nodes `s`, and weights ``(q, n)`` of hat functions with unit resultant."""
    step = np.diff(s)
    places = (s[:-1, None] + step[:, None] * (GAUSS + 1) / 2).ravel()
    weights, at = np.zeros((step.size, GAUSS.size, s.size)), np.arange(step.size)
    for node, sign in ((at, -1), (at + 1, 1)):
        weights[at, :, node] = (WEIGHT / 2 * (1 + sign * GAUSS) / 2) * step[:, None]
    weights = weights.reshape(places.size, -1)
    return places, weights / weights.sum(axis=0)

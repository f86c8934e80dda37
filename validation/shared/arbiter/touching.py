"""First contact of two rigid outlines when both gears rotate towards each other by the same approach.

Points of either outline move with their gear. The secant method finds the approach at which each point lies on the other outline,
from the two curves and rotations only. The smallest approach is the gap of the tooth pair. It is negative if the outlines overlap
in the given pose. An approach delta rotates the pinion forward by ``delta / (2 r_b1)`` and the wheel
backward by ``delta / (2 r_b2)``.
"""

from dataclasses import dataclass

import numpy as np

COARSE, FINE, ZOOMS = 49, 9, 4  # sample points per segment, then per refinement around the first contact; number of refinements
STEPS = 6  # limit of secant steps
SETTLED = 1e-10  # tolerance of the approach [mm]
FAR = 0.15  # largest approach that is searched [m_n]


@dataclass
class Stand:
    """Tooth pairs in their unloaded poses: angles [rad] of the tooth centre-lines and numbers of both teeth, arrays ``(n,)``."""

    turn_1: np.ndarray
    turn_2: np.ndarray
    tooth: np.ndarray

    def __getitem__(self, at):
        return Stand(self.turn_1[at], self.turn_2[at], self.tooth[at])


@dataclass
class FirstTouch:
    """First contact of points on one curve with the other outline, arrays ``(pieces, n)``.

    `approach` [mm], inf where they never do; `own`, `met`: radii about the point's own and the other centre [mm];
    `gear` (pieces,) 0 or 1: whose points, `piece` their piece, `at` its parameter.
    """

    approach: np.ndarray
    own: np.ndarray
    met: np.ndarray
    gear: np.ndarray
    piece: np.ndarray
    at: np.ndarray

    @property
    def gap(self):
        """Least approach of every tooth pair [mm], ``(n,)``."""
        return self.approach.min(axis=0)


def stand(pair, phase, order):
    """Return the poses of tooth pairs `order` (numbers of `gearfe.geometry.pair.contacts`) at `phase`."""
    phase, order = np.broadcast_arrays(np.asarray(phase, dtype=float), np.asarray(order))
    nominal = pair.path[0] + (phase + order) * pair.p_bt
    turn_1, turn_2 = pair.turn(nominal)
    return Stand(np.asarray(turn_1), np.asarray(turn_2), order)


class Press:
    """Contact of two gear outlines at the centre distance of a pair: positions of their points after an approach."""

    def __init__(self, pair, outlines):
        self.pair, self.outlines = pair, outlines
        self.centres, self.mirror = (0.0, pair.centre_2), (1, pair.outward)
        self.rates = 1 / (2 * outlines[0].r_b), pair.outward / (2 * outlines[1].r_b)  # clockwise rotation per approach [rad/mm]

    def placed(self, own, stand, radius, angle, approach):
        """Return points (x, y) of gear `own` [mm] after an approach."""
        turn, pitch = self._turned(own, stand, radius)
        turned = turn + self.mirror[own] * (angle - pitch) + self.rates[own] * approach
        return radius * np.sin(turned), radius * np.cos(turned) + self.centres[own]

    def seen(self, own, stand, x, y, approach):
        """Return radius and angle of points after an approach, in the frame of a tooth of gear `own`."""
        turn, pitch = self._turned(own, stand, x)
        y = y - self.centres[own]
        angle = self.mirror[own] * (np.arctan2(x, y) - turn - self.rates[own] * approach)
        angle = (angle + np.pi) % (2 * np.pi) - np.pi
        return np.hypot(x, y), angle + pitch

    def _turned(self, own, stand, values):
        """Return the angles of tooth centre-lines including pitch deviations [rad], with the axes of `values`."""
        turn = (stand.turn_1, stand.turn_2)[own]
        shape = turn.shape + (1,) * (np.ndim(values) - turn.ndim)
        return turn.reshape(shape), self.outlines[own].pitch(stand.tooth).reshape(shape)

    def outside(self, own, stand, radius, angle, approach):
        """Return the angle of points of gear `own` outside the other outline, and their radius about the other centre."""
        away, seen = self.seen(1 - own, stand, *self.placed(own, stand, radius, angle, approach), approach)
        return seen - self.outlines[1 - own].half(away), away

    def approach(self, own, stand, radius, angle, steps=STEPS):
        """Return the approach at which points ``(n, m)`` of gear `own` touch the other outline [mm], and the radius there.

        The approach is inf for points that never touch.
        """
        mate = self.outlines[1 - own]
        before = np.zeros(np.broadcast_shapes(np.shape(radius), (stand.turn_1.size, 1)))
        was, away = self.outside(own, stand, radius, angle, before)
        here = was * mate.r_b
        limit = FAR * mate.gear.m_n
        here = np.clip(here, -limit, limit)
        for _ in range(steps):
            value, away = self.outside(own, stand, radius, angle, here)
            rise = value - was
            step = -value * np.divide(here - before, rise, out=np.zeros_like(rise), where=np.abs(rise) > 0)
            before, was = here, value
            here = np.clip(here + step, -2 * limit, 2 * limit)
            if not (np.abs(step) > SETTLED).any():
                break
        on = (away - mate.r_f) * (away - mate.r_a) <= 1e-9 * mate.r_a
        good = on & (np.abs(step) < 1e-7) & (np.abs(here) < limit)
        return np.where(good, here, np.inf), away


def touching(press, stand):
    """Return the first touches of all curves of both outlines for tooth pairs in their poses (`FirstTouch`)."""
    found = []
    for own in (0, 1):
        for number, (low, high, place) in enumerate(press.outlines[own].pieces):
            found.append((*_first(press, own, stand, low, high, place), own, number))
    values, radii, met, at, own, number = zip(*found, strict=True)
    return FirstTouch(np.array(values), np.array(radii), np.array(met), np.array(own), np.array(number), np.array(at))


def _first(press, own, stand, low, high, place):
    """Return approach, own radius, radius on the mate and parameter ``(n,)`` of the first point of a curve to touch."""
    shape = stand.turn_1.size
    value, radius, met, at = (np.full(shape, fill) for fill in (np.inf, 1.0, 1.0, low))
    t = np.linspace(low, high, COARSE)
    coarse, _ = press.approach(own, stand, *(part[None, :] for part in place(t)), steps=3)
    best = np.argmin(coarse, axis=1)
    rows = np.flatnonzero(np.isfinite(coarse[np.arange(shape), best]))
    if not rows.size:
        return value, radius, met, at
    some, best = stand[rows], best[rows]
    first, last = t[np.maximum(best - 1, 0)], t[np.minimum(best + 1, COARSE - 1)]
    for _ in range(ZOOMS):
        places = first[:, None] + (last - first)[:, None] * np.linspace(0, 1, FINE)
        own_radius, angle = place(places)
        values, away = press.approach(own, some, own_radius, angle)
        best, there = np.argmin(values, axis=1), np.arange(rows.size)
        first, last = places[there, np.maximum(best - 1, 0)], places[there, np.minimum(best + 1, FINE - 1)]
    value[rows], radius[rows] = values[there, best], own_radius[there, best]
    met[rows], at[rows] = away[there, best], places[there, best]
    return value, radius, met, at


def orders(pair, phase):
    """Return the numbers of tooth pairs that may approach each other at `phase`, up to three base pitches off the path."""
    reach = 5 if pair.gear_2.internal else 3
    reach = min(reach, pair.gear_1.z // 2)
    return np.arange(-reach - int(np.floor(phase)), int(np.ceil(pair.eps_alpha)) + reach - int(np.floor(phase)))

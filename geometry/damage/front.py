"""Front of a crack whose depth changes along the width, for meshes that follow the front.

A mesh cannot follow a front to zero depth. Where the depth decreases to zero, the mesh stops at a least depth, and the crack
ends a little further on.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
import scipy

from .crack import Crack
from .crack_form import SLACK, deepest, extremes, front

# Least depths that a mesh resolves where the crack front runs out, relative to the largest depth. They are tried in order.
LEAST = 0.1, 0.15, 0.2, 0.25
# A front that runs out ends at this part of the least depth. The integral of depth**2 dz is then unchanged for a straight
# front.
END = 2 / 3
STEEP = 3.0  # largest growth factor of the front's depth over one layer of elements
SAMPLES = 801  # initial number of heights at which the front is sampled


def open_part(crack, b, z):
    """Return the open part of a crack's length at heights `z` [mm] of a face of width `b` [mm].

    It is 0 beyond the ends of the crack.
    """
    low, high = crack.width or (0.0, b)
    return np.where((z >= low) & (z <= high), front(crack, b, z)[0], 0.0)


def shallowest(crack):
    """Return the least depth between the ends of a crack over its largest depth, or 0 if the depth decreases to zero."""
    low, high = (max(value, 0.0) for value in extremes(crack))
    part = low / high if low > SLACK else 0.0
    return math.sqrt(part) if crack.rounded else part


def whole(crack):
    """Return the crack in a section through its deepest place, open over the whole width.

    ValueError if it has a bend, and another depth than that of its full length.
    """
    part, even = deepest(crack), replace(crack, width=None, ends=(1.0, 1.0), rounded=False)
    if part == 1 and crack.even:
        return even
    if crack.bends:
        raise ValueError(
            f"turning crack of level {crack.level} over parts {crack.ends} of its length: only straight cracks change their "
            "depth along the width; give turning = False, or ends = (1, 1)"
        )
    return even if part == 1 else shallower(even, part)


def shallower(crack, part):
    """Return the crack shortened to a `part` of its length."""
    return replace(crack, **({"length": part * crack.length} if crack.level is None else {"level": part * crack.level}))


def crack_in_band(crack, b, first, last):
    """Return the part of a crack in a band of the face width `b` [mm], or None if it is closed there.

    Heights in the band are counted from its end at z = `first` to that at z = `last` [mm]; `first` may be the higher one.
    """
    if crack.through:
        return crack
    low, high = crack.width or (0.0, b)
    low, high = max(low, min(first, last)), min(high, max(first, last))
    ends = crack.ends
    if (low, high) != (crack.width or (0.0, b)):
        ends = tuple(open_part(crack, b, np.linspace(low, high, len(ends))).tolist())
    if not (low < high and max(ends) > 0):
        return None
    width, band = (low - first, high - first), abs(last - first)
    if last < first:
        width, ends = (first - high, first - low), ends[::-1]
    whole = width[0] <= 1e-9 * band and width[1] >= (1 - 1e-9) * band
    return replace(crack, width=None if whole else width, ends=ends)


@dataclass(frozen=True, slots=True)
class Front:
    """Front of a crack that a mesh follows.

    `width` is the face width [mm]. `least` is the smallest depth that the mesh follows, relative to the largest depth.
    """

    crack: Crack
    width: float
    least: float

    @property
    def ends(self):
        """Return the stated end heights of the crack [mm]."""
        return self.crack.width or (0.0, self.width)

    def depth(self, z):
        """Return the depth at heights `z` [mm] relative to the largest depth, at least `least`, and its slope [1/mm]."""
        part, slope = front(self.crack, self.width, z)
        top = deepest(self.crack)
        deep = part > self.least * top
        return np.where(deep, part / top, self.least), np.where(deep, slope / top, 0.0)

    def kinks(self):
        """Heights at which the followed depth has a kink [mm]."""
        return (*self.ends, *self.crossings(self.least))

    def open(self):
        """Return the intervals of the width in which the crack is open: ``((low, high), ...)`` [mm]."""
        places = [self.ends[0], *self.crossings(END * self.least), self.ends[1]]
        middles = (np.array(places[1:]) + places[:-1]) / 2
        deep = front(self.crack, self.width, middles)[0] > END * self.least * deepest(self.crack)
        return tuple((a, b) for a, b, inside in zip(places[:-1], places[1:], deep, strict=True) if inside)

    def runs_out(self, end):
        """Whether the crack depth decreases to zero towards the height `end`, rather than ending at a finite depth."""
        return end not in self.ends

    def steep(self):
        """Return the heights with the depth `least`, those with `STEEP` times that depth, and their distances [mm]."""
        deeper = self.crossings(STEEP * self.least)
        return [(z, z, min(abs(z - other) for other in deeper)) for z in self.crossings(self.least) if deeper]

    @property
    def sharp(self):
        """Whether the depth over the width is not a second-degree polynomial."""
        return self.crack.rounded or self.crack.width is not None or len(self.kinks()) > 2

    def crossings(self, part):
        """Heights [mm] between the crack ends at which the depth is a `part` of the largest depth."""
        z = np.linspace(*self.ends, SAMPLES)
        over, near = self._over(z, part) > 0, 1e-12 * self.width
        return [
            scipy.optimize.brentq(self._over, z[k], z[k + 1], args=(part,), xtol=near)
            for k in np.flatnonzero(over[1:] != over[:-1])
        ]

    def _over(self, z, part):
        return front(self.crack, self.width, z)[0] - part * deepest(self.crack)

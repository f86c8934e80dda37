"""What a tip corner adds to the local law of a contact line, taken from the plane section.

Close to its tip corner a tooth is a wedge, no half-space, and pressure ends at the corner. The plane resolves that contact hat
by hat (`gearfe.contact.plane`); how much more it closes there than Hertz's strip on a half-plane would, at the same line load and
place, is a property of the section: a few tenths of a millimetre across, whatever the load does along the width. Contact in three
dimensions adds it to the logarithm of its strips, so that in the plane limit both are the same contact. For helical teeth the
transverse section is taken for the normal one: widths and loads there differ by cos(beta_b).
"""

import math
from functools import partial

import numpy as np
from scipy.interpolate import RectBivariateSpline

from geometry.tooth.profile import arc_at

from ..energy.ritz.plane import flexibility
from ..energy.ritz.plane_strain import plane_hats
from ..flexibility.hertz import contact_modulus, half_plane, half_width
from ..flexibility.solid import carry
from ..flexibility.solved import solved_gears
from .plane import CORNER, RESOLVED, PairContact
from .sharing import approaches, stacked

LOADS = 2.0 ** np.arange(-9, 5)  # line loads of the table, of the even one
PLACES = 13  # abscissae of the table at each end of the path


class CornerLaw:
    """How much softer corners are than half-planes, at both ends of the path.

    Parameters
    ----------
    pair : GearPair
    materials : (Material, Material)
    line_load : float
        Even load [N/mm] of the width.
    further : (float, float)
        How far before the start and after the end of the path contact is looked for [mm].
    cache : bool or SolvedGears
        Where to look for what was solved before, see `gearfe.flexibility.solved.solved_gears`.
    """

    def __init__(self, pair, materials, line_load, further, *, cache=True):
        modulus = contact_modulus(materials)
        radius = [abs(float(pair.relative_radius(nominal, pair.mate_roll(nominal)))) for nominal in pair.path]
        # the same rule as in the plane: contacts of the whole load less than so many half widths from the corner
        self.inside = [CORNER * float(half_width(line_load, r, modulus)) for r in radius]
        self.limits = corners(pair)
        load = 2.0 ** round(math.log2(line_load))  # so that loads alike share a table
        near = [1.5 * float(half_width(load, r, modulus)) for r in radius]
        away = [2.0 ** math.ceil(math.log2(max(a, n))) for a, n in zip(further, near, strict=True)]
        kept, case = solved_gears(cache), (pair, materials, load)
        self._tables = [
            kept.get(("corner", *case, corner, -n, a), partial(_table, *case, corner, (-n, a), kept))
            for corner, n, a in zip((2, 1), near, away, strict=True)
        ]

    def ends(self, pair, cells):
        """End of the path (0 start, 1 end) whose corner each cell touches or nearly touches, -1 away from both."""
        out = np.full(cells.z.size, -1)
        for k, (corner, gear, roll) in enumerate(((2, pair.gear_2, cells.roll_2), (1, pair.gear_1, cells.roll_1))):
            near = arc_at(gear, gear.roll_a) - arc_at(gear, roll) < self.inside[k]
            out[(cells.corner == corner) | ((cells.corner == 0) & near)] = k
        return out

    def __call__(self, ends, nominal, line_load):
        """Add to ``ln(2 / a) + 1/2`` ``(n,)`` at line loads ``(n,)`` [N/mm]: zero where `ends` is -1."""
        out = np.zeros(ends.size)
        for k, sign in ((0, -1), (1, 1)):
            own = np.flatnonzero(ends == k)
            if own.size and self._tables[k] is not None:
                spline, least, most, low, high = self._tables[k]
                # a contact that the hats do not resolve sees a wedge, which looks the same at every scale
                scale = np.sqrt(np.maximum(least / line_load[own], 1.0))
                away = np.clip(sign * (nominal[own] - self.limits[k]) * scale, low, high)
                out[own] = spline.ev(np.log(np.clip(line_load[own], least, most)), away)
        return out


def corners(pair):
    """Abscissae on the line of action [mm] at which the wheel's and the pinion's tip corner lie on it.

    They are the ends of the path of contact unless the mate's flank ends before, at a form point: an undercut pinion's path
    starts later, and the corner that would start it meets its flank nowhere near.
    """
    return float(pair.outward * (pair.length - pair.gear_2.roll_a)), float(pair.gear_1.roll_a)


def _table(pair, materials, line_load, corner, span, cache):
    """Spline over the logarithm of the line load and the abscissa beyond the corner's, with the limits of both.

    None if the corner meets no flank at any of these abscissae.
    """
    gears = list(zip((pair.gear_1, pair.gear_2), materials, strict=True))
    bodies = [flexibility(gear, material, neighbours=1, cache=cache) for gear, material in gears]
    end = 1 if corner == 1 else 0
    sign, limit = (-1, 1)[end], corners(pair)[end]
    c, modulus = sum(half_plane(m) for m in materials), contact_modulus(materials)
    unit = float(half_width(1.0, abs(float(pair.relative_radius(pair.path[end], pair.mate_roll(pair.path[end])))), modulus))
    hat = float(np.diff(np.sort(bodies[1 - end].tip_of(0).arc))[-1])
    least = (RESOLVED * hat / unit) ** 2
    line_load = max(line_load, 2.0 ** math.ceil(math.log2(least)))
    near = 1.5 * unit * math.sqrt(line_load)
    low, high = min(span[0], -near), max(span[1], near)
    away = low + (high - low) * np.linspace(0, 1, PLACES) ** 1.5
    away = np.unique([*away, *(at for at in (0.0, sign * (pair.path[end] - limit)) if low <= at <= high)])
    nominal = limit + sign * away
    mesh = PairContact(pair, materials, bodies, (nominal - pair.path[0]) / pair.p_bt, extended=True, state="plane strain")
    column = int(np.flatnonzero(mesh.found.order == 0)[0])
    loads = line_load * LOADS
    loads = loads[loads >= least]
    there = np.isfinite(mesh.found.gap[:, column])
    rows = mesh.contacts_at([(i, np.array([column]), np.array([corner])) for i in np.flatnonzero(there).tolist()])
    there[there] = [row["gap"].size > 0 for row in rows]  # else no point near the corner has a flank before it
    rows = [row for row in rows if row["gap"].size]
    away = away[there]
    if away.size < 2:
        return None
    rolls = mesh.found.roll_1[there, column], mesh.found.roll_2[there, column]
    smooth = sum(_read(*own, roll, cache) for own, roll in zip(gears, rolls, strict=True))
    closing = pressed(rows, loads) - mesh.found.gap[there, column]
    width = half_width(loads[:, None], mesh.radius[there, column], modulus)
    out = (closing / loads[:, None] - smooth) / c - np.log(2 / width) - 0.5
    return RectBivariateSpline(np.log(loads), away, out, kx=1, ky=1), loads[0], loads[-1], away[0], away[-1]


def pressed(rows, loads):
    """Approach ``(loads, rows)`` [mm] of rows of hats, with their ``flexibility`` and ``gap``, under line loads [N/mm]."""
    flexibility, gap = (stacked([row[name] for row in rows]) for name in ("flexibility", "gap"))
    there = np.arange(gap.shape[1]) < np.array([row["gap"].size for row in rows])[:, None]
    case = (np.concatenate([values] * loads.size) for values in (flexibility, gap))
    found = approaches(*case, np.repeat(loads, len(rows)), np.concatenate([there] * loads.size))
    return found.reshape(loads.size, len(rows))


def _read(gear, material, roll, cache):
    """The plane's S(s, s) ``(n,)`` [mm per N/mm] at roll lengths, as the polynomials of `ritz3d` carry it."""
    rows = carry(gear, roll)
    return np.einsum("ni,ij,nj->n", rows, plane_hats(gear, material, cache=cache), rows)

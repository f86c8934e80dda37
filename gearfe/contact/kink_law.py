"""What a kink of a modified flank adds to the local law of a contact line, taken from the plane section.

Where a linear relief starts, the flank has a ridge, and pressure concentrates there. The plane resolves that contact by a row of
hats (`gearfe.contact.kinks`); how much more or less it closes than Hertz's strip at the same line load and place is a property of
the section, which contact in three dimensions adds to the logarithm of its strips, as for tip corners (`gearfe.contact.corner`).
"""

import math
from functools import partial

import numpy as np
from scipy.interpolate import RectBivariateSpline

from ..energy.ritz.plane import flexibility
from ..flexibility.hertz import contact_modulus, half_plane, half_width
from ..flexibility.solved import solved_gears
from .corner import pressed
from .kinks import REACH, kink_rows
from .plane import PairContact

LOADS = 2.0 ** np.arange(-5, 4)  # line loads of the table, of the even one
PLACES = 17  # of the table, over the zone of a kink


class KinkLaw:
    """How much softer or stiffer contacts at kinks are than on smooth flanks.

    Parameters
    ----------
    pair : GearPair
    materials : (Material, Material)
    line_load : float
        Even load [N/mm] of the width.
    flanks : (FlankForm, FlankForm)
        What they have along the width is left out: it shifts the contact, but not its form.
    cache : bool or SolvedGears
        See `gearfe.flexibility.solved.solved_gears`.
    """

    def __init__(self, pair, materials, line_load, flanks, *, cache=True):
        forms = tuple(form.at(None) for form in flanks)
        modulus = contact_modulus(materials)
        step = modulus * pair.gear_1.m_n
        load = step * 2.0 ** round(math.log2(line_load / step))  # so that loads alike share a table
        kept, own = solved_gears(cache), tuple(form.flank for form in forms)
        self.zones = []
        start, end = pair.path
        places = [(roll, step) for roll, step in forms[0].kinks]
        places += [(pair.outward * (pair.length - roll), step) for roll, step in forms[1].kinks]
        for nominal, step in places:
            if not start < nominal < end:
                continue
            radius = abs(float(pair.relative_radius(nominal, pair.mate_roll(nominal))))
            # from the arc, in which contacts are wide, to the abscissa; and where contact stays on the ridge
            unit = REACH * float(half_width(1.0, radius, modulus)) * pair.gear_1.r_b / nominal
            stuck = 2 * abs(step) * radius
            case = (pair, materials, load, own, nominal, unit, stuck)
            table = kept.get(("kink", *case), partial(_table, pair, materials, load, forms, nominal, unit, stuck, kept))
            self.zones.append((nominal, unit, stuck, table))

    def __call__(self, inside, nominal, line_load):
        """Add to ``ln(2 / a) + 1/2`` ``(n,)`` at line loads ``(n,)`` [N/mm]; only where `inside`."""
        out = np.zeros(nominal.size)
        for at, unit, stuck, (spline, least, most) in self.zones:
            place = (nominal - at) / (unit * np.sqrt(np.clip(line_load, least, most)) + stuck)
            own = np.flatnonzero((np.abs(place) < 1) & inside)
            out[own] += spline.ev(np.log(np.clip(line_load[own], least, most)), place[own])
        return out


def _table(pair, materials, line_load, flanks, nominal, unit, stuck, cache):
    """Spline over the logarithm of the line load and the place in the zone, from -1 to 1, and the limits of the load."""
    bodies = [flexibility(g, m, neighbours=1, cache=cache) for g, m in zip((pair.gear_1, pair.gear_2), materials, strict=True)]
    places, loads = np.linspace(-1, 1, PLACES), line_load * LOADS
    c, out = sum(half_plane(m) for m in materials), np.zeros((loads.size, PLACES))
    for j, load in enumerate(loads.tolist()):
        phase = (nominal + places * (unit * math.sqrt(load) + stuck) - pair.path[0]) / pair.p_bt
        mesh = PairContact(pair, materials, bodies, phase, extended=False, state="plane strain", flanks=flanks)
        column = int(np.flatnonzero(mesh.found.order == 0)[0])
        there = np.flatnonzero(np.isfinite(mesh.found.gap[:, column]))
        where = np.array([there, np.full(there.size, column)]).T
        rows = kink_rows(mesh, where, load)
        if rows:
            closing = (
                pressed([rows[phase, column] for phase in there.tolist()], np.array([load]))[0] - mesh.found.gap[there, column]
            )
            width = half_width(load, mesh.radius[there, column], mesh.modulus)
            out[j, there] = (closing / load - _straight(mesh, there, column)) / c - np.log(2 / width) - 0.5
    return RectBivariateSpline(np.log(loads), places, out, kx=1, ky=1), loads[0], loads[-1]


def _straight(mesh, phases, column):
    """What both teeth yield to forces along their involutes' normals ``(phases,)`` [mm per N/mm], which the cells of a line have.

    The plane's own matrix turns them to the modified flank's normal, which jumps at a kink.
    """
    found, out = mesh.found, 0.0
    for flexible, roll, sense in zip(mesh.flexibility, (found.roll_1, found.roll_2), (1, -1), strict=True):
        out = out + flexible.matrix(roll[phases], sense * found.order)[:, column, column]
    return out

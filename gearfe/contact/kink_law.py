"""Local law of a contact line at a kink of a modified flank, computed in the plane section.

Where a linear relief starts, the flank has a ridge, and pressure concentrates there. The plane section resolves that contact by a
row of hat functions (`gearfe.contact.kinks`). The additional approach, relative to Hertz's strip under the same line load, is a
property of the section. Contact in three dimensions adds it to the logarithm of its strips, as for tip corners
(`gearfe.contact.corner`).
"""

import math
from functools import partial

import numpy as np

from ..flexibility.energy.ritz.plane import flexibility
from ..flexibility.hertz import contact_modulus, half_plane, half_width
from ..flexibility.solved import solved_gears
from ..geometry.cubic import Bilinear
from ..geometry.pair.modified import flank_contacts
from ..geometry.tooth.profile import arc_at
from .corner import pressed
from .kinks import REACH, kink_rows
from .pair_contact import PairContact

LOADS = 2.0 ** np.arange(-5, 4)  # tabulated line loads, relative to the load spread evenly over the width
PLACES = 9  # tabulated abscissae on each side of a kink, within the half-width of a contact
ON = 9  # tabulated abscissae up to the end of contact on the kink
BESIDE = 1e-6  # first of these abscissae
LEAST = 0.05  # No abscissae are tabulated if contact stays on the kink for less than this part of the widest contact.
SAMPLES = 400  # samples per base pitch, to find the range of contact on the kink
SOFT = 80  # bound of the approach of any tooth pair, in line loads over pi E*


class KinkLaw:
    """Additional compliance of contacts at kinks relative to smooth flanks.

    Parameters
    ----------
    line_load : float
        Even load [N/mm] of the width.
    flanks : (FlankForm, FlankForm)
        Modifications along the width are neglected: they shift the contact and do not change its form.
    """

    def __init__(self, pair, materials, line_load, flanks, *, cache=True):
        forms = tuple(form.at(None) for form in flanks)
        modulus = contact_modulus(materials)
        step = modulus * pair.gear_1.m_n
        load = step * 2.0 ** round(math.log2(line_load / step))  # Loads are rounded, so that nearly equal loads share a table.
        kept, modifications = solved_gears(cache), tuple(form.flank for form in forms)
        start, end = pair.path
        self.zones = []
        for gear, form in enumerate(forms):
            for roll, _ in form.kinks:
                nominal = pair.outward * (pair.length - roll) if gear else roll
                if start < nominal < end:
                    case = (pair, materials, load, modifications, gear, roll, nominal)
                    self.zones.append((nominal, *kept.get(("kink", *case), partial(_table, *case[:3], forms, *case[4:], kept))))

    def __call__(self, inside, nominal, line_load):
        """Term added to ``ln(2 / a) + 1/2`` ``(n,)`` at line loads ``(n,)`` [N/mm], for contacts `inside` only."""
        out = np.zeros(nominal.size)
        for at, unit, stays, (table, least, most) in self.zones:
            load = np.clip(line_load, least, most)
            place = _place((nominal - at) / unit, np.sqrt(load), stays)
            near = np.flatnonzero((np.abs(place) < 2) & inside)
            out[near] += table(np.log(load[near]), place[near])
        return out


def _place(away, wide, stays):
    """Return the coordinate in the table of the law: -1 to 1 within the contact width `wide`, to 2 within `stays` of the kink."""
    further = np.abs(away) - wide
    return np.where(further < 0, away / wide, np.sign(away) * (1 + further / np.where(away < 0, *stays)))


def _table(pair, materials, line_load, flanks, gear, roll, nominal, cache):
    """Return the unit of the abscissa [mm], the lengths of contact before and after a kink, and its table.

    The kink is at `roll` of `gear` (0 or 1). Within one unit, contacts of 1 N/mm are within `REACH` of the kink. The lengths of
    contact beyond the widest contacts are in these units. The table is over the logarithm of the line load and the place
    (`_place`), with the limits of the load.
    """
    gears, loads, modulus = pair.gears, line_load * LOADS, contact_modulus(materials)
    bodies = [flexibility(g, m, neighbours=1, cache=cache) for g, m in zip(gears, materials, strict=True)]
    radius = abs(float(pair.relative_radius(nominal, pair.mate_roll(nominal))))
    # conversion from the arc, in which contacts are wide, to the abscissa
    unit = REACH * float(half_width(1.0, radius, modulus)) * gears[gear].r_b / roll
    wide = np.sqrt(loads)
    lengths = (_stays(pair, flanks, gear, roll, nominal, sign, modulus, loads[-1]) / unit for sign in (-1, 1))
    stays = [max(away - wide[-1], LEAST * wide[-1]) for away in lengths]
    on, inside = 1 + np.linspace(0, 1, ON)[1:] ** 1.5, np.linspace(0, 1, PLACES)
    inside[0] = BESIDE  # Both sides of the kink are tabulated, because the radius of curvature may jump there.
    sides = [np.append(inside, on if beyond > LEAST * wide[-1] else []) for beyond in stays]
    places = np.append(-sides[0][::-1], sides[1])
    further = np.maximum(np.abs(places) - 1, 0.0) * np.where(places < 0, *stays)
    away = np.sign(places) * (np.minimum(np.abs(places), 1.0) * wide[:, None] + further)
    phase = ((nominal + unit * away - pair.path[0]) / pair.p_bt).ravel()
    mesh = PairContact(pair, materials, bodies, phase, extended=True, state="plane strain", flanks=flanks)
    column = int(np.flatnonzero(mesh.found.order == 0)[0])
    gap, touches = mesh.found.gap[:, column], mesh.found.corner[:, column] == 0
    c, out = sum(half_plane(m) for m in materials), np.zeros(phase.size)
    for numbers, load in zip(np.arange(phase.size).reshape(away.shape), loads.tolist(), strict=True):
        on_flanks = numbers[np.isfinite(gap[numbers]) & touches[numbers]]
        rows = kink_rows(mesh, np.array([on_flanks, np.full(on_flanks.size, column)]).T, load)
        if rows:
            closing = pressed([rows[phase, column] for phase in on_flanks.tolist()], np.array([load]))[0] - gap[on_flanks]
            width = half_width(load, mesh.radius[on_flanks, column], mesh.modulus)
            out[on_flanks] = (closing / load - _straight(mesh, on_flanks, column)) / c - np.log(2 / width) - 0.5
    out = out.reshape(away.shape)
    return unit, stays, (Bilinear(np.log(loads), places, out), loads[0], loads[-1])


def _stays(pair, flanks, gear, roll, nominal, sign, modulus, line_load):
    """Return the distance from a kink [mm of abscissa] within which the kink influences the contact, on one side."""
    reach = SOFT / (math.pi * modulus) * line_load
    away = np.arange(1, SAMPLES + 1) / SAMPLES * pair.p_bt
    points = flank_contacts(pair, (nominal + sign * away - pair.path[0]) / pair.p_bt, extended=True, flanks=flanks)
    column = int(np.flatnonzero(points.order == 0)[0])
    rolls, host = (points.roll_1[:, column], points.roll_2[:, column]), pair.gears[gear]
    beside = REACH * half_width(line_load, np.abs(pair.relative_radius(*rolls)), modulus)
    on = np.abs(arc_at(host, rolls[gear]) - arc_at(host, roll)) < beside
    stays = on & (points.gap[:, column] < reach) & (points.corner[:, column] == 0)
    count = int(np.argmin(np.append(stays, False)))  # number of consecutive places on the kink
    return float(away[count - 1]) if count else 0.0


def _straight(mesh, phases, column):
    """Compute the deflection of both teeth along their involute normals ``(phases,)`` [mm per N/mm], as for cells of lines.

    The plane model refers deflections to the normal of the modified flank, which is discontinuous at a kink.
    """
    points, out = mesh.found, 0.0
    for flexible, roll, sense in zip(mesh.flexibility, points.rolls, (1, -1), strict=True):
        out = out + flexible.matrix(roll[phases], sense * points.order)[:, column, column]
    return out

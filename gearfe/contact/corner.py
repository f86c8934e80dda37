"""Local law of a contact line at a corner at an end of the path of contact, computed in the plane section.

Close to its tip corner a tooth is a wedge and not a half-space. The pressure ends at the corner, or at the edge where undercut
ends the flank. The plane section resolves that contact by hat functions (`gearfe.contact.rows`). The additional approach,
relative to Hertz's strip on a half-plane under the same line load, is a property of the section. It extends over a few tenths
of a millimetre and does not depend on the load distribution along the width. Contact in three dimensions adds it to the
logarithm of its strips, so that both models agree in the plane limit. For helical teeth the transverse section replaces the
normal one: widths and loads there differ by cos(beta_b).
"""

import math
from dataclasses import replace
from functools import partial

import numpy as np

from ..flexibility.energy.ritz.plane import flexibility
from ..flexibility.energy.ritz.plane_strain import end_of, plane_hats
from ..flexibility.hats import TIP_ZONE
from ..flexibility.hertz import contact_modulus, half_plane, half_width
from ..flexibility.solid import carry
from ..flexibility.solved import solved_gears
from ..geometry.cubic import Bilinear
from ..geometry.pair.contacts import TIP, end_corners, touching
from ..geometry.pair.gear_pair import with_tips
from ..geometry.tooth.profile import arc_at
from ..geometry.tooth.side import on_fillet
from .pair_contact import BEYOND, CORNER, PairContact
from .pieces import cut
from .rows import LEAST, RESOLVED, Wanted, finest_hat
from .sharing import approaches, stacked

LOADS = 2.0 ** np.arange(-9, 5)  # tabulated line loads, relative to the load spread evenly over the width
LIGHT = 16.0  # The hat functions resolve loads down to the even load divided by this factor.
FINER = 2  # factor for the number of tabulated loads where a tip contacts a fillet
MARGIN = 2.25  # The tables cover line loads up to this factor. Contact is then 1.5 times as wide.
PLACES = 65  # tabulated abscissae at each end of the path; with 17, k of ring gear pairs has an error up to 0.2 %
IN_FILLET = 17  # additional abscissae where a tip contacts a fillet
BETWEEN = 200  # abscissae at which the touching corner is determined


class CornerLaw:
    """Additional compliance of corners relative to half-planes, at both ends of the path.

    Parameters
    ----------
    line_load : float
        Even load [N/mm] of the width.
    further : (float, float)
        How far before the start and after the end of the path contact is looked for [mm].
    chips : (Chip or None, Chip or None)
        Of the teeth in contact, numbered 0.
    """

    def __init__(self, pair, materials, line_load, further, *, chips=(None, None), cache=True):
        modulus, own = contact_modulus(materials), _chipped(pair, chips)
        self.path = own.path
        self.inside = [_reached(own, end, line_load, modulus) for end in (0, 1)]
        unit = modulus * pair.gear_1.m_n
        load = unit * 2.0 ** round(math.log2(line_load / unit))  # Loads are rounded, so that nearly equal loads share a table.
        near = [_reached(own, end, MARGIN * load, modulus) for end in (0, 1)]
        away = [pair.p_bt * 2.0 ** math.ceil(math.log2(max(a, n) / pair.p_bt)) for a, n in zip(further, near, strict=True)]
        # the body of a gear with a chip of a part of the width has the whole tooth, wherever the chip lies
        chips = tuple(one and (one if one.through else replace(one, width=(0.0, 1.0))) for one in chips)
        kept, case = solved_gears(cache), (pair, chips, materials, load)
        self._tables = [
            kept.get(("corner", *case, end, -n, a), partial(_table, *case, end, (-n, a), kept))
            for end, n, a in zip((0, 1), near, away, strict=True)
        ]
        self._gears = tuple(zip(pair.gears, materials, chips, strict=True))
        self._soft, self._cache = sum(half_plane(m) for m in materials), cache

    def ends(self, cells):
        """Return the end of the path (0 start, 1 end) whose corner a cell touches or nearly touches, or -1 for other cells."""
        out, middle = np.full(cells.z.size, -1), sum(self.path) / 2
        for k, sign in ((0, -1), (1, 1)):
            near = sign * (self.path[k] - cells.nominal) < self.inside[k]
            out[np.where(cells.corner > 0, sign * (cells.nominal - middle) > 0, near)] = k
        return out

    def softer(self, *rolls):
        """Return the term added to ``ln(2 / a) + 1/2`` ``(n,)`` away from corners, at roll lengths ``(n,)`` of both gears [mm].

        The bodies contain the material that chips of a part of the width remove. The term is the difference of the sections
        with and without that material.
        """
        out = np.zeros(rolls[0].size)
        for (gear, material, chip), roll in zip(self._gears, rolls, strict=True):
            if chip is not None and not chip.through:
                chipped, whole = (_read(gear, material, one, roll, self._cache) for one in (chip, None))
                out += (chipped - whole) / self._soft
        return out

    def __call__(self, ends, nominal, line_load):
        """Return the term added to ``ln(2 / a) + 1/2`` ``(n,)`` at line loads ``(n,)`` [N/mm]. It is 0 where `ends` is -1."""
        out = np.zeros(ends.size)
        for k, sign in ((0, -1), (1, 1)):
            at_end = np.flatnonzero(ends == k)
            if at_end.size and self._tables[k] is not None:
                table, least, most, low, high = self._tables[k]
                # A contact narrower than the hat functions is a wedge contact, whose shape is independent of the scale.
                scale = np.sqrt(np.maximum(least / line_load[at_end], 1.0))
                away = np.clip(sign * (nominal[at_end] - self.path[k]) * scale, low, high)
                out[at_end] = table(np.log(np.clip(line_load[at_end], least, most)), away)
        return out


def _chipped(pair, chips):
    """Return the pair with the tips of teeth with `chips`."""
    gears = zip(pair.gears, chips, strict=True)
    return with_tips(pair, [one and one.end_roll(gear, "loaded") for gear, one in gears])


def in_fillet(pair, roll_1, roll_2):
    """Return whether a tip touches the mate's fillet, at roll lengths of both gears."""
    return on_fillet(pair.gear_1, roll_1) | on_fillet(pair.gear_2, roll_2)


def plain_radius(pair, roll_1, roll_2):
    """Relative radius of curvature of involutes [mm]. For a tip in a fillet the value at the pitch point is used."""
    radius = pair.relative_radius(roll_1, roll_2)
    return np.where((radius > 0) & ~in_fillet(pair, roll_1, roll_2), radius, pair.pitch_relative_radius)


def _reached(pair, end, line_load, modulus):
    """Return the distance from an end of the path [mm] within which contacts reach the corner, as in the section (`CORNER`)."""
    number, sign, limit = end_corners(pair)[end], (-1, 1)[end], pair.path[end]
    nominal = limit - sign * np.linspace(0, 1, BETWEEN) * (pair.path[1] - pair.path[0])
    rolls = nominal, pair.mate_roll(nominal)
    first = number % 2 == 1
    gear, roll = (pair.gear_1, rolls[0]) if first else (pair.gear_2, rolls[1])
    apart = np.abs(arc_at(gear, gear.roll_a if number in TIP else gear.roll_f) - arc_at(gear, roll))
    away = apart / (CORNER * half_width(line_load, np.abs(pair.relative_radius(*rolls)), modulus))
    out = int(np.argmax(away > 1)) if (away > 1).any() else away.size - 1
    if not 0 < out < away.size:
        return 0.0
    part = (1 - away[out - 1]) / max(away[out] - away[out - 1], 1e-12)
    return float(np.abs(limit - nominal[out - 1]) + min(part, 1.0) * np.abs(nominal[1] - nominal[0]))


def _table(whole, chips, materials, line_load, end, span, cache):
    """Return a `Bilinear` of the law over log line load and abscissa beyond an end of the path, and the limits of both variables.

    The result is None if no corner meets the other gear at any of these abscissae.
    """
    pair, gears = _chipped(whole, chips), list(zip(whole.gears, materials, chips, strict=True))
    bodies = [
        flexibility(gear, material, broken=() if chip is None else (chip,), neighbours=1, cache=cache)
        for gear, material, chip in gears
    ]
    sign, limit, corner = (-1, 1)[end], pair.path[end], end_corners(pair)[end]
    c, modulus = sum(half_plane(m) for m in materials), contact_modulus(materials)
    unit = float(half_width(1.0, abs(float(pair.relative_radius(limit, pair.mate_roll(limit)))), modulus))
    mesh = PairContact(whole, materials, bodies, [0.0], extended=True, state="plane strain")
    finest = mesh.finest(line_load / LIGHT)
    finest = max(finest, LEAST * pair.gear_1.m_n) if finest else 0.0
    least = (RESOLVED * (finest or finest_hat(pair.gear_1.m_n, bodies[0].fine)) / unit) ** 2
    line_load *= 2.0 ** max(math.ceil(math.log2(least / line_load)), 0)
    inside = cut(pair)[end]
    near = _reached(pair, end, MARGIN * line_load, modulus)
    low, high = min(span[0], -near), max(span[1], near)
    away = np.append(low + (high - low) * np.linspace(0, 1, PLACES) ** 1.5, 0.0)
    # More abscissae are used in a fillet, where the gap changes faster.
    away = np.append(away, np.linspace(-inside, 0.0, IN_FILLET) if inside else [])
    between = low + (high - low) * np.linspace(0, 1, BETWEEN)
    changes = np.flatnonzero(np.diff(touching(pair, limit + sign * between).corner))  # abscissae at which another corner touches
    away = np.unique(np.concatenate([away, between[changes], between[changes + 1]]))
    nominal = limit + sign * away
    mesh = PairContact(whole, materials, bodies, (nominal - whole.path[0]) / pair.p_bt, extended=True, state="plane strain")
    column = int(np.flatnonzero(mesh.found.order == 0)[0])
    loads = line_load * LOADS
    loads = loads[loads >= least]
    touches = np.where(mesh.found.corner[:, column] > 0, mesh.found.corner[:, column], corner)
    meets = np.isfinite(mesh.found.gap[:, column]) & np.isfinite(mesh.found.corner_gap[touches - 1, np.arange(away.size), column])
    rolls = mesh.found.roll_1[:, column], mesh.found.roll_2[:, column]
    radius = plain_radius(pair, *rolls)
    if inside:  # Concave contact changes more with the load.
        loads = np.exp2(np.linspace(*np.log2(loads[[0, -1]]), FINER * (loads.size - 1) + 1))
    width = half_width(MARGIN * line_load, radius, modulus)
    zone = np.maximum(TIP_ZONE * pair.gear_1.m_n, (1 + BEYOND) * width).tolist()
    # Near a tip in a fillet, the flanks also touch on the path, so corners and hat functions are those of the plane section.
    twofold = (mesh.found.corner[:, column] > 0) & (nominal > pair.path[0]) & (nominal < pair.path[1])
    reached = [values[:, column] for values in mesh.corners(line_load, np.isfinite(mesh.found.gap))]
    taking, beside = np.where(mesh.found.corner[:, column] > 0, reached[0], 0), np.where(twofold, reached[2], 0)
    taking = taking.astype(int) | (1 << (touches - 1))
    at = np.flatnonzero(meets).tolist()
    made = mesh.rows([Wanted(i, column, int(taking[i]), zone[i], finest, float(beside[i])) for i in at])
    meets[meets] = [row.gap.size > 0 for row in made]  # Other rows have no point near the corner that faces a flank.
    rows = [row for row in made if row.gap.size]
    away = away[meets]
    if away.size < 2:
        return None
    in_body = [(gear, material, chip and (chip if chip.through else None)) for gear, material, chip in gears]
    smooth = sum(_read(*case, roll[meets], cache) for case, roll in zip(in_body, rolls, strict=True))
    closing = pressed(rows, loads) - mesh.found.gap[meets, column]
    width = half_width(loads[:, None], radius[meets], modulus)
    out = (closing / loads[:, None] - smooth) / c - np.log(2 / width) - 0.5
    return Bilinear(np.log(loads), away, out), loads[0], loads[-1], away[0], away[-1]


def pressed(rows, loads):
    """Approach ``(loads, rows)`` [mm] of each `gearfe.contact.rows.Row` under line loads [N/mm]."""
    flexibility, gap = (stacked([getattr(row, name) for row in rows]) for name in ("influence", "gap"))
    filled = np.arange(gap.shape[1]) < np.array([row.gap.size for row in rows])[:, None]
    return approaches(flexibility, gap, loads, filled)


def _read(gear, material, chip, roll, cache):
    """Return S(s, s) of the plane model ``(n,)`` [mm per N/mm] at roll lengths, represented by the polynomials of `ritz3d`."""
    rows = carry(end_of(gear, chip), roll)
    return np.einsum("ni,ij,nj->n", rows, plane_hats(gear, material, chip, cache=cache), rows)

"""Load sharing and approach of all tooth pairs at one phase.

A pair whose contact is well inside both flanks is one line contact with Hertz's logarithmic deflection. No such formula holds
where the contact reaches a corner of an outline, or where a modified flank has a kink within the contact. There the pressure is
a row of hat functions with the exact gap at each (`gearfe.contact.rows`, `gearfe.contact.kinks`).
"""

import math
from functools import cached_property

import numpy as np
from scipy.linalg import block_diag

from ..flexibility.hats import TIP_ZONE
from ..flexibility.hertz import contact_modulus, half_plane, half_width, peak_pressure
from ..flexibility.section_contact import Solved
from ..geometry.pair.modified import flank_contacts
from ..geometry.tooth.profile import arc_at
from .broken_teeth import with_broken
from .closed_cracks import share_closing
from .directions import leaning
from .kinks import kink_rows, near_kink
from .rows import LEAST, RESOLVED, SHARP, Wanted, corner_rows, finest_hat
from .sharing import LineContacts, line_contact, line_contacts, stacked
from .sliding import bounded, cracked_contacts, left_out, moved_contacts, sliding
from .thinned import thinned_teeth
from .unknowns import near_contacts, overlaps, unknowns_at

CORNER = 1.0  # distance from a corner within which hat functions resolve a contact [half-widths]
BEYOND = 1.5  # least half-length of a row [half-widths]
KINK = 16  # mark of a pair whose contact reaches a kink; smaller marks are corners, with bit n - 1 for corner n
SMOOTH = 0.5  # A corner is a second contact if its gap is below this part of the parabola of the smooth contact.


class PairContact:
    """Contact problem of a gear pair at some phases, solved for any load.

    It is built from the `Flexibility` of pinion and wheel. `Solve` describes `extended` and `state`. `flanks` are the `FlankForm`
    objects of a `Case`.
    """

    def __init__(self, pair, materials, flexibility, phase, *, extended, state, flanks=None):
        self.pair, self.flexibility, self.flanks = pair, flexibility, flanks
        self.coefficients = [half_plane(m, state) for m in materials]
        self.modulus = contact_modulus(materials, state)
        found = flank_contacts(pair, phase, extended=extended, flanks=flanks)
        self.found, self.path = points, _ = with_broken(found, pair, flexibility, extended, flanks)
        self.extended = extended
        # The leading pair is on the pinion's next tooth on the loaded side, and on the wheel's on the other side.
        matrices = [flexibility[0].matrix(points.roll_1, points.order), flexibility[1].matrix(points.roll_2, -points.order)]
        self.coefficient, self.turns = np.full(points.gap.shape, sum(self.coefficients)), np.ones((2, *points.gap.shape))
        if flanks is not None:
            matrices, self.coefficient, self.turns = leaning(self, matrices)
        self.matrix = matrices[0] + matrices[1]
        self.thinning, self.thinner = thinned_teeth(flanks, materials, state, points)
        self.matrix[:, range(points.order.size), range(points.order.size)] += self.thinner
        self.alone = np.diagonal(self.matrix, axis1=1, axis2=2)  # compliance of each contact alone, with bonded crack faces
        self.radius = self.flat_radius = points.radius
        if any(form.edge for form in flanks or ()):  # A rounded tip shares its contact with the adjacent flank.
            beside = pair.relative_radius(*points.rolls)
            self.flat_radius = np.where(beside > 0, np.maximum(beside, points.radius), points.radius)
        self.opening = self.opening_at(*points.rolls, points.order)
        self.stiffness = None
        if self.opening is not None:
            self.stiffness = block_diag(*(flexible.seam.stiffness for flexible in flexibility if flexible.seam))
            self.matrix = self.matrix + self.opening @ self.stiffness @ self.opening.mT
        self.sliding = sliding(self)
        self._rows = {}

    @cached_property
    def moved(self):
        """Result of `moved_contacts`, used for sliding under any load."""
        return moved_contacts(self)

    @cached_property
    def cracked(self):
        """Result of `cracked_contacts`, used for the error of cracks under any load."""
        return cracked_contacts(self)

    @cached_property
    def faces(self):
        """Opening of the crack faces of both gears under unit forces that push them apart [mm per N/mm]."""
        return block_diag(*(flexible.seam.influence for flexible in self.flexibility if flexible.seam))

    def solve(self, line_load):
        """Solve the contact under `line_load` [N/mm] at all phases."""
        points, tilt = self.found, bounded(self, line_load)
        # Gaps are measured from first contact: the approach at light loads is below their rounding error.
        least = points.gap.min(axis=1)
        reach, beyond = self._reach(line_load), points.gap - least[:, None]
        possible = beyond < reach[:, None]
        corner, zone, width = self.corners(line_load, possible)
        single = LineContacts(self.matrix, beyond, self.coefficient, self.radius, self.modulus, tilt)
        line, closing, tangent, done = line_contacts(single, line_load, possible)
        pressure = peak_pressure(line, self.radius, self.modulus)
        kink = near_kink(self, line_load) & possible & (corner == 0)
        done &= ~(corner.any(axis=1) | kink.any(axis=1))
        if self.opening is not None:
            done &= ~overlaps(np.einsum("pcf,pc->pf", self.opening, line))
        open_ = np.flatnonzero(~done)
        closed, fillet = [], []
        if open_.size:
            sets, _ = self.problems(line_load, open_, possible, (corner, zone, width), kink, tilt)
            sets = [problem | {"gap": problem["gap"] - least[i]} for i, problem in zip(open_.tolist(), sets, strict=True)]
            sets = [near_contacts(contacts, reach[i]) for i, contacts in zip(open_.tolist(), sets, strict=True)]
            line[open_], pressure[open_], closing[open_], tangent[open_], closed, fillet = self._solved(
                sets, line_load, line[open_], open_
            )
        unloaded = least if self.flanks is not None or least.any() else None
        marked = (tuple(open_[which].tolist()) for which in (closed, fillet))
        doubt = left_out(self, line, closing, beyond, np.isin(np.arange(least.size), open_[closed]))
        return Solved(points.order, closing, tangent, line, pressure, *marked, unloaded, left_out=doubt)

    def problems(self, line_load, phases, possible, corners, kink, tilt):
        """Return contact problems at some phases under a load [N/mm] (see `unknowns_at`), and the `HatRow` by phase and column.

        `possible` and `kink` ``(phases, pairs)`` mark pairs that may touch and pairs on a kink. `tilt` is an argument of
        `line_contacts`, and `corners` is the result of `PairContact.corners`.
        """
        (corner, zone, width), chosen, finest = corners, np.zeros((len(possible), 1), dtype=bool), self.finest(line_load)
        chosen[phases] = True
        at = np.argwhere((corner > 0) & chosen).tolist()
        rows = self.rows([Wanted(i, k, int(corner[i, k]), float(zone[i, k]), finest, float(width[i, k])) for i, k in at])
        rows = dict(zip(map(tuple, at), rows, strict=True)) | kink_rows(self, np.argwhere(kink & chosen), line_load)
        corner = np.where(kink, KINK, corner)
        wanted = [(i, near := np.flatnonzero(possible[i]), corner[i, near]) for i in np.flatnonzero(chosen).tolist()]
        return unknowns_at(self, wanted, rows, tilt), rows

    def _solved(self, sets, line_load, smooth, phases):
        """Solve contact problems: line loads and pressures by pair, approach, tangent, closed faces and fillets.

        `phases` are the phase numbers of the sets. `smooth` are the line loads if all contacts were single. Hat functions are
        initially in contact up to the gap at the ends of the Hertzian contact under these loads, which is the same for any
        radius. The last two results are the numbers of the sets in which crack faces touch, and in which a tip touches a
        fillet.
        """
        names = ("flexibility", "gap", "coefficient", "radius", "column", "tilt")
        flexibility, gap, coefficient, radius, column, tilt = (stacked([contacts[name] for contacts in sets]) for name in names)
        filled = stacked([np.ones(contacts["gap"].size, dtype=bool) for contacts in sets])
        radius[~filled] = 1.0
        row = np.broadcast_to(np.arange(len(sets))[:, None], column.shape)
        least = np.full(smooth.shape, np.inf)
        np.minimum.at(least, (row[filled], column[filled]), gap[filled])
        close = gap - least[row, column] <= sum(self.coefficients) * smooth[row, column]
        case = LineContacts(flexibility, gap, coefficient, radius, self.modulus, tilt)
        force, approach, tangent, settled = line_contacts(case, line_load, filled, filled & ((coefficient > 0) | close))
        for k in np.flatnonzero(~settled).tolist():
            force[k, filled[k]], approach[k], tangent[k] = line_contact(self._lines(sets[k]), line_load)
        closed = []
        if self.opening is not None:
            carried = [row[on] for row, on in zip(force, filled, strict=True)]
            closed = [k for k, one in enumerate(sets) if overlaps(carried[k] @ one["opening"])]
        if closed:
            of_closed = [sets[k] for k in closed], line_load, [carried[k] for k in closed], phases[closed]
            some, approach[closed], tangent[closed] = share_closing(self, *of_closed)
            force[closed, : some.shape[1]] = some
        fillet = [k for k, one in enumerate(sets) if (one["fillet"] & (force[k, filled[k]] > 0)).any()]
        line, pressure = np.zeros((2, len(sets), self.found.order.size))
        np.add.at(line, (row, column), force)
        single, hat = coefficient > 0, filled & (coefficient == 0)
        pressure[row[hat], column[hat]] = np.nan
        pressure[row[single], column[single]] = peak_pressure(force[single], radius[single], self.modulus)
        pressure[(line == 0) & np.isnan(pressure)] = 0.0
        return line, pressure, approach, tangent, closed, fillet

    def _lines(self, contacts):
        values = (contacts[name] for name in ("flexibility", "gap", "coefficient", "radius"))
        return LineContacts(*values, self.modulus, contacts["tilt"])

    def opening_at(self, roll_1, roll_2, order):
        """Return the opening ``(..., contacts, faces)`` of all cracks under unit loads, or None without cracks."""
        rows = []
        for flexible, roll, teeth in zip(self.flexibility, (roll_1, roll_2), (order, -order), strict=True):
            if flexible.seam is not None:
                arc = flexible.clipped(arc_at(flexible.gear, roll), teeth)
                rows.append(flexible.seam.at(arc, (teeth % flexible.gear.z).tolist()))
        return np.concatenate(rows, axis=-1) if rows else None

    def _reach(self, line_load):
        """Return a limit of the gaps beyond the first touch [mm] that can close: twice the approach of the nearest pair alone."""
        best = np.argmin(self.found.gap, axis=1)
        at = np.arange(best.size), best
        local = sum(self.coefficients) * (np.log(2 / half_width(line_load, self.radius[at], self.modulus)) + 0.5)
        return 2 * np.maximum(self.matrix[at[0], best, best] + local, 0.0) * line_load

    def finest(self, line_load):
        """Return the length of hat functions next to corners [mm] for a line load [N/mm]. 0: the default is short enough."""
        if not self.extended:
            return 0.0
        gear, ends = self.pair.gear_1, np.array(self.pair.path)
        radius = np.abs(self.pair.relative_radius(ends, self.pair.mate_roll(ends))).min()
        width = float(half_width(line_load, max(radius, 1e-3 * gear.m_n), self.modulus)) / gear.m_n
        finest = max(width / SHARP, min(LEAST, width / RESOLVED))
        default = finest_hat(1.0, min(flexible.fine for flexible in self.flexibility))
        return 0.0 if finest > default else gear.m_n * 2.0 ** math.floor(math.log2(finest))

    def corners(self, line_load, possible):
        """Return the corners in contact of each pair as a sum of bits, and `zone` and `width` of their `Wanted`.

        A corner is in contact if the flank contact reaches it, or if it is a second contact of the same pair with a gap smaller
        than the approach under load.
        """
        points, gear = self.found, self.pair.gear_1
        corner = np.zeros(points.gap.shape, dtype=int)
        if not self.extended:
            return corner, *np.zeros((2, *corner.shape))
        start, end = self.path
        mate = self.pair.mate_roll(points.nominal)
        radius = np.where(points.corner > 0, self.pair.relative_radius(points.nominal, mate), self.radius)
        width = half_width(line_load, np.where(radius > 0, radius, self.pair.pitch_relative_radius), self.modulus)
        pressed = sum(self.coefficients) * line_load * (np.log(2 * gear.m_n / width) + 0.5)
        away = np.abs(arc_at(gear, points.corner_roll[0]) - arc_at(gear, points.roll_1))
        wheel = self.pair.gear_2  # The row is finer on the side of the corner's gear, so that both gears are treated alike.
        away[1::2] = np.abs(arc_at(wheel, points.corner_roll[1, 1::2]) - arc_at(wheel, points.roll_2))
        excess = points.corner_gap - np.where(possible, points.gap, 0.0)
        with np.errstate(invalid="ignore"):
            reached = away < CORNER * width
            second = (excess < pressed) & ((points.corner > 0) | (excess < SMOOTH * away**2 / (2 * radius)))
        meets = possible & np.isfinite(points.corner_gap)
        corner = ((meets & (reached | second)) * (1 << np.arange(4))[:, None, None]).sum(axis=0)
        smooth = (corner > 0) & (points.corner == 0)
        also = (corner > 0) & (points.corner > 0) & (points.nominal > start) & (points.nominal < end) & (-points.gap < pressed)
        apart = also | (smooth & ~(meets & reached).any(axis=0))  # The flanks also touch on the path.
        further = np.where(meets & reached, away, 0.0).max(axis=0) + BEYOND * width
        zone = np.where(smooth, np.maximum(further, TIP_ZONE * gear.m_n), TIP_ZONE * gear.m_n)
        return corner, zone, np.where(apart, width, 0.0)

    def rows(self, wanted):
        """Return the `HatRow` of each `gearfe.contact.rows.Wanted`. Rows that are independent of the load are stored."""
        new = [request for request in dict.fromkeys(wanted) if request not in self._rows]
        made = dict(zip(new, corner_rows(self, new), strict=True))
        self._rows |= {request: row for request, row in made.items() if not request.width}
        return [made[request] if request in made else self._rows[request] for request in wanted]

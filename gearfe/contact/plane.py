"""All tooth pairs at one phase: who carries what, and how far the gears approach.

A pair well inside its flanks is one contact with Hertz's logarithm. Where the contact reaches a tip corner there is no such
formula: that pair becomes a row of hat pressures up to the corner, with the exact gap at each. So it does where a modified flank
has a kink within the contact: a row of hats on both sides of the touching point (`gearfe.contact.kinks`).
"""

import math

import numpy as np
from scipy.linalg import block_diag

from geometry.tooth.profile import arc_at, roll_at_arc

from ..flexibility.hertz import contact_modulus, half_plane, half_width, hat_logarithm, peak_pressure
from ..flexibility.section_contact import Solved
from .kinks import kink_rows, near_kink
from .sharing import line_contact, line_contacts, stacked

# A contact whose middle is closer to a tip corner than so many half widths of the whole load is resolved hat by hat: near
# the corner a pair carries about half of it, and its own half width is then smaller by sqrt(2).
CORNER = 0.7
KINK = 3  # number of a pair whose contact reaches a kink of a flank; 1 and 2 are those at a tip corner
RESOLVED = 4.0  # hats at a tip corner that a half width must span: a narrower contact falls between them
OVERLAP = 1e-3  # crack faces overlapping by less than this part of the largest opening are left alone


def _closing(opening):
    """Whether crack faces overlap, by the last axis."""
    return opening.min(axis=-1) < -OVERLAP * np.abs(opening).max(axis=-1)


def _within(contacts, reach):
    """Without the unknowns whose gap cannot close."""
    near = contacts["gap"] <= max(reach, contacts["gap"].min())
    if near.all():
        return contacts
    kept = {name: values if values is None else values[near] for name, values in contacts.items()}
    return kept | {"flexibility": contacts["flexibility"][np.ix_(near, near)]}


def _aligned(rows):
    """Rows of hats of different lengths as arrays ``(rows, n)`` and ``(rows, n, n)``, nan as gap after each."""
    first, second, gap, coefficient, radius, influence = (stacked([row[k] for row in rows]) for k in range(6))
    for k, row in enumerate(rows):
        size = row[0].size
        first[k, size:], second[k, size:], gap[k, size:], radius[k, size:] = row[0][-1], row[1][-1], np.nan, 1.0
    return first, second, gap, coefficient, radius, influence


def _towards(arc, gear, scale):
    """Arcs, their distances to the tip corner of a gear scaled."""
    corner = arc_at(gear, gear.roll_a)
    return corner + scale * (arc - corner)


class PairContact:
    """Two gears' flexibilities and the contacts of a pair at some phases; solves for any load.

    Parameters
    ----------
    pair : GearPair
    materials : (Material, Material)
    flexibility : (Flexibility, Flexibility)
        Of pinion and wheel.
    phase : ndarray
    extended : bool
    state : str
    flanks : (FlankForm, FlankForm), optional
        Modifications of pinion and wheel, `geometry.tooth.modified.flank_forms`.
    """

    def __init__(self, pair, materials, flexibility, phase, *, extended, state, flanks=None):
        self.pair, self.flexibility, self.flanks = pair, flexibility, flanks
        self.coefficients = [half_plane(m, state) for m in materials]
        self.modulus = contact_modulus(materials, state)
        self.found = found = pair.contacts(phase, extended=extended, flanks=flanks)
        self.extended = extended
        # the pair ahead of another is on the pinion's next tooth on the loaded side, but on the wheel's on the other side
        self.matrix = flexibility[0].matrix(found.roll_1, found.order) + flexibility[1].matrix(found.roll_2, -found.order)
        self.radius = self.flat_radius = found.radius
        if any(form.edge for form in flanks or ()):  # on a rounded tip: of the flank beside it, which shares the contact
            beside = pair.relative_radius(found.roll_1, found.roll_2)
            self.flat_radius = np.where(beside > 0, np.maximum(beside, found.radius), found.radius)
        self.opening = self._opening(found.roll_1, found.roll_2, found.order)
        if self.opening is not None:
            self.stiffness = block_diag(*(flexible.seam.stiffness for flexible in flexibility if flexible.seam))
            self.matrix = self.matrix + self.opening @ self.stiffness @ np.swapaxes(self.opening, -1, -2)
        self._known, self._gaps = {}, {}

    def solve(self, line_load):
        """Contact under `line_load` [N/mm] at all phases."""
        found, c = self.found, sum(self.coefficients)
        # all beyond the first touch: a light load closes so little that it would drown in the digits of the gaps
        least = np.zeros(len(found.gap)) if self.flanks is None else found.gap.min(axis=1)
        reach, beyond = self._reach(line_load), found.gap - least[:, None]
        possible = beyond < reach[:, None]
        corner = np.where(possible, self._corners(line_load), 0)
        line, closing, tangent, done = line_contacts(self.matrix, beyond, line_load, c, self.radius, self.modulus, possible)
        pressure = peak_pressure(line, self.radius, self.modulus)
        kink = near_kink(self, line_load) & possible & (corner == 0)
        done &= ~(corner.any(axis=1) | kink.any(axis=1))
        if self.opening is not None:
            done &= ~_closing(np.einsum("pcf,pc->pf", self.opening, line))
        kinks, corner = kink_rows(self, np.argwhere(kink), line_load), np.where(kink, KINK, corner)
        open_ = np.flatnonzero(~done)
        closed = []
        if open_.size:
            wanted = [(i, near := np.flatnonzero(possible[i]), corner[i, near]) for i in open_.tolist()]
            sets = self.contacts_at(wanted, kinks, self._shrunk(line_load))
            sets = [one | {"gap": one["gap"] - least[i]} for i, one in zip(open_.tolist(), sets, strict=True)]
            sets = [_within(contacts, reach[i]) for i, contacts in zip(open_.tolist(), sets, strict=True)]
            line[open_], pressure[open_], closing[open_], tangent[open_], closed = self._solved(sets, line_load)
        unloaded = None if self.flanks is None else least
        return Solved(found.order, closing, tangent, line, pressure, tuple(open_[closed].tolist()), unloaded)

    def _solved(self, sets, line_load):
        """Line loads and pressures by pair, approach and tangent of contact problems `sets`, and which crack faces touch."""
        names = ("flexibility", "gap", "coefficient", "radius", "column")
        flexibility, gap, coefficient, radius, column = (stacked([contacts[name] for contacts in sets]) for name in names)
        there = stacked([np.ones(contacts["gap"].size, dtype=bool) for contacts in sets])
        radius[~there] = 1.0
        case = flexibility, gap, line_load, coefficient, radius, self.modulus, there
        force, approach, tangent, settled = line_contacts(*case)
        closed = []
        for k, contacts in enumerate(sets):
            own = force[k, : contacts["gap"].size]
            if not settled[k]:
                own[:], approach[k], tangent[k] = self._share(contacts, line_load)
            if self.opening is not None and _closing(own @ contacts["opening"]):
                closed.append(k)
                own[:], approach[k], tangent[k] = self._share_closing(contacts, line_load)
        row = np.broadcast_to(np.arange(len(sets))[:, None], column.shape)
        line, pressure = np.zeros((2, len(sets), self.found.order.size))
        np.add.at(line, (row, column), force)
        single, hat = coefficient > 0, there & (coefficient == 0)
        pressure[row[hat], column[hat]] = np.nan
        pressure[row[single], column[single]] = peak_pressure(force[single], radius[single], self.modulus)
        pressure[(line == 0) & np.isnan(pressure)] = 0.0
        return line, pressure, approach, tangent, closed

    def _share(self, contacts, line_load, weight=None):
        names = ("coefficient", "radius")
        case = contacts["flexibility"], contacts["gap"], line_load, *(contacts[n] for n in names), self.modulus
        return line_contact(*case, weight)

    def _share_closing(self, contacts, line_load):
        """The same contacts with crack faces that can push each other apart but not pass through."""
        faces = block_diag(*(flexible.seam.influence for flexible in self.flexibility if flexible.seam))
        opening = contacts["opening"].T
        m, n = opening.shape
        extended = {
            "flexibility": np.block([[contacts["flexibility"], opening.T], [opening, faces]]),
            "gap": np.append(contacts["gap"], np.zeros(m)),
            "coefficient": np.append(contacts["coefficient"], np.zeros(m)),
            "radius": np.append(contacts["radius"], np.ones(m)),
        }
        force, approach, tangent = self._share(extended, line_load, np.append(np.ones(n), np.zeros(m)))
        return force[:n], approach, tangent

    def _opening(self, roll_1, roll_2, order):
        """Opening ``(..., contacts, faces)`` of all cracks under unit loads, None without cracks."""
        rows = []
        for flexible, roll, teeth in zip(self.flexibility, (roll_1, roll_2), (order, -order), strict=True):
            if flexible.seam is not None:
                arc = np.clip(arc_at(flexible.gear, roll), *flexible.limits)
                rows.append(flexible.seam.at(arc, (teeth % flexible.gear.z).tolist()))
        return np.concatenate(rows, axis=-1) if rows else None

    def _reach(self, line_load):
        """Gap beyond the first touch [mm] that no contact can close, by phase: twice what the best pair gives alone."""
        best = np.argmin(self.found.gap, axis=1)
        at = np.arange(best.size), best
        local = sum(self.coefficients) * (np.log(2 / half_width(line_load, self.radius[at], self.modulus)) + 0.5)
        own = 0.0 if self.flanks is not None else self.found.gap[at]
        return own + 2 * np.maximum(self.matrix[at[0], best, best] + local, 0.0) * line_load

    def _corners(self, line_load):
        """For each phase and pair: 0, or the gear (1, 2) whose tip corner it touches."""
        corner = np.zeros(self.found.gap.shape, dtype=int)
        if not self.extended:
            return corner
        reach = CORNER * half_width(line_load, self.radius, self.modulus)
        sharp = [self.flanks is None or form.edge is None for form in self.flanks or (None, None)]
        for number, gear, roll in ((1, self.pair.gear_1, self.found.roll_1), (2, self.pair.gear_2, self.found.roll_2)):
            if sharp[number - 1]:
                corner[arc_at(gear, gear.roll_a) - arc_at(gear, roll) < reach] = number
        return corner

    def _shrunk(self, line_load):
        """By what hats at corners are shrunk towards them, so that a contact under `line_load` spans some."""
        hats = [np.diff(np.sort(flexible.tip_of(0).arc))[-1] for flexible in self.flexibility if self.extended]
        if not hats:
            return 1.0
        radius = self.pair.relative_radius(end := np.array(self.pair.path), self.pair.mate_roll(end))
        width = half_width(line_load, np.abs(radius).min(), self.modulus)
        return min(1.0, float(width) / (RESOLVED * max(hats)))

    def find_gaps(self, rows, scale=1.0):
        """Keep gaps and places of the hats of `rows` (phase, column, gear whose tip corner touches), all found at once."""
        teeth = {}
        for i, column, corner in rows:
            if (i, column, corner, scale) not in self._gaps:
                tip = self._tip(column, corner)
                teeth.setdefault((corner, id(tip)), (tip, []))[1].append((i, column))
        for (corner, _), (tip, found) in teeth.items():
            gear = (self.pair.gear_1, self.pair.gear_2)[corner - 1]
            roll = roll_at_arc(gear, _towards(tip.arc, gear, scale))
            at = tuple(np.array(found).T)
            nominal, start = (values[at][:, None] for values in (self.found.nominal, self.found.gap))
            own = {"flanks": self.flanks, "order": self.found.order[at[1]][:, None]}
            gap, met = self.pair.approach(roll, nominal, driver=corner == 1, start=start, **own)
            self._gaps |= {(*row, corner, scale): (gap[j], met[j]) for j, row in enumerate(found)}

    def _tip(self, column, corner):
        """`TipHats` of the gear whose corner a pair touches."""
        order = self.found.order[column]
        return self.flexibility[corner - 1].tip_of(order if corner == 1 else -order)

    def contacts_at(self, wanted, kinks=None, scale=1.0):
        """Unknowns of the contact problems at some phases.

        Parameters
        ----------
        wanted : sequence of (int, ndarray of int, ndarray of int)
            Number of a phase; columns of the pairs that may touch; for each of them 0, or the gear (1, 2) whose tip corner it
            touches, or `KINK`: then it is a row of hats.
        kinks : dict, optional
            The rows at kinks, from `gearfe.contact.kinks.kink_rows`: they are those of one load.
        scale : float
            By what hats at corners are shrunk towards them. Near its corner a tooth is a wedge, which looks the same at every
            scale: what hats do to each other then only grows by the half-planes' ``-ln(scale)``.

        Returns
        -------
        list of dict
            ``flexibility``, ``gap``, ``coefficient`` of the logarithm, ``radius``, pair ``column`` and crack ``opening``.
        """
        keys = [(i, tuple(near.tolist()), tuple(corner.tolist()), scale) for i, near, corner in wanted]
        alike = {}  # phases at which the same pairs touch in the same way
        for i, near, corner, _ in keys:
            if KINK in corner or (i, near, corner, scale) not in self._known:
                alike.setdefault((near, corner), []).append(i)
        rows = [(i, *one) for pairs, own in alike.items() for one in zip(*pairs, strict=True) for i in own]
        self.find_gaps([row for row in rows if row[2] in (1, 2)], scale)
        for (near, corner), own in alike.items():
            built = self._built(np.array(own), near, corner, kinks, scale)
            self._known |= {(i, near, corner, scale): contacts for i, contacts in zip(own, built, strict=True)}
        return [self._known[key] for key in keys]

    def _built(self, phases, near, corner, kinks, scale):
        parts = [
            _aligned([kinks[i, column] for i in phases.tolist()]) if number == KINK else self._row(phases, column, number, scale)
            for column, number in zip(near, corner, strict=True)
        ]
        column = np.repeat(near, [part[0].shape[1] for part in parts])
        order = self.found.order[column]
        roll_1, roll_2, gap, coefficient, radius = (np.concatenate([part[k] for part in parts], axis=1) for k in range(5))
        total = self.flexibility[0].matrix(roll_1, order) + self.flexibility[1].matrix(roll_2, -order)
        for part, k in zip(parts, near, strict=True):
            own = np.flatnonzero(column == k)
            if part[5] is not None:
                total[:, own[:, None], own] = part[5]
        opening = self._opening(roll_1, roll_2, order)
        if opening is not None:
            total = total + opening @ self.stiffness @ np.swapaxes(opening, -1, -2)
        out, there = [], np.isfinite(gap)
        for k, on in enumerate(there):
            values = {"gap": gap[k], "coefficient": coefficient[k], "radius": radius[k], "column": column}
            own = {name: value[on] for name, value in values.items()} | {"flexibility": total[k][on][:, on]}
            out.append(own | {"opening": None if opening is None else opening[k, on]})
        return out

    def _row(self, phases, column, corner, scale):
        """Unknowns ``(phases, n)`` of one pair: roll_1, roll_2, gap, coefficient, radius, and their influence for a corner.

        The gap is nan where a hat has no flank before it.
        """
        found = self.found
        if corner == 0:
            roll_1, roll_2, gap, radius = (v[phases, column, None] for v in (found.roll_1, found.roll_2, found.gap, self.radius))
            return roll_1, roll_2, gap, np.full(gap.shape, sum(self.coefficients)), radius, None
        tip, flank = (0, 1) if corner == 1 else (1, 0)
        gears, tooth = (self.pair.gear_1, self.pair.gear_2), (found.order[column], -found.order[column])
        hats = self._tip(column, corner)
        gap, met = (
            np.array(values) for values in zip(*(self._gaps[i, column, corner, scale] for i in phases.tolist()), strict=True)
        )
        met[np.isnan(met)] = gears[flank].roll_a  # no flank before it
        arc, top = arc_at(gears[flank], met), arc_at(gears[flank], gears[flank].roll_a)
        gap[~(arc < top)] = np.nan
        middle = np.clip((arc[:, :, None] + arc[:, None, :]) / 2, *self.flexibility[flank].limits)
        mate = self.flexibility[flank].near_of(tooth[flank])(middle)
        mate = mate + self.coefficients[flank] * hat_logarithm(hats.knots, hats.knots) - sum(self.coefficients) * math.log(scale)
        roll = np.broadcast_to(roll_at_arc(gears[tip], _towards(hats.arc, gears[tip], scale)), met.shape)
        rolls = (roll, met) if corner == 1 else (met, roll)
        return *rolls, gap, np.zeros(gap.shape), np.ones(gap.shape), hats.influence + mate

"""All tooth pairs at one phase: who carries what, and how far the gears approach.

A pair well inside its flanks is one contact with Hertz's logarithm. Where the contact reaches a tip corner there is no such
formula: that pair becomes a row of hat pressures up to the corner, with the exact gap at each. So it does where a modified flank
has a kink within the contact: a row of hats on both sides of the touching point (`gearfe.contact.kinks`).
"""

import numpy as np
from scipy.linalg import block_diag

from geometry.tooth.profile import arc_at, roll_at_arc

from ..flexibility.hertz import contact_modulus, half_plane, half_width, hat_logarithm, peak_pressure
from ..flexibility.section_contact import Solved
from .kinks import kink_rows, near_kink
from .sharing import line_contact, line_contacts

# A contact whose middle is closer to a tip corner than so many half widths of the whole load is resolved hat by hat: near
# the corner a pair carries about half of it, and its own half width is then smaller by sqrt(2).
CORNER = 0.7
KINK = 3  # number of a pair whose contact reaches a kink of a flank; 1 and 2 are those at a tip corner
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
        self._known, self._rows, self._gaps = {}, {}, {}
        self._starts = {}  # line loads found last, by phase

    def solve(self, line_load):
        """Contact under `line_load` [N/mm] at all phases."""
        found, c = self.found, sum(self.coefficients)
        reach = self._reach(line_load)
        possible = found.gap < reach[:, None]
        corner = np.where(possible, self._corners(line_load), 0)
        line, approach, tangent, done = line_contacts(self.matrix, found.gap, line_load, c, self.radius, self.modulus, possible)
        pressure = peak_pressure(line, self.radius, self.modulus)
        kink = near_kink(self, line_load) & possible & (corner == 0)
        done &= ~(corner.any(axis=1) | kink.any(axis=1))
        if self.opening is not None:
            done &= ~_closing(np.einsum("pcf,pc->pf", self.opening, line))
        self.find_gaps([(i, column, int(corner[i, column])) for i, column in np.argwhere(corner > 0).tolist()])
        closed = []
        kinks = kink_rows(self, np.argwhere(kink), line_load)
        for i in np.flatnonzero(~done).tolist():
            line[i] = pressure[i] = 0.0
            near = np.flatnonzero(possible[i])
            rows = kinks if kink[i].any() else None
            contacts = _within(self.contacts_at(i, near, np.where(kink[i], KINK, corner[i])[near], rows), reach[i])
            near_by = self._starts.get(i) if i in self._starts else self._starts.get(i - 1)
            start = near_by if near_by is not None and near_by.size == contacts["gap"].size else None
            force, approach[i], tangent[i] = self._share(contacts, line_load, start=start)
            self._starts[i] = force
            if self.opening is not None and _closing(force @ contacts["opening"]):
                closed.append(i)
                force, approach[i], tangent[i] = self._share_closing(contacts, line_load)
            np.add.at(line[i], contacts["column"], force)
            single = contacts["coefficient"] > 0
            peak = peak_pressure(force[single], contacts["radius"][single], self.modulus)
            pressure[i, contacts["column"][~single]] = np.nan
            pressure[i, contacts["column"][single]] = peak
        pressure[(line == 0) & np.isnan(pressure)] = 0.0
        unloaded = None if self.flanks is None else found.gap.min(axis=1)
        return Solved(found.order, approach, tangent, line, pressure, tuple(closed), unloaded)

    def _share(self, contacts, line_load, weight=None, start=None):
        names = ("coefficient", "radius")
        case = contacts["flexibility"], contacts["gap"], line_load, *(contacts[n] for n in names), self.modulus
        return line_contact(*case, weight, start)

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
        """Gap [mm] no contact can close, by phase: the best pair's, and twice what it gives alone."""
        best = np.argmin(self.found.gap, axis=1)
        at = np.arange(best.size), best
        local = sum(self.coefficients) * (np.log(2 / half_width(line_load, self.radius[at], self.modulus)) + 0.5)
        return self.found.gap[at] + 2 * np.maximum(self.matrix[at[0], best, best] + local, 0.0) * line_load

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

    def find_gaps(self, rows):
        """Keep gaps and places of the hats of `rows` (phase, column, gear whose tip corner touches), all found at once."""
        teeth = {}
        for i, column, corner in rows:
            if (i, column, corner) not in self._gaps:
                tip = self._tip(column, corner)
                teeth.setdefault((corner, id(tip)), (tip, []))[1].append((i, column))
        for (corner, _), (tip, found) in teeth.items():
            roll = roll_at_arc((self.pair.gear_1, self.pair.gear_2)[corner - 1], tip.arc)
            at = tuple(np.array(found).T)
            nominal, start = (values[at][:, None] for values in (self.found.nominal, self.found.gap))
            own = {"flanks": self.flanks, "order": self.found.order[at[1]][:, None]}
            gap, met = self.pair.approach(roll, nominal, driver=corner == 1, start=start, **own)
            self._gaps |= {(*row, corner): (gap[j], met[j]) for j, row in enumerate(found)}

    def _tip(self, column, corner):
        """`TipHats` of the gear whose corner a pair touches."""
        order = self.found.order[column]
        return self.flexibility[corner - 1].tip_of(order if corner == 1 else -order)

    def contacts_at(self, i, near, corner, kinks=None):
        """Unknowns of the contact problem at one phase.

        Parameters
        ----------
        i : int
            Number of the phase.
        near : ndarray of int
            Columns of the pairs that may touch.
        corner : ndarray of int
            For each of them 0, or the gear (1, 2) whose tip corner it touches, or `KINK`: then it is a row of hats.
        kinks : dict, optional
            The rows at kinks, from `gearfe.contact.kinks.kink_rows`: they are those of one load.

        Returns
        -------
        dict
            ``flexibility``, ``gap``, ``coefficient`` of the logarithm, ``radius``, pair ``column`` and crack ``opening``.
        """
        if kinks is not None:
            return self._built(i, near, corner, kinks)
        key = i, tuple(near), tuple(corner)
        if key not in self._known:
            self._known[key] = self._built(i, near, corner, {})
        return self._known[key]

    def _built(self, i, near, corner, kinks):
        parts = [
            kinks[i, column] if number == KINK else self._row(i, column, number)
            for column, number in zip(near, corner, strict=True)
        ]
        roll_1, roll_2, gap, coefficient, radius = (np.concatenate([part[k] for part in parts]) for k in range(5))
        column = np.repeat(near, [part[0].size for part in parts])
        order = self.found.order[column]
        total = self.flexibility[0].matrix(roll_1, order) + self.flexibility[1].matrix(roll_2, -order)
        for part, k in zip(parts, near, strict=True):
            if part[5] is not None:
                total[np.ix_(column == k, column == k)] = part[5]
        opening = self._opening(roll_1, roll_2, order)
        if opening is not None:
            total = total + opening @ self.stiffness @ opening.T
        return {
            "flexibility": total, "gap": gap, "coefficient": coefficient, "radius": radius, "column": column, "opening": opening
        }  # fmt: skip

    def _row(self, i, column, corner):
        if (i, column, corner) not in self._rows:
            self._rows[i, column, corner] = self._made(i, column, corner)
        return self._rows[i, column, corner]

    def _made(self, i, column, corner):
        """Unknowns of one pair: roll_1, roll_2, gap, coefficient, radius, and the influence among them for a corner."""
        found = self.found
        if corner == 0:
            single = (found.roll_1, found.roll_2, found.gap, self.radius)
            roll_1, roll_2, gap, radius = (np.array([values[i, column]]) for values in single)
            return roll_1, roll_2, gap, np.array([sum(self.coefficients)]), radius, None
        tip, flank = (0, 1) if corner == 1 else (1, 0)
        gears, tooth = (self.pair.gear_1, self.pair.gear_2), (found.order[column], -found.order[column])
        hats = self._tip(column, corner)
        roll = roll_at_arc(gears[tip], hats.arc)
        self.find_gaps([(i, int(column), int(corner))])  # unless they are known
        gap, met = self._gaps[i, int(column), int(corner)]
        there = np.isfinite(met)
        there[there] = arc_at(gears[flank], met[there]) < arc_at(gears[flank], gears[flank].roll_a)
        keep = np.ix_(there, there)
        arc = arc_at(gears[flank], met[there])
        middle = np.clip((arc[:, None] + arc[None, :]) / 2, *self.flexibility[flank].limits)
        mate = self.flexibility[flank].near_of(tooth[flank])(middle)
        mate = mate + self.coefficients[flank] * hat_logarithm(hats.knots[:, there], hats.knots[:, there])
        rolls = (roll[there], met[there]) if corner == 1 else (met[there], roll[there])
        zero = np.zeros(there.sum())
        return *rolls, gap[there], zero, zero + 1.0, hats.influence[keep] + mate

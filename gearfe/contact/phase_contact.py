"""Load distribution of a gear pair of finite width, for many mesh positions at once."""

import math
from dataclasses import replace
from functools import partial

import numpy as np

from ..core.steps import steps
from ..flexibility.hertz import contact_modulus, half_width, peak_pressure
from ..geometry.pair.broken import ToothPairs
from ..geometry.pair.contacts import TIP, neighbours_of
from ..geometry.pair.lines import bands_of
from .bodies import between, faces_of, mirrors_of
from .broken_teeth import without_recesses
from .cell_batch import Carried, CellBatch, alike_halves, furthest_gap, hubs_of, same_bodies, together
from .cell_sharing import SharedLines
from .cells import SETTLED, TIMES, carrying, cells_of
from .corner import CornerLaw, in_fillet, plain_radius
from .hubs import given_way
from .joined_lines import System
from .kink_law import KinkLaw
from .pieces import beyond, pieces_of
from .sliding import MOST, cracks_beyond_lines, off_path, slid
from .unknowns import OVERLAP

FINEST = 1.5  # length of the shortest cell [Hertz half widths]
ALIKE = 1e-9  # tolerance of equal halves, of which only one is solved [base pitches]
DEEPEST = 0.01  # search depth for the floor of a pit that covers a whole contact line [m_n]
ROW = math.sqrt(2)  # ratio of the forces for which cell divisions are made
REACH = 1.3  # growth of the search radius for gaps if it was too small
TOGETHER = 16  # phases that are solved at once


class PhaseContact:
    """Contact lines of a gear pair under a force, with pits.

    The cells are those of the next larger force in a series (`ROW`). Nearly equal forces therefore have equal cells, so that the
    difference of their approaches contains no change of discretisation.

    Parameters
    ----------
    case : Case
    force : float
        One of its loads, in the transverse section [N].
    step, extended
        As in `gearfe.contact.wide_contact.pair_stiffness3d`.
    longer : int
        Of `gearfe.contact.cells.cells_of`.
    cache
        As in `gearfe.contact.corner.CornerLaw`.
    """

    def __init__(self, case, force, *, step, extended, longer, cache=True):
        pair, materials, flanks, (pits, broken) = case.pair, case.materials, case.forms, without_recesses(case)
        self.pair, self.pits, self.step, self.extended, self.longer = pair, pits, step, extended, longer
        self.force = force
        self.hubs = hubs_of(case.held or ())
        self.pairs = ToothPairs(pair, broken)
        self.flanks, self.least = flanks, 0.0 if flanks is None else sum(form.bounds()[0] for form in flanks)
        self.floors = sorted({pit.depth for pit in (*pits[0], *pits[1]) if pit.side == "loaded"})
        self.deepest = DEEPEST * pair.gear_1.m_n
        self.bands = bands_of(pair, case.runs, case.groove)
        self.width = sum(abs(last - first) for first, last in self.bands)
        self.beta_b = abs(pair.gear_1.beta_b)
        self.radius, self.modulus = pair.pitch_relative_radius / math.cos(self.beta_b), contact_modulus(materials)
        self.furthest = furthest_gap(pair) if extended else 0.0
        unit = self.modulus * pair.gear_1.m_n * self.width
        self.sized = unit * ROW ** math.ceil(math.log(force / unit, ROW) - 1e-9)
        # The initial estimate is the logarithmic deflection of the half-plane over one tooth, doubled for the tooth itself.
        load, self.bed = force / self.width, math.pi * self.modulus / 40
        self.reach = self.sized / self.width / self.bed
        further = self._further(self.least + 80 / (math.pi * self.modulus) * load)
        if case.missing:  # The teeth next to the gap are this far from their path.
            further = [max(away, (2 - pair.eps_alpha) * pair.p_bt) for away in further]
        self._laws, self._make_law = {}, partial(CornerLaw, pair, materials, load, further, cache=cache)
        self.least_neighbours = neighbours_of(pair) if any(case.cracks) or any(case.broken) else 1
        kinked = any(form.kinks for form in flanks or ())
        self.kinks = KinkLaw(pair, materials, load, flanks, cache=cache) if kinked else None

    @property
    def neighbours(self):
        """Largest difference between the numbers of tooth pairs in contact at one phase, for the first estimate of the approach.

        With damage it is at least as large as in sections, so that cracks affect equally many neighbours.
        """
        ratio = self.pair.eps_beta_of(self.width / len(self.bands)) if self.beta_b else 0.0
        further = sum(self._further(self.least + self.reach)) / self.pair.p_bt
        return max(self.least_neighbours, math.floor(self.pair.eps_alpha + ratio + further))

    def _further(self, reach):
        """Return the distance beyond the path [mm] within which gaps are below `reach`, plus the least material removed."""
        return beyond(self.pair, reach - self.least) if self.extended else (0.0, 0.0)

    def solve(self, phases, bodies):
        """Return the `Carried` of each phase.

        Parameters
        ----------
        phases : list of float
        bodies : callable
            ``bodies(n)`` gives ``[((Flexibility3D, offset), (Flexibility3D, offset)), ...]``: both gears of each
            half, and the offset at which their contact begins [mm]. At least n teeth after each loaded tooth are coupled to it.

        Raises
        ------
        RuntimeError
            If there is no contact. The message states the phase.
        """
        parts = [phases[k : k + TOGETHER] for k in range(0, len(phases), TOGETHER)]
        return [carried for part in steps(parts, weights=[len(part) for part in parts]) for carried in self._part(part, bodies)]

    def _part(self, phases, bodies):
        """Return the result of `solve` for phases that are solved at once.

        The extent of the cells depends on their own phase only, so that k does not depend on the other phases.
        """
        done = [None] * len(phases)
        reaches, closings, open_ = np.full(len(phases), self.least + self.reach), np.zeros(len(phases)), list(range(len(phases)))
        while open_:
            cells = self._cells([phases[i] for i in open_], reaches[open_], closings[open_])
            filled = [(i, group) for i, group in zip(open_, cells, strict=True) if group is not None]
            carried = self._shared(self._batch([group for _, group in filled], bodies)) if filled else ()
            for (i, _), loaded in zip(filled, carried, strict=True):
                grown = self._grown(loaded, reaches[i], closings[i])
                if grown is None:
                    done[i] = loaded
                else:
                    reaches[i], closings[i] = grown
            for i in (i for i, group in zip(open_, cells, strict=True) if group is None):
                reaches[i], closings[i] = self._widened(phases[i], reaches[i], closings[i])
            open_ = [i for i in open_ if done[i] is None]
        return done

    def _grown(self, loaded, reach, closing):
        """Return larger `reach` and `closing` [mm] if the solution `loaded` of a phase requires more contacts, else None."""
        closes = loaded.approach - loaded.least  # part of the approach that closes gaps between teeth
        normal = closes * math.cos(self.beta_b)
        if any(closing < depth < normal for depth in self.floors):
            # The floors of shallow pits carry load: solve again with them. This can only stiffen the pair.
            return reach, normal
        if self.extended and closes > reach and reach - self.least <= self.furthest:
            needed = (closes - self.least) / (reach - self.least)
            return self.least + (reach - self.least) * REACH ** math.ceil(math.log(needed, REACH)), closing
        return None

    def _widened(self, phase, reach, closing):
        """Return larger reach and closing [mm] for a phase without cells. RuntimeError if no flanks are within reach."""
        if reach - self.least <= self.furthest:
            return 2 * reach, closing
        if any(closing < depth <= self.deepest for depth in self.floors):
            return reach, self.deepest
        raise RuntimeError(f"no contact at phase {phase:g}: damage covers it all, or the pair has left its path of contact")

    def _cells(self, phases, reaches, closings):
        """Return the `Cells` of each phase, None for a phase without cells."""
        away = reaches - self.least if self.extended else 0.0 * reaches
        pieces = pieces_of(self.pair, phases, self.pits, self.bands, self.beta_b, away, closings, self.pairs)
        sizes = []
        for group in pieces:
            length = sum(piece.last - piece.first for piece in group if not piece.floor or all(each.floor for each in group))
            finest = FINEST * self._half_width(length) if group else 0.0
            sizes.append((finest, max(self.step, finest)))
        if not any(pieces):
            return [None] * len(phases)
        whole, number = self._close(pieces, sizes)
        ends = np.searchsorted(number, np.arange(len(phases) + 1)).tolist()
        return [whole.some(slice(a, b)) if b > a else None for a, b in zip(ends[:-1], ends[1:], strict=True)]

    def _half_width(self, length):
        """Return the Hertzian half width under the force on a contact line of a `length` [mm]."""
        return float(half_width(self.sized / length, self.radius, self.modulus))

    def _close(self, pieces, sizes):
        """Return the cells of the pieces, shorter where modified flanks leave contact on a few cells only."""
        arguments = self.pair, pieces, self.bands, math.tan(self.beta_b), sizes, self.flanks
        fine = {}
        if self.flanks is not None and any(form.wide for form in self.flanks):
            for _ in range(TIMES):
                finer = carrying(*cells_of(*arguments, fine=fine, pairs=self.pairs), pieces, self.sized, self.bed)
                least = {at: FINEST * self._half_width(high - low) for at, (low, high, _) in finer.items()}
                finer = {at: (*zone[:2], max(zone[2], least[at])) for at, zone in finer.items()}
                finer = {at: zone for at, zone in finer.items() if zone[2] < SETTLED * (fine[at][2] if at in fine else self.step)}
                if not finer:
                    break
                fine |= finer
        return cells_of(*arguments, longer=self.longer, fine=fine, pairs=self.pairs)

    def _batch(self, cells, bodies):
        """`CellBatch` of several phases. The equal halves of a herringbone pair are solved once."""
        cos, halves = math.cos(self.beta_b), bodies(max(int(np.ptp(group.order)) for group in cells))
        double = len(halves) > 1 and self.hubs is None and same_bodies(*halves)
        alike = np.array([double and alike_halves(group, group.half == 0, ALIKE * self.pair.p_bt) for group in cells])
        solved = [group.some(group.half == 0) if half else group for group, half in zip(cells, alike.tolist(), strict=True)]
        whole, spans = together(solved)
        radius = self._radius(whole)
        systems, yields = [], []
        for group, matrix, span in zip(solved, between(solved, halves), spans, strict=True):
            ends = tuple((group.depth + side * group.width / 2) / cos for side in (-1, 1))
            line = np.cumsum(np.append(0, (np.diff(group.half) != 0) | (np.diff(group.order) != 0)))
            faces, mirrors, block = faces_of(group, halves), mirrors_of(group, halves), group.half
            yields.append(None)
            if self.hubs is not None:  # Both halves of a herringbone gear are on one hub.
                yields[-1] = given_way(group, self.pair, self.hubs, self.bands, self.beta_b)
                matrix, block = matrix + yields[-1], np.zeros(group.z.size, dtype=int)
                faces = None if faces is None else (*faces[:2], np.zeros_like(faces[2]))
            systems.append(System(matrix, cos * group.gap, ends, line, radius[span], block, faces, group.floor, mirrors))
        lines = SharedLines(systems, sum(body.kernel for body, _ in halves[0]), self.modulus)
        return CellBatch(cells, solved, alike, lines, whole, spans, radius, yields, halves)

    def _shared(self, batch):
        """`Carried` of the phases of a batch."""
        load, ends = self.force / math.cos(self.beta_b) / np.where(batch.alike, 2, 1), self._ends(batch.all)
        shared = batch.lines.solve(load, self._local(batch.all, ends))
        sizes = [group.z.size for group in batch.solved]
        forces = np.concatenate([one.force[:size] for one, size in zip(shared, sizes, strict=True)])
        slides = slid(batch.all, np.repeat(np.arange(len(sizes)), sizes), batch.bodies, forces, batch.radius)
        return [
            self._told(batch, i, one, ends[span], slides[:, span])
            for i, (one, span) in enumerate(zip(shared, batch.spans, strict=True))
        ]

    def _local(self, cells, ends):
        """Return the local contact law of the cells for `SharedLines.solve`, or None if Hertz's law holds everywhere.

        `ends` is the result of `_ends`.
        """
        laws, kinks = self._laws_at(cells), self.kinks
        at = ends.copy()
        for end, form in enumerate((self.flanks or ())[::-1]):
            # A rounded tip has no sharp corner.
            at[(at == end) & (form.edge is not None) & np.isin(cells.corner, (0, *TIP))] = -1
        corner, bent = (at >= 0).any(), kinks is not None and bool(kinks.zones)
        soft = np.zeros(at.size)
        for law, on in laws:
            away = np.flatnonzero(on & (at < 0))
            soft[away] = law.softer(cells.roll_1[away], cells.roll_2[away])

        def local(line_load):
            out = soft.copy()
            for law, on in laws if corner else ():
                out += law(np.where(on, at, -1), cells.nominal, line_load)
            return out + kinks(at < 0, cells.nominal, line_load) if bent else out

        return local if corner or bent or soft.any() else None

    def _laws_at(self, cells):
        """Return the laws of corners, each with the mask of its cells ``(n,)``."""
        by_law, part = {}, self.pairs.parts(cells.z)
        for place in sorted(set(zip(cells.order.tolist(), part.tolist(), strict=True))) if self.extended else ():
            chips = tuple(one and replace(one, tooth=0) for one in self.pairs.broken_at(*place))
            if chips not in self._laws:
                self._laws[chips] = self._make_law(chips=chips)
            on = (cells.order == place[0]) & (part == place[1])
            by_law[self._laws[chips]] = by_law.get(self._laws[chips], False) | on
        return list(by_law.items())

    def _ends(self, cells):
        """Return the end of the path whose corner each cell touches or nearly touches, see `CornerLaw.ends`."""
        out = np.full(cells.z.size, -1)
        for law, on in self._laws_at(cells):
            out[on] = law.ends(cells)[on]
        return out

    def _told(self, batch, i, shared, ends, slides):
        """Return `Carried` of phase i of a batch. `ends` and `slides` are the results of `_ends` and `slid` at its cells."""
        solved, bodies, yields, radius = batch.solved[i], batch.bodies, batch.yields[i], batch.radius[batch.spans[i]]
        n, cos = solved.z.size, math.cos(self.beta_b)
        load, closed = shared.force[:n], bool(shared.force[n:].sum() > OVERLAP * shared.force[:n].sum())
        pressure = peak_pressure(load * cos / solved.width, radius, self.modulus)
        pressure[(solved.corner > 0) & (load > 0)] = np.nan
        times = 2 if batch.alike[i] else 1
        loaded = replace(batch.cells[i], load=np.tile(load, times), pressure=np.tile(pressure, times))
        way = np.zeros(n) if yields is None else yields @ load / cos
        given = float(load @ way / load.sum()), float(way.min())
        gap = cos * solved.gap - (solved.floor if self.flanks is None else 0.0)
        closing = shared.approach - float(gap.min())
        slide, unsure = _slid(solved, (ends, slides), load, closing, closed)
        unsure += cracks_beyond_lines(solved, bodies, load, closing)
        tangent = 1 / (1 / shared.tangent - 2 * slide / load.sum())
        beyond_it = off_path(self, solved, load, radius, shared.approach)
        return Carried(loaded, (shared.approach - slide) / cos, times * tangent * cos**2, closed, *given, unsure, beyond_it)

    def _radius(self, cells):
        """Return the relative radii of curvature of cells in the normal section [mm]."""
        radius = plain_radius(self.pair, *cells.rolls)
        modified = (cells.radius > 0) & ~in_fillet(self.pair, *cells.rolls)
        return np.where(modified, cells.radius, radius) / math.cos(self.beta_b)


def _slid(cells, at_cells, load, closing, closed):
    """Return the reduction of the approach by sliding [mm], normal to the flanks, and the relative uncertainty of the rest.

    `at_cells` are the results of `PhaseContact._ends` and `slid`. `closing` is the approach beyond the first touch [mm]. At
    corners the corner law already contains sliding, except sliding due to cracks. Sliding is neglected where crack faces are
    `closed`. Large displacements of open cracks add to the uncertainty.
    """
    (ends, slide), share = at_cells, load / load.sum()
    alike = (cells.half[:, None] == cells.half) & (cells.order[:, None] == cells.order)
    open_, healthy = share * np.minimum(slide[:2], MOST * closing)
    saved = np.minimum(open_, share * MOST * closing * (alike @ share))
    smooth = (cells.corner == 0) & (ends < 0)
    unsure = np.where(smooth, healthy if closed else share * slide[0] - saved, np.abs(open_ - healthy))
    unsure += 0.0 if closed else share * slide[2]
    return 0.0 if closed else float(saved[smooth].sum()), float(unsure.sum() / closing)

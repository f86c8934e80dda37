"""Contact of a pair of finite width at one phase: cells as far beyond the path as the approach reaches, and their loads."""

import math
from dataclasses import replace

import numpy as np

from geometry.pair.lines import bands_of
from geometry.pair.modified import first_touch

from ..flexibility.hertz import contact_modulus, half_width, peak_pressure
from .bodies import between, faces_of
from .cell_sharing import line_cells
from .cells import Cells, beyond, cells_of, gaps, pieces_of, touching
from .corner import CornerLaw
from .hubs import given_way, hubs_of

FINEST = 1.5  # shortest cell, in Hertz half widths: a load finer than it is wide is no line
ALIKE = 1e-9  # difference of the cells of two halves that are solved once [mm]
DEEPEST = 0.01  # modules: the floor of a pit that covers a whole line is looked for so deep
FINE, ROUNDS = 9, 2  # places along the cell with the least gap, and how often they are looked for more closely
REACH = 1.3  # initial search radius for gaps, in approaches of the phase before


class PhaseContact:
    """The contact lines of a pair, with pits, under a force.

    Parameters
    ----------
    pair : GearPair
    force : float
        In the transverse section [N].
    materials : (Material, Material)
    pits : (sequence of Pit, sequence of Pit)
    face, groove, step, extended
        As in `gearfe.contact.solid.pair_stiffness3d`.
    flanks : (FlankForm, FlankForm), optional
        Modifications of pinion and wheel, `geometry.pair.flanks.flank_forms`.
    cache
        As in `gearfe.contact.corner.CornerLaw`.
    supports : (Support or Shaft or None, Support or Shaft or None), optional
        What holds the hubs of pinion and wheel; None: rigid.
    """

    def __init__(self, pair, force, materials, *, pits, face, groove, step, extended, flanks=None, cache=True, supports=None):
        self.hubs = hubs_of(supports)
        self.pair, self.force, self.pits, self.step, self.extended = pair, force, pits, step, extended
        self.flanks, self.least = flanks, 0.0 if flanks is None else sum(form.bounds()[0] for form in flanks)
        self.floors = sorted({pit.depth for own in pits for pit in own if pit.side == "loaded"})
        self.deepest = DEEPEST * pair.gear_1.m_n
        self.bands = bands_of(pair, face, groove)
        self.width = sum(abs(last - first) for first, last in self.bands)
        self.beta_b = abs(pair.gear_1.beta_b)
        radius = pair.relative_radius(*pair.curvature_radii(pair.pitch_phase)) / math.cos(self.beta_b)
        self.radius, self.modulus = abs(float(radius)), contact_modulus(materials)
        # first guess of the approach: the half-plane's logarithm over the size of a tooth, and as much for the tooth
        self.reach = 40 / (math.pi * self.modulus) * force / self.width
        self.furthest = max((float(gap[-1]) for _, gap in gaps(pair) if gap.size), default=0.0) if extended else 0.0
        case = (pair, materials, force / self.width, self._further(self.least + 2 * self.reach))
        self.law = CornerLaw(*case, cache=cache) if extended else None

    @property
    def neighbours(self):
        """Largest difference of the orders of pairs in contact at the same phase, by the first guess of the approach."""
        ratio = self.pair.eps_beta_of(self.width / len(self.bands)) if self.beta_b else 0.0
        return max(1, math.floor(self.pair.eps_alpha + ratio + sum(self._further(self.least + self.reach)) / self.pair.p_bt))

    def _further(self, reach):
        """How far beyond the path [mm] gaps are below `reach`; flanks with less material have larger ones by `least` or more."""
        return beyond(self.pair, reach - self.least) if self.extended else (0.0, 0.0)

    def solve(self, phase, bodies, reach=None):
        """`Cells` with their loads, the approach in the transverse section, whether faces of a crack touched, and what hubs gave.

        The last are two parts of the approach: what the supports of the hubs give way, the mean over the loads (so that it adds
        up to the approach with the rest), and at the cell where it is least.

        Parameters
        ----------
        phase : float
        bodies : callable
            ``bodies(n)`` gives ``[((Flexibility3D, offset), (Flexibility3D, offset)), ...]``: both gears by half, with where
            their contact begins on them [mm]; at least n teeth after each loaded one are coupled to it.
        reach : float, optional
            Gap [mm] to look at first.

        Raises
        ------
        RuntimeError
            If there is no contact; the message says at which phase.
        """
        reach, closing = self.least + self.reach if reach is None else reach, 0.0
        while True:
            cells = self._cells(phase, reach, closing)
            if cells is not None:
                cells, approach, closed, given = self._carried(cells, bodies(int(np.ptp(cells.order))))
                closes = approach - given[1]  # what of it teeth can close gaps by
                normal = closes * math.cos(self.beta_b)
                if any(closing < depth < normal for depth in self.floors):
                    closing = normal  # shallow pits: solved again with their floors, which can only make it stiffer
                    continue
                if not self.extended or closes <= reach or reach - self.least > self.furthest:
                    return cells, approach, closed, given
            if reach - self.least > self.furthest:
                if cells is None and any(closing < depth <= self.deepest for depth in self.floors):
                    closing = self.deepest
                    continue
                raise RuntimeError(f"no contact at phase {phase:g}: pits cover it all, or the pair has left its path of contact")
            reach = 2 * reach if cells is None else closes  # fewer cells approach more: enough

    def unloaded(self, found):
        """Approach at which the flanks first touch, from the `Cells` of each phase ``(phases,)`` [mm]: the least gap."""
        if self.flanks is None:
            return np.zeros(len(found))
        best = [int(np.argmin(cells.gap)) for cells in found]
        names = ("half", "order", "nominal", "z", "width", "floor")
        half, order, nominal, z, width, floor = (
            np.array([getattr(c, n)[k] for c, k in zip(found, best, strict=True)]) for n in names
        )
        slope = math.tan(self.beta_b) * np.sign([last - first for first, last in self.bands])[half]  # of the abscissa, down by z
        low, high, gap = -width / 2, width / 2, np.zeros(0)
        for _ in range(ROUNDS):
            steps = np.linspace(low, high, FINE, axis=1)
            at = (nominal[:, None] - slope[:, None] * steps).ravel()
            known = touching(self.pair, at)[2]
            met = first_touch(self.pair, self.flanks, at, np.repeat(order, FINE), known, (z[:, None] + steps).ravel())
            gap, rows = met.gap.reshape(-1, FINE), np.arange(order.size)
            least = np.argmin(gap, axis=1)
            low, high = steps[rows, np.maximum(least - 1, 0)], steps[rows, np.minimum(least + 1, FINE - 1)]
        return gap.min(axis=1) + floor / math.cos(self.beta_b)

    def _cells(self, phase, reach, closing):
        pieces = pieces_of(self.pair, phase, self.pits, self.bands, self.beta_b, self._further(reach), closing)
        if not pieces:
            return None
        length = sum(piece.last - piece.first for piece in pieces if not piece.floor or all(one.floor for one in pieces))
        finest = FINEST * float(half_width(self.force / length, self.radius, self.modulus))
        cells = cells_of(self.pair, pieces, self.bands, math.tan(self.beta_b), max(self.step, finest), self.flanks)
        return cells if cells.z.size else None

    def _carried(self, cells, bodies):
        """What `solve` gives, under the whole force; two halves alike are solved once."""
        first = cells.half == 0
        if len(bodies) == 1 or self.hubs is not None or not _same(*bodies) or not _alike(cells, first):
            return self._shared(cells, bodies, self.force)
        half, *rest = self._shared(_some(cells, first), bodies[:1], self.force / 2)
        return replace(cells, load=np.tile(half.load, 2), pressure=np.tile(half.pressure, 2)), *rest

    def _shared(self, cells, bodies, force):
        cos = math.cos(self.beta_b)
        radius = self.pair.relative_radius(cells.roll_1, cells.roll_2)
        radius = np.where(radius > 0, radius, self.radius)
        radius = np.where(cells.radius > 0, cells.radius, radius) / cos
        ends = [(cells.depth + side * cells.width / 2) / cos for side in (-1, 1)]
        line = np.unique(np.array([cells.half, cells.order]), axis=1, return_inverse=True)[1].ravel()
        kernel = sum(body.kernel for body, _ in bodies[0])
        local = None
        if self.law is not None:
            at = self.law.ends(self.pair, cells)
            for end, form in enumerate((self.flanks or ())[::-1]):
                at[(at == end) & (form.edge is not None)] = -1  # no sharp corner there
            local = (lambda line_load: self.law(at, cells.nominal, line_load)) if (at >= 0).any() else None
        matrix, block, faces, yields = between(cells, bodies), cells.half, faces_of(cells, bodies), None
        if self.hubs is not None:  # both halves of a herringbone gear are on one hub
            yields = given_way(cells, self.pair, self.hubs, self.bands, self.beta_b)
            matrix, block = matrix + yields, np.zeros(cells.z.size, dtype=int)
            faces = None if faces is None else (*faces[:2], np.zeros_like(faces[2]))
        case = (matrix, cos * cells.gap, force / cos, kernel, ends, line, radius, self.modulus)
        options = {"block": block, "local": local, "faces": faces, "floor": cells.floor}
        load, approach = line_cells(*case, **options)
        load, closed = load[: line.size], bool(load[line.size :].any())
        pressure = peak_pressure(load / (ends[1] - ends[0]), radius, self.modulus)
        pressure[(cells.corner > 0) & (load > 0)] = np.nan
        way = np.zeros(load.size) if yields is None else yields @ load / cos
        return replace(cells, load=load, pressure=pressure), approach / cos, closed, (load @ way / load.sum(), way.min())


def _same(one, two):
    return all(first is second for (first, _), (second, _) in zip(one, two, strict=True))


def _alike(cells, first):
    one, two = _some(cells, first), _some(cells, ~first)
    if one.z.size != two.z.size:
        return False
    names = ("order", "width", "depth", "nominal", "gap")
    return all(np.allclose(getattr(one, name), getattr(two, name), rtol=0, atol=ALIKE) for name in names)


def _some(cells, which):
    names = ("half", "order", "z", "width", "depth", "nominal", "roll_1", "roll_2", "gap", "corner", "floor", "radius")
    return Cells(*(getattr(cells, name)[which] for name in names))

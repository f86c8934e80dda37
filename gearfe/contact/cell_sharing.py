"""Load sharing over the cells of contact lines: cells push, do not pull, and each is a strip of Hertz's pressure.

Many contact problems, one for each phase, are solved at once: what is done cell by cell is done for all of them in one array.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dposv
from scipy.sparse import csr_array

from ..flexibility.halfspace import pair_kernel, pair_slope, strip
from ..flexibility.hertz import half_width
from .plane import OVERLAP
from .sharing import share

MOST = 60  # steps, the second half of them with exact contact problems
WIDTHS = 20  # steps in which the strips' widths follow the loads, half of their change in the second half
SMOOTH = 8.0  # half widths over which the line load is averaged before the width of the strip follows it
SETTLED = 1e-7  # change of a cell's load in the last step, of the whole load
FLOOR = 1e-9  # of the load: least load of a cell where its logarithm is taken
NEAR = 25.0  # strip distances within which the kernel follows the strips' widths; further away it no longer knows them
SLOPE = 1e-4  # relative change of the line load by which the slope of the local law is found


class System(NamedTuple):
    """A contact problem over n cells, without its load.

    Attributes
    ----------
    matrix : ndarray, shape (n, n)
        Approach per unit force, symmetric, half-space left out [mm/N].
    gap : ndarray, shape (n,)
        Unloaded distance [mm].
    ends : (ndarray, ndarray)
        Ends of the cells along their lines [mm].
    line : ndarray, shape (n,)
        Number of each cell's line; cells of a line are neighbours, in the order along it.
    radius : ndarray, shape (n,)
        Relative radius of curvature [mm].
    block : ndarray, shape (n,), optional
        Number of the bodies each cell is on: `matrix` is zero between different ones.
    faces : (ndarray (m, n), ndarray (m, m), ndarray (m,)), optional
        Faces of cracks that must not pass through each other: their opening by the cells' forces and by unit forces that push
        them apart [mm/N], and the block of each.
    floor : ndarray, shape (n,), optional
        How deep the pits above the cells are [mm]; cells of one depth share their mean load.
    mirrors : list of (float, ndarray (n,), ndarray (n,))
        End faces in which loads are mirrored, as of `bodies.mirrors_of`; as many in all systems solved together.
    """

    matrix: NDArray[np.float64]
    gap: NDArray[np.float64]
    ends: tuple[NDArray[np.float64], NDArray[np.float64]]
    line: NDArray[np.int64]
    radius: NDArray[np.float64]
    block: NDArray[np.int64] | None = None
    faces: Any = None
    floor: NDArray[np.float64] | None = None
    mirrors: Any = ()


class Shared(NamedTuple):
    """Forces on the cells, then on the faces [N]; approach [mm]; tangent stiffness d load / d approach [N/mm]."""

    force: NDArray[np.float64]
    approach: float
    tangent: float


class SharedLines:
    """Cells of contact lines that can push but not pull, in many contact problems at once; solves them for any loads.

    Cells of one line act on each other and themselves as the half-space does, each a strip of Hertz's pressure
    (`halfspace.line_kernel`). The strips' widths follow from the loads of the step before, averaged along the line so that the
    load at an end of contact converges with the cells (each step gains a digit or more; what is left after `WIDTHS` steps is
    let be), with an active set; if that does not settle, an exact contact problem (`sharing.share`) in every step.

    Parameters
    ----------
    systems : list of System
    kernel : float
        k of both bodies' half-spaces together [mm**2/N].
    modulus : float
        Contact modulus E* [MPa].
    """

    def __init__(self, systems, kernel, modulus):
        self.systems, self.kernel, self.modulus = systems, kernel, modulus
        count = np.array([one.gap.size for one in systems])
        self.slices = [slice(int(end) - int(n), int(end)) for n, end in zip(count, np.cumsum(count), strict=True)]
        self.problem = np.repeat(np.arange(count.size), count)
        self.start, self.stop = (np.concatenate([one.ends[side] for one in systems]) for side in (0, 1))
        self.width, self.radius = self.stop - self.start, np.concatenate([one.radius for one in systems])
        lines = np.concatenate([one.line for one in systems])
        self.line = np.cumsum(np.append(True, (np.diff(lines) != 0) | (np.diff(self.problem) > 0))) - 1
        self.first = np.flatnonzero(np.append(True, np.diff(self.line) > 0))  # cell of each line
        self.floor = np.concatenate([np.zeros(one.gap.size) if one.floor is None else one.floor for one in systems])
        lowest = np.minimum.reduceat(self.floor, np.cumsum(count) - count)
        flat = (self.floor == lowest[self.problem]).astype(float)
        self.length = np.bincount(self.problem, self.width * flat)
        self.mean_radius = np.bincount(self.problem, self.radius * flat) / np.bincount(self.problem, flat)
        self.widest = self._pieces() / 2  # a piece shorter than it is wide acts as one as wide as it is long
        self._arrange()
        mirrors = zip(*(one.mirrors for one in systems), strict=True)
        self.mirrors = [(own[0][0], *(np.concatenate([one[k] for one in own]) for k in (1, 2))) for own in mirrors]
        self._near, self._images = None, []

    def _pieces(self):
        """Length of the unbroken piece of contact each cell belongs to ``(n,)`` [mm]."""
        part = _runs(self.line, self.floor)
        apart = (np.diff(part) != 0) | (np.abs(self.start[1:] - self.stop[:-1]) > 1e-9 * self.width[1:])
        number = np.concatenate([[0], np.cumsum(apart)])
        return np.bincount(number, weights=self.width)[number]

    def _arrange(self):
        """Of each problem its whole flexibility (a view of one array), gaps, weights and blocks, faces of cracks included."""
        sizes = [one.gap.size + (0 if one.faces is None else one.faces[2].size) for one in self.systems]
        base = np.concatenate([[0], np.cumsum(np.square(sizes))])
        self._flat, self._base, self._sizes = np.zeros(base[-1]), base[:-1], np.array(sizes)
        self.totals = [self._flat[at : at + n * n].reshape(n, n) for at, n in zip(base[:-1].tolist(), sizes, strict=True)]
        self.gaps, self.weights, self.blocks = [], [], []
        for one, total in zip(self.systems, self.totals, strict=True):
            n, m = one.gap.size, total.shape[0] - one.gap.size
            total[:n, :n] = one.matrix
            number = np.zeros(n, dtype=int) if one.block is None else one.block
            if one.faces is not None:
                total[n:, :n], total[:n, n:], total[n:, n:] = one.faces[0], one.faces[0].T, one.faces[1]
                number = np.append(number, one.faces[2])
            self.gaps.append(np.append(one.gap, np.zeros(m)))
            self.weights.append(np.append(np.ones(n), np.zeros(m)))
            self.blocks.append([np.flatnonzero(number == k) for k in np.unique(number)])

    def _places(self, i, j):
        """Places in the array of all flexibilities of the pairs ``(i, j)`` of cells."""
        problem = self.problem[i]
        first = np.array([one.start for one in self.slices])[problem]
        return self._base[problem] + (i - first) * self._sizes[problem] + (j - first)

    def _begin(self, x):
        """Put the half-space into the flexibilities, and find the pairs of cells in which it depends on the strips' widths."""
        last = np.searchsorted(self.line, self.line, side="right")
        i, j = _ranges(np.arange(self.line.size), last)
        forth, back = self._places(i, j), self._places(j, i)
        widest = np.maximum.reduceat(x, self.first)[self.line[i]]
        near = np.flatnonzero(self.start[j] - self.stop[i] < NEAR * widest)
        bulk = self._flat[forth]
        for weight, low, high in self.mirrors:
            image = weight * pair_kernel((low, high), i, j, x, (-high, -low))
            bulk += image
            at = np.flatnonzero(low[i[near]] + low[j[near]] < NEAR * widest[near])
            self._images.append((weight, low, high, at, image[near[at]]))
        self._flat[forth] = self._flat[back] = bulk + self.kernel * pair_kernel((self.start, self.stop), i, j, x)
        self._near = i[near], j[near], forth[near], back[near], bulk[near]

    def _widen(self, x):
        """The half-space and the images in end faces of strips with distances `x`."""
        i, j, forth, back, bulk = self._near
        own = bulk + self.kernel * pair_kernel((self.start, self.stop), i, j, x)
        for weight, low, high, at, before in self._images:
            own[at] += weight * pair_kernel((low, high), i[at], j[at], x, (-high, -low)) - before
        self._flat[forth] = self._flat[back] = own

    def _smoother(self, load):
        """Sparse matrix from the cells' forces to mean line loads over some half widths, within their lines and floors."""
        reach = SMOOTH * half_width(load / self.length, self.mean_radius, self.modulus)[self.problem]
        middle = (self.start + self.stop) / 2
        long = np.maximum.reduceat(self.stop, self.first) - self.start[self.first]
        apart = np.append(0.0, np.cumsum(long + 4 * reach.max())[:-1])  # all lines behind each other
        shift = (apart - self.start[self.first])[self.line]
        first = np.searchsorted(self.stop + shift, middle + shift - reach, side="right")
        i, j = _ranges(first, np.searchsorted(self.start + shift, middle + shift + reach))
        over = np.minimum(self.stop[j], middle[i] + reach[i]) - np.maximum(self.start[j], middle[i] - reach[i])
        over = np.where(self.floor[i] == self.floor[j], np.maximum(over, 0.0), 0.0)
        over = over / np.bincount(i, over, minlength=reach.size)[i] / self.width[j]
        return csr_array((over, (i, j)), shape=(reach.size,) * 2)

    def solve(self, load, local=None, which=None, start=None):
        """Share loads.

        Parameters
        ----------
        load : ndarray, shape (problems,)
            Sum of the cells' forces in each problem [N].
        local : callable, optional
            From line loads ``(n,)`` [N/mm] of the cells of all problems to what each one's ``ln(2 / a) + 1/2`` is more than
            Hertz's ``(n,)``.
        which : sequence of int, optional
            The problems to solve; default: all.
        start : list of Shared, optional
            What other loads of the same problems came to, for the strips and active sets to start from.

        Returns
        -------
        list of Shared
            None for problems that were not asked for.

        Raises
        ------
        RuntimeError
            If the load sharing does not settle, or the flexibility is not positive definite.
        """
        which = list(range(len(self.systems)) if which is None else which)
        load = np.asarray(load, dtype=float)
        mean = self._smoother(load)
        along = np.bincount(self.problem, self.width)
        forces, actives = [], []
        for p, one in enumerate(self.systems):
            before = None if start is None else start[p]
            force = load[p] * self.width[self.slices[p]] / along[p]
            force = np.append(force, np.zeros(self.gaps[p].size - one.gap.size))
            forces.append(force if before is None else before.force * load[p] / before.force[: one.gap.size].sum())
            actives.append(self.weights[p] > 0 if before is None else before.force > 0)
        approaches, open_, x = np.zeros(load.size), list(which), None
        for attempt in range(MOST):
            if attempt < WIDTHS:
                wide = self._wide(self._along(mean, forces, load), local)
                x = wide if attempt < WIDTHS // 2 else np.sqrt(x * wide)
                if self._near is None:
                    self._begin(x)
                self._widen(x)
            still = []
            for p in open_:
                active = actives[p]
                new, approaches[p], wanted = self._step(p, load[p], active, attempt < MOST // 2)
                active = active if attempt < MOST // 2 else wanted
                settled = (wanted == active).all() and np.abs(new - forces[p]).max() < SETTLED * load[p]
                actives[p], forces[p] = wanted, np.maximum(new, 0.0)
                if not settled:
                    still.append(p)
                    n = self.systems[p].gap.size
                    if not wanted[:n].any():
                        actives[p][:n] = True
            open_ = still
            if not open_:
                tangents = self._tangents(which, forces, load, x, local)
                found = [None] * load.size
                for p in which:
                    found[p] = Shared(forces[p], float(approaches[p]), tangents[p])
                return found
        raise RuntimeError(f"load sharing along the contact lines did not settle at {load[open_[0]]:g} N")

    def _cells(self, forces):
        """Forces of all cells, those of faces left out."""
        return np.concatenate([force[: one.gap.size] for force, one in zip(forces, self.systems, strict=True)])

    def _along(self, mean, forces, load):
        """Mean line loads of all cells [N/mm]."""
        return np.maximum(mean @ self._cells(forces), FLOOR * load[self.problem] / self.width)

    def _wide(self, along, local):
        wide = strip(half_width(along, self.radius, self.modulus))
        if local is not None:
            wide = wide * np.exp(-local(along))
        return np.minimum(wide, self.widest)

    def _step(self, p, load, active, free):
        """Forces and approach of a problem, and which of its cells and faces should push."""
        total, gap, weight, n = self.totals[p], self.gaps[p], self.weights[p], self.systems[p].gap.size
        if not free:
            new, approach = share(total, gap, load, weight)
            return new, approach, new > 0
        new, approach = _free(total, gap, load, active, self.blocks[p], weight)
        rests = total @ np.maximum(new, 0.0) + gap - approach * weight
        let = np.append(np.full(n, 1e-12 * approach), np.full(gap.size - n, OVERLAP * np.abs(rests[n:]).max(initial=0.0)))
        return new, approach, np.where(active, new > 0, rests < -let)

    def _tangents(self, which, forces, load, x, local):
        """Stiffness of each problem to a little more load, its active set kept [N/mm].

        With T the flexibility of what pushes, and the strips' distances x following forces and load, the forces P of a further
        approach d solve the linearisation of what was solved::

            (T + d(T P)/dx dx/dP) dP + d(T P)/dx dx/dload dload = dd,    sum(dP) = dload
        """
        mean, more = self._smoother(load), self._smoother(load * (1 + SLOPE))
        along, further = (self._along(one, forces, load) for one in (mean, more))
        rate = np.full(along.size, 0.5)
        if local is not None:
            rate = rate - (local(along * (1 + SLOPE)) - local(along)) / np.log1p(SLOPE)
        free = (self._wide(along, local) < self.widest) & (along > FLOOR * load[self.problem] / self.width)
        rate = np.where(free, rate * x / along, 0.0)  # of x over the mean line load
        change = self._change(forces, x) * rate
        slope = (change @ mean).tocoo()
        jacobian = self._flat.copy()
        jacobian[self._places(slope.row, slope.col)] += slope.data
        by_load = change @ (further - along) / SLOPE / load[self.problem]
        out = {}
        for p in which:
            n, at = self._sizes[p], np.flatnonzero(forces[p] > 0)
            whole = jacobian[self._base[p] : self._base[p] + n * n].reshape(n, n)
            moved = np.append(by_load[self.slices[p]], np.zeros(n - self.systems[p].gap.size))[at]
            weight = self.weights[p][at]
            ones, moved = np.linalg.solve(whole[np.ix_(at, at)], np.array([weight, moved]).T).T
            out[p] = float(weight @ ones / (1 + weight @ moved))
        return out

    def _change(self, forces, x):
        """Sparse change ``(n, n)`` of the approach of each cell with the strip's distance x of each."""
        cells = self._cells(forces)
        i, j = self._near[:2]
        slope = self.kernel * pair_slope((self.start, self.stop), i, j, x)
        for weight, low, high, at, _ in self._images:
            slope[at] += weight * pair_slope((low, high), i[at], j[at], x, (-high, -low))
        apart = i != j
        i, j, slope = np.append(i, j[apart]), np.append(j, i[apart]), np.append(slope, slope[apart])
        own, number = x * np.bincount(i, slope * cells[j], minlength=x.size), np.arange(x.size)
        values = np.append(slope * cells[j] * x[j], own)
        return csr_array((values, (np.append(i, number), np.append(j, number))), shape=(x.size,) * 2)


def _runs(line, floor):
    """Numbers of the parts with one line and floor, equal for equal ones ``(n,)``."""
    if not floor.any():
        return line
    return np.unique(np.array([line, floor]), axis=1, return_inverse=True)[1].ravel()


def _ranges(first, last):
    """Pairs ``(i, j)`` with ``first[i] <= j < last[i]``."""
    count = np.maximum(last - first, 0)
    i = np.repeat(np.arange(count.size), count)
    return i, np.arange(count.sum()) - np.repeat(np.cumsum(count) - count - first, count)


def _free(total, gap, load, active, blocks, weight):
    """Forces ``(n,)`` of the active cells and their common approach, whatever their signs."""
    ones, gaps = np.zeros(gap.size), np.zeros(gap.size)
    for block in blocks:
        at = block[active[block]]
        if at.size:
            part = total.copy() if at.size == gap.size else total[np.ix_(at, at)]
            right = np.array([weight[at], gap[at]])
            _, solved, fault = dposv(part.T, right.T, overwrite_a=1, overwrite_b=1)
            if fault:
                raise RuntimeError("bodies too coarse: some load on the contact lines would gain energy; raise refine")
            ones[at], gaps[at] = solved.T
    approach = (load + weight @ gaps) / (weight @ ones)
    return approach * ones - gaps, approach

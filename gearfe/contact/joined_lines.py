"""Cells of the contact lines of all phases in joined arrays, and their half-space flexibility.

Operations on cells are done for the contact problems of all phases together.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from ..flexibility.halfspace import pair_kernel, pair_slope, strip
from ..flexibility.hertz import half_width
from ..geometry.aliases import Floats

SMOOTH = 8.0  # averaging length of the line load for the strip width [half widths]
FLOOR = 1e-9  # least load of a cell in logarithms, relative to the whole load
NEAR = 25.0  # distance [strip distances] within which the kernel depends on the strips' widths


class System(NamedTuple):
    """A contact problem over n cells, without its load.

    Attributes
    ----------
    matrix : ndarray, shape (n, n)
        Approach per unit force without half-space [mm/N], symmetric.
    gap : ndarray, shape (n,)
        Unloaded distance [mm].
    ends : (ndarray, ndarray)
        Ends of the cells along their lines [mm].
    line : ndarray, shape (n,)
        Number of each cell's line; cells of a line are neighbours, in the order along it.
    radius : ndarray, shape (n,)
        Relative radius of curvature [mm].
    block : ndarray, shape (n,), optional
        Number of the body of each cell. `matrix` is zero between cells of different bodies.
    faces : (ndarray (m, n), ndarray (m, m), ndarray (m,)), optional
        Crack faces in contact: their opening under unit forces on the cells and under unit forces that push the faces apart
        [mm/N], and the block of each face.
    floor : ndarray, shape (n,), optional
        Depth of the pits above the cells [mm]. Cells of equal depth have one averaged load.
    mirrors : list of (float, ndarray (n,), ndarray (n,))
        End faces with mirrored loads (see `bodies.mirrors_of`); all systems solved together have the same number.
    """

    matrix: Floats
    gap: Floats
    ends: tuple[Floats, Floats]
    line: NDArray[np.int64]
    radius: Floats
    block: NDArray[np.int64] | None = None
    faces: Any = None
    floor: Floats | None = None
    mirrors: Any = ()


class JoinedLines:
    """Cells of many contact problems, with flexibilities whose half-space part depends on the widths of the pressure strips.

    Attributes
    ----------
    totals : list of ndarray, shape (n + m, n + m)
        Flexibility between the cells, then the faces of cracks, of each problem [mm/N]; views of `flat`, each from its `base` on.
    gaps, weights, blocks : list
        For each problem: unloaded distances [mm], weights (1 for cells, 0 for crack faces), numbers of the members of each
        block.
    problem, width, widest : ndarray, shape (cells,)
        For all cells: number of the problem, length [mm], largest width of the strip [mm].
    slices : list of slice
        The cells of each problem among all.
    near : tuple or None
        Pairs of cells ``(i, j)`` within `NEAR`, their places in `flat` in both orders, and the values there without half-space.
        None before `begin`.
    images : list
        For each end face: its `System.mirrors`, the pairs of `near` that are within `NEAR` of their images, and the
        contribution of these images.
    """

    def __init__(self, systems, kernel, modulus):
        self.systems, self.kernel, self.modulus = systems, kernel, modulus
        count = np.array([system.gap.size for system in systems])
        self.slices = [slice(int(end) - int(n), int(end)) for n, end in zip(count, np.cumsum(count), strict=True)]
        self.problem = np.repeat(np.arange(count.size), count)
        self.start, self.stop = (np.concatenate([system.ends[side] for system in systems]) for side in (0, 1))
        self.width, self.radius = self.stop - self.start, np.concatenate([system.radius for system in systems])
        lines = np.concatenate([system.line for system in systems])
        self.line = np.cumsum(np.append(True, (np.diff(lines) != 0) | (np.diff(self.problem) > 0))) - 1
        self.first = np.flatnonzero(np.append(True, np.diff(self.line) > 0))  # first cell of each line
        self.floor = np.concatenate([np.zeros(system.gap.size) if system.floor is None else system.floor for system in systems])
        lowest = np.minimum.reduceat(self.floor, np.cumsum(count) - count)
        flat = (self.floor == lowest[self.problem]).astype(float)
        self.length = np.bincount(self.problem, self.width * flat)
        self.mean_radius = np.bincount(self.problem, self.radius * flat) / np.bincount(self.problem, flat)
        self.widest = self._pieces() / 2  # A segment shorter than its width acts as a square.
        self._arrange()
        mirrors = zip(*(system.mirrors for system in systems), strict=True)
        self.mirrors = [(face[0][0], *(np.concatenate([image[k] for image in face]) for k in (1, 2))) for face in mirrors]
        self.near, self.images = None, []

    def _pieces(self):
        """Length of the uninterrupted piece of contact to which each cell belongs ``(n,)`` [mm]."""
        part = _runs(self.line, self.floor)
        apart = (np.diff(part) != 0) | (np.abs(self.start[1:] - self.stop[:-1]) > 1e-9 * self.width[1:])
        number = np.concatenate([[0], np.cumsum(apart)])
        return np.bincount(number, weights=self.width)[number]

    def _arrange(self):
        """Set up flexibility (views of one array), gaps, weights and blocks of each problem, crack faces included."""
        sizes = [system.gap.size + (0 if system.faces is None else system.faces[2].size) for system in self.systems]
        base = np.concatenate([[0], np.cumsum(np.square(sizes))])
        self.flat, self.base, self.sizes = np.zeros(base[-1]), base[:-1], np.array(sizes)
        self.totals = [self.flat[at : at + n * n].reshape(n, n) for at, n in zip(base[:-1].tolist(), sizes, strict=True)]
        self.gaps, self.weights, self.blocks = [], [], []
        for problem, total in zip(self.systems, self.totals, strict=True):
            n, m = problem.gap.size, total.shape[0] - problem.gap.size
            total[:n, :n] = problem.matrix
            number = np.zeros(n, dtype=int) if problem.block is None else problem.block
            if problem.faces is not None:
                total[n:, :n], total[:n, n:], total[n:, n:] = problem.faces[0], problem.faces[0].T, problem.faces[1]
                number = np.append(number, problem.faces[2])
            self.gaps.append(np.append(problem.gap, np.zeros(m)))
            self.weights.append(np.append(np.ones(n), np.zeros(m)))
            self.blocks.append([np.flatnonzero(number == k) for k in np.unique(number)])

    def places(self, i, j):
        """Return the indices of the cell pairs ``(i, j)`` in the array of all flexibilities."""
        problem = self.problem[i]
        first = np.array([span.start for span in self.slices])[problem]
        return self.base[problem] + (i - first) * self.sizes[problem] + (j - first)

    def begin(self, x):
        """Add the half-space to the flexibilities, and find the cell pairs whose half-space term depends on the strip widths."""
        last = np.searchsorted(self.line, self.line, side="right")
        i, j = _ranges(np.arange(self.line.size), last)
        forth, back = self.places(i, j), self.places(j, i)
        widest = np.maximum.reduceat(x, self.first)[self.line[i]]
        near = np.flatnonzero(self.start[j] - self.stop[i] < NEAR * widest)
        bulk = self.flat[forth]
        for weight, low, high in self.mirrors:
            image = weight * pair_kernel((low, high), i, j, x, (-high, -low))
            bulk += image
            at = np.flatnonzero(low[i[near]] + low[j[near]] < NEAR * widest[near])
            self.images.append((weight, low, high, at, image[near[at]]))
        self.flat[forth] = self.flat[back] = bulk + self.kernel * pair_kernel((self.start, self.stop), i, j, x)
        self.near = i[near], j[near], forth[near], back[near], bulk[near]

    def widen(self, x):
        """Return the half-space flexibility and the images in end faces of strips with distances `x`."""
        i, j, forth, back, bulk = self.near
        influence = bulk + self.kernel * pair_kernel((self.start, self.stop), i, j, x)
        for weight, low, high, at, before in self.images:
            influence[at] += weight * pair_kernel((low, high), i[at], j[at], x, (-high, -low)) - before
        self.flat[forth] = self.flat[back] = influence

    def smoother(self, load):
        """Return a sparse matrix that averages forces to line loads over several half widths, within a line and a pit floor."""
        reach = SMOOTH * half_width(load / self.length, self.mean_radius, self.modulus)[self.problem]
        middle = (self.start + self.stop) / 2
        long = np.maximum.reduceat(self.stop, self.first) - self.start[self.first]
        apart = np.append(0.0, np.cumsum(long + 4 * reach.max())[:-1])  # All lines are arranged in sequence.
        shift = (apart - self.start[self.first])[self.line]
        first = np.searchsorted(self.stop + shift, middle + shift - reach, side="right")
        i, j = _ranges(first, np.searchsorted(self.start + shift, middle + shift + reach))
        over = np.minimum(self.stop[j], middle[i] + reach[i]) - np.maximum(self.start[j], middle[i] - reach[i])
        over = np.where(self.floor[i] == self.floor[j], np.maximum(over, 0.0), 0.0)
        over = over / np.bincount(i, over, minlength=reach.size)[i] / self.width[j]
        return csr_array((over, (i, j)), shape=(reach.size,) * 2)

    def cells(self, forces):
        """Return the forces of all cells, without the forces on crack faces."""
        return np.concatenate([force[: system.gap.size] for force, system in zip(forces, self.systems, strict=True)])

    def along(self, mean, forces, load):
        """Return mean line loads of all cells [N/mm], limited to the whole load, because first steps may give tensile forces."""
        whole_load = load[self.problem]
        return np.maximum(mean @ np.minimum(self.cells(forces), whole_load), FLOOR * whole_load / self.width)

    def wide(self, along, local):
        """Distances x of the strips ``(n,)`` [mm] at mean line loads `along`, with the local law of `SharedLines.solve`."""
        wide = strip(half_width(along, self.radius, self.modulus))
        if local is not None:
            wide = wide * np.exp(-local(along))
        return np.minimum(wide, self.widest)

    def change(self, forces, x):
        """Return the sparse derivative ``(n, n)`` of the approach of each cell with respect to ln(x), x the strip distance."""
        cells = self.cells(forces)
        i, j = self.near[:2]
        slope = self.kernel * pair_slope((self.start, self.stop), i, j, x)
        for weight, low, high, at, _ in self.images:
            slope[at] += weight * pair_slope((low, high), i[at], j[at], x, (-high, -low))
        apart = i != j
        i, j, slope = np.append(i, j[apart]), np.append(j, i[apart]), np.append(slope, slope[apart])
        diagonal, number = x * np.bincount(i, slope * cells[j], minlength=x.size), np.arange(x.size)
        values = np.append(slope * cells[j] * x[j], diagonal)
        return csr_array((values, (np.append(i, number), np.append(j, number))), shape=(x.size,) * 2)


def _runs(line, floor):
    """Return a number for each cell ``(n,)`` that is equal for the cells of one line and one pit floor."""
    if not floor.any():
        return line
    return np.unique(np.array([line, floor]), axis=1, return_inverse=True)[1].ravel()


def _ranges(first, last):
    """Return all pairs ``(i, j)`` with ``first[i] <= j < last[i]``."""
    count = np.maximum(last - first, 0)
    i = np.repeat(np.arange(count.size), count)
    return i, np.arange(count.sum()) - np.repeat(np.cumsum(count) - count - first, count)

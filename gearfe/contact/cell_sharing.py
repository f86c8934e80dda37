"""Load sharing over the cells of contact lines. A cell transmits compression only and has a Hertzian pressure distribution.

There is one contact problem for each phase. All are solved together, with the cells of all problems in one array.
"""

from typing import NamedTuple

import numpy as np
from scipy.linalg.lapack import dpotrf, dpotrs

from ..geometry.aliases import Floats
from .joined_lines import FLOOR, JoinedLines
from .sharing import share
from .unknowns import OVERLAP

MOST = 60  # limit of steps; the second half solve exact contact problems
WIDTHS = 20  # iterations with updated contact widths; the relaxation factor is 0.5 in the second half
SETTLED = 1e-7  # tolerance: change of a cell's load in the last iteration, relative to the whole load
SLOW = 0.2  # A larger relative change requires a new factorisation.
SLOPE = 1e-4  # relative step of the line load for the derivative of the local law


class SharedLoad(NamedTuple):
    """Result of the contact problem: forces on cells and crack faces [N], approach [mm], tangent stiffness [N/mm]."""

    force: Floats
    approach: float
    tangent: float


class SharedLines:
    """Cells of contact lines that push but cannot pull, in many contact problems at once. Solves them for any loads.

    Each cell of a line is a strip with Hertzian pressure on an elastic half-space (`halfspace.pair_kernel`). The strip widths
    follow from the loads of the previous step. These are averaged along the line, so that the load at an end of contact
    converges as cells get shorter. Each step improves the loads by a digit or more, and there are at most `WIDTHS` steps. The
    contacts follow from an active set. If it does not converge, every step solves an exact contact problem (`sharing.share`).

    Parameters
    ----------
    systems : list of System
    kernel : float
        k of both bodies' half-spaces together [mm**2/N].
    modulus : float
        Contact modulus E* [MPa].
    """

    def __init__(self, systems, kernel, modulus):
        self.joined, self._factors = JoinedLines(systems, kernel, modulus), [None] * len(systems)

    def solve(self, load, local=None):
        """Share loads.

        Parameters
        ----------
        load : ndarray, shape (problems,)
            Sum of the cells' forces in each problem [N].
        local : callable, optional
            Addition to Hertz's ``ln(2 / a) + 1/2`` for each cell ``(n,)`` of all problems, at line loads ``(n,)`` [N/mm].

        Returns
        -------
        list of Shared

        Raises
        ------
        RuntimeError
            If the load sharing does not settle, or the flexibility is not positive definite.
        """
        lines = self.joined
        load = np.asarray(load, dtype=float)
        forces, actives = self._started(load)
        mean, x, open_ = lines.smoother(load), None, list(range(load.size))
        approaches, changes, slow = np.zeros(load.size), np.full(load.size, np.inf), np.full(load.size, True)
        for attempt in range(MOST):
            if attempt < WIDTHS:
                wide = lines.wide(lines.along(mean, forces, load), local)
                x = wide if attempt < WIDTHS // 2 else np.sqrt(x * wide)
                if lines.near is None:
                    lines.begin(x)
                lines.widen(x)
            still = []
            for p in open_:
                free, before = attempt < MOST // 2, None if slow[p] else forces[p]
                new, approaches[p], wanted = self._step(p, load[p], actives[p], before, free)
                change = float(np.abs(new - forces[p]).max())
                settled = change < SETTLED * load[p] and (not free or bool((wanted == actives[p]).all()))
                changes[p], slow[p] = change, change > SLOW * changes[p]
                actives[p], forces[p] = wanted, np.maximum(new, 0.0)
                if not settled:
                    still.append(p)
                    n = lines.systems[p].gap.size
                    if not wanted[:n].any():
                        actives[p][:n] = True
            open_ = still
            if not open_:
                tangents = self._tangents(forces, load, x, local)
                return [SharedLoad(*values) for values in zip(forces, approaches.tolist(), tangents, strict=True)]
        raise RuntimeError(f"load sharing along the contact lines did not converge at {load[open_[0]]:g} N")

    def _started(self, load):
        """Return initial forces, equal in all cells of a problem, and the initially active contacts (no crack faces)."""
        lines, forces = self.joined, []
        length = np.bincount(lines.problem, lines.width)
        for p, gap in enumerate(lines.gaps):
            even = load[p] * lines.width[lines.slices[p]] / length[p]
            forces.append(np.append(even, np.zeros(gap.size - even.size)))
        return forces, [weight > 0 for weight in lines.weights]

    def _step(self, p, load, active, before, free):
        """Return forces, approach, active cells and active crack faces of a problem.

        `before` contains the forces of the last step.
        """
        lines = self.joined
        total, gap, weight, n = lines.totals[p], lines.gaps[p], lines.weights[p], lines.systems[p].gap.size
        if not free:
            new, approach = share(total, gap, load, weight)
            return new, approach, new > 0
        new, approach = self._free(p, load, active, before)
        distances = total @ np.maximum(new, 0.0) + gap - approach * weight
        slack = np.append(np.full(n, 1e-12 * approach), np.full(gap.size - n, OVERLAP * np.abs(distances[n:]).max(initial=0.0)))
        return new, approach, np.where(active, new > 0, distances < -slack)

    def _free(self, p, load, active, before):
        """Solve for the forces of the active cells of a problem and their common approach. Forces may be tensile.

        The last forces are corrected iteratively with a stored Cholesky factor, which belongs to the same cells with slightly
        different strip widths. A new factor is computed if there are no last forces, or if other cells are active.
        """
        lines, known = self.joined, self._factors[p]
        total, gap, weight = lines.totals[p], lines.gaps[p], lines.weights[p]
        fresh = before is None or known is None or (known[0] != active).any()
        if fresh:
            parts = [self._factor(p, at) for block in lines.blocks[p] if (at := block[active[block]]).size]
            known = self._factors[p] = active.copy(), parts
        kept = np.zeros(gap.size) if fresh else np.where(active, before, 0.0)
        distances = gap if fresh else gap + total @ kept
        ones, moved = np.zeros(gap.size), np.zeros(gap.size)
        for at, factor, unit in known[1]:
            ones[at], moved[at] = unit, dpotrs(factor, distances[at])[0]
        approach = (load - weight @ kept + weight @ moved) / (weight @ ones)
        return kept + approach * ones - moved, approach

    def _factor(self, p, at):
        """Return cells, the Cholesky factor of their flexibility, and the cell forces for an approach of 1."""
        total = self.joined.totals[p]
        part = total.copy() if at.size == len(total) else total[np.ix_(at, at)]
        factor, fault = dpotrf(part.T, overwrite_a=1, clean=0)
        if fault:
            raise RuntimeError("the mesh is too coarse: its flexibility is not positive definite; increase refine")
        return at, factor, dpotrs(factor, self.joined.weights[p][at])[0]

    def _tangents(self, forces, load, x, local):
        """Return the tangent stiffness of each problem for an unchanged active set [N/mm].

        T is the flexibility of the active cells. The strip distances x follow the forces and the load. The change dP of the
        forces by a further approach dd solves the linearised equations::

            (T + d(T P)/dx dx/dP) dP + d(T P)/dx dx/dload dload = dd,    sum(dP) = dload
        """
        lines = self.joined
        mean, raised = lines.smoother(load), lines.smoother(load * (1 + SLOPE))
        along, further = (lines.along(matrix, forces, load) for matrix in (mean, raised))
        rate = np.full(along.size, 0.5)
        if local is not None:
            rate = rate - (local(along * (1 + SLOPE)) - local(along)) / np.log1p(SLOPE)
        free = (lines.wide(along, local) < lines.widest) & (along > FLOOR * load[lines.problem] / lines.width)
        rate = np.where(free, rate * x / along, 0.0)  # derivative of x by the mean line load
        change = lines.change(forces, x) * rate
        slope = (change @ mean).tocoo()
        jacobian = lines.flat.copy()
        jacobian[lines.places(slope.row, slope.col)] += slope.data
        by_load = change @ (further - along) / SLOPE / load[lines.problem]
        out = []
        for p in range(load.size):
            n, at = lines.sizes[p], np.flatnonzero(forces[p] > 0)
            whole = jacobian[lines.base[p] : lines.base[p] + n * n].reshape(n, n)
            moved = np.append(by_load[lines.slices[p]], np.zeros(n - lines.systems[p].gap.size))[at]
            weight = lines.weights[p][at]
            ones, moved = np.linalg.solve(whole[np.ix_(at, at)], np.array([weight, moved]).T).T
            out.append(float(weight @ ones / (1 + weight @ moved)))
        return out

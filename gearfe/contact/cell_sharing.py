"""Load sharing over the cells of contact lines: cells push, do not pull, and each is a strip of Hertz's pressure."""

import numpy as np
from scipy.linalg import LinAlgError, cho_factor, cho_solve

from ..flexibility.halfspace import line_kernel, pair_kernel, strip
from ..flexibility.hertz import half_width
from .plane import OVERLAP
from .sharing import share

MOST = 60  # steps, the second half of them with exact contact problems
WIDTHS = 20  # steps in which the strips' widths follow the loads, half of their change in the second half
SMOOTH = 8.0  # half widths over which the line load is averaged before the width of the strip follows it
SETTLED = 1e-7  # change of a cell's load in the last step, of the whole load
FLOOR = 1e-9  # of the load: least load of a cell where its logarithm is taken
NEAR = 25.0  # strip distances within which the kernel follows the strips' widths; further away it no longer knows them


def line_cells(matrix, gap, load, kernel, ends, line, radius, modulus, *, block=None, local=None, faces=None, floor=None):
    """Share a load over cells of contact lines that can push but not pull.

    Cells of one line act on each other and themselves as the half-space does, each a strip of Hertz's pressure
    (`halfspace.line_kernel`). The strips' widths follow from the loads of the step before, averaged along the line so that the
    load at an end of contact converges with the cells (each step gains a digit or more; what is left after `WIDTHS` steps is
    let be), with an active set; if that does not settle, an exact contact problem (`sharing.share`) in every step.

    Parameters
    ----------
    matrix : ndarray, shape (n, n)
        Approach per unit force, symmetric, half-space left out [mm/N].
    gap : ndarray, shape (n,)
        Unloaded distance [mm]; inf for cells that cannot touch.
    load : float
        [N].
    kernel : float
        k of both bodies' half-spaces together [mm**2/N].
    ends : (ndarray, ndarray)
        Ends of the cells along their lines [mm].
    line : ndarray, shape (n,)
        Number of each cell's line; cells of a line are neighbours, in the order along it.
    radius : ndarray, shape (n,)
        Relative radius of curvature [mm].
    modulus : float
        Contact modulus E* [MPa].
    block : ndarray, shape (n,), optional
        Number of the bodies each cell is on: `matrix` is zero between different ones.
    local : callable, optional
        From line loads ``(n,)`` [N/mm] to what each cell's ``ln(2 / a) + 1/2`` is more than Hertz's ``(n,)``.
    faces : (ndarray (m, n), ndarray (m, m), ndarray (m,)), optional
        Faces of cracks that must not pass through each other: their opening by the cells' forces and by unit forces that push
        them apart [mm/N], and the block of each.

    Returns
    -------
    force : ndarray, shape (n + m,)
        Of the cells, then of the faces [N].
    approach : float
        [mm].

    Raises
    ------
    RuntimeError
        If no cell can touch, or the load sharing does not settle.
    """
    able = np.flatnonzero(np.isfinite(gap))
    if able.size == 0:
        raise RuntimeError("no cell can touch: every gap is infinite")
    if able.size < gap.size:
        few = matrix[np.ix_(able, able)], gap[able], load, kernel, [end[able] for end in ends], line[able], radius[able], modulus
        options = {
            "block": None if block is None else block[able],
            "local": None if local is None else lambda along: local(_spread(along, able, gap.size, along.mean()))[able],
            "faces": None if faces is None else (faces[0][:, able], *faces[1:]),
            "floor": None if floor is None else floor[able],
        }
        found, approach = line_cells(*few, **options)
        return np.append(_spread(found[: able.size], able, gap.size), found[able.size :]), approach
    n, length = gap.size, ends[1] - ends[0]
    force = load * length / length.sum()
    flat, part = np.ones(n, dtype=bool), line
    if floor is not None and (floor > 0).any():
        flat = floor == floor.min()
        part = np.unique(np.array([line, floor]), axis=1, return_inverse=True)[1].ravel()
    mean = smoother(ends, part, SMOOTH * half_width(load / length[flat].sum(), radius[flat].mean(), modulus))
    widest = pieces(ends, part) / 2  # a piece shorter than it is wide acts as one as wide as it is long
    number = np.zeros(n, dtype=int) if block is None else block
    if faces is not None:
        matrix = np.block([[matrix, faces[0].T], [faces[0], faces[1]]])
        gap, number = np.append(gap, np.zeros(faces[2].size)), np.append(number, faces[2])
    force, weight = np.append(force, np.zeros(gap.size - n)), (np.arange(gap.size) < n).astype(float)
    blocks = [np.flatnonzero(number == k) for k in np.unique(number)]
    active, x, total, near = weight > 0, np.ones(n), None, None
    for attempt in range(MOST):
        if attempt < WIDTHS:
            along = np.maximum(mean @ force[:n], FLOOR * load / length)
            wide = strip(half_width(along, radius, modulus))
            if local is not None:
                wide = wide * np.exp(-local(along))
            wide = np.minimum(wide, widest)
            x = wide if attempt < WIDTHS // 2 else np.sqrt(x * wide)
        if total is None:
            total, near = _whole(matrix, kernel, ends, line, x)
        else:
            i, j = near
            total[i, j] = matrix[i, j] + kernel * pair_kernel(ends, i, j, x)
        if attempt < MOST // 2:
            new, approach = _free(total, gap, load, active, blocks, weight)
            rests = total @ np.maximum(new, 0.0) + gap - approach * weight
            let = np.append(np.full(n, 1e-12 * approach), np.full(gap.size - n, OVERLAP * np.abs(rests[n:]).max(initial=0.0)))
            wanted = np.where(active, new > 0, rests < -let)
        else:
            new, approach = share(total, gap, load, weight)
            wanted = active = new > 0
        settled = (wanted == active).all() and np.abs(new - force).max() < SETTLED * load
        active, force = wanted, np.maximum(new, 0.0)
        if settled:
            return force, float(approach)
        if not active[:n].any():
            active[:n] = True
    raise RuntimeError(f"load sharing along the contact lines did not settle at {load:g} N")


def _spread(values, places, size, others=0.0):
    """Values at their places among `size`, and what `others` have."""
    out = np.full(size, float(others))
    out[places] = values
    return out


def _whole(matrix, kernel, ends, line, x):
    """Flexibility with the half-space, and the pairs ``(i, j)`` of cells in which it depends on the strips' widths."""
    total = matrix.copy()
    rows, columns = [], []
    for number in np.unique(line):
        at = np.flatnonzero(line == number)
        total[np.ix_(at, at)] += kernel * line_kernel(ends[0][at], ends[1][at], x[at])
        apart = np.maximum(ends[0][at][:, None] - ends[1][at], ends[0][at] - ends[1][at][:, None])
        i, j = np.nonzero(apart < NEAR * x[at].max())
        rows.append(at[i])
        columns.append(at[j])
    return total, (np.concatenate(rows), np.concatenate(columns))


def pieces(ends, line):
    """Length of the unbroken piece of contact each cell belongs to ``(n,)`` [mm]."""
    apart = (np.diff(line) != 0) | (np.abs(ends[0][1:] - ends[1][:-1]) > 1e-9 * (ends[1] - ends[0])[1:])
    number = np.concatenate([[0], np.cumsum(apart)])
    return np.bincount(number, weights=ends[1] - ends[0])[number]


def smoother(ends, line, reach):
    """Matrix ``(n, n)`` from the cells' forces to mean line loads over `reach` [mm] on either side, within their lines."""
    middle = (ends[0] + ends[1]) / 2
    over = np.minimum(ends[1], middle[:, None] + reach) - np.maximum(ends[0], middle[:, None] - reach)
    over = np.where(line[:, None] == line, np.maximum(over, 0.0), 0.0)
    return over / over.sum(axis=1, keepdims=True) / (ends[1] - ends[0])


def _free(total, offset, load, active, blocks, weight):
    """Forces ``(n,)`` of the active cells and their common approach, whatever their signs."""
    ones, gaps = np.zeros(offset.size), np.zeros(offset.size)
    for block in blocks:
        at = block[active[block]]
        if at.size:
            part = total if at.size == offset.size else total[np.ix_(at, at)]
            try:
                solved = cho_solve(cho_factor(part), np.column_stack([weight[at], offset[at]]))
            except LinAlgError as error:
                raise RuntimeError("bodies too coarse: some load on the contact lines would gain energy; raise refine") from error
            ones[at], gaps[at] = solved.T
    approach = (load + weight @ gaps) / (weight @ ones)
    return approach * ones - gaps, approach

"""A pair of gears of finite width in contact along its true contact lines: spur, helical or herringbone, with pits and cracks.

Every contact line is cut into short cells, pits taken out exactly, so that nothing jumps when a pit or the phase moves. The
flexibility between all cells of all pairs is that of both bodies (`energy.ritz3d`) and the half-space along the line; each cell
on itself is a strip of Hertz's pressure, as in the plane.
"""

import math
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from scipy.linalg import LinAlgError, cho_factor, cho_solve

from geometry.pit import check_pits

from .bodies3d import between, bodies_of
from .energy.halfspace import line_kernel, strip
from .energy.ritz3d import axial_degree, flexibility3d
from .hertz import contact_modulus, half_width, peak_pressure
from .lines3d import bands_of, cells_of, lines_of
from .sharing import share

STEP = 0.4  # longest cell along the width [mm]
FINEST = 1.5  # shortest, in Hertz half widths: a load finer than it is wide is no line
MOST = 60  # steps, the second half of them with exact contact problems
WIDTHS = 20  # steps in which the strips' widths follow the loads, half of their change in the second half
SMOOTH = 8.0  # the width of the strip follows the line load's mean over so many half widths: it knows no sharper peaks
SETTLED = 1e-7  # change of a cell's load in the last step, of the whole load
FLOOR = 1e-9  # of the load: least load of a cell where its logarithm is taken


@dataclass(frozen=True, slots=True)
class Contact3D:
    """Contact of a pair at some phases.

    `phase` (phases,): of the end that touches first; `k` (phases,) ``force / approach`` [N/m]; `approach` (phases,) of the gears
    along the transverse line of action [mm]; `order` (pairs,) and `load` (phases, pairs) the share of each tooth pair in the
    transverse force [N]; `cells` (phases,) tuple of `Cells`, the load distribution along the lines; `dofs` the unknowns
    of pinion and wheel; `error` (phases,) estimated discretisation error of k [N/m], or None.
    """

    phase: np.ndarray
    k: np.ndarray
    approach: np.ndarray
    order: np.ndarray
    load: np.ndarray
    cells: tuple
    dofs: tuple
    error: np.ndarray | None = None


def pair_stiffness3d(
    pair,
    force,
    material,
    phases=32,
    *,
    pits=((), ()),
    cracks=((), ()),
    face="helical",
    groove=0.0,
    step=STEP,
    order=3,
    axial=None,
    refine=1.0,
    error=False,
    model=None,
):
    """Mesh stiffness of a pair of finite width.

    ``k = F / delta``, F = `force` in the transverse section along the line of action, delta the approach along it. The flanks
    press at right angles, ``F / cos(beta_b)`` in all, and approach by ``delta cos(beta_b)``: k is ``cos(beta_b)**2`` times the
    normal force per normal approach.

    Parameters
    ----------
    pair : GearPair
        The faces, if of different width, lie centred on each other.
    force : float
        [N].
    material : Material or (Material, Material)
    phases : int or ndarray
        Number of equidistant phases in 0...1, or the phases: of the end that touches first, pair 0 enters there at phase 0.
    pits, cracks : (sequence, sequence)
        Of pinion and wheel, teeth numbered in each gear's own frame. Pits on loaded flanks take contact away, no material.
        The faces of cracks may pass through each other.
    face : {"spur", "helical", "herringbone"}
        The end z = 0 of a helical pair touches first if the pinion's beta is negative, z = b
        otherwise. The outer ends of ``herringbone`` halves touch first; the halves are mirrored and do not know each other's
        bodies.
    groove : float
        Between the halves [mm].
    step : float
        Longest cell along the width [mm].
    order, axial, refine : int, int, float
        Of `flexibility3d`.
    error : bool
        Of the energy model: estimate the discretisation error of every k: its difference from that of a section order less by
        1 and an axial degree less by 2, or the mean of those over the phases if that is larger.
    model : callable, optional
        ``model(gear, material, cracks, neighbours=n)`` gives the `Flexibility3D` of a body instead of the energy model.

    Returns
    -------
    Contact3D

    Raises
    ------
    ValueError
        If an input is impossible.
    RuntimeError
        If pits leave no contact at some phase, or the contact was not found.
    """
    if not (math.isfinite(force) and force > 0):
        raise ValueError(f"force = {force} N, but a mesh is pressed together: give a finite force > 0")
    if not (math.isfinite(step) and step > 0):
        raise ValueError(f"step = {step} mm, but it is the longest cell: give step > 0")
    phase = np.arange(phases) / phases if np.ndim(phases) == 0 else np.asarray(phases, dtype=float)
    materials = material if isinstance(material, tuple) else (material, material)
    for gear, found in zip((pair.gear_1, pair.gear_2), pits, strict=True):
        check_pits(gear, found)
    bands = bands_of(pair, face, groove)
    lines = [lines_of(pair, p, pits, bands, abs(pair.gear_1.beta_b)) for p in phase]

    def energy(order, less):
        def flexible(gear, own, found, neighbours):
            degree = (axial_degree(gear.b, gear.m_n) if axial is None else axial) - less
            return flexibility3d(gear, own, found, neighbours=neighbours, order=order, axial=degree, refine=refine)

        return flexible

    def solve(model):
        bodies = bodies_of(pair, materials, cracks, bands, face, groove, partial(model, neighbours=max(1, _reach(lines))))
        return _solved(pair, force, materials, phase, lines, bodies, bands, step)

    solved = solve(model or energy(order, 0))
    if error:
        away = np.abs(solve(energy(order - 1, 2)).k - solved.k)
        solved = replace(solved, error=np.maximum(away, away.mean()))
    return solved


def _solved(pair, force, materials, phase, lines, bodies, bands, step):
    beta_b = abs(pair.gear_1.beta_b)
    orders = np.array(sorted({order for found in lines for _, order, _, _ in found}))
    approach, load, cells = np.zeros(phase.size), np.zeros((phase.size, orders.size)), []
    for i, found in enumerate(lines):
        finest = FINEST * _mean_half_width(pair, found, force, materials, beta_b)
        own = cells_of(pair, found, bands, math.tan(beta_b), max(step, finest))
        own, closed = _carried(pair, own, bodies, force / math.cos(beta_b), materials, beta_b)
        approach[i] = closed / math.cos(beta_b)
        np.add.at(load[i], np.searchsorted(orders, own.order), own.load * math.cos(beta_b))
        cells.append(own)
    dofs = tuple(body.unknowns for body, _ in bodies[0])
    return Contact3D(phase, 1e3 * force / approach, approach, orders, load, tuple(cells), dofs)


def _reach(lines):
    """Largest difference of the orders of pairs in contact at the same phase."""
    orders = [[order for _, order, _, _ in found] for found in lines]
    return max((max(own) - min(own) for own in orders if own), default=0)


def _mean_half_width(pair, lines, force, materials, beta_b):
    """Hertz half width [mm] of an even load at the pitch point."""
    length = sum(b - a for *_, left in lines for a, b in left)
    radius = pair.relative_radius(*pair.curvature_radii(pair.pitch_phase)) / math.cos(beta_b)
    return half_width(force / length, radius, contact_modulus(materials)) if length > 0 else 0.0


def _carried(pair, cells, bodies, normal, materials, beta_b):
    """`Cells` with their loads, and the approach at right angles to the flanks [mm], under a normal force [N]."""
    modulus = contact_modulus(materials)
    radius = np.abs(pair.relative_radius(cells.roll_1, cells.roll_2)) / math.cos(beta_b)
    ends = [(cells.depth + side * cells.width / 2) / math.cos(beta_b) for side in (-1, 1)]
    line = np.unique(np.array([cells.half, cells.order]), axis=1, return_inverse=True)[1].ravel()
    kernel = sum(body.kernel for body, _ in bodies[0])
    load, approach = line_cells(between(cells, bodies), np.zeros(line.size), normal, kernel, ends, line, radius, modulus)
    pressure = peak_pressure(load / (ends[1] - ends[0]), radius, modulus)
    return replace(cells, load=load, pressure=pressure), approach


def line_cells(matrix, gap, load, kernel, ends, line, radius, modulus):
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
        Number of each cell's line.
    radius : ndarray, shape (n,)
        Relative radius of curvature [mm].
    modulus : float
        Contact modulus E* [MPa].

    Returns
    -------
    force : ndarray, shape (n,)
        [N].
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
        force = np.zeros(gap.size)
        few = matrix[np.ix_(able, able)], gap[able], load, kernel, [end[able] for end in ends], line[able], radius[able], modulus
        force[able], approach = line_cells(*few)
        return force, approach
    length = ends[1] - ends[0]
    members = [np.flatnonzero(line == number) for number in np.unique(line)]
    force = load * length / length.sum()
    mean = _smoother(ends, line, SMOOTH * half_width(load / length.sum(), radius.mean(), modulus))
    widest = _pieces(ends, line) / 2  # a piece shorter than it is wide acts as one as wide as it is long
    active, x = np.ones(gap.size, dtype=bool), np.ones(gap.size)
    for attempt in range(MOST):
        if attempt < WIDTHS:
            wide = strip(half_width(np.maximum(mean @ force, FLOOR * load / length), radius, modulus))
            wide = np.minimum(wide, widest)
            x = wide if attempt < WIDTHS // 2 else np.sqrt(x * wide)
        total = matrix.copy()
        for at in members:
            total[np.ix_(at, at)] += kernel * line_kernel(ends[0][at], ends[1][at], x[at])
        if attempt < MOST // 2:
            new, approach = _free(total, gap, load, active)
            rests = total @ np.maximum(new, 0.0) + gap
            wanted = np.where(active, new > 0, rests < approach * (1 - 1e-12))
        else:
            new, approach = share(total, gap, load)
            wanted = active = new > 0
        settled = (wanted == active).all() and np.abs(new - force).max() < SETTLED * load
        active, force = wanted, np.maximum(new, 0.0)
        if settled:
            return force, float(approach)
        if not active.any():
            active[:] = True
    raise RuntimeError(f"load sharing along the contact lines did not settle at {load:g} N")


def _pieces(ends, line):
    """Length of the unbroken piece of contact each cell belongs to ``(n,)`` [mm]."""
    apart = (np.diff(line) != 0) | (np.abs(ends[0][1:] - ends[1][:-1]) > 1e-9 * (ends[1] - ends[0])[1:])
    number = np.concatenate([[0], np.cumsum(apart)])
    return np.bincount(number, weights=ends[1] - ends[0])[number]


def _smoother(ends, line, reach):
    """Matrix ``(n, n)`` from the cells' forces to mean line loads over `reach` [mm] on either side, within their lines."""
    middle = (ends[0] + ends[1]) / 2
    over = np.minimum(ends[1], middle[:, None] + reach) - np.maximum(ends[0], middle[:, None] - reach)
    over = np.where(line[:, None] == line, np.maximum(over, 0.0), 0.0)
    return over / over.sum(axis=1, keepdims=True) / (ends[1] - ends[0])


def _free(total, offset, load, active):
    """Forces ``(n,)`` of the active cells and their common approach, whatever their signs."""
    at = np.flatnonzero(active)
    try:
        factored = cho_factor(total[np.ix_(at, at)])
    except LinAlgError as error:
        raise RuntimeError("bodies too coarse: some load along the contact lines would gain energy; raise refine") from error
    solved = cho_solve(factored, np.column_stack([np.ones(at.size), offset[at]]))
    ones, gaps = solved.sum(axis=0)
    approach = (load + gaps) / ones
    new = np.zeros(offset.size)
    new[at] = approach * solved[:, 0] - solved[:, 1]
    return new, approach

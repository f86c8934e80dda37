"""Load sharing in a set: unilateral contacts on bodies that rotate and float.

With forces f of all contacts and motions q of the bodies::

    A f + gap = G q  where f > 0,    A f + gap >= G q  where f = 0,    G' f = load

A is the flexibility of gears, supports and contacts without rigid motions of the bodies. Its diagonal contains the logarithm of
each line contact at the current force.
"""

from typing import NamedTuple

import numpy as np
import scipy
from scipy.linalg import LinAlgError, cholesky, solve_triangular

from ..flexibility.hertz import half_width
from ..geometry.aliases import Floats

STEPS, SINGLE = 40, 400  # limits of steps of Newton's method and the active set: all changes at once, then one by one
HOLD = 1e-11  # weak springs on all motions, relative to the load per mm, which hold planets out of mesh
ROUNDING = 1e-12  # overlaps below this part of the largest distance are rounding errors
SETTLED = 1e-11  # largest last change of a force, as a part of the load
STIFF = 1e6  # weight of the balance in the initial non-negative least squares


class Problem(NamedTuple):
    """Contacts ``(n,)`` of a whole set: `flexibility` ``(n, n)``, `closing` G ``(n, motions)``, `load` ``(motions,)`` [N/mm].

    `gearfe.contact.sharing.line_contact` describes `gap`, `coefficient`, `radius`, `modulus` and `tilt` ``(n,)``.
    """

    flexibility: Floats
    gap: Floats
    coefficient: Floats
    radius: Floats
    modulus: Floats
    tilt: Floats
    closing: Floats
    load: Floats

    def with_more(self, flexibility: Floats, closing: Floats) -> "Problem":
        """Return the problem with m more contacts without gap and without Hertzian deflection.

        `flexibility` ``(n + m, n + m)`` and `closing` ``(n + m, motions)`` are those of all contacts.
        """
        count = flexibility.shape[0] - self.gap.size
        free = {"gap": 0.0, "coefficient": 0.0, "radius": 1.0, "modulus": 1.0, "tilt": 0.0}
        values = {name: np.append(getattr(self, name), np.full(count, value)) for name, value in free.items()}
        return self._replace(flexibility=flexibility, closing=closing, **values)


def balance(problem: Problem) -> tuple[Floats, Floats]:
    """Solve for the forces ``(n,)`` [N/mm] and motions of a `Problem`.

    In each iteration all contacts with tension are removed and all overlapping ones are added. If that does not converge, one
    contact is changed at a time. RuntimeError if no equilibrium without tension exists, or none was found.
    """
    unit = np.abs(problem.load).max()
    active = _likely(problem, unit)
    for most, at_once in ((STEPS, True), (SINGLE, False)):
        settled = _settled(problem, active, unit, most, at_once)
        if settled is not None:
            return settled
    raise RuntimeError("the loads of the set did not converge: change the load or the position slightly")


def _settled(problem, active, unit, most, at_once):
    """Run Newton's method with an active set, which changes `at_once` or by one contact. None if there is no convergence."""
    floor = 1e-9 * unit
    force = np.where(active, unit / max(np.count_nonzero(active), 1), 0.0)
    for _ in range(most):
        solution = _newton(problem, active, force, floor)
        if solution is None:
            return None
        new, motion = solution
        free = problem.flexibility @ np.maximum(new, 0.0) + problem.gap - problem.closing @ motion
        pulls, overlaps = active & (new < 0), ~active & (free < -ROUNDING * np.abs(free).max())
        flips = pulls | overlaps
        carried = np.where(active, np.maximum(new, floor), 0.0)  # A face without load has a force of exactly 0.
        if not flips.any() and np.abs(carried - force).max() < SETTLED * unit:
            return new, motion
        if not at_once:  # Tensile contacts are removed first, then overlaps are added.
            flips &= np.arange(new.size) == np.argmin(np.where(pulls, new, 0.0) if pulls.any() else np.where(overlaps, free, 0.0))
        force = np.where(flips, floor, carried)
        active = active ^ flips
        force = np.where(active, force, 0.0)
    return None


def _newton(problem, active, force, floor):
    """Return forces and motions for the `active` contacts, linearised at `force`."""
    at = np.flatnonzero(active)
    carried = np.maximum(force[at], floor)
    tilt, coefficient = problem.tilt[at], problem.coefficient[at]
    width = half_width(carried, problem.radius[at], problem.modulus[at])
    matrix = problem.flexibility[np.ix_(at, at)].copy()
    matrix[np.arange(at.size), np.arange(at.size)] += coefficient * np.log(2 / width) - 2 * tilt * carried
    offset = problem.gap[at] + (coefficient / 2 + tilt * carried) * carried
    closing = problem.closing[at]
    try:
        upper = cholesky(matrix)
        moved = solve_triangular(upper, np.column_stack([closing, offset]), trans="T")
        normal = moved[:, :-1].T @ moved[:, :-1] + HOLD * np.abs(problem.load).max() * np.eye(problem.load.size)
        motion = np.linalg.solve(normal, problem.load + moved[:, :-1].T @ moved[:, -1])
    except (LinAlgError, np.linalg.LinAlgError):
        return None
    out = np.zeros(force.size)
    out[at] = solve_triangular(upper, moved[:, :-1] @ motion - moved[:, -1])
    return out, motion


def _likely(problem, unit):
    """Estimate which contacts are closed by non-negative least squares, with stiffnesses for equal load sharing."""
    n = problem.gap.size
    even = np.full(n, unit / max(n, 1))
    width = half_width(even, problem.radius, problem.modulus)
    matrix = problem.flexibility + np.diag(problem.coefficient * np.log(2 / width))
    try:
        upper = cholesky(matrix)
    except LinAlgError as error:
        raise RuntimeError(
            "the flexibility between the contacts of the set is not positive definite: refine the meshes, or give wider pads"
        ) from error
    push = solve_triangular(upper, problem.gap + problem.coefficient / 2 * even, trans="T")
    # The gaps are shifted by a rigid motion, whose work is zero because of the balance.
    scale = STIFF * np.abs(upper).max()
    system, right = np.vstack([upper, scale * problem.closing.T]), np.append(-push, scale * problem.load)
    force, _ = scipy.optimize.nnls(system, right, maxiter=50 * n)
    rest = problem.closing.T @ force - problem.load
    if np.abs(rest).max() > 1e-3 * unit:
        raise RuntimeError("no compressive mesh forces balance this set: a body has no support")
    return force > 1e-9 * unit

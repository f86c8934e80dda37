"""Load sharing of unilateral contacts with the logarithmic compliance of line contact."""

from typing import Any, NamedTuple

import numpy as np
import scipy
from scipy.linalg import cholesky, solve_triangular
from scipy.linalg.lapack import dposv

from ..flexibility.hertz import half_width

STEPS = 20  # limit of active-set steps before non-negative least squares
TOGETHER = 30  # limit of active-set steps of many sets at once; the remaining ones are solved one by one
ROUNDING = 1e-12  # Overlaps below this part of the largest distance are rounding errors.


def share(flexibility, gap, load, weight=None, start=None):
    """Split a load over elastic contacts that can push but not pull.

    Contacts under load have the same approach. The others stay open::

        flexibility @ force + gap  = approach   where force > 0
        flexibility @ force + gap >= approach   where force = 0

    The active set removes contacts in tension and adds contacts that overlap, until there is none of either. This usually takes
    a few steps. If it does not converge, the energy is minimised over ``force >= 0, sum(force) = load``. With the Cholesky
    factor of the flexibility this is the point of a simplex nearest to the origin. Non-negative least squares finds it in
    finitely many steps.

    Parameters
    ----------
    flexibility : ndarray, shape (n, n)
        Approach at contact i per unit load at contact j [mm/N], symmetric positive definite.
    gap : ndarray, shape (n,)
        Unloaded distance of each contact along the line of action [mm].
    load : float
        Sum of the contact forces [N].
    weight : ndarray, shape (n,), optional
        1 for contacts that carry the load, 0 for others (crack faces): those close by no approach, only by `gap`.
    start : ndarray of bool, shape (n,), optional
        Contacts that are in touch at nearly the same load; default: all.

    Returns
    -------
    force : ndarray, shape (n,)
        Contact forces [N].
    approach : float
        Rigid-body approach along the line of action [mm].

    Raises
    ------
    ValueError
        If `load` is not positive.
    RuntimeError
        If the flexibility is not positive definite.

    References
    ----------
    T. F. Conry, A. Seireg, J. Eng. Ind. 95(4) (1973) 1115-1122 (the contact problem); P. Wolfe, Math. Program. 11 (1976)
    128-149 (the nearest point).

    Examples
    --------
    >>> force, approach = share(np.eye(2), np.array([0.0, 1.0]), 3.0)
    >>> np.round(force, 12), round(approach, 12)
    (array([2., 1.]), 2.0)
    """
    if not load > 0:
        raise ValueError(f"load = {load} N, but contacts can only push: give load > 0")
    gap = np.asarray(gap, dtype=float)
    weight = np.ones(gap.size) if weight is None else weight
    if gap.size == 1:
        return np.array([load]), float(flexibility[0, 0] * load + gap[0])
    settled = _settled(flexibility, gap, load, weight, np.ones(gap.size, dtype=bool) if start is None else start)
    if settled is not None:
        return settled
    try:
        upper = cholesky(flexibility)
    except np.linalg.LinAlgError as error:
        raise RuntimeError("the flexibility between the contacts is not positive definite; refine the mesh") from error
    least = gap[weight > 0].min()
    corners = load * upper + np.outer(solve_triangular(upper, gap - least * weight, trans="T"), weight)
    corners /= np.linalg.norm(corners, axis=0).max()
    weights, _ = scipy.optimize.nnls(np.vstack([corners, weight]), np.append(np.zeros(gap.size), 1.0))
    force = load * weights / (weights @ weight)
    closing = flexibility @ force + gap
    return force, float(force * weight @ closing / load)


def _settled(flexibility, gap, load, weight, active):
    """Return forces and approach by an active set, None if it does not converge."""
    for _ in range(STEPS):
        at = np.flatnonzero(active)
        if not weight[at].any():
            return None
        _, solved, fault = dposv(flexibility[np.ix_(at, at)].T, np.array([weight[at], gap[at]]).T, overwrite_a=1, overwrite_b=1)
        if fault:
            return None
        ones, gaps = solved.T
        approach = (load + weight[at] @ gaps) / (weight[at] @ ones)
        force = np.zeros(gap.size)
        force[at] = approach * ones - gaps
        distances = flexibility[:, at] @ force[at] + gap - approach * weight
        wanted = np.where(active, force > 0, distances < -ROUNDING * np.abs(distances).max())
        if (wanted == active).all():
            return force, float(approach)
        active = wanted
    return None


class LineContacts(NamedTuple):
    """Line contacts that carry a load together: of one set ``(n,)``, or of many ``(sets, n)``.

    `flexibility` ``(..., n, n)`` is that of both gears together, without local contact [mm per N/mm]. `gap` is in mm.
    `coefficient` is the sum of both half-plane coefficients [mm per N/mm], 0 for contacts whose `flexibility` is complete.
    `radius` is the relative radius of curvature [mm], and `modulus` the contact modulus E* [MPa]. Sliding
    along the flanks reduces the approach of contact k by ``tilt_k P_k**2``, `tilt` in mm per (N/mm)**2.
    """

    flexibility: Any
    gap: Any
    coefficient: Any
    radius: Any
    modulus: float
    tilt: Any = 0.0


def line_contact(contacts, load, weight=None, start=None):
    """Distribute a line load over line contacts, with the logarithmic half-plane deflection of each contact.

    Contact k adds ``coefficient * (ln(2 / a_k) + 1/2) P_k`` to the approach, with ``a_k`` its Hertzian half width. This is the
    half-plane deflection at the middle of an elliptic pressure. Newton's method linearises the logarithm, and every step solves
    an exact contact problem.

    Parameters
    ----------
    contacts : LineContacts
        Of one set.
    load : float
        Line load of all contacts together [N/mm].
    weight : ndarray, shape (n,), optional
        As in `share`.
    start : ndarray, shape (n,), optional
        Line loads near those wanted, 0 for contacts that are likely open [N/mm]; default: all alike.

    Returns
    -------
    force, approach, tangent : ndarray (n,), float, float
        Line loads [N/mm], approach [mm], and stiffness d load / d approach of the contacts in touch [N/mm per mm].
    """
    weight = np.ones(contacts.gap.size) if weight is None else weight
    force, approach, total = line_forces(contacts, load, weight, start)
    touch = force > 1e-9 * load
    tangent = weight[touch] @ np.linalg.solve(total[np.ix_(touch, touch)], weight[touch])
    return force, approach, float(tangent)


def line_forces(contacts, load, weight, start=None):
    """Return line loads and approach of `line_contact`, and the flexibility linearised at the second to last line loads."""
    flexibility, gap, coefficient, radius, modulus, tilt = contacts
    force, touch = (np.full(gap.size, load / gap.size), None) if start is None else (start, start > 0)
    for _ in range(60):
        carried, total = np.maximum(force, 1e-9 * load), flexibility.copy()
        local = coefficient * np.log(2 / half_width(carried, radius, modulus)) - 2 * tilt * carried
        total.reshape(-1)[:: gap.size + 1] += local
        new, approach = share(total, gap + (coefficient / 2 + tilt * carried) * carried, load, weight, touch)
        touch = new > 1e-9 * load
        settled = np.abs(new - force).max() < 1e-10 * load
        force = new
        if settled or not np.any(coefficient):
            return force, approach, total
    raise RuntimeError(f"load sharing did not converge at line load {load} N/mm; reduce the load or refine the mesh")


def line_contacts(contacts, load, possible, start=None):
    """Solve `line_contact` for many independent sets of contacts at once, by Newton's method and an active set.

    Sets whose active set does not converge are solved by `line_contact`.

    Parameters
    ----------
    contacts : LineContacts
        `coefficient` and `tilt` may be numbers.
    load : float or ndarray, shape (sets,)
    possible : ndarray of bool, shape (sets, n)
        Contacts that may carry load; at least one in each set.
    start : ndarray, shape (sets, n), optional
        Line loads in proportion to those expected, 0 for contacts that are likely open, at least one positive in each set.
        Default: all alike.

    Returns
    -------
    force, approach, tangent, settled : ndarray (sets, n), (sets,), (sets,), (sets,) of bool
    """
    sets, shape = len(contacts.gap), contacts.gap.shape
    load = np.broadcast_to(load, sets)[:, None]
    coefficient, tilt = (np.broadcast_to(values, shape) for values in (contacts.coefficient, contacts.tilt))
    case = contacts._replace(gap=np.where(possible, contacts.gap, 0.0), coefficient=coefficient, tilt=tilt)
    force, approach, tangent = np.zeros(shape), np.zeros(sets), np.zeros(sets)
    start = possible if start is None else start
    open_, active, old = np.arange(sets), start > 0, load * (start / start.sum(axis=1, keepdims=True))
    for _ in range(TOGETHER):
        new, approach[open_], tangent[open_] = _newton(case, load, active, old)
        force[open_] = np.where(active, new, 0.0)
        free = case.gap + (case.flexibility @ np.maximum(new, 0.0)[..., None])[..., 0]
        wanted = np.where(active, new > 0, possible & (free < approach[open_, None]))
        on = (wanted != active).any(axis=1) | ~(np.abs(new - old) < 1e-10 * load).all(axis=1)
        if not on.any():
            open_ = open_[on]
            break
        if not on.all():
            open_, wanted, new, load, possible = (values[on] for values in (open_, wanted, new, load, possible))
            case = LineContacts(*(values[on] if np.ndim(values) else values for values in case))
        active = np.where(wanted.any(axis=1, keepdims=True), wanted, possible)
        old = np.where(wanted, np.where(new > 0, new, 1e-9 * load), 0.0)
    settled = np.ones(sets, dtype=bool)
    settled[open_] = False
    return force, approach, tangent, settled


def _newton(contacts, load, active, force):
    """Return forces, approach and d load / d approach of `line_contacts` with the `active` contacts, linearised at `force`."""
    flexibility, gap, coefficient, radius, modulus, tilt = contacts
    (sets, n), diagonal = gap.shape, np.arange(gap.shape[1])
    carried = np.maximum(force, 1e-9 * load)
    system, right = np.zeros((sets, n + 1, n + 1)), np.zeros((sets, n + 1, 2))
    system[:, :n, :n] = flexibility
    system[:, diagonal, diagonal] += coefficient * np.log(2 / half_width(carried, radius, modulus)) - 2 * tilt * carried
    np.copyto(system[:, :n, :n], 0.0, where=~(active[:, :, None] & active[:, None, :]))
    system[:, diagonal, diagonal] += ~active
    system[:, :n, n], system[:, n, :n] = -active.astype(float), active
    right[:, :n, 0] = np.where(active, -gap - (coefficient / 2 + tilt * carried) * carried, 0.0)
    right[:, n] = np.append(load, np.ones((sets, 1)), axis=1)
    solution = np.linalg.solve(system, right)
    return solution[:, :n, 0], solution[:, n, 0], 1 / solution[:, n, 1]


def approaches(flexibility, gap, loads, possible):
    """Return the approach ``(loads, sets)`` [mm] of many contact problems under several loads, each solved by `share`.

    Contacts open as the load decreases. The loads are therefore solved in decreasing order, from the contacts of the last one.

    Parameters
    ----------
    flexibility : ndarray, shape (sets, n, n)
    gap : ndarray, shape (sets, n)
    loads : ndarray, shape (loads,)
    possible : ndarray of bool, shape (sets, n)
        Contacts that there are; at least one in each set.
    """
    out, start = np.empty((loads.size, len(gap))), None
    contacts = LineContacts(flexibility, gap, 0.0, np.ones(gap.shape), 1.0)
    for k in np.argsort(-loads).tolist():
        load = float(loads[k])
        start, out[k], _, settled = line_contacts(contacts, load, possible, start)
        for i in np.flatnonzero(~settled).tolist():
            on = possible[i]
            start[i, on], out[k, i] = share(flexibility[i][np.ix_(on, on)], gap[i, on], load)
    return out


def stacked(arrays):
    """Stack arrays ``(n,)`` or ``(n, n)`` of different sizes, padded with zeros."""
    sizes = [len(array) for array in arrays]
    out = np.zeros((len(arrays), *(max(sizes),) * arrays[0].ndim), dtype=arrays[0].dtype)
    for row, array, n in zip(out, arrays, sizes, strict=True):
        row[(slice(n),) * array.ndim] = array
    return out

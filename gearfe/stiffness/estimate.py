"""Estimated discretisation error of a stiffness at a phase. It is independent of the other phases of a list."""

import numpy as np

COARSER = {"fe": 0.5, "ritz": 0.7}  # resolution of the coarser solve, relative to that of the curve
# Lowest order of convergence of k in the edge length: 2 for finite elements (`fe`), 4 for the energy model with polynomials of
# order 4. The coarser solution of the energy model also has polynomials of one order less.
ORDER = {"fe": 2, "ritz": 4}
SAFETY = 3.0  # safety factor for two meshes, P. J. Roache, J. Fluids Eng. 116 (1994) 405-413
FINER = 2.0  # refinement of the hat functions at tip corners, whose error decreases at least linearly with their length
STEPS = 16  # number of fixed phases per base pitch
# Half-width of the window of fixed phases for the largest difference [base pitches]. Meshes of different size can agree by
# chance over a quarter of a base pitch.
WINDOW = {"fe": 1 / 2, "ritz": 1 / 8}
# Error of the contact model relative to k, from contact of whole outlines with negligible mesh error. It is smaller at nine
# of ten phases. Contact lines in three dimensions have the same law as the section.
MODEL = 1e-3
MEAN = 1 / 2  # half-width of the averaging window [base pitches]


def fixed_phases(phase, periodic):
    """Return the multiples ``(m,)`` of ``1 / STEPS`` that are used to estimate the error at `phase` ``(n,)``.

    With `periodic`, all teeth are equal, so that one base pitch is sufficient.
    """
    if periodic:
        return np.arange(STEPS) / STEPS
    reach = int(MEAN * STEPS)
    first = np.unique(np.floor(phase * STEPS).astype(int))
    return np.unique(first[:, None] + np.arange(-reach, reach + 2)) / STEPS


def estimate(phase, periodic, k, coarse, finer, *, energy):
    """Estimate the discretisation error of `k` from a coarser solve and one with finer hat functions at tip corners.

    If solves with edge lengths h and ``h / r`` differ by d, the error at h is ``d / (r**-p - 1)``, with the lowest order of
    convergence p. This is multiplied by `SAFETY`. Because d can vanish by chance, its largest value at the phase itself and at
    the fixed phases within `WINDOW` is used, and at least the mean over the fixed phases within `MEAN`. For finite elements,
    whose meshes of different size are unrelated, the window is wider, and that mean is added.

    While a contact moves over hat functions, the error of k oscillates: by 0.1 to 0.3 % within a hundredth of a pitch for ring
    pairs in contact at a tip corner. The difference from a coarser solve oscillates as well and can vanish. The difference from
    a solve with finer hat functions vanishes only with the error. Twice this difference is added at the same phase.

    All constants are published ones or follow from the orders. The estimate is judged on random pairs in
    ``tests/stiffness/test_error.py``, ``test_error_rings.py``, ``tests/flexibility/test_ritz.py`` and the page ``sample``.

    Parameters
    ----------
    phase : ndarray, shape (n,)
    periodic : bool
        Of `fixed_phases`.
    k, coarse, finer : ndarray, shape (n + m,)
        At `phase` and then at its `fixed_phases` [N/m]; of the curve, the coarser solve and the one with finer hat functions.
    energy : bool
        Whether this is the energy model, not finite elements.

    Returns
    -------
    ndarray, shape (n,)
        [N/m]
    """
    away = np.abs(k - coarse)
    apart = np.abs(phase[:, None] - fixed_phases(phase, periodic))
    if periodic:
        apart = np.abs((apart + 0.5) % 1 - 0.5)
    name = "ritz" if energy else "fe"
    largest = np.where(apart <= WINDOW[name] + 1e-9, away[phase.size :], 0.0).max(axis=1)
    within = apart <= MEAN + 1e-9
    mean = (within * away[phase.size :]).sum(axis=1) / within.sum(axis=1)
    largest = np.maximum(largest, away[: phase.size])
    doubt = np.maximum(largest, mean) if energy else largest + mean
    return SAFETY / (COARSER[name] ** -ORDER[name] - 1) * doubt + FINER / (FINER - 1) * np.abs(k - finer)[: phase.size]


def other_solves(refine, order=None):
    """Return options of the coarser solve and of the solve with finer hat functions. `order` is for the energy model."""
    coarse = (
        {"refine": COARSER["fe"] * refine} if order is None else {"refine": COARSER["ritz"] * refine, "order": max(order - 1, 2)}
    )
    return coarse, {"hats": FINER}

"""The estimated discretisation error of a stiffness, a property of its phase: neighbours in a list of phases do not enter."""

import numpy as np

COARSER = (0.5, 0.7)  # resolutions of the coarser solves, relative to that of the curve
FINER = 2.0  # times finer hats at tip corners
STEPS = 16  # fixed phases per base pitch
WINDOW = 1 / 8  # the largest difference is taken from the fixed phases so close, on either side
# Error of the contact against pressed whole outlines where no mesh is to blame, as a part of k, in nine of ten phases. Lines of
# contact in three dimensions have the laws of the section.
MODEL = 1e-3
MEAN = 1 / 2  # and the mean difference from those so close: one base pitch in all


def fixed_phases(phase, periodic):
    """Multiples ``(m,)`` of ``1 / STEPS`` that the estimate at `phase` ``(n,)`` looks at.

    `periodic`: all teeth are alike, so that one base pitch says it all.
    """
    if periodic:
        return np.arange(STEPS) / STEPS
    reach = int(MEAN * STEPS)
    first = np.unique(np.floor(phase * STEPS).astype(int))
    return np.unique(first[:, None] + np.arange(-reach, reach + 2)) / STEPS


def estimate(phase, periodic, k, coarse, finer=()):
    """Estimated discretisation error of `k` from coarser solves, and from some with finer hats at tip corners.

    The differences of `k` from the coarser solves are added; because they can vanish by chance at single phases, their largest
    value at the phase itself and at the fixed phases within `WINDOW` is taken, and the mean difference from the first, coarsest
    solve over the fixed phases within `MEAN` is added. For ``fe`` the two solves have edges 2 and 1 / 0.7 times as long; for
    ``ritz`` there is one with 1 / 0.7 times as long edges and, from order 3 on, one order less, and one with hats at tip corners
    half as long.

    While a contact slides over hats as long as a part of itself, k errs to and fro: by 0.1 to 0.3 % of ring pairs that touch with
    a tip corner, over a hundredth of a pitch. The difference from a coarser solve does so, too, and vanishes elsewhere; that from
    finer hats vanishes with the error itself. It is added at its own phase.

    That two solves and a sum are needed was found on the 31 random cases of seeds 0 to 39 in ``tests/stiffness/test_error.py``
    (all covered) and is judged on others there; ``ritz`` was looked at on seeds 0 to 39 of ``test_ritz.py``, its
    hats on ring pairs of seeds 0 to 259 of ``tests/stiffness/test_error_rings.py``, and is judged on others there.

    `k` ``(n + m,)`` [N/m] is at `phase` ``(n,)`` and then at its `fixed_phases`; `coarse` are the same from coarser solves, the
    coarsest first, `finer` those with finer hats. The error ``(n,)`` is in N/m.
    """
    away = np.abs(k - np.array(coarse))
    total, mean = away.sum(axis=0), away[0, phase.size :]
    at_phase = total[: phase.size] + sum(np.abs(k - other)[: phase.size] for other in finer)
    apart = np.abs(phase[:, None] - fixed_phases(phase, periodic))
    if periodic:
        apart = np.abs((apart + 0.5) % 1 - 0.5)
    largest = np.where(apart <= WINDOW + 1e-9, total[phase.size :], 0.0).max(axis=1)
    within = apart <= MEAN + 1e-9
    return np.maximum(largest, at_phase) + (within * mean).sum(axis=1) / within.sum(axis=1)


def coarser(refine, order=None):
    """Options of the coarser solves that `estimate` compares with; with a polynomial `order` that is one less."""
    if order is None:
        return [{"refine": ratio * refine} for ratio in COARSER]
    return [{"refine": COARSER[1] * refine, "order": max(order - 1, 2)}]


def finer_hats(order=None):
    """Options of the solves with finer hats: one for the energy model, which has a polynomial `order`."""
    return [] if order is None else [{"hats": FINER}]

"""Estimated error of a planetary set, from a coarser solution of some of its positions."""

from typing import Any

import numpy as np

from ..stiffness.section_curves import MODEL

CARRIES = 0.2  # minimum load relative to the mean load of its kind; below it, k depends little on the teeth


def set_error(found: Any, coarse: Any, some: Any) -> dict[str, Any]:
    """Return the estimated relative errors of `SetCurves` from a coarser solution of the positions `some`.

    Each is the largest difference of the two solves plus the mean one (see `gearfe.stiffness.estimate`) plus the error of the
    contact model. The coarser solve has longer edges, also along the faces of cracks, and a polynomial order lower by one.

    Returns
    -------
    dict
        ``"k"`` ``(2, planets)`` of the stiffness of each mesh where it carries more than `CARRIES` of the mean load, nan if it
        never does; ``"force"`` ``(2, planets)`` of its load, as a part of the mean load of its kind; ``"te"`` of the
        transmission error, as a part of its mean.
    """
    force = found.force[:, some]
    even = force.mean(axis=(1, 2), keepdims=True)
    with np.errstate(divide="ignore", invalid="ignore"):
        k = np.where(force > CARRIES * even, np.abs(coarse.k / found.k[:, some] - 1), np.nan)
    model = float(found.meta["left_out"].max()) + MODEL  # The load of a planet depends on the contact of all others.
    te = np.abs(coarse.te - found.te[some]) / np.abs(found.te).mean()
    return {
        "k": _worst(k) + found.meta["left_out"] + MODEL,
        "force": _worst(np.abs(coarse.force - force) / even) + model,
        "te": float(te.max() + te.mean() + model),
    }


def _worst(apart):
    """Return the largest plus the mean difference ``(2, planets)`` over the positions, or nan where none exists."""
    counts = np.isfinite(apart)
    values, number = np.where(counts, apart, 0.0), counts.sum(axis=1)
    return np.where(number > 0, values.max(axis=1) + values.sum(axis=1) / np.maximum(number, 1), np.nan)

"""Stiffness curves of gears of finite width, from contact along their contact lines."""

import time

import numpy as np

from .contact3d import pair_stiffness3d
from .curve import StiffnessCurve

MORE = 1.01  # load of the second solve that gives the tangent


def wide_curve(pair, force, materials, phase, cracks, pits, meta, error):
    """`StiffnessCurve` of a pair by the energy model in three dimensions.

    Parameters
    ----------
    pair : GearPair
    force : float
        Along the transverse line of action [N].
    materials : (Material, Material)
    phase : ndarray
    cracks, pits : (tuple, tuple)
        In each gear's own frame.
    meta : dict
        Holds ``face``, ``groove``, ``refine``, ``order`` and ``extended``.
    error : bool
        Estimate the discretisation error.

    Returns
    -------
    StiffnessCurve
        `pressure` is the largest of each pair's contact line, tip corners left out; nan where nothing else touches.
    """
    started = time.perf_counter()
    names = ("face", "groove", "refine", "order", "extended")
    options = {"pits": pits, "cracks": cracks, **{name: meta[name] for name in names}}
    found = pair_stiffness3d(pair, force, materials, phase, error=error, **options)
    more = pair_stiffness3d(pair, MORE * force, materials, phase, **options)
    pressure = np.zeros(found.load.shape)
    for i, cells in enumerate(found.cells):
        for k, order in enumerate(found.order):
            own = cells.pressure[(cells.order == order) & (cells.load > 0)]
            flat = own[np.isfinite(own)]
            pressure[i, k] = flat.max(initial=0.0) if flat.size or not own.size else np.nan
    used = found.load.max(axis=0) > 0
    return StiffnessCurve(
        phase=phase,
        k=found.k,
        k_tangent=1e3 * (MORE - 1) * force / (more.approach - found.approach),
        lte=1e-3 * found.approach,
        order=found.order[used],
        force=found.load[:, used],
        pressure=1e6 * pressure[:, used],
        error=found.error,
        meta=meta | {"force_N": force, "seconds_contact": time.perf_counter() - started},
    )

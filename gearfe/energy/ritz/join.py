"""Sectors joined to a whole gear, exactly: whether of the section or of a gear of finite width.

Sectors in a row are all alike where no load is, so that they are joined by doubling.
"""

import numpy as np
from scipy.linalg import LinAlgError
from scipy.linalg.blas import dsyrk
from scipy.linalg.lapack import dpotrf

from ...flexibility.triangular import divide


def join(gear, panels, healthy):
    """Influence between the loads of the teeth of `panels`, with `healthy` sectors everywhere else.

    Returns
    -------
    influence : dict of (int, int) to ndarray, shape (n, n)
    opening : dict
        By tooth the opening of all facing crack nodes under its loads ``(k, n)``, and under ``"influence"`` that under unit
        forces on them ``(k, k)``.
    """
    teeth = sorted(panels)
    segments = []
    for tooth, following in zip(teeth, [*teeth[1:], teeth[0] + gear.z], strict=True):
        segments.append((tooth, panels[tooth].stiffness))
        if following - tooth > 1:
            segments.append((None, repeated(healthy.stiffness, following - tooth - 1)))
    half = healthy.stiffness.shape[0] // 2
    total = np.zeros((len(segments) * half,) * 2)
    pushes, loads = {}, []
    for k, (tooth, stiffness) in enumerate(segments):
        places = np.concatenate([k * half + np.arange(half), (k + 1) % len(segments) * half + np.arange(half)])
        total[np.ix_(places, places)] += stiffness
        if tooth is not None:
            push = np.zeros((total.shape[0], panels[tooth].push.shape[1] + panels[tooth].open_push.shape[1]))
            push[places] = np.hstack([panels[tooth].push, panels[tooth].open_push])
            pushes[tooth] = slice(sum(p.shape[1] for p in loads), sum(p.shape[1] for p in loads) + push.shape[1])
            loads.append(push)
    loads = np.hstack(loads)
    between = _full(_added(total, loads, np.zeros((loads.shape[1],) * 2, order="F"), 1.0))
    n = healthy.push.shape[1]
    for tooth in teeth:
        at, panel = pushes[tooth], panels[tooth]
        direct = (panel.own + panel.own.T) / 2
        between[at, at] += np.block([[direct, panel.open_own.T], [panel.open_own, panel.open_open]])
    index = {t: slice(pushes[t].start, pushes[t].start + n) for t in teeth}
    faces = np.concatenate([np.arange(pushes[t].start + n, pushes[t].stop) for t in teeth])
    influence = {(i, j): between[index[i], index[j]].copy() for i in teeth for j in teeth}
    opening = {t: between[faces, index[t]] for t in teeth}
    mutual = between[np.ix_(faces, faces)]
    return influence, opening | {"influence": (mutual + mutual.T) / 2}


def repeated(stiffness, count):
    """Stiffness between the outer sides of `count` equal sectors in a row, by doubling."""
    out = None
    while count:
        if count % 2:
            out = stiffness if out is None else side_by_side(out, stiffness)
        count //= 2
        stiffness = side_by_side(stiffness, stiffness) if count else stiffness
    return _full(out)


def side_by_side(one, two):
    """Two sectors side by side, their common side eliminated; of all matrices only the lower triangles count."""
    h = one.shape[0] // 2
    out = np.zeros(one.shape, order="F")
    out[:h, :h], out[h:, h:] = one[:h, :h], two[h:, h:]
    coupling = np.hstack([one[h:, :h], two[h:, :h].T])
    return _added(one[h:, h:] + two[:h, :h], coupling, out, -1.0)


def _added(stiffness, loads, out, sign):
    """``out + sign loads' stiffness**-1 loads``, lower triangles, by Cholesky, forward only; `loads` are used up."""
    lower, failed = dpotrf(np.asfortranarray(stiffness), lower=1, clean=0, overwrite_a=1)
    if failed:
        raise LinAlgError("the stiffness of the joined sectors is not positive definite")
    across = np.asfortranarray(loads.T)
    divide(across, lower)
    return dsyrk(sign, across, beta=1.0, c=out, lower=1, overwrite_c=1)


def _full(lower):
    """The symmetric matrix of which `lower` has the lower triangle."""
    return np.where(np.tri(*lower.shape, dtype=bool), lower, lower.T)

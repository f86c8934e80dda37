"""Sectors joined to a whole gear, exactly: whether of the section or of a gear of finite width.

Sectors in a row are all alike where no load is, so that they are joined by doubling.
"""

import numpy as np
from scipy.linalg import cholesky, solve_triangular


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
    halved = _halved(total, loads)
    between = halved.T @ halved
    n = healthy.push.shape[1]
    for tooth in teeth:
        at, one = pushes[tooth], panels[tooth]
        own = (one.own + one.own.T) / 2
        between[at, at] += np.block([[own, one.open_own.T], [one.open_own, one.open_open]])
    index = {t: np.arange(pushes[t].start, pushes[t].start + n) for t in teeth}
    faces = np.concatenate([np.arange(pushes[t].start + n, pushes[t].stop) for t in teeth])
    influence = {(i, j): between[np.ix_(index[i], index[j])] for i in teeth for j in teeth}
    opening = {t: between[np.ix_(faces, index[t])] for t in teeth}
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
    return out


def side_by_side(one, two):
    """Two sectors side by side, their common side eliminated."""
    h = one.shape[0] // 2
    middle = one[h:, h:] + two[:h, :h]
    coupling = np.hstack([one[h:, :h], two[:h, h:]])
    halved = _halved(middle, coupling)
    out = -halved.T @ halved
    out[:h, :h] += one[:h, :h]
    out[h:, h:] += two[h:, h:]
    return (out + out.T) / 2


def _halved(stiffness, loads):
    """``L**-1 loads`` of ``stiffness = L L'``: its square is the displacement of the loads under each other."""
    return solve_triangular(cholesky(stiffness, lower=True, check_finite=False), loads, lower=True, check_finite=False)

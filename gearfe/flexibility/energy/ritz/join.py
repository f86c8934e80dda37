"""Sectors joined exactly to a whole gear, for transverse sections and for gears of finite width.

A row of sectors is represented by one matrix between its outer sides and its loads. The block of the loads is minus their
displacements under each other. Equal rows are computed once, so that sectors without loads are joined by doubling.
"""

import numpy as np

from ...condense import without


def join(gear, panels, healthy):
    """Influence between the loads of the teeth of `panels`. All other sectors are `healthy`.

    Returns
    -------
    influence : dict of (int, int) to ndarray, shape (n, n)
    opening : dict
        For each tooth, the opening of all facing crack nodes under its loads ``(k, n)``. The key ``"influence"`` has the opening
        under unit forces on them ``(k, k)``.
    """
    teeth, half = sorted(panels), healthy.stiffness.shape[0] // 2
    loaded = {id(panel): _loaded(panel) for panel in panels.values()}
    rows = []
    for tooth, following in zip(teeth, [*teeth[1:], teeth[0] + gear.z], strict=True):
        rows.append(loaded[id(panels[tooth])])
        if following - tooth > 1:
            rows.append(repeated(healthy.stiffness, following - tooth - 1))
    between = _closed(_in_a_row(rows, half), half)
    stops = np.cumsum([loaded[id(panels[tooth])].shape[0] - 2 * half for tooth in teeth]).tolist()
    starts = [0, *stops[:-1]]
    index = {tooth: slice(start, start + panels[tooth].push.shape[1]) for tooth, start in zip(teeth, starts, strict=True)}
    faces = np.concatenate([np.arange(index[tooth].stop, stop) for tooth, stop in zip(teeth, stops, strict=True)])
    influence = {(i, j): between[index[i], index[j]].copy() for i in teeth for j in teeth}
    opening = {t: between[faces, index[t]] for t in teeth}
    return influence, opening | {"influence": between[np.ix_(faces, faces)]}


def _loaded(panel):
    """Return one sector as a row (lower triangle), with its loads and the forces on its crack faces."""
    loads = np.hstack([panel.push, panel.open_push])
    m, n = loads.shape
    out = np.zeros((m + n,) * 2, order="F")
    out[:m, :m], out[m:, :m] = panel.stiffness, loads.T
    direct = (panel.own + panel.own.T) / 2
    out[m:, m:] = -np.block([[direct, panel.open_own.T], [panel.open_own, panel.open_open]])
    return out


def repeated(stiffness, count):
    """Stiffness between the outer sides of `count` equal sectors in a row."""
    return _full(_in_a_row([stiffness] * count, stiffness.shape[0] // 2))


def _in_a_row(rows, half):
    """Join many rows to one, two by two."""
    while len(rows) > 1:
        pairs = list(zip(rows[::2], rows[1::2], strict=False))
        alike = {(id(one), id(two)): (one, two) for one, two in pairs}
        made = {key: side_by_side(*pair, half) for key, pair in alike.items()}
        rows = [made[id(one), id(two)] for one, two in pairs] + rows[2 * len(pairs) :]
    return rows[0]


def side_by_side(one, two, half):
    """Join two adjacent rows by eliminating their common side of `half` unknowns.

    Only the lower triangles of the matrices are used.
    """
    left, right, loads = slice(half), slice(half, 2 * half), slice(2 * half, None)
    mine = slice(2 * half, one.shape[0])
    out = np.zeros((one.shape[0] + two.shape[0] - 2 * half,) * 2, order="F")
    across = np.empty((out.shape[0], half), order="F")
    yours = slice(mine.stop, None)
    out[left, left], out[right, right] = one[left, left], two[right, right]
    out[mine, left], out[mine, mine] = one[loads, left], one[loads, loads]
    out[yours, right], out[yours, yours] = two[loads, right], two[loads, loads]
    across[left], across[right] = one[right, left].T, two[right, left]
    across[mine], across[yours] = one[loads, right], two[loads, left]
    return without(np.asfortranarray(one[right, right] + two[left, left]), across, out)


def _closed(row, half):
    """Close a row to a ring, whose outer sides coincide. Return the displacements of its loads due to each other."""
    left, right, loads = slice(half), slice(half, 2 * half), slice(2 * half, None)
    around = row[left, left] + row[right, right] + row[right, left] + row[right, left].T
    parts = around, row[loads, left] + row[loads, right], row[loads, loads]
    return -_full(without(*map(np.asfortranarray, parts)))


def _full(lower):
    """Return the symmetric matrix with the given lower triangle."""
    return np.where(np.tri(*lower.shape, dtype=bool), lower, lower.T)

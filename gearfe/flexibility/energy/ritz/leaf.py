"""Matrix of a few triangles of a section, multiplied by the functions along the width."""

from itertools import pairwise

import numpy as np

from .bent import moved_factors, moved_products


def leaf(body, own, gone, rest, blocks):
    """Write the matrix of a few triangles into three blocks: `gone` by `gone`, `rest` by `gone`, `rest` by `rest`.

    The matrix of the section is assembled first, then multiplied by those of the functions along the width.
    """
    ids = np.append(gone, rest)
    raw = np.unique(body.numbers[:, own])
    nodes, loads = ids[ids < body.first_load], ids[ids >= body.first_load]
    index = np.full(body.first_load, -1)
    index[raw] = np.arange(raw.size)
    plane = np.zeros((4, 3 * raw.size, 3 * raw.size))
    for triangle in own:
        at = (3 * index[body.numbers[:, triangle]][:, None] + np.arange(3)).ravel()
        plane[(slice(None), *np.ix_(at, at))] += body.section[[0, 1, 1, 2], triangle]
    plane[2] = plane[1].T
    if body.bent is not None:
        plane = np.concatenate([plane, moved_products(body.bent, own, index[body.numbers[:, own]].T, raw.size)])
    forces = np.where(np.isin(body.owner[raw], own)[:, None, None], body.load[raw], 0.0)[:, :, loads - body.first_load]
    turn = _seamed(body, raw, nodes) if body.seams else None
    if turn is None or np.isin(turn, (0.0, 1.0)).all():
        taken = index[nodes] if turn is None else turn.argmax(axis=0)
        at = (3 * taken[:, None] + np.arange(3)).ravel()
        plane, forces = plane[:, at[:, None], at], forces[taken]
    else:
        forces, turn = turn.T @ forces.reshape(raw.size, -1), np.kron(turn, np.eye(3))
        plane = turn.T @ plane @ turn
    forces = forces.reshape(3 * nodes.size, loads.size)
    if body.parted:
        plane = _by_component(plane)
    _times(body, plane, forces, ids, gone.size, [block.T for block in blocks])


def _by_component(plane):
    """Return the matrices ``(8, n, n)`` of section and axial components separately, without twist terms."""
    axial = np.arange(plane.shape[1]) % 3 == 2
    rows = np.array([~axial, axial])[:, :, None]
    alike, apart = rows & (axial[:, None] == axial), rows & (axial[:, None] != axial)
    return plane[[0, 0, 1, 1, 2, 2, 3, 3]] * np.concatenate([alike, apart, apart, alike])


def _seamed(body, raw, nodes):
    """Return the matrix ``(raw, nodes)`` from means and differences of facing nodes to the nodes themselves.

    Other nodes are unchanged.
    """
    out = (raw[:, None] == nodes).astype(float)
    for left, right in body.seams:
        mean, apart = (nodes == pair[:, None] for pair in (left, right))
        for k in np.flatnonzero(mean.any(axis=1)):
            for side, sign in ((left[k], 0.5), (right[k], -0.5)):
                row = raw == side
                if row.any():
                    out[row] = mean[k] + sign * apart[k]
    return out


def _times(body, plane, here, ids, gone, blocks):
    """Multiply matrices ``(t, n, n)`` and loads of the section by those of the functions along the width. See `leaf`.

    Numbers in a row with the same functions are taken together. `blocks` are transposed: upper triangles are written, in rows.
    """
    nodes, kind, size = here.shape[0] // 3, body.kind[ids], body.size[ids]
    place, first = np.cumsum(size) - size, int(size[:gone].sum())
    place[gone:] -= first
    cuts = np.unique(np.concatenate([[0, gone, nodes, ids.size], 1 + np.flatnonzero(np.diff(kind))]))
    runs = [(slice(a, b), int(kind[a]), slice(place[a], place[a] + size[a:b].sum())) for a, b in pairwise(cuts.tolist())]
    for k, (nodes_i, kind_i, rows) in enumerate(runs):
        if nodes_i.start >= nodes:
            break  # The matrix has no entries between loads.
        for nodes_j, kind_j, columns in runs[k:]:
            factors, coupled = body.factors[kind_i, kind_j], plane[:, _three(nodes_i), _three(nodes_j)]
            if nodes_j.start >= nodes:
                factors, coupled = factors[:1], here[None, _three(nodes_i), nodes_j.start - nodes : nodes_j.stop - nodes]
            elif len(plane) > len(factors):
                factors = np.concatenate([factors, moved_factors(body.bent, kind_i, kind_j)])
            block = coupled.reshape(len(factors), -1).T @ factors.reshape(len(factors), -1)
            block = block.reshape(*coupled.shape[1:], *factors.shape[1:]).transpose(0, 2, 1, 3)
            target = blocks[(nodes_i.start >= gone) + (nodes_j.start >= gone)]
            target[rows, columns].reshape(block.shape)[:] = block


def _three(nodes):
    return slice(3 * nodes.start, 3 * nodes.stop)

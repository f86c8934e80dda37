"""What the polynomials of a sector's section miss near the tip corner and at the tips of cracks, known in plane strain.

The section's triangles of `panel3d` are coarser than those of `ritz`, which takes the singular fields of loads out. In plane
strain both are cheap, and their difference is what `solid` adds.
"""

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu

from ...halfspace import hat_points
from ...hertz import half_plane, hat_logarithm
from ...solid import hats
from ...solved import solved_gears
from .join import join
from .panel import Panel, SectionModel
from .panel3d import polar, section_of
from .plane import PLACES as LOADS
from .plane import carry, loaded_sector


def missing(model, cracks, sections, *, cubic=False, cache=True):
    """What the section's polynomials miss between the hats ``(PLACES, PLACES)`` [mm per N/mm].

    `cracks` are on tooth 0, `sections` the `Sector` with them and that without; `cubic` as of `panel3d.section_of`.
    """
    gear, material = model.gear, model.material
    healthy = plane_panel(model, sections[1], cubic)
    coarse = join(gear, {0: plane_panel(model, sections[0], cubic) if cracks else healthy, 1: healthy}, healthy)[0][0, 0]
    local = half_plane(material) * hat_logarithm(hats(gear), hats(gear))
    return plane_hats(gear, material, cracks, cache=cache) + local - coarse


def plane_panel(model, sector, cubic=False):
    """`Panel` of a sector in plane strain on the triangles of `panel3d`, loaded by the hats; faces of cracks are free."""
    gear = model.gear
    every, stiffness, load, sides, held, _ = section_of(model, sector, hats(gear), plane=True, cubic=cubic)
    nodes, local = int(every.max()) + 1, np.arange(3 * every.shape[0]).reshape(-1, 3)[:, :2].ravel()  # the third is zero
    at = (2 * every.T[:, :, None] + np.arange(2)).reshape(every.shape[1], -1)
    block = stiffness[0][:, local[:, None], local]
    rows, columns = np.broadcast_to(at[:, :, None], block.shape), np.broadcast_to(at[:, None], block.shape)
    matrix = coo_matrix((block.ravel(), (rows.ravel(), columns.ravel())), shape=(2 * nodes,) * 2).tocsr()
    force = np.zeros((2 * nodes, load.shape[2]))
    force[: 2 * load.shape[0]] = load[:, :2].reshape(-1, load.shape[2])
    inner = np.setdiff1d(np.arange(nodes), np.concatenate([sides, held]))
    inside, border = ((2 * numbers[:, None] + np.arange(2)).ravel() for numbers in (inner, sides))
    coupled = np.hstack([matrix[inside][:, border].toarray(), force[inside]])
    factor = splu(matrix[inside][:, inside].tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
    between = coupled.T @ factor.solve(coupled)
    m, n, sizes = border.size, force.shape[1], np.ones(sides.size, dtype=int)
    edge = matrix[border][:, border].toarray() - between[:m, :m]
    edge = polar(gear, sizes, polar(gear, sizes, edge, 2).T, 2)
    return Panel(
        stiffness=(edge + edge.T) / 2,
        push=polar(gear, sizes, force[border] - between[:m, m:], 2),
        own=between[m:, m:],
        open_push=np.zeros((m, 0)),
        open_own=np.zeros((0, n)),
        open_open=np.zeros((0, 0)),
        unknowns=inside.size,
    )


def plane_hats(gear, material, cracks=(), *, cache=True):
    """Plane strain's flexibility between the hats ``(PLACES, PLACES)`` [mm per N/mm], the half-plane's logarithm left out."""
    kept = solved_gears(cache)

    def solve():
        panels = {k: loaded_sector(SectionModel(gear, material), on_tooth, kept) for k, on_tooth in enumerate((cracks, ()))}
        influence = join(gear, panels, panels[1])[0][0, 0][:LOADS, :LOADS]
        points, weight = hat_points(hats(gear), 12)
        mean = np.einsum("hg,hgk->hk", weight, carry(gear, points.ravel()).reshape(*points.shape, -1))
        return mean @ (influence + influence.T) @ mean.T / 2

    return kept.get(("plane hats", gear, material, cracks), solve)

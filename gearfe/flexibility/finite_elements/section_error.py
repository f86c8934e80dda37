"""Discretisation error of the quads of a gear's section, from a finer section in plane strain.

A section costs a hundredth of the gear. It is one layer of hexahedra whose displacement is constant along the height, without an
axial part. The missing flexibility of its patches relative to the finer section is also missing in the gear at every height, for
any load along the width, since it originates much closer than the width.
"""

from dataclasses import replace

import numpy as np
from scipy.sparse import coo_matrix, csc_matrix, tril
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import splu

from ...geometry.damage.chip import loaded_side
from ...geometry.damage.crack import Crack
from ...geometry.damage.front import whole
from ...geometry.mesh.solid import HEX
from ..solid import hats
from ..solved import solved_gears
from .fe3d import Patches, mesh_patches, patch_loads
from .fe_gear3d import PER_HAT, SIZES
from .solid_assembly import assemble

FINER = 4.0  # resolution of the reference section, relative to the gear
THIN = 1e-2  # height of the layer [m_n], so small that the helix rotates it negligibly


def finer_section(found, material, damage=(), *, refine, cache=True):
    """Return a gear's `Flexibility3D` corrected, for every tooth, by a section of `FINER` times the resolution.

    `found` is the result of hexahedra whose section has resolution `refine`. Cracks of part of the width or of changing depth
    count with their whole section.
    """
    gear, kept = found.gear, solved_gears(cache)
    even = np.eye(found.degree + 1)

    def lacking(tooth):
        """Return the missing displacement ``(PLACES, PLACES)`` of hat functions under a unit force per width [mm**2/N]."""
        own = [one for one in damage if one.tooth % gear.z == tooth]
        case = gear, material, tuple(replace(whole(one) if isinstance(one, Crack) else one, tooth=0) for one in own)
        return kept.get(("section error", *case, refine), lambda: plane_hats(*case, FINER * refine) - plane_hats(*case, refine))

    near = {tooth: near + np.kron(lacking(tooth), even) for tooth, near in found.near.items()}
    healthy = found.healthy and finer_section(found.healthy, material, refine=refine, cache=kept)
    return replace(found, near=near, healthy=healthy)


def plane_hats(gear, material, damage, refine):
    """Displacement ``(PLACES, PLACES)`` of hat functions of tooth 0 under a unit force per width in plane strain [mm**2/N]."""
    thin = replace(gear, b=THIN * gear.m_n)
    cracks, broken = ([one for one in damage if isinstance(one, Crack) is cracked] for cracked in (True, False))
    patches = Patches((0,), hats(loaded_side(gear, broken, 0)), 1)
    options = {"refine": refine, "per_hat": PER_HAT, "layer": refine * thin.b, "sizes": SIZES}
    mesh = mesh_patches(thin, patches, cracks=cracks, broken=broken, **options)
    count = mesh.points.shape[1]
    lower = assemble(mesh.points, mesh.cells, material, np.arange(count))
    planar = _planar(mesh.cells, count)
    held = np.unique(planar[3 * mesh.held].indices // 2)
    free = np.setdiff1d(np.arange(planar.shape[1]), [2 * held, 2 * held + 1])
    load = (planar.T @ patch_loads(mesh, patches, 0))[free]
    matrix = csc_matrix(planar.T @ (lower + tril(lower, -1).T) @ planar)[free][:, free]
    return thin.b / np.cos(gear.beta_b) ** 2 * (load.T @ splu(matrix).solve(load))


def _planar(cells, count):
    """Matrix ``(3 count, 2 n)`` from planar displacements of the n section nodes to the nodes of one layer above them."""
    pairs = [(i, j) for i, (node, _) in enumerate(HEX) for j, (other, _) in enumerate(HEX) if node == other and i < j]
    ends = np.hstack([cells[list(pair)] for pair in pairs])
    joined = coo_matrix((np.ones(ends.shape[1]), tuple(ends)), shape=(count, count))
    n, where = connected_components(joined, directed=False)
    nodes = np.arange(count)
    rows, columns = np.append(3 * nodes, 3 * nodes + 1), np.append(2 * where, 2 * where + 1)
    return coo_matrix((np.ones(2 * count), (rows, columns)), shape=(3 * count, 2 * n)).tocsr()

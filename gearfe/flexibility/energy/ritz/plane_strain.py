"""Plane-strain correction for the coarse section mesh of `ritz3d` near tip corners and crack tips.

The triangles of `panel3d` are coarser than those of `ritz`, which subtracts the singular fields of loads. The difference of
both in plane strain is cheap to compute, and `solid` adds it.
"""

from dataclasses import replace

import numpy as np
from scipy.sparse import coo_array

from ....geometry.damage.chip import loaded_side
from ...condense import condense
from ...halfspace import hat_points
from ...hertz import half_plane, hat_logarithm
from ...solid import PLACES, hats
from ...solved import solved_gears
from .crack_faces import face_forces
from .join import join
from .panel import GROUP, SectionModel, panel_of, unknowns_of
from .panel3d import polar, section_of
from .plane import PLACES as LOADS
from .plane import carry, loaded_sector

FURTHER, HIGHEST = 3, 8  # additional polynomial orders for the comparison at cracks, and the highest order


def missing(model, section, healthy, *, chip=None, cubic=False, cache=True):
    """Return the flexibility that a `section` without cracks lacks between hat functions ``(PLACES, PLACES)`` [mm per N/mm].

    The section may have a `chip`; `healthy` is the one without. `panel3d.section_of` describes `cubic`.
    """
    gear, material, knots = model.gear, model.material, hats(end_of(model.gear, chip))
    others, coarse = sound(model, healthy, cubic, cache)
    if chip is not None:
        coarse = join(gear, {0: plane_panel(model, section, cubic, knots=knots), 1: others}, others)[0][0, 0]
    local = half_plane(material) * hat_logarithm(knots, knots)
    return plane_hats(gear, material, chip, cache=cache) + local - coarse


def end_of(gear, chip):
    """Return the gear shortened to the end of the loaded flank of a tooth with a `chip` (or None)."""
    return gear if chip is None else loaded_side(gear, [chip], chip.tooth)


def sound(model, section, cubic, cache):
    """Return the `Panel` of a healthy `section` in plane strain, and its influence between hat functions ``(PLACES, PLACES)``."""

    def solve():
        panel = plane_panel(model, section, cubic)
        return panel, join(model.gear, {0: panel, 1: panel}, panel)[0][0, 0]

    return solved_gears(cache).get(("ritz3d plane", model, cubic), solve)


def missing_at_cracks(model, sections, *, points=None, cubic=False, cache=True):
    """Return the flexibility that a cracked section lacks, beyond that of the healthy section [mm per N/mm].

    Parameters
    ----------
    model : SolidModel
    sections : (Sector, Sector)
        With the cracks, and healthy.
    points : ndarray, optional
        Vertices of the section with the cracks, if they are elsewhere; its faces keep their directions.
    cubic : bool
        See `panel3d.section_of`.

    Returns
    -------
    ndarray, shape (PLACES + k, PLACES)
        Displacement of the hat functions, then opening of k points of the faces, under unit loads on the hats. It is the
        difference from polynomials of an order `FURTHER` higher on the same triangles.
    """
    out = []
    for order in (min(model.order + FURTHER, HIGHEST), model.order):
        finer = replace(model, order=order)
        healthy, without = sound(finer, sections[1], cubic, cache)
        cracked = plane_panel(finer, sections[0], cubic, points=points, at=model.order)
        influence, opening = join(model.gear, {0: cracked, 1: healthy}, healthy)
        out.append(np.concatenate([influence[0, 0] - without, opening[0]]))
    return out[0] - out[1]


def completed(missed, cracks):
    """Return the opening ``(k, k)`` of points on the faces under unit forces there, consistent with `missing_at_cracks`.

    The flexibility that is missing at a crack tip acts on the hat functions through the bending of the tooth, by one field for
    each of the `cracks`. The smallest opening compatible with these fields is added. Faces that are pressed shut then lose the
    flexibility that was added to the hats. The logarithm of a point force, which depends on the polynomial order, is excluded.
    """
    size, field = np.linalg.eigh((missed[:PLACES] + missed[:PLACES].T) / 2)
    size, field = size[-cracks:], field[:, -cracks:]
    kept = size > 0
    apart = missed[PLACES:] @ field[:, kept] / np.sqrt(size[kept])
    return apart @ apart.T


def plane_panel(model, sector, cubic=False, *, points=None, at=None, knots=None):
    """Return the `Panel` of a sector in plane strain on the triangles of `panel3d`, loaded by hat functions.

    `points` are its vertices, if not its own. Facing points of cracks are the nodes of polynomials of order `at`, by default of
    the `model`.
    """
    gear, moved = model.gear, sector if points is None else replace(sector, points=points)
    knots = hats(gear) if knots is None else knots
    every, stiffness, load, sides, held, chain = section_of(model, moved, knots, plane=True, cubic=cubic)
    apart, _ = face_forces(sector, chain, load.shape[0], model.order, at or model.order)
    load = np.concatenate([load, apart], axis=2)
    # The axial component is absent in plane strain.
    local = np.arange(3 * every.shape[0]).reshape(-1, 3)[:, :2].ravel()
    m, dofs, centre = 2 * sides.size, unknowns_of(every.T), moved.points[:, moved.triangles].mean(axis=1)
    force = np.zeros((int(dofs.max()) + 1, load.shape[2]))
    force[: 2 * load.shape[0]] = load[:, :2].reshape(-1, load.shape[2])
    stays, fixed = unknowns_of(sides), unknowns_of(held)
    total = condense(stiffness[0][:, local[:, None], local], dofs, centre, coo_array(force), stays, fixed, leaf=GROUP)
    sizes = np.ones(sides.size, dtype=int)
    edge = polar(gear, sizes, polar(gear, sizes, total[:m, :m], 2).T, 2)
    push = polar(gear, sizes, total[:m, m:], 2)
    return panel_of(edge, push, -total[m:, m:], knots.shape[1], len(force) - stays.size - fixed.size)


def plane_hats(gear, material, chip=None, *, cache=True):
    """Return the plane-strain flexibility between hat functions ``(PLACES, PLACES)`` [mm per N/mm], without half-plane part.

    The tooth may have a `chip`.
    """
    kept, end = solved_gears(cache), end_of(gear, chip)

    def solve():
        own, panel = (loaded_sector(SectionModel(gear, material), (), kept, broken=one) for one in (chip, None))
        influence = join(gear, {0: own, 1: panel}, panel)[0][0, 0][:LOADS, :LOADS]
        points, weight = hat_points(hats(end), 12)
        mean = np.einsum("hg,hgk->hk", weight, carry(end, points.ravel()).reshape(*points.shape, -1))
        return mean @ (influence + influence.T) @ mean.T / 2

    return kept.get(("plane hats", gear, material, chip), solve)

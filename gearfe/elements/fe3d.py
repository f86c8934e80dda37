"""Flexibility of one gear between patches of its flanks, by brute force: three-dimensional finite elements.

A patch carries a pressure of known resultant along minus the flank's normal::

    p(s, z) dA = h(s) g(z) ds dz,    integral of h = 1

with a hat h along the transverse arc s of the flank and a function g of the height z. On an involute
helicoid ``dA = ds dz / cos(beta_b)`` and the normal has the axial part ``sin(beta_b)``. Displacement is measured with the same
weights, so the influence matrix ``C = F' K^-1 F`` is symmetric.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre
from scipy.sparse import coo_matrix

from geometry.mesh.solid import solid
from geometry.tooth.profile import arc_at, flank_normal, roll_at_arc

from .hexahedron import assemble, face_shapes
from .solver import factor, plan

ROLL_POINTS, HEIGHT_POINTS = 4, 6  # Gauss points between breakpoints along the profile and along the width


@dataclass(frozen=True, slots=True)
class Patches:
    """Pressures on the loaded flanks of one gear.

    Attributes
    ----------
    teeth : tuple of int
    knots : ndarray, shape (3, arcs)
        Start, top and end of each hat along the flank, as of `geometry.tooth.profile.arc_at` [mm].
    axial : int or ndarray
        Functions along the width: so many Legendre polynomials ``P_a(2 z / b - 1) / b``, of which the first is a uniform line
        load of unit resultant; or the knots [mm] of hats of unit integral, each from its left to its right neighbour, the
        first and the last one-sided.
    """

    teeth: tuple
    knots: np.ndarray
    axial: int | np.ndarray

    @property
    def modes(self):
        """Number of functions along the width."""
        return self.axial if np.ndim(self.axial) == 0 else np.size(self.axial)

    def along_profile(self, arc):
        """Hats ``(arcs, n)`` [1/mm] at places `arc` [mm]."""
        start, top, stop = np.asarray(self.knots)[:, :, None]
        rising = np.minimum((arc - start) / (top - start), (stop - arc) / (stop - top))
        return 2 / (stop - start) * np.maximum(rising, 0.0)

    def along_width(self, z, b):
        """Axial functions ``(modes, n)`` [1/mm] at heights `z` [mm]."""
        if np.ndim(self.axial) == 0:
            return legendre.legvander(2 * np.asarray(z) / b - 1, self.axial - 1).T / b
        knots = np.asarray(self.axial, dtype=float)
        tops = np.array([np.interp(z, knots, row) for row in np.eye(knots.size)])
        reach = np.diff(np.concatenate([knots[:1], knots, knots[-1:]]))
        return tops * 2 / (reach[1:] + reach[:-1])[:, None]

    def check(self, gear):
        """Raise ValueError if a hat leaves the flank or the axial knots leave the face."""
        low, high = arc_at(gear, gear.roll_f), arc_at(gear, gear.roll_a)
        slack = 1e-9 * gear.m_n
        knots = np.asarray(self.knots)
        if not (knots.ndim == 2 and knots.shape[0] == 3 and knots.size and (np.diff(knots, axis=0) > 0).all()):
            raise ValueError(f"knots = {self.knots}, but each hat needs a start, a top beyond it and an end beyond that [mm]")
        if knots.min() < low - slack or knots.max() > high + slack:
            raise ValueError(
                f"hats from {knots.min():.4g} to {knots.max():.4g} mm leave the flank, which runs from {low:.4g} to {high:.4g} mm"
            )
        if np.ndim(self.axial) == 0:
            if self.axial < 1:
                raise ValueError(f"axial = {self.axial}, but there is at least one function along the width")
        elif not (
            np.size(self.axial) > 1 and (np.diff(self.axial) > 0).all() and min(self.axial) >= 0 and max(self.axial) <= gear.b
        ):
            raise ValueError(f"axial = {self.axial}, but knots rise within 0 and b = {gear.b} mm")


@dataclass(frozen=True, slots=True)
class Influence:
    """Influence matrix between patches.

    `matrix` is (teeth, arcs, modes, teeth, arcs, modes) [mm/N], as loaded and read; `moved` the displacements (3, nodes,
    teeth * arcs * modes) [mm/N] if they were kept; `dofs` the unknowns, `plan` how they were solved for. `opening` (k, teeth,
    arcs, modes) is that of zones of crack faces under the patches, `mutual` (k, k) that under unit forces that push the zones'
    faces apart [mm/N], if asked for.
    """

    matrix: np.ndarray
    patches: Patches
    dofs: int
    plan: object
    moved: np.ndarray | None = None
    opening: np.ndarray | None = None
    mutual: np.ndarray | None = None


def mesh_patches(gear, patches, *, cracks=(), refine=1.0, per_hat=4, layer=None, sizes=None, fine=()):
    """Mesh `gear` for `patches`: `per_hat` edges across each hat and layers of height `layer` [mm].

    `layer` is b / 12 by default, at most a module. `refine` divides all edge lengths and the layers; `cracks`, `sizes`,
    `fine` as in `geometry.mesh.solid.solid`. What converges last are loads that run over the end faces:
    ``fine = [(0, 0, w), (b, b, w)]`` gives layers of w there.
    """
    patches.check(gear)
    places = [(start, stop, (stop - start) / (per_hat * refine)) for start, _, stop in patches.knots.T]
    layer = layer or min(gear.b / 12, gear.m_n)
    return solid(
        gear,
        layer=layer,
        loaded=patches.teeth,
        cracks=cracks,
        patches=places,
        refine=refine,
        sizes=sizes,
        fine=fine,
    )


def patch_loads(mesh, patches, tooth):
    """Consistent nodal forces of the patches on one tooth ``(3 nodes, arcs * modes)`` [N], node by node x, y, z.

    Both integrals are cut at the borders of the elements and at the knots of the hats.
    """
    gear = mesh.gear
    rising = gear.outward * mesh.section.roll[tooth % gear.z]  # a ring's roll length falls from root to tip
    cuts = gear.outward * roll_at_arc(gear, np.unique(patches.knots))
    edge, x, at, across = _points(rising, cuts, ROLL_POINTS)
    at = gear.outward * at
    layer, y, z, along = _points(mesh.levels, () if np.ndim(patches.axial) == 0 else patches.axial, HEIGHT_POINTS)
    across = across * at / gear.r_b  # ds = roll d(roll) / r_b
    hats, modes = patches.along_profile(arc_at(gear, at)) * across, patches.along_width(z, gear.b) * along
    used = np.flatnonzero(hats.any(axis=0))
    edge, x, at, hats = edge[used], x[used], at[used], hats[:, used]
    value = face_shapes(x[:, None], y[None, :])  # node, roll point, height point
    nodes = mesh.flank(tooth)[:, edge[:, None], layer[None, :]]
    plane = flank_normal(gear, at)
    turn = 2 * math.pi * tooth / gear.z + gear.twist_rate * z
    cos, sin = np.cos(turn), np.sin(turn)
    tilt = math.cos(gear.beta_b)
    normal = np.array([
        tilt * (np.outer(plane[0], cos) + np.outer(plane[1], sin)),
        tilt * (np.outer(plane[1], cos) - np.outer(plane[0], sin)),
        np.full((at.size, z.size), -math.sin(gear.beta_b)),
    ])  # fmt: skip
    weight = np.einsum("ir,az->iarz", hats, modes)
    rows = (3 * nodes[:, None] + np.arange(3)[:, None, None]).reshape(24, -1)
    spread = -(value[:, None] * normal).reshape(24, -1)
    points = np.broadcast_to(np.arange(rows.shape[1]), rows.shape)
    shape = 3 * mesh.points.shape[1], rows.shape[1]
    return coo_matrix((spread.ravel(), (rows.ravel(), points.ravel())), shape=shape).tocsr() @ weight.reshape(-1, rows.shape[1]).T


def _points(ends, cuts, count):
    """Gauss points between all of `ends` and `cuts`: interval of `ends`, place in it (-1..1), place and weight."""
    inner = [c for c in cuts if ends[0] < c < ends[-1]]
    every = np.unique(np.concatenate([ends, inner]))
    every = every[np.concatenate([[True], np.diff(every) > 1e-12 * (ends[-1] - ends[0])])]
    gauss, weight = legendre.leggauss(count)
    half = np.diff(every)[:, None] / 2
    place = ((every[1:] + every[:-1])[:, None] / 2 + half * gauss).ravel()
    interval = np.clip(np.searchsorted(ends, place) - 1, 0, ends.size - 2)
    local = 2 * (place - ends[interval]) / (ends[interval + 1] - ends[interval]) - 1
    return interval, local, place, (half * weight).ravel()


def planned(mesh, patches, more=0):
    """`gearfe.elements.solver.Plan` of the influence between patches, with so many `more` right-hand sides."""
    free = mesh.points.shape[1] - np.unique(mesh.held).size
    return plan(3 * free, columns=len(patches.teeth) * patches.knots.shape[1] * patches.modes + more)


def influence(mesh, material, patches, *, keep=False, tell=None, zones=None):
    """Influence matrix between all patches.

    Parameters
    ----------
    mesh : geometry.mesh.solid.Solid
        With the loaded flanks of all of `patches.teeth`, see `mesh_patches`.
    material : Material
    patches : Patches
    keep : bool
        Whether to return the displacements too.
    tell : callable, optional
        Gets the `gearfe.elements.solver.Plan`, with the expected seconds and memory, before anything costly starts.
    zones : ndarray, shape (3 nodes, k), optional
        Nodal forces that push apart zones of crack faces, of `gearfe.elements.crack_zones.zone_forces`.

    Returns
    -------
    Influence
    """
    patches.check(mesh.gear)
    free = np.setdiff1d(np.arange(mesh.points.shape[1]), mesh.held)
    own = len(patches.teeth) * patches.knots.shape[1] * patches.modes
    zones = np.zeros((3 * mesh.points.shape[1], 0)) if zones is None else zones
    made = planned(mesh, patches, zones.shape[1])
    if tell:
        tell(made)
    load = np.hstack([*(patch_loads(mesh, patches, tooth) for tooth in patches.teeth), zones])
    rows = (3 * free[:, None] + np.arange(3)).ravel()
    solve = factor(assemble(mesh.points, mesh.cells, material, free), made)
    whole = None
    if keep:
        whole = np.zeros(load.shape)
        whole[rows] = solve(load[rows])
        matrix = load.T @ whole
        whole = whole[:, :own].reshape(-1, 3, own).transpose(1, 0, 2)
    else:
        matrix = solve.gram(load[rows])
    if not np.isfinite(matrix).all():
        raise RuntimeError("the FE solve gave no finite displacement: the body is not held, or nu is too close to 0.5")
    shape = len(patches.teeth), patches.knots.shape[1], patches.modes
    opening, mutual = matrix[own:, :own].reshape(-1, *shape), matrix[own:, own:]
    return Influence(matrix[:own, :own].reshape(*shape, *shape), patches, rows.size, made, whole, opening, mutual)

"""Flexibility of one gear between patches of its flanks, by three-dimensional finite elements.

A patch carries a pressure of known resultant along minus the flank's normal::

    p(s, z) dA = h(s) g(z) ds dz,    integral of h = 1

with a hat function h along the transverse arc s of the flank and a function g of the height z. On an involute
helicoid ``dA = ds dz / cos(beta_b)`` and the normal has the axial part ``sin(beta_b)``. Displacement is measured with the same
weights, so the influence matrix ``C = F' K^-1 F`` is symmetric.
"""

import math
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.polynomial import legendre
from scipy.sparse import coo_matrix, csc_array, hstack

from ...geometry.mesh.solid import solid
from ...geometry.tooth.profile import arc_at, flank_arcs, flank_normal, roll_at_arc, turned
from .hexahedron import face_shapes
from .solid_assembly import assemble
from .solver import half_solved, plan

ROLL_POINTS, HEIGHT_POINTS = 4, 6  # Gauss points between breakpoints along the profile and along the width


@dataclass(frozen=True, slots=True)
class Patches:
    """Pressures on the loaded flanks of one gear.

    Attributes
    ----------
    teeth : tuple of int
    knots : ndarray, shape (3, arcs)
        Start, top and end of each hat function along the flank [mm], see `gearfe.geometry.tooth.profile.arc_at`.
    modes : int
        Number of functions along the width: the Legendre polynomials ``P_a(2 z / b - 1) / b``, of which the first is a uniform
        line load of unit resultant.
    own : dict of int to ndarray, shape (3, arcs)
        Knots of teeth whose loaded flanks end below the tip circle.
    """

    teeth: tuple
    knots: np.ndarray
    modes: int
    own: dict = field(default_factory=dict)

    @property
    def shape(self):
        """Numbers of teeth, of hat functions along the profile, and of modes along the width."""
        return len(self.teeth), self.knots.shape[1], self.modes

    def along_profile(self, arc):
        """Hat functions ``(arcs, n)`` [1/mm] at places `arc` [mm]."""
        start, top, stop = np.asarray(self.knots)[:, :, None]
        rising = np.minimum((arc - start) / (top - start), (stop - arc) / (stop - top))
        return 2 / (stop - start) * np.maximum(rising, 0.0)

    def along_width(self, z, b):
        """Axial functions ``(modes, n)`` [1/mm] at heights `z` [mm]."""
        return legendre.legvander(2 * np.asarray(z) / b - 1, self.modes - 1).T / b

    def of(self, tooth):
        """Return the patches of one tooth."""
        return replace(self, teeth=(tooth,), knots=self.own.get(tooth, self.knots))

    def check(self, gear):
        """Raise ValueError if a hat function leaves the flank."""
        low, high = flank_arcs(gear)
        slack = 1e-9 * gear.m_n
        knots = np.asarray(self.knots)
        if not (knots.ndim == 2 and knots.shape[0] == 3 and knots.size and (np.diff(knots, axis=0) > 0).all()):
            raise ValueError(f"knots = {self.knots}, but each hat function needs three increasing numbers: start, top, end [mm]")
        if knots.min() < low - slack or knots.max() > high + slack:
            raise ValueError(
                f"hat functions from {knots.min():.4g} to {knots.max():.4g} mm leave the flank, which runs from {low:.4g} to "
                f"{high:.4g} mm"
            )
        if self.modes < 1:
            raise ValueError(f"modes = {self.modes}, but at least one function along the width is required")


@dataclass(frozen=True, slots=True)
class Influence:
    """Influence matrix between patches.

    `matrix` is (teeth, arcs, modes, teeth, arcs, modes) [mm/N]. Its first three axes are loaded patches, the others those where
    it is read. `dofs` is the number of unknowns. `opening` (k, teeth, arcs, modes) is the opening of zones of crack faces under
    loads on the patches. `mutual` (k, k) is that under unit forces that push the faces of zones apart [mm/N].
    """

    matrix: np.ndarray
    dofs: int
    opening: np.ndarray
    mutual: np.ndarray

    @classmethod
    def between(cls, patches, matrix, dofs):
        """Create the record from the flexibility matrix of all patches, followed by crack zones."""
        shape, size = patches.shape, math.prod(patches.shape)
        within = matrix[:size, :size].reshape(*shape, *shape)
        return cls(within, dofs, matrix[size:, :size].reshape(-1, *shape), matrix[size:, size:])


def mesh_patches(gear, patches, *, cracks=(), broken=(), refine=1.0, per_hat=4, layer=None, sizes=None, fine=()):
    """Mesh `gear` for `patches`, with `per_hat` edges per hat function and layers of height `layer` [mm].

    `layer` is b / 12 by default, at most a module. `refine` divides all edge lengths and the layers; `cracks`, `broken`, `sizes`,
    `fine` as in `gearfe.geometry.mesh.solid.solid`. Loads at the end faces converge slowest:
    ``fine = [(0, 0, w), (b, b, w)]`` gives layers of height w there.
    """
    patches.check(gear)
    places = {
        tooth: [(start, stop, (stop - start) / (per_hat * refine)) for start, _, stop in patches.of(tooth).knots.T]
        for tooth in patches.teeth
    }
    layer = layer or min(gear.b / 12, gear.m_n)
    options = {"broken": broken, "refine": refine, "sizes": sizes, "fine": fine}
    return solid(gear, layer=layer, loaded=patches.teeth, cracks=cracks, patches=places, **options)


def patch_loads(mesh, patches, tooth):
    """Consistent nodal forces of the patches on one tooth ``(3 nodes, arcs * modes)`` [N], node by node x, y, z.

    Both integrals are cut at the borders of the elements, that along the profile also at the knots of the hats.
    """
    gear, patches = mesh.gear, patches.of(tooth)
    rising = gear.outward * mesh.section.roll[tooth % gear.z]  # The roll length of a ring gear decreases from root to tip.
    cuts = gear.outward * roll_at_arc(gear, np.unique(patches.knots))
    edge, x, at, across = points_between(rising, cuts, ROLL_POINTS)
    at = gear.outward * at
    layer, y, z, along = points_between(mesh.levels, (), HEIGHT_POINTS)
    across = across * at / gear.r_b  # ds = roll d(roll) / r_b
    hats, modes = patches.along_profile(arc_at(gear, at)) * across, patches.along_width(z, gear.b) * along
    used = np.flatnonzero(hats.any(axis=0))
    edge, x, at, hats = edge[used], x[used], at[used], hats[:, used]
    value = face_shapes(x[:, None], y[None, :])  # node, roll point, height point
    nodes = mesh.flank(tooth)[:, edge[:, None], layer[None, :]]
    normal = helicoid_normal(gear, at, z, 2 * math.pi * tooth / gear.z)
    weight = np.einsum("ir,az->iarz", hats, modes)
    rows = (3 * nodes[:, None] + np.arange(3)[:, None, None]).reshape(24, -1)
    spread = -(value[:, None] * normal).reshape(24, -1)
    points = np.broadcast_to(np.arange(rows.shape[1]), rows.shape)
    shape = 3 * mesh.points.shape[1], rows.shape[1]
    return coo_matrix((spread.ravel(), (rows.ravel(), points.ravel())), shape=shape).tocsr() @ weight.reshape(-1, rows.shape[1]).T


def helicoid_normal(gear, roll, z, turn=0.0):
    """Outward normals ``(3, n, m)`` of the loaded flank at roll lengths ``(n,)`` and heights ``(m,)`` [mm].

    The tooth is `turn` [rad] away from tooth 0.
    """
    plane, turn, tilt = flank_normal(gear, roll), turn + gear.twist_rate * z, math.cos(gear.beta_b)
    return turned((*tilt * plane[:, :, None], np.full((roll.size, z.size), -math.sin(gear.beta_b))), turn)


def points_between(ends, cuts, count):
    """Gauss points between all of `ends` and `cuts`: interval of `ends`, position in it (-1..1), place and weight."""
    inner = [c for c in cuts if ends[0] < c < ends[-1]]
    breaks = np.unique(np.concatenate([ends, inner]))
    breaks = breaks[np.concatenate([[True], np.diff(breaks) > 1e-12 * (ends[-1] - ends[0])])]
    gauss, weight = legendre.leggauss(count)
    half = np.diff(breaks)[:, None] / 2
    place = ((breaks[1:] + breaks[:-1])[:, None] / 2 + half * gauss).ravel()
    interval = np.clip(np.searchsorted(ends, place) - 1, 0, ends.size - 2)
    local = 2 * (place - ends[interval]) / (ends[interval + 1] - ends[interval]) - 1
    return interval, local, place, (half * weight).ravel()


def planned(mesh, patches, more=0):
    """Return the `SolveCost` (`finite_elements.solver`) of the influence between patches, with `more` right-hand sides."""
    free = mesh.points.shape[1] - np.unique(mesh.held).size
    return plan(3 * free, columns=math.prod(patches.shape) + more)


def loads_and_rows(mesh, patches, zones):
    """Nodal forces of all patches, then of zones ``(3 nodes, n)``, the nodes that can move, and their unknowns.

    The forces are sparse: few nodes are on loaded flanks, and dense columns would take as much memory as the factor.
    """
    parts = [csc_array(patch_loads(mesh, patches, tooth)) for tooth in patches.teeth]
    load = hstack([*parts, *([] if zones is None else [csc_array(zones)])], format="csr")
    free = np.setdiff1d(np.arange(mesh.points.shape[1]), mesh.held)
    return load, free, (3 * free[:, None] + np.arange(3)).ravel()


def influence(mesh, material, patches, *, tell=None, zones=None):
    """Compute the influence matrix between all patches.

    Parameters
    ----------
    mesh : gearfe.geometry.mesh.solid.Solid
        With the loaded flanks of all of `patches.teeth`, see `mesh_patches`.
    material : Material
    patches : Patches
    tell : callable, optional
        Gets the `finite_elements.solver.SolveCost`, with the expected seconds and memory, before anything costly starts.
    zones : ndarray, shape (3 nodes, k), optional
        Nodal forces that push apart zones of crack faces, of `gearfe.flexibility.finite_elements.crack_zones.zone_forces`.

    Returns
    -------
    Influence
    """
    patches.check(mesh.gear)
    cost = planned(mesh, patches, 0 if zones is None else zones.shape[1])
    if tell:
        tell(cost)
    load, free, rows = loads_and_rows(mesh, patches, zones)
    matrix = half_solved(assemble(mesh.points, mesh.cells, material, free), load[rows], cost)
    if not np.isfinite(matrix).all():
        raise RuntimeError("the FE solve gave no finite displacement: the body is not held, or nu is too close to 0.5")
    return Influence.between(patches, matrix, rows.size)

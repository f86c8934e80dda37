"""`Flexibility3D` of a whole gear in hexahedra (`fe3d`) under the patches of `gearfe.flexibility.solid`."""

import math
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from scipy.linalg import eigh

from ...core.supports.shaft import Shaft
from ...geometry.damage.chip import loaded_side
from ...geometry.damage.kinds import BROKEN
from ...geometry.tooth.gear import Gear
from ..halfspace import half_space
from ..solid import Faces, hats, own_distance, parted, solved_teeth
from . import solver
from .crack_zones import zone_forces
from .fe3d import Patches, influence, mesh_patches, planned
from .integral import integral_influence, on_stubs

FEWEST = 60_000  # least number of unknowns of a gear at refine 1; it grows with the power 2.5 to 3 of refine
LOST = 2  # number of highest axial degrees that may be dropped if the layers do not resolve them
RESOLVED = 0.05  # least displacement under a patch relative to a half-space; a smaller value indicates a mesh that is too coarse
PER_HAT = 4  # edges across a hat function
LAYER = 2.0  # height of the element layers [m_n], at most a sixth of the width
END = 0.25  # height of the end layers relative to the others; loads and modes change most there
# edge lengths in modules, see `gearfe.geometry.mesh.quads.SIZES`; the section costs little: layers times teeth fill the memory
SIZES = {"flank": 0.13, "corner": 0.07, "fillet": 0.17, "root": 0.27, "near": 0.33, "far": 0.8, "crack": 0.2, "crack tip": 0.04}


def axial_modes(width, m_n):
    """Highest degree of the patches along a `width` [mm]: 0.8 per normal module plus 2, at least 8.

    `ritz3d` uses 2 degrees less.
    """
    return max(8, math.ceil(0.8 * width / m_n) + 2)


@dataclass(frozen=True, slots=True)
class MeshedGear:
    """Gear of finite width with the options of its mesh, and the teeth that are loaded.

    Attributes
    ----------
    gear : Gear
        Bore or rim are held over the whole width, the end faces free.
    damage : tuple of (Crack, MissingTooth or Chip)
        The faces of cracks are kept from passing through each other, zone by zone (`finite_elements.crack_zones`).
    neighbours : int
        How many following teeth may carry load at the same time.
    degree : int, optional
        Of the patches along the width, before `less` is taken off; default `axial_modes`. At most two of the highest degrees are
        dropped if the layers cannot carry them (seen on the gear without cracks).
    refine : float
        Divides all edge lengths and the layers.
    section : float, optional
        Divides the edges of the section instead.
    shaft : Shaft, optional
        Of a gear that is one piece with it: held by it at its end faces, the bore free.
    """

    gear: Gear
    damage: tuple = ()
    neighbours: int = 1
    degree: int | None = None
    less: int = 0
    refine: float = 1.0
    section: float | None = None
    shaft: Shaft | None = None

    def meshed(self):
        """Mesh and `Patches`.

        Raises
        ------
        ValueError
            If `refine` is not positive.
        """
        gear, refine = self.gear, self.refine
        if not (math.isfinite(refine) and refine > 0):
            raise ValueError(f"refine = {refine}, but it divides the edge lengths: give a positive number")
        solver.plan(int(FEWEST * max(refine, 1.0) ** 2.5), columns=1)  # Gears that exceed the memory are rejected before meshing.
        degree = (axial_modes(gear.b, gear.m_n) if self.degree is None else self.degree) - self.less
        broken = tuple(one for one in self.damage if isinstance(one, BROKEN))
        own = {one.tooth % gear.z: hats(loaded_side(gear, broken, one.tooth)) for one in broken}
        patches = Patches(tuple(solved_teeth(gear, self.damage, self.neighbours)), hats(gear), degree + 1, own)
        section = refine if self.section is None else self.section
        layer = min(LAYER * gear.m_n, gear.b / 6) * section / refine
        fine = [(z, z, END * layer) for z in (0.0, gear.b)]
        options = {"refine": section, "per_hat": PER_HAT, "layer": layer, "sizes": SIZES, "fine": fine}
        cracks = tuple(one for one in self.damage if one not in broken)
        return mesh_patches(gear, patches, cracks=cracks, broken=broken, **options), patches

    def plan(self):
        """Return the expected cost (`finite_elements.solver.SolveCost`) of `solid_flexibility`.

        Only the mesh is computed for this. RuntimeError if the system does not fit into memory.
        """
        mesh, patches = self.meshed()
        columns = zone_forces(mesh).shape[1]
        if self.shaft is not None:
            mesh, discs = on_stubs(mesh, self.shaft)
            columns += discs.shape[1]
        return planned(mesh, patches, columns)


def solid_flexibility(whole, material, *, healthy=None, tell=None, cache=True):
    """Compute the `Flexibility3D` of a `MeshedGear` by finite elements.

    Parameters
    ----------
    healthy : Flexibility3D, optional
        Of the gear without damage; needed if it has damage.
    tell
        As in `gearfe.flexibility.finite_elements.fe3d.influence`.
    cache : bool or SolvedGears
        Where to look for the half-space's part, see `gearfe.flexibility.solved.solved_gears`.

    Raises
    ------
    ValueError
        If an input is impossible.
    RuntimeError
        If the system does not fit into memory, with the numbers, or if the mesh cannot carry the patches.
    """
    gear, (mesh, patches) = whole.gear, whole.meshed()
    teeth, degree = patches.teeth, patches.modes - 1
    solve = influence if whole.shaft is None else partial(integral_influence, shaft=whole.shaft)
    solved = solve(mesh, material, patches, tell=tell, zones=zone_forces(mesh))
    unit = np.tile(np.sqrt((2 * np.arange(degree + 1) + 1) * gear.b), patches.knots.shape[1])  # orthonormal polynomials
    size = unit.size
    matrix = solved.matrix.reshape(len(teeth), size, len(teeth), size) * unit[:, None, None] * unit
    kept = _resolved(whole, material, matrix[0, :, 0], degree, cache) if healthy is None else healthy.degree
    carried = np.flatnonzero(np.arange(size) % (degree + 1) <= kept)
    between = {(i, j): matrix[a][np.ix_(carried, [b], carried)][:, 0] for a, i in enumerate(teeth) for b, j in enumerate(teeth)}
    flexibility = parted(gear, material, kept, between, solved.dofs, healthy, damage=whole.damage, cache=cache)
    if not solved.mutual.size:
        return flexibility
    opening = {tooth: (solved.opening[:, k].reshape(-1, size) * unit)[:, carried] for k, tooth in enumerate(teeth)}
    return replace(flexibility, seam=Faces(opening, solved.mutual))


def _resolved(whole, material, own, degree, cache):
    """Return the highest degree that the layers resolve, between `degree` less `LOST` and `degree`.

    `own` is the flank's influence.
    """
    gear = whole.gear
    for kept in range(degree, degree - LOST - 1, -1):
        at = np.flatnonzero(np.arange(len(own)) % (degree + 1) <= kept)
        flat = half_space(material) * own_distance(gear, kept, cache=cache)
        least = eigh(own[np.ix_(at, at)], flat, eigvals_only=True)[0]
        if least >= RESOLVED:
            return kept
    raise RuntimeError(
        f"z = {gear.z}, b = {gear.b:g} mm, refine = {whole.refine:g}: the mesh is too coarse for patches of degree {kept} along "
        f"the width, one of which has only {100 * least:.2g} % of the deflection of a half-space: raise refine, or lower "
        "the degree"
    )

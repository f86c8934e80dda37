"""`Flexibility3D` of a whole gear by brute force: hexahedra (`fe3d`) under the patches of `gearfe.flexibility.solid`."""

import math
from dataclasses import replace
from functools import partial

import numpy as np
from scipy.linalg import eigh

from ..flexibility.halfspace import half_space
from ..flexibility.solid import Faces, hats, own_distance, parted, solved_teeth
from .crack_zones import zone_forces
from .fe3d import Patches, influence, mesh_patches, planned
from .integral import integral_influence, on_stubs

LOST = 2  # of the highest axial degrees may be dropped if the layers do not carry them
RESOLVED = 0.05  # of the half-space's displacement: below, the mesh is stiffer than the contact's own part by so much
PER_HAT = 4  # edges across a hat
LAYER = 2.0  # height of the element layers [m_n], at most a sixth of the width
END = 0.25  # height of the layers at the end faces, where loads and modes change most, against that
# edge lengths in modules, see `geometry.mesh.quads.SIZES`; the section costs little: layers times teeth fill the memory
SIZES = {"flank": 0.13, "corner": 0.07, "fillet": 0.17, "root": 0.27, "near": 0.33, "far": 0.8, "crack": 0.2, "crack tip": 0.04}


def axial_modes(width, m_n):
    """Highest degree of the patches along a `width` [mm]: 0.8 per normal module and 2, at least 8: 2 more than `ritz3d` keeps."""
    return max(8, math.ceil(0.8 * width / m_n) + 2)


def solid_flexibility(
    gear,
    material,
    cracks=(),
    *,
    neighbours=1,
    degree=None,
    less=0,
    refine=1.0,
    section=None,
    tell=None,
    healthy=None,
    cache=True,
    shaft=None,
):
    """Flexibility of a gear of finite width by finite elements of all of it.

    Parameters
    ----------
    gear : Gear
        Bore or rim are held over the whole width, the end faces free.
    material : Material
    cracks : tuple of Crack
        Their faces are kept from passing through each other, zone by zone (`gearfe.elements.crack_zones`).
    neighbours : int
        How many following teeth may carry load at the same time.
    degree : int, optional
        Of the patches along the width; default `axial_modes`, `less` so many. The highest that the layers cannot carry, at most
        two, are dropped (seen on the gear without cracks).
    refine : float
        Divides all edge lengths and the layers.
    section : float, optional
        Divides the edges of the section instead.
    tell
        As in `gearfe.elements.fe3d.influence`.
    healthy : Flexibility3D, optional
        Of the gear without cracks; needed if there are `cracks`.
    cache : bool or SolvedGears
        Where to look for the half-space's part, see `gearfe.flexibility.solved.solved_gears`.
    shaft : Shaft, optional
        Of a gear that is one piece with it: held by it at its end faces, the bore free.

    Returns
    -------
    Flexibility3D

    Raises
    ------
    ValueError
        If an input is impossible.
    RuntimeError
        If the system does not fit into memory, with the numbers, or if the mesh cannot carry the patches.
    """
    if not (math.isfinite(refine) and refine > 0):
        raise ValueError(f"refine = {refine}, but it divides the edge lengths: give a positive number")
    mesh, patches = _meshed(gear, cracks, neighbours, degree, less, refine, section)
    teeth, degree = patches.teeth, patches.modes - 1
    options = {"tell": tell, "zones": zone_forces(mesh)}
    whole_gear = influence if shaft is None else partial(integral_influence, shaft=shaft)
    found = whole_gear(mesh, material, patches, **options)
    unit = np.tile(np.sqrt((2 * np.arange(degree + 1) + 1) * gear.b), patches.knots.shape[1])  # from P_a / b to orthonormal
    size = unit.size
    whole = found.matrix.reshape(len(teeth), size, len(teeth), size) * unit[:, None, None] * unit
    kept = _resolved(gear, material, whole[0, :, 0], degree, refine, cache) if healthy is None else healthy.degree
    own = np.flatnonzero(np.arange(size) % (degree + 1) <= kept)
    between = {(i, j): whole[a][np.ix_(own, [b], own)][:, 0] for a, i in enumerate(teeth) for b, j in enumerate(teeth)}
    made = parted(gear, material, kept, between, found.dofs, healthy, cache=cache)
    if not found.mutual.size:
        return made
    opening = {tooth: (found.opening[:, k].reshape(-1, size) * unit)[:, own] for k, tooth in enumerate(teeth)}
    return replace(made, seam=Faces(opening, found.mutual))


def solid_plan(gear, cracks=(), *, neighbours=1, degree=None, less=0, refine=1.0, section=None, shaft=None):
    """`gearfe.elements.solver.Plan` of `solid_flexibility` of the same, refused if it does not fit; costs its mesh alone."""
    mesh, patches = _meshed(gear, cracks, neighbours, degree, less, refine, section)
    more = zone_forces(mesh).shape[1]
    if shaft is not None:
        mesh, discs = on_stubs(mesh, shaft)
        more += discs.shape[1]
    return planned(mesh, patches, more)


def _meshed(gear, cracks, neighbours, degree, less, refine, section):
    """Mesh and patches of `solid_flexibility`."""
    degree = (axial_modes(gear.b, gear.m_n) if degree is None else degree) - less
    patches = Patches(tuple(solved_teeth(gear, cracks, neighbours)), hats(gear), degree + 1)
    section = refine if section is None else section
    layer = min(LAYER * gear.m_n, gear.b / 6) * section / refine
    fine = [(z, z, END * layer) for z in (0.0, gear.b)]
    options = {"refine": section, "per_hat": PER_HAT, "layer": layer, "sizes": SIZES, "fine": fine}
    return mesh_patches(gear, patches, cracks=cracks, **options), patches


def _resolved(gear, material, own, degree, refine, cache):
    """Highest degree that the layers carry: `degree`, or up to `LOST` less; `own` is the influence on one flank."""
    for kept in range(degree, degree - LOST - 1, -1):
        at = np.flatnonzero(np.arange(len(own)) % (degree + 1) <= kept)
        flat = half_space(material) * own_distance(gear, kept, cache=cache)
        least = eigh(own[np.ix_(at, at)], flat, eigvals_only=True)[0]
        if least >= RESOLVED:
            return kept
    raise RuntimeError(
        f"z = {gear.z}, b = {gear.b:g} mm, refine = {refine:g}: the mesh is too coarse for patches of degree {kept} along the "
        f"width, one of them moves only {100 * least:.2g} % of what a half-space does: raise refine, or lower the degree"
    )

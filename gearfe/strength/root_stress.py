"""Root stress along the width of a spur or helical tooth under a contact line, from hexahedra of the whole gear."""

import math
from dataclasses import dataclass

import numpy as np

from ..core.material import Material
from ..core.threads import single
from ..flexibility.finite_elements.hexahedron import face_shapes
from ..flexibility.finite_elements.line_load import check_spread, contact_line, strip, under_line
from ..flexibility.finite_elements.mesh_cost import check_hexahedra
from ..flexibility.finite_elements.one_tooth import check_line_load
from ..geometry.aliases import Floats
from ..geometry.mesh.solid import Solid, solid
from ..geometry.tooth.gear import Gear
from .loaded_tooth import _peak

# edge lengths in modules, see `gearfe.geometry.mesh.quads.SIZES`; the fillet decides
SIZES = {"flank": 0.3, "corner": 0.2, "fillet": 0.06, "root": 0.4, "near": 0.7, "far": 2.0}
# layers of elements: height [m_n], least number, height at the end faces relative to the others
LAYER, LAYERS, END = 0.8, 8, 0.25
DENSITY = 830.0  # number of nodes for each tooth and module of width at refine 1
GAUSS = np.array([-1.0, 1.0]) / math.sqrt(3)  # points of a face at which derivatives are most accurate


@dataclass(frozen=True, slots=True)
class RootStress:
    """Root stress along the width.

    Attributes
    ----------
    z : ndarray, shape (n,)
        Heights [mm].
    stress : ndarray, shape (n,)
        Largest principal stress on the loaded side's fillet at each height [MPa].
    radius : ndarray, shape (n,)
        Where on the fillet it is [mm].
    unknowns : int
    """

    z: Floats
    stress: Floats
    radius: Floats
    unknowns: int

    @property
    def largest(self) -> float:
        """Largest stress [MPa]."""
        return float(self.stress.max())

    @property
    def height(self) -> float:
        """Height of the largest stress [mm]."""
        return float(self.z[self.stress.argmax()])


@single
def root_stress_along_width(
    gear: Gear,
    radius: float,
    line_load: float,
    material: Material,
    *,
    half_width: float | None = None,
    refine: float = 1.0,
) -> RootStress:
    """Compute the largest principal stress on the loaded side's fillet of tooth 0 at every height of a gear.

    The load lies on the contact line through `radius` at half the width; on a helical tooth it runs across the flank,
    ``roll(z) = roll(b / 2) + tan(beta_b) (z - b / 2)``, as far as the involute reaches. On the free surface stress is plane: it
    is computed from the displacements of the surface alone, at the points of each face where their derivatives are most
    accurate, and its peak along the profile by a polynomial over its neighbourhood (as in `gearfe.root_stress`).

    Parameters
    ----------
    gear : Gear
        Its bore (of a ring the outside) is held over the whole width.
    radius : float
        Radius of the loaded flank point at half the width [mm].
    line_load : float
        Load normal to the flank per width where the line runs [N/mm].
    material : Material
    half_width : float, optional
        The load is spread as a hat function over this arc to either side [mm]; default 0.15 m_n.
    refine : float
        Divides all edge lengths, along the width too.

    Returns
    -------
    RootStress

    Raises
    ------
    ValueError
        If the load is not positive, or the point is off the flank.
    RuntimeError
        If the system does not fit into memory.
    """
    check_line_load(line_load, gear, material)
    spread = check_spread(gear, half_width)
    return stress_under_line(gear, contact_line(gear, radius), line_load, material, spread=spread, refine=refine)


def stress_under_line(gear, roll, line_load, material, *, spread, refine=1.0) -> RootStress:
    """Return the `RootStress` for a load on a line of tooth 0 at roll lengths ``roll(z)`` [mm] at heights z [mm].

    `line_load` is the normal load per width [N/mm], a number or a function of z. `spread` is the half width [mm] of the hat
    function over which it is distributed.
    """
    check_hexahedra(gear, refine, DENSITY)
    layer = min(LAYER * gear.m_n, gear.b / LAYERS)
    mesh = solid(
        gear, layer=layer, patches=[strip(gear, roll, spread, refine)], refine=refine, sizes=SIZES,
        fine=[(0.0, 0.0, END * layer), (gear.b, gear.b, END * layer)],
    )  # fmt: skip
    moved, unknowns = under_line(mesh, roll, line_load, material, spread)
    return _along(mesh, moved, material, unknowns)


def _fillet(mesh: Solid):
    """Return edges ``(3, n)`` of the section along the loaded side's fillet of tooth 0, from the flank to the root."""
    gear, section = mesh.gear, mesh.section
    corners = section.quads[:4]
    ends = np.array([corners, np.roll(corners, -1, axis=0)]).reshape(2, -1)
    middles = section.quads[4:].ravel()
    count = np.bincount(middles, minlength=section.points.shape[1])
    outer = count[middles] == 1
    x, y = section.points[:, middles[outer]]
    radius, angle = np.hypot(x, y), np.arctan2(x, y)
    low, high = sorted((gear.r_f, gear.r_form))
    slack = 1e-6 * gear.m_n
    on_fillet = (radius > low - slack) & (radius < high + slack) & (angle > 0) & (angle < math.pi / gear.z)
    a, b = ends[:, outer][:, on_fillet]
    first = np.hypot(*section.points[:, a]) * gear.outward
    last = np.hypot(*section.points[:, b]) * gear.outward
    same, turned = np.isclose(first, last, atol=0), np.arctan2(*section.points[:, a]) > np.arctan2(*section.points[:, b])
    flip = np.where(same, turned, first < last)
    edges = np.array([np.where(flip, b, a), middles[outer][on_fillet], np.where(flip, a, b)])
    return edges[:, np.argsort(np.arctan2(*section.points[:, edges[1]]))]


def _along(mesh: Solid, moved, material, unknowns):
    """Return the `RootStress` from displacements ``(n, 3)``."""
    edges, levels = _fillet(mesh), mesh.levels
    count, corners = mesh.section.points.shape[1], mesh.section.corners
    a, m, b = edges
    peaks, heights, places = [], [], []
    for k in range(levels.size - 1):
        low, high, half = k * count, (k + 1) * count, levels.size * count + k * corners
        nodes = np.array([a + low, b + low, b + high, a + high, m + low, b + half, m + high, a + half])
        for y in GAUSS:
            stress, place = _surface_stress(mesh.points[:, nodes], moved[nodes], y, material)
            heights.append(levels[k] + (1 + y) / 2 * (levels[k + 1] - levels[k]))
            along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(place, axis=1), axis=0))])
            top = int(stress.argmax())
            peaks.append(_peak(along, stress) if 0 < top < stress.size - 1 else stress[top])
            places.append(float(np.hypot(*place[:2, top])))
    return RootStress(np.array(heights), np.array(peaks), np.array(places), unknowns)


def _surface_stress(points, moved, y, material):
    """Largest principal stress [MPa] and places (3, p) at the Gauss points of faces in a row, at local height `y`."""
    step = 1e-5
    x, shape = GAUSS, face_shapes(GAUSS, np.full(2, y))
    slopes = [
        (face_shapes(x + step, np.full(2, y)) - face_shapes(x - step, np.full(2, y))) / (2 * step),
        (face_shapes(x, np.full(2, y + step)) - face_shapes(x, np.full(2, y - step))) / (2 * step),
    ]
    tangent = [np.einsum("dne,np->dep", points, slope).reshape(3, -1) for slope in slopes]
    change = [np.einsum("ned,np->dep", moved, slope).reshape(3, -1) for slope in slopes]
    first = tangent[0] / np.linalg.norm(tangent[0], axis=0)
    second = tangent[1] - (first * tangent[1]).sum(axis=0) * first
    second /= np.linalg.norm(second, axis=0)
    frame = np.array([[(axis * vector).sum(axis=0) for vector in tangent] for axis in (first, second)]).transpose(2, 0, 1)
    strain = np.array([[(t * u).sum(axis=0) for u in change] for t in tangent]).transpose(2, 0, 1)
    inverse = np.linalg.inv(frame)
    strain = inverse.mT @ ((strain + strain.mT) / 2) @ inverse
    trace = np.trace(strain, axis1=1, axis2=2)[:, None, None] * np.eye(2)
    nu = material.nu
    stress = material.E / (1 - nu**2) * ((1 - nu) * strain + nu * trace)
    return np.linalg.eigvalsh(stress)[:, -1], np.einsum("dne,np->dep", points, shape).reshape(3, -1)

"""One loaded tooth: deflection and root stress, as in rating and in strain gauge measurements."""

import math

import numpy as np
from numpy.polynomial import Polynomial
from skfem import MeshTri

from ..core.checks import check_length
from ..core.material import Material
from ..core.threads import single
from ..flexibility.finite_elements.elasticity import edge_nodes, edge_shapes
from ..flexibility.finite_elements.fe import EDGES
from ..flexibility.finite_elements.one_tooth import NARROW, check_line_load, edge_lengths, load_at, narrow_section
from ..geometry.tooth.gear import Gear
from ..geometry.tooth.profile import flank, lengths, roll_at_arc

# edge lengths in modules; the fillet determines the accuracy
STRESS_EDGES = {"flank": 0.1, "fillet": 0.01, "near": 0.4, "far": 0.9}
COARSER = (0.5, 0.7)  # coarser resolutions for the error estimate
HIGH, NEIGHBOURS = 0.9, 3  # limits that select the fillet points near the peak, see `_peak`


def _solve(gear, material, state, arc, half_width, edges, refine):
    """Return the displacement under a unit load [N/mm] with ``cos**2`` pressure over `half_width` [mm] around `arc`."""
    at = arc, half_width, half_width / (4 * refine)
    mesh, body, load = narrow_section(gear, material, state, edge_lengths(gear, edges, refine), at)
    return mesh, body, body.solve(load)[:, 0]


@single
def tooth_flexibility(
    gear: Gear, radius: float, material: Material, *, at: str = "centreline", state: str = "plane strain", refine: float = 1.0
) -> float:
    """Deflection of a tooth per unit line load, along the load line [mm per N/mm].

    Parameters
    ----------
    gear : Gear
        Its bore is held.
    radius : float
        Radius of the loaded flank point [mm].
    material : Material
    at : {"centreline", "surface"}
        Where the displacement is taken: where the load line crosses the tooth centre-line (the local contact
        deformation is left out, as in Weber's analysis), or the smooth part S(s, s) at the surface, which has the
        half-plane logarithm removed (see `gearfe.flexibility.finite_elements.fe`).
    state : {"plane strain", "plane stress"}
    refine : float
        Divides the edge lengths.

    Raises
    ------
    ValueError
        If `radius` is off the flank or `at` is unknown.

    References
    ----------
    C. Weber, K. Banaschek, Formaenderung und Profilruecknahme bei gerad- und schraegverzahnten Raedern (1953).
    """
    arc = load_at(gear, radius)
    roll = float(roll_at_arc(gear, arc))
    if at == "surface":
        from ..flexibility.finite_elements.fe import flexibility

        return float(flexibility(gear, material, neighbours=0, state=state, refine=refine).matrix(np.array([roll]), [0])[0, 0])
    if at != "centreline":
        raise ValueError(f"at = {at!r}, but it must be 'centreline' or 'surface'")
    edges = EDGES | {"flank": 0.1}
    _, body, moved = _solve(gear, material, state, arc, 0.02 * gear.m_n, edges, refine)
    angle = gear.outward * roll / gear.r_b - gear.base_half_angle
    far, turn = flank(gear, roll)
    crossing = far * math.cos(turn) - far * math.sin(turn) * math.tan(angle)
    return float(_displacement(body, moved, 0.0, crossing) @ [-math.cos(angle), -math.sin(angle)])


def _displacement(body, moved, x, y):
    """Return the displacement (2,) at an inner point. Triangles at this point have straight edges."""
    mesh = body.mesh
    linear = MeshTri(mesh.doflocs[:, : mesh.nvertices].copy(), mesh.t)
    point = np.array([[x], [y]])
    triangle = linear.element_finder()(*point)
    local = linear.mapping().invF(point[:, :, None], tind=triangle)[:, 0, 0]
    shapes = [float(body.basis.elem.lbasis(local[:, None], i)[0][0]) for i in range(6)]
    return np.array(shapes) @ moved.reshape(-1, 2)[body.nodes[:, triangle[0]]]


@single
def root_stress(
    gear: Gear,
    radius: float,
    line_load: float,
    material: Material,
    *,
    half_width: float | None = None,
    state: str = "plane strain",
    refine: float = 1.0,
    error: bool = False,
) -> float | tuple[float, float]:
    """Largest principal stress on the loaded side's fillet [MPa].

    On the free fillet the stress is one tension along the profile, ``E' du_t/ds``; it is taken at the Gauss points of the
    fillet's edges, where the derivative of second-order displacements is most accurate, and its peak by a polynomial over its
    neighbourhood.

    Parameters
    ----------
    gear : Gear
        Its bore is held.
    radius : float
        Radius of the loaded flank point [mm].
    line_load : float
        Load normal to the flank per face width [N/mm].
    half_width : float, optional
        The load is spread as ``cos**2`` over twice this arc [mm]; default 0.05 m_n.
    state : {"plane strain", "plane stress"}
    refine : float
        Divides the edge lengths.
    error : bool
        Also estimate the discretisation error: the sum of the differences from solves with edges 2 and 1 / 0.7 times as long,
        as for a stiffness (`gearfe.stiffness.estimate.estimate`). Costs two coarser solves.

    Returns
    -------
    float, or (float, float) with ``error=True``
        The stress, and its estimated error [MPa].

    Raises
    ------
    ValueError
        If the load is not positive, or the point is off the flank.
    """
    check_line_load(line_load, gear, material)
    check_length("half_width", half_width)
    half_width = NARROW * gear.m_n if half_width is None else half_width
    if not 0 < half_width <= gear.m_n:
        raise ValueError(f"half_width = {half_width} mm, but the loaded strip is narrow: give 0 < half_width <= {gear.m_n} mm")
    case = gear, material, state, load_at(gear, radius), half_width, STRESS_EDGES
    stress, *coarse = (line_load * _unit_stress(*case, ratio * refine) for ratio in (1.0, *(COARSER if error else ())))
    return (stress, sum(abs(stress - other) for other in coarse)) if error else stress


def _unit_stress(gear, material, state, arc, half_width, edges, refine):
    """Largest principal stress on the fillet [MPa] under a unit load [N/mm]."""
    mesh, _, moved = _solve(gear, material, state, arc, half_width, edges, refine)
    nodes = edge_nodes(mesh.mesh, mesh.fillet[0])
    shapes, slopes = edge_shapes(np.array([-1, 1]) / math.sqrt(3))
    along = np.einsum("dne,np->dep", mesh.mesh.doflocs[:, nodes], slopes)
    stretch = np.einsum("ned,np->dep", moved.reshape(-1, 2)[nodes], slopes)
    length = np.hypot(*along)
    stress = material.plane_modulus(state) * ((along * stretch).sum(axis=0) / length**2).ravel()
    points = np.einsum("dne,np->dep", mesh.mesh.doflocs[:, nodes], shapes).reshape(2, -1)
    return _peak(lengths(points), stress)


def _peak(place, stress):
    """Return the largest value of a polynomial of degree 4 fitted to at least `NEIGHBOURS` points on each side of the peak.

    The stress scatters by 0.2 % from point to point of a mesh. The fit over the points above `HIGH` of the largest averages this.
    """
    top = int(np.argmax(stress))
    if not 0 < top < stress.size - 1:
        raise RuntimeError("the largest root stress is at the end of the fillet, not on it")
    low = stress < HIGH * stress[top]
    first = min(np.flatnonzero(low[:top]).max(initial=-1) + 1, top - NEIGHBOURS)
    last = max(top + np.flatnonzero(low[top:]).min(initial=stress.size), top + NEIGHBOURS + 1)
    first, last = max(first, 0), min(last, stress.size)
    scale = place[last - 1] - place[first]
    curve = Polynomial.fit(place[first:last] / scale, stress[first:last] / stress[top], 4)
    around = np.linspace(place[max(top - 2, first)], place[min(top + 2, last - 1)], 401) / scale
    return float(stress[top] * curve(around).max())

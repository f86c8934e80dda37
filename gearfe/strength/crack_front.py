"""Stress intensities along the front of a root crack in a gear of finite width, from hexahedra of the whole gear."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..core.material import Material
from ..core.threads import single
from ..flexibility.finite_elements.line_load import check_spread, contact_line, strip, under_line
from ..flexibility.finite_elements.mesh_cost import check_hexahedra
from ..flexibility.finite_elements.one_tooth import check_load_along
from ..geometry.aliases import Floats
from ..geometry.damage.crack import Crack, check_apart, meshed_path
from ..geometry.damage.crack_form import deepest
from ..geometry.damage.front import open_part, shallowest, whole
from ..geometry.damage.kinds import check_crack
from ..geometry.mesh.solid import solid
from ..geometry.tooth.gear import Gear
from ..geometry.tooth.profile import turned
from .front_integral import front_intensity

# edge lengths in modules, see `gearfe.geometry.mesh.quads.SIZES`
SIZES = {"flank": 0.3, "corner": 0.2, "fillet": 0.2, "root": 0.4, "near": 0.7, "far": 2.0, "crack": 0.25}
# layers of elements: height [m_n], least number, height at the end faces relative to the others
LAYER, LAYERS, END_LAYER = 0.5, 12, 0.25
DENSITY = 1150.0  # number of nodes for each tooth and module of width at refine 1
SHALLOW = 0.25  # smallest depth relative to the largest at which the integration tubes fit around a front that runs out
LEAST = 0.15, 0.8  # least depth and width of a crack [m_n], which the element edges and the tubes require
TUBE = 0.4, 0.5  # radius of the wider integration tube [m_n], and its largest value relative to the least depth
# edge lengths at the front relative to that radius, tried until no quad folds; reduced if `refine` > 1
TIPS = 1 / 13, 1 / 15, 1 / 11


@dataclass(frozen=True, slots=True)
class FrontIntensity:
    """Stress intensities along a crack front.

    Attributes
    ----------
    z : ndarray, shape (n,)
        Heights [mm].
    depth : ndarray, shape (n,)
        Depth of the crack at these heights, along the crack in the transverse section [mm].
    K_I, K_II, K_III : ndarray, shape (n,)
        Stress intensity factors [MPa sqrt(mm)]. K_I < 0 means that the faces overlap. Real faces touch, without mode I.
    unknowns : int
    """

    z: Floats
    depth: Floats
    K_I: Floats
    K_II: Floats
    K_III: Floats
    unknowns: int


@single
def stress_intensity_along_front(
    gear: Gear,
    crack: Crack,
    radius: float,
    line_load: float | Callable[[Floats], Floats],
    material: Material,
    *,
    refine: float = 1.0,
) -> FrontIntensity:
    """Compute K_I, K_II, K_III along the front of a crack of tooth 0, whose depth may change along the width.

    The load is on the contact line through `radius` at half the width, see `gearfe.root_stress_along_width`. The elements follow
    the front. The interaction integral is evaluated on two tubes around it and extrapolated to radius zero
    (`gearfe.strength.front_integral`). Crack faces may pass through each other: where K_I < 0 they would touch.

    Parameters
    ----------
    gear : Gear
        Its bore (of a ring the outside) is held over the whole width.
    crack : Crack
        Straight crack of tooth 0.
    radius : float
        Radius of the loaded flank point at half the width [mm].
    line_load : float or callable
        Load normal to the flank per width [N/mm], or as a function of the height z [mm].
    material : Material
    refine : float
        Divides all edge lengths; those at the front only if it is above 1.

    Returns
    -------
    FrontIntensity
        Values at the layers of elements. Where the crack front runs out, values at less than a quarter of the maximum depth are
        omitted. The values at the first and the last place are means with a one-sided weight. Do not use K_III at the end faces:
        the auxiliary mode III field violates the traction-free condition there (error: a few per cent of K_I).

    Raises
    ------
    ValueError
        If the load is not positive, the point is off the flank, or the crack is not a straight one of tooth 0.
    RuntimeError
        If the mesh cannot follow the front, or the system does not fit into memory.
    """
    check_load_along(line_load, gear, material)
    check_crack(crack)
    if crack.tooth % gear.z or crack.bends:
        raise ValueError(f"crack of tooth {crack.tooth}, turning = {crack.turning}: give a straight crack of tooth 0")
    check_apart(gear, [crack])
    _check_room(gear, crack)
    spread, roll = check_spread(gear), contact_line(gear, radius)
    check_hexahedra(gear, refine, DENSITY)
    layer = min(LAYER * gear.m_n, gear.b / LAYERS)
    fine = [(z, z, END_LAYER * layer) for z in (0.0, gear.b, *(crack.width or ()))]
    patches = [strip(gear, roll, spread, refine)]
    mesh = _mesh(gear, crack, refine, layer=layer, patches=patches, fine=fine)
    moved, unknowns = under_line(mesh, roll, line_load, material, spread)
    z, part, least = _followed(mesh, crack)
    mouth, tip = meshed_path(gear, whole(crack)).T
    length = math.dist(mouth, tip)
    front, ahead, normal = _axes(gear, mouth, tip, z, part)
    tube = _tube(gear, crack, least)
    k_1, k_2, k_3 = front_intensity(mesh.points, mesh.cells, moved.T, material, front, ahead, normal, tube)
    return FrontIntensity(z, part[0] * length, k_1, k_2, k_3, unknowns)


def _mesh(gear, crack, refine, **options):
    """Mesh the gear in hexahedra. The edge length at the front suits the integration tubes for any `refine`."""
    edge = _tube(gear, crack, shallowest(crack) or SHALLOW) / gear.m_n * min(refine, 1.0)
    for tip in TIPS:
        try:
            return solid(gear, cracks=[crack], refine=refine, sizes=SIZES | {"crack tip": tip * edge}, **options)
        except RuntimeError as error:
            failed = error
    raise failed


def _check_room(gear, crack):
    """Raise ValueError if the crack is too shallow or too narrow for the integration tubes around its front."""
    depth = deepest(crack) * math.dist(*meshed_path(gear, whole(crack)).T)
    low, high = crack.width or (0.0, gear.b)
    if depth < LEAST[0] * gear.m_n or high - low < LEAST[1] * gear.m_n * (1 - 1e-9):
        raise ValueError(
            f"crack {depth:.3g} mm deep and open over {high - low:.3g} mm: the integral around its front needs a depth of "
            f"{LEAST[0]:g} and a width of {LEAST[1]:g} m_n or more ({LEAST[0] * gear.m_n:.3g} and {LEAST[1] * gear.m_n:.3g} mm)"
        )


def _tube(gear, crack, least):
    """Return the radius [mm] of the wider integration tube around a crack front with relative depths of at least `least`."""
    return min(TUBE[0] * gear.m_n, TUBE[1] * least * math.dist(*meshed_path(gear, whole(crack)).T))


def _followed(mesh, crack):
    """Return the layers at which the mesh follows the front: heights ``(n,)`` [mm], depth and slope ``(2, n)``, least depth.

    Depths are parts of the largest depth, slopes per mm.
    """
    low, high = crack.width or (0.0, mesh.gear.b)
    slack = 1e-9 * mesh.gear.b
    z = mesh.levels[(mesh.levels >= low - slack) & (mesh.levels <= high + slack)]
    if 0 not in mesh.fronts:
        return z, np.array([np.ones(z.size), np.zeros(z.size)]), 1.0
    front = mesh.fronts[0]
    least = front.least if shallowest(crack) else SHALLOW
    z = z[open_part(crack, mesh.gear.b, z) >= (1 - 1e-9) * least * deepest(crack)]
    part = np.array(front.depth(z))
    return z, part, float(part[0].min())


def _axes(gear, mouth, tip, z, part):
    """Return points of the front ``(n, 3)``, unit vectors ahead of it in the crack surface, and normals of this surface."""
    turn, rate = gear.twist_rate * z, gear.twist_rate
    place = mouth[:, None] + (tip - mouth)[:, None] * part[0]
    flat, heading = turned(place, turn), turned((tip - mouth)[:, None], turn)
    rise = heading * part[1] + rate * np.array([flat[1], -flat[0]])
    along = np.vstack([rise, np.ones(z.size)]).T
    along /= np.linalg.norm(along, axis=1)[:, None]
    heading = np.vstack([heading, np.zeros(z.size)]).T
    ahead = heading - (heading * along).sum(axis=1)[:, None] * along
    ahead /= np.linalg.norm(ahead, axis=1)[:, None]
    return np.vstack([flat, z]).T, ahead, np.cross(along, ahead)

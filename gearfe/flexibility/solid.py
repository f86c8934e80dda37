"""`Flexibility3D`: elastic flexibility of a gear of finite width between its contact lines, for all solvers.

Loads are patches: hat functions of unit area across the flank times orthonormal polynomials along the width. The half-space's
part of a patch's effect on itself is removed (`halfspace`). The rest is smooth and interpolated by polynomials.
"""

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev

from ..geometry.damage.chip import loaded_side
from ..geometry.damage.missing import missing_teeth
from ..geometry.kept import keeping
from ..geometry.tooth.gear import Gear, shortened
from ..geometry.tooth.profile import arc_at, flank_arcs, roll_at_arc
from .end_faces import edge_factor, mirrored_patches
from .halfspace import half_space, hat_points, modes, patch_kernel
from .plane import outermost, reached_teeth
from .solved import solved_gears

PLACES = 8  # number of hat functions on each flank
HAT = 0.4  # half-width of the hat functions [m_n]
# Least distance from the tip corner at which values are read [m_n]. It was chosen from the limit of plane strain and checked
# with hexahedra of a spur pair.
NEAREST = 0.01
OFFSET = 0.2  # offset of the distance from the tip corner before taking the logarithm [m_n]


@dataclass(frozen=True, slots=True, eq=False)
class Flexibility3D:
    """Flexibility of one gear between any loads on its loaded flanks, without the half-space part on the same flank.

    A load is a force per width P(z) [N/mm], at right angles to the flank, on a line s(z) of it. The displacement against it is

        u(z) = int P(z)' [bulk(s, z, s', z') + k / R + edge (1 / R_0 + 1 / R_b)] dz',
        bulk = sum of p_a(z) c_i(s) B_ia,jb c_j(s') p_b(z')

    with orthonormal Legendre polynomials p over the width, polynomials c through the hat functions, R the flat distance, and
    R_0, R_b those to the mirror images of the load in the end faces.

    Attributes
    ----------
    gear : Gear
        The gear; its `beta` is the helix angle of the sections.
    degree : int
        Highest axial mode kept.
    kernel : float
        k of the half-space [mm**2/N].
    near : dict of int to ndarray, shape (n, n)
        B of each solved tooth, ``n = PLACES * (degree + 1)``, modes innermost [mm/N mm].
    far : dict of (int, int) to ndarray, shape (n, n)
        B between two teeth, nothing taken out; the second is further to the loaded side.
    unknowns : int
    healthy : Flexibility3D or None
        Of the gear without damage, for teeth that were not solved; a healthy gear has only tooth 0 solved.
    seam : Faces or None
        The faces of its cracks, if they are to be kept from passing through each other; B is that of faces that may.
    edge : float
        Coefficient of loads mirrored in the end faces [mm**2/N], taken out of B like the half-space, see
        `gearfe.flexibility.end_faces`.
    tips : dict of int to float
        Of teeth whose loaded flank ends below the tip circle: roll length of the corner [mm].
    seconds : float
        Time of the solve, that of `healthy` included (`gearfe.flexibility.solved.timed`) [s].
    """

    gear: Gear
    degree: int
    kernel: float
    near: dict
    far: dict
    unknowns: int
    healthy: "Flexibility3D | None" = None
    seam: Any = None
    edge: float = 0.0
    tips: dict = field(default_factory=dict)
    seconds: float = 0.0

    def basis(self, roll, z, tooth=0):
        """Return rows ``(n, PLACES * (degree + 1))`` that evaluate B at roll lengths `roll` and heights `z` [mm] of `tooth`."""
        across, along = carry(self.gear, roll), modes(z, self.gear.b, self.degree)
        for number, corner in self.tips.items():
            on = np.broadcast_to(np.asarray(tooth) % self.gear.z == number, roll.shape)
            across[on] = carry(shortened(self.gear, corner), roll[on])
        return (across[:, :, None] * along[:, None, :]).reshape(across.shape[0], -1)

    def between(self, first, second):
        """Return the matrix B of a tooth or between two teeth. It is None if these are too far apart to interact."""
        z = self.gear.z
        whole = self if self.healthy is None else self.healthy
        if (second - first) % z == 0:
            return self.near.get(first % z, whole.near[0])
        for behind, ahead, turned in ((first, second, False), (second, first, True)):
            block = self.far.get((behind % z, ahead % z), whole.far.get((0, (ahead - behind) % z)))
            if block is not None:
                return block.T if turned else block
        return None

    def opening(self, tooth, roll, z):
        """Return the opening ``(k, n)`` [mm/N] of the points of `seam` under loads at `roll`, `z` [mm] of teeth `tooth`."""
        tooth, rows = np.asarray(tooth) % self.gear.z, self.basis(roll, z, tooth)
        out = np.zeros((self.seam.influence.shape[0], tooth.size))
        for number in np.unique(tooth).tolist():
            if number in self.seam.opening:
                on_tooth = tooth == number
                out[:, on_tooth] = self.seam.opening[number] @ rows[on_tooth].T
        return out

    def cracks_beyond(self, tooth, roll, z, load):
        """Return the sum of load times deflection [N mm] that open cracks may add on teeth solved without them.

        It is zero if every loaded tooth was solved. The bound is that of the whole load on an outermost solved tooth.
        """
        if self.seam is None or not (load[~np.isin(tooth % self.gear.z, list(self.seam.opening))] > 0).any():
            return 0.0
        opens = [self.opening(np.full(load.size, end), roll, z) @ load for end in outermost(self.seam.opening, self.gear.z)]
        return max((float(one @ np.linalg.lstsq(self.seam.influence, one)[0]) for one in opens), default=0.0)


@dataclass(frozen=True, slots=True, eq=False)
class Faces:
    """Points at which crack faces may touch, k of them.

    Attributes
    ----------
    opening : dict of int to ndarray, shape (k, n)
        Under the patches of that tooth.
    influence : ndarray, shape (k, k)
        Of unit forces that push the faces apart at these points [mm/N].
    """

    opening: dict
    influence: np.ndarray


def solved_teeth(gear, damage, neighbours):
    """Return the teeth to load: tooth 0 and the next `neighbours`, or the `reached_teeth` of the damage except missing teeth."""
    if not damage:
        return list(range(min(neighbours, gear.z - 1) + 1))
    return sorted(set(reached_teeth(gear, damage, max(1, neighbours))) - set(missing_teeth(gear, damage)))


def parted(gear, material, degree, influence, unknowns, healthy=None, *, damage=(), cache=True):
    """Build the `Flexibility3D` from the influence between patches.

    `degree` is the highest axial mode. `influence` ``{(i, j): (n, n)}`` is that between the patches of `solved_teeth` [mm/N
    mm]. A patch is one of the `hats` of unit area times one of `halfspace.modes`, with the modes as the inner index. `healthy`
    is the `Flexibility3D` without `damage`, if there is any.
    """
    edge = edge_factor(material) * half_space(material)
    wanted = {(i, j): value for (i, j), value in influence.items() if i == 0 or healthy}  # Healthy teeth are equal.
    near, tips = {}, {}
    for tooth in {i for i, _ in wanted}:
        end = loaded_side(gear, damage, tooth)
        local = half_space(material) * own_distance(end, degree, cache=cache) + edge * own_mirrors(end, degree, cache=cache)
        near[tooth] = wanted[tooth, tooth] - local
        if end is not gear:
            tips[tooth] = end.roll_a
    far = {(i, j): value for (i, j), value in wanted.items() if i != j and (j - i) % gear.z <= gear.z // 2}
    return Flexibility3D(gear, degree, half_space(material), near, far, unknowns, healthy, edge=edge, tips=tips)


def own_distance(gear, degree, *, cache=True):
    """Mean of 1 / R between each patch and the other patches of its flank ``(n, n)``, see `patch_kernel`."""

    def solve():
        knots = hats(gear)
        roll = roll_at_arc(gear, knots.mean(axis=0))
        slope = gear.twist_rate * (roll[:, None] + roll) / 2
        n = PLACES * (degree + 1)
        return patch_kernel(knots, gear.b, degree, slope, 1 / math.cos(gear.beta_b)).reshape(n, n)

    return solved_gears(cache).get(("own distance", gear, degree), solve)


def own_mirrors(gear, degree, *, cache=True):
    """Mean of 1 / R between each patch and the images of the patches in the end faces ``(n, n)``, see `mirrored_patches`."""

    def solve():
        n = PLACES * (degree + 1)
        return mirrored_patches(hats(gear), gear.b, degree, 1 / math.cos(gear.beta_b)).reshape(n, n)

    return solved_gears(cache).get(("own mirrors", gear, degree), solve)


def _scale(gear):
    """Return the ends of the flank as arcs, and the offset in the logarithm of the distance to the tip corner [mm]."""
    return *flank_arcs(gear), OFFSET * gear.m_n


def variable(gear, arc):
    """Place on the flank in [-1, 1], by the logarithm of the distance to the tip corner."""
    low, high, offset = _scale(gear)
    away = high + offset - np.clip(arc, low, high)
    return 2 * np.log(away / (high - low + offset)) / math.log(offset / (high - low + offset)) - 1


@keeping(64)
def hats(gear):
    """Hat functions ``(3, PLACES)`` on the flank [mm] with tops at Chebyshev points of `variable`, cut at the ends."""
    low, high, offset = _scale(gear)
    part = (1 + chebyshev.chebpts1(PLACES)) / 2
    middle = high + offset - (high - low + offset) * (offset / (high - low + offset)) ** part
    reach = HAT * gear.m_n
    return np.array([np.maximum(middle - reach, low), middle, np.minimum(middle + reach, high)])


@keeping(64)
def _from_hats(gear):
    """Matrix ``(PLACES, PLACES)`` from means over the hat functions to coefficients of Chebyshev polynomials."""
    points, weight = hat_points(hats(gear), 12)
    return np.linalg.inv(np.einsum("hg,hgk->hk", weight, chebyshev.chebvander(variable(gear, points), PLACES - 1)))


def carry(gear, roll):
    """Matrix ``(n, PLACES)`` from means over the hat functions to values at roll lengths [mm].

    The values are taken at least `NEAREST` away from the tip corner, because the polynomials would amplify small errors of the
    hat functions at the corner.
    """
    arc = np.minimum(arc_at(gear, np.asarray(roll, dtype=float)), arc_at(gear, gear.roll_a) - NEAREST * gear.m_n)
    return chebyshev.chebvander(variable(gear, arc), PLACES - 1) @ _from_hats(gear)

"""Rows of springs and meshes from positions of bodies and contacts, and phases of meshes along a train of gears.

Axes: x and y in the plane of the gears, z along their axes; angles counter-clockwise about z. Planetary trains are described in
the frame of their carrier. A `Machine` with a `spin` contains the centripetal and gyroscopic terms of its rotation.
"""

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.record import check_named, ranged, settle_numbers
from ...geometry.aliases import Floats
from ...geometry.pair.gear_pair import GearPair
from .springs import Spring

PLANE = "x y theta"
SPACE = "x y z tilt_x tilt_y theta"
AXES = dict(zip("xyz", np.eye(3), strict=True))


@dataclass(frozen=True, slots=True)
class Body:
    """A rigid body: mass [kg], moments of inertia about and across its axis [kg m2], and the directions in which it can move.

    Parameters
    ----------
    name : str
    mass : float
        [kg]
    inertia : float
        Moment of inertia about its axis [kg m2], that of ``theta``.
    dofs : str
        Directions it can move in, of ``x y z tilt_x tilt_y theta``, with blanks between them.
    across : float
        Moment of inertia across its axis [kg m2], that of ``tilt_x`` and ``tilt_y``.
    """

    name: str
    mass: float
    inertia: float
    dofs: str = PLANE
    across: float = 0.0

    def __post_init__(self) -> None:
        """Raise ValueError for an impossible direction or mass, or for a name with signs other than letters, digits, _ and -."""
        if not isinstance(self.name, str) or not re.fullmatch(r"[\w-]+", self.name):
            raise ValueError(f"body: name = {self.name!r}, but give letters, digits, _ and - alone")
        known, given = SPACE.split(), str(self.dofs).split()
        if not given or set(given) - set(known) or len(set(given)) < len(given):
            raise ValueError(f"body {self.name}: dofs = {self.dofs!r}, but give some of {SPACE!r}, each once")
        sizes = {"mass": "x y z", "inertia": "theta", "across": "tilt_x tilt_y"}
        needed = {size for size, moved in sizes.items() if set(moved.split()) & set(given)}
        settle_numbers(self, f"body {self.name}", "mass inertia across", least=0.0)
        settle_numbers(self, f"body {self.name}", " ".join(needed), above=0.0)


class Layout:
    """Degrees of freedom of bodies, and rows over these, for a user-defined machine.

    Examples
    --------
    Two discs in mesh, 40 and 80 mm in base radius, the second held by a shaft: 10 N m press the mesh with 250 N.

    >>> import gearfe as gf
    >>> layout = gf.Layout([gf.Body("one", 1.0, 1e-3, "theta"), gf.Body("two", 2.0, 4e-3, "theta")])
    >>> row = layout.mesh("one", "two", angle=0.0, alpha=0.35, radii=(0.04, 0.08))
    >>> mesh = gf.GearMesh("mesh", row, stiffness=1e8, frequency=200.0)
    >>> shaft = layout.springs("two", None, {"theta": 1e4}, zeta=0.02)
    >>> drive = gf.Load("drive", layout.unit("one", "theta"), 10.0)
    >>> machine = gf.Machine(layout.dofs, layout.mass, tuple(shaft), (mesh,), (drive,))
    >>> print(f"{float(row @ machine.rest() * 1e8):.6g} N")
    250 N
    """

    def __init__(self, bodies: Sequence[Body]) -> None:
        self.bodies = {body.name: body for body in bodies}
        if len(self.bodies) < len(bodies):
            raise ValueError(f"bodies {', '.join(body.name for body in bodies)}, but give each body a different name")
        self.dofs = tuple(f"{body.name}.{dof}" for body in bodies for dof in body.dofs.split())
        self.place = {name: i for i, name in enumerate(self.dofs)}
        sizes = {"theta": "inertia", "tilt_x": "across", "tilt_y": "across"}
        self.mass = np.array([getattr(body, sizes.get(dof, "mass")) for body in bodies for dof in body.dofs.split()])

    def unit(self, name: str, dof: str) -> Floats:
        """Row of one degree of freedom."""
        check_named("degree of freedom", f"{name}.{dof}", self.place)
        row = np.zeros(len(self.dofs))
        row[self.place[f"{name}.{dof}"]] = 1.0
        return row

    def point(self, name: str, direction: ArrayLike, arm: ArrayLike = (0.0, 0.0, 0.0)) -> Floats:
        """Row of the displacement along `direction` of a point of a body, at `arm` [m] from its centre.

        Missing degrees of freedom are fixed.
        """
        check_named("body", name, self.bodies)
        direction, arm = np.append(direction, np.zeros(3))[:3], np.append(arm, np.zeros(3))[:3]
        parts = dict(zip(SPACE.split(), (*direction, *np.cross(arm, direction)), strict=True))
        row = np.zeros(len(self.dofs))
        for dof in self.bodies[name].dofs.split():
            row[self.place[f"{name}.{dof}"]] = parts[dof]
        return row

    def springs(
        self, one: str, two: str | None, stiffness: Mapping[str, float], zeta: float, arm: ArrayLike = (0.0, 0.0, 0.0)
    ) -> list[Spring]:
        """Springs between two bodies by direction ``{dof: k}``. `two` None is the ground.

        Translational springs act at the centre of body `one`, which is at `arm` [m] from the centre of body `two`. Dampers are
        ``2 zeta sqrt(k m)``, m the mass or inertia of body `one` (a reduced mass would depend on the direction of the axes).
        """
        out, zeta = [], ranged("zeta", zeta, least=0.0)
        for dof, k in stiffness.items():
            check_named("direction", dof, SPACE.split())
            k = ranged(f"stiffness of {one} {dof}", k, least=0.0)
            row = self.point(one, AXES[dof]) if dof in AXES else self.unit(one, dof)
            if two is not None and dof in AXES:
                row = row - self.point(two, AXES[dof], arm)
            elif two is not None and f"{two}.{dof}" in self.place:
                row = row - self.unit(two, dof)
            if k > 0 and row.any():
                name = f"{one}-{two or 'ground'} {dof}"
                out.append(Spring(name, row, k, 2 * zeta * math.sqrt(k * self.mass[self.place[f"{one}.{dof}"]])))
        return out

    def mesh(
        self,
        one: str,
        two: str | None,
        *,
        angle: float,
        alpha: float,
        radii: tuple[float, float],
        sense: int = 1,
        helix: float = 0.0,
        internal: bool = False,
        height: float = 0.0,
    ) -> Floats:
        """Row of the mesh in which body `one` pushes body `two`.

        The transverse line of action leaves the pitch point at ``sense t cos(alpha) + e sin(alpha)``: e points from the centre of
        `one` to the pitch point, at `angle`, and t is e turned by 90 degrees. Its components along the plane have length 1.

        Parameters
        ----------
        one : str
        two : str or None
            None: a gear at rest.
        angle : float
            [rad]
        alpha : float
            Working transverse pressure angle [rad].
        radii : (float, float)
            Base radii [m].
        sense : {1, -1}
            Sense in which body `one` would turn if it drove with the loaded flanks; 1: counter-clockwise.
        helix : float
            ``tan(beta_b)`` with the sign of the axial force on body `two`.
        internal : bool
            Body `two` is a ring.
        height : float
            Height of the mesh over the centre of body `two` [m].
        """
        if one == two:
            raise ValueError(f"mesh of {one!r} with itself: give two bodies")
        radii = tuple(ranged("radii", radius, " m", above=0.0) for radius in radii)  # type: ignore[assignment]
        e, along = _line_of_action(angle, alpha, sense)
        along[2] = ranged("helix", helix)
        first, second = (r / math.cos(alpha) for r in radii)
        arm = (second if internal else -second) * e + np.array([0.0, 0.0, height])
        row = self.point(one, along, first * e)
        return row if two is None else row - self.point(two, along, arm)

    def pair_mesh(self, one: str, two: str | None, pair: GearPair, angle: float = 0.0, **options: Any) -> NDArray:
        """Row of the mesh of a `GearPair` at `angle` [rad], with the `options` of `mesh`."""
        radii = 1e-3 * pair.gear_1.r_b, 1e-3 * pair.gear_2.r_b
        return self.mesh(one, two, angle=angle, alpha=pair.alpha_wt, radii=radii, internal=pair.gear_2.internal, **options)

    def rubbing(
        self, one: str, two: str, *, angle: float, alpha: float, sense: int = 1, internal: bool = False
    ) -> tuple[Floats, Floats, Floats]:
        """Friction rows of a mesh: motion across the line of action, and rotation of each body per lever arm [m].

        The first row opposes the motion of body `one` along the direction of the line of action rotated by +90 degrees.
        """
        _, along = _line_of_action(angle, alpha, sense)
        across = (-along[1], along[0])
        turns = self.unit(one, "theta"), (-1 if internal else 1) * self.unit(two, "theta")
        return self.point(one, across) - self.point(two, across), *turns


def outwards(angle: float) -> Floats:
    """Return the unit vector in the plane at an angle from the x axis [rad]."""
    return np.array([math.cos(angle), math.sin(angle), 0.0])


def _line_of_action(angle, alpha, sense):
    """Return unit vectors from the centre of the first body to the pitch point, and along the transverse line of action."""
    angle = ranged("angle", angle, " rad")
    if not 0 < ranged("alpha", alpha, " rad") < math.pi / 2:
        raise ValueError(f"alpha = {alpha:g} rad, but a pressure angle lies between 0 and pi / 2: give it in rad")
    if sense not in (1, -1):
        raise ValueError(f"sense = {sense!r}, but give 1 (counter-clockwise) or -1")
    e = outwards(angle)
    return e, sense * math.cos(alpha) * np.array([-e[1], e[0], 0.0]) + math.sin(alpha) * e


def around(phase, z, sense, angle):
    """Phase of a second mesh of a gear at `angle` [rad] from the mesh with `phase`. Tooth n forms pair n in both meshes.

    `sense` is that of `Layout.mesh` for the gear: its direction of rotation if contacts move forward.

    R. G. Parker, J. Lin, J. Mech. Des. 126 (2004) 525-534, eq. 6, without dropping whole cycles.
    """
    return phase - sense * z * angle / (2 * math.pi)


def through(phase, pair_1, pair_2, sense, turn):
    """Phase of the mesh that an idler drives, from the mesh that drives it. Tooth n of the idler forms pair n in both.

    The two meshes load opposite flanks of an idler tooth, so that its thicknesses on both working pitch circles have an effect
    (R. G. Parker, J. Lin, J. Mech. Des. 126 (2004) 525-534, eqs. 14-20, for a planet; here for any angle between the meshes).

    Parameters
    ----------
    phase : float
        Phase of the mesh `pair_1`.
    pair_1, pair_2 : GearPair
        The idler is gear 2 of the first and gear 1 of the second.
    sense : {1, -1}
        Sense in which the idler turns (if contacts run forward); 1: counter-clockwise.
    turn : float
        Angle from the first to the second pitch point about the idler's centre [rad].
    """
    idler = pair_2.gear_1
    thick = idler.half_thickness(pair_1.pitch_radius_2) + idler.half_thickness(pair_2.pitch_radius_1)
    ahead = idler.z / (2 * math.pi) * (thick - sense * turn)
    return phase - pair_1.pitch_phase + pair_2.pitch_phase + ahead

"""`Machine`: masses, linear springs, gear meshes and loads as tables, with matrices, modes and the state of rest."""

import math
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.checks import numbers
from ...core.record import settle, settle_numbers
from ...geometry.aliases import Floats
from .contact_law import depth, force, parameters, slopes
from .gear_mesh import GearMesh
from .loads import Load
from .speed import Speed
from .springs import Spring
from .stages import Fault, Stage
from .turning_frame import frame_terms

FASTEST = 1e6  # largest carrier speed [rad/s], beyond any machine
TOUCH = 1e-12  # compression at which an unloaded force law has its tangent [m]


@dataclass(frozen=True, slots=True)
class Machine:
    """Dynamic model of a gearbox as tables of masses, springs, meshes and loads.

    The equations are in SI units, in a frame in which the bodies vibrate about fixed positions::

        M q'' + C q' + K q + sum over meshes of g F(g @ q - e, ...) = sum of loads

    Parameters
    ----------
    dofs : tuple of str
        Names ``body.direction``; rotations (``theta``, ``tilt_x``, ``tilt_y``) in rad, the others in m.
    mass : ndarray, shape (n,)
        Mass [kg] or moment of inertia [kg m2] of each.
    springs : tuple of Spring
    meshes : tuple of GearMesh
    loads : tuple of Load
    notes : dict
        What had to be assumed, and derived numbers to be printed (phases, frequencies).
    stages : tuple of Stage
        Their frequencies and bodies are those that spectra and errors of the machine use; the last one is the driven one.
    speed : Speed, optional
        A speed that changes (`gearfe.with_speed`); None: the frequencies stated, for ever.
    spin : float
        Angular velocity of the frame, that of the carrier, counter-clockwise [rad/s]: with gyroscopic and centripetal terms. 0:
        without them.
    rotors : dict of str to float
        Angular velocities of bodies that tilt, against the ground, counter-clockwise [rad/s]: with their gyroscopic moments.
    faults : tuple of Fault
        Teeth that differ, whose lines spectra are searched for; the driven stage's last stage names its frequencies.
    sensors : dict of str to Sensor
        Sensors by name (`gearfe.Sensor`), each a channel ``"sensor NAME"`` of a response.

    Attributes
    ----------
    K, C : ndarray, shape (n, n)
        Stiffness and damping matrices of the springs alone, without the meshes; with a `spin` or `rotors` their terms, too.
    frame : ndarray, shape (n, n)
        What of K is due to them (`gearfe.dynamics.machine.turning_frame.frame_terms`).
    G : ndarray, shape (m, n)
        Rows of the meshes.
    law : dict of ndarray, shape (m,)
        Parameters of their contact laws by name (`gearfe.dynamics.machine.contact_law.parameters`).

    Raises
    ------
    ValueError
        If there is not one positive, finite mass for each degree of freedom; if a row of a spring, mesh or load has not n finite
        numbers; if `k` or `c` of a spring is negative or not finite. With a `spin`: if a body moves in one direction of the plane
        only, is held to the ground otherwise in x than in y, or tilts and is not among the `rotors`. With `rotors`: if one does
        not move in two directions, has no ``theta``, or its speed is not finite.
    """

    dofs: tuple[str, ...]
    mass: Floats
    springs: tuple[Spring, ...]
    meshes: tuple[GearMesh, ...]
    loads: tuple[Load, ...] = ()
    notes: dict[str, Any] = field(default_factory=dict)
    stages: tuple[Stage, ...] = ()
    speed: Speed | None = None
    spin: float = 0.0
    rotors: dict[str, float] = field(default_factory=dict)
    faults: tuple[Fault, ...] = ()
    sensors: dict[str, Any] = field(default_factory=dict)
    K: Floats = field(init=False)
    C: Floats = field(init=False)
    G: Floats = field(init=False)
    law: dict[str, NDArray[Any]] = field(init=False)
    frame: Floats = field(init=False)

    def __post_init__(self) -> None:
        """Assemble the matrices.

        Raises ValueError for masses that are not positive, springs that are negative, or rows of another length.
        """
        n, mass = len(self.dofs), numbers("mass", self.mass, " [kg], moments of inertia [kg m2]")
        self._check_sizes(mass)
        R = np.array([s.row for s in self.springs]).reshape(-1, n)
        K, C = (R.T @ (np.array([getattr(s, key) for s in self.springs])[:, None] * R) for key in "kc")
        frame = np.zeros((n, n))
        settle_numbers(self, "machine", "spin", " rad/s")
        if abs(self.spin) > FASTEST:
            raise ValueError(f"machine: spin = {self.spin:g} rad/s, but give at most {FASTEST:g} rad/s")
        if self.spin or self.rotors:
            gyroscopic, centripetal, circulatory = frame_terms(self.dofs, mass, self.springs, self.spin, self.rotors)
            frame, C = centripetal + circulatory, C + gyroscopic
        law = parameters(self.meshes)
        extra = [2 * m.zeta * math.sqrt(m.cycle.mean / (m.row**2 / mass).sum()) if m.zeta else 0.0 for m in self.meshes]
        law |= {"damping": law["damping"] + np.array(extra)}
        G = np.array([m.row for m in self.meshes]).reshape(-1, n)
        settle(self, mass=mass, K=K + frame, C=C, frame=frame, G=G, law=law)

    def _check_sizes(self, mass):
        n = len(self.dofs)
        if mass.shape != (n,) or not (np.isfinite(mass).all() and (mass > 0).all()):
            raise ValueError(f"mass: give {n} positive numbers, one per degree of freedom ({', '.join(self.dofs[:4])}, ...)")
        if len(set(self.dofs)) < n:
            raise ValueError(f"dofs: {', '.join(self.dofs)}, but give each degree of freedom once")
        elements: tuple[Spring | GearMesh | Load, ...] = (*self.springs, *self.meshes, *self.loads)
        for element in elements:
            if element.row.shape != (n,):
                raise ValueError(f"{element.name}: its row needs {n} finite numbers, one per degree of freedom")

    def __repr__(self):
        """Return one line with the numbers of degrees of freedom, springs, meshes and loads."""
        meshes = ", ".join(mesh.name for mesh in self.meshes[:4]) + (", ..." if len(self.meshes) > 4 else "")
        speeds = ", ".join(f"{stage.mesh:.4g} Hz" for stage in self.stages)
        return (
            f"<Machine: {len(self.dofs)} degrees of freedom, {len(self.springs)} springs, {len(self.meshes)} meshes ({meshes}), "
            f"{len(self.loads)} loads{f', mesh frequency {speeds}' if speeds else ''}>"
        )

    def row(self, name: str) -> Floats:
        """Return the unit row of a degree of freedom.

        Raises
        ------
        ValueError
            If there is none of that name.
        """
        if name not in self.dofs:
            raise ValueError(f"no degree of freedom {name!r}; there are {', '.join(self.dofs)}")
        return np.eye(len(self.dofs))[self.dofs.index(name)]

    def turned(self, t: ArrayLike) -> Floats:
        """Return the time in which gears rotate at nominal speed by the same angle as in `t` [s]. It determines the phases."""
        return np.asarray(t, dtype=float) if self.speed is None else self.speed.turned(t)

    @property
    def fastest(self) -> float:
        """Return the largest ratio of speed to nominal speed."""
        return 1.0 if self.speed is None else self.speed.fastest

    def stage_of(self, body: str) -> Stage:
        """Return the stage whose `Stage.returns` contains a body, or the last (driven) stage if none does."""
        names = {body, body.rstrip("LR"), body.rstrip("LR0123456789")}
        return next((stage for stage in reversed(self.stages) if names & set(stage.returns)), self.stages[-1])

    def fault_frequencies(self) -> tuple[Stage, float, float]:
        """Return the stage of the first fault, and its fault and shaft frequency [Hz]. The default is the driving gear."""
        if self.faults:
            first = self.faults[0]
            return self.stage_of(first.gear), first.frequency, first.turning
        stage = self.stages[-1]
        return stage, stage.fault or stage.turning, stage.turning

    def mean_stiffness(self) -> Floats:
        """Mean of each mesh's stiffness over its healthy cycle ``(m,)`` [N/m^power]."""
        return np.array([m.cycle.mean for m in self.meshes])

    def linear(self, x: ArrayLike | None = None) -> tuple[NDArray, NDArray, NDArray, NDArray]:
        """Return stiffness and damping matrices with mean mesh stiffness, and the mesh values used.

        `x` (m,) are the compressions [m] at which nonlinear laws are linearised (`working`). They are needed for a power other
        than 1 and for a `ForceLaw`.

        Returns
        -------
        K, C : ndarray, shape (n, n)
        k, c : ndarray, shape (m,)
        """
        if x is None:
            x = np.where(self.law["power"] == 1.0, 1.0, 0.0)
        mean, bend = self._mean_at(np.asarray(x))
        k, c = slopes(np.asarray(x), np.zeros(len(mean)), mean, self.law, bend)
        return self.K + self.G.T @ (k[:, None] * self.G), self.C + self.G.T @ (c[:, None] * self.G), k, c

    def _mean_at(self, x: Floats) -> tuple[Floats, Floats]:
        """Return `mean_stiffness` at compressions `x` (m,), and its derivative by depth. Only a `ForceLaw` depends on x."""
        mean, bend = self.mean_stiffness(), np.zeros(len(self.meshes))
        for i, mesh in enumerate(self.meshes):
            if mesh.average is not None:
                mean[i], bend[i] = mesh.average(0.0, depth(x, self.law)[i])
        return mean, bend

    @property
    def curved(self) -> bool:
        """Return True if the force of a mesh is nonlinear in its compression (exponent or `ForceLaw`)."""
        return bool((self.law["power"] != 1).any()) or any(mesh.secants for mesh in self.meshes)

    def working(self) -> Floats | None:
        """Return the compressions ``(m,)`` [m] of the meshes at rest, at which forces are linearised. None for linear forces."""
        gaps = np.array([mesh.gap for mesh in self.meshes])
        if not self.curved and not gaps.any():
            return None
        x = self.compressions(self.rest())
        free = gaps > 0
        for i in np.flatnonzero((gaps > 0) & (x > 0)):  # These back flanks carry load, and the drive flanks of the mesh do not.
            free |= (self.G + self.G[i] == 0).all(axis=1)
        touching = np.array([bool(mesh.secants) or not self.curved for mesh in self.meshes])
        return np.where(touching & ~free & (depth(x, self.law) == 0), TOUCH, x)

    def compressions(self, q: NDArray[Any]) -> Floats:
        """Return the compressions of the meshes ``(m,)`` [m] at displacements ``(n,)``, without mesh errors."""
        return self.G @ q - np.array([mesh.gap for mesh in self.meshes])

    def load(self, t: float = 0.0) -> Floats:
        """Sum of the loads at time `t` ``(n,)``."""
        return sum((load.row * float(load(t)) for load in self.loads), np.zeros(len(self.dofs)))

    def rest(self, t: float | None = None) -> Floats:
        """Return the displacements ``(n,)`` under the loads at time `t` (None: 0), with mean mesh stiffness, without mesh errors.

        Rigid-body motions are left out (least squares).

        Raises
        ------
        RuntimeError
            If Newton's method does not converge, because a load opens a mesh that no other load closes.
        """
        load = self.load(0.0 if t is None else t)
        zero = np.zeros(len(self.meshes))
        start = 1e-5 * np.ones(len(self.meshes))
        stiffness, _, least, _ = self.linear(start)
        q = np.linalg.lstsq(stiffness, load, rcond=1e-12)[0]
        for _ in range(200):
            x = self.compressions(q)
            mean, bend = self._mean_at(x)
            away = load - self.K @ q - self.G.T @ force(x, zero, mean, self.law)
            tangent = slopes(x, zero, mean, self.law, bend)[0]
            tangent = np.maximum(tangent, 1e-6 * least)  # A small stiffness of open meshes keeps the matrix regular.
            change = _weighted_solve(self.K + self.G.T @ (tangent[:, None] * self.G), away, self.mass)
            q = q + change
            if np.abs(change * np.sqrt(self.mass)).max() <= 1e-11 * np.abs(q * np.sqrt(self.mass)).max() + 1e-30:
                return q
        raise RuntimeError("no static equilibrium found: the loads do not close the meshes, or a body is free")

    def with_meshes(self, **changes: Any) -> "Machine":
        """Return the same machine with fields of every mesh replaced, e.g. ``with_meshes(backlash=1e-4)``."""
        return replace(self, meshes=tuple(replace(m, **changes) for m in self.meshes))


def _weighted_solve(matrix, right, mass):
    scale = 1 / np.sqrt(mass)
    return scale * np.linalg.lstsq(matrix * scale[:, None] * scale[None, :], right * scale, rcond=1e-13)[0]

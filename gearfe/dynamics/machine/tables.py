"""`Machine`: masses, linear springs, gear meshes and loads as tables; its matrices, modes and state of rest."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from html import escape
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .contact_law import depth, force, parameters, slopes
from .gear_mesh import GearMesh
from .speed import Speed
from .turning_frame import frame_terms

# of a load: a number, times and values, or a function of an array of times
History = float | tuple[ArrayLike, ArrayLike] | Callable[[NDArray], ArrayLike]

TOUCH = 1e-12  # compression at which the tangent of a law of force without load is taken [m]


@dataclass(frozen=True, slots=True)
class Spring:
    """A linear spring and damper along a row: force ``k row @ q + c row @ v`` against it [N/m, N s/m or per rad]."""

    name: str
    row: NDArray
    k: float
    c: float = 0.0


@dataclass(frozen=True, slots=True)
class Load:
    """A load along a row: a number, a history ``(times, values)`` linear between its times, or a function of an array of times.

    A history holds its first and last values outside; two equal times are a jump. A function must be smooth.

    Parameters
    ----------
    name : str
    row : ndarray, shape (n,)
        The load acts on the n degrees of freedom of a machine as ``row`` times its value (`Layout.unit`, `Layout.point`).
    value : float, (ndarray, ndarray) or callable
        Along its row: a force [N] on displacements, a torque [N m] on rotations. Times are in s.

    Raises
    ------
    ValueError
        If a number or a history is not finite, if a history is empty or has not as many times as values, or if its times fall. A
        function is looked at when the load is called: if it gives a value that is not finite.
    """

    name: str
    row: NDArray
    value: History

    def __post_init__(self) -> None:
        """Raise ValueError if the value is not finite, or the times of a history do not rise."""
        value: Any = self.value
        if callable(value):
            return
        if not isinstance(value, (tuple, list)) and np.ndim(value) == 0:
            if not math.isfinite(value):
                raise ValueError(f"load {self.name} = {value}, but it must be finite")
            return
        times, values = (np.asarray(part, dtype=float) for part in value)
        if times.ndim != 1 or times.shape != values.shape or not times.size:
            raise ValueError(f"load {self.name}: give as many times as values, got shapes {times.shape} and {values.shape}")
        if not (np.isfinite(times).all() and np.isfinite(values).all()):
            raise ValueError(f"load {self.name}: its history has a time or a value that is not finite (nan or inf)")
        if (np.diff(times) < 0).any():
            at = int(np.argmax(np.diff(times) < 0)) + 1
            raise ValueError(f"load {self.name}: time {times[at]:g} s follows {times[at - 1]:g} s; sort the history by time")

    def __call__(self, t: ArrayLike) -> NDArray:
        """Value at times `t`."""
        value: Any = self.value
        if callable(value):
            values = np.broadcast_to(np.asarray(value(t), dtype=float), np.shape(t))
            if not np.isfinite(values).all():
                raise ValueError(f"load {self.name}: its function gives a value that is not finite (nan or inf)")
            return values
        if np.ndim(value) == 0:
            return np.full(np.shape(t), float(value))
        return np.interp(np.asarray(t, dtype=float), *value)

    @property
    def breaks(self) -> NDArray:
        """Times at which the history bends or jumps [s]."""
        value: Any = self.value
        return np.unique(value[0]) if not callable(value) and np.ndim(value) else np.empty(0)


def pulses(
    base: float, peak: float, period: float, width: float, count: int, *, start: float = 0.0, rise: float = 0.1
) -> tuple[NDArray, NDArray]:
    """History of a load that rises from `base` to `peak` for `width` seconds every `period` seconds, `count` times.

    Each flank of a pulse takes the part `rise` of its width. For `Load`.

    Parameters
    ----------
    base, peak : float
        Values between the pulses and on top of them, in the unit of the load: [N] or, of a torque, [N m].
    period, width : float
        From the start of a pulse to that of the next, and from the start of a pulse to its end [s].
    count : int
        Number of pulses.
    start : float
        Start of the first pulse [s].
    rise : float
        Part of `width`, up to 0.5.

    Returns
    -------
    times, values : ndarray, shape (4 count,)
        Corners of the pulses: times [s], and values in the unit of the load.

    Raises
    ------
    ValueError
        Unless ``0 < width < period`` and ``0 < rise <= 0.5``.
    """
    if not 0 < width < period or not 0 < rise <= 0.5:
        raise ValueError(f"width = {width} s, rise = {rise}: pulses need 0 < width < period and 0 < rise <= 0.5")
    first = start + period * np.arange(count)[:, None]
    times = first + width * np.array([0.0, rise, 1 - rise, 1.0])
    return times.ravel(), np.tile([base, peak, peak, base], count).astype(float)


@dataclass(frozen=True, slots=True)
class Stage:
    """One stage of a machine: which bodies drive which, and its frequencies.

    Attributes
    ----------
    name : str
    driver : tuple of str
        Bodies of the driving gear (two of a herringbone gear).
    follower : tuple of str
        Bodies of the first gear that it drives.
    mesh : float
        Mesh frequency [Hz].
    turning : float
        Turning frequency of the driving gear [Hz], relative to the carrier if there is one.
    fault : float, optional
        How often a damaged tooth of the driving gear meshes, if that gear meets several others [Hz]; None: once a turn.
    carrier : float, optional
        Turning frequency of the carrier [Hz].
    returns : dict of str to float
        How often a tooth of each gear meshes with the same flank [Hz], by body; of planets without their number.
    """

    name: str
    driver: tuple[str, ...]
    follower: tuple[str, ...]
    mesh: float
    turning: float
    fault: float | None = None
    carrier: float | None = None
    returns: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Fault:
    """A tooth that differs from the others of its gear.

    Attributes
    ----------
    gear : str
        Body of the machine.
    tooth : int
    what : str
        Its damage or deviation in words.
    frequency : float
        How often it meshes [Hz].
    turning : float
        Turning frequency of its gear [Hz], relative to the carrier if there is one.

    Examples
    --------
    >>> print(Fault("wheel", 5, "3 mm crack at 60 degrees", 17.89, 17.89))
    tooth 5 of the wheel: 3 mm crack at 60 degrees; it meshes at 17.89 Hz
    """

    gear: str
    tooth: int
    what: str
    frequency: float
    turning: float

    def __str__(self) -> str:
        gear = f"the {self.gear}" if self.gear.isalpha() else self.gear
        return f"tooth {self.tooth} of {gear}: {self.what}; it meshes at {self.frequency:.4g} Hz"


@dataclass(frozen=True, slots=True)
class Machine:
    """A machine as tables.

    Its equations, in SI units and a frame in which its bodies vibrate about their places::

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
    mass: NDArray
    springs: tuple[Spring, ...]
    meshes: tuple[GearMesh, ...]
    loads: tuple[Load, ...] = ()
    notes: dict[str, Any] = field(default_factory=dict)
    stages: tuple[Stage, ...] = ()
    speed: Speed | None = None
    spin: float = 0.0
    rotors: dict[str, float] = field(default_factory=dict)
    faults: tuple[Fault, ...] = ()
    K: NDArray = field(init=False)
    C: NDArray = field(init=False)
    G: NDArray = field(init=False)
    law: dict[str, NDArray[Any]] = field(init=False)
    frame: NDArray = field(init=False)

    def __post_init__(self) -> None:
        """Assemble; ValueError for masses that are not positive, springs that are negative, or rows of another length."""
        n, mass = len(self.dofs), np.asarray(self.mass, dtype=float)
        if mass.shape != (n,) or not (np.isfinite(mass).all() and (mass > 0).all()):
            raise ValueError(f"mass: give {n} positive numbers, one per degree of freedom ({', '.join(self.dofs[:4])}, ...)")
        rows: tuple[Spring | GearMesh | Load, ...] = (*self.springs, *self.meshes, *self.loads)
        for element in rows:
            if np.shape(element.row) != (n,) or not np.isfinite(element.row).all():
                raise ValueError(f"{element.name}: its row needs {n} finite numbers, one per degree of freedom")
        for s in self.springs:
            if not (math.isfinite(s.k) and math.isfinite(s.c) and s.k >= 0 and s.c >= 0):
                raise ValueError(f"spring {s.name}: k = {s.k}, c = {s.c}, but they must be finite and not negative")
        R = np.array([s.row for s in self.springs]).reshape(-1, n)
        object.__setattr__(self, "mass", mass)
        K, C = (R.T @ (np.array([getattr(s, key) for s in self.springs])[:, None] * R) for key in "kc")
        frame = np.zeros((n, n))
        if self.spin or self.rotors:
            gyroscopic, centripetal, circulatory = frame_terms(self.dofs, mass, self.springs, self.spin, self.rotors)
            frame, C = centripetal + circulatory, C + gyroscopic
        object.__setattr__(self, "K", K + frame)
        object.__setattr__(self, "C", C)
        object.__setattr__(self, "frame", frame)
        object.__setattr__(self, "G", np.array([m.row for m in self.meshes]).reshape(-1, n))
        law = parameters(self.meshes)
        extra = [2 * m.zeta * math.sqrt(m.cycle.mean / (m.row**2 / mass).sum()) if m.zeta else 0.0 for m in self.meshes]
        object.__setattr__(self, "law", law | {"damping": law["damping"] + np.array(extra)})

    def __repr__(self):
        """One line: numbers of degrees of freedom, springs, meshes and loads."""
        meshes = ", ".join(mesh.name for mesh in self.meshes[:4]) + (", ..." if len(self.meshes) > 4 else "")
        speeds = ", ".join(f"{stage.mesh:.4g} Hz" for stage in self.stages)
        return (
            f"<Machine: {len(self.dofs)} degrees of freedom, {len(self.springs)} springs, {len(self.meshes)} meshes ({meshes}), "
            f"{len(self.loads)} loads{f', mesh frequency {speeds}' if speeds else ''}>"
        )

    def _repr_html_(self):
        rows = {"degrees of freedom": ", ".join(self.dofs), "meshes": ", ".join(mesh.name for mesh in self.meshes)}
        notes = "".join(f"<tr><td>{escape(str(k))}</td><td>{escape(str(v))}</td></tr>" for k, v in (rows | self.notes).items())
        return f"<table><caption>{escape(repr(self))}</caption>{notes}</table>"

    def row(self, name: str) -> NDArray:
        """Unit row of a degree of freedom.

        Raises
        ------
        ValueError
            If there is none of that name.
        """
        if name not in self.dofs:
            raise ValueError(f"no degree of freedom {name!r}; there are {', '.join(self.dofs)}")
        return np.eye(len(self.dofs))[self.dofs.index(name)]

    def turned(self, t: ArrayLike) -> NDArray:
        """Time in which the nominal speed turns the gears as far as they have turned at times `t` [s]: what angles follow."""
        return np.asarray(t, dtype=float) if self.speed is None else self.speed.turned(t)

    @property
    def fastest(self) -> float:
        """Largest speed over the nominal one."""
        return 1.0 if self.speed is None else self.speed.fastest

    def stage_of(self, body: str) -> Stage:
        """The stage in which a body's teeth return as `Stage.returns` says; the driven one, the last, if none has it."""
        names = {body, body.rstrip("LR"), body.rstrip("LR0123456789")}
        return next((stage for stage in reversed(self.stages) if names & set(stage.returns)), self.stages[-1])

    def fault_frequencies(self) -> tuple[Stage, float, float]:
        """Stage of the first fault, how often its tooth meshes and its gear turns [Hz]; without, those of the driving gear."""
        if self.faults:
            first = self.faults[0]
            return self.stage_of(first.gear), first.frequency, first.turning
        stage = self.stages[-1]
        return stage, stage.fault or stage.turning, stage.turning

    def mean_stiffness(self) -> NDArray:
        """Mean of each mesh's stiffness over its healthy cycle ``(m,)`` [N/m^power]."""
        return np.array([m.cycle.mean for m in self.meshes])

    def linear(self, x: ArrayLike | None = None) -> tuple[NDArray, NDArray, NDArray, NDArray]:
        """Stiffness and damping matrices with the meshes at their mean, and the mesh values used.

        `x` (m,): compressions [m] at which a law that is not linear is taken (`working`; needed for a power other than 1 and
        for a `ForceLaw`, whose tangent stiffness there is taken).

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

    def _mean_at(self, x: NDArray) -> tuple[NDArray, NDArray]:
        """`mean_stiffness` at compressions `x` (m,), which matter to a `ForceLaw`, and its derivative by the depth."""
        mean, bend = self.mean_stiffness(), np.zeros(len(self.meshes))
        for i, mesh in enumerate(self.meshes):
            if mesh.average is not None:
                mean[i], bend[i] = mesh.average(0.0, depth(x, self.law)[i])
        return mean, bend

    @property
    def curved(self) -> bool:
        """Whether the force of a mesh is no straight line over its compression: a power, or a `ForceLaw`."""
        return bool((self.law["power"] != 1).any()) or any(mesh.secants for mesh in self.meshes)

    def working(self) -> NDArray | None:
        """Compressions of the meshes at rest ``(m,)`` [m], about which their forces are taken as straight; None if they are."""
        gaps = np.array([mesh.gap for mesh in self.meshes])
        if not self.curved and not gaps.any():
            return None
        x = self.compressions(self.rest())
        free = gaps > 0
        for i in np.flatnonzero((gaps > 0) & (x > 0)):  # these carry, and the flanks before them do not
            free |= (self.G + self.G[i] == 0).all(axis=1)
        touching = np.array([bool(mesh.secants) or not self.curved for mesh in self.meshes])
        return np.where(touching & ~free & (depth(x, self.law) == 0), TOUCH, x)

    def compressions(self, q: NDArray[Any]) -> NDArray:
        """Compressions of the meshes ``(m,)`` [m] at displacements ``(n,)``, errors disregarded."""
        return self.G @ q - np.array([mesh.gap for mesh in self.meshes])

    def load(self, t: float = 0.0) -> NDArray:
        """Sum of the loads at time `t` ``(n,)``."""
        return sum((load.row * float(load(t)) for load in self.loads), np.zeros(len(self.dofs)))

    def rest(self, t: float | None = None) -> NDArray:
        """Displacements ``(n,)`` under the loads of time `t` (0 if None) at the mean mesh stiffnesses, errors disregarded.

        Rigid-body motions are left out (least squares).

        Raises
        ------
        RuntimeError
            If Newton's method does not settle: a load opens a mesh that nothing closes.
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
            tangent = np.maximum(tangent, 1e-6 * least)  # an open mesh keeps the matrix regular
            change = _weighted_solve(self.K + self.G.T @ (tangent[:, None] * self.G), away, self.mass)
            q = q + change
            if np.abs(change * np.sqrt(self.mass)).max() <= 1e-11 * np.abs(q * np.sqrt(self.mass)).max() + 1e-30:
                return q
        raise RuntimeError("no state of rest found: the loads do not press the meshes together, or leave a body free")

    def with_meshes(self, **changes: Any) -> "Machine":
        """The same machine with fields of every mesh replaced, e.g. ``with_meshes(backlash=1e-4)``."""
        return replace(self, meshes=tuple(replace(m, **changes) for m in self.meshes))


def _weighted_solve(matrix, right, mass):
    scale = 1 / np.sqrt(mass)
    return scale * np.linalg.lstsq(matrix * scale[:, None] * scale[None, :], right * scale, rcond=1e-13)[0]

"""`Response`: simulated motion of a machine, with named channels and units."""

import os
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.files import Content, save_as, suffix_of
from ...geometry.aliases import Floats
from ...signal.series import Signal
from ..machine.contact_law import force, sided_force
from ..machine.springs import Spring
from ..machine.tables import Machine
from . import excitation
from .heard import heard, unit_of

KINDS = {"velocity": "/s", "acceleration": "/s2"}
MESH = {"compression": "m", "stiffness": "N/m", "force": "N"}


@dataclass(frozen=True, slots=True)
class Response:
    """Motion of a machine at equal intervals.

    ``response[name]`` is a channel, an array like `time`: a degree of freedom (``"sun.theta"``), with ``" velocity"`` or
    ``" acceleration"`` after it, or of a mesh ``"compression NAME"``, ``"stiffness NAME"``, ``"force NAME"``. The force
    of a spring with its damper is ``"spring NAME"`` (`springs`): force [N] of a bearing, or torque [N m] of a coupling.

    If `gearfe.simulate` filtered the channels (`filtered`), channels by name, `mesh`, `accelerations`, `signal` and files have no
    content above half the rate of the response. `states`, `q` and `v` are unfiltered values of the integrator at these times,
    from which a run can be continued. All channels of ``response.raw`` are unfiltered, for energies and contact loss.

    Attributes
    ----------
    machine : Machine
    time : ndarray, shape (t,)
        Times [s].
    states : ndarray, shape (t, 2n)
        Coordinates of the integrator.
    basis : ndarray, shape (2n, 2n)
        ``(q, v) = basis @ state``.
    stats : dict
        Solver, step, number of calls or steps, seconds, losses of contact, and the error estimate if requested.
    filtered : ndarray, shape (t, 3n + 3m), optional
        States, accelerations, and compressions, stiffnesses and forces of the meshes, filtered.
    heard : dict of str to ndarray, shape (t,)
        Signals of sensors, computed from a longer record.
    """

    machine: Machine
    time: Floats
    states: Floats
    basis: Floats
    stats: dict[str, Any] = field(default_factory=dict)
    filtered: Floats | None = None
    heard: dict[str, Floats] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Raise ValueError for times, states and filtered channels of different lengths."""
        counts = {len(self.time), len(self.states), len(self.time if self.filtered is None else self.filtered)}
        if len(counts) > 1:
            raise ValueError("a response needs as many times as states and filtered channels: cut it by part")

    @property
    def raw(self) -> "Response":
        """The same response with the unfiltered channels of the integrator at these times."""
        return replace(self, filtered=None)

    def part(self, kept: slice | NDArray[np.int64]) -> "Response":
        """Return some of the samples, given as a slice or by their numbers."""
        filtered = None if self.filtered is None else self.filtered[kept]
        heard = {name: values[kept] for name, values in self.heard.items()}
        return replace(self, time=self.time[kept], states=self.states[kept], filtered=filtered, heard=heard)

    def with_heard(self) -> "Response":
        """Return the response with the signals of its sensors. They do not change when the response is cut."""
        return replace(self, heard={name: self[f"sensor {name}"] for name in self.machine.sensors})

    def __repr__(self):
        """Return one line with machine, time and solver."""
        time = f"{len(self.time)} samples from {self.time[0]:.4g} to {self.time[-1]:.4g} s"
        machine = f"{len(self.machine.dofs)} degrees of freedom, {len(self.machine.meshes)} meshes"
        return f"<Response: {time}, {machine}, by {self.stats.get('method', '?')}; {len(self.names)} channels in .names>"

    @property
    def names(self) -> list[str]:
        """Names of all channels."""
        dofs = self.machine.dofs
        motions = [*dofs, *(f"{name} {kind}" for kind in KINDS for name in dofs)]
        meshes = [f"{kind} {mesh.name}" for kind in MESH for mesh in self.machine.meshes]
        return [*motions, *meshes, *(f"sensor {name}" for name in self.machine.sensors)]

    def unit(self, name: str) -> str:
        """Return the unit of a channel."""
        head, _, tail = name.partition(" ")
        if head in MESH and tail in self._meshes:
            power = self.machine.meshes[self._meshes.index(tail)].contact.power
            return MESH[head] if head != "stiffness" or power == 1 else f"N/m^{power:g}"
        if head == "spring" and tail in self.springs:
            return "N m" if self._turns(tail) else "N"
        if head == "sensor" and tail in self.machine.sensors:
            return unit_of(self, self.machine.sensors[tail])
        self._dof(head, name)
        return ("rad" if head.endswith((".theta", ".tilt_x", ".tilt_y")) else "m") + KINDS.get(tail, "")

    def __getitem__(self, name: str) -> Floats:
        """Channel `name` ``(t,)``."""
        head, _, tail = name.partition(" ")
        if head in MESH and tail in self._meshes:
            return self.mesh(head)[:, self._meshes.index(tail)]
        n = len(self.machine.dofs)
        if head == "spring" and tail in self.springs:
            spring = self.springs[tail]
            return self._moving @ (spring.row @ (spring.k * self.basis[:n] + spring.c * self.basis[n:]))
        if head == "sensor" and tail in self.machine.sensors:
            return self.heard[tail] if tail in self.heard else heard(self, self.machine.sensors[tail], name).values
        dof = self._dof(head, name)
        if tail == "acceleration":
            return self.accelerations()[:, dof]
        return self._moving @ self.basis[dof + (n if tail == "velocity" else 0)]

    @property
    def springs(self) -> dict[str, Spring]:
        """Return the springs of the machine by unique names."""
        names = [spring.name for spring in self.machine.springs]
        return {spring.name: spring for spring in self.machine.springs if names.count(spring.name) == 1}

    @property
    def _moving(self):
        """Return the states. They are filtered if the response is filtered."""
        return self.states if self.filtered is None else self.filtered[:, : 2 * len(self.machine.dofs)]

    def _turns(self, name):
        """Return whether a spring carries a torque. Such a spring couples no translation."""
        moved = {self.machine.dofs[i].partition(".")[2] for i in self.springs[name].row.nonzero()[0]}
        return not moved & set("xyz")

    @property
    def q(self) -> Floats:
        """Displacements ``(t, n)``."""
        return self.states @ self.basis[: len(self.machine.dofs)].T

    @property
    def v(self) -> Floats:
        """Velocities ``(t, n)``."""
        return self.states @ self.basis[len(self.machine.dofs) :].T

    def mesh(self, kind: str = "force") -> Floats:
        """Compression [m], stiffness [N/m^power] or force [N] of all meshes ``(t, m)``."""
        if kind not in MESH:
            raise ValueError(f"kind = {kind!r}, but it must be one of {', '.join(MESH)}")
        which = list(MESH).index(kind)
        if self.filtered is not None:
            return np.split(self.filtered[:, 3 * len(self.machine.dofs) :], 3, axis=1)[which]
        return mesh_channels(self.machine, self.time, self.q, self.v)[which]

    def accelerations(self) -> Floats:
        """Accelerations ``(t, n)``, from the equations of motion."""
        if self.filtered is not None:
            n = len(self.machine.dofs)
            return self.filtered[:, 2 * n : 3 * n]
        return acceleration(self.machine, self.time, self.q, self.v)

    def signal(self, name: str, turning: float | None = None) -> Signal:
        """Channel `name` as a `gearfe.Signal`.

        `turning` is the rotational frequency of a shaft at the machine's nominal speed [Hz]. With it, the signal has the angle
        of that shaft, so that `gearfe.order_spectrum` and the synchronous average are valid at variable speed.
        """
        angle = None if turning is None else 2 * np.pi * turning * self.machine.turned(self.time)
        return Signal(self[name], 1 / float(self.time[1] - self.time[0]), self.unit(name), name, angle)

    def save(self, path: str | os.PathLike[str], names: Sequence[str] | None = None) -> None:
        """Write channels `names` (default: displacements and mesh forces). The suffix decides: .csv, .npz or .mat."""
        suffix = suffix_of(path, "response")
        save_as(suffix, path, self._content(names))

    def _content(self, names):
        channels = self._columns(names)
        units = [self.unit(name) for name in channels]
        columns = {"time [s]": self.time} | {f"{name} [{u}]": v for (name, v), u in zip(channels.items(), units, strict=True)}
        values = np.array(list(channels.values())).T
        arrays = {"time": self.time, "values": values, "names": np.array(list(channels)), "units": np.array(units)}
        array_units = {"time": "s", "values": "by row of units", "names": "-", "units": "-"}
        return Content("gearfe response, version 1", columns, arrays, self.stats, array_units)

    @property
    def saved(self) -> list[str]:
        """Names of the channels that `save` writes by default."""
        return [*self.machine.dofs, *(f"force {name}" for name in self._meshes)]

    def _columns(self, names):
        names = self.saved if names is None else list(names)
        forces = self.mesh() if any(name.startswith("force ") for name in names) else None
        plain = {f"force {name}": i for i, name in enumerate(self._meshes)}
        return {name: forces[:, plain[name]] if name in plain else self[name] for name in names}

    @property
    def _meshes(self):
        return [mesh.name for mesh in self.machine.meshes]

    def _dof(self, head, name):
        if head not in self.machine.dofs or name.partition(" ")[2] not in ("", *KINDS):
            springs = "".join(f", spring {one}" for one in self.springs)
            raise ValueError(f"no channel {name!r}; there are {', '.join(self.names)}{springs}")
        return self.machine.dofs.index(head)


def mesh_channels(machine, t, q, v, side=None):
    """Compressions, stiffnesses, forces ``(..., m)`` and running phases of the meshes, kept in contact on a `side` if given."""
    e, rate = excitation.errors(machine, t)
    x, speed = q @ machine.G.T - e, v @ machine.G.T - rate
    k, _, phase = excitation.stiffness(machine, t, x)
    total = force(x, speed, k, machine.law) if side is None else sided_force(x, speed, k, machine.law, side)
    return x, k, total, phase


def acceleration(machine, t, q, v, side=None, meshes=None):
    """Accelerations at times `t` from displacements and velocities ``(..., n)``. `meshes` are available `mesh_channels`."""
    _, _, total, phase = mesh_channels(machine, t, q, v, side) if meshes is None else meshes
    out = -q @ machine.K.T - v @ machine.C.T - total @ machine.G
    if any(mesh.friction for mesh in machine.meshes):
        rows, rubbed, weights = excitation.rubbing(machine, phase)
        out = out - (weights * total[..., rubbed]) @ rows
    for load in machine.loads:
        out = out + load(t)[..., None] * load.row
    return out / machine.mass


def all_channels(response):
    """Return `Response.filtered` ``(t, 3n + 3m)`` of a response that is not yet filtered."""
    machine, t, q, v = response.machine, response.time, response.q, response.v
    meshes = mesh_channels(machine, t, q, v)
    return np.concatenate([response.states, acceleration(machine, t, q, v, meshes=meshes), *meshes[:3]], axis=1)

"""Forces of a gear mesh: table of contact laws, backlash, Coulomb friction and Hertz's coefficient.

All functions take arrays. The compression `x` of a mesh is positive when the driving flanks press on each other. The back flanks
touch at ``x = -backlash``. A law gives the force of flanks in touch, which is the same for back flanks.

To add a law, write one file in ``laws/`` and one row in `LAWS`; a mesh takes it as ``GearMesh(..., law=...)``.
A law is a frozen dataclass; its fields are numeric parameters. Every law has two of them: `power`, the exponent of the depth in
the unit of k, ``N/m**power``, and `straight`, true if the force is linear in depth and rate. Two static methods define the
force::

    force(depth, rate, k, c, law)    the force [N]: of depth >= 0 [m] and its rate [m/s], in proportion to k and c together
    slopes(depth, rate, k, c, law)   its derivatives by depth and by rate

`k` and ``c = damping + damping_per_stiffness k`` [N s/m] are the present values of the mesh, and ``law.name`` is the parameter
with that name. The reference integrator calls the methods with arrays. For the fast path numba compiles them for numbers. Write
them with operators and functions of numpy, without ``if`` and without calls of other functions.
"""

import math
from collections.abc import Sequence
from dataclasses import fields
from functools import partial
from types import SimpleNamespace
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ...core.record import ranged
from ...flexibility.hertz import contact_modulus
from .laws.impact import Hertz, Impact
from .laws.spring import SpringLaw

LAWS: tuple[Any, ...] = (SpringLaw, Hertz, Impact)


class Law(Protocol):
    """A contact law: a row of `LAWS` with its parameters."""

    @property
    def power(self) -> float:
        """Exponent of the depth in the unit of k."""

    @property
    def straight(self) -> bool:
        """Whether the force is linear in depth and rate."""

    @staticmethod
    def force(depth: Any, rate: Any, k: Any, c: Any, law: Any) -> Any:
        """Force of depth and rate."""

    @staticmethod
    def slopes(depth: Any, rate: Any, k: Any, c: Any, law: Any) -> tuple[Any, Any]:
        """Return the derivatives of the force by depth and rate."""


def law_of(power: float, full: float) -> Law:
    """Return the law with this exponent. `full` is the depth from which the damping is full [m]."""
    if power == 1 and full == 0:
        return SpringLaw()
    return Hertz(full) if power == 1.5 else Impact(power, full)


def parameters(meshes: Sequence[Any]) -> dict[str, NDArray[Any]]:
    """Return the contact parameters of the meshes by name, ``(m,)`` each, 0 for laws without this parameter.

    Besides those of the laws: `kind`, the row of `LAWS`; ``damping, damping_per_stiffness, backlash, film``; and `least`, the
    smallest force: 0 if flanks never pull, otherwise ``-inf``.
    """
    names = dict.fromkeys(field.name for law in LAWS for field in fields(law))
    out = {name: np.array([float(getattr(mesh.contact, name, 0.0)) for mesh in meshes]) for name in names}
    out |= {
        name: np.array([float(getattr(mesh, name)) for mesh in meshes])
        for name in ("damping", "damping_per_stiffness", "backlash")
    }
    return out | {
        "kind": np.array([LAWS.index(type(mesh.contact)) for mesh in meshes], dtype=np.int64),
        "film": np.array([0.0 if mesh.push else float(mesh.film) for mesh in meshes]),
        "least": np.array([0.0 if mesh.push else -math.inf for mesh in meshes]),
    }


def touch(x, v, backlash):
    """Return penetration of the flanks in contact, its rate, and the side (1 front, -1 back, 0 none) as floats."""
    front, rear = np.maximum(x, 0.0), np.maximum(-backlash - x, 0.0)
    side = (front > 0) * 1.0 - (rear > 0)
    return front + rear, side * v, side


def mesh_force(touch, pushed):
    """Return the mesh force as a function of compression, rate, k and parameters, built from `touch` and the force of the law.

    The result accepts arrays if the functions are plain, and numbers if they are compiled.
    """

    def force(x, v, k, law):
        depth, rate, side = touch(x, v, law.backlash)
        c = law.damping + law.damping_per_stiffness * k
        return side * np.maximum(pushed(depth, rate, k, c, law), law.least) + (side == 0) * law.film * c * v

    return force


def step(x, x0, h0, x1, h1):
    """Cubic step of multibody programs: `h0` up to `x0`, `h1` from `x1` on, and ``3 u**2 - 2 u**3`` between them.

    >>> float(step(0.05, 0.0, 0.0, 0.1, 1.0))
    0.5
    """
    u = np.clip((np.asarray(x, dtype=float) - x0) / (x1 - x0), 0.0, 1.0)
    return h0 + (h1 - h0) * u * u * (3 - 2 * u)


def hertz_coefficient(radius_1, radius_2, materials):
    """Coefficient K of ``F = K delta**1.5`` from Hertz's theory, ``4/3 sqrt(R) E*`` [N/mm^1.5].

    Parameters
    ----------
    radius_1, radius_2 : float
        Radii of curvature of the flanks at the contact [mm], the second negative in an internal gear.
    materials : (Material, Material)

    References
    ----------
    K. L. Johnson, Contact Mechanics, 1985, eq. 4.23; the law of the articles on pitted planetary and helical gears.

    Examples
    --------
    At the pitch point of the 21/31 pair of module 2 the articles print 3.0459e5:

    >>> from gearfe.core.material import Material
    >>> half = math.sin(math.radians(20))
    >>> round(hertz_coefficient(21 * half, 31 * half, (Material(E=207e3, nu=0.25),) * 2) / 1e5, 3)
    3.046
    """
    return 4 / 3 / math.sqrt(1 / radius_1 + 1 / radius_2) * contact_modulus(materials)


def friction_coefficient(slip, *, static, dynamic, v_static, v_dynamic):
    """Return the smoothed coefficient of Coulomb friction of multibody programs, with the sign of the slip velocity.

    It is 0 without slip, `static` at the slip velocity `v_static`, and `dynamic` from `v_dynamic` on. `step` interpolates.

    Parameters
    ----------
    slip : ndarray
        Slip velocity [m/s].
    static, dynamic : float
        Coefficients of friction.
    v_static, v_dynamic : float
        Transition velocities [m/s].
    """
    for name, value in {"static": static, "dynamic": dynamic}.items():
        ranged(f"friction: {name}", value, least=0.0)
    if not 0 < ranged("friction: v_static", v_static) < ranged("friction: v_dynamic", v_dynamic):
        raise ValueError(f"friction: v_static = {v_static}, v_dynamic = {v_dynamic} m/s, but give 0 < v_static < v_dynamic")
    size = np.abs(slip)
    stick = step(size, -v_static, -static, v_static, static)
    return np.sign(slip) * np.where(size < v_static, stick, step(size, v_static, static, v_dynamic, dynamic))


def _each(what, depth, rate, k, c, law):
    """Evaluate the force or the slopes of each mesh by its own law."""
    kinds = set(law.kind.tolist()) or {0}
    if len(kinds) == 1:
        return getattr(LAWS[kinds.pop()], what)(depth, rate, k, c, law)
    arguments = np.broadcast_arrays(depth, rate, k, c)
    out = np.empty(arguments[0].shape if what == "force" else (2, *arguments[0].shape))
    for kind in kinds:
        mine = law.kind == kind
        selected = SimpleNamespace(**{name: values[mine] for name, values in vars(law).items()})
        out[..., mine] = getattr(LAWS[kind], what)(*(argument[..., mine] for argument in arguments), selected)
    return out


_force = mesh_force(touch, partial(_each, "force"))


def force(x, v, k, law):
    """Force of each mesh along its line of action [N], positive when it pushes.

    The law is evaluated on the flanks in contact, with the damping ``c = damping + damping_per_stiffness k``. Without contact, a
    part `film` of the damping remains. With `push` a flank never pulls, as in the impact function of multibody programs.

    Parameters
    ----------
    x, v : ndarray, shape (..., m)
        Compression [m] and its rate [m/s].
    k : ndarray, shape (..., m)
        Stiffness [N/m^power].
    law : dict of ndarray, shape (m,)
        Of `parameters`.
    """
    return _force(x, v, k, SimpleNamespace(**law))


def sides(x, law):
    """Return the flanks on which each mesh touches at compressions `x` ``(..., m)``: 1 front, -1 back, 0 none."""
    return (x > 0).astype(np.int8) - (x < -law["backlash"])


def sided_force(x, v, k, law, side):
    """Return the `force` of meshes as if they stayed on the flanks of `side` at every compression `x`.

    `force` has kinks where contact is lost or the side changes. An integrator that stops there can integrate this smooth law in
    between. Flanks that only push keep the kink at which their force reaches zero.
    """
    depth = np.where(side == 0, 0.0, np.where(side < 0, x + law["backlash"], x))
    depth = np.where(law["least"] == 0, np.where(side < 0, np.minimum(depth, 0.0), np.maximum(depth, 0.0)), depth)
    return force(depth, v, k, law | {"backlash": np.zeros_like(law["backlash"])})


def depth(x, law):
    """Return the penetration of the touching flanks of each mesh, front or back, at compressions `x` ``(..., m)``, or 0."""
    return touch(x, 0.0, law["backlash"])[0]


def slopes(x, v, k, law, bend=0.0):
    """Compute the derivatives of `force` by x and v on the present branch, with the shape of `force`.

    `bend` is the derivative of k by the depth for a `gearfe.dynamics.machine.force_law.ForceLaw` [N/m2].
    """
    law = SimpleNamespace(**law)
    depth, rate, side = touch(x, v, law.backlash)
    c = law.damping + law.damping_per_stiffness * k
    by_depth, by_rate = _each("slopes", depth, rate, k, c, law)
    by_depth = by_depth + bend * _each("force", depth, rate, 1.0, law.damping_per_stiffness, law)
    on = (side != 0) & (_each("force", depth, rate, k, c, law) > law.least)
    return np.where(on, by_depth, 0.0), np.where(side == 0, law.film * c, np.where(on, by_rate, 0.0))


def closed(law):
    """Return True if all meshes push with ``k x + c x'`` at any compression: straight laws that never open."""
    return bool((law["straight"].astype(bool) & (law["backlash"] == 0) & (law["least"] < 0)).all())

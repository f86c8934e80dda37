"""Steady state of a machine without its transient by shooting, and its stability by Floquet multipliers."""

import math
import time
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.record import ranged
from ...core.threads import single
from ..machine.contact_law import closed
from ..machine.tables import Machine
from . import excitation, propagator
from .response import Response
from .run_checks import initial_state
from .step_control import chosen_step

DISTURBED = 1e-5  # relative size of the disturbances that test the stability of a nonlinear motion
STABLE = 1e-6  # tolerance above 1 for Floquet multipliers of rigid-body motion and undamped modes


MOST_STEPS = 10_000_000  # largest number of steps in a period


@dataclass(frozen=True, slots=True)
class Steady:
    """Periodic motion of a machine.

    Attributes
    ----------
    response : Response
        One period, both ends included.
    period : float
        Period [s].
    multipliers : ndarray, shape (2n,)
        Floquet multipliers: eigenvalues of the monodromy matrix, the largest first.
    residual : float
        Distance of the end of the period from its start over the size of the motion (in scaled coordinates).
    iterations : int
        Number of Newton iterations.
    """

    response: Response
    period: float
    multipliers: NDArray[np.complex128]
    residual: float
    iterations: int

    @property
    def stable(self) -> bool:
        """Whether small disturbances decay or stay constant."""
        return bool(abs(self.multipliers[0]) <= 1 + STABLE)


def common_period(machine: Machine) -> float:
    """Shortest time after which all stiffnesses and errors of a machine repeat [s].

    Raises
    ------
    ValueError
        If there is none (frequencies without a common multiple, loads that change).
    """
    if any(load.changes for load in machine.loads):
        raise ValueError("the loads change with time: give the period")
    if machine.speed is not None:
        raise ValueError("the speed changes with time: there is no periodic motion; use simulate")
    rates = [abs(m.frequency) / m.cycles() for m in machine.meshes]
    rates = [rate for rate in (*rates, *(abs(f) for m in machine.meshes for _, f, _ in m.error)) if rate]
    if not rates:
        raise ValueError("no load or mesh of this machine is periodic: give the period")
    parts = [Fraction(rate / rates[0]).limit_denominator(10000) for rate in rates]
    if not np.allclose(np.array(parts, dtype=float) * rates[0], rates, rtol=1e-9, atol=0.0):
        raise ValueError(f"frequencies {', '.join(f'{r:.6g}' for r in sorted(set(rates)))} Hz have no common period")
    turns = math.lcm(*(part.denominator for part in parts))
    return turns / math.gcd(*(int(part * turns) for part in parts)) / rates[0]


@single
def steady_state(
    machine: Machine,
    *,
    period: float | None = None,
    dt: float | None = None,
    initial: tuple[ArrayLike, ArrayLike] | None = None,
    iterations: int = 20,
    tolerance: float = 1e-9,
) -> Steady:
    """Compute the periodic motion of a machine by shooting.

    Newton's method solves for the state at the start of the period. One step is exact if the meshes stay closed. Motions of
    longer periods (subharmonic) are found only if `period` states them.

    Parameters
    ----------
    machine : Machine
    period : float, optional
        [s]; default: `common_period`.
    dt : float, optional
        Step; default `gearfe.dynamics.motion.step_control.chosen_step`.
    initial : (ndarray, ndarray), optional
        Displacements and velocities to start from; default: at rest.
    iterations : int
        Bound of Newton's method.
    tolerance : float
        Of `Steady.residual`.

    Returns
    -------
    Steady

    Raises
    ------
    RuntimeError
        If Newton's method does not settle.
    """
    started = time.perf_counter()
    period = common_period(machine) if period is None else ranged("period", period, " s", above=0.0)
    dt = None if dt is None else ranged("dt", dt, " s", above=0.0)
    flow = _Flow(machine, period, dt)
    q, v = (machine.rest(), np.zeros(len(machine.dofs))) if initial is None else initial_state(machine, initial)
    z = flow.plan.inverse @ np.concatenate([q, v])
    for done in range(iterations + 1):
        states, stats = flow(z)
        away = states[-1] - z
        size = np.abs(states).max() or 1.0
        residual = float(np.abs(away).max() / size)
        if not residual <= tolerance and done == iterations:
            break
        if done == 0 or residual > tolerance or not flow.linear:
            matrix = flow.monodromy(states)
        if residual <= tolerance:
            values = np.linalg.eigvals(matrix)
            stats |= {"method": "shooting", "dt": 2 * flow.plan.h, "seconds": time.perf_counter() - started}
            response = Response(machine, flow.times[::2], states[::2], flow.plan.basis, stats)
            return Steady(response, period, values[np.argsort(-np.abs(values))], residual, done)
        z = z + np.linalg.lstsq(np.eye(z.size) - matrix, away, rcond=1e-10)[0]
    raise RuntimeError(
        f"no periodic motion of period {period:.6g} s found in {iterations} iterations (residual {residual:.3g}): "
        "the response may be of a longer period or not periodic; give initial from a simulation, or add damping"
    )


class _Flow:
    """Flow of the equations of motion over a period, and its derivative by the initial state."""

    def __init__(self, machine, period, dt):
        steps = math.ceil(period / (dt or chosen_step(machine, period)[0]) * (1 - 1e-12))
        if steps > MOST_STEPS:
            raise ValueError(f"period = {period:g} s: {steps:.3g} steps, but the maximum is {MOST_STEPS:g}: give a longer dt")
        self.machine, self.times = machine, np.linspace(0.0, period, 2 * steps + 1)
        self.plan = propagator.plan(machine, period / steps / 2, machine.working())
        self.flat = excitation.flatten(machine, np.linspace(0.0, period, 16 * steps + 1))
        self.linear = closed(machine.law) and not machine.curved  # Friction leaves the machine linear.

    def __call__(self, z):
        from .loop import run  # This import loads the compiler.
        from .loop_parts import announced

        with announced():
            return run(self.plan, self.machine, self.flat, z, self.times.size - 1, 1)

    def monodromy(self, states):
        """Return the monodromy matrix (final by initial state of a period) by differences, exact for linear machines."""
        part = 1.0 if self.linear else DISTURBED
        size = part * (np.abs(states).max() or 1.0)
        columns = []
        for step in size * np.eye(len(states[0])):
            before = states if self.linear else self(states[0] - step)[0]
            columns.append((self(states[0] + step)[0][-1] - before[-1]) / (size if self.linear else 2 * size))
        return np.array(columns).T

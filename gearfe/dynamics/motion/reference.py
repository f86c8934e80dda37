"""Reference integrator: methods of `scipy.integrate.solve_ivp` between located contact changes and load kinks."""

import math
import time

import numpy as np
import scipy

from ..machine.contact_law import sides
from . import excitation
from .response import Response, acceleration

SOLVERS = ("RK45", "RK23", "DOP853", "Radau", "BDF", "LSODA")
EVENTS = 100_000  # limit of contact changes in one run
# parts of a step at which contact is checked, because separation may be short
LOOKS = np.concatenate([[0.0], 2.0 ** np.arange(-20, -4), np.arange(2, 17) / 16])
TOGETHER = 1e-12  # Contact changes count as one if their time difference is below this part of the run.


def reference(machine, duration, count, state, method, rtol, start=0.0):
    """Integrate a machine by a method of scipy at `count` equal intervals.

    Every mesh is held on the flanks in contact, so that the motion is smooth, up to the time at which it leaves or reaches a
    flank. This time is a root of the method's dense output. There the integration restarts with the new flanks in contact.

    Parameters
    ----------
    machine : Machine
    duration, start : float
        [s]
    count : int
    state : ndarray, shape (2n,)
        Displacements and velocities at time `start`.
    method : str
        One of `SOLVERS`.
    rtol : float
        Relative tolerance; the absolute one is a thousandth of it, times the largest value at rest.

    Returns
    -------
    Response

    Raises
    ------
    RuntimeError
        If the method gives up, or contact changes more often than `EVENTS` times.
    """
    started = time.perf_counter()
    run = _Run(machine, duration, count, state, method, rtol, start)
    edges = np.unique(np.concatenate([[start, start + duration], *(load.breaks for load in machine.loads)]))
    edges = edges[(edges >= start) & (edges <= start + duration)]
    at = start + np.linspace(0.0, duration, count + 1)
    y, states = run.scale * state, [state[None]]
    for low, high in zip(edges[:-1], edges[1:], strict=True):
        y, passed = run.between(low, high, y, at[(at > low) & (at <= high)])
        states += passed
    stats = {"method": method, "rtol": rtol, "calls": run.calls, "events": run.events, "losses": run.losses}
    stats |= {"seconds": time.perf_counter() - started, "dofs": len(machine.dofs)}
    return Response(machine, at, np.concatenate(states), np.eye(2 * len(machine.dofs)), stats)


class _Run:
    """One run: the scaled equations of motion, the flanks in contact, and counters."""

    def __init__(self, machine, duration, count, state, method, rtol, start):
        self.machine, self.n, self.law = machine, len(machine.dofs), machine.law
        highest = machine.fastest * max((abs(m.frequency) for m in machine.meshes), default=0.0)
        unit = max(2 * math.pi * highest, 1.0)  # scales velocities to the magnitude of displacements
        self.scale = scale = np.concatenate([np.sqrt(machine.mass) * unit, np.sqrt(machine.mass)])
        rest = machine.rest()
        size = np.abs(scale * np.concatenate([rest, 0 * rest])).max() or np.abs(scale * state).max() or 1.0
        self.method, self.options = method, {"rtol": rtol, "atol": 1e-3 * rtol * size}
        self.options["max_step"] = 1 / (8 * highest) if highest else np.inf
        self.opens = np.flatnonzero(self.law["backlash"] > 0)
        self.tiny, self.calls, self.events, self.losses = TOGETHER * duration, 0, 0, 0
        self.side = sides(self.compression(start, scale * state), self.law)

    def compression(self, t, y):
        """Compressions of all meshes ``(m,)`` [m], or at many times ``(m, t)``."""
        return self.machine.G @ (y.T / self.scale).T[: self.n] - excitation.errors(self.machine, t)[0].T

    def rate(self, t, y):
        u = y / self.scale
        a = acceleration(self.machine, t, u[: self.n], u[self.n :], self.side)
        return self.scale * np.concatenate([u[self.n :], a])

    def between(self, low, high, y, inside):
        """Integrate between two times without load kinks. Return the state at `high`, and the states at times `inside`."""
        states = []
        while low < high:
            solver = getattr(scipy.integrate, self.method)(self.rate, low, y, high, **self.options)
            low, hit = self._smooth(solver, inside, states)
            y = solver.y if hit is None else solver.dense_output()(low)
            self.calls += solver.nfev
            if hit is not None:
                self._change(low, y, hit)
        return y, states

    def _smooth(self, solver, inside, found):
        """Step until a contact changes or the end is reached. Return that time, and the new flanks in contact (None at the end).

        States at the times `inside` are appended to `found`.
        """
        while True:
            message = solver.step()
            if solver.status == "failed" or not np.isfinite(solver.y).all():
                raise RuntimeError(f"{self.method} failed at t = {solver.t:.4g} s: {message or 'values that are not finite'}")
            times, end, hit = inside[(inside > solver.t_old) & (inside <= solver.t)], solver.t, None
            if self.opens.size or times.size:
                path = solver.dense_output()
            if self.opens.size:
                end, hit = self._first_exit(path, solver.t_old, solver.t)
                times = times[times <= end]
            if times.size:
                found.append((path(times) / self.scale[:, None]).T)
            if hit is not None or solver.status == "finished":
                return end, hit

    def _first_exit(self, path, low, high):
        """Return the first time in a step at which a contact ends, and the flanks that touch afterwards, by mesh.

        If no contact ends, the result is the end of the step and None.
        """
        first = high, None
        exits = [(i, *leaving) for i in self.opens for leaving in self._exits(i)]
        at, x = self._looks(path, low, high, {i for i, *_ in exits})
        for i, place, direction, side in exits:
            past = direction * (x[i] - place) > 0
            if not past[1:].any():
                continue
            j = 1 + int(np.argmax(past[1:]))
            time = (
                at[j]
                if past[j - 1]
                else scipy.optimize.brentq(self._beyond(path, i, place), at[j - 1], at[j], xtol=1e-300, rtol=1e-15)
            )
            if time < first[0] or first[1] is None:
                first = time, {i: side}
        return first

    def _looks(self, path, low, high, meshes):
        """Return times within a step and the compressions at these times. A step may be longer than a loss of contact.

        The times are `LOOKS` and the extrema of parabolas through three of them.
        """
        at = low + (high - low) * LOOKS
        x = self.compression(at, path(at))
        turns = []
        for i in meshes:
            before, after = np.diff(x[i])[:-1], np.diff(x[i])[1:]
            for j in np.flatnonzero(before * after < 0):
                (left, middle), rise = np.diff(at[j : j + 3]), np.diff(x[i, j : j + 3])
                slopes = rise / (left, middle)
                turns.append(at[j] + left / 2 - slopes[0] * (left + middle) / 2 / (slopes[1] - slopes[0]))
        if not turns:
            return at, x
        at = np.unique(np.concatenate([at, turns]))
        return at, self.compression(at, path(at))

    def _beyond(self, path, i, place):
        return lambda t: self.compression(t, path(t))[i] - place

    def _change(self, t, y, hit):
        """Change the flanks in contact of the meshes `hit`, and of the other half of the gear if it changes at the same time."""
        self.events += 1
        if self.events > EVENTS:
            raise RuntimeError(
                f"contact changed {EVENTS} times up to t = {t:.4g} s: the flanks open and close continually; give a "
                "shorter duration"
            )
        x, u = self.compression(t, y), y / self.scale
        speed = self.machine.G @ u[self.n :] - excitation.errors(self.machine, t)[1]
        for i in self.opens:
            near = [
                side
                for place, direction, side in self._exits(i)
                if abs(x[i] - place) <= self.tiny * abs(speed[i]) and direction * speed[i] > 0
            ]
            after = hit.get(i, near[0] if near else self.side[i])
            self.losses += int(after == 0 and self.side[i] != 0)
            self.side[i] = after

    def _exits(self, i):
        """Return where the present contact of a mesh ends: compression, direction, and the next flank in contact."""
        side, slack = self.side[i], self.law["backlash"][i]
        if side == 0:
            return (0.0, 1, 1), (-slack, -1, -1)
        return ((0.0 if side > 0 else -slack, -side, 0),)

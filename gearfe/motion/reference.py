"""The reference: methods of `scipy.integrate.solve_ivp` between located changes of contact and bends of the loads."""

import math
import time

import numpy as np
from scipy.integrate import solve_ivp

from ..machine.contact_law import sides
from . import excitation
from .response import Response, acceleration

SOLVERS = ("RK45", "RK23", "DOP853", "Radau", "BDF", "LSODA")
EVENTS = 100_000  # in one run
TOGETHER = 1e-12  # of a run: changes of contact closer in time than this are one


def reference(machine, duration, count, state, method, rtol, start=0.0):
    """Response of a machine by a method of scipy at `count` equal intervals.

    Every mesh is held on the flanks it touches, so that all is smooth, up to the time at which it leaves or reaches a flank;
    there, at the root of the method's dense output, the integration begins anew with the flanks it then touches.

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
        Its atol is a thousandth of that of the largest value at rest.

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
    edges = np.unique(np.concatenate([[start, start + duration], *(one.breaks for one in machine.loads)]))
    edges = edges[(edges >= start) & (edges <= start + duration)]
    at = start + np.linspace(0.0, duration, count + 1)
    y, states = run.scale * state, [state[None]]
    for low, high in zip(edges[:-1], edges[1:], strict=True):
        y, found = run.between(low, high, y, at[(at > low) & (at <= high)])
        states += found
    stats = {"method": method, "rtol": rtol, "calls": run.calls, "events": run.events, "losses": run.losses}
    stats |= {"seconds": time.perf_counter() - started, "dofs": len(machine.dofs)}
    return Response(machine, at, np.concatenate(states), np.eye(2 * len(machine.dofs)), stats)


class _Run:
    """One run: the scaled equations of motion, the flanks in touch, and what was counted."""

    def __init__(self, machine, duration, count, state, method, rtol, start):
        self.machine, self.n, self.law = machine, len(machine.dofs), machine.law
        self.flat = excitation.flatten(machine, start + np.linspace(0.0, duration, 20 * count + 1))
        highest = machine.fastest * max((abs(m.frequency) for m in machine.meshes), default=0.0)
        unit = max(2 * math.pi * highest, 1.0)  # velocities of the size of the displacements
        self.scale = scale = np.concatenate([np.sqrt(machine.mass) * unit, np.sqrt(machine.mass)])
        rest = machine.rest()
        size = np.abs(scale * np.concatenate([rest, 0 * rest])).max() or np.abs(scale * state).max() or 1.0
        self.options = {"method": method, "rtol": rtol, "atol": 1e-3 * rtol * size}
        self.options["max_step"] = 1 / (8 * highest) if highest else np.inf
        self.opens = np.flatnonzero(self.law["backlash"] > 0)
        self.tiny, self.calls, self.events, self.losses = TOGETHER * duration, 0, 0, 0
        self.side = sides(self.compression(start, scale * state), self.law)

    def compression(self, t, y):
        """Of all meshes ``(m,)`` [m]."""
        q = (y / self.scale)[: self.n]
        return self.machine.G @ q - excitation.errors(self.flat, np.asarray(t))[0]

    def rate(self, t, y):
        u = y / self.scale
        a = acceleration(self.machine, self.flat, np.asarray(t), u[: self.n], u[self.n :], self.side)
        return self.scale * np.concatenate([u[self.n :], a])

    def between(self, low, high, y, inside):
        """State at `high`, and the states at the times `inside`, where no load bends."""
        found = []
        while low < high:
            watched = [(self._event(i, *exit[:2]), i, exit[2]) for i in self.opens for exit in self._exits(i)]
            wanted = inside[inside > low]
            done = solve_ivp(
                self.rate,
                (low, high),
                y,
                t_eval=np.union1d(wanted, [high]),
                events=[w[0] for w in watched] or None,
                **self.options,
            )
            self.calls += done.nfev
            if not done.success or not all(np.isfinite(part).all() for part in (done.y, *(done.y_events or ())) if np.size(part)):
                reached = done.t[-1] if len(done.t) else low
                raise RuntimeError(f"{self.options['method']} gave up at t = {reached:.4g} s: {done.message}")
            kept = len(done.t) if done.status == 1 else wanted.size  # no array but a list where a change came before any output
            if kept:
                found.append((done.y[:, :kept] / self.scale[:, None]).T)
            if done.status != 1:
                return done.y[:, -1], found
            hit = [j for j, times in enumerate(done.t_events) if times.size]
            low, y = done.t_events[hit[0]][0], done.y_events[hit[0]][0]
            self._change(low, y, {watched[j][1]: watched[j][2] for j in hit})
        return y, found

    def _change(self, t, y, hit):
        """Change the flanks in touch of the meshes `hit`, and of those that would follow at once: halves of one gear do."""
        self.events += 1
        if self.events > EVENTS:
            raise RuntimeError(
                f"contact changed {EVENTS} times up to t = {t:.4g} s: flanks rest on the edge of touching; give a shorter run"
            )
        x, u = self.compression(t, y), y / self.scale
        speed = self.machine.G @ u[self.n :] - excitation.errors(self.flat, np.asarray(t))[1]
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
        """Where the contact a mesh is in ends: compression, direction, and the flank it then touches."""
        side, slack = self.side[i], self.law["backlash"][i]
        if side == 0:
            return (0.0, 1, 1), (-slack, -1, -1)
        return ((0.0 if side > 0 else -slack, -side, 0),)

    def _event(self, i, place, direction):
        def event(t, y):
            return self.compression(t, y)[i] - place

        event.terminal, event.direction = True, float(direction)
        return event

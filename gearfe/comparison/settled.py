"""Simulations of a machine without the free vibrations of its start."""

import math
from dataclasses import replace

import numpy as np

from ..core.steps import part
from ..dynamics.motion.simulate import simulate
from ..dynamics.motion.thinned import REACH

FREE = 1e-3  # part of the initial free vibration that may remain at the start of a record
UNDAMPED = 0.5  # discarded start relative to the duration, if free vibrations are undamped
LONGEST = 20.0  # longest discarded start [s]


def recorded(machine, duration, rate, *, method="fast", start=0.0, progress=None):
    """Simulate a machine, and return the `Response` after the free vibrations of its start have decayed.

    The omitted time is that in which the least damped mode decays to `FREE`, with mean mesh stiffnesses. The fast integrator
    computes it. The run begins before and ends after the returned samples, because its filter and the transfer paths of its
    sensors need that time. ``stats["settled"]`` is the omitted time [s], and ``stats["free"]`` the remaining part of that
    mode. It is above `FREE` if the decay takes longer than `LONGEST`, or if nothing is damped.

    `duration` [s] and `rate` [Hz] describe the returned samples. The machine starts at the time `start` [s], which sets the
    position of its damaged tooth.
    """
    margin, (settle, decay) = REACH / rate, settling(machine, duration)
    settle = max(settle, 2 * margin)
    rings = math.ceil(min(max((one.ringing for one in machine.sensors.values()), default=0.0), LONGEST) * rate)
    before, whole = settle - margin, settle + duration + margin + rings / rate
    with part("", 0.0, before / whole):
        first = simulate(machine, before, rate=1 / before, start=start, filtered=False, progress=progress)
    last, options = (first.q[-1], first.v[-1]), {"method": method, "start": start + before, "progress": progress}
    with part("", before / whole, 1.0):
        out = simulate(machine, duration + 2 * margin + rings / rate, rate=rate, initial=last, **options).with_heard()
    stats = {"settled": settle, "free": math.exp(-decay * settle), "seconds": first.stats["seconds"] + out.stats["seconds"]}
    return replace(out.part(slice(REACH + rings, -REACH)), stats=out.stats | stats)


def settling(machine, duration):
    """Return the time in which the free vibrations decay to `FREE` [s], and the slowest rate of decay [1/s].

    The time is a part of `duration` if nothing is damped.
    """
    decay = slowest_decay(machine)
    return min(-math.log(FREE) / decay, LONGEST) if decay else UNDAMPED * duration, decay


def slowest_decay(machine):
    """Decay rate of the least damped vibration of a machine with mean mesh stiffness [1/s], or 0 if it does not decay."""
    n = len(machine.dofs)
    K, C, _, _ = machine.linear(machine.working())
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-K / machine.mass[:, None], -C / machine.mass[:, None]]])
    values = np.linalg.eigvals(A)
    slow = 1e-6 * np.abs(values).max()  # The zero-frequency part is rigid rotation, not vibration.
    decays = -values.real[values.imag > slow]
    return float(max(decays.min(), 0.0)) if decays.size and decays.min() > 1e-9 * np.abs(values).max() else 0.0

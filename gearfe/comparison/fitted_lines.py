"""Lines of a record and of a machine that `gearfe.comparison.machine_fit` compares."""

import math

import numpy as np
from scipy.special import chdtri

from ..dynamics.motion.heard import gain
from ..dynamics.motion.steady import common_period, steady_state
from ..signal.known_lines import fine_amplitudes, line_amplitudes, noise_amplitudes
from .settled import recorded

BAND = 0.4  # lines above this part of the sampling rate are not used
APART = 4.0  # smallest distance between two lines that a Hann window resolves [1 / duration]
SHORT = 4  # longest common period for a direct periodic solution [mesh cycles]
CLEAR = 3.0  # least ratio of the summed lines to the noise that a fit requires
PARTS = 8  # equal parts of a record, whose lines are compared with those of its second half
RARE = 1e-3  # probability that noise alone makes a part differ
OFF = 0.02  # relative speed difference within which another record speed is searched


def resolved_lines(machine, record, harmonics):
    """Mesh lines [Hz] of a machine that the record resolves. Raises ValueError if the record has another speed."""
    meshes = {abs(mesh.frequency) for mesh in machine.meshes if mesh.frequency}
    every = sorted(n * mesh for mesh in meshes for n in range(1, harmonics + 1) if n * mesh < BAND * record.rate)
    least = APART / record.duration
    lines = np.array([one for one, before in zip(every, [0.0, *every], strict=False) if one - before > least])
    speeds = 1 + np.arange(-OFF, OFF, 0.25 / (record.duration * max(lines.max(initial=0.0), 1.0)))
    found = np.sum(fine_amplitudes(record, np.outer([1.0, *speeds], lines)) ** 2, axis=1)
    if not found.max() > CLEAR**2 * float(np.sum(noise_amplitudes(record, lines) ** 2)):
        raise ValueError("the record shows no mesh lines above its noise: give a longer record of this channel and speed")
    if found[0] < found.max() / 2:
        raise ValueError(
            f"the mesh lines of the record are those of {speeds[int(np.argmax(found[1:]))]:.5f} times the speed of the scene: "
            "give the scene the speed of the record"
        )
    return lines


def steady_part(record, frequency):
    """Return the record without the parts of its first half whose line amplitudes differ from those of its second half.

    The differences are compared with the noise, or with the scatter of the parts of the second half if it is larger.
    """
    size = record.values.size // PARTS
    parts = [record.part(i * size, (i + 1) * size) for i in range(PARTS)]
    gaps = np.diff(frequency, prepend=0.0, append=math.inf)
    clear = frequency[np.minimum(gaps[:-1], gaps[1:]) > APART / parts[0].duration]
    if not clear.size:  # the parts are too short to separate lines
        return record
    sizes = np.abs([line_amplitudes(part, clear) for part in parts])
    late = sizes[PARTS // 2 :]
    noise = np.mean([noise_amplitudes(part, clear) for part in parts[PARTS // 2 :]], axis=0)
    spread = np.maximum(noise, late.std(axis=0, ddof=1)) * math.sqrt(1 + 1 / len(late))
    away = np.sum(((sizes[: PARTS // 2] - late.mean(axis=0)) / spread) ** 2, axis=1)
    kept = 1 + max(np.flatnonzero(away > chdtri(clear.size, RARE)), default=-1)
    if kept == PARTS // 2:
        raise ValueError(
            f"the mesh lines of the record still change after {kept * size / record.rate:.3g} s: give a longer record at "
            "constant speed and load, without its start"
        )
    return record.part(kept * size, record.values.size) if kept else record


def machine_lines(machine, channel, frequency):
    """Complex amplitudes of the lines of a machine, from its periodic motion, or from a simulation of long periods."""
    sensor = machine.sensors.get(channel.removeprefix("sensor "))
    if sensor is not None and not sensor.housing:
        weights = sensor.weights or [1.0] * len(sensor.channels)
        of_channels = zip(weights, sensor.channels, strict=True)
        return gain(sensor, frequency) * sum(weight * machine_lines(machine, one, frequency) for weight, one in of_channels)
    period = common_period(machine)
    if sensor is None and period * max(abs(mesh.frequency) for mesh in machine.meshes) < SHORT:
        found = steady_state(machine, period=period).response
        return line_amplitudes(found.part(slice(None, -1)).signal(channel), frequency, np.ones)
    apart = np.diff(frequency, prepend=0.0).min()
    run = recorded(machine, 2 * APART / apart, 1.5 * float(frequency.max()) / BAND)
    return line_amplitudes(run.signal(channel), frequency)

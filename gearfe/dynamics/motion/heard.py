"""Signals of the sensors of a machine, computed from a response."""

import re

import numpy as np

from ...signal.series import Signal
from .transfer_path import gain_of_modes, interpolated, through_frf, through_modes


def heard(response, sensor, name):
    """Return the `Signal` of a `Sensor`. Modes start from rest. A measured path is applied to a periodic record."""
    if sensor.housing:
        values = ring_force(response, sensor.housing, sensor.angle)
    else:
        weights = sensor.weights or [1.0] * len(sensor.channels)
        values = sum(weight * response[one] for weight, one in zip(weights, sensor.channels, strict=True))
    force = Signal(values, 1 / float(response.time[1] - response.time[0]), input_unit(response, sensor), name)
    if sensor.frf is not None:
        return through_frf(force, *sensor.frf, sensor.unit)
    return through_modes(force, sensor.modes) if sensor.modes else force


def gain(sensor, frequency):
    """Complex gain of the transfer path of a `Sensor` at frequencies [Hz], 1 without a path."""
    if sensor.frf is not None:
        return interpolated(frequency, *map(np.asarray, sensor.frf))
    return gain_of_modes(frequency, sensor.modes)


def input_unit(response, sensor):
    """Return the unit of the channels of a sensor.

    ValueError if they have different units, or a transfer path does not start at a force.
    """
    units = {response.unit(one) for one in sensor.channels} or {_passing(response.machine, sensor.housing) and "N"}
    if len(units) > 1:
        raise ValueError(f"a sensor adds channels of different units, {', '.join(sorted(units))}: give channels of one unit")
    (unit,) = units
    if unit != "N" and (sensor.modes or sensor.frf is not None):
        raise ValueError(f"a transfer path starts at a force, but {sensor.channels[0]!r} is in {unit}: give a channel in N")
    return unit


def unit_of(response, sensor):
    """Return the unit of the signal of a sensor."""
    unit = input_unit(response, sensor)
    return sensor.unit if sensor.frf is not None else "m/s^2" if sensor.modes else unit


def ring_force(response, kind, sensor=0.0, planet_angles=None, carrier=None, window=None):
    """Force [N] at a fixed sensor of the meshes ``kind1``, ``kind2``, ... of the planets that pass it, see `housing_signal`."""
    machine = response.machine
    passing = _passing(machine, kind)
    if carrier is None:
        carrier = _noted(machine, "carrier frequency [Hz]", kind)
        if carrier is None:
            raise ValueError(f"the machine's notes have no 'carrier frequency [Hz]' of {kind!r}: give carrier")
    count = 1 + max(planet for _, planet in passing)
    spacing = np.radians(_noted(machine, "planet spacing [deg]", kind) or 360 / count)
    angles = spacing * np.arange(count) if planet_angles is None else np.asarray(planet_angles, dtype=float)
    if len(angles) < count:
        raise ValueError(f"planet_angles has {len(angles)} angles, but there are {count} planets")
    time = response.time
    turned = 2 * np.pi * carrier * machine.turned(time) - sensor
    weigh = _raised if window is None else window
    heights = [np.asarray(weigh(angles[planet] + turned)) * response[f"force {name}"] for name, planet in passing]
    return np.sum(heights, axis=0)


def _noted(machine, name, kind):
    """Return a note of the machine. If the note is by pair, return the value for the pair `kind`."""
    value = machine.notes.get(name)
    return value.get(kind) if isinstance(value, dict) else value


def _passing(machine, kind):
    """Return the meshes called `kind` and a number, and the number of their planet, counted from 0."""
    named = [(mesh.name, re.fullmatch(re.escape(kind) + r"(\d+)[LR]?", mesh.name)) for mesh in machine.meshes]
    found = [(name, int(match[1]) - 1) for name, match in named if match]
    if not found:
        raise ValueError(
            f"no mesh has a name such as {f'{kind}1'!r}; there are {', '.join(mesh.name for mesh in machine.meshes)}"
        )
    return found


def _raised(angle):
    return (1 + np.cos(angle)) / 2

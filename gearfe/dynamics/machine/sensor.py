"""`Sensor`: channels of a machine, or planets that pass a fixed point, with a transfer path."""

import math
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ...core.record import ranged
from .tables import Machine

RUNG = math.log(1000.0)  # time constants in which a mode falls to a thousandth


@dataclass(frozen=True, slots=True)
class Sensor:
    """Sensor of a machine: a weighted sum of channels, through a transfer path to its place.

    Attributes
    ----------
    channels : tuple of str
        Channels of the response, such as ``"spring bearing idler2 x"``.
    weights : tuple of float, optional
        Factor of each channel, default 1.
    modes : tuple of (float, float, float)
        Natural frequency [Hz], damping ratio and modal mass [kg] of each mode of the transfer path (`gearfe.through_modes`).
    frf : (ndarray, ndarray), optional
        Measured frequency response function: rising frequencies [Hz], and complex values in `unit` per N (`gearfe.through_frf`).
    unit : str
        Unit of the signal after a measured path.
    housing : str
        Instead of channels: meshes that a sensor at a fixed point measures (`gearfe.housing_signal`), such as ``"planet_ring"``.
    angle : float
        Angle of this point [rad].
    """

    channels: tuple[str, ...] = ()
    weights: tuple[float, ...] = ()
    modes: tuple[tuple[float, float, float], ...] = ()
    frf: tuple[ArrayLike, ArrayLike] | None = None
    unit: str = "m/s^2"
    housing: str = ""
    angle: float = 0.0
    ringing: float = field(init=False)  # time in which the free response of the path dies out [s]

    def __post_init__(self) -> None:
        """Raise ValueError unless there are channels or a housing, a weight for each channel, and at most one valid path."""
        if bool(self.channels) == bool(self.housing):
            raise ValueError("sensor: give channels or housing, one of them")
        if inner := [one for one in self.channels if one.startswith("sensor ")]:
            raise ValueError(f"sensor: channels = {inner[0]!r}, but a sensor receives channels of the machine only")
        if self.weights and len(self.weights) != len(self.channels):
            raise ValueError(f"sensor: weights = {self.weights}, but give {len(self.channels)} numbers, one for each channel")
        if self.modes and self.frf is not None:
            raise ValueError("sensor: give modes or frf as transfer path, not both")
        ringing = _ringing_of_modes(self.modes) if self.frf is None else _length_of_measurement(*self.frf)
        object.__setattr__(self, "ringing", ringing)


def _ringing_of_modes(modes):
    """Return the time [s] in which the slowest mode of a path decays. Raises ValueError for an invalid mode."""
    for frequency, ratio, mass in modes:
        ranged("sensor: frequency of a mode", frequency, " Hz", above=0.0)
        ranged("sensor: mass of a mode", mass, " kg", above=0.0)
        if not 0 < ratio < 1:
            raise ValueError(f"sensor: damping ratio of a mode = {ratio}, but give a number between 0 and 1")
    return max((RUNG / (2 * math.pi * f * zeta) for f, zeta, _ in modes), default=0.0)


def _length_of_measurement(frequency, values):
    """Return the length [s] of the record of a measured path. Raises ValueError for invalid frequencies."""
    at, values = np.asarray(frequency), np.asarray(values)
    if at.ndim != 1 or at.shape != values.shape or at.size < 2 or not (np.diff(at) > 0).all():
        raise ValueError("sensor: frf needs as many values as rising frequencies [Hz], two or more")
    return 1 / float(np.diff(at).min())


def with_sensors(scene: Any, machine: Machine) -> Machine:
    """Return the machine with the sensors of its scene."""
    return replace(machine, sensors={name: _sensor(scene, name, row) for name, row in scene.sensors.items()})


def _sensor(scene, name, row):
    counts = {len(row[key] or ()) for key in ("modes_Hz", "modes_ratio", "modes_kg")}
    spots = {len(row[key] or ()) for key in ("frf_Hz", "frf_real", "frf_imag")}
    if max(len(counts), len(spots)) > 1:
        raise ValueError(f"{scene.name}.toml [sensor.{name}]: give as many entries in each list of its modes, or of its frf")
    path = row["frf_Hz"] and (np.array(row["frf_Hz"]), np.array(row["frf_real"]) + 1j * np.array(row["frf_imag"]))
    modes = tuple(zip(*(row[key] or () for key in ("modes_Hz", "modes_ratio", "modes_kg")), strict=True))
    try:
        return Sensor(
            tuple(row["channels"] or ()), tuple(row["weights"] or ()), modes, path or None, row["frf_unit"],
            row["housing"] or "", math.radians(row["angle_deg"]),
        )  # fmt: skip
    except ValueError as error:
        raise ValueError(f"{scene.name}.toml [sensor.{name}]: {str(error).removeprefix('sensor: ')}") from error

"""Campbell diagram: natural frequencies and excitation orders of meshes and shafts over the speed, and their crossings."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ...core.checks import numbers, whole
from ...core.record import ranged
from ...core.steps import steps
from ...geometry.aliases import Floats
from .modes import natural_frequencies
from .tables import Machine

MOST_HARMONICS = 1000  # limit of the harmonics of a mesh
FASTEST = 50.0  # limit of the relative speed, because a larger number is probably in rpm


class Crossing(NamedTuple):
    """Crossing of an order and a natural frequency: `speed` over nominal speed, `frequency` [Hz], mode number from 0."""

    speed: float
    frequency: float
    order: str
    mode: int


@dataclass(frozen=True, slots=True)
class Campbell:
    """Natural frequencies and orders over the speed.

    Attributes
    ----------
    speed : ndarray, shape (s,)
        Speed relative to the speed of the machine.
    natural : ndarray, shape (s, n)
        Natural frequencies [Hz]; 0 for rigid-body modes.
    orders : dict of str to float
        Frequency of each order at the machine's speed [Hz].
    crossings : tuple of Crossing
        Crossings in the order of increasing speed.
    """

    speed: Floats
    natural: Floats
    orders: dict[str, float]
    crossings: tuple[Crossing, ...]


def campbell(machine: Machine, speeds: ArrayLike, *, harmonics: int = 3, orders: Mapping[str, float] | None = None) -> Campbell:
    """Compute the Campbell diagram of a machine.

    The natural frequencies are those of the mean mesh stiffnesses. With a `spin` (of the carrier) or with `rotors` they depend on
    the speed. Values between the given speeds are linear.

    Parameters
    ----------
    machine : Machine
    speeds : array_like, shape (s,)
        Speeds over that of the machine, rising, two or more.
    harmonics : int
        Number of harmonics of the mesh frequencies.
    orders : dict of str to float, optional
        Additional user-defined orders, with their frequencies at the machine's speed [Hz]. Default: meshes with their harmonics,
        and by stage the shaft frequencies of the driving gear, of the gear with a damaged tooth and of the carrier.

    Returns
    -------
    Campbell

    Raises
    ------
    ValueError
        If the speeds do not rise or exceed `FASTEST`, or an order is not positive.

    References
    ----------
    W. Campbell, Trans. ASME 46 (1924) 31-160.

    Examples
    --------
    A mesh of 500 Hz with a natural frequency of 1591.55 Hz is met by the mesh at 3.18 times its speed, by its second harmonic
    at half of that:

    >>> import gearfe as gf
    >>> diagram = campbell(gf.single_mesh(1.0, 1e8, 500.0), [0.5, 4.0], harmonics=2)
    >>> [(crossing.order, round(crossing.speed, 3), round(crossing.frequency, 1)) for crossing in diagram.crossings]
    [('2 mesh', 1.592, 1591.5), ('mesh', 3.183, 1591.5)]
    """
    speed = numbers("speeds", speeds, " over that of the machine")
    if speed.ndim != 1 or speed.size < 2 or not (np.isfinite(speed).all() and (speed >= 0).all() and (np.diff(speed) > 0).all()):
        raise ValueError("speeds: give two or more increasing numbers from 0 on, relative to the nominal speed of the machine")
    if speed[-1] > FASTEST:
        raise ValueError(
            f"speeds up to {speed[-1]:g} times that of the machine: give speeds relative to the nominal one, not in rpm"
        )
    if whole("harmonics", harmonics, 1) > MOST_HARMONICS:
        raise ValueError(f"harmonics = {harmonics}, but give at most {MOST_HARMONICS}")
    named = _orders(machine, harmonics) if orders is None else dict(orders)
    for name, value in named.items():
        ranged(f"order {name}", value, " Hz", above=0.0)
    if machine.spin or machine.rotors:
        natural = np.array([natural_frequencies(_at_speed(machine, factor))[0] for factor in steps(speed)])
    else:
        natural = np.tile(natural_frequencies(machine)[0], (speed.size, 1))
    return Campbell(speed, natural, named, tuple(sorted(_crossings(speed, natural, named))))


def _at_speed(machine, speed):
    """Return the machine with the gyroscopic terms of a relative speed."""
    rotors = {name: speed * velocity for name, velocity in machine.rotors.items()}
    return replace(machine, spin=speed * machine.spin, rotors=rotors)


def _orders(machine, harmonics):
    """Return the excitation orders of a machine: of its stages, or of its meshes if it has no stages."""
    stages = machine.stages
    meshes = {one.name: one.mesh for one in stages} or {one.name: abs(one.frequency) for one in machine.meshes if one.frequency}
    single = len(meshes) == 1
    out = {}
    for name, value in meshes.items():
        mesh = "mesh" if single else f"mesh {name}"
        out |= {f"{k} {mesh}".removeprefix("1 "): k * value for k in range(1, harmonics + 1)}
    for source in stages:
        lines = {"driving gear": source.turning, "damaged tooth": source.fault, "carrier": source.carrier}
        out |= {name if single else f"{name} {source.name}": value for name, value in lines.items() if value}
    # Meshes with the same frequency share one line.
    unique = {round(value, 9): name for name, value in reversed(out.items())}
    return {name: value for name, value in out.items() if name in unique.values()}


def _crossings(speed, natural, orders):
    for name, value in orders.items():
        away = value * speed[:, None] - natural
        for i, mode in np.argwhere((away[:-1] * away[1:] < 0) | (away[1:] == 0)):
            if natural[i : i + 2, mode].min() > 0:
                at = away[i, mode] / (away[i, mode] - away[i + 1, mode])
                place = float(speed[i] + at * (speed[i + 1] - speed[i]))
                yield Crossing(place, value * place, name, int(mode))

"""What a sensor on the housing of a planetary stage receives: the forces of the planets, louder as they pass it."""

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from .series import Signal

if TYPE_CHECKING:
    from ..motion.response import Response


def housing_signal(
    response: "Response",
    *,
    kind: str = "planet_ring",
    sensor: float = 0.0,
    places: Sequence[float] | None = None,
    carrier: float | None = None,
) -> Signal:
    """Sum of the planets' mesh forces, weighted by how near each planet is to a sensor that stands still.

    Simulations are made in the frame of the carrier; a sensor on a fixed ring sees the planets go by. The path from a mesh to
    it is taken as a window over the planet's place, largest at the sensor and zero opposite::

        a(t) = sum over planets p of (1 + cos(phi_p(t))) / 2 F_p(t),   phi_p(t) = places[p] + 2 pi carrier t - sensor

    It brings the lines a carrier turning at `carrier` Hz puts beside those of the forces; their sizes are those of this window,
    not of a housing. With n equal planets in phase, healthy gears keep only multiples of n `carrier` beside the mesh line.

    Parameters
    ----------
    response : gearfe.motion.response.Response
        Response of a machine with one planetary stage.
    kind : str
        Meshes whose forces are heard, one or more to a planet: those named ``kind`` and the number of the planet
        (``planet_ring1``, ``planet_ring1L``...).
    sensor : float
        Angle of the sensor [rad].
    places : sequence of float, optional
        Angles of the planets at time 0 [rad]; default: equally spaced from 0, as all stages of `gearfe.machine` are.
    carrier : float, optional
        Turns of the carrier per second at the machine's nominal speed, counter-clockwise if positive; default: from the
        machine's notes, ``"carrier frequency [Hz]"``.

    Returns
    -------
    Signal
        [N]

    Raises
    ------
    ValueError
        If no mesh has such a name, the carrier's frequency is not known, or `places` are too few.

    References
    ----------
    X. Liang, M. J. Zuo, W. Chen, Dynamics-based vibration signal modeling for tooth fault diagnosis of planetary gearboxes,
    in Fault Diagnosis and Detection, InTech, 2017, doi 10.5772/67529, on windows for the path.
    """
    machine = response.machine
    named = [(one.name, re.fullmatch(re.escape(kind) + r"(\d+)[LR]?", one.name)) for one in machine.meshes]
    heard = [(name, int(found[1]) - 1) for name, found in named if found]
    if not heard:
        raise ValueError(f"no mesh is called {kind!r} and a number; there are {', '.join(one.name for one in machine.meshes)}")
    if carrier is None:
        if "carrier frequency [Hz]" not in machine.notes:
            raise ValueError("the machine's notes have no 'carrier frequency [Hz]': give carrier")
        carrier = machine.notes["carrier frequency [Hz]"]
    count = 1 + max(planet for _, planet in heard)
    angles = 2 * np.pi * np.arange(count) / count if places is None else np.asarray(places, dtype=float)
    if len(angles) < count:
        raise ValueError(f"places has {len(angles)} angles, but there are {count} planets")
    time = response.time
    turned = 2 * np.pi * carrier * machine.turned(time) - sensor
    values = sum((1 + np.cos(angles[planet] + turned)) / 2 * response[f"force {name}"] for name, planet in heard)
    return Signal(values, 1 / float(time[1] - time[0]), "N", f"housing, {kind}")

"""Vibration at a sensor on the housing of a planetary stage: mesh forces with planet-pass modulation (transfer path)."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike

from ...core.record import ranged
from ...geometry.aliases import Floats
from ...geometry.renamed import renamed
from ...signal.series import Signal
from .heard import ring_force
from .response import Response
from .transfer_path import through_modes

LEAST = 1e-15  # lower limit of the ring parameters, because powers of their reciprocals overflow


@renamed(places="planet_angles")
def housing_signal(
    response: Response,
    *,
    kind: str = "planet_ring",
    sensor: float = 0.0,
    planet_angles: Sequence[float] | None = None,
    carrier: float | None = None,
    window: Callable[[Floats], ArrayLike] | None = None,
    modes: Sequence[tuple[float, float, float]] = (),
) -> Signal:
    """Compute the vibration at a fixed sensor: the planets' mesh forces, weighted by a transfer-path window.

    Simulations are in the frame of the carrier, and the planets pass a sensor on a fixed ring. The transfer path from a mesh to
    the sensor is a window w over the planet's angle. The default is largest at the sensor and zero opposite::

        F(t) = sum over planets p of w(phi_p(t)) F_p(t),   phi_p(t) = planet_angles[p] + 2 pi carrier t - sensor,
        w = (1 + cos(phi)) / 2

    The window adds the sidebands of the carrier frequency `carrier` [Hz] to the lines of the forces (planet-pass modulation, see
    `gearfe.stage_lines`). Their amplitudes are those of the window. With `modes` the housing responds to that force, each mode as
    a separate oscillator::

        a(t) = sum over modes of x'',   x'' + 2 zeta (2 pi f) x' + (2 pi f)**2 x = F(t) / mass

    It starts from rest under the first force and is exact for forces that are linear between samples.

    With n equal planets in phase, healthy gears have sidebands at multiples of n `carrier` only.

    Parameters
    ----------
    response : gearfe.dynamics.motion.response.Response
        Response of a machine with planetary stages.
    kind : str
        Meshes whose forces reach the sensor, one or more per planet, named ``kind`` and the number of the planet
        (``planet_ring1``, ``planet_ring1L``...).
    sensor : float
        Angle of the sensor [rad].
    planet_angles : sequence of float, optional
        Angles of the planets at time 0 [rad]; default: equally spaced from 0, as all stages of `gearfe.dynamics.machine` are. The
        note ``"planet spacing [deg]"`` states the sense of their numbers.
    carrier : float, optional
        Carrier frequency at nominal speed [Hz], counter-clockwise if positive; default: from the machine's notes, ``"carrier
        frequency [Hz]"``.
    window : callable, optional
        Weights at an array of angles between planet and sensor [rad]: a measured one, or `gearfe.ring_window`.
    modes : sequence of (float, float, float)
        Natural frequency [Hz], damping ratio and modal mass [kg] of the housing at the sensor; none: the force itself.

    Returns
    -------
    Signal
        Force [N], or acceleration [m/s^2] if there are modes.

    Raises
    ------
    ValueError
        If no mesh has such a name, the carrier's frequency is not known, or `planet_angles` are too few.

    References
    ----------
    X. Liang, M. J. Zuo, W. Chen, Dynamics-based vibration signal modeling for tooth fault diagnosis of planetary gearboxes,
    in Fault Diagnosis and Detection, InTech, 2017, doi 10.5772/67529, on windows for the path.
    """
    values = ring_force(response, kind, sensor, planet_angles, carrier, window)
    rate = 1 / float(response.time[1] - response.time[0])
    if not modes:
        return Signal(values, rate, "N", f"housing, {kind}")
    return through_modes(Signal(values, rate, "N", f"housing, {kind}"), modes)


def ring_window(radius: float, bending: float, foundation: float) -> Callable[[Floats], Floats]:
    """Window for `housing_signal`: deflection of a thin ring on an elastic foundation at the sensor.

    It is the radial displacement at an angle phi from a radial force, relative to that under the force, of an inextensible ring::

        w(phi) = sum over n >= 1 of cos(n phi) / (bending (n**2 - 1)**2 / radius**3 + foundation radius),   over w(0)

    A stiff ring moves as a whole, w = cos(phi). A flexible ring deflects only near the planet.

    Parameters
    ----------
    radius : float
        Of the ring's centre line [m].
    bending : float
        Young's modulus times second moment of area of its section [N m2].
    foundation : float
        Radial stiffness of its support per length [N/m2].

    Returns
    -------
    callable
        Weights at an array of angles [rad].

    Raises
    ------
    ValueError
        If a number is not positive and finite.

    References
    ----------
    By the energy of bending ``EI / (2 R**3) integral of (w + w'')**2``: S. P. Timoshenko, Vibration Problems in Engineering, art.
    on the flexural vibrations of a circular ring.
    """
    for name, value in {"radius": radius, "bending": bending, "foundation": foundation}.items():
        if not LEAST < ranged(name, value, above=0.0) < 1 / LEAST:
            raise ValueError(f"{name} = {value:g}, but give a number between {LEAST:g} and {1 / LEAST:g} in SI units")
    n = np.arange(1, 400)
    share = 1 / (bending * (n**2 - 1.0) ** 2 / radius**3 + foundation * radius)
    share = share / share.sum()
    return lambda angle: np.cos(np.multiply.outer(np.asarray(angle, dtype=float), n)) @ share

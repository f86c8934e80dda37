"""Amplitude and phase modulation of a mesh line over one revolution of the gear, from the sidebands of the line."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.fft import fft, ifft

from ..core.checks import whole
from ..geometry.aliases import Floats
from .given import samples

EMPTY = 1e-9  # A smaller mesh line, relative to the average, is a rounding error.


class Modulation(NamedTuple):
    """Modulation of a mesh line, at equal angles over one revolution.

    Attributes
    ----------
    amplitude : ndarray, shape (n,)
        Amplitude of the line [unit of the average].
    phase : ndarray, shape (n,)
        Phase of the line relative to an undisturbed mesh [rad], with mean 0. It increases where teeth engage early.
    """

    amplitude: Floats
    phase: Floats


def mesh_modulation(average: ArrayLike, teeth: int, *, harmonic: int = 1, sidebands: int | None = None) -> Modulation:
    """Compute amplitude and phase modulation of a mesh line over one revolution of the gear.

    The orders ``harmonic teeth +- sidebands`` of the average form an analytic signal, which is demodulated by the mesh order::

        a(t) exp(i p(t)) = exp(-i m t) sum over |k| <= sidebands of 2 X(m + k) exp(i (m + k) t),   m = harmonic teeth

    A crack of one tooth causes a short dip of the amplitude and a short change of the phase. Run-out causes one wave per
    revolution.

    Parameters
    ----------
    average : ndarray, shape (n,)
        Synchronous average over one turn of the gear's shaft, see `gearfe.synchronous_average`.
    teeth : int
    harmonic : int
        Of the mesh: the strongest shows most.
    sidebands : int, optional
        On each side; default: up to half of the way to the next mesh line, ``(teeth - 1) // 2``.

    Raises
    ------
    ValueError
        If the average is too short for these orders, or has no such mesh line.

    References
    ----------
    P. D. McFadden, J. Vib. Acoust. Stress Reliab. Des. 108(2) (1986) 165-170.

    Examples
    --------
    >>> turn = 2 * np.pi * np.arange(1024) / 1024
    >>> line = mesh_modulation((1 + 0.2 * np.cos(turn)) * np.cos(24 * turn + 0.1 * np.sin(2 * turn)), 24)
    >>> line.amplitude[[0, 512]].round(6).tolist(), line.phase[[0, 128]].round(6).tolist()
    ([1.2, 0.8], [0.0, 0.1])
    """
    x = samples("average", average)
    middle = whole("harmonic", harmonic, 1) * whole("teeth", teeth, 2)
    wide = (teeth - 1) // 2 if sidebands is None else whole("sidebands", sidebands, 1)
    if not wide < middle or middle + wide >= x.size / 2:
        raise ValueError(
            f"orders {middle - wide} to {middle + wide} of the average, but {x.size} samples hold the orders 1 to "
            f"{(x.size - 1) // 2}: take more samples per turn, or fewer sidebands"
        )
    transform = fft(x)
    if not abs(transform[middle]) > EMPTY * x.size * np.abs(x).max():
        raise ValueError(
            f"the average has no mesh line of order {middle}: give the average over one revolution of a gear of {teeth} teeth"
        )
    lines = np.zeros(x.size, dtype=complex)
    orders = np.arange(-wide, wide + 1)
    lines[orders] = 2 * transform[middle + orders]
    modulated = ifft(lines)
    phase = np.unwrap(np.angle(modulated))
    return Modulation(np.abs(modulated), phase - phase.mean())

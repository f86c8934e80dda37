"""Random pitch deviations of the teeth of a gear within an ISO 1328-1 class."""

import math

import numpy as np

from .gear import Gear

CLASSES = range(1, 12)


def pitch_tolerances(gear: Gear, iso_class: int) -> tuple[float, float]:
    """Tolerances of ISO 1328-1:2013 of a single pitch (f_pT) and of the cumulative pitch (F_pT) [mm].

    ``(0.001 d + 0.4 m_n + 5) sqrt(2)**(A - 5)`` and ``(0.002 d + 0.55 sqrt(d) + 0.7 m_n + 12) sqrt(2)**(A - 5)`` um, class A and
    reference diameter d in mm, unrounded. The formulas were not checked with the text of the standard.
    """
    d, step = 2 * gear.r, math.sqrt(2) ** (iso_class - 5)
    single = 0.001 * d + 0.4 * gear.m_n + 5
    return 1e-3 * single * step, 1e-3 * (0.002 * d + 0.55 * math.sqrt(d) + 0.7 * gear.m_n + 12) * step


def random_pitch(gear: Gear, iso_class: int, seed: int) -> tuple[float, ...]:
    """Return random cumulative pitch deviations of a gear at the limit of its class, for ``Flank(pitch=...)``.

    Single deviations are drawn from a normal distribution. Their mean is subtracted, because their sum around the gear is zero.
    They are scaled so that one of the two tolerances (single or cumulative pitch) is reached and the other is satisfied.

    Parameters
    ----------
    gear : Gear
    iso_class : int
        Flank tolerance class of ISO 1328-1, 1 to 11.
    seed : int
        The same seed gives the same gear.

    Returns
    -------
    tuple of float
        One for each tooth, along the reference circle, mean zero [mm].

    Raises
    ------
    ValueError
        If there is no such class, or the seed is no whole number.

    Examples
    --------
    >>> gear = Gear(z=21, m_n=2.0, alpha_n=math.radians(20), b=20.0, r_bore=7.4)
    >>> places = np.array(random_pitch(gear, 6, seed=1))
    >>> single = np.diff(places, append=places[0])
    >>> [round(1e3 * float(value), 2) for value in (abs(single).max(), np.ptp(places))]  # um
    [8.26, 14.75]
    """
    if iso_class not in CLASSES:
        raise ValueError(f"iso_class = {iso_class!r}, but ISO 1328-1 has the classes 1 to 11")
    if seed < 0:
        raise ValueError(f"seed = {seed!r}, but give a whole number from 0 on; equal seeds give equal deviations")
    single = np.random.default_rng(int(seed)).standard_normal(gear.z)
    single -= single.mean()
    places = np.cumsum(single)
    most, total = pitch_tolerances(gear, iso_class)
    places *= min(most / np.abs(single).max(), total / np.ptp(places))
    return tuple((places - places.mean()).tolist())

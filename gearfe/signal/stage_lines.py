"""Sidebands of a planetary stage at a fixed sensor on its ring or housing (planet-pass modulation)."""

import math
from collections.abc import Sequence
from itertools import product

import numpy as np

from ..core.checks import numbers, whole
from .given import hertz

NEAR = 1e-3  # tolerance of whole numbers of teeth
HIGHEST = {"harmonics": 1, "turns": 3, "window": 1}


def stage_lines(
    sun: int,
    ring: int,
    n_planets: int,
    carrier: float,
    *,
    damaged: str | None = None,
    equal: bool = True,
    angles: Sequence[float] | None = None,
    **highest: int,
) -> dict[str, float]:
    """Return the frequencies of a planetary stage with a fixed ring at a fixed sensor.

    Planet p is at the angle ``2 pi (f_c t + p / N)``. A window over that angle (planet pass) modulates its forces, and the
    harmonics j of the window up to `window` shift lines by j f_c. The forces are those of planet 0 with a delay. Multiples n of
    the mesh frequency ``f_m = ring f_c`` have phases ``n ring p / N``. Components at the rotation of the sun relative to the
    carrier, ``f_t = f_m / sun``, are delayed by ``p / (N f_t)``. In the sum over the planets, a line remains only if all phases
    agree::

        n f_m + j f_c           if n ring + j is a multiple of N   (healthy, or a damaged ring: then with j of any size)
        n f_m + q f_t + j f_c   if n ring - q + j is a multiple of N   (a damaged sun tooth)
        n f_m + q f_t + j f_c   all of them   (a damaged tooth of one planet: f_t = f_m / planet)

    For unequal planets all lines of the first row remain. For planets at other `angles` psi_p a line remains unless the sum of
    ``exp(i m psi_p)`` over them is zero. Here m is the number that is a multiple of N above.

    Parameters
    ----------
    sun, ring : int
        Numbers of teeth; the planets have ``(ring - sun) / 2``, or nearly so.
    n_planets : int
    carrier : float
        f_c, turns of the carrier per second [Hz].
    damaged : {"sun", "planet", "ring"}, optional
        Which gear has a damaged tooth.
    equal : bool
        Whether all planets are alike and share the load alike.
    angles : sequence of float, optional
        Angles of the planets [rad], at which they can be assembled; default: equal spacing.
    **highest
        ``harmonics`` (default 1): n goes up to it. ``turns`` (3) of a damaged gear: q goes up to it, j of a damaged ring up to it
        times `n_planets`. ``window`` (1): its highest harmonic, 1 for that of `gearfe.housing_signal`.

    Returns
    -------
    dict of str to float
        ``f_m``, ``f_m + f_c``, ``f_m - 2 f_t + f_c``, ... [Hz], above 0; for `gearfe.find_lines`. Lines of the same frequency are
        named once.

    Raises
    ------
    ValueError
        If a number of teeth or of planets is no whole number from 1 on, the ring has no more teeth than the sun,
        ``(sun + ring) / n_planets`` is not whole, planets cannot be assembled at their `angles`, `carrier` is no positive number
        of Hz, or `damaged` is none of the three gears.
    TypeError
        If `highest` has another name.

    References
    ----------
    P. D. McFadden, J. D. Smith, Proc. Inst. Mech. Eng. C 199 (1985) 65-70; M. Inalpolat, A. Kahraman, J. Sound Vib. 323 (2009)
    677-696, for healthy stages; X. Liang, M. J. Zuo, M. R. Hoseini, Struct. Health Monit. 14 (2015) 488-505, on damaged suns.

    Examples
    --------
    Three planets whose meshes follow each other: of both carrier sidebands one is left, the mesh line itself is gone.

    >>> stage_lines(20, 82, 3, 5.0)
    {'f_m - f_c': 405.0}
    """
    at = _check(sun, ring, n_planets, carrier, damaged, angles)
    if unknown := sorted(set(highest) - set(HIGHEST)):
        raise TypeError(f"stage_lines() has no argument {unknown[0]!r}; it has {', '.join(HIGHEST)}")
    harmonics, turns, window = (whole(name, value, 0, 1000) for name, value in (HIGHEST | highest).items())
    mesh, planet = ring * carrier, round((ring - sun) / 2)
    turn = {"sun": mesh / sun, "planet": mesh / planet}.get(damaged or "", 0.0)
    reach, spread = (turns, window) if turn else (0, turns * n_planets if damaged == "ring" else window)
    steps = (range(-most, most + 1) for most in (reach, spread))
    rows = sorted(product(range(harmonics + 1), *steps), key=lambda row: (sum(map(bool, row)), sum(map(abs, row))))
    n, q, j = np.array(rows).T
    around = n * ring - (q if damaged == "sun" else 0) + j
    agree = np.abs(np.exp(2j * math.pi * np.multiply.outer(around, at)).mean(axis=1)) > NEAR
    free = np.full(n.size, damaged == "planet") if equal else (damaged in ("planet", "sun")) | (q == 0)
    values = n * mesh + q * turn + j * carrier
    lines: dict[str, float] = {}
    for k in np.flatnonzero((values > 1e-9 * mesh) & (agree | free)).tolist():
        if not any(math.isclose(values[k], other) for other in lines.values()):
            lines[_named(*rows[k])] = float(values[k])
    return dict(sorted(lines.items(), key=lambda item: item[1]))


def _check(sun, ring, n_planets, carrier, damaged, angles):
    """Check the arguments, and return the angles of the planets as parts of a revolution."""
    for name, value in {"sun": sun, "ring": ring, "n_planets": n_planets}.items():
        whole(name, value, 1)
    if ring <= sun:
        raise ValueError(f"ring = {ring}, sun = {sun}: a ring has more teeth than its sun")
    at = np.arange(n_planets) / n_planets if angles is None else numbers("angles", angles, " in rad") / (2 * math.pi)
    if at.shape != (n_planets,):
        raise ValueError(f"angles has {at.size} values, but there are {n_planets} planets: give one for each")
    apart = (sun + ring) * (at - at[0])
    if angles is not None and np.abs(apart - np.round(apart)).max() > NEAR:
        raise ValueError(
            f"angles = {angles}: planets can be assembled where ({sun} + {ring}) angle / (2 pi) is whole, counted from "
            "the first; angles are radians"
        )
    if angles is None and (sun + ring) % n_planets:
        raise ValueError(
            f"{n_planets} equally spaced planets cannot be assembled: ({sun} + {ring}) / {n_planets} is not whole; give angles"
        )
    hertz("carrier", carrier)
    if damaged not in (None, "sun", "planet", "ring"):
        raise ValueError(f"damaged = {damaged!r}, but it must be 'sun', 'planet' or 'ring'")
    return at


def _named(*counts):
    out = ""
    for count, name in zip(counts, ("f_m", "f_t", "f_c"), strict=True):
        if count:
            size = name if abs(count) == 1 else f"{abs(count)} {name}"
            out += (f" {'+' if count > 0 else '-'} " if out else "-" * (count < 0)) + size
    return out

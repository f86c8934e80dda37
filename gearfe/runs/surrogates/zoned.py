"""Stiffness curve by zones of the mesh cycle. The ends of the zones depend on the contact ratio and the load.

A pair enters at a whole phase n and leaves at ``n + eps_alpha``. Under load its tip corner touches somewhat earlier and loses
contact somewhat later. There k has kinks. Polynomials over the phase, or over the gears at a fixed phase, represent them badly.
Between these *breaks* k is smooth. Each piece is a polynomial in a separate coordinate, and the breaks are separate numbers.
"""

import math
from collections.abc import Callable

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from ...geometry.aliases import Floats
from ...stiffness.curve import StiffnessCurve

DEGREE = 8  # degree of the polynomial of a piece: curves of 21/31 pairs are then off by 0.005 % on average
ROUND = 0.05  # End part of the zone with more pairs that has a separate polynomial, because k has a curved transition there.
SHORTEST = 0.1  # shorter zones are not divided [mesh cycles]
SEARCH = 8  # phases per iteration of the search for a break
ROUNDS = 3
LESS = "give less load or another contact ratio"

Solve = Callable[[Floats], StiffnessCurve]
_NODES = np.cos(np.pi * (np.arange(DEGREE + 1) + 0.5) / (DEGREE + 1))
_TO_SERIES = np.linalg.inv(chebyshev.chebvander(_NODES, DEGREE))


def breaks_of(eps_alpha: float, solve: Solve, *, cracked: bool) -> Floats:
    """Return rising phases ``(m,)``, both ends included, between which k is smooth. `solve` returns the curve at phases.

    For healthy gears they cover a cycle. For `cracked` gears they cover the engagement of tooth 0, from the middle of the zone
    with fewer pairs before it to the middle of the one after it. ValueError if a zone, with or without load, is too short to
    be separated from its neighbours.
    """
    low = math.floor(eps_alpha)
    more = eps_alpha - low
    if not SHORTEST <= more <= 1 - SHORTEST:
        raise ValueError(
            f"contact ratio {eps_alpha:.4g}: a zone of the mesh cycle is shorter than {SHORTEST:g}; give ranges in which it "
            f"stays between {low + SHORTEST:g} and {low + 1 - SHORTEST:g}"
        )
    half = (1 - more) / 2
    cycles = range(low + 1) if cracked else range(1)
    enter = [(float(n), -1, -n) for n in cycles]
    leave = [(more + n, 1, low - n) for n in cycles]
    outer = _outermost([*enter, *leave], half, solve)
    inner = [n + ROUND * more for n, _, _ in enter] + [n - ROUND * more for n, _, _ in leave]
    ends = [-half, low + more + half] if cracked else [-half, more + half]
    out = np.array(sorted([*ends, *inner, *outer, *(n for n, _, _ in (*enter, *leave))]))
    if not (np.diff(out) > 1e-6).all():
        raise ValueError(f"two zones of the mesh cycle meet at contact ratio {eps_alpha:.4g} under this load: {LESS}")
    return out


def _outermost(events, half, solve):
    """Return the phases before nominal entry (-1) or after nominal exit (1) at which contact under load begins or ends."""
    spans = [(nominal, nominal + side * half) for nominal, side, _ in events]
    last = []
    for _ in range(ROUNDS):
        phase = np.concatenate([np.linspace(*span, SEARCH) for span in spans])
        curve, last = solve(phase), []
        for i, (_, _, order) in enumerate(events):
            rows = slice(i * SEARCH, (i + 1) * SEARCH)
            column = np.flatnonzero(curve.order == order)
            force = curve.force[rows, column[0]] if column.size else np.zeros(SEARCH)
            if force.all():
                raise ValueError(f"the zone of fewer pairs vanishes under this load: {LESS}")
            free = int(np.argmin(force > 0))
            k, before = max(free - 1, 0), max(free - 2, 0)
            last.append((phase[rows][k], phase[rows][free], phase[rows][before], force[k], force[before]))
        spans = [(touching, open_) for touching, open_, *_ in last]
    return [_vanishing(*touch) for touch in last]


def _vanishing(touching, open_, before, force, force_before):
    """Return the zero of the force, extrapolated from its last two values, between the last touch and the first gap."""
    if not force_before > force > 0:
        return touching
    place = touching + (touching - before) * force / (force_before - force)
    return float(np.clip(place, *sorted((touching, open_))))


def phases_of(breaks: Floats) -> Floats:
    """Phases ``(pieces * (DEGREE + 1),)`` at which k is needed: Chebyshev's nodes of each piece."""
    low, high = breaks[:-1, None], breaks[1:, None]
    return ((low + high) / 2 + (high - low) / 2 * _NODES).ravel()


def series_of(values: Floats) -> Floats:
    """Return Chebyshev coefficients ``(pieces, DEGREE + 1)`` from values at `phases_of`."""
    return values.reshape(-1, DEGREE + 1) @ _TO_SERIES.T


def at(phase: Floats, breaks: Floats, series: Floats) -> Floats:
    """Return values at phases within the breaks."""
    piece = piece_of(phase, breaks)
    low, high = breaks[piece], breaks[piece + 1]
    u = np.clip((2 * phase - low - high) / (high - low), -1.0, 1.0)
    return np.asarray(chebyshev.chebval(u, series[piece].T, tensor=False), dtype=float)


def piece_of(phase: Floats, breaks: Floats) -> NDArray[np.int64]:
    """Return the index of the piece of the mesh cycle, between two of `breaks`, that contains each phase."""
    return np.clip(np.searchsorted(breaks, phase, side="right") - 1, 0, breaks.size - 2)

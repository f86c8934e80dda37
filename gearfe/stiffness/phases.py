"""Phases of a curve in the mesh cycle, given as a list or as a number over a span."""

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from ..core.checks import numbers, one_of
from ..geometry.aliases import Floats
from ..geometry.pair.gear_pair import GearPair
from .limits import check_count, check_range
from .turns import check_length, cycles_in

SPANS = ("cycle", "tooth", "revolution", "hunting")
LONG = SPANS[2:]  # spans of several cycles


def check_phases(phases: Any) -> int | Floats:
    """Return a number of phases, or an array ``(n,)`` of finite phases. Raises ValueError for other arguments."""
    if np.ndim(phases) == 0:
        return check_count(phases)
    out = numbers("phases", phases, "")
    if out.ndim != 1 or out.size == 0 or not np.isfinite(out).all():
        raise ValueError("phases: give the number of phases, or a list of at least one finite phase in mesh cycles")
    return out


def phase_array(phases: Any, span: str, pair: GearPair, overlap: float = 0.0, teeth: Iterable[int] = (0,)) -> Floats:
    """Return given phases, or a number of phases over a `span` ``(n,)``.

    Those of the `span` ``tooth`` are of the engagements of all tooth pairs of these numbers.
    """
    one_of("span", span, SPANS)
    if np.ndim(phases) == 0:
        phases = check_count(phases)
        if span == "tooth":
            one = np.arange(math.floor(-0.25 * phases), math.ceil((pair.eps_alpha + overlap + 0.25) * phases) + 1)
            return np.asarray(np.unique([one - tooth * phases for tooth in teeth]) / phases, dtype=np.float64)
        check_length(pair, span, phases)
        return np.arange(phases * cycles_in(pair, span)) / phases
    if span in LONG:
        raise ValueError(f"span = {span!r} with a list of phases: give the number of phases per mesh cycle")
    phases = check_phases(phases)
    check_range(phases, pair.eps_alpha + overlap)
    return phases

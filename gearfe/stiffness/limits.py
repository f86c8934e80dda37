"""Limits of arguments, with reasons: value types, resolution, number and range of phases, memory."""

import math
from numbers import Integral
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.checks import is_number
from ..core.memory import free_memory

MOST_PHASES = 100_000  # limit of phases per cycle: between two adjacent ones k changes by less than 1e-4, even where teeth enter
FURTHEST = 1e6  # largest phase [mesh cycles]; beyond it, rounding moves contacts by more than 1e-10 pitches
SECTION = (9_000, 4_200, 3_700)  # unknowns of a whole section of 20 to 30 teeth by powers of refine, measured at 1, 2, 4 and 8
SECTION_BYTES = (3500.0, 400.0)  # memory of the solve per unknown by powers of refine [bytes], measured at 1, 4 and 8


def check_count(phases: Any) -> int:
    """Return a number of phases as an int. Raises ValueError unless it is whole and from 1 to `MOST_PHASES`."""
    if not is_number(phases) or not math.isfinite(phases) or phases != int(phases) or phases < 1:
        raise ValueError(f"phases = {phases!r}, but give a number of phases >= 1, or an array of phases")
    if phases > MOST_PHASES:
        raise ValueError(f"phases = {phases:g}, but give at most {MOST_PHASES}: a few hundred are sufficient")
    return int(phases)


def check_range(phases: NDArray, pairs: float) -> None:
    """Raise ValueError for phases beyond rounding accuracy, or over more cycles than fit into memory.

    `phases` ``(n,)``; `pairs` is the contact ratio, the mean number of pairs in contact.
    """
    far = float(np.abs(phases).max())
    if far > FURTHEST:
        raise ValueError(
            f"phases up to {far:g}, but give phases within {FURTHEST:g} cycles, where rounding does not move contacts; healthy "
            "gears repeat after 1"
        )
    orders = float(np.ptp(phases)) + pairs + 3
    # every pair with every other at every phase, in four arrays of floats
    memory, free = 32.0 * phases.size * orders**2, free_memory()
    if memory > free / 2:
        raise ValueError(
            f"{phases.size} phases over {np.ptp(phases):.6g} cycles need about {memory / 1e9:.3g} GB, but {free / 1e9:.3g} GB "
            "are free: give fewer cycles at once"
        )


def section_size(refine: float) -> tuple[float, float]:
    """Return the expected unknowns and memory [bytes] of a finite element section of 20 to 30 teeth."""
    unknowns = sum(factor * refine**power for power, factor in enumerate(SECTION))
    return unknowns, unknowns * sum(factor * refine**power for power, factor in enumerate(SECTION_BYTES))


def check_section(refine: float) -> None:
    """Raise RuntimeError for a finite element section that does not fit into memory, before it is meshed."""
    unknowns, memory = section_size(refine)
    free = free_memory()
    if memory > free:
        raise RuntimeError(
            f"refine = {refine:g}: about {unknowns:.3g} unknowns a section, which need about {memory / 1e9:.3g} GB, but "
            f"{free / 1e9:.3g} GB are free: give a smaller refine"
        )


def check_teeth(teeth: Any, most: int) -> None:
    """Raise ValueError unless `teeth` is None or a whole number from 1 to `most`, the larger tooth number."""
    if teeth is None:
        return
    if isinstance(teeth, bool) or not (isinstance(teeth, Integral) and int(teeth) >= 1):
        raise ValueError(f"teeth = {teeth!r}, but give a whole number of teeth >= 1, or None for all")
    if int(teeth) > most:
        raise ValueError(f"teeth = {teeth}, but the gears have no more than {most}: give fewer, or None for all")

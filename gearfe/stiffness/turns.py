"""Curves over many mesh cycles (a revolution, or the hunting period). Equal cycles are solved once."""

import math
from dataclasses import replace

import numpy as np

from ..flexibility.section_contact import MARKS
from .curve import joined

LONGEST = {"revolution": "z of the pinion", "hunting": "the least common multiple of both numbers of teeth"}
MOST = 2e7  # largest number of stored forces by phase and tooth pair (160 MB)


def cycles_in(pair, span):
    """Return the mesh cycles of a `span`: a revolution of the pinion, or the time until the same teeth meet again."""
    z_1, z_2 = pair.gear_1.z, pair.gear_2.z
    return {"revolution": z_1, "hunting": math.lcm(z_1, z_2)}.get(span, 1)


def check_length(pair, span, phases):
    """Raise ValueError for a span with more values than `MOST`, before anything is solved."""
    cycles = cycles_in(pair, span)
    if cycles > 1 and cycles * phases * (cycles + pair.eps_alpha) > MOST:
        fewer = int(MOST / cycles / (cycles + pair.eps_alpha))
        instead = f"at most {fewer} phases in each cycle" if fewer else "span = 'revolution'"
        raise ValueError(
            f"span = {span!r} of {pair.gear_1.z} and {pair.gear_2.z} teeth has {cycles} mesh cycles ({LONGEST[span]}), but "
            f"{cycles * phases} phases with {cycles} tooth pairs exceed the largest size of a curve: give {instead}, or a list "
            "of the phases you need"
        )


def over_turns(solve, phase, pair, span, differs):
    """Return curves over a `span` of many cycles, one per load.

    In cycle c, tooth c of pinion and wheel enter the mesh. Cycles differ only by the teeth of gears with deviating teeth.
    Equal cycles are therefore solved once.

    `solve` maps the phases ``(n,)`` of one cycle to a list of `StiffnessCurve`, one for each load. `phase` are those of all
    cycles. `differs` (bool, bool) states for pinion and wheel whether their teeth differ from each other.
    """
    parts = np.split(phase, cycles_in(pair, span))
    alike = math.lcm(*(gear.z for gear, apart in zip(pair.gears, differs, strict=True) if apart))
    solved = [solve(part) for part in parts[:alike]]
    turns = [[_later(curve, part, c // alike * alike) for curve in solved[c % alike]] for c, part in enumerate(parts)]
    return [joined(curves) for curves in zip(*turns, strict=True)]


def _later(curve, phase, cycles):
    """Return the same curve a number of mesh `cycles` later, with tooth pair numbers lowered by this number."""
    if not cycles:
        return curve
    meta = curve.meta | {name: [at + cycles for at in curve.meta[name]] for name in MARKS if name in curve.meta}
    return replace(curve, phase=phase, order=curve.order - cycles, meta=meta)

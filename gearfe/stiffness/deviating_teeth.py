"""Teeth of a pair that differ from the others: which, and the mesh cycles in which they or their neighbours are in mesh."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..core.case import Case
from ..core.case_parts import SIDES
from ..flexibility.plane import FURTHER
from ..geometry.pair.contacts import neighbours_of
from ..geometry.tooth.gear import Gear
from ..geometry.tooth.modified import Flank

MARGIN = 0.25  # range before and after the path of contact in which corners touch [mesh cycles]
MOST = 1_000_000  # largest number of phases in a hunting period whose cycles all differ
NAMES = tuple(name for name, _ in SIDES)


class Window(NamedTuple):
    """Samples ``start <= i < stop`` of a gear's revolution in which `teeth` of it, or their neighbours, are in mesh."""

    start: int
    stop: int
    teeth: tuple[int, ...]
    position: int


def like_all(case: Case, sides: Sequence[int]) -> Case:
    """Return the case with equal teeth on some gears (0: pinion, 1: wheel): no damage, no deviations between teeth."""
    damage, flanks = dict(case.damage or {}), dict(case.flanks or {})
    for side in sides:
        name = NAMES[side]
        damage.pop(name, None)
        if name in flanks:
            flanks[name] = _plain(flanks[name], case.pair.gears[side])
    return replace(case, damage=damage or None, flanks=flanks or None)


def differing(case: Case, side: int) -> tuple[int, ...]:
    """Return the numbers of the deviating teeth of a gear (0: pinion, 1: wheel)."""
    gear, flank = case.pair.gears[side], (case.flanks or {}).get(NAMES[side])
    teeth = {hurt.tooth % gear.z for hurt in (case.damage or {}).get(NAMES[side], ())}
    if flank is not None and flank.on(gear).differs:
        usual = _plain(flank, gear)
        if flank.eccentricity:
            teeth |= set(range(gear.z))
        for values, common in ((flank.pitch, usual.pitch), (flank.tooth_scale, usual.tooth_scale)):
            teeth |= {tooth for tooth, value in enumerate(values) if value != common[0]}
    return tuple(sorted(teeth))


def renumbered(case: Case, by: int) -> Case:
    """Return the case with renumbered wheel teeth, so that tooth k of the pinion meets the former wheel tooth k - `by`."""
    damage, flanks, z = dict(case.damage or {}), dict(case.flanks or {}), case.pair.gear_2.z
    if "wheel" in damage:
        damage["wheel"] = [replace(hurt, tooth=(hurt.tooth + by) % z) for hurt in damage["wheel"]]
    if "wheel" in flanks:
        flank = flanks["wheel"]
        pitch, scale = (tuple(np.roll(values, by).tolist()) for values in (flank.pitch, flank.tooth_scale))
        flanks["wheel"] = replace(flank, eccentric_tooth=flank.eccentric_tooth + by, pitch=pitch, tooth_scale=scale)
    return replace(case, damage=damage or None, flanks=flanks or None)


def _plain(flank, gear):
    """Return a flank without eccentricity, on which all teeth have the most frequent pitch error and scale."""
    if not flank.on(gear).differs:
        return flank
    pitch = (_commonest(flank.pitch or (0.0,)),) * gear.z
    scale = (_commonest(flank.tooth_scale),) * gear.z if flank.tooth_scale else ()
    return replace(flank, pitch=pitch, tooth_scale=scale, eccentricity=0.0)


def common_profile(flank: Flank, gear: Gear) -> Flank:
    """Return the flank that most teeth of a gear have, without position errors of single teeth."""
    usual = _plain(flank, gear)
    pitch, scale = set(usual.pitch), set(usual.tooth_scale)
    return replace(
        usual, eccentricity=0.0, eccentric_tooth=0.0,
        pitch=() if pitch <= {0.0} else usual.pitch, tooth_scale=() if scale <= {1.0} else usual.tooth_scale,
    )  # fmt: skip


def _commonest(values):
    numbers, counts = np.unique(values, return_counts=True)
    return float(numbers[np.argmax(counts)])


def windows(case, side, n):
    """Return the `Window` of each group of deviating teeth of a gear. Overlapping windows are merged."""
    z, teeth = case.pair.gears[side].z, differing(case, side)
    if not teeth:
        return []
    span = case.pair.eps_alpha + case.overlap()
    # number of teeth before the damaged tooth that its damage affects
    before = math.ceil((neighbours_of(case.pair) + FURTHER + MARGIN) * n)
    length = before + math.ceil(span * n) + before
    entries = sorted(-tooth % z for tooth in teeth)
    breaks = [i for i, entry in enumerate(entries) if (entries[i - len(entries) + 1] - entry - 1) % z * n + n > length]
    if not breaks or length > z * n:
        return [Window(0, z * n, teeth, 0)]
    groups = []
    for last, end in zip((breaks[-1] - len(entries), *breaks[:-1]), breaks, strict=True):
        own = [entries[i] - (z if i < 0 else 0) for i in range(last + 1, end + 1)]
        groups.append(Window(own[0] * n - before, own[-1] * n - before + length, tuple(-e % z for e in own), own[0]))
    return groups


def meetings(case, both, n):
    """Return samples (start, stop) of the hunting period in which deviating teeth of both gears are in mesh together."""
    z_1, z_2 = (gear.z for gear in case.pair.gears)
    cycles = math.lcm(z_1, z_2)
    spans = {span for one in both[0] for two in both[1] for span in _overlaps((one, z_1 * n), (two, z_2 * n), cycles * n)}
    if sum(stop - start for start, stop in spans) > MOST:
        raise ValueError(
            f"teeth of both gears differ, and the same pair of teeth meets every {cycles} mesh cycles, more "
            f"than {MOST:g} phases: give "
            "fewer phases, or deviations of one gear"
        )
    return sorted(spans)


def _overlaps(first, second, size):
    """Return samples (start, stop) of a hunting period of `size` samples in which windows of both gears overlap."""
    (one, turn_1), (two, turn_2) = first, second
    whole_1, whole_2 = (window.stop - window.start == turn for window, turn in (first, second))
    if whole_1 and whole_2:
        return {(0, size)}
    if whole_1 or whole_2:
        window, turn = (two, turn_2) if whole_1 else (one, turn_1)
        return {(at, at + window.stop - window.start) for at in range(window.start, size + window.start, turn)}
    starts = np.arange(one.start, size + one.start, turn_1)
    # time from the start of the first to that of the second, which may have started earlier
    ahead = (two.start - starts) % turn_2
    out = set()
    for start, gap in zip(starts.tolist(), ahead.tolist(), strict=True):
        for begin in (gap, gap - turn_2):
            low, high = max(begin, 0), min(begin + two.stop - two.start, one.stop - one.start)
            if low < high:
                out.add((start + low, start + max(high, low + 2)))
    return out

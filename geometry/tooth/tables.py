"""Checked lists of numbers of a `Flank`."""

from typing import Any

import numpy as np

from ..checks import shown
from .gear import Gear


def numbers(name: str, values: Any) -> list[float]:
    """Return a row of finite numbers as a list. Raises ValueError if something else is given."""
    try:
        out = np.asarray(values, dtype=float)
    except (TypeError, ValueError, OverflowError) as error:
        raise ValueError(f"{name} = {shown(values)}, but give a sequence of numbers [mm]") from error
    if out.ndim != 1 or not np.isfinite(out).all() or np.ma.is_masked(values):
        raise ValueError(f"{name} needs one row of finite numbers [mm], none missing")
    return out.tolist()


def table(name: str, given: Any) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return increasing roll lengths and removed material [mm] of a table. Raises ValueError if the table is invalid."""
    try:
        rolls, amounts = given
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name} needs two rows: roll lengths and the material removed there [mm]") from error
    rolls, amounts = numbers(f"{name}: roll lengths", rolls), numbers(f"{name}: amounts", amounts)
    if len(rolls) != len(amounts) or len(rolls) < 2 or not (np.diff(rolls) > 0).all():
        raise ValueError(
            f"{name} has {len(rolls)} roll lengths and {len(amounts)} amounts: give as many, the roll lengths rising"
        )
    return tuple(rolls), tuple(amounts)


def worn(given: Any) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return wear over roll lengths as a `table` of depths. Raises ValueError for negative wear."""
    rolls, depths = table("wear", given)
    if min(depths) < 0:
        raise ValueError(f"wear: depth {min(depths):g} mm, but wear removes material: give depths of 0 or more")
    return rolls, depths


def each_tooth(name: str, values: tuple[float, ...], gear: Gear) -> np.ndarray:
    """Values by tooth, empty if none are given. Raises ValueError unless there is one for each tooth."""
    if len(values) not in (0, gear.z):
        raise ValueError(f"{name} = {shown(values)}: {len(values)} values, but z = {gear.z}: give one for each tooth")
    return np.array(values)


def covering(values: tuple, gear: Gear) -> np.ndarray:
    """Return a table ``(2, n)`` of roll lengths and amounts [mm]. Raises ValueError unless it covers the flank."""
    rows = np.array(values)
    rolls = rows[0]
    least, most = gear.flank_rolls
    if rolls[0] > least + 1e-6 * gear.m_n or rolls[-1] < most - 1e-6 * gear.m_n:
        raise ValueError(
            f"table from {rolls[0]:.5g} to {rolls[-1]:.5g} mm of roll length does not cover the flank of z = {gear.z}: "
            f"{least:.5g} to {most:.5g} mm"
        )
    return rows

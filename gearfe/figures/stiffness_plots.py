"""Plots (matplotlib) of stiffness curves."""

import math
from collections import Counter
from typing import get_args

import numpy as np

from ..core.files import save_figure
from ..core.units import NEWTON_PER_UM
from ..geometry.damage.kinds import Damage
from .look import SQUASHED, blank, look

UNEVEN = ("pitch", "tooth_scale", "eccentricity")  # flank deviations that differ between teeth


def plot_curves(curves, path=None, title=None):
    """Draw stiffness curves by name over the phase [N/um], and below the load shares of the first curve.

    Save if a `path` is given. Curves differ by colour and by dashes. A jump, where a curve without contact off the path of
    contact gains or loses a pair, is drawn at its phase. The axis of stiffness starts at zero unless the variation would then be
    too small to see. The `title` is by default teeth, damage and load of the first curve, see `told`.
    """
    figure, (top, bottom) = blank((7.5, 5.4), 2, 1, sharex=True, height_ratios=[2, 1])
    for number, (name, curve) in enumerate(curves.items()):
        top.plot(*closed(curve), label=name, linewidth=1.8 if number == 0 else 1.4, **look(number))
    first = next(iter(curves.values()))
    share = np.where(first.force > 0, first.share, np.nan)
    for column, order in enumerate(first.order):
        bottom.plot(first.phase, share[:, column], label=f"pair {order:+d}", **look(column))
    k = np.concatenate([curve.k for curve in curves.values()]) / NEWTON_PER_UM
    if k.min() < SQUASHED * k.max():
        top.set_ylim(0, 1.06 * k.max())
    top.set_title(told(first) if title is None else title, fontsize=10)
    top.set_ylabel("mesh stiffness k [N/µm]")
    top.legend(fontsize=8, loc="center left", bbox_to_anchor=(1, 0.5))
    bottom.set_ylabel(f"load share\n({next(iter(curves))})")
    bottom.set_xlabel("mesh phase (0: a pair enters, 1: one base pitch later)")
    bottom.set_ylim(0, 1.05)
    bottom.legend(fontsize=8, loc="center left", bbox_to_anchor=(1, 0.5))
    return save_figure(figure, path, dpi=120)


def told(curve, *, load=True):
    """Describe a curve in one line from its `meta`: teeth, damage, width and, with `load`, the load."""
    meta = curve.meta
    parts = []
    if "gear_1" in meta and "gear_2" in meta:
        parts.append(f"z = {meta['gear_1']['z']} / {meta['gear_2']['z']}")
    parts += [f"{_named(damages)} of the {side}" for side, damages in meta.get("damage", {}).items() if damages]
    if "force_N" in meta and "width_mm" in meta:
        parts.append(f"{meta['force_N']:g} N on {meta['width_mm']:g} mm" if load else f"{meta['width_mm']:g} mm wide")
    return ", ".join(parts)


def _named(damages):
    """Name the damage of a gear by kind, with the number of several of a kind."""
    count = Counter(one.get("kind", "damage") for one in damages)  # Curves of older files have no kind.
    nouns = {kind._nouns[0]: kind._nouns[1] for kind in get_args(Damage)} | {"damage": "damages"}
    return " and ".join(kind if number == 1 else f"{number} {nouns[kind]}" for kind, number in count.items())


def periodic(curve):
    """Return whether a curve repeats after one mesh cycle, as without damage and with equal teeth."""
    flanks = curve.meta.get("flanks", {}).values()
    return not curve.meta.get("damage") and not any(flank.get(name) for flank in flanks for name in UNEVEN)


def closed(curve):
    """Phases and stiffness [N/um] for drawing: the cycle is closed, and jumps are vertical.

    Returns
    -------
    phase, k : ndarray, shape (m,)
    """
    phase, k, order = curve.phase, curve.k / NEWTON_PER_UM, np.arange(curve.phase.size)
    rises = phase.size > 1 and bool((np.diff(phase) > 0).all())
    if rises and periodic(curve) and phase[-1] < phase[0] + 1 and phase[-1] - phase[0] > 0.75:  # A curve of one cycle is closed.
        phase, order = np.append(phase, phase[0] + 1), np.append(order, 0)
    k = k[order]
    meta = curve.meta
    smooth = meta.get("extended", not np.isfinite(curve.force).all()) or meta.get("face") in ("helical", "herringbone")
    if not rises or smooth or "eps_alpha" not in meta or phase.size < 4:
        return phase, k
    whole = np.arange(math.floor(phase[0]), math.ceil(phase[-1]) + 1)
    places = np.concatenate([whole, whole + meta["eps_alpha"] % 1])  # phases at which a pair enters and a pair leaves
    for place in np.sort(places[(places > phase[0]) & (places <= phase[-1])])[::-1]:
        after = int(np.searchsorted(phase, place - 1e-9))
        if after < phase.size - 1 and abs(phase[after] - place) < 1e-9:  # The stiffness jumps where a pair enters or leaves.
            after += int(place not in whole)
        before = after - 1
        left = _extended(phase, k, (before - 1, before), place)
        right = _extended(phase, k, (after, after + 1), place)
        phase, k = np.insert(phase, after, [place, place]), np.insert(k, after, [left, right])
    return phase, k


def _extended(phase, k, rows, place):
    """Return the value at `place` of the line through two samples. Outside the curve, return the nearest sample."""
    a, b = rows
    if a < 0 or b >= phase.size or phase[a] == phase[b]:
        return k[min(max(a, 0), phase.size - 1)] if a >= 0 else k[b]
    return k[a] + (k[b] - k[a]) / (phase[b] - phase[a]) * (place - phase[a])

"""The volume pits take from a tooth, by an integral that needs no solid."""

import math

import numpy as np

from ..tooth.profile import arc_at, cartesian, flank, flank_normal, roll_at_arc
from .pit import centre_arc, union_length

GRID = 400  # points of the quadrature across a pit


def pit_frame(gear, pit):
    """Of a pit, in the frame that turns: centre, half axes ``(3, 2)``, push to the bottom [mm], normal in the section."""
    roll = math.sqrt(max(pit.radius**2 - gear.r_b**2, 0.0))
    sign = 1 if pit.side == "loaded" else -1
    mirror = np.array([sign, 1.0])
    xy = cartesian(*flank(gear, roll)) * mirror
    across = flank_normal(gear, roll) * mirror
    along = np.array([-across[1], across[0]]) * sign  # towards growing radius
    along *= gear.outward if along @ xy > 0 else -gear.outward
    tilt = sign * gear.beta_b
    true = np.array([*(math.cos(tilt) * across), -math.sin(tilt)])
    pulled = true - gear.twist_rate * true[2] * np.array([xy[1], -xy[0], 0.0])
    c, s = math.cos(pit.angle), math.sin(pit.angle)
    u, w = np.array([*along, 0.0]), np.array([0.0, 0.0, 1.0])
    axes = np.column_stack([pit.axes[0] * (c * u + s * w), pit.axes[1] * (c * w - s * u)])
    return np.array([*xy, pit.z]), axes, -pit.depth * pulled, np.array([*across, 0.0])


def removed_volume(gear, pits):
    """Volume [mm**3] the pits take from the body, what several take counted once.

    The tooth near its flank is filled by the involutes parallel to it: a place is arc s, distance t below the flank and height
    z, and ``dV = (1 - t / roll) ds dt dz`` (on a ring ``1 + t / roll``). Along t a pit is an interval, because its cylinder is a
    quadric; over s and z the lengths are summed on a fine grid.
    """
    return sum(_taken(gear, pit, pits[:k]) for k, pit in enumerate(pits))


def _taken(gear, pit, before):
    """Volume of a pit less what those `before` it have."""
    spread = pit.depth * math.tan(gear.beta_b) ** 2 + 0.02 * min(pit.axes)
    reach = np.array(pit.reach) * 1.02 + 2 * spread + pit.depth * abs(math.tan(gear.beta_b))
    low, high = max(centre_arc(gear, pit) - reach[0], arc_at(gear, gear.roll_f)), centre_arc(gear, pit) + reach[0]
    bottom, top = max(pit.z - reach[1], 0.0), min(pit.z + reach[1], gear.b)
    s = low + (high - low) * (np.arange(GRID) + 0.5) / GRID
    z = bottom + (top - bottom) * (np.arange(GRID) + 0.5) / GRID
    others = [one for one in before if one.side == pit.side and abs(one.z - pit.z) < 2 * (one.reach[1] + reach[1])]
    ranges = [_below(gear, one, s, z) for one in (*others, pit)]
    lengths = [union_length(*np.array(part).transpose(1, 0, 2, 3)) for part in (ranges, ranges[:-1]) if part]
    return (lengths[0] - (lengths[1] if len(lengths) > 1 else 0.0)).sum() * (high - low) * (top - bottom) / GRID**2


def _below(gear, pit, s, z):
    """Where a pit begins and ends below the flank at arcs `s` and heights `z`, weighted: two arrays ``(s, z)`` [mm]."""
    centre, axes, push, normal = pit_frame(gear, pit)
    sign = 1 if pit.side == "loaded" else -1
    roll = roll_at_arc(gear, s)
    place = np.array([*(cartesian(*flank(gear, roll)) * [[sign], [1]]), 0 * s])
    inward = -np.array([*(flank_normal(gear, roll) * [[sign], [1]]), 0 * s])
    start = (place - centre[:, None])[:, :, None] + np.array([0, 0, 1])[:, None, None] * z
    deep = push @ -normal  # of the bottom below the tangent plane
    dual = np.linalg.inv(np.column_stack([axes, -push / deep]))  # places in half axes and height
    p, q, h = np.einsum("ij,jsz->isz", dual, start)
    dp, dq, dh = (dual @ inward)[:, :, None]
    a, half, c = dp * dp + dq * dq, p * dp + q * dq, p * p + q * q - 1
    root = np.sqrt(np.maximum(half * half - a * c, 0.0))
    hit = half * half - a * c > 0
    flat = 1e-12 / min(pit.axes) ** 2
    wall = np.where(a > flat, a, 1.0)
    inside = c < 0
    low = np.where(a > flat, (-half - root) / wall, np.where(inside, -np.inf, 0.0))
    high = np.where(a > flat, (-half + root) / wall, np.where(inside, np.inf, 0.0))
    tip = np.maximum(gear.outward * (roll - gear.roll_a), 0.0)[:, None]  # beyond the tip the body begins deeper
    low = np.maximum(low, tip)
    high = np.minimum(high, (-deep - h) / dh)  # dh < 0: down to the bottom
    ok = hit & (high > low)
    low, high = np.where(ok, low, 0.0), np.where(ok, high, 0.0)
    bend = gear.outward / (2 * roll[:, None])
    return low - bend * low**2, high - bend * high**2

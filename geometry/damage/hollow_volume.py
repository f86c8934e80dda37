"""Volume that hollows remove from a tooth, computed by an integral without a solid model."""

import math

import numpy as np

from ..tooth.profile import arc_at, cartesian, flank, flank_normal, roll_at_arc
from .hollow import centre_arc, union_length

GRID = 400  # quadrature points across a hollow


def hollow_frame(gear, one):
    """Return the frame of a hollow: centre, half axes ``(3, 2)``, vector to the bottom [mm], normal in the section."""
    roll = math.sqrt(max(one.radius**2 - gear.r_b**2, 0.0))
    sign = 1 if one.side == "loaded" else -1
    mirror = np.array([sign, 1.0])
    xy = cartesian(*flank(gear, roll)) * mirror
    across = flank_normal(gear, roll) * mirror
    along = np.array([-across[1], across[0]]) * sign  # direction of increasing radius
    along *= gear.outward if along @ xy > 0 else -gear.outward
    tilt = sign * gear.beta_b
    true = np.array([*(math.cos(tilt) * across), -math.sin(tilt)])
    pulled = true - gear.twist_rate * true[2] * np.array([xy[1], -xy[0], 0.0])
    c, s = math.cos(one.angle), math.sin(one.angle)
    u, w = np.array([*along, 0.0]), np.array([0.0, 0.0, 1.0])
    axes = np.column_stack([one.axes[0] * (c * u + s * w), one.axes[1] * (c * w - s * u)])
    return np.array([*xy, one.z]), axes, -one.depth * pulled, np.array([*across, 0.0])


def removed_volume(gear, hollows):
    """Return the volume [mm**3] that hollows remove from the body. Overlaps count once.

    The tooth near its flank is described by involutes parallel to the flank: arc s, distance t below the flank and height z,
    with ``dV = (1 - t / roll) ds dt dz`` (``1 + t / roll`` for a ring). Along t a hollow is an interval, because its outline
    is convex. The lengths are summed over a fine grid of s and z.
    """
    return sum(_taken(gear, hollow, hollows[:k]) for k, hollow in enumerate(hollows))


def _taken(gear, one, before):
    """Return the volume of a hollow without its overlap with the hollows in `before`."""
    spread = one.depth * math.tan(gear.beta_b) ** 2 + 0.02 * min(one.axes)
    reach = np.array(one.reach) * 1.02 + 2 * spread + one.depth * abs(math.tan(gear.beta_b))
    low, high = max(centre_arc(gear, one) - reach[0], arc_at(gear, gear.roll_f)), centre_arc(gear, one) + reach[0]
    bottom, top = max(one.z - reach[1], 0.0), min(one.z + reach[1], gear.b)
    s, ds = _places(low, high, centre_arc(gear, one) + np.array(one.kinks[0]))
    z, dz = _places(bottom, top, one.z + np.array(one.kinks[1]))
    others = [other for other in before if other.side == one.side and abs(other.z - one.z) < 2 * (other.reach[1] + reach[1])]
    ranges = [_below(gear, hollow, s, z) for hollow in (*others, one)]
    lengths = [union_length(*np.array(part).transpose(1, 0, 2, 3)) for part in (ranges, ranges[:-1]) if part]
    return ds @ (lengths[0] - (lengths[1] if len(lengths) > 1 else 0.0)) @ dz


def _places(low, high, kinks):
    """Return points [mm] and weights [mm] for numerical integration from `low` to `high` of a function with kinks."""
    ends = np.unique(np.clip([low, *kinks, high], low, high))
    count = -(-GRID // (ends.size - 1))
    steps = np.repeat(np.diff(ends) / count, count)
    return (np.repeat(ends[:-1], count) + steps * (np.tile(np.arange(count), ends.size - 1) + 0.5)), steps


def _below(gear, one, s, z):
    """Return weighted depths ``(s, z)`` [mm] at which a hollow begins and ends below the flank, at arcs `s`, heights `z`."""
    centre, axes, push, normal = hollow_frame(gear, one)
    sign = 1 if one.side == "loaded" else -1
    roll = roll_at_arc(gear, s)
    place = np.array([*(cartesian(*flank(gear, roll)) * [[sign], [1]]), 0 * s])
    inward = -np.array([*(flank_normal(gear, roll) * [[sign], [1]]), 0 * s])
    start = (place - centre[:, None])[:, :, None] + np.array([0, 0, 1])[:, None, None] * z
    deep = push @ -normal  # depth of the floor below the tangent plane
    # maps points to coordinates in units of the semi-axes and the depth
    dual = np.linalg.inv(np.column_stack([axes, -push / deep]))
    p, q, h = np.einsum("ij,jsz->isz", dual, start)
    dp, dq, dh = (dual @ inward)[:, :, None]
    low, high = one._chord(p, q, dp, dq)
    tip = np.maximum(gear.outward * (roll - gear.roll_a), 0.0)[:, None]  # Beyond the tip circle, the body's surface lies deeper.
    low = np.maximum(low, tip)
    high = np.minimum(high, (-deep - h) / dh)  # dh < 0: the line ends at the floor
    ok = high > low
    low, high = np.where(ok, low, 0.0), np.where(ok, high, 0.0)
    bend = gear.outward / (2 * roll[:, None])
    return low - bend * low**2, high - bend * high**2

"""Checks of the fields of a `Crack`, and its open part along the width."""

import math

import numpy as np

from ..checks import is_finite

TANGENTS = {"30deg": math.pi / 6, "60deg": math.pi / 3}  # angle between tangent and centre-line of the tooth
STARTS = (*TANGENTS, "root", "middle")
SLACK = 1e-9  # tolerance for rounding of the open part of a crack


def check_path(crack):
    """Raise ValueError for incompatible size, angle and start of a crack."""
    if [crack.level, crack.length, crack.path].count(None) != 2:
        raise ValueError(f"level = {crack.level}, length = {crack.length}, path = {crack.path}: give one of them")
    if crack.level is not None and not 0 < crack.level < 1:
        raise ValueError(
            f"level = {crack.level}, but it must lie between 0 and 1 (0.5 reaches the centre-line, 1 is a broken tooth)"
        )
    if crack.length is not None and not crack.length > 0:
        raise ValueError(f"length = {crack.length} mm, but a crack has a positive length")
    if crack.angle is None or not math.radians(5) <= crack.angle <= math.radians(90):
        raise ValueError(f"angle = {crack.angle} rad, but it must lie between 5 and 90 degrees; angles are radians in Python")
    if crack.start not in STARTS and not is_finite(crack.start):
        raise ValueError(f"start = {crack.start!r}, but it must be one of {', '.join(STARTS)}, or an arc in mm")
    if not isinstance(crack.turning, bool):
        raise ValueError(f"turning = {crack.turning!r}, but give True or False")
    if crack.turning and crack.level is None:
        raise ValueError("turning = True with a length or a path: describe a turning crack by its level")


def check_front(crack):
    """Raise ValueError unless a crack is open at some height, and nowhere deeper than its length."""
    if crack.width is not None and not 0 <= crack.width[0] < crack.width[1]:
        raise ValueError(f"width = {crack.width} mm, but a crack is open from a height z >= 0 to a greater one")
    if not isinstance(crack.rounded, bool):
        raise ValueError(f"rounded = {crack.rounded!r}, but give True or False")
    if not (min(crack.ends) >= 0 and 0 < max(crack.ends) <= 1):
        raise ValueError(f"ends = {crack.ends}, but they are parts of the crack's length: from 0 to 1, not all 0")
    low, high = extremes(crack)
    if low < -SLACK or high > 1 + SLACK:
        raise ValueError(
            f"ends = {crack.ends}: the parabola through them runs from {low:.3g} to {high:.3g}, but parts of the crack's "
            "length lie between 0 and 1; change the middle number, or give two"
        )


def corners_of(path):
    """Return the corners of a path as floats."""
    try:
        corners = tuple((float(x), float(y)) for x, y in path)
    except (TypeError, ValueError) as error:
        raise ValueError(f"path = {path!r}, but give corners (x, y) [mm] of the crack after its start") from error
    if not corners or not all(math.isfinite(value) for corner in corners for value in corner):
        raise ValueError(f"path = {path!r}, but give one or more corners of finite numbers [mm]")
    return corners


def two_or_three(name, values, counts):
    """Return two or three numbers along the width, as a tuple of floats."""
    try:
        values = tuple(values)
    except TypeError:
        values = (values,)
    if len(values) not in counts or not all(map(is_finite, values)):
        third = ", or three with the one half-way" if 3 in counts else ""
        raise ValueError(f"{name} = {values!r}, but give two finite numbers, one for each end{third}")
    return tuple(float(value) for value in values)


def _polynomial(crack):
    """Return polynomial coefficients (constant first) of the open part of a crack over t = 0..1 along its width.

    Of a `rounded` crack, the polynomial is the square of the open part.
    """
    first, *middle, last = (end**2 for end in crack.ends) if crack.rounded else crack.ends
    if not middle:
        return first, last - first, 0.0
    return first, 4 * middle[0] - 3 * first - last, 2 * (first + last - 2 * middle[0])


def extremes(crack):
    """Least and largest open part (of a `rounded` crack its square) between the crack's ends."""
    constant, linear, square = _polynomial(crack)
    places = [0.0, 1.0]
    if square and 0 < -linear / (2 * square) < 1:
        places.append(-linear / (2 * square))
    values = [constant + t * (linear + t * square) for t in places]
    return min(values), max(values)


def deepest(crack):
    """Largest open part of a crack's length."""
    high = extremes(crack)[1]
    return math.sqrt(high) if crack.rounded else high


def front(crack, b, z):
    """Return the open part of the crack's length at heights `z` [mm] (constant beyond its ends), and its slope [1/mm]."""
    low, high = crack.width or (0.0, b)
    constant, linear, square = _polynomial(crack)
    place = (np.asarray(z, dtype=float) - low) / (high - low)
    t = np.clip(place, 0.0, 1.0)
    part = np.clip(constant + t * (linear + t * square), 0.0, 1.0)
    slope = np.where(place == t, linear + 2 * t * square, 0.0) / (high - low)
    if not crack.rounded:
        return part, slope
    root = np.sqrt(part)
    return root, slope / (2 * np.maximum(root, SLACK))

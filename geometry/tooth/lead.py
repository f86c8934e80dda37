"""Modifications of flanks along the width: helix crowning, helix slope, end relief, twist, a measured grid."""

from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from ..aliases import Floats
from ..checks import is_finite
from .gear import Gear


class LeadForm:
    """Modifications of a `Flank` along the width: material removed by roll length and height."""

    def __init__(self, flank: Any, gear: Gear, low: float, high: float) -> None:
        self.flank, self.b, self.low, self.high = flank, gear.b, low, high
        for amount, length in zip(flank.end_relief, flank.end_length, strict=True):
            if amount and not 0 < length <= gear.b:
                raise ValueError(f"end_length = {length:g} mm, but the gear of z = {gear.z} is {gear.b:g} mm wide: give 0 to b")
        self._grid = None
        if flank.topography is not None:
            rolls, heights, amounts = flank.topography
            slack = 1e-6 * gear.m_n
            for name, axis, ends in (("roll length", rolls, sorted((low, high))), ("height", heights, (0.0, gear.b))):
                if axis[0] > ends[0] + slack or axis[-1] < ends[1] - slack:
                    raise ValueError(
                        f"topography from {axis[0]:.5g} to {axis[-1]:.5g} mm of {name} does not cover the flank of "
                        f"z = {gear.z}: {ends[0]:.5g} to {ends[1]:.5g} mm"
                    )
            degree = {"kx": min(3, len(rolls) - 1), "ky": min(3, len(heights) - 1)}
            self._grid = scipy.interpolate.RectBivariateSpline(rolls, heights, amounts, **degree)

    def removed(self, roll: NDArray, z: NDArray, derivative: int) -> Floats:
        """Return the material removed at roll lengths and heights [mm], or its derivative by the roll length."""
        flank, n = self.flank, derivative
        span = self.high - self.low
        across, along = (2 * roll - self.low - self.high) / span, 2 * z / self.b - 1
        out = flank.twist * along * (across, 2 / span, 0.0)[n]
        if n == 0:
            out = out + flank.helix_crowning * along**2 + flank.helix_slope * (1 + along) / 2
            for away, amount, length, exponent in zip(
                (z, self.b - z), flank.end_relief, flank.end_length, flank.end_exponent, strict=True
            ):
                if amount:
                    out = out + amount * np.maximum(1 - away / length, 0.0) ** exponent
        if self._grid is not None:
            rolls, heights = flank.topography[:2]
            place = np.broadcast_arrays(np.clip(roll, rolls[0], rolls[-1]), np.clip(z, heights[0], heights[-1]))
            out = out + self._grid.ev(*place, dx=n)
        return out


def two_ends(flank: Any) -> list[tuple[float, float]]:
    """Return end reliefs of a `Flank`, with lengths and exponents, at z = 0 and z = b.

    ValueError if there are other than one or two numbers of each, no length, or an exponent below 1.
    """
    out = []
    for name in ("end_relief", "end_length", "end_exponent"):
        value = getattr(flank, name)
        value = 0.0 if value is None else value
        values = value if isinstance(value, (tuple, list)) else (value, value)
        if len(values) != 2 or not all(map(is_finite, values)):
            raise ValueError(f"{name} = {value!r}, but give one finite number, or two: at z = 0 and at z = b")
        out.append((float(values[0]), float(values[1])))
    for amount, length, exponent in zip(*out, strict=True):
        if length < 0 or (amount and length == 0):
            raise ValueError(f"end_relief = {amount:g} mm with end_length = {length:g} mm: give a length > 0 [mm]")
        if exponent < 1:
            raise ValueError(f"end_exponent = {exponent:g}, but a relief needs an exponent >= 1")
    return out


def checked_topography(given: Any) -> tuple[tuple[float, ...], tuple[float, ...], tuple[tuple[float, ...], ...]]:
    """Return roll lengths, heights and amounts of a measured flank as tuples.

    Raises ValueError unless a full grid with rising axes.
    """
    try:
        rolls, heights, amounts = (np.asarray(part, dtype=float) for part in given)
    except (TypeError, ValueError) as error:
        raise ValueError(
            "topography needs roll lengths, heights and one row of amounts for each roll length: numbers in mm, none missing"
        ) from error
    if any(map(np.ma.is_masked, given)) or not all(np.isfinite(part).all() for part in (rolls, heights, amounts)):
        raise ValueError("topography has holes (masked, or not finite): fill them before, or cut the grid")
    if rolls.ndim != 1 or heights.ndim != 1 or min(rolls.size, heights.size) < 2 or amounts.shape != (rolls.size, heights.size):
        raise ValueError(
            f"topography has {rolls.size} roll lengths, {heights.size} heights and amounts of shape {amounts.shape}: give a row "
            "for each roll length and a column for each height, at least two of each"
        )
    if not ((np.diff(rolls) > 0).all() and (np.diff(heights) > 0).all()):
        raise ValueError("topography: roll lengths and heights must rise")
    return tuple(rolls.tolist()), tuple(heights.tolist()), tuple(map(tuple, amounts.tolist()))

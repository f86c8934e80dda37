"""Flanks of a pair with the misalignment of its axes, for the gaps of every contact model."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ..checks import by_gear, is_finite
from ..renamed import renamed
from ..tooth.flank_form import FlankForm
from ..tooth.modified import Flank

STEEPEST = 0.01  # largest misalignment per face width, beyond which the axes are not parallel


@renamed(F_beta="F_beta_x")
@dataclass(frozen=True, slots=True)
class Misalignment:
    """Misalignment of the axes of a gear pair.

    Only the component in the plane of action has an effect. Over the common width b the gap of the flanks changes by::

        F_beta_x + (f_sigma_beta cos(alpha_wt) + f_sigma_delta sin(alpha_wt)) b / length

    The gap is larger at z = b than at z = 0 (heights of a `Pit`), and unchanged in the middle of the width.

    Parameters
    ----------
    F_beta_x : float
        Equivalent misalignment in the plane of action over the common width, F_beta_x of ISO 6336-1 [mm]; positive: at z = b the
        flanks are further apart, as if material were removed there.
    f_sigma_beta, f_sigma_delta : float
        Deviations of the axes from being parallel, out of the plane of the axes and in it (ISO/TR 10064-3), over `length` [mm];
        the same sign: each positive one opens the flanks at z = b.
    length : float, optional
        Distance along the axis over which they are stated, the span of the bearings [mm].

    Raises
    ------
    ValueError
        If a number is not finite, or a deviation of the axes is given without its length.

    Examples
    --------
    >>> Misalignment(F_beta_x=0.012)
    Misalignment(F_beta_x=0.012, f_sigma_beta=0.0, f_sigma_delta=0.0, length=None)
    """

    F_beta_x: float = 0.0
    f_sigma_beta: float = 0.0
    f_sigma_delta: float = 0.0
    length: float | None = None

    def __post_init__(self) -> None:
        """Raise ValueError for numbers that are not finite, and for axis deviations without a length."""
        for name in self.__slots__:
            value = getattr(self, name)
            if name == "length" and value is None:
                continue
            if not is_finite(value):
                raise ValueError(f"misalignment: {name} = {value!r}, but it needs a finite number [mm]")
        if self.length is not None and not self.length > 0:
            raise ValueError(f"misalignment: length = {self.length:g} mm, but the span of the bearings must be positive")
        if (self.f_sigma_beta or self.f_sigma_delta) and self.length is None:
            raise ValueError(
                "misalignment: f_sigma_beta and f_sigma_delta are deviations over a length: give length, the span of the "
                "bearings [mm]"
            )


def tilt_of(pair: Any, misalignment: Misalignment | None) -> float:
    """Return the change of the flank gap per height [mm/mm] by a misalignment of the axes of a `GearPair`.

    ValueError if it is no `Misalignment`, or larger than any gears can run with.
    """
    if misalignment is None:
        return 0.0
    if not isinstance(misalignment, Misalignment):
        raise ValueError(f"misalignment = {misalignment!r}, but give a Misalignment(F_beta_x=...) [mm]")
    askew = misalignment.f_sigma_beta * math.cos(pair.alpha_wt) + misalignment.f_sigma_delta * math.sin(pair.alpha_wt)
    tilt = misalignment.F_beta_x / pair.b_w + (askew / misalignment.length if misalignment.length else 0.0)
    if abs(tilt) > STEEPEST:
        raise ValueError(
            f"F_beta_x = {misalignment.F_beta_x:g} mm: the misalignment is {1e3 * tilt:.4g} um per mm of width, but gears with "
            f"parallel axes allow at most {1e3 * STEEPEST:g}: give a smaller one"
        )
    return tilt


def flank_forms(
    pair: Any, flanks: Mapping[str, Flank] | None, misalignment: Misalignment | None = None
) -> tuple[FlankForm, FlankForm] | None:
    """Return the `FlankForm` of pinion and wheel, each with half of the misalignment. Involutes give None.

    ValueError if `flanks` are not given by gear (``{"pinion": Flank(...), "wheel": Flank(...)}``, or one of them), or do not
    fit.
    """
    tilt = tilt_of(pair, misalignment)
    if flanks is None and not tilt:
        return None
    both = by_gear("flanks", flanks, "{'pinion': Flank(...), 'wheel': Flank(...)}")
    for name, flank in zip(("pinion", "wheel"), both, strict=True):
        if not (flank is None or isinstance(flank, Flank)):
            raise ValueError(f"flanks of the {name}: {flank!r} is no Flank")
    first, second = ((flank or Flank()).on(gear) for flank, gear in zip(both, pair.gears, strict=True))
    if not tilt and all(flank in (None, Flank()) for flank in both):
        return None
    return first.tilted(tilt / 2), second.tilted(tilt / 2).turned(-1)

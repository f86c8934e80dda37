"""Inputs of a surrogate: names, ranges, and the `Case` at a point of the ranges."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from ...core.case import Case
from ...core.checks import is_number
from ...geometry.aliases import Floats
from ...geometry.damage.crack import Crack
from ...geometry.pair.gear_pair import GearPair, free_centre_distance

INPUTS = {  # by input: description
    "force": "force along the line of action over the whole width [N], on a logarithmic scale",
    "level": "level of a root crack of a pinion tooth, see Crack",
    "angle": "its angle to the centre-line [rad]",
    "z_1": "teeth of the pinion",
    "z_2": "teeth of the wheel",
    "x_1": "profile shift of the pinion",
    "x_2": "profile shift of the wheel",
    "bore_1": "bore of the pinion, in its root radii",
    "bore_2": "bore of the wheel, in its root radii",
}
WHOLE = ("z_1", "z_2")
SHAPE = ("z_1", "z_2", "x_1", "x_2")  # inputs that change the contact ratio or the centre distance


@dataclass(frozen=True)
class Space:
    """Ranges of some `INPUTS` of a pair of spur gears. The other inputs are fixed."""

    pair: GearPair  # pair that provides all other values
    ranges: dict[str, tuple[float, float]]  # limits of the varied inputs
    held: dict[str, float]  # inputs with a single value

    @cached_property
    def _scale(self):
        """Return which inputs are logarithmic, and middle and half-width of each range."""
        logarithmic = np.array([name == "force" for name in self.ranges])
        ends = np.array(list(self.ranges.values()))
        np.log(ends, out=ends, where=logarithmic[:, None])
        return logarithmic, ends.mean(axis=1), (ends[:, 1] - ends[:, 0]) / 2

    @property
    def cracked(self) -> bool:
        """Whether a tooth has a crack."""
        return "level" in self.ranges or "level" in self.held

    def point(self, given: Mapping[str, Any]) -> list[float]:
        """Return the values of `given` in the order of `ranges`, after a check of names and ranges.

        Raises
        ------
        ValueError
            Naming what is missing, unknown or outside.
        """
        if given.keys() != self.ranges.keys():
            unknown, missing = set(given) - set(self.ranges), [name for name in self.ranges if name not in given]
            wrong = f"{sorted(unknown)[0]!r} is none of its inputs" if unknown else f"no value of {missing[0]!r}"
            raise ValueError(f"{wrong}: this surrogate needs {', '.join(f'{name} = ...' for name in self.ranges)}")
        out = []
        for name, (low, high) in self.ranges.items():
            value = given[name]
            if not is_number(value) or not low <= value <= high:
                raise ValueError(
                    f"{name} = {value!r}, but this surrogate was fitted from {low:g} to {high:g} and is invalid outside: give "
                    "a value within, fit another surrogate, or use mesh_stiffness"
                )
            if name in WHOLE and value != int(value):
                raise ValueError(f"{name} = {value!r}, but give a whole number of teeth")
            out.append(float(value))
        return out

    def scaled(self, points: Any) -> Floats:
        """Return points ``(..., d)`` scaled to -1 ... 1. Forces are scaled by their logarithm."""
        logarithmic, middle, half = self._scale
        values = np.array(points, dtype=float)
        np.log(values, out=values, where=logarithmic)
        return (values - middle) / half

    def at(self, unit: Floats) -> dict[str, float]:
        """Return the point for numbers from 0 to 1: whole numbers of teeth, forces on a logarithmic scale."""
        out: dict[str, float] = {}
        for (name, (low, high)), share in zip(self.ranges.items(), unit.tolist(), strict=True):
            if name in WHOLE:
                out[name] = float(min(high, math.floor(low + share * (high - low + 1))))
            else:
                out[name] = low * (high / low) ** share if name == "force" else low + share * (high - low)
        return out

    def case(self, point: Mapping[str, float], material: Any) -> Case:
        """Return the `Case` at a point of the ranges, with this material (or pair of materials).

        ValueError if such gears or such a crack are impossible.
        """
        values: dict[str, Any] = self.held | dict(point)
        gears = []
        for number, gear in enumerate(self.pair.gears, 1):
            new: dict[str, Any] = {"z": int(values.get(f"z_{number}", gear.z)), "x": values.get(f"x_{number}", gear.x)}
            if bore := values.get(f"bore_{number}"):
                new["r_bore"] = bore * replace(gear, **new, r_bore=0.1 * gear.m_n).r_f
            gears.append(replace(gear, **new))
        pair = GearPair(gears[0], gears[1]) if values.keys() & {*SHAPE} else replace(self.pair, gear_1=gears[0], gear_2=gears[1])
        crack = {name: values[name] for name in ("level", "angle") if name in values}
        return Case(pair, values["force"], material, damage={"pinion": [Crack(**crack)]} if crack else None)


def space_of(pair: GearPair, inputs: Mapping[str, Any]) -> Space:
    """Return the `Space` of a pair from ranges ``name=(low, high)`` and single numbers.

    ValueError if an input is unknown, no range, or does not go with this pair.
    """
    if pair.gear_1.beta:
        raise ValueError("the pair is helical, but a surrogate is one of the transverse section: give spur gears")
    _check_names(pair, inputs)
    values = {name: _numbers(name, value) for name, value in inputs.items()}
    ranges = {name: ends for name, ends in values.items() if len(ends) == 2}
    if not ranges:
        raise ValueError(
            "inputs: all are single numbers, so that nothing varies: give a range (low, high), or use mesh_stiffness"
        )
    return Space(pair, ranges, {name: ends[0] for name, ends in values.items() if name not in ranges})


def _check_names(pair, inputs):
    """Raise ValueError for inputs that are unknown, incomplete, or incompatible with a pair."""
    if not isinstance(inputs, Mapping):
        raise ValueError(f"inputs = {inputs!r}, but give a dict: {{'force': (500.0, 4000.0), 'level': (0.1, 0.5)}}")
    if unknown := [name for name in inputs if name not in INPUTS]:
        raise ValueError(f"inputs: {unknown[0]!r} is unknown; there are {', '.join(INPUTS)}")
    if "force" not in inputs:
        raise ValueError("inputs: no 'force', but k depends on the load: give a range or a number [N]")
    if "angle" in inputs and "level" not in inputs:
        raise ValueError("inputs: an 'angle' of a crack, but no 'level': give both")
    ring = [name for name in (*SHAPE, "bore_2") if name in inputs]
    if ring and pair.gear_2.internal:
        raise ValueError(f"inputs: {ring[0]!r}, but gear 2 is a ring, whose trimmed tip makes k discontinuous: omit this input")
    shape = ring and ring[0] in SHAPE
    if shape and not math.isclose(pair.a, free_centre_distance(*pair.gears), rel_tol=1e-9):
        raise ValueError(
            f"inputs: {ring[0]!r} changes the centre distance, which a surrogate sets without backlash, but the pair has "
            f"a = {pair.a:g} mm: give a pair with a = None, or leave {ring[0]!r} out"
        )


def _numbers(name, value):
    """Return the ends of the range of an input, or its single number."""
    ends = (value,) if is_number(value) else value
    if not (isinstance(ends, (tuple, list)) and (ends == (value,) or len(ends) == 2) and all(map(is_number, ends))):
        raise ValueError(f"inputs: {name} = {value!r}, but give a range (low, high) or one number")
    if not all(math.isfinite(end) and (end > 0 or name != "force") and (name not in WHOLE or end % 1 == 0) for end in ends):
        raise ValueError(f"inputs: {name} = {value!r}, but give finite numbers, forces > 0, whole numbers of teeth")
    if len(ends) == 2 and not ends[0] < ends[1]:
        raise ValueError(
            f"inputs: {name} from {ends[0]:g} to {ends[1]:g}, but the upper end must be larger: give low < high, or one number"
        )
    return tuple(map(float, ends))

"""Channel of a file as a `Signal`. Rate and unit are stated in the file or by the caller. They are never guessed."""

import math
import re
import warnings
from pathlib import Path
from typing import Any

import numpy as np

from ..core.checks import is_number
from .found import ANGLES, RATES, SHAFTS, TIMES, Found
from .series import Signal
from .time_axis import step_of

TIME = {"s": 1.0, "ms": 1e-3, "us": 1e-6}
TURN = {"rad": 1.0, "deg": math.pi / 180}
HERTZ = {"": 1.0, "hz": 1.0, "khz": 1e3}
AGREE = 1e-3  # largest relative difference between a stated rate and the time column
SAME = {"m/s²": "m/s^2", "m/s2": "m/s^2", "m/s**2": "m/s^2", "m/s/s": "m/s^2", "µm": "um", "μm": "um", "Newtons": "N"}


def signal_of(
    path: Any,
    found: Found,
    name: str,
    *,
    rate: float | None = None,
    unit: str | None = None,
    shaft_frequency: float | None = None,
    scale: float = 1.0,
) -> Signal:
    """Return a channel with its rate, unit and angle. Arguments and errors are those of `gearfe.read_signal`."""
    if not (scale and math.isfinite(scale)):
        raise ValueError(f"scale = {scale!r}, but give a finite factor other than 0")
    time, angle = _axis(path, found, name, TIMES, TIME, rate), _axis(path, found, name, ANGLES, TURN)
    turning = _one(path, "shaft_frequency", [shaft_frequency, *found.nearest(found.stated, name, SHAFTS)], found.named(SHAFTS))
    values = found.vectors[name]
    _whole(path, name, values)
    if found.parts and scale == 1 and unit and unit != "1":
        meaning = f"full scale is taken for 1 {unit}; give what it is as scale="
        warnings.warn(f"{path}: the values are parts of full scale, and {meaning}", stacklevel=4)
    values = values if scale == 1 else scale * np.asarray(values, dtype=float)
    stated = {"rate": _rate(path, found, name, rate, time), "unit": _unit(path, found, name, unit, scale)}
    return Signal(values, **stated, name=f"{Path(path).stem} {name}", angle=angle, shaft_frequency=turning)


def _unit(path, found, name, given, scale):
    spellings = [found.units.get(name, ""), *map(str, found.nearest(found.stated, name, ("unit",)))]
    asked, *stated = (SAME.get(text.strip(), text.strip()) for text in (given or "", *spellings))
    if asked and scale != 1:
        return asked
    units = sorted({asked, *stated} - {""})
    if len(units) == 1:
        return units[0]
    text = f"units {', '.join(units)}" if units else "no unit"
    if found.parts:
        remedy = ", whose values are parts of full scale: give what that is as scale= and unit="
    else:
        remedy = f"; give one, in the file ('{name} [m/s^2]', 'unit = m/s^2') or as unit="
    raise ValueError(f"{path}: {text} for {name!r}{remedy}")


def _axis(path, found, channel, names, factors, rate=None):
    """Return time [s] or angle [rad] of a channel, from its group or from the whole file, or None if neither has it.

    Times without a unit have the one that fits the `rate`.
    """
    chosen = found.nearest({name: name for name in found.vectors}, channel, names)
    if not chosen:
        return None
    if len(chosen) > 1:
        raise ValueError(f"{path}: {' and '.join(map(repr, chosen))} exclude each other; give one of them")
    values, unit = found.vectors[chosen[0]], found.units.get(chosen[0], "")
    if not unit and is_number(rate) and len(values) > 1:
        step = float(values[-1] - values[0]) / (len(values) - 1)
        unit = next((one for one, factor in factors.items() if abs(rate * factor * step - 1) <= AGREE), "")
        if not unit:
            raise ValueError(
                f"{path}: column {chosen[0]!r} has no unit, and its step of {step:.6g} is that of rate = {rate:g} Hz in none of "
                f"{', '.join(factors)}: correct rate="
            )
    if unit not in factors:
        stated, also = f"{chosen[0]} [{next(iter(factors))}]", "give rate=, " if "s" in factors else ""
        raise ValueError(
            f"{path}: column {chosen[0]!r} has {f'unit {unit!r}' if unit else 'no unit'}, but needs one of {', '.join(factors)}: "
            f"call it {stated!r} in the file, {also}or name all columns of a text table in header="
        )
    return factors[unit] * values


def _one(path, name, values, where=""):
    """Return the only finite positive number among `values` [Hz], or None. The first value may be None.

    `where` is the source of the others.
    """
    numbers = [_hertz(path, name, value) for value in values if value is not None]
    same = [math.isclose(number, numbers[0]) for number in numbers[1:]]
    if not (all(same) or (values[0] is not None and any(same))):
        listed = f"{' and '.join(f'{number:g}' for number in numbers)} Hz{f' ({where})' if where else ''}"
        raise ValueError(f"{path}: {name} is given as {listed}; choose one by {name}=")
    return next(iter(numbers), None)


def _hertz(path, name, value):
    match = re.fullmatch(r"\s*([-+.\d]+(?:e[-+]?\d+)?)\s*(\w*)\s*", str(value), re.IGNORECASE)
    try:
        number = float(match[1]) * HERTZ[match[2].lower()]
    except (TypeError, ValueError, KeyError):
        number = math.nan
    if not 0 < number < math.inf:
        raise ValueError(f"{path}: {name} = {str(value).strip()!r}, but give a positive number of Hz")
    return number


def _rate(path, found, name, given, time):
    stated = found.nearest(found.stated, name, RATES) + ([found.rates[name]] if name in found.rates else [])
    rate = _one(path, "rate", [given, *stated], found.named(RATES))
    samples = found.vectors[name].size
    if time is None:
        if rate is None:
            others = found.channels() if len(found.channels()) > 1 else []
            rising = [other for other in others if np.all(np.diff(found.vectors[other]) > 0)]
            clock = f"; if {rising[0]!r}, which rises all along, is the time, name it so by header=" if rising else ""
            remedy = "add a column 'time [s]', write 'rate = ... Hz' into it, or give rate="
            raise ValueError(f"{path} states no sampling rate: {remedy}{clock}")
        return rate
    if time.size != samples or samples < 2:
        raise ValueError(f"{path}: {time.size} times for {samples} samples")
    step = step_of(path, np.asarray(time, dtype=float), rate)
    if rate is not None and abs(rate * step - 1) > AGREE:
        remedy = "leave rate= out, or mend the times" if given is not None else "mend one of them in the file"
        raise ValueError(f"{path}: rate = {rate:g} Hz, but its times are {1 / step:g} Hz; {remedy}")
    return 1 / step if rate is None else rate


def _whole(path, name, values):
    """Raise ValueError with the number of missing samples and the longest gap, if samples are missing."""
    bad = np.flatnonzero(~np.isfinite(values))
    if not bad.size:
        return
    edges = np.concatenate([[-1], bad, [values.size]])
    most = int(np.argmax(np.diff(edges)))
    first, last = edges[most] + 1, edges[most + 1] - 1
    raise ValueError(
        f"{path}: {name!r}: sample {bad[0]} is {values[bad[0]]}, the first of {bad.size} that are missing; cut the file to "
        f"samples {first} to {last}, its longest whole stretch, or fill the gaps"
    )

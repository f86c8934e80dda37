"""`Found`: channels and metadata of one measurement file, independent of its format."""

import warnings
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

RATES = ("rate", "fs", "sr", "sampling rate", "sample rate", "sampling frequency")
TIMES, ANGLES, SHAFTS = ("time", "t", "zeit", "temps"), ("angle", "shaft angle"), ("shaft frequency",)
KEYS = (*RATES, *SHAFTS, "unit")


TOLD = 40  # largest number of channels in a message


@dataclass(slots=True)
class Found:
    """Channels and metadata of one file."""

    vectors: dict[str, NDArray[Any]]  # samples by channel name, shape (n,)
    units: dict[str, str] = field(default_factory=dict)  # units as stated; missing or empty if not stated
    stated: dict[str, Any] = field(default_factory=dict)  # values of the names in `KEYS`, by full name
    rates: dict[str, float] = field(default_factory=dict)  # [Hz] of single channels, in formats that state them there
    starts: dict[str, float] = field(default_factory=dict)  # times [s] of the first samples of channels, from a common origin
    nested: str = ""  # separator of group and name: "." in MATLAB structs, "/" in HDF5 and TDMS; empty: no groups
    other: list[str] = field(default_factory=list)  # other contents of the file, for messages
    hint: str = ""  # remedy for a file whose columns have no names
    parts: bool = False  # True if the values are parts of an unknown full scale (WAV files)

    def add(self, name: str, values: NDArray[Any], unit: Any = "", step: Any = 0, start: Any = 0.0) -> None:
        """Add a channel.

        Its name gets a number if it is already used. A `step` [s] above 0 states rate and `start` [s].
        """
        same = [other for other in self.vectors if other == name or other.startswith(f"{name} (")]
        name = f"{name} ({len(same) + 1})" if same else name
        self.vectors[name], self.units[name] = values, str(unit).strip()
        if isinstance(step, (int, float)) and step > 0:
            self.rates[name], self.starts[name] = 1 / float(step), float(start)

    def take_clock(self, path: Any, name: str, kind: Any, seconds: NDArray[Any], depth: int) -> None:
        """Use clock times or dates as time [s] after the first one, for any column name, and warn about it."""
        if self.axes(TIMES):
            self.other.append(f"{name!r} (of a clock, in addition to {self.axes(TIMES)[0]!r})")
            return
        taken = name if plain(name) in TIMES else "time"
        self.vectors[taken], self.units[taken] = seconds, "s"
        warnings.warn(f"{path}: {name!r} ({kind}) is used as the time, in seconds from its first row", stacklevel=depth + 1)

    def state(self, name: str, value: Any) -> None:
        """Store a value if its name is in `KEYS`."""
        if plain(self.leaf(name)) in KEYS:
            self.stated[name] = value

    def nearest(self, table: dict[str, Any], channel: str, kind: tuple[str, ...]) -> list[Any]:
        """Return the values of a table whose names are of a kind: from the channel's group, the whole file, or else any group."""
        fit = {name: value for name, value in table.items() if plain(self.leaf(name)) in kind}
        for group in (self.group(channel), ""):
            near = [value for name, value in fit.items() if self.group(name) == group]
            if near:
                return near
        return list(fit.values())

    def named(self, kind: tuple[str, ...]) -> str:
        """Return "name = value" for the metadata of a kind of names."""
        return " and ".join(f"{name} = {value}" for name, value in self.stated.items() if plain(self.leaf(name)) in kind)

    def leaf(self, name: str) -> str:
        """Return the name without its groups."""
        return name.rsplit(self.nested, 1)[-1] if self.nested else name

    def group(self, name: str) -> str:
        """Return the groups of a name."""
        return name.rsplit(self.nested, 1)[0] if self.nested and self.nested in name else ""

    def axes(self, kind: tuple[str, ...]) -> list[str]:
        """Return the names of the vectors that are times or angles."""
        return [name for name in self.vectors if plain(self.leaf(name)) in kind]

    def channels(self) -> list[str]:
        """Return the names of all other vectors."""
        axes = self.axes(TIMES + ANGLES)
        return [name for name in self.vectors if name not in axes]

    def told(self) -> str:
        """Describe the channels with their units, and other contents, for messages."""
        channels = [f"{name!r}{f' [{self.units[name]}]' if self.units.get(name) else ''}" for name in self.channels()]
        told = channels + self.other
        return ", ".join(told[:TOLD]) + f" and {len(told) - TOLD} more" * (len(told) > TOLD) or "nothing"


def plain(name: str) -> str:
    """Return a name in lower case with blanks in place of underscores."""
    return name.strip().lower().replace("_", " ")


def numeric(value: Any) -> bool:
    """Return whether an array contains real numbers."""
    return isinstance(value, np.ndarray) and value.dtype.kind in "fiu"

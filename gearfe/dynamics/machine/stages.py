"""Stages of a machine, and the deviating teeth of its gears."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from ...core.record import ranged


@dataclass(frozen=True, slots=True)
class Stage:
    """Stage of a machine: driving and driven bodies, and frequencies.

    Attributes
    ----------
    name : str
    driver : tuple of str
        Bodies of the driving gear (two of a herringbone gear).
    follower : tuple of str
        Bodies of the first gear that it drives.
    mesh : float
        Mesh frequency [Hz].
    turning : float
        Shaft frequency of the driving gear [Hz], relative to the carrier if there is one.
    fault : float, optional
        Engagement frequency of a damaged tooth of the driving gear [Hz], if that gear meshes with several others. None: once per
        revolution.
    carrier : float, optional
        Rotation frequency of the carrier [Hz].
    returns : dict of str to float
        Engagement frequency of one flank of a tooth of each gear [Hz], by body. Planets are named without their number.
    """

    name: str
    driver: tuple[str, ...]
    follower: tuple[str, ...]
    mesh: float
    turning: float
    fault: float | None = None
    carrier: float | None = None
    returns: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Raise ValueError if a frequency is negative or not finite."""
        given = {"mesh": self.mesh, "turning": self.turning, "fault": self.fault, **self.returns}
        for name, value in given.items():
            if value is not None:
                ranged(f"stage {self.name}: frequency {name}", value, " Hz", least=0.0)
        if self.carrier is not None:
            ranged(f"stage {self.name}: frequency carrier", self.carrier, " Hz")


@dataclass(frozen=True, slots=True)
class Fault:
    """A tooth that differs from the other teeth of its gear.

    Attributes
    ----------
    gear : str
        Body of the machine.
    tooth : int
    what : str
        Its damage or deviation in words.
    frequency : float
        Engagement frequency of the tooth [Hz].
    turning : float
        Shaft frequency of its gear [Hz], relative to the carrier if there is one.

    Examples
    --------
    >>> print(Fault("wheel", 5, "3 mm crack at 60 degrees", 17.89, 17.89))
    tooth 5 of the wheel: 3 mm crack at 60 degrees; it meshes at 17.89 Hz
    """

    gear: str
    tooth: int
    what: str
    frequency: float
    turning: float

    def __str__(self) -> str:
        gear = f"the {self.gear}" if self.gear.isalpha() else self.gear
        return f"tooth {self.tooth} of {gear}: {self.what}; it meshes at {self.frequency:.4g} Hz"

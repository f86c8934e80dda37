"""`MissingTooth`: a tooth that has broken off at its root."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from ..aliases import Floats
from ..tooth.gear import Gear
from ..tooth.profile import cartesian, flank
from .given import tooth_and_side


@dataclass(frozen=True, slots=True)
class MissingTooth:
    """A tooth that has broken off. The root circle continues over its pitch.

    Where no other tooth pair is on the path of contact, the gears rotate on until tip corners of the neighbours touch. The
    unloaded transmission error contains this gap, and the mesh stiffness is the force divided by the deflection after the gap
    is closed.

    Parameters
    ----------
    tooth : int
        Number of the tooth: tooth k is in the pair that is k base pitches ahead of pair 0.

    Raises
    ------
    ValueError
        If `tooth` is not a whole number.

    >>> MissingTooth(tooth=5).tooth
    5
    """

    tooth: int = 0

    _nouns: ClassVar[tuple[str, str]] = ("missing tooth", "missing teeth")
    _adjective: ClassVar[str] = "missing"
    _removes_contact: ClassVar[None] = None  # a missing tooth has no contact to remove
    through: ClassVar[bool] = True
    side: ClassVar[str] = "loaded"

    def __post_init__(self) -> None:
        """Raise ValueError for an invalid tooth number."""
        object.__setattr__(self, "tooth", tooth_and_side(self.tooth, "loaded"))

    def outline(self, gear: Gear) -> Floats:
        """Line ``(2, n)`` [mm] along both flanks and the tip of the tooth, in the frame of the tooth."""
        x, y = cartesian(*flank(gear, np.linspace(gear.roll_f, gear.roll_a, 24)))
        return np.array([np.append(x, -x[::-1]), np.append(y, y[::-1])])

    def _description(self, gear: Gear) -> str:
        """Return a description."""
        return "missing tooth"

    def _warning(self, gear: Gear) -> str:
        """Return no warning."""
        return ""


def missing_teeth(gear: Gear, damage: Iterable[Any]) -> tuple[int, ...]:
    """Return the numbers of the missing teeth among damage."""
    return tuple(one.tooth % gear.z for one in damage if isinstance(one, MissingTooth))

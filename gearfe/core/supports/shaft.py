"""`Shaft`: a stepped shaft on two bearings, and the equivalent springs under its gear."""

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...geometry.aliases import Floats
from ..checks import is_number
from .beam import ShaftPiece, bending_flexibility, twist_flexibility
from .hub import Hub
from .support import Support

if TYPE_CHECKING:
    from ..material import Material

THICKEST = 100  # limit of the ratio of diameters: larger ratios are input errors and cause rounding errors
NONE = 1e-10  # Smaller couplings, relative to the largest possible one, are rounding errors.


@dataclass(frozen=True, slots=True)
class Shaft:
    """A round shaft on two bearings with one gear: Timoshenko's beam, and Saint-Venant's torsion.

    Positions are counted along the axis from the shaft's left end [mm]. The gear's end z = 0 is on the left,
    z = b on the right. The part of the shaft inside the gear has its stated diameter.

    Parameters
    ----------
    segments : sequence of (length, diameter) or (length, diameter, bore)
        From left to right [mm].
    bearings : (float, float)
        Positions of both bearings [mm]. They hold the shaft across its axis and let it tilt; the gear may lie outside of them.
    gear : float
        Position of the middle of the gear [mm].
    material : Material
    torque : float, optional
        Position at which the torque enters or leaves the shaft [mm]: the shaft twists between there and the gear. None: no twist.
    bearing_stiffness : float or (float, float)
        Stiffness of each bearing across the axis [N/mm]; default rigid.
    integral : bool
        The gear is one piece with its shaft, as small pinions are, in ``fe3d``: its body is solid but for the centre hole
        `r_bore`, which is free, and the shaft goes on at its end faces (`finite_elements.integral`). Needs `torque`; the first
        bearing holds the shaft along its axis.

    Raises
    ------
    ValueError
        If the shaft is impossible; the message states which number to change.

    Examples
    --------
    A force in the middle of 100 mm between rigid bearings: F L**3 / (48 E I), and a few per cent of shear.

    >>> from gearfe import Material
    >>> shaft = Shaft(segments=[(100, 20)], bearings=(0, 100), gear=50, material=Material(E=207e3, nu=0.3))
    >>> round(shaft.support().radial), round(48 * 207e3 * math.pi * 10**4 / 4 / 100**3)
    (71725, 78037)
    """

    segments: Any
    bearings: Any
    gear: float
    material: "Material"
    torque: float | None = None
    bearing_stiffness: Any = math.inf
    integral: bool = False

    def __post_init__(self) -> None:
        """Convert all numbers to floats, and raise ValueError for an impossible shaft."""
        object.__setattr__(self, "segments", tuple(_segment(i, row) for i, row in enumerate(_rows(self.segments))))
        thick, thin = (pick(segment.diameter for segment in self.segments) for pick in (max, min))
        if thick > THICKEST * thin:
            raise ValueError(
                f"shaft: diameters from {thin:g} to {thick:g} mm, but no shaft is {THICKEST} times thicker in one part than in "
                "another: give diameters in mm"
            )
        object.__setattr__(self, "bearings", _two("bearings", self.bearings, "positions [mm]"))
        stiff = self.bearing_stiffness
        stiffnesses = (stiff, stiff) if is_number(stiff) else stiff
        object.__setattr__(self, "bearing_stiffness", _two("bearing_stiffness", stiffnesses, "stiffnesses [N/mm]", least=0.0))
        if not hasattr(self.material, "shear_modulus"):
            raise ValueError(f"shaft: material = {self.material!r}, but give a Material")
        at = {"gear": self.gear, "bearings": self.bearings[0], "bearings ": self.bearings[1]}
        if self.torque is not None:
            at["torque"] = self.torque
        for name, value in at.items():
            if not (is_number(value) and 0 <= float(value) <= self.length * (1 + 1e-12)):
                raise ValueError(f"shaft: {name.strip()} = {value!r}, but the shaft reaches from 0 to {self.length:g} mm")
        if self.bearings[0] == self.bearings[1]:
            raise ValueError(f"shaft: both bearings at {self.bearings[0]:g} mm do not support it: give two positions")
        if self.integral and self.torque is None:
            raise ValueError(
                "shaft: integral = True needs the position torque [mm], because the shaft supports an integral gear: give torque"
            )

    @property
    def length(self) -> float:
        """Length of the shaft [mm]."""
        return sum(segment.length for segment in self.segments)

    @property
    def diameter(self) -> float:
        """Diameter of the shaft at the middle of its gear [mm]. At a step it is the smaller diameter."""
        ends = np.cumsum([0.0, *(segment.length for segment in self.segments)])
        near = 1e-9 * ends[-1]
        touch = [k for k in range(len(self.segments)) if ends[k] - near <= self.gear <= ends[k + 1] + near]
        return min(self.segments[k].diameter for k in touch)

    @property
    def tilts(self) -> bool:
        """True if a force in the middle of the gear tilts it, or bends it along its width."""
        return self.integral or self.support().tilts

    def turned(self) -> "Shaft":
        """Return the same shaft seen from its other end."""

        def mirrored(place: float) -> float:
            return self.length - place

        return replace(
            self,
            segments=self.segments[::-1],
            bearings=tuple(mirrored(place) for place in self.bearings),
            gear=mirrored(self.gear),
            torque=None if self.torque is None else mirrored(self.torque),
        )

    def untilted(self) -> Support:
        """Return the equivalent springs without coupling, for which a force displaces the gear without tilting it."""
        return self.support().untilted()

    def support(self) -> Support:
        """Return the equivalent spring stiffnesses of the shaft at mid-width of the gear, as a `Support`."""
        (soft, coupling), (_, tilt) = self.bends().tolist()
        twist = self.twists()
        coupling = coupling if abs(coupling) > NONE * math.sqrt(soft * tilt) else 0.0
        return Support(1 / soft, 1 / tilt, 1 / twist if twist else math.inf, coupling=coupling)

    def hub(self) -> Hub:
        """Return the compliance of the shaft as a `Hub` (for the contact solver)."""
        return self.support().hub()

    def bends(self) -> Floats:
        """Return displacement and slope ``(2, 2)`` at the gear by a unit force and a unit moment there."""
        return bending_flexibility(self.segments, self.material, self.bearings, self.bearing_stiffness, np.array([self.gear]))

    def twists(self) -> float:
        """Twist [rad] at the gear by a unit torque there [N mm]. Without a `torque` position it is zero."""
        if self.torque is None:
            return 0.0
        return float(twist_flexibility(self.segments, self.material, self.torque, np.array([self.gear]))[0, 0])


def _rows(segments):
    try:
        rows = [tuple(segment) for segment in segments]
    except TypeError:
        rows = []
    if not rows:
        raise ValueError(f"shaft: segments = {segments!r}, but give its parts: [(length, diameter), ...] [mm]")
    return rows


def _segment(i, row):
    right = len(row) in (2, 3) and all(is_number(v) and math.isfinite(v) for v in row)
    if not right:
        raise ValueError(
            f"shaft: part {i + 1} is {row!r}, but give (length, diameter) or (length, diameter, bore), numbers in mm"
        )
    length, diameter, bore = (*map(float, row), 0.0)[:3]
    if not (length > 0 and 0 <= bore < diameter):
        raise ValueError(
            f"shaft: part {i + 1} is {row!r}, but a part needs a length > 0 and a bore smaller than its diameter [mm]"
        )
    return ShaftPiece(length, diameter, bore)


def _two(name, values, what, least=-math.inf):
    try:
        numbers = tuple(float(value) for value in values)
    except (TypeError, ValueError, OverflowError):
        numbers = ()
    if len(numbers) != 2 or any(math.isnan(value) or not value > least for value in numbers):
        raise ValueError(f"shaft: {name} = {values!r}, but give two {what}{' > 0' if least == 0 else ''}")
    return numbers

"""`Crack`: a root crack of one tooth, with start, path, and open part along the width."""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

import numpy as np

from ..aliases import Floats
from ..kept import keeping
from ..tooth.gear import Gear
from ..tooth.profile import (
    cartesian,
    fillet_arc,
    fillet_length,
    lengths,
    root_curve,
    root_half_angle,
    tangent_point,
    tangent_range,
)
from .crack_form import STARTS, TANGENTS, check_front, check_path, corners_of, deepest, two_or_three
from .given import finite, tooth_and_side

SECTOR = 0.9  # part of a pitch in which a polyline crack can be meshed
SHORTEST = 1e-4  # shortest crack [m_n]; it changes k by 1e-5, and no mesh resolves less


@dataclass(frozen=True, slots=True)
class Crack:
    """A crack through the root of one tooth, described in the transverse section.

    It starts on the fillet and runs at `angle` to the tooth centre-line down towards it. Its size is `length` [mm], or
    `level`: at 0.5 the straight crack reaches the centre-line, so a straight crack of level p is p / 0.5 times as long as
    that. With ``turning=True`` it changes its direction at the centre-line towards the mirror image of its start. Level 1 is
    then the opposite fillet, where the tooth breaks off.

    Parameters
    ----------
    level, length : float
        Size of the crack, as a level (``0 < level < 1``) or as a length [mm]: give one of the two.
    angle : float
        Angle between the crack and the tooth centre-line [rad], default 45 degrees.
    start : {"30deg", "60deg", "root", "middle"} or float
        Where it starts: where the fillet's tangent makes 30 or 60 degrees with the centre-line of the tooth, where the fillet
        meets the root circle, or in the middle of the fillet's arc. ISO 6336-3 has its critical section at 30 degrees on external
        gears and at 60 degrees on rings. The default is 30 degrees on both. A number is the arc [mm] from where the fillet meets
        the root circle: up the fillet if it is positive, along the root circle if it is negative.
    turning : bool
    path : sequence of (float, float), optional
        Instead of a size: corners of a polyline after its start [mm], in the frame of its tooth. x points to the loaded flank, y
        outwards along the centre-line, both from the axis of the gear.
    tooth : int
        Number of the tooth: tooth k is in the pair that is k base pitches ahead of pair 0 (`gearfe.geometry.pair.contacts`).
    side : {"loaded", "unloaded"}
        Flank side on which it starts.
    width : (float, float), optional
        Heights z [mm] between which it is open, counted as those of a `Pit`; default: the whole width, in a herringbone gear that
        of both halves.
    ends : (float, float) or (float, float, float)
        The part of its length over which it is open at the two ends of `width`, linear in between: ``(1, 0)`` runs out. Three
        numbers: at one end, half-way and at the other end, a parabola in between.
    rounded : bool
        Whether it is the square of that part which is linear or a parabola: ``ends=(1, 0)`` is then the parabolic front of
        Z. Chen, Y. Shao, Eng. Fail. Anal. 18 (2011) 2149-2164, and ``ends=(0, 1, 0)`` half an ellipse.

    Raises
    ------
    ValueError
        If the description is contradictory. A crack that leaves its gear's body, or starts at a tangent that the fillet lacks, is
        rejected when it meets its gear.

    >>> Crack(level=0.6, width=(0.0, 12.5), ends=(1.0, 0.0)).width
    (0.0, 12.5)
    """

    level: float | None = None
    length: float | None = None
    angle: float = math.pi / 4
    start: str | float = "30deg"
    turning: bool = False
    tooth: int = 0
    side: str = "loaded"
    width: tuple[float, float] | None = None
    ends: tuple[float, ...] = (1.0, 1.0)
    rounded: bool = False
    path: tuple[tuple[float, float], ...] | None = None

    _nouns: ClassVar[tuple[str, str]] = ("crack", "cracks")
    _adjective: ClassVar[str] = "cracked"
    _removes_contact: ClassVar[bool] = False

    def __post_init__(self) -> None:
        """Raise ValueError for contradictory arguments."""
        for name in ("level", "length", "angle"):
            value = getattr(self, name)
            if value is not None:
                finite("crack", name, value)
        object.__setattr__(self, "tooth", tooth_and_side(self.tooth, self.side))
        if self.path is not None:
            object.__setattr__(self, "path", corners_of(self.path))
        check_path(self)
        if self.width is not None:
            object.__setattr__(self, "width", two_or_three("width", self.width, (2,)))
        object.__setattr__(self, "ends", two_or_three("ends", self.ends, (2, 3)))
        check_front(self)

    @property
    def through(self) -> bool:
        """Whether the crack has its whole depth over the whole width."""
        return self.width is None and self.even and self.ends[0] == 1.0

    @property
    def even(self) -> bool:
        """Whether the crack has the same depth at every height between its ends."""
        return len(set(self.ends)) == 1

    @property
    def bends(self) -> bool:
        """Whether the path is a polyline or has a kink at the tooth centre-line."""
        if self.path is not None:
            return len(self.path) > 1
        return self.turning and self.level is not None and self.level > 0.5

    def outline(self, gear: Gear) -> Floats:
        """Return the crack as a line ``(2, n)`` [mm] in the transverse section, in the frame of its tooth (`crack_path`)."""
        return crack_path(gear, self)

    def _description(self, gear: Gear) -> str:
        """Describe the size and the angle of the crack in words."""
        angle = f"at {math.degrees(self.angle):.3g} degrees"
        if self.path is not None:
            return f"{path_length(gear, self):.3g} mm crack along a path of {len(self.path)} part{'s' * (len(self.path) > 1)}"
        if self.length is not None:
            return f"{self.length:.3g} mm crack {angle}"
        if self.bends:
            return f"turning crack of level {self.level:.3g} {angle}"
        return f"{path_length(gear, self):.3g} mm crack {angle} (level {self.level:.3g})"

    def _warning(self, gear: Gear) -> str:
        """Return no warning."""
        return ""


@lru_cache(maxsize=256)
def start_arc(gear, crack):
    """Return the start of the crack as an arc length [mm] of `gearfe.geometry.tooth.profile.root_curve`."""
    if not isinstance(crack.start, str):
        least = root_half_angle(gear) * gear.r_f - math.pi / gear.z * gear.r_f
        if not least <= crack.start <= fillet_length(gear):
            raise ValueError(
                f"start = {crack.start} mm, but the root of z = {gear.z} goes from {least:.4g} (middle of the space) to "
                f"{fillet_length(gear):.4g} mm (end of the fillet)"
            )
        return float(crack.start)
    if crack.start == "root":
        return 0.0
    if crack.start == "middle":
        return fillet_length(gear) / 2
    inclination = TANGENTS[crack.start]
    least, largest = tangent_range(gear)
    if not least <= inclination <= largest:
        others = ", ".join(repr(name) for name in STARTS if least <= TANGENTS.get(name, least) <= largest)
        raise ValueError(
            f"start = {crack.start!r}, but the fillet's tangents make {math.degrees(least):.1f} to {math.degrees(largest):.1f} "
            f"degrees with the centre-line of a tooth of z = {gear.z}; use start = {others}"
        )
    return fillet_arc(gear, tangent_point(gear, inclination))


@keeping(256)
def crack_path(gear, crack):
    """Corners ``(2, 2 or 3)`` [mm] of the crack in the frame of its tooth (centre-line +y), from the fillet to its tip.

    ValueError if it leaves the body: reaches the held edge, the opposite fillet or the next tooth's sector.
    """
    first = cartesian(*root_curve(gear, start_arc(gear, crack)))
    heading = np.array([-math.sin(crack.angle), -gear.outward * math.cos(crack.angle)])
    corners = [first, *map(np.array, crack.path)] if crack.path else [first, first + heading * _straight(crack, first)]
    if crack.turning and crack.bends:
        goal = first * [-1, 1]
        corners.append(corners[1] + (goal - corners[1]) * (2 * crack.level - 1))
    path = np.array(corners).T
    _check_inside(gear, crack, path)
    return path if crack.side == "loaded" else path * [[-1], [1]]


def _straight(crack, first):
    """Return the length [mm] of a crack from its start (x, y) [mm] to its end or bend."""
    half = first[0] / math.sin(crack.angle)
    return crack.length if crack.length is not None else 2 * half * min(crack.level, 0.5 if crack.turning else 1.0)


def path_length(gear, crack):
    """Return the length of a straight crack where it is deepest [mm]."""
    if crack.path is not None:
        return float(lengths(crack_path(gear, crack))[-1])
    return float(deepest(crack) * _straight(crack, cartesian(*root_curve(gear, start_arc(gear, crack)))))


def meshed_path(gear, crack):
    """Return `crack_path`. A crack shorter than `SHORTEST`, which no mesh can represent, raises ValueError."""
    path = crack_path(gear, crack)
    length = math.dist(path[:, 0], path[:, 1])
    if length < SHORTEST * gear.m_n:
        least = f"leave it out, or give {SHORTEST * gear.m_n:.3g} mm or more"
        raise ValueError(
            f"crack of {_size(crack)}: {length:.3g} mm long, too short to be meshed at m_n = {gear.m_n:g} mm; {least}"
        )
    return path


def mirrored(gear, crack):
    """Return the mirror image [mm] of the crack's start in the frame of its tooth, at which a turning crack ends."""
    sign = -1 if crack.side == "loaded" else 1
    return cartesian(*root_curve(gear, start_arc(gear, crack))) * [sign, 1]


def check_apart(gear, cracks):
    """Raise ValueError if a crack extends beyond the face, or if two cracks of one tooth (nearly) meet."""
    for crack in cracks:
        if crack.width is not None and crack.width[1] > gear.b * (1 + 1e-9):
            raise ValueError(
                f"width = ({crack.width[0]:g}, {crack.width[1]:g}) mm: the crack opens beyond the face, "
                f"which ends at {gear.b:g} mm"
            )
    paths = [(crack.tooth % gear.z, crack.side, crack.width or (0.0, gear.b), crack_path(gear, crack)) for crack in cracks]
    for i, (tooth, side, width, path) in enumerate(paths):
        for other_tooth, other_side, other_width, other in paths[:i]:
            if tooth != other_tooth or width[1] <= other_width[0] or other_width[1] <= width[0]:
                continue
            if side == other_side:
                raise ValueError(f"two cracks on the {side} side of tooth {tooth}; give one")
            near = np.abs(sampled(path)[:, :, None] - sampled(other)[:, None, :])
            if np.hypot(*near).min() < 0.1 * gear.m_n:
                raise ValueError(f"two cracks of tooth {tooth} meet: the tooth breaks off; make one of them shorter")


def check_single(gear, cracks):
    """Raise ValueError if a body has two cracks on one side of a tooth, even at different heights."""
    if len({(crack.tooth % gear.z, crack.side) for crack in cracks}) < len(cracks):
        raise ValueError(f"two cracks on one side of a tooth (body of b = {gear.b:g} mm), but only one can be meshed: give one")


def check_through(cracks, what):
    """Raise ValueError if a crack changes along the width. `what` names the transverse model that cannot represent it."""
    for crack in cracks:
        if not crack.through:
            width = f"width = {crack.width} mm, " if crack.width else ""
            raise ValueError(
                f"crack with {width}ends = {crack.ends} changes along the width, but {what} models only cracks through the whole "
                "width: use method = 'ritz3d' or 'fe3d' of mesh_stiffness"
            )


def sampled(path: Floats, count: int = 200) -> Floats:
    """Return evenly numbered points ``(2, count)`` along a polyline ``(2, n)`` of a crack [mm]."""
    place = np.linspace(0, path.shape[1] - 1, count)
    return np.array([np.interp(place, np.arange(path.shape[1]), row) for row in path])


def check_sector(gear: Gear, crack: "Crack", part: float = SECTOR) -> None:
    """Raise ValueError if a crack leaves the middle `part` of its sector. A method can represent cracks only there."""
    turn = np.abs(np.arctan2(*sampled(crack_path(gear, crack)))).max()
    if turn > part * math.pi / gear.z:
        raise ValueError(
            f"crack of {_size(crack)}: it leaves the middle {part:.0%} of the sector of its tooth (z = {gear.z}): "
            "use method = 'fe'"
        )


def _size(crack):
    if crack.path is not None:
        return f"path = {crack.path}"
    return f"level = {crack.level}" if crack.level is not None else f"length = {crack.length} mm"


def _check_inside(gear, crack, path):
    tip = path[:, -1]
    angle = math.atan2(tip[0], tip[1])
    margin = 0.02 * gear.m_n
    if (gear.outward * (np.hypot(*sampled(path)) - gear.held)).min() < margin:
        where = "its tip" if path.shape[1] == 2 else "it"
        raise ValueError(
            f"crack of {_size(crack)}: {where} reaches the held edge of z = {gear.z} (radius {gear.held:g} mm); make it shorter"
        )
    if crack.path is None and abs(angle) > math.pi / gear.z:
        raise ValueError(f"crack of {_size(crack)}: it leaves the sector of its tooth (z = {gear.z}); make it shorter or steeper")
    arcs = np.linspace(-gear.r_f * math.pi / gear.z / 4, fillet_length(gear), 400)
    fillet_points = cartesian(*root_curve(gear, arcs)) * [[-1], [1]]
    if np.hypot(*(fillet_points - tip[:, None])).min() < margin:
        raise ValueError(
            f"crack of {_size(crack)}: its tip reaches the opposite fillet of z = {gear.z}, the tooth breaks off; make it shorter"
        )

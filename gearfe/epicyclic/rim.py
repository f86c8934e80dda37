"""What holds the rim of a ring: everywhere, an elastic bed, or pads of some width; and how the ring's teeth then yield.

A ring on pads is a ring that nothing holds, under the tractions p of its pads and moved as a whole by q::

    u_teeth = C f + B' p + R q,    u_pads = B f + A p + R_p q = -p / k,    R' f + R_p' p = 0

so that what pads add to the flexibility of the free ring is a small matrix, and one solve of the ring serves all layouts. On a
pad the rim moves along with it: tractions are Chebyshev polynomials over ``sqrt(1 - s**2)``, which rise at both ends of a pad as
they do under a stiff one. The mesh of the rim only gets them spread over some edges; what they do more close by is what they do
to a half-plane, known exactly.

References
----------
K. L. Johnson, Contact Mechanics, 1985, sec. 2.8 (tractions under a rigid punch).
"""

import math
from dataclasses import dataclass, field
from numbers import Integral, Real
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geometry.tooth.gear import Gear

from ..checks import truth
from .pads import Pads, among, by_teeth, pads_on
from .whole_gear import PLACES, WholeGear, between_teeth, motion

SURE = 1e-9  # of the largest singular value of the pads' balance: less, and the ring can move without force


@dataclass(frozen=True, slots=True)
class RimBed:
    """An elastic bed around the whole outer edge of a ring, for example a press fit or a soft sleeve.

    Parameters
    ----------
    radial, tangential : float
        Stress on the edge per displacement [N/mm^3], both finite and > 0.

    Raises
    ------
    ValueError
        If one of them is not.
    """

    radial: float
    tangential: float

    def __post_init__(self) -> None:
        """Refuse a bed on which a ring turns freely."""
        for name in self.__slots__:
            value = _number(f"rim bed: {name}", getattr(self, name))
            if not 0 < value < math.inf:
                raise ValueError(
                    f"rim bed: {name} = {value:g} N/mm^3, but give a stiffness > 0; for a rim that is held give ring = 'held'"
                )
            object.__setattr__(self, name, value)


@dataclass(frozen=True, slots=True)
class RimSupports:
    """Equal, equally spaced pads on the outer edge (rim) of a ring: bolts, lands, pins. Between them the rim is free.

    Parameters
    ----------
    count : int
        Number of pads.
    width : float
        Arc of the rim that each pad holds [mm]. It matters: from 5 to 15 mm the stiffness of the mesh of planet and ring changes
        by a fifth.
    first : float
        Angle from the centre-line of the ring's tooth 0 to the middle of the first pad, clockwise [rad]. Tooth 0 of the ring is
        the one in mesh with planet 0 at position 0, in the newest pair of teeth there.
    radial, tangential : float
        Stiffness of each pad over the whole face width [N/mm]; default: rigid; 0: the pad does not hold in that direction. The
        rim on a pad stays an arc that moves as a whole, without tilting.
    pushes : bool
        Whether the pads are the flanks of lugs or splines, which only push against the torque of the ring and never pull. Needs
        ``radial=0``.

    Raises
    ------
    ValueError
        If a number is out of range, or the pads would not hold the ring.
    """

    count: int
    width: float
    first: float = 0.0
    radial: float = math.inf
    tangential: float = math.inf
    pushes: bool = False

    def __post_init__(self) -> None:
        """Refuse pads that cannot be or do not hold."""
        if isinstance(self.count, bool) or not isinstance(self.count, Integral) or self.count < 1:
            raise ValueError(f"rim supports: count = {self.count!r}, but a ring that nothing holds moves away: give at least 1")
        for name in ("width", "first", "radial", "tangential"):
            object.__setattr__(self, name, _number(f"rim supports: {name}", getattr(self, name)))
        if not 0 < self.width < math.inf:
            raise ValueError(f"rim supports: width = {self.width:g} mm, but a pad needs one: give the arc of the rim it holds")
        if not math.isfinite(self.first):
            raise ValueError(f"rim supports: first = {self.first:g} rad, but give a finite angle")
        for name in ("radial", "tangential"):
            if not getattr(self, name) >= 0:
                raise ValueError(f"rim supports: {name} = {getattr(self, name):g} N/mm, but give 0 or more")
        if not self.tangential > 0:
            raise ValueError("rim supports: tangential = 0 N/mm, but then nothing takes the ring's torque: give more than 0")
        object.__setattr__(self, "pushes", truth("rim supports: pushes", self.pushes))
        if self.pushes and self.radial:
            raise ValueError("rim supports: pads that only push have no radial force: give radial = 0")
        if self.count < (1 if self.radial and math.isinf(self.radial) else 2 if self.radial else 3):
            raise ValueError(f"rim supports: count = {self.count}, but so few of these do not hold the ring: give 3 or more")

    @property
    def middles(self) -> NDArray[np.float64]:
        """Angles of the pads' middles, clockwise from the ring's tooth 0 [rad]."""
        return self.first + np.linspace(0, 2 * math.pi, self.count, endpoint=False)

    def ends(self, gear: Gear) -> NDArray[np.float64]:
        """Angles of both ends of all pads on the rim of a ring [rad]."""
        reach = self.width / (2 * gear.held)
        return np.concatenate([self.middles - reach, self.middles + reach])

    def covers(self, gear: Gear, places: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Whether `places` ``(2, n)`` on the rim lie on a pad, its ends included."""
        away = np.arctan2(*places)[:, None] - self.middles + math.pi
        return np.abs(away % (2 * math.pi) - math.pi).min(axis=1) < self.width / (2 * gear.held) + 1e-9


def _number(name, value):
    if isinstance(value, bool) or not isinstance(value, Real) or math.isnan(value):
        raise ValueError(f"{name} = {value!r}, but it needs a number")
    return float(value)


@dataclass(frozen=True, slots=True)
class Rim:
    """A ring's teeth as what holds its rim lets them move, per mm of width (z teeth, `PLACES` loads on each right flank).

    `more` ``(z, PLACES, z, PLACES)`` is added to the flexibility with the rim held. With p pads' tractions per load `reaction`
    ``(p, z, PLACES)``, and motions of the whole ring `moves` ``(3, z, PLACES)``: along x, along y [mm], clockwise turn [rad].
    Lugs that only push (l of them) are contacts of their own: `lug` ``(l, l)`` and `across` ``(l, z, PLACES)`` their flexibility,
    `turns` ``(3, l)`` and `gives` ``(3, z, PLACES)`` what motions of the whole ring do to them and to the loads.
    """

    whole: WholeGear
    more: NDArray[np.float64]
    pads: Pads | None = None
    reaction: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 0, 0)))
    moves: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 0, 0)))
    lug: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 0)))
    across: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 0, 0)))
    turns: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 0)))
    gives: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 0, 0)))


def check_support(support: Any, gear: Gear) -> None:
    """ValueError unless it is ``"held"``, `RimBed` or `RimSupports` whose pads find room on the rim of `gear`."""
    if not (isinstance(support, (RimBed, RimSupports)) or (isinstance(support, str) and support == "held")):
        raise ValueError(
            f"ring = {support!r}, but give 'held', RimBed(...) or RimSupports(...): a ring that nothing holds moves away"
        )
    rim = 2 * math.pi * gear.held
    if isinstance(support, RimSupports) and support.count * support.width > rim * (1 - 1e-9):
        raise ValueError(
            f"ring: {support.count} pads of {support.width:g} mm are longer than its rim, {rim:.5g} mm: give ring = 'held', or "
            f"less than {rim / support.count:.4g} mm"
        )


def ring_on(whole: WholeGear, support: "str | RimBed | RimSupports", width: float) -> Rim:
    """`Rim` of a ring by what holds it; pads' stiffnesses are shared by the face `width` [mm].

    Raises
    ------
    ValueError
        As of `check_support`, or if the ring could move without force.
    """
    gear = whole.gear
    check_support(support, gear)
    if isinstance(support, RimBed):
        return Rim(whole, between_teeth(whole.bedded(np.array([support.radial, support.tangential]))))
    if not isinstance(support, RimSupports):
        return Rim(whole, np.zeros((gear.z, PLACES) * 2))
    more, moved = whole.loose()
    pads = pads_on(whole, support, width, moved)
    teeth = between_teeth(more)
    across, between = by_teeth(pads), among(pads) + pads.compliance
    gives = _moves(gear)
    if support.pushes:
        return Rim(whole, teeth, pads, lug=between, across=across, turns=pads.turns, gives=gives)
    p, n = pads.compliance.shape[0], gear.z * PLACES
    scale = np.diag(between).mean()
    unit = scale * np.array([1.0, 1.0, 1 / gear.held])[:, None]  # so that all of the system is of one size
    system = np.block([[between, (unit * pads.turns).T], [unit * pads.turns, np.zeros((3, 3))]])
    if np.linalg.svd(unit * pads.turns, compute_uv=False)[-1] < SURE * scale:
        raise ValueError("ring: these pads let it move without force: give more of them, or hold both directions")
    right = np.concatenate([across.reshape(p, n), unit * gives.reshape(3, n)])
    solved = -np.linalg.solve(system, right)
    more = teeth.reshape(n, n) + right.T @ solved
    shape = gear.z, PLACES
    return Rim(
        whole, ((more + more.T) / 2).reshape(*shape, *shape), pads, solved[:p].reshape(p, *shape),
        (unit * solved[p:]).reshape(3, *shape),
    )  # fmt: skip


def _moves(gear):
    """How loads ``(3, z, PLACES)`` move with the whole ring: along x, along y, by a clockwise turn."""
    x, y, turn = motion(gear)[:, :PLACES]
    angle = 2 * math.pi / gear.z * np.arange(gear.z)[:, None]
    cos, sin = np.cos(angle), np.sin(angle)
    return np.array([cos * x + sin * y, cos * y - sin * x, np.broadcast_to(turn, (gear.z, PLACES))])


def rim_moved(rim: Rim, loads: NDArray[np.float64], tractions: NDArray, whole: NDArray) -> NDArray[np.float64]:
    """Displacement ``(nodes, 2)`` of the rim's nodes, outwards and clockwise [mm]; their angles are those of `rim_angles`.

    Parameters
    ----------
    rim : Rim
        On pads.
    loads : ndarray, shape (z, PLACES)
        On the teeth [N/mm].
    tractions : ndarray, shape (p,)
        Of the pads [N/mm].
    whole : ndarray, shape (3,)
        Motion of the whole ring: along x, y [mm], clockwise turn [rad].
    """
    assert rim.pads is not None
    gear, pads, r = rim.whole.gear, rim.pads, rim.whole.edge
    waves = np.einsum("hra,ha->hr", pads.moved[:, :, :PLACES], np.fft.rfft(loads, axis=0))
    waves += np.einsum("hrs,hs->hr", pads.moved[:, :, -r:], np.fft.rfft(pads.load @ tractions, axis=0))
    moved = np.fft.irfft(waves, n=gear.z, axis=0).reshape(-1, 2)
    angle = rim_angles(rim.whole)
    sin, cos = np.sin(angle), np.cos(angle)
    x, y, turn = whole
    return moved + np.column_stack([sin * x + cos * y, cos * x - sin * y + gear.held * turn])


def rim_angles(whole: WholeGear) -> NDArray[np.float64]:
    """Angles of all nodes of the rim, clockwise from the centre-line of tooth 0 [rad]."""
    sectors = 2 * math.pi / whole.gear.z * np.arange(whole.gear.z)
    return (sectors[:, None] + whole.angle).ravel()

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

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from geometry.tooth.gear import Gear

from ..elements.elasticity import GAUSS_3
from ..flexibility.hertz import half_plane, hat_logarithm
from .whole_gear import PLACES, WholeGear, between_teeth, motion

TERMS = 10  # polynomials on a pad, radial and tangential
POINTS = 64  # of their quadrature
FINE = 400  # the same, where a polynomial meets a jump
SPREAD = 3  # edges of the rim to either side over which the mesh is given a traction as a hat
SURE = 1e-9  # of the largest singular value of the pads' balance: less, and the ring can move without force


@dataclass(frozen=True, slots=True)
class RimBed:
    """An elastic bed around the whole rim, for example a press fit or a soft sleeve.

    Parameters
    ----------
    radial, tangential : float
        Traction by displacement [N/mm^3].

    Raises
    ------
    ValueError
        If it does not hold the ring.
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
    """Equal pads around the rim: bolts, lands, pins. Between them the rim is free.

    Parameters
    ----------
    count : int
    width : float
        Arc of the rim that each pad holds [mm]. It decides: a pad of 5 mm and one of 15 differ by a fifth in k of planet and
        ring.
    first : float
        Angle from the centre-line of the ring's tooth 0 to the middle of the first pad, clockwise [rad].
    radial, tangential : float
        Stiffness of each pad over the whole face width [N/mm]; default rigid, 0: it does not hold in that direction. A pad does
        not turn.
    pushes : bool
        The pads are the flanks of lugs or splines, which only push against the torque of the ring: no radial force, and none
        that pulls. Needs ``radial=0``.

    Raises
    ------
    ValueError
        If the pads cannot be, or would not hold the ring.
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
        if self.pushes and self.radial:
            raise ValueError("rim supports: pads that only push have no radial force: give radial = 0")
        if self.count < (1 if self.radial and math.isinf(self.radial) else 2 if self.radial else 3):
            raise ValueError(f"rim supports: count = {self.count}, but so few of these do not hold the ring: give 3 or more")

    @property
    def middles(self) -> NDArray[np.float64]:
        """Angles of the pads' middles, clockwise from the ring's tooth 0 [rad]."""
        step = 2 * math.pi / self.count
        return np.array([self.first + k * step for k in range(self.count)])

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
    pads: "Pads | None" = None
    reaction: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 0, 0)))
    moves: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 0, 0)))
    lug: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 0)))
    across: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 0, 0)))
    turns: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 0)))
    gives: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 0, 0)))


@dataclass(frozen=True, slots=True)
class Pads:
    """Tractions of pads on the rim: nodal forces `load` ``(z, r, p)``, forces x, y and clockwise torque `turns` ``(3, p)``.

    `compliance` ``(p, p)`` is added to how the rim's mesh moves under them [mm per N/mm]: of springs, and close to each pad.
    `moved` are the edge's displacements by harmonic, as of `WholeGear.loose`.
    """

    load: NDArray[np.float64]
    turns: NDArray[np.float64]
    compliance: NDArray[np.float64]
    moved: NDArray[np.complex128]


def ring_on(whole: WholeGear, support: "str | RimBed | RimSupports", width: float) -> Rim:
    """`Rim` of a ring by what holds it; pads' stiffnesses are shared by the face `width` [mm].

    Raises
    ------
    ValueError
        If pads overlap, or the ring could move without force.
    """
    gear = whole.gear
    if support == "held":
        return Rim(whole, np.zeros((gear.z, PLACES) * 2))
    if isinstance(support, RimBed):
        return Rim(whole, between_teeth(whole.bedded(np.array([support.radial, support.tangential]))))
    if not isinstance(support, RimSupports):
        raise ValueError(
            f"ring = {support!r}, but give 'held', RimBed(...) or RimSupports(...): a ring that nothing holds moves away"
        )
    more, moved = whole.loose()
    pads = _pads(whole, support, width, moved)
    teeth = between_teeth(more)
    across, between = _by_teeth(pads, gear.z), _among(pads) + pads.compliance
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


def _pads(whole, support, width, moved):
    """`Pads`: their Chebyshev tractions as nodal forces."""
    gear, z, nodes = whole.gear, whole.gear.z, whole.angle.size
    if support.count * support.width > 2 * math.pi * gear.r_rim * (1 - 1e-9):
        raise ValueError(
            f"ring: {support.count} pads of {support.width:g} mm are longer than its rim, {2 * math.pi * gear.r_rim:.5g} mm: "
            "give ring = 'held'"
        )
    step = 4 * math.pi / (z * nodes)  # of an edge of the rim
    terms = 1 if support.pushes else TERMS
    place = np.cos((np.arange(POINTS) + 0.5) * math.pi / POINTS)
    shapes = chebyshev.chebvander(place, terms - 1) / POINTS
    stiff = (support.radial, support.tangential)
    held = [which for which in (0, 1) if stiff[which] > 0]
    hats = [_hat(which, step, z * nodes) for which in (0, 1)]
    columns, turns, compliance, local = [], [], [], []
    for k in range(support.count):
        angle = support.first + 2 * math.pi * k / support.count + place * support.width / (2 * gear.r_rim)
        at = (angle + math.pi / z) / step  # in edges from the first corner
        number = np.arange(math.floor(at.min()), math.floor(at.max()) + 2)
        weight = np.maximum(1 - np.abs(number[:, None] - at), 0.0) @ shapes
        out, inx = np.sin(angle), np.cos(angle)
        force = np.array([out, inx, 0 * angle]), np.array([inx, -out, np.full(angle.size, gear.r_rim)])
        for which in held:
            hat = zip(number.tolist(), weight, strict=True)  # of each vertex under the pad: every second node, two unknowns each
            columns.append(sum(np.roll(hats[which], 4 * n)[:, None] * row for n, row in hat))
            turns.append(force[which] @ shapes)
            compliance.append(np.append(width / stiff[which], np.zeros(terms - 1)))
        edge = step * gear.r_rim
        local.append(_sharper(whole, support.width, number * edge, edge, weight)[np.ix_(held, held)])
    p = len(held) * terms
    total = np.zeros((support.count * p,) * 2)
    for k, own in enumerate(local):
        total[k * p : (k + 1) * p, k * p : (k + 1) * p] = own.transpose(0, 2, 1, 3).reshape(p, p)
    load = np.concatenate(columns, axis=1).reshape(z, 2 * nodes, -1)
    return Pads(load, np.concatenate(turns, axis=1), total + np.diag(np.concatenate(compliance)), moved)


def _hat(which, step, count):
    """Forces ``(2 count,)`` on rim nodes of a unit hat of traction, radial (0) or tangential (1), its top on the first node."""
    points, weights = GAUSS_3
    edges = np.arange(-SPREAD, SPREAD)
    angle = step * (edges[:, None] + (points + 1) / 2)
    share = (1 - np.abs(angle) / (SPREAD * step)) * weights / (2 * SPREAD)
    return _nodal(angle.ravel(), which, step / 2, count) @ share.ravel()


def _nodal(angle, which, step, count):
    """Forces ``(2 count, n)`` on rim nodes, radial and tangential, of unit forces at `angle` from the first node."""
    edge = np.floor(angle / (2 * step)).astype(int)
    t = angle / step - 2 * edge - 1
    shapes = np.array([t * (t - 1) / 2, 1 - t**2, t * (t + 1) / 2])
    out, column = np.zeros((2 * count, angle.size)), np.arange(angle.size)
    for a, shape in enumerate(shapes):
        lean = angle - step * (2 * edge + a)
        parts = (np.cos(lean), np.sin(lean)) if which == 0 else (-np.sin(lean), np.cos(lean))
        for direction, part in enumerate(parts):
            np.add.at(out, (2 * ((2 * edge + a) % count) + direction, column), shape * part)
    return out


def _sharper(whole, width, tops, edge, weight):
    """What a pad's own tractions move it more than those that the hats spread ``(2, 2, terms, terms)`` [mm per N/mm].

    Both differ only near by, where the rim is a half-plane. On it tractions ``T_n(s) / (pi sqrt(1 - s**2))`` move the surface
    along themselves by c ``ln(4 / width)`` (n = 0) or ``c T_n(s) / n``, and across by the jump of Flamant's field.
    """
    terms, material = weight.shape[1], whole.material
    knots = tops + SPREAD * edge * np.array([[-1], [0], [1]])
    along = np.append(math.log(4 / width), 1 / (2 * np.arange(1, terms)))
    direct = half_plane(material, whole.state) * (np.diag(along) - weight.T @ hat_logarithm(knots, knots) @ weight)
    modulus = material.plane_modulus(whole.state)
    ratio = material.nu / (1 - material.nu) if whole.state == "plane strain" else material.nu
    angle, order = (np.arange(FINE) + 0.5) * math.pi / FINE, np.arange(1, terms)
    ahead = np.column_stack([1 - 2 * angle / math.pi, -2 * np.sin(angle[:, None] * order) / (math.pi * order)])
    jump = np.cos(angle[:, None] * np.arange(terms)).T @ ahead / FINE
    masses = np.array([1.0, -2.0, 1.0]) / (SPREAD * edge) ** 2  # second derivative of a unit hat
    apart = knots[:, :, None, None] - knots
    spread = np.einsum("p,pnqm,q->nm", masses, np.sign(apart) * apart**4 / 24, masses)
    across = -(1 - ratio) / (2 * modulus) * (jump - weight.T @ spread @ weight)
    return np.array([[direct, across], [across.T, direct]])


def _series(load):
    """Harmonics ``(h, r, p)`` of nodal forces ``(z, r, p)``."""
    return np.fft.rfft(load, axis=0)


def _among(pads):
    """Displacement ``(p, p)`` of pads under each other's tractions."""
    z, waves = pads.load.shape[0], _series(pads.load)
    r = waves.shape[1]
    weight = np.full(waves.shape[0], 2.0)
    weight[0] = 1.0
    if z % 2 == 0:
        weight[-1] = 1.0
    out = np.einsum("h,hrp,hrs,hsq->pq", weight, waves.conj(), pads.moved[:, :, -r:], waves, optimize=True).real / z
    return (out + out.T) / 2


def _by_teeth(pads, z):
    """Displacement ``(p, z, PLACES)`` of pads under loads on the teeth."""
    waves = _series(pads.load)
    found = np.einsum("hrp,hra->hpa", waves.conj(), pads.moved[:, :, :PLACES], optimize=True)
    return np.fft.irfft(found.conj(), n=z, axis=0).transpose(1, 0, 2)


def _moves(gear):
    """How loads ``(3, z, PLACES)`` move with the whole ring: along x, along y, by a clockwise turn."""
    x, y, turn = motion(gear)[:, :PLACES]
    angle = 2 * math.pi / gear.z * np.arange(gear.z)[:, None]
    cos, sin = np.cos(angle), np.sin(angle)
    return np.array([cos * x + sin * y, cos * y - sin * x, np.broadcast_to(turn, (gear.z, PLACES))])


def rim_moved(rim: Rim, loads: NDArray[np.float64], tractions: NDArray, whole: NDArray) -> NDArray[np.float64]:
    """Displacement ``(nodes, 2)`` of the rim, radial and clockwise, and angles of its nodes, under `loads` ``(z, PLACES)``.

    Parameters
    ----------
    rim : Rim
        On pads.
    loads : ndarray, shape (z, PLACES)
        [N/mm].
    tractions : ndarray, shape (p,)
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
    return moved + np.column_stack([sin * x + cos * y, cos * x - sin * y + gear.r_rim * turn])


def rim_angles(whole: WholeGear) -> NDArray[np.float64]:
    """Angles of all nodes of the rim, clockwise from the centre-line of tooth 0 [rad]."""
    sectors = 2 * math.pi / whole.gear.z * np.arange(whole.gear.z)
    return (sectors[:, None] + whole.angle).ravel()

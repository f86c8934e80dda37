"""Contact problem of a whole planetary set at one position: flexibility, gaps and motions of all contacts, and results."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..flexibility.hertz import contact_modulus
from ..geometry.aliases import Floats
from .balance import Problem, balance
from .case import PlanetaryCase
from .crack_contacts import crack_contacts
from .cracked import CrackOpenings
from .meshes import PlacedContacts
from .rim import Rim
from .standing import Standing, directions
from .whole_gear import PLACES, carry


class BodyTables(NamedTuple):
    """Tables of the flexibility of healthy gears between their meshes [mm per N/mm], from `gearfe.planetary_sets.whole_gear`.

    `sun` and `ring` ``(z, PLACES, z, PLACES)`` relate displacements of right flanks to loads on right flanks. `planet`
    ``(z, PLACES, PLACES)`` relates displacements of a right flank to loads on a left flank, by the number of teeth between
    them. `rim` is the additional flexibility by the support of the ring. `faces` are the crack openings (`CrackOpenings`), by
    the gear names of `PlanetaryCase`.
    """

    sun: Floats
    planet: Floats
    ring: Floats
    rim: Rim
    faces: dict[Any, CrackOpenings]


class Position(NamedTuple):
    """Solution at one position: line loads [N/mm], lengths [mm] along the line of action.

    `loads`, `closing`, `rim` and `gap` ``(2, planets)`` belong to the meshes with the sun and with the ring: load, approach
    beyond the first touch, its part by the ring's support, and the unloaded gap by flanks and pin position errors. `turn` is
    the rotation of the sun, `orbit` (x, y) the motion of its axis [mm]. `pairs` are (inner, planet, number of the pair after
    the newest, pinion's tooth, line load). `on_ring` ``(z, PLACES)`` are the loads on the ring, and `lugs` those on its lugs.
    `whole` ``(3,)`` is the rigid motion of a ring on lugs, and `opened` ``(e,)`` are the openings of its cracks. `shut` is
    true if crack faces touch.
    """

    loads: Floats
    closing: Floats
    rim: Floats
    gap: Floats
    turn: float
    orbit: Floats
    pairs: list[tuple[int, int, int, int, float]]
    on_ring: Floats
    lugs: Floats
    whole: Floats
    opened: Floats
    shut: bool


class _Block(NamedTuple):
    """Contacts of one mesh in the contact problem, their teeth on pinion and wheel, and interpolation of their loads."""

    met: PlacedContacts
    inner: int
    planet: int
    at: slice
    teeth: tuple[NDArray[np.int64], NDArray[np.int64]]
    spread: tuple[Floats, Floats]


class Set:
    """Flexibilities of a `PlanetaryCase`, and a solver for its positions. `planetary_stiffness` describes `coupled`."""

    def __init__(self, case: PlanetaryCase, bodies: BodyTables, stand: Standing, coupled: bool) -> None:
        self.case, self.bodies, self.stand, self.coupled = case, bodies, stand, coupled
        angles = np.array(case.planet_angles)
        outer, inner = directions(case.gears, angles)
        self.push = np.array([outer, inner]).mT  # unit forces on the planets, shape (2, planets, 2)
        out = np.array([np.sin(angles), np.cos(angles)]).T
        along = np.array([np.cos(angles), -np.sin(angles)]).T
        error = np.array(case.errors)
        self.behind = np.einsum("kpd,pd->kp", self.push, error[:, :1] * out + error[:, 1:] * along)
        self._modulus = [contact_modulus(case.material[k : k + 2]) for k in (0, 1)]
        self._spread: dict[int, Any] = {}

    def solved(self, i: int, met: list[list[PlacedContacts]]) -> Position:
        """Solve position i, starting from the contacts `met` of its meshes."""
        blocks = self._blocks(met)
        problem = self._problem(blocks)
        cracks = crack_contacts(self.bodies.faces, blocks, problem.gap.size, self._lugs, apart=not self.coupled)
        if cracks is None:
            return self._read(blocks, *balance(problem), problem)
        problem = problem._replace(flexibility=problem.flexibility + cracks.more)
        force, motion = balance(problem)
        opened, shut = cracks.by_loads @ force, False
        if cracks.overlap(opened):
            shut, faces = True, cracks.by_loads[cracks.touch]
            total = np.block([[problem.flexibility, faces.T], [faces, cracks.ease[np.ix_(cracks.touch, cracks.touch)]]])
            still = np.zeros((faces.shape[0], problem.closing.shape[1]))
            force, motion = balance(problem.with_more(total, np.vstack([problem.closing, still])))
            force, pressed = force[: problem.gap.size], force[problem.gap.size :]
            opened = cracks.by_loads @ force + cracks.ease[:, cracks.touch] @ pressed
        return self._read(blocks, force, motion, problem, opened[cracks.ring], shut)

    def _blocks(self, met):
        out, stop = [], 0
        for inner, row in enumerate(met):
            for planet, one in enumerate(row):
                at = slice(stop, stop := stop + one.contacts.gap.size)
                slots = self._slots(one.contacts, inner)
                # teeth, clockwise: sun j meets planet C - j; planet -j' meets ring D - j'
                first = (self.stand.planet, self.stand.ring)[inner][planet]
                teeth = slots[0] + one.first
                out.append(_Block(one, inner, planet, at, ((-1 if inner else 1) * teeth, first - teeth), slots[1]))
        return out

    def _slots(self, contacts, inner):
        """Return the orders of the touching pairs, and the interpolation of loads on their teeth, for pinion and wheel."""
        key = id(contacts)
        if key not in self._spread:
            pair = self.case.pairs[inner]
            orders = np.unique(contacts.order)
            on = contacts.order[:, None] == orders
            both = []
            for gear, roll, turn in (
                (pair.gear_1, contacts.roll_1, contacts.turn_1),
                (pair.gear_2, contacts.roll_2, contacts.turn_2),
            ):
                rows = carry(gear, roll) * turn[:, None]
                both.append((on[:, :, None] * rows[:, None]).reshape(roll.size, -1))
            self._spread[key] = orders, tuple(both), contacts  # The reference to `contacts` prevents reuse of its id.
        return self._spread[key]

    def _between(self, a, b):
        """Return the flexibility between the contacts of two meshes, or None if they share no gear or have no interaction."""
        gears, bodies = self.case.gears, self.bodies
        if a.inner and b.inner:
            rows, columns, side = a.teeth[1] % gears.ring.z, b.teeth[1] % gears.ring.z, (1, 1)
            at = np.ix_(rows, range(PLACES), columns, range(PLACES))
            own = bodies.rim.more[at] if a is b else bodies.ring[at] + bodies.rim.more[at]
        elif a is b:
            return None
        elif not (a.inner or b.inner):
            rows, columns, side = a.teeth[0] % gears.sun.z, b.teeth[0] % gears.sun.z, (0, 0)
            own = bodies.sun[np.ix_(rows, range(PLACES), columns, range(PLACES))]
        elif a.planet == b.planet:
            side, z = (1, 0), gears.planet.z
            own = bodies.planet[(a.teeth[1][:, None] - b.teeth[0]) % z].transpose(0, 2, 1, 3)
        else:
            return None
        rows, columns = a.spread[side[0]], b.spread[side[1]]
        return rows @ own.reshape(rows.shape[1], columns.shape[1]) @ columns.T

    def _problem(self, blocks):
        """Return the `Problem` of a position.

        Motions are those of the sun (rotation; x, y if floating), planets, and a loose ring.
        """
        case, n = self.case, blocks[-1].at.stop
        total, closing = np.zeros((n, n)), np.zeros((n, self._motions))
        give = case.width / case.pin
        for k, a in enumerate(blocks):
            total[a.at, a.at] = a.met.contacts.flexibility
            for b in blocks[k:]:
                if self.coupled:
                    more = self._between(a, b)
                    if more is not None:
                        total[a.at, b.at] += more
                if a.planet == b.planet:
                    total[a.at, b.at] += give * (self.push[a.inner, a.planet] @ self.push[b.inner, b.planet])
                if a is not b:
                    total[b.at, a.at] = total[a.at, b.at].T
            closing[a.at] = self._closing(a)
        values = {
            name: np.concatenate([getattr(block.met.contacts, name) for block in blocks])
            for name in ("coefficient", "radius", "tilt")
        }
        gap = np.concatenate([block.met.contacts.gap + self.behind[block.inner, block.planet] for block in blocks])
        modulus = np.concatenate([np.full(block.met.contacts.gap.size, self._modulus[block.inner]) for block in blocks])
        load = np.zeros(self._motions)
        load[0] = case.planets * case.force / case.width
        problem = Problem(total, gap, values["coefficient"], values["radius"], modulus, values["tilt"], closing, load)
        return self._with_lugs(problem, blocks) if self._lugs else problem

    @property
    def _lugs(self):
        return self.bodies.rim.lug.shape[0]

    @property
    def _motions(self):
        return 1 + 2 * self.case.floating + self.case.planets + 3 * bool(self._lugs)

    def _closing(self, block):
        """Return the closure of a mesh by unit motions of the bodies ``(motions,)``."""
        case, out = self.case, np.zeros(self._motions)
        first = 1 + 2 * case.floating
        if block.inner:
            out[first + block.planet] = 1.0
        else:
            out[0], out[first + block.planet] = 1.0, -1.0
            if case.floating:
                out[1:3] = self.push[0, block.planet]
        return out

    def _with_lugs(self, problem, blocks):
        """Return the problem extended by the lugs of the ring as contacts and by the ring's motions."""
        rim, lugs = self.bodies.rim, self._lugs
        n = problem.gap.size
        across, moves = np.zeros((lugs, n)), np.zeros((3, n))
        for block in blocks:
            if block.inner:
                teeth = block.teeth[1] % self.case.gears.ring.z
                across[:, block.at] = rim.across[:, teeth].reshape(lugs, -1) @ block.spread[1].T
                moves[:, block.at] = rim.gives[:, teeth].reshape(3, -1) @ block.spread[1].T
        closing = np.vstack([problem.closing, np.zeros((lugs, problem.closing.shape[1]))])
        closing[:, -3:] = -np.concatenate([moves, rim.turns], axis=1).T
        return problem.with_more(np.block([[problem.flexibility, across.T], [across, rim.lug]]), closing)

    def _read(self, blocks, force, motion, problem, opened=(), shut=False):
        """Return the `Position` from forces and motions."""
        case, z = self.case, self.case.gears.ring.z
        loads, closing, rim, gap = np.zeros((4, 2, case.planets))
        on_ring, pairs = np.zeros((z, PLACES)), []
        give = case.width / case.pin
        for one in blocks:
            loads[one.inner, one.planet] = force[one.at].sum()
            if one.inner:
                np.add.at(on_ring, one.teeth[1] % z, (force[one.at] @ one.spread[1]).reshape(-1, PLACES))
        moved = np.einsum("kpd,kp->pd", self.push, loads) * give
        back = np.einsum("kpd,pd->kp", self.push, moved) + self.behind
        released = np.einsum("tapb,pb->ta", self.bodies.rim.more, on_ring)
        if len(opened):
            released += np.einsum("e,eta->ta", opened, self.bodies.faces["ring"].released)
        for one in blocks:
            own = force[one.at]
            way = self._closing(one) @ motion - back[one.inner, one.planet]
            closing[one.inner, one.planet] = way - one.met.contacts.least
            gap[one.inner, one.planet] = self.behind[one.inner, one.planet] + one.met.contacts.least
            if one.inner and own.any():
                given = one.spread[1] @ released[one.teeth[1] % z].ravel()
                if self._lugs:
                    given = given - (problem.closing[one.at, -3:] @ motion[-3:]) + self._by_lugs(one, force)
                rim[one.inner, one.planet] = own @ given / own.sum()
            orders = one.met.contacts.order
            for order in np.unique(orders[own > 0]).tolist():
                tooth = (order + one.met.first) * (-1 if one.inner else 1)
                pairs.append((one.inner, one.planet, order + one.met.newest, tooth, float(own[orders == order].sum())))
        orbit = motion[1:3] if case.floating else np.zeros(2)
        lugs, whole = (force[-self._lugs :], motion[-3:]) if self._lugs else (np.zeros(0), np.zeros(3))
        return Position(loads, closing, rim, gap, float(motion[0]), orbit, pairs, on_ring, lugs, whole, np.array(opened), shut)

    def _by_lugs(self, one, force):
        """Return the displacement of the ring due to the lug forces, at the contacts of a mesh."""
        rim, lugs = self.bodies.rim, self._lugs
        teeth = one.teeth[1] % self.case.gears.ring.z
        return one.spread[1] @ (rim.across[:, teeth].reshape(lugs, -1).T @ force[-lugs:])

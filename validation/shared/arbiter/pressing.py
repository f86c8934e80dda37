"""Two gears pressed together with their whole outlines: contact pressures, approach and mesh stiffness.

The unknowns are the forces p of hat function pressures in all zones and the approach delta, shared by both gears::

    C p + gap - delta c >= 0,    p >= 0,    one of both zero,    c . p = F

C is the flexibility of both gears along the normals, by finite elements of whole gears. The gap is that of the rigid outlines
in the unloaded pose along the same normals, computed near the loaded pose and moved back by c. c is the rate at which a shared
approach closes the gap. Crack faces are treated alike with zero gap and c. They may open but not overlap. By virtual work ``c .
p = (T1 / r_b1 + T2 / r_b2) / 2``: this is the force F along the line of action, and ``k = F / (delta - least gap)``.
"""

import time
from dataclasses import dataclass, field, replace

import numpy as np

from .body import MeshedBody
from .outline import Outline
from .side import Side
from .touching import FirstTouch, Press, orders, stand, touching
from .zones import WIDER, Contact, found, hats, placed

SPRING = 0.065  # estimated stiffness of a tooth pair over width and Young's modulus, to find the pairs that may touch
FIRST = 0.5  # refinement of the first pass, which only locates the pressure
OPEN = 1.3  # Pairs with gaps up to this multiple of the approach may touch.
STEPS = 300  # limit of steps in the search for loaded hat functions


@dataclass
class Result:
    """Stiffness [N/mm per mm of width] at the phases, with its data (arrays ``(phases,)`` unless stated)."""

    k: np.ndarray
    error: np.ndarray
    approach: np.ndarray
    least: np.ndarray
    force: list
    edge: np.ndarray
    dofs: int
    cpu: float
    zones: list = field(default_factory=list)
    bodies: list = field(default_factory=list)


def pressed(pair, flanks, load, phases, material, *, cracks=((), ()), missing=((), ()), refines=(0.8, 1.2)):
    """Compute the mesh stiffness of a pair by whole outlines. Its error is the difference of two meshes.

    Parameters
    ----------
    pair : gearfe.GearPair
    flanks : (gearfe.Flank or None, gearfe.Flank or None) or None
    load : float
        [N/mm] of width along the line of action.
    phases : ndarray
    material : (float, float)
        Young's modulus [MPa] and Poisson's ratio of both gears.
    cracks : (sequence, sequence) of gearfe.Crack
        Of pinion and wheel: straight, through the whole width.
    missing : (sequence, sequence) of int
        Missing teeth of pinion and wheel; tooth k is in pair k.
    refines : sequence of float
        Meshes after the first pass; the last is the result. Its error is the larger of the two that its differences to the one
        before and to the first pass say, if errors fall with the square of edge lengths.

    Returns
    -------
    Result
    """
    started = time.process_time()
    outlines = [Outline(gear, flank) for gear, flank in zip(pair.gears, flanks or (None, None), strict=True)]
    contact = Contact(Press(pair, outlines), [Side(outline) for outline in outlines])
    states = [_Phase(contact, pair, phase, number, load, material, missing) for number, phase in enumerate(np.atleast_1d(phases))]
    zones = [state.first(FIRST) for state in states]
    answers = []
    for refine in (FIRST, *refines):
        if refine != FIRST:
            zones = [state.again(answer, refine) for state, answer in zip(states, answers[-1], strict=True)]
        bodies = _bodies(contact, zones, material, refine, cracks, missing)
        answers.append([state.solved(some, bodies) for state, some in zip(states, zones, strict=True)])
    k = np.array([[load / (one.approach - state.least) for one, state in zip(row, states, strict=True)] for row in answers])
    last, (middle, fine) = answers[-1], refines[-2:]
    return Result(
        k[-1],
        np.maximum(np.abs(k[-1] - k[-2]) / ((fine / middle) ** 2 - 1), np.abs(k[-1] - k[0]) / ((fine / FIRST) ** 2 - 1)),
        np.array([one.approach for one in last]),
        np.array([state.least for state in states]),
        [one.forces for one in last],
        np.array([one.edge for one in last]),
        sum(2 * body.nodes.shape[1] for body in bodies),
        time.process_time() - started,
        [(contact.sides, answer) for answer in last],
        bodies,
    )


@dataclass
class _Answer:
    approach: float
    pressed: list  # (zone, p, c, elastic shift) of each zone
    forces: dict  # by tooth pair: share of the load
    edge: bool  # True if pressure reaches the end of a zone


class _Phase:
    """One phase: poses of the tooth pairs, first touches, zones and contact."""

    def __init__(self, contact, pair, phase, number, load, material, missing):
        self.contact, self.number, self.load = contact, number, load
        self.order = orders(pair, phase)
        for gear, gone in zip(pair.gears, missing, strict=True):
            self.order = self.order[~np.isin(self.order % gear.z, np.array(gone, dtype=int) % gear.z)]
        self.stands = stand(pair, float(phase), self.order)
        self.touch = touching(contact.press, self.stands)
        self.least = float(self.touch.gap.min())
        self.modulus = material[0] / (2 * (1 - material[1] ** 2))
        self.spring = SPRING * material[0]
        gaps = np.sort(self.touch.gap[np.isfinite(self.touch.gap)])
        self.approach = min((load / self.spring + gaps[:n].sum()) / n for n in range(1, gaps.size + 1))

    def _pair(self, order):
        i = int(np.flatnonzero(self.order == order)[0])
        touch, at = self.touch, slice(i, i + 1)
        parts = (touch.approach, touch.own, touch.met)
        return self.stands[at], FirstTouch(*(part[:, at] for part in parts), touch.gear, touch.piece, touch.at[:, at])

    def first(self, refine):
        """Return the first zones, estimated from the rigid gaps and one spring for each tooth pair."""
        limit = self.least + OPEN * (self.approach - self.least)

        def shares(gap):
            return max(self.spring * (self.approach - gap), 0.02 * self.load)

        return self._found(limit, shares, refine)

    def _found(self, limit, shares, refine, known=()):
        zones = []
        for order, gap in zip(self.order, self.touch.gap, strict=True):
            if gap < limit and int(order) not in known:
                at = self.number, int(order)
                zones += found(self.contact, self._pair(order), at, limit, shares, self.modulus, refine)
        return zones

    def _missed(self, known, refine):
        """Return zones of pairs that the last approach closes. They were missed because teeth with cracks deflect more."""
        return self._found(self.approach, lambda gap: max(self.spring * (self.approach - gap), 0.02 * self.load), refine, known)

    def again(self, answer, refine):
        """Return zones adapted to the pressures of a solution. Overlapping zones of one tooth pair are joined."""
        windows = []
        for zone, p, _, shift in answer.pressed:
            window = _window(zone, p, shift)
            for other in windows:
                same = (other[0].order, other[0].own) == (zone.order, zone.own)
                if same and other[1] < window[2] and window[1] < other[2]:
                    other[1:3] = min(other[1], window[1]), max(other[2], window[2])
                    if window[4] > other[4]:
                        other[0], other[3], other[5] = zone, window[3], shift
                    other[4] += window[4]
                    break
            else:
                windows.append(window)
        zones = self._missed({zone.order for zone, *_ in windows}, refine)
        for zone, low, high, middle, force, shift in windows:
            half = (high - low) / 2
            stands, _ = self._pair(zone.order)
            middle = min(max(middle, low), high)
            width = min(half, max(min(middle - low, high - middle), 0.05 * half)) / (1 if force else 2)
            moved = replace(zone, middle=middle, force=force, shift=shift)
            zones.append(placed(self.contact, stands, moved, self.approach, (low, high), width, refine))
        return zones

    def solved(self, zones, bodies):
        """Solve the contact of all zones of this phase."""
        columns, gaps, rates = ([], []), [], []
        m = self.contact.press.outlines[0].gear.m_n
        for zone in zones:
            stands, _ = self._pair(zone.order)
            places, weight = hats(zone.s)
            gap, met, points, normals = self.contact.gaps(zone.own, stands, self.approach, places, zone.near, 1.5 * m, zone.shift)
            there = np.isfinite(gap)
            gap = np.where(there, gap, 1.0)
            rate = np.zeros(places.size)
            for gear, sense in ((zone.own, 1), (1 - zone.own, -1)):
                x, y = points[0] + (gap * normals[0] if sense < 0 else 0), points[1] + (gap * normals[1] if sense < 0 else 0)
                y = y - self.contact.press.centres[gear]
                rate += sense * self.contact.press.rates[gear] * (y * normals[0] - x * normals[1])
            # This rigid motion is already part of the deformation.
            moved = (zone.shift[1 - zone.own] - zone.shift[zone.own]) @ normals
            gaps.append(weight.T @ (gap + rate * self.approach - moved))
            rates.append(weight.T @ rate)
            heading = np.arctan2(*normals)
            for gear, s, sense in ((zone.own, places, -1.0), (1 - zone.own, np.where(there, met, 0.0), 1.0)):
                posed = self.contact.posed(gear, stands, self.approach)
                turned = bodies[gear].angle(zone.order) + posed.mirror * (heading - posed.turn)
                direction = sense * np.array([np.sin(turned), np.cos(turned)])
                columns[gear].append(bodies[gear].loads(zone.order, s, weight * there[:, None], direction))
        count = sum(zone.s.size for zone in zones)
        faces = [body.seam_loads() for body in bodies]
        bent: list = []
        total, at = np.zeros((count + sum(face.shape[1] for face in faces),) * 2), count
        for gear in (0, 1):
            loads = np.hstack([*columns[gear], faces[gear]])
            place = np.concatenate([np.arange(count), at + np.arange(faces[gear].shape[1])])
            solved = bodies[gear].solve(loads)
            total[np.ix_(place, place)] += loads.T @ solved
            at += faces[gear].shape[1]
            bent.append((solved, place))
        closed = np.zeros(at - count)
        p, approach = complementary(total, np.concatenate([*gaps, closed]), np.concatenate([*rates, closed]), self.load)
        moved = [solved @ p[place] for solved, place in bent]
        posed_at, self.approach = self.approach, approach
        ends = np.cumsum([zone.s.size for zone in zones])
        parts = []
        for zone, end, rate in zip(zones, ends, rates, strict=True):
            part = p[end - zone.s.size : end]
            parts.append((zone, part, rate, self._shift(zone, part, moved, bodies, posed_at) if part.max() > 0 else zone.shift))
        forces = {}
        for zone, part, rate, _ in parts:
            forces[zone.order] = forces.get(zone.order, 0.0) + float(part @ rate) / self.load
        edge = any(max(part[0], part[-1]) > 1e-3 * part.max() for _, part, *_ in parts if part.max() > 0)
        return _Answer(approach, parts, forces, edge)

    def _shift(self, zone, part, moved, bodies, approach):
        """Return the mean elastic displacement of both outlines in a zone, weighted with its pressure ``(2, 2)`` [mm]."""
        stands, _ = self._pair(zone.order)
        places, weight = hats(zone.s)
        mean = (weight @ part / part.sum())[:, None]
        met = np.interp(places, zone.s, np.where(np.isfinite(zone.met), zone.met, zone.near))
        shift = np.zeros((2, 2))
        for gear, s in ((zone.own, places), (1 - zone.own, met)):
            directions = np.eye(2)[:, :, None] * np.ones(places.size)
            x, y = (float(bodies[gear].loads(zone.order, s, mean, direction)[:, 0] @ moved[gear]) for direction in directions)
            posed = self.contact.posed(gear, stands, approach)
            turned = posed.turn + posed.mirror * (np.arctan2(x, y) - bodies[gear].angle(zone.order))
            shift[gear] = np.hypot(x, y) * np.array([np.sin(turned), np.cos(turned)])
        return shift


def _bodies(contact, zones, material, refine, cracks, missing):
    """Return both gears, meshed for all zones of all phases."""
    bodies = []
    for gear in (0, 1):
        side, marks = contact.sides[gear], {}
        for zone in [zone for some in zones for zone in some]:
            s = zone.s if gear == zone.own else zone.met
            good = np.isfinite(s)
            size = np.gradient(zone.s) if gear == zone.own else np.maximum(np.abs(np.gradient(s)), np.gradient(zone.s))
            size = np.where(np.isfinite(size), size, np.inf)
            marks.setdefault(zone.order % side.outline.gear.z, []).append((s[good], size[good]))
        marks = {tooth: tuple(np.concatenate(part) for part in zip(*some, strict=True)) for tooth, some in marks.items()}
        sense = 1 if gear == 0 else -1
        bodies.append(MeshedBody(side, sense, marks, *material, refine=refine, cracks=cracks[gear], missing=missing[gear]))
    return bodies


def complementary(matrix, gap, rate, load):
    """Return forces and approach: loaded hat functions close exactly, the others stay open (primal-dual active set).

    Raises
    ------
    RuntimeError
        If the set of loaded hat functions does not converge.
    """
    scale = np.where(np.diag(matrix) > 0, np.diag(matrix), 1.0)  # Hat functions without an opposite surface have a zero diagonal.
    meets = rate > 0
    pressed = meets & (gap <= np.sort(gap[meets])[min(3, meets.sum() - 1)])
    for _ in range(STEPS):
        on = np.flatnonzero(pressed)
        size = on.size
        system = np.zeros((size + 1, size + 1))
        system[:size, :size], system[:size, size], system[size, :size] = matrix[np.ix_(on, on)], -rate[on], rate[on]
        answer = np.linalg.solve(system, np.append(-gap[on], load))
        p = np.zeros(gap.size)
        p[on], approach = answer[:size], float(answer[size])
        opening = matrix @ p + gap - approach * rate
        pulls, cuts = pressed & (p < 0), ~pressed & (opening < -1e-13)
        if not pulls.any() and not cuts.any():
            return p, approach
        value = p - opening / scale
        pressed = np.where(pressed, p >= 0, value > 0) if not (pulls.any() and cuts.any() and size > 400) else pressed & ~pulls
    raise RuntimeError("the contact does not settle: the set of pressed places goes round in circles")


def _window(zone, p, shift):
    """Return the loaded part of a zone with a margin: zone, ends, place of the largest pressure, force and shift."""
    density = p / np.gradient(zone.s)
    on = np.flatnonzero(density > 1e-3 * density.max()) if p.max() > 0 else []
    if not len(on):
        return [zone, zone.s[0], zone.s[-1], zone.middle, 0.0, shift]
    low, high = zone.s[max(on[0] - 1, 0)], zone.s[min(on[-1] + 1, p.size - 1)]
    low = low if on[0] > 0 else low - (high - low)
    high = high if on[-1] < p.size - 1 else high + (high - low)
    margin = (WIDER - 1.2) * (high - low) / 2
    return [zone, low - margin, high + margin, float(zone.s[np.argmax(density)]), float(p.sum()), shift]

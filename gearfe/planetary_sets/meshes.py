"""Contacts of one mesh of a set at one phase: gaps and local flexibility, as in the contact of its pair.

`gearfe.contact.pair_contact.PairContact` computes them: smooth contacts with Hertz's logarithm, rows of hat functions at
corners and kinks, exact gaps, cracks.
"""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..contact.kinks import near_kink
from ..contact.pair_contact import PairContact
from ..contact.sliding import bounded
from ..flexibility.energy.ritz.plane import flexibility
from ..flexibility.section_contact import Solved
from ..geometry.aliases import Floats
from ..geometry.damage.chip import Chip
from ..geometry.damage.crack import Crack
from ..geometry.damage.kinds import BROKEN
from ..geometry.damage.missing import missing_teeth
from ..geometry.pair.contacts import near_pitches
from .case import planet_name
from .faults import faults
from .standing import DIGITS, Standing

TOGETHER = 64  # number of positions whose pairs are solved at once if teeth differ
APART = 0.05  # Mesh loads with a smaller difference, relative to the load, use the same rows of hat functions.


class MeshContacts(NamedTuple):
    """Contacts ``(n,)`` of one mesh at one phase.

    `flexibility` ``(n, n)`` is that of both gears [mm per N/mm], and `gap` is in mm. `gearfe.contact.sharing.line_contact`
    describes `coefficient`, `radius` and `tilt`. `roll_1`, `roll_2` are the roll lengths [mm], `turn_1`, `turn_2` the torques
    of `gearfe.contact.rows.HatRow`, and `order` are the numbers of the tooth pairs. `least` is the smallest gap. The contacts
    are all that an approach of up to `reach` beyond it may close.
    """

    flexibility: Floats
    gap: Floats
    coefficient: Floats
    radius: Floats
    tilt: Floats
    roll_1: Floats
    roll_2: Floats
    turn_1: Floats
    turn_2: Floats
    order: NDArray[np.int64]
    least: float
    reach: float


class SetMesh:
    """One mesh of a set at the phases of its `PairContact`, for any load."""

    def __init__(self, contact: PairContact) -> None:
        self.contact = contact
        self._found: dict[tuple[int, float, float], MeshContacts] = {}
        self._alone: tuple[float, Solved] | None = None

    def at(self, i: int, line_load: float, reach: float) -> MeshContacts:
        """Return the contacts at phase number i that a load of about `line_load` [N/mm], or an approach [mm], may close.

        The first request, for the nominal load, is computed for all phases together.
        """
        key = i, line_load, reach
        if key not in self._found:
            phases = [i] if self._found else range(len(self.contact.found.gap))
            found = _contacts(self.contact, phases, line_load, reach)
            self._found |= {(k, line_load, reach): one for k, one in zip(phases, found, strict=True)}
        return self._found[key]

    def alone(self, line_load: float) -> Solved:
        """Solve the isolated pair under a load."""
        if self._alone is None or self._alone[0] != line_load:
            self._alone = line_load, self.contact.solve(line_load)
        return self._alone[1]


class PlacedContacts(NamedTuple):
    """`MeshContacts` of a mesh at one position, with the pinion tooth `first` of pair 0 and the number of leading pairs."""

    contacts: MeshContacts
    first: int
    newest: int


class Meshes:
    """All meshes of a case at the positions of a `Standing`. Equal planets share their solutions.

    An isolated pair (`alone`) has bodies with cracks and missing teeth. In the set, `gearfe.planetary_sets.cracked` adds these
    to healthy bodies.
    """

    def __init__(self, case: Any, stand: Standing, options: dict[str, Any], *, alone: bool = False) -> None:
        self._alone, self._options = alone, options
        self.case = case if alone else case.with_(damage={name: broken_of(own) for name, own in case.damage.items()})
        self._phases = (stand.outer, stand.inner)
        self._firsts = (stand.planet, stand.ring)
        self._mesh: dict[Any, tuple[SetMesh, dict[float, int]]] = {}
        self._kind = {(k, p): self._key(k, p) for k in (0, 1) for p in range(case.planets)}

    def _key(self, inner, planet):
        differs = faults(self.case, bool(inner), planet, int(self._firsts[inner][planet]))[2]
        return inner, planet, differs, None if differs else self.case.flanks.get(planet_name(planet))

    def at(self, i: int, loads: Floats, reach: Floats) -> list[list[PlacedContacts]]:
        """Return the `PlacedContacts` of meshes at position i by ``[inner][planet]``, for loads [N/mm] and approaches [mm]."""
        return [[self._met(i, k, p, float(loads[k, p]), float(reach[k, p])) for p in range(self.case.planets)] for k in (0, 1)]

    def _met(self, i, inner, planet, load, reach):
        mesh, number, phase, whole = self._of(i, inner, planet)
        first = 0 if self._kind[inner, planet][2] else -whole
        return PlacedContacts(mesh.at(number[phase], load, reach), first, whole if self._kind[inner, planet][2] else 0)

    def alone(self, i: int, inner: int, planet: int, load: float) -> tuple[float, float]:
        """Return the approach of the isolated pair of a mesh under a line load [mm], and its model error [mm]."""
        mesh, number, phase, _ = self._of(i, inner, planet)
        solved = mesh.alone(load)
        return float(solved.closing[number[phase]]), float(solved.left_out[number[phase]])

    def _of(self, i, inner, planet):
        """Return the `SetMesh`, its phase indices, its phase, and the number of whole cycles of tooth 0 at position i."""
        key = self._kind[inner, planet]
        phase = float(self._phases[inner][i, planet])
        whole = math.floor(phase)
        if not key[2]:
            phase = round(phase - whole, DIGITS)
        chunk = (*key, i // TOGETHER) if key[2] else (inner, key[3])
        if chunk not in self._mesh:
            self._mesh[chunk] = self._made(key, i // TOGETHER)
        return *self._mesh[chunk], phase, whole

    def _made(self, key, chunk):
        inner, planet, differs, flank = key
        forms, damage, _ = faults(self.case, bool(inner), planet, int(self._firsts[inner][planet]))
        if differs:
            phase = np.unique(self._phases[inner][chunk * TOGETHER : (chunk + 1) * TOGETHER, planet])
        else:
            alike = [p for (k, p), other in self._kind.items() if k == inner and not other[2] and other[3] == flank]
            phases = self._phases[inner][:, alike]
            phase = np.unique(np.round(phases - np.floor(phases), DIGITS))
        pair, materials = self.case.pairs[inner], self.case.material[inner : inner + 2]
        near = math.ceil(pair.eps_alpha) + sum(near_pitches(pair)) - 2
        gears = zip(pair.gears, materials, damage, strict=True)
        bodies = [self._body(gear, material, own, near) for gear, material, own in gears]
        contact = PairContact(pair, materials, bodies, phase, extended=True, state="plane strain", flanks=forms)
        return SetMesh(contact), {value: k for k, value in enumerate(phase.tolist())}

    def _body(self, gear, material, damage, near):
        """Return the `Flexibility` of a gear."""
        broken, gone = broken_of(damage), ()
        if not self._alone:
            gone = missing_teeth(gear, broken)
            broken = [one for one in broken if isinstance(one, Chip)]
        cracks = [one for one in damage if isinstance(one, Crack)]
        made = flexibility(gear, material, cracks, broken=tuple(broken), neighbours=near, **self._options)
        return replace(made, missing=gone) if gone else made


def broken_of(damage: Any) -> list[Any]:
    """Return the missing and chipped teeth among damage."""
    return [one for one in damage if isinstance(one, BROKEN)]


def near_load(line_load: float, unit: float) -> float:
    """Return the power of ``1 + APART`` times `unit` nearest to `line_load`, so that similar loads share hat functions."""
    step = np.log1p(APART)
    return float(unit * np.exp(step * round(np.log(max(line_load, 1e-3 * unit) / unit) / step)))


def _contacts(contact: Any, phases: Sequence[int], line_load: float, reach: float) -> list[MeshContacts]:
    """Return the `MeshContacts` at some phases, selected as in `PairContact.solve`.

    `reach` is the smallest approach [mm] for which they are complete.
    """
    candidates, tilt = contact.found, bounded(contact, line_load)
    least = candidates.gap.min(axis=1)
    reaches = np.maximum(contact._reach(line_load), reach)
    possible = candidates.gap - least[:, None] < reaches[:, None]
    corners = contact.corners(line_load, possible)
    kink = near_kink(contact, line_load) & possible & (corners[0] == 0)
    built, rows = contact.problems(line_load, phases, possible, corners, kink, tilt)
    return [_one(contact, i, one, rows, possible[i], least[i], reaches[i]) for i, one in zip(phases, built, strict=True)]


def _one(contact, i, built, rows, possible, least, reach):
    """Return the `MeshContacts` of one phase from the result of `PairContact.contacts_at`, with the contacts it omits."""
    candidates, places = contact.found, []
    for k in np.flatnonzero(possible).tolist():
        row = rows.get((i, k))
        if row is None:
            places.append([candidates.roll_1[i, k], candidates.roll_2[i, k], *contact.turns[:, i, k]])
        else:
            places.append([row.roll_1, row.roll_2, row.turn_1, row.turn_2])
    values = np.hstack([np.reshape(place, (4, -1)) for place in places])
    near = built["gap"] - least <= reach
    return MeshContacts(
        built["flexibility"][np.ix_(near, near)],
        *(built[name][near] for name in ("gap", "coefficient", "radius", "tilt")),
        *values[:, near],
        candidates.order[built["column"][near]],
        float(least),
        float(reach),
    )

"""What the contact of a pair says of one mesh of a set at one phase: contacts, their gaps, how they yield among themselves.

All of it is the pair's (`gearfe.contact.pair_contact.PairContact`): smooth contacts with Hertz's logarithm, rows of hats at
corners and kinks, exact gaps, cracks.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag

from ..contact.kinks import kink_rows, near_kink
from ..contact.pair_contact import KINK, PairContact, _closing
from ..contact.rows import Wanted
from ..contact.sliding import bounded
from ..flexibility.energy.ritz.plane import flexibility
from ..geometry.pair.contacts import near_pitches
from .faults import faults
from .standing import DIGITS, Standing

TOGETHER = 64  # positions whose pairs are solved at once, where teeth differ
APART = 0.05  # of the load: mesh loads closer than that ask for the same rows of hats


class Contacts(NamedTuple):
    """Contacts ``(n,)`` of one mesh at one phase.

    `flexibility` ``(n, n)`` of both gears [mm per N/mm], `gap` [mm], `coefficient`, `radius` and `tilt` as of
    `gearfe.contact.sharing.line_contact`; places `roll_1`, `roll_2` [mm] and torques `turn_1`, `turn_2` on both gears as of
    `gearfe.contact.rows.Row`; `order` of their pairs. `opening` ``(n, m)`` of cracks under unit loads and `faces` ``(m, m)``
    under unit forces, None without cracks. `least` is the gap of the first touch.
    """

    flexibility: NDArray[np.float64]
    gap: NDArray[np.float64]
    coefficient: NDArray[np.float64]
    radius: NDArray[np.float64]
    tilt: NDArray[np.float64]
    roll_1: NDArray[np.float64]
    roll_2: NDArray[np.float64]
    turn_1: NDArray[np.float64]
    turn_2: NDArray[np.float64]
    order: NDArray[np.int64]
    opening: NDArray[np.float64] | None
    faces: NDArray[np.float64] | None
    least: float

    def closed(self, force: NDArray[np.float64]) -> bool:
        """Whether faces of cracks overlap under forces ``(n,)``."""
        return self.opening is not None and bool(_closing(force @ self.opening))


class Mesh:
    """One mesh of a set at the phases of its `PairContact`, under any load."""

    def __init__(self, contact: PairContact) -> None:
        self.contact = contact
        self._found: dict[tuple[int, float], Contacts] = {}
        self._alone: tuple[float, NDArray[np.float64]] | None = None

    def at(self, wanted: list[int], line_load: float) -> list[Contacts]:
        """Contacts at phases by their number, as many as a load of about `line_load` [N/mm] may close."""
        new = sorted({i for i in wanted if (i, line_load) not in self._found})
        if new:
            solved = _contacts(self.contact, new, line_load)
            self._found |= {(i, line_load): contacts for i, contacts in zip(new, solved, strict=True)}
        return [self._found[i, line_load] for i in wanted]

    def alone(self, line_load: float) -> NDArray[np.float64]:
        """How far a load alone closes the pair ``(phases,)`` [mm]."""
        if self._alone is None or self._alone[0] != line_load:
            self._alone = line_load, self.contact.solve(line_load).closing
        return self._alone[1]


class Met(NamedTuple):
    """`Contacts` of a mesh at one position, pinion tooth `first` of pair 0, and how many pairs are ahead of the newest one."""

    contacts: Contacts
    first: int
    newest: int


class Meshes:
    """All meshes of a case at the positions of a `Standing`; equal planets share what they have in common."""

    def __init__(self, case: Any, stand: Standing, refine: float, cache: Any) -> None:
        self.case, self._options = case, {"refine": refine, "cache": cache}
        self._phases = (stand.outer, stand.inner)
        self._firsts = (stand.planet, stand.ring)
        self._mesh: dict[Any, tuple[Mesh, dict[float, int]]] = {}
        self._kind = {(k, p): self._key(k, p) for k in (0, 1) for p in range(case.planets)}

    def _key(self, inner, planet):
        differs = faults(self.case, bool(inner), planet, int(self._firsts[inner][planet]))[2]
        return inner, planet, differs, None if differs else self.case.flanks.get(("planet", planet))

    def at(self, i: int, loads: NDArray[np.float64]) -> list[list[Met]]:
        """`Met` of all meshes at position i by ``[inner][planet]``, made for loads ``(2, planets)`` [N/mm]."""
        return [[self._met(i, k, p, float(loads[k, p])) for p in range(self.case.planets)] for k in (0, 1)]

    def _met(self, i, inner, planet, load):
        mesh, number, phase, whole = self._of(i, inner, planet)
        first = 0 if self._kind[inner, planet][2] else -whole
        return Met(mesh.at([number[phase]], load)[0], first, whole if self._kind[inner, planet][2] else 0)

    def alone(self, i: int, inner: int, planet: int, load: float) -> float:
        """How far a line load alone closes the pair of a mesh [mm]."""
        mesh, number, phase, _ = self._of(i, inner, planet)
        return float(mesh.alone(load)[number[phase]])

    def _of(self, i, inner, planet):
        """`Mesh`, its phases' numbers, phase, and whole cycles of tooth 0 at position i."""
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
        forms, cracks, _ = faults(self.case, bool(inner), planet, int(self._firsts[inner][planet]))
        if differs:
            phase = np.unique(self._phases[inner][chunk * TOGETHER : (chunk + 1) * TOGETHER, planet])
        else:
            alike = [p for (k, p), other in self._kind.items() if k == inner and not other[2] and other[3] == flank]
            phases = self._phases[inner][:, alike]
            phase = np.unique(np.round(phases - np.floor(phases), DIGITS))
        pair, materials = self.case.pairs[inner], self.case.material[inner : inner + 2]
        near = math.ceil(pair.eps_alpha) + sum(near_pitches(pair)) - 2
        gears = zip((pair.gear_1, pair.gear_2), materials, cracks, strict=True)
        bodies = [flexibility(gear, m, gear_cracks, neighbours=near, **self._options) for gear, m, gear_cracks in gears]
        contact = PairContact(pair, materials, bodies, phase, extended=True, state="plane strain", flanks=forms)
        return Mesh(contact), {value: k for k, value in enumerate(phase.tolist())}


def near_load(line_load: float, unit: float) -> float:
    """`unit` times a power of ``1 + APART``, the one next to `line_load`: loads alike share their rows of hats."""
    step = np.log1p(APART)
    return float(unit * np.exp(step * round(np.log(max(line_load, 1e-3 * unit) / unit) / step)))


def _contacts(contact: Any, phases: list[int], line_load: float) -> list[Contacts]:
    """`Contacts` at some phases, chosen as `PairContact.solve` does."""
    candidates, tilt = contact.found, bounded(contact, line_load)
    least = candidates.gap.min(axis=1)
    reach = contact._reach(line_load)
    possible = candidates.gap - least[:, None] < reach[:, None]
    corner, zone, width = contact.corners(line_load, possible)
    kink = near_kink(contact, line_load) & possible & (corner == 0)
    asked = np.zeros(possible.shape, dtype=bool)
    asked[phases] = True
    finest, at = contact.finest(line_load), np.argwhere((corner > 0) & asked).tolist()
    rows = contact.rows([Wanted(i, k, int(corner[i, k]), float(zone[i, k]), finest, float(width[i, k])) for i, k in at])
    rows = dict(zip(map(tuple, at), rows, strict=True)) | kink_rows(contact, np.argwhere(kink & asked), line_load)
    corner = np.where(kink, KINK, corner)
    sets = contact.contacts_at([(i, near := np.flatnonzero(possible[i]), corner[i, near]) for i in phases], rows, tilt)
    return [_one(contact, i, built, rows, possible[i], least[i], reach[i]) for i, built in zip(phases, sets, strict=True)]


def _one(contact, i, built, rows, possible, least, reach):
    """`Contacts` of one phase from what `PairContact.contacts_at` gives, with the places it leaves out."""
    candidates, places = contact.found, []
    for k in np.flatnonzero(possible).tolist():
        row = rows.get((i, k))
        if row is None:
            places.append([candidates.roll_1[i, k], candidates.roll_2[i, k], *contact.turns[:, i, k]])
        else:
            places.append([row.roll_1, row.roll_2, row.turn_1, row.turn_2])
    values = np.hstack([np.reshape(place, (4, -1)) for place in places])
    near = built["gap"] - least <= reach
    seams = [flexible.seam for flexible in contact.flexibility if flexible.seam]
    return Contacts(
        built["flexibility"][np.ix_(near, near)],
        *(built[name][near] for name in ("gap", "coefficient", "radius", "tilt")),
        *values[:, near],
        candidates.order[built["column"][near]],
        built["opening"][near] if seams else None,
        block_diag(*(seam.influence for seam in seams)) if seams else None,
        float(least),
    )

"""`Flexibility`: elastic flexibility of a gear between its contacts, for all section methods."""

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..geometry.aliases import Floats
from ..geometry.tooth.gear import Gear
from ..geometry.tooth.profile import arc_at

NEAREST = 0.001  # offset of distances from a tip corner before taking the logarithm [m_n]
TILT = 0.2  # tilt of the two loads at each of four places, which determine the deflection across the normal [rad]
FURTHER = 1  # number of further teeth solved with damage, beyond those that can share load with a damaged one
BELOW = 0.1  # distance of the third of these places from the tip [m_n]


def leaning(arc: ArrayLike, normal: ArrayLike, ahead: ArrayLike, back: ArrayLike) -> Floats:
    """Return the flexibility of a tooth for tangential forces, from flexibilities under loads tilted by `TILT` to either side.

    Under a force along f = cos(d) n + sin(d) t, the deflection along f is ``S_nn cos(d)**2 + S_nt sin(2 d) + S_tt sin(d)**2``.
    `arc` ``(4,)`` [mm] is at the foot of the flank, half-way, `BELOW` the tip and at the tip. The arguments are flexibilities
    there [mm per N/mm] under loads along the involute's `normal` n, tilted towards t (`ahead`) and away from it (`back`). The
    result ``(3, 4)`` is arcs, S_nt and S_tt.

    At `arc` ``(4,)``, at the foot of the flank, half-way, `BELOW` the tip and at the tip [mm], under loads along the involute's
    `normal` n, and tilted towards t (`ahead`) and away from it (`back`) [mm per N/mm]: arcs, S_nt and S_tt ``(3, 4)``.
    """
    plain, plus, minus = (np.asarray(values, dtype=float) for values in (normal, ahead, back))
    across = (plus - minus) / (2 * math.sin(2 * TILT))
    along = ((plus + minus) / 2 - plain * math.cos(TILT) ** 2) / math.sin(TILT) ** 2
    return np.array([np.asarray(arc, dtype=float), across, along])


def _logarithmic(arc, places, least):
    """Return a variable of the arc over which `leaning` changes evenly: a logarithm towards the wedge at the tip."""
    middle, tip = places[-2:]
    left = np.maximum(tip - np.maximum(arc, middle), 0.0) + least
    return np.minimum(arc - middle, 0.0) + np.log((tip - middle + least) / left)


def reached_teeth(gear: Gear, damage: Iterable[Any], neighbours: int) -> list[int]:
    """Return the numbers of the teeth solved with damage: `neighbours` and `FURTHER` on each side of a damaged tooth."""
    reach = neighbours + FURTHER
    return sorted({(one.tooth + k) % gear.z for one in damage for k in range(-reach, reach + 1)})


def glued(
    gear: Gear, teeth: Sequence[int], influence: Callable[[int, int], Floats], opening: Mapping[int, Floats], stiffness: Floats
) -> tuple[dict[int, Floats], dict[tuple[int, int], Floats]]:
    """Return the influence of loads if all cracks are closed.

    It is that of each tooth on itself and on the teeth up to half a revolution ahead.
    """
    between = {(i, j): influence(i, j) - opening[i].T @ stiffness @ opening[j] for i in teeth for j in teeth}
    ahead = {(i, j): one for (i, j), one in between.items() if i != j and (j - i) % gear.z <= gear.z // 2}
    return {tooth: between[tooth, tooth] for tooth in teeth}, ahead


@dataclass(frozen=True, slots=True, eq=False)
class SeamFaces:
    """Faces of all cracks of a gear, as pairs of facing nodes.

    The flexibility of a cracked gear between loads is that with every crack glued shut, which the splines of `Flexibility`
    hold, plus ``opening' stiffness opening``: so it stays positive definite however deep the crack, and its faces can be kept
    from passing through each other.

    Attributes
    ----------
    opening : dict of int to spline
        Over the arc of that tooth's flank: opening of the n face pairs under a unit load there [mm per N/mm].
    influence : ndarray, shape (n, n)
        Opening of the pairs under unit forces that push them apart [mm per N/mm].
    stiffness : ndarray, shape (n, n)
        Its inverse.
    """

    opening: dict[int, Any]
    influence: Floats
    stiffness: Floats

    def at(self, arc: ArrayLike, teeth: Sequence[int] | NDArray[np.int64]) -> Floats:
        """Return the opening ``(..., contacts, n)`` under unit loads at `arc` ``(..., contacts)`` [mm] on `teeth`.

        It is zero for teeth that were not solved.
        """
        arc, teeth = np.asarray(arc), np.asarray(teeth)
        out = np.zeros((*arc.shape, self.influence.shape[0]))
        for tooth in set(teeth.tolist()) & self.opening.keys():
            out[..., teeth == tooth, :] = self.opening[tooth](arc[..., teeth == tooth])
        return out


@dataclass(frozen=True, slots=True, eq=False)
class Flexibility:
    """Flexibility of one gear between simultaneous contacts, local contact excluded.

    Attributes
    ----------
    gear : Gear
    near : dict of int to spline
        Smooth part S(s, s) along the flank of each solved tooth [mm per N/mm], over the arc of `geometry.tooth.profile.arc_at`.
    far : dict of (int, int) to spline
        Influence of a load on one tooth at another, over both arcs; the second tooth is further to the loaded
        side.
    own : dict of int to ndarray, shape (k, k)
        Smooth part S(s, s') between two places of the flank of each solved tooth: ``basis(s) @ own @ basis(s')``.
    limits : tuple of float
        Arcs between which the splines hold [mm]; contacts outside are clamped to them.
    fine : float
        How many times shorter than by default the hat functions of contacts at corners are to be (`gearfe.contact.rows`).
    dofs : int
        Unknowns of the solve.
    healthy : Flexibility or None
        Of the gear without damage, for teeth that were not solved; a healthy gear has only tooth 0 solved.
    seam : SeamFaces or None
        The cracks; the splines above then are those with the cracks glued shut.
    basis : spline or None
        Over the arc of a flank: the k functions by which `own` is carried.
    leans : dict of int to ndarray, shape (3, 4)
        Of each solved tooth what `leaning` gives: t is the tangent away from the gear's centre. Without it a tooth yields to
        loads off its normal by their torque.
    missing : tuple of int
        Missing teeth, which touch nothing.
    tips : dict of int to (float, (float, float), spline)
        Of teeth whose loaded flank ends below the tip circle: roll length of the corner [mm], their own `limits` and `basis`.
    seconds : float
        Time of the solve, that of `healthy` included (`gearfe.flexibility.solved.timed`) [s].
    """

    gear: Gear
    near: dict[int, Any]
    far: dict[tuple[int, int], Any]
    own: dict[int, Floats]
    limits: tuple[float, float]
    fine: float = 1.0
    dofs: int = 0
    healthy: "Flexibility | None" = None
    seam: SeamFaces | None = None
    basis: Any = None
    leans: dict[int, Floats] = field(default_factory=dict)
    missing: tuple[int, ...] = ()
    tips: dict[int, tuple[float, tuple[float, float], Any]] = field(default_factory=dict)
    seconds: float = 0.0

    def within(self, rolls: Sequence[Floats], teeth: Sequence[int]) -> list[Floats]:
        """Return the smooth flexibility ``(n, n)`` [mm per N/mm] between contacts on one tooth.

        There is one result for each entry of `rolls` ``(n,)`` and `teeth`.
        """
        if self.basis is None and self.healthy is None:
            return singly(self, rolls, teeth)
        arc = arc_at(self.gear, np.concatenate(rolls))
        solved = [self if tooth % self.gear.z in self.own else self._whole() for tooth in teeth]
        bases = [flexible._end(tooth) for flexible, tooth in zip(solved, teeth, strict=True)]
        rows = {basis: basis(np.clip(arc, *limits)) for limits, basis in set(bases)}
        depth, out, stop = np.minimum(arc - self.limits[0], 0.0), [], 0
        for flexible, (limits, basis), roll, tooth in zip(solved, bases, rolls, teeth, strict=True):
            part, values = slice(stop, stop := stop + roll.size), flexible.own.get(tooth % self.gear.z, flexible.own.get(0))
            here = rows[basis][part]
            smooth = here @ values @ here.T
            if depth[part].any():  # In the fillet, the function is extrapolated linearly.
                slope = np.outer(depth[part], basis(limits[0], 1) @ values @ here.T)
                smooth = smooth + slope + slope.T
            out.append(smooth)
        return out

    def yields_across(self, roll: Floats, tooth: int) -> Floats | None:
        """Return S_nt and S_tt of `leaning` ``(2, ...)`` [mm per N/mm] at roll lengths of a tooth, or None if not available."""
        leans = self.leans.get(tooth % self.gear.z, self._whole().leans.get(0))
        if leans is None:
            return None
        at, places = (_logarithmic(arc, leans[0], NEAREST * self.gear.m_n) for arc in (arc_at(self.gear, roll), leans[0]))
        return np.array([np.interp(at, places, values) for values in leans[1:]])

    def _end(self, tooth):
        """Limits of the arc [mm] and spline basis for the flank of a tooth, which a chip shortens."""
        return self.tips.get(tooth % self.gear.z, (0.0, self.limits, self.basis))[1:]

    def clipped(self, arc: Floats, teeth: ArrayLike) -> Floats:
        """Arcs ``(..., n)`` on `teeth` ``(n,)``, moved into the limits of their splines [mm]."""
        if not self.tips:
            return np.minimum(np.maximum(arc, self.limits[0]), self.limits[1])
        low, high = np.array([self._end(tooth)[0] for tooth in np.asarray(teeth).tolist()]).reshape(-1, 2).T
        return np.minimum(np.maximum(arc, low), high)

    def _whole(self):
        return self if self.healthy is None else self.healthy

    def matrix(self, roll: Floats, teeth: ArrayLike) -> Floats:
        """Flexibility ``(..., n, n)`` [mm per N/mm] between contacts at `roll` ``(..., n)`` on `teeth` ``(n,)``.

        Contacts on one tooth get no influence on each other here: see `within`. Cracks are glued shut: see `SeamFaces`.
        """
        z, whole = self.gear.z, self._whole()
        teeth = np.asarray(teeth)
        arc = self.clipped(arc_at(self.gear, roll), teeth)
        out = np.zeros((*np.shape(roll), teeth.size))
        members = {tooth: teeth == tooth for tooth in sorted(set(teeth.tolist()))}
        near: dict[Any, NDArray[np.bool_]] = {}  # contacts by spline; equal teeth share a spline
        far: dict[Any, NDArray[np.bool_]] = {}
        for tooth, on in members.items():
            spline = self.near.get(tooth % z, whole.near.get(0))
            near[spline] = near.get(spline, False) | on
            for other, there in members.items():
                spline = self.far.get((tooth % z, other % z), whole.far.get((0, other - tooth)))
                if tooth < other and spline is not None:  # Otherwise the teeth are too far apart to interact.
                    far[spline] = far.get(spline, False) | on[:, None] & there
        for spline, on in near.items():
            (here,) = on.nonzero()
            out[..., here, here] = spline(arc[..., here])
        for spline, on in far.items():
            here, there = on.nonzero()
            out[..., here, there] = out[..., there, here] = spline.ev(arc[..., here], arc[..., there])
        return out


def outermost(solved: Iterable[int], z: int) -> list[int]:
    """Return those `solved` teeth of a gear with `z` teeth that have an unsolved neighbour."""
    teeth = set(solved)
    return [tooth for tooth in teeth if not {(tooth + 1) % z, (tooth - 1) % z} <= teeth]


def cracks_beyond(flexible: Any, teeth: NDArray[np.int64]) -> tuple[NDArray[np.bool_], float]:
    """Return which `teeth` ``(n,)`` of a cracked gear were solved without its cracks, and the error bound there [mm per N/mm].

    Cracks open less under loads further away. The bound is the flexibility that open cracks add to the outermost solved teeth.
    """
    none = np.zeros(teeth.size, dtype=bool), 0.0
    if flexible.seam is None:
        return none
    z, faces = flexible.gear.z, flexible.seam
    ends = outermost(faces.opening, z)
    if not ends:
        return none
    opening = np.concatenate([faces.opening[tooth](np.array(flexible.limits)) for tooth in ends])
    most = np.einsum("nf,fg,ng->n", opening, faces.stiffness, opening).max()
    return ~np.isin(teeth % z, list(faces.opening)), float(most)


def singly(flexible: Any, rolls: Sequence[Floats], teeth: Sequence[int]) -> list[Floats]:
    """Return `Flexibility.within` for a gear that is known at single places only: S between two places is the mean of both.

    If S is linear over a contact, this is the value at the middle.
    """
    diagonals = (flexible.matrix(roll[:, None], [tooth])[:, 0, 0] for roll, tooth in zip(rolls, teeth, strict=True))
    return [(values[:, None] + values) / 2 for values in diagonals]


def towards(
    flexible: Flexibility,
    smooth: Floats,
    roll: Floats,
    tooth: int,
    force: Floats,
    torque: Floats,
    local: float,
) -> Floats:
    """Smooth flexibility ``(..., n, n)`` [mm per N/mm] between contacts on one tooth with forces inclined to its normals.

    Parameters
    ----------
    smooth : ndarray, shape (..., n, n)
        What `Flexibility.within` gives.
    force : ndarray, shape (2, ..., n)
        Each unit load's parts along the involute's normal and along the tangent away from the gear's centre.
    torque : ndarray, shape (..., n)
        Its torque over that of a unit load along the normal.
    local : float
        Taken from S(s, s') for loads of any direction [mm per N/mm]: what else than the half-plane's logarithm is local.
    """
    leans = flexible.yields_across(roll, tooth)
    if leans is None:
        return torque[..., None] * torque[..., None, :] * (smooth - local)
    across, along = leans
    normal, tangent = force
    between = (along[..., None] + along[..., None, :]) / 2
    mixed = (normal * across)[..., None] * tangent[..., None, :]
    straight = normal[..., None] * normal[..., None, :] * (smooth - local)
    return straight + mixed + mixed.mT + tangent[..., None] * tangent[..., None, :] * (between - local)

"""`Flexibility`: what a gear gives to its contacts, wherever it came from."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geometry.tooth.gear import Gear
from geometry.tooth.profile import arc_at

NEAREST = 0.001  # to a tip corner that a flexibility is told apart [m_n]
TILT = 0.2  # of the two loads at each of three places that tell how a tooth yields across the normal [rad]
BELOW = 0.1  # the tip: the place between both ends of the flank [m_n]


def leaning(arc: ArrayLike, normal: ArrayLike, ahead: ArrayLike, back: ArrayLike) -> NDArray[np.float64]:
    """How a tooth yields across its normal, from the smooth flexibility under loads tilted by `TILT` either way.

    With f = cos(d) n + sin(d) t a load yields ``S_nn cos(d)**2 + S_nt sin(2 d) + S_tt sin(d)**2`` along itself.

    Parameters
    ----------
    arc : ndarray, shape (3,)
        Places of the loads: at the foot of the flank, `BELOW` the tip and at the tip [mm].
    normal, ahead, back : ndarray, shape (3,)
        Under loads along the involute's normal n, and tilted towards t and away from it [mm per N/mm].

    Returns
    -------
    ndarray, shape (3, 3)
        Arcs, S_nt and S_tt [mm per N/mm].
    """
    plain, plus, minus = (np.asarray(values, dtype=float) for values in (normal, ahead, back))
    across = (plus - minus) / (2 * math.sin(2 * TILT))
    along = ((plus + minus) / 2 - plain * math.cos(TILT) ** 2) / math.sin(TILT) ** 2
    return np.array([np.asarray(arc, dtype=float), across, along])


def _logarithmic(arc, places, least):
    """A variable of the arc in which `leaning` changes evenly between its places: towards the tip's wedge a logarithm."""
    _, middle, tip = places
    left = np.maximum(tip - np.maximum(arc, middle), 0.0) + least
    return np.minimum(arc - middle, 0.0) + np.log((tip - middle + least) / left)


@dataclass(frozen=True, slots=True)
class SeamFaces:
    """The faces of all cracks of a gear, pair of facing nodes by pair.

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
    influence: NDArray[np.float64]
    stiffness: NDArray[np.float64]

    def at(self, arc: ArrayLike, teeth: Sequence[int] | NDArray[np.int64]) -> NDArray[np.float64]:
        """Opening ``(..., contacts, n)`` under unit loads at `arc` ``(..., contacts)`` [mm] on `teeth`.

        It is zero for teeth that were not solved.
        """
        arc = np.asarray(arc)
        out = np.zeros((*arc.shape, self.influence.shape[0]))
        for k, tooth in enumerate(teeth):
            if tooth in self.opening:
                out[..., k, :] = self.opening[tooth](arc[..., k])
        return out


@dataclass(frozen=True, slots=True)
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
    own : dict of int to spline
        Smooth part S(s, s') between two places of the flank of each solved tooth, over both arcs.
    limits : tuple of float
        Arcs between which the splines hold [mm]; contacts outside are clamped to them.
    fine : float
        How many times shorter than by default the hats of contacts at corners are to be (`gearfe.contact.rows`).
    dofs : int
        Unknowns of the solve.
    healthy : Flexibility or None
        Of the gear without damage, for teeth that were not solved; a healthy gear has only tooth 0 solved.
    seam : SeamFaces or None
        The cracks; the splines above then are those with the cracks glued shut.
    leans : dict of int to ndarray, shape (3, 3)
        Of each solved tooth what `leaning` gives: t is the tangent away from the gear's centre. Without it a tooth yields to
        loads off its normal by their torque.
    """

    gear: Gear
    near: dict[int, Any]
    far: dict[tuple[int, int], Any]
    own: dict[int, Any]
    limits: tuple[float, float]
    fine: float = 1.0
    dofs: int = 0
    healthy: "Flexibility | None" = None
    seam: SeamFaces | None = None
    leans: dict[int, NDArray[np.float64]] = field(default_factory=dict)

    def near_of(self, tooth: int) -> Any:
        """Spline S(s, s) of a tooth; tooth numbers count round the gear."""
        tooth %= self.gear.z
        return self.near[tooth] if tooth in self.near else self._whole().near[0]

    def far_of(self, first: int, second: int) -> Any:
        """Spline between two teeth, first < second; None if they are too far apart to have been solved."""
        key = first % self.gear.z, second % self.gear.z
        return self.far[key] if key in self.far else self._whole().far.get((0, second - first))

    def within(self, roll: NDArray[np.float64], tooth: int) -> NDArray[np.float64]:
        """Smooth flexibility ``(n, n)`` [mm per N/mm] between contacts at `roll` ``(n,)`` on one tooth."""
        tooth %= self.gear.z
        spline = self.own[tooth] if tooth in self.own else self._whole().own[0]
        arc = arc_at(self.gear, roll)
        rising, back = np.unique(np.clip(arc, *self.limits), return_inverse=True)
        out = spline(rising, rising)[np.ix_(back, back)]
        depth = np.minimum(arc - self.limits[0], 0.0)
        if (depth < 0).any():  # in the fillet it goes on straight
            slope = spline(rising, rising, dx=1)[np.ix_(back, back)] * depth[:, None]
            out = out + slope + slope.T
        return out

    def towards(
        self, roll: NDArray[np.float64], tooth: int, force: NDArray[np.float64], torque: NDArray[np.float64], local: float
    ) -> NDArray[np.float64]:
        """Smooth flexibility ``(n, n)`` [mm per N/mm] between contacts on one tooth whose forces are not along its normals.

        Parameters
        ----------
        roll : ndarray, shape (n,)
        tooth : int
        force : ndarray, shape (2, n)
            Each unit load's parts along the involute's normal and along the tangent away from the gear's centre.
        torque : ndarray, shape (n,)
            Its torque over that of a unit load along the normal.
        local : float
            Taken from S(s, s') as well, for loads of any direction [mm per N/mm]: what else than the half-plane's logarithm is
            local.
        """
        leans = self.leans.get(tooth % self.gear.z, self._whole().leans.get(0))
        if leans is None:
            return np.outer(torque, torque) * (self.within(roll, tooth) - local)
        least = NEAREST * self.gear.m_n
        at, places = (_logarithmic(arc, leans[0], least) for arc in (arc_at(self.gear, roll), leans[0]))
        across, along = (np.interp(at, places, values) for values in leans[1:])
        (normal, tangent), along = force, (along[:, None] + along) / 2
        mixed = np.outer(normal * across, tangent)
        straight = np.outer(normal, normal) * (self.within(roll, tooth) - local)
        return straight + mixed + mixed.T + np.outer(tangent, tangent) * (along - local)

    def _whole(self):
        return self if self.healthy is None else self.healthy

    def matrix(self, roll: NDArray[np.float64], teeth: ArrayLike) -> NDArray[np.float64]:
        """Flexibility ``(..., n, n)`` [mm per N/mm] between contacts at `roll` ``(..., n)`` on `teeth` ``(n,)``.

        Contacts on one tooth get no influence on each other here: see `within`. Cracks are glued shut: see `SeamFaces`.
        """
        low, high = self.limits
        arc = np.minimum(np.maximum(arc_at(self.gear, roll), low), high)
        teeth = np.asarray(teeth)
        out = np.zeros((*np.shape(roll), teeth.size))
        members = {tooth: (teeth == tooth).nonzero()[0] for tooth in sorted(set(teeth.tolist()))}
        for tooth, own in members.items():
            out[..., own, own] = self.near_of(tooth)(arc[..., own])
            for other, theirs in members.items():
                spline = self.far_of(tooth, other) if tooth < other else None
                if spline is not None:
                    block = spline.ev(arc[..., own, None], arc[..., None, theirs])
                    out[..., own[:, None], theirs] = block
                    out[..., theirs[:, None], own] = np.swapaxes(block, -1, -2)
        return out

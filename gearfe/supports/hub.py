"""`Hub`: how far the flanks of a gear give way because what holds its body gives way, by the place of the contact."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Hub:
    """Flexibility of what holds a gear, at some places along its width.

    The body between two places is carried along: its displacement is straight between theirs.

    Attributes
    ----------
    places : ndarray, shape (k,)
        Heights from the middle of the gear, rising towards z = b [mm]; one place for a hub that moves as a whole.
    bending : ndarray, shape (2 k, 2 k)
        Displacements [mm] and slopes [rad] of the places, displacements first, by forces [N] and moments [N mm] on them. The same
        in every plane through the axis.
    torsion : ndarray, shape (k, k)
        Twist [rad] by torques [N mm].
    axial : ndarray, shape (k, k)
        [mm/N].
    """

    places: NDArray[np.float64]
    bending: NDArray[np.float64]
    torsion: NDArray[np.float64]
    axial: NDArray[np.float64]

    def given(
        self, along: NDArray[np.float64], z: NDArray[np.float64], hand: NDArray[np.float64], r_b: float, beta_b: float
    ) -> NDArray[np.float64]:
        """Approach at each contact by unit normal forces on the others, as the body follows its hub ``(n, n)`` [mm/N].

        A unit normal force has the part cos(beta_b) along the line of action, ``r_b`` away from the axis, and hand sin(beta_b)
        along the axis. Rows below are what it does to the places; by reciprocity they also read the displacements.

        Parameters
        ----------
        along : ndarray, shape (n,)
            Where the contacts are on the line of action, from the foot of the perpendicular from the gear's axis, in the sense
            of the pinion's roll length [mm].
        z : ndarray, shape (n,)
            Heights from the middle of the gear [mm].
        hand : ndarray, shape (n,)
            Sense of the axial part: +1 towards z = b.
        r_b : float
            Base radius [mm].
        beta_b : float
            Base helix angle [rad], not negative.
        """
        cos, sin = math.cos(beta_b), math.sin(beta_b)
        near = _between(self.places, z)
        lever = cos * (z - near @ self.places) - hand * sin * along
        plane = np.hstack([cos * near, lever[:, None] * near])  # the plane of axis and line of action
        across = np.hstack([0 * near, (hand * sin * r_b)[:, None] * near])  # the one at right angles to it
        out = plane @ self.bending @ plane.T + across @ self.bending @ across.T
        out += (cos * r_b) ** 2 * near @ self.torsion @ near.T
        pull = (hand * sin)[:, None] * near
        return out + pull @ self.axial @ pull.T


def _between(places, z):
    """Weights ``(n, k)`` of the places in what is straight between them; outside, the nearest counts."""
    if places.size == 1:
        return np.ones((z.size, 1))
    right = np.clip(np.searchsorted(places, z), 1, places.size - 1)
    part = np.clip((z - places[right - 1]) / (places[right] - places[right - 1]), 0.0, 1.0)
    out, rows = np.zeros((z.size, places.size)), np.arange(z.size)
    out[rows, right - 1], out[rows, right] = 1 - part, part
    return out

"""`Hub`: deflection of the flanks of a gear by its supports, at any contact."""

import math
from dataclasses import dataclass

import numpy as np

from ...geometry.aliases import Floats


@dataclass(frozen=True, slots=True)
class Hub:
    """Flexibility of the support of a gear, at the middle of its width. The gear moves as a rigid body.

    `bending` (2, 2) is displacement [mm] and slope [rad] by a force [N] and a moment [N mm], the same in every plane through
    the axis; `torsion` the twist [rad] by a torque [N mm]; `axial` the shift by an axial force [mm/N].
    """

    bending: Floats
    torsion: float
    axial: float

    def given(self, along: Floats, z: Floats, hand: Floats, r_b: float, beta_b: float) -> Floats:
        """Return the approach ``(n, n)`` at each contact by a unit normal force on each, due to the hub [mm/N].

        A unit normal force has the part cos(beta_b) along the line of action, ``r_b`` away from the axis, and hand sin(beta_b)
        along the axis. The rows in the code are its forces and moments on the hub. By reciprocity they also give the
        displacements.

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
        cos, pull = math.cos(beta_b), math.sin(beta_b) * hand
        # load components in the plane of the axis and the line of action
        plane = np.stack([np.full(z.size, cos), cos * z - pull * along], axis=1)
        across = r_b * pull  # moment in the perpendicular plane
        out = plane @ self.bending @ plane.T + self.bending[1, 1] * np.outer(across, across)
        return out + (cos * r_b) ** 2 * self.torsion + self.axial * np.outer(pull, pull)

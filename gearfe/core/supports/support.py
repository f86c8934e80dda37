"""`Support`: equivalent springs under the hub of a gear."""

import math
from dataclasses import dataclass, replace

import numpy as np

from ..checks import number
from .hub import Hub

UNITS = {"radial": "N/mm", "tilt": "N mm/rad", "torsion": "N mm/rad", "axial": "N/mm"}


@dataclass(frozen=True, slots=True)
class Support:
    """Springs under the hub of a gear, at the middle of its width. Omitted stiffnesses are rigid.

    The held edge (the bore, or the rim of a ring) moves as a rigid body. The springs hold it, equally in every direction across
    the axis::

        displacement = force / radial + coupling moment          across the axis, at the middle of the gear
        slope        = coupling force + moment / tilt            of the axis, in the plane of the force
        twist        = torque / torsion                          between the gear and where its torque leaves the shaft
        shift        = axial force / axial

    Parameters
    ----------
    radial : float
        Force across the axis per displacement, without a moment [N/mm]; 1 N/um are 1000 N/mm.
    tilt : float
        Moment per slope, without a force [N mm/rad].
    torsion : float
        Torsional stiffness [N mm/rad].
    axial : float
        Axial stiffness [N/mm].
    coupling : float
        Slope under a unit force [rad/N], equal to the displacement under a unit moment: 0 for a gear in the middle of its
        bearings, positive if the end z = b of the gear deflects more than z = 0. `Shaft` computes it.

    Raises
    ------
    ValueError
        If a stiffness is not positive, or the coupling is so large that the springs would generate energy.

    Examples
    --------
    >>> Support(radial=2e5, torsion=4e8)
    Support(radial=200000.0, tilt=inf, torsion=400000000.0, axial=inf, coupling=0.0)
    """

    radial: float = math.inf
    tilt: float = math.inf
    torsion: float = math.inf
    axial: float = math.inf
    coupling: float = 0.0

    def __post_init__(self) -> None:
        """Raise ValueError for stiffnesses that are not positive, or for a coupling that is too large."""
        for name in self.__slots__:
            object.__setattr__(self, name, number(f"support: {name}", getattr(self, name)))
        for name, unit in UNITS.items():
            if not getattr(self, name) > 0:
                raise ValueError(
                    f"support: {name} = {getattr(self, name):g} {unit}, but the stiffness of a spring must be positive; leave it "
                    "out for a rigid support"
                )
        largest = 1 / (math.sqrt(self.radial) * math.sqrt(self.tilt))
        if not abs(self.coupling) <= (1 + 5e-10) * largest:
            raise ValueError(
                f"support: coupling = {self.coupling:g} rad/N is more than 1 / sqrt(radial tilt) = "
                f"{largest:g}: the stiffness matrix is not positive definite; take all three from a Shaft"
            )

    @property
    def integral(self) -> bool:
        """Whether gear and support are one piece, which is False for a gear on springs."""
        return False

    @property
    def tilts(self) -> bool:
        """True if a force in the middle of the gear tilts it."""
        return self.coupling != 0

    def untilted(self) -> "Support":
        """Return the springs without coupling, for which a force displaces the gear without tilting it."""
        return replace(self, coupling=0.0)

    def hub(self) -> Hub:
        """Return the compliance of these springs as a `Hub` (for the contact solver)."""
        bending = np.array([[1 / self.radial, self.coupling], [self.coupling, 1 / self.tilt]])
        return Hub(bending, 1 / self.torsion, 1 / self.axial)

"""Smallest machine: one mass on one gear mesh."""

from typing import Any

import numpy as np

from .gear_mesh import GearMesh
from .loads import History, Load
from .mesh_curves import Stiffness
from .tables import Machine


def single_mesh(mass: float, stiffness: Stiffness, frequency: float, *, force: History = 0.0, **mesh: Any) -> Machine:
    """Build one mass on one mesh: a gear pair along its line of action, ``m x'' + c x' + k(t) f(x - e(t)) = F``.

    Parameters
    ----------
    mass : float
        Equivalent mass [kg], ``1 / (r_b1**2 / I_1 + r_b2**2 / I_2)``.
    stiffness
        Mesh stiffness over one cycle [N/m], anything that `GearMesh` takes.
    frequency : float
        Mesh frequency [Hz].
    force : float, (ndarray, ndarray) or callable
        Force transmitted [N].
    **mesh
        Further fields of `GearMesh` (``damping``, ``zeta``, ``backlash``, ``error``, ``damage``...).

    Returns
    -------
    Machine
        One degree of freedom, ``pair.x``: the compression along the line of action [m]. In SI units.

    Raises
    ------
    ValueError
        If `mass` is not positive and finite, `stiffness` is negative or not finite, `frequency` or `force` is not finite, the
        times of a history fall, or a field of `GearMesh` is out of range.
    """
    row = np.ones(1)
    return Machine(
        ("pair.x",), np.array([mass]), (), (GearMesh("mesh", row, stiffness, frequency, **mesh),), (Load("force", row, force),)
    )

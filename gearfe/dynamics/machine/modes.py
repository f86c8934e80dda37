"""Natural frequencies and modes of a machine, in a fixed or rotating frame."""

import math

import numpy as np
from scipy.linalg import eigh

from ...geometry.aliases import Floats
from .tables import Machine
from .turning_frame import frame_terms

RIGID = 1e-12  # modes below this part of the largest squared frequency are rigid-body modes


def natural_frequencies(machine: Machine) -> tuple[Floats, Floats]:
    """Natural frequencies and modes without damping. Meshes have their mean stiffness (tangent stiffness for a `ForceLaw`).

    Parameters
    ----------
    machine : Machine
        Contact laws that are not linear are taken about the compressions at rest.

    Returns
    -------
    frequencies : ndarray, shape (n,)
        [Hz], rising; 0 for rigid-body modes.
    modes : ndarray, shape (n, n)
        In columns, ``modes.T @ diag(mass) @ modes = 1``. With a `spin` or `rotors` they are complex, of modal mass 1.
    """
    K = machine.linear(machine.working())[0] - machine.frame
    if machine.spin or machine.rotors:
        return _whirling(machine, K)
    squared, modes = modal(K, machine.mass)
    return np.sqrt(squared) / (2 * math.pi), modes


def _whirling(machine, K):
    """Return natural frequencies and complex modes of an undamped machine in a rotating frame, or with tilting rotors."""
    n, mass = len(machine.mass), machine.mass
    gyroscopic, centripetal, _ = frame_terms(machine.dofs, mass, machine.springs, machine.spin, machine.rotors)
    inner = np.block([[np.zeros((n, n)), np.eye(n)], [-(K + centripetal) / mass[:, None], -gyroscopic / mass[:, None]]])
    values, vectors = np.linalg.eig(inner)
    order = np.argsort(values.imag)[n:]  # the forward whirl of each pair of modes
    modes = vectors[:n, order]
    modes = modes / np.sqrt((mass[:, None] * np.abs(modes) ** 2).sum(axis=0))
    top = values.imag.max()
    return np.where(values.imag[order] < math.sqrt(RIGID) * top, 0.0, values.imag[order]) / (2 * math.pi), modes


def modal(K: Floats, mass: Floats) -> tuple[Floats, Floats]:
    """Return squared angular frequencies, exactly 0 for rigid-body modes, and modes with unit modal mass.

    Raises
    ------
    ValueError
        If the stiffness is not positive semi-definite.
    """
    scale = 1 / np.sqrt(mass)
    squared, modes = eigh(K * scale[:, None] * scale[None, :])
    if squared[0] < -1e-8 * squared[-1]:
        raise ValueError(
            f"the stiffness matrix has a negative eigenvalue {squared[0]:.4g}: check the springs for a negative stiffness"
        )
    return np.where(squared < RIGID * squared[-1], 0.0, squared), scale[:, None] * modes

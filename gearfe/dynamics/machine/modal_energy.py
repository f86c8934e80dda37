"""Modal energy: shares of springs, meshes and bodies in the energy of each mode."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ...geometry.aliases import Floats
from .modes import natural_frequencies
from .tables import Machine


@dataclass(frozen=True, slots=True)
class ModalEnergy:
    """Shares of the energy of every mode.

    Attributes
    ----------
    frequencies : ndarray, shape (n,)
        Natural frequencies [Hz], increasing.
    modes : ndarray, shape (n, n)
        Modes of unit modal mass, in columns.
    strain : dict of str to ndarray, shape (n,)
        Part of the elastic energy by spring and mesh; nan for rigid-body modes, which have none.
    kinetic : dict of str to ndarray, shape (n,)
        Part of the kinetic energy by degree of freedom.
    """

    frequencies: Floats
    modes: Floats
    strain: dict[str, Floats]
    kinetic: dict[str, Floats]

    def participation(self, row: ArrayLike) -> Floats:
        """Modal participation factors ``modes.T @ row`` of a load along a row ``(n,)``, such as that of a mesh.

        A harmonic force F along it moves mode j by ``F participation[j] / (w_j**2 - w**2)``.
        """
        return np.asarray(self.modes.T @ np.asarray(row, dtype=float))

    def largest(self, mode: int, count: int = 3) -> dict[str, float]:
        """Return the springs and meshes that hold most of the elastic energy of a mode, and their shares."""
        ranked = sorted(self.strain, key=lambda name: -self.strain[name][mode])
        return {name: float(self.strain[name][mode]) for name in ranked[:count]}


def modal_energy(machine: Machine) -> ModalEnergy:
    """Fractions of the elastic energy of every mode by spring and mesh, and of the kinetic energy by degree of freedom.

    ::

        strain = k (row @ mode)**2 / sum of all,   kinetic = m mode**2

    The derivative of a natural frequency by a stiffness is ``f strain / (2 k)``. It shows which member to change. Meshes have
    their mean stiffness, which is the tangent stiffness for a `ForceLaw`.

    Parameters
    ----------
    machine : Machine
        Of a machine with a `spin` or `rotors` the modes are complex and the energies their means over a cycle.

    Returns
    -------
    ModalEnergy

    References
    ----------
    J. Lin, R. G. Parker, J. Sound Vib. 228(1) (1999) 109-128, eqs. 8-12: sensitivities as modal strain and kinetic energies.

    Examples
    --------
    >>> import gearfe as gf
    >>> energy = modal_energy(gf.single_mesh(1.0, 1e8, 500.0))
    >>> {name: part.tolist() for name, part in energy.strain.items()}
    {'mesh': [1.0]}
    """
    frequencies, modes = natural_frequencies(machine)
    k = machine.linear(machine.working())[2]
    members = [(s.name, s.row, s.k) for s in machine.springs] + list(
        zip((m.name for m in machine.meshes), machine.G, k, strict=True)
    )
    energy: dict[str, Floats] = {}
    for name, row, stiffness in members:
        energy[name] = energy.get(name, np.zeros(len(frequencies))) + stiffness * np.abs(row @ modes) ** 2
    total = np.sum(list(energy.values()), axis=0)
    total = np.where(frequencies > 0, total, np.nan)
    kinetic = machine.mass[:, None] * np.abs(modes) ** 2
    return ModalEnergy(
        frequencies,
        modes,
        {name: value / total for name, value in energy.items()},
        dict(zip(machine.dofs, kinetic / kinetic.sum(axis=0), strict=True)),
    )

"""Frequency response of a machine: receptance, mobility and accelerance between two of its coordinates."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.checks import numbers, one_of
from ...geometry.renamed import renamed
from .tables import Machine

KINDS = {"receptance": 0, "mobility": 1, "accelerance": 2}  # order of the time derivative
HIGHEST = 1e9  # largest frequency [Hz], above any mode; its square is finite


@renamed(heard="output", driven="input")
def frequency_response(
    machine: Machine,
    frequencies: ArrayLike,
    output: str | ArrayLike,
    input: str | ArrayLike,
    *,
    kind: str = "receptance",
) -> NDArray[np.complex128]:
    """Return the motion at one coordinate per harmonic force at another, with mean stiffness and damping of the meshes.

    ::

        H(f) = (i w)**p  output @ inv(K + i w C - w**2 M) @ input,   w = 2 pi f,  p = 0, 1, 2

    The variation of the stiffness, which couples frequencies that differ by the mesh frequency, is neglected. H is reciprocal
    (both coordinates may be exchanged) without rotating frame, tilting rotors and friction.

    Parameters
    ----------
    machine : Machine
    frequencies : array_like, shape (f,)
        [Hz]
    output, input : str or array_like, shape (n,)
        A degree of freedom, a mesh (its compression; its force on both bodies), or a row over the degrees of freedom.
    kind : str
        ``"receptance"`` [m/N, rad/(N m)...], ``"mobility"`` [times 1/s], ``"accelerance"`` [times 1/s2].

    Returns
    -------
    ndarray, shape (f,), complex

    Raises
    ------
    ValueError
        If a name is unknown, a frequency is negative or not finite, or the machine is free to move at it without limit.

    References
    ----------
    D. J. Ewins, Modal Testing, 2nd ed. (2000), section 2.6.

    Examples
    --------
    A mass of 2 kg on a spring of 8e4 N/m, at rest and far above its 31.8 Hz:

    >>> from gearfe.dynamics.machine.springs import Spring
    >>> disc = Machine(("disc.x",), [2.0], (Spring("bearing", np.array([1.0]), 8e4, 40.0),), ())
    >>> float(1 / frequency_response(disc, [0.0], "disc.x", "disc.x")[0].real)
    80000.0
    >>> round(float(frequency_response(disc, [1e4], "disc.x", "disc.x", kind="accelerance")[0].real), 4)
    0.5
    """
    one_of("kind", kind, KINDS)
    f = np.atleast_1d(numbers("frequencies", frequencies, " [Hz]"))
    if f.ndim != 1 or not f.size or not ((f <= HIGHEST).all() and (f >= 0).all()):
        raise ValueError(f"frequencies: give at least one number, each from 0 to {HIGHEST:g} Hz")
    out, at = _row(machine, output), _row(machine, input)
    K, C, _, _ = machine.linear(machine.working())
    scale = 1 / np.sqrt(machine.mass)  # Scaling gives displacements and rotations one order of magnitude.
    K, C = (scale[:, None] * matrix * scale for matrix in (K, C))
    answer = np.empty(f.size, dtype=complex)
    for i, w in enumerate(2 * np.pi * f):
        dynamic = K + 1j * w * C - w**2 * np.eye(len(K))
        if np.linalg.cond(dynamic) > 1e15:
            raise ValueError(f"the response at {f[i]:g} Hz is infinite: a body is free, or a mode has no damping")
        answer[i] = (1j * w) ** KINDS[kind] * (out * scale) @ np.linalg.solve(dynamic, scale * at)
    return answer


def _row(machine, given):
    """Return the row over the degrees of freedom that belongs to a name. A row is returned unchanged."""
    if isinstance(given, str):
        rows = [mesh.row for mesh in machine.meshes if mesh.name == given]
        return rows[0] if rows else machine.row(given)
    row = numbers("a row", given, "")
    if row.shape != (len(machine.dofs),) or not np.isfinite(row).all():
        raise ValueError(f"a row of shape {row.shape}: give {len(machine.dofs)} finite numbers, one per degree of freedom")
    return row

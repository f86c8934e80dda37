"""The exact linear part of a machine and the matrices of exponential steps: what `gearfe.exponential` steps with."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.linalg import eig, expm

from .machine import modal

LEVELS = 6  # a step is halved at most so often
CONDITION = 1e8  # of the eigenvectors: above it the linear part is kept full


@dataclass(frozen=True, slots=True)
class Plan:
    """What a run needs: coordinates, linear part, and the matrices of each level of step.

    Attributes
    ----------
    basis, inverse : ndarray, shape (2n, 2n)
        ``(q, v) = basis @ z``.
    A : ndarray, shape (2n, 2n)
    B : ndarray, shape (2n, f)
        Columns of the meshes, the friction rows, and the loads.
    P : ndarray, shape (m or 2m, 2n)
        Compressions (without errors), and their rates where the law needs them.
    blocks : bool
        Whether A is made of blocks of two.
    k, c : ndarray, shape (m,)
        Mesh stiffness and damping in the linear part.
    h : float
        Step [s].
    levels : list of tuple
        Of each step ``h / 2**level``: E; Y = (P exp(A h/2); P exp(A h)); S; T = (R - S, 2 S), for f1 and f3; F = (F1, F2, F2,
        F3), for f1, f3, f2 and f4.
    """

    basis: np.ndarray
    inverse: np.ndarray
    A: np.ndarray
    B: np.ndarray
    P: np.ndarray
    blocks: bool
    k: np.ndarray
    c: np.ndarray
    h: float
    levels: list


def plan(machine, h, x=None):
    """`Plan` of a machine for steps of `h` seconds, its laws taken at compressions `x` [m]."""
    K, C, k, c = machine.linear(x)
    squared, modes = modal(K, machine.mass)
    n = len(squared)
    unit = math.sqrt(squared[-1]) or 1.0  # so that displacements and velocities are of one size
    D = modes.T @ C @ modes
    A = np.block([[np.zeros((n, n)), unit * np.eye(n)], [-np.diag(squared) / unit, -D]])
    turn, blocks = _blocks(A, squared, D)
    back = np.linalg.inv(turn)
    A = back @ A @ turn
    zero = np.zeros((n, n))
    basis = np.block([[modes / unit, zero], [zero, modes]]) @ turn
    to_modes = modes.T * machine.mass
    inverse = back @ np.block([[unit * to_modes, zero], [zero, to_modes]])
    rub = [row for m in machine.meshes for row, _ in m.friction]
    rows = np.concatenate([-machine.G, -np.array(rub).reshape(-1, n), np.array([p.row for p in machine.loads]).reshape(-1, n)])
    B = back[:, n:] @ modes.T @ rows.T
    law = machine.law
    rates = (
        (law["beta"] > 0) | (law["per_depth"] > 0) | law["push"] | ((law["film"] != 1) & (law["damping"] > 0)) | (len(rub) > 0)
    )
    P = np.concatenate([machine.G @ basis[:n], *([machine.G @ basis[n:]] if rates.any() else [])])
    count = 1 + (LEVELS if (law["backlash"] > 0).any() or any(one.breaks.size > 1 for one in machine.loads) else 0)
    return Plan(basis, inverse, A, B, P, blocks, k, c, h, [_matrices(A, B, P, h / 2**level) for level in range(count)])


def _blocks(A, squared, D):
    """Coordinates in which A is made of real blocks of two, and whether they could be found."""
    n = len(squared)
    small = 1e-12 * np.abs(D).max(initial=0.0)
    rigid = (squared == 0) & (np.abs(D) <= small).all(axis=1)
    others = np.flatnonzero(np.concatenate([~rigid, ~rigid]))
    values, vectors = eig(A[np.ix_(others, others)])
    up = values.imag > 0
    real = np.argsort(values.real)[values.imag[np.argsort(values.real)] == 0]
    columns = [part for j in np.flatnonzero(up) for part in (vectors[:, j].real, vectors[:, j].imag)]
    columns += [vectors[:, j].real for j in real]
    turn = np.zeros((2 * n, 2 * n))
    for j, mode in enumerate(np.flatnonzero(rigid)):
        turn[mode, 2 * j] = turn[n + mode, 2 * j + 1] = 1.0
    turn[others, 2 * rigid.sum() :] = np.array(columns).T if columns else 0.0
    if np.linalg.cond(turn) > CONDITION:
        return np.eye(2 * n), False
    return turn, True


def _matrices(A, B, P, h):
    """Matrices of one step length; the phi functions from one exponential of an augmented matrix."""
    E2, (Q,) = _phi(A, B, h / 2, 1)
    E, phi = _phi(A, B, h, 3)
    F1, F2, F3 = phi[0] - 3 * phi[1] + 4 * phi[2], 2 * phi[1] - 4 * phi[2], 4 * phi[2] - phi[1]
    S, R = P @ Q, P @ E2 @ Q
    return E, np.concatenate([P @ E2, P @ E]), S, np.hstack([R - S, 2 * S]), np.hstack([F1, F2, F2, F3])


def _phi(A, B, h, order):
    """``exp(h A)`` and ``h phi_j(h A) B`` for j from 1 to `order`."""
    n, f = B.shape
    big = np.zeros((n + order * f, n + order * f))
    big[:n, :n], big[:n, n : n + f] = h * A, h * B
    for j in range(order - 1):
        big[n + j * f : n + (j + 1) * f, n + (j + 1) * f : n + (j + 2) * f] = np.eye(f)
    full = expm(big)
    return full[:n, :n], [full[:n, n + j * f : n + (j + 1) * f] for j in range(order)]

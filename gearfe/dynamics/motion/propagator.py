"""Exact linear part of a machine, and matrices of the fourth-order exponential step of the fast integrator.

``u = (q, v)`` is transformed to coordinates z in which the linear part (springs, and meshes at their mean stiffness) is exact:
``z' = A z + B f(t, P z)``. Here f are the deviations of the mesh forces from the linear part, and the loads. P z are the inputs
of the forces, the compressions of the meshes. The step is that of Cox and Matthews. Its stages are needed only as P z, so that
small matrices are sufficient:

    y = P exp(A h/2) z,  w = P exp(A h) z
    f1 = f(t, P z), f2 = f(t + h/2, y + S f1), f3 = f(t + h/2, y + S f2), f4 = f(t + h, w + R f1 + S (2 f3 - f1))
    z+ = exp(A h) z + F1 f1 + F2 (f2 + f3) + F3 f4

`gearfe.dynamics.motion.loop` takes these steps one after the other.

References
----------
S. M. Cox, P. C. Matthews, J. Comput. Phys. 176 (2002) 430-455, eqs. 26-29; A.-K. Kassam, L. N. Trefethen, SIAM J. Sci. Comput.
26 (2005) 1214-1233.
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.linalg import eig

from ..machine.contact_law import closed
from ..machine.modes import modal, natural_frequencies

UNSTABLE = "the machine is unstable (a parametric resonance without enough damping), or the step is too long"
LEVELS, DEEPER = 6, 8  # limits of step halving: near contact changes, and with an adaptive step
LOCAL = 1e-5  # `Plan.allowed` at the default step, as a part of the largest mesh force
STEPS = 80  # initial number of steps per mesh cycle
SHARE = 0.35  # initial step, as a part of the period of the stiffest mesh
CONDITION = 1e8  # condition number of the eigenvectors above which the linear part is a full matrix


@dataclass(frozen=True, slots=True)
class RunMatrices:
    """Data of a run: coordinates, linear part, and the matrices for each step level.

    Attributes
    ----------
    basis, inverse : ndarray, shape (2n, 2n)
        ``(q, v) = basis @ z``.
    P : ndarray, shape (m or 2m, 2n)
        Inputs of the forces: compressions (without errors), and their rates if the law needs them. If all forces are affine, ``x
        + damping_per_stiffness v`` alone.
    affine : bool
        True if all forces are affine: ``f = (k - plan.k) P z + shift(t)``.
    rows : ndarray, shape (width, n)
        Rows of the forces: meshes and friction rows, both negative, then loads.
    k, c : ndarray, shape (m,)
        Mesh stiffness and damping in the linear part.
    h : float
        Step [s].
    levels : list of tuple
        For each step ``h / 2**level``: E in blocks ``(blocks, size, size)``; Y = (P exp(A h/2); P exp(A h)); S; T = (R - S, 2 S),
        for f1 and f3; F = (F1, F2, F3), for f1, f2 + f3 and f4. Columns are those of the meshes, friction rows, and loads.
    told : list of ndarray, shape (m, width)
        By level: effect of forces at the end of a step on the mesh forces of the linear part there. The difference of the forces
        at its end from those of its last stage gives the difference to a step of lower order. The deviation of the stiffnesses
        from straight lines within the step, times the forces, gives the difference of Simpson's rule and the trapezoidal rule.
        The larger of both is the estimated error of the step.
    allowed : float
        Largest accepted estimate of a step, relative to the largest mesh force up to then. inf: no estimate.
    scale : float
        Initial value of the largest mesh force: that at rest [N].
    """

    basis: np.ndarray
    inverse: np.ndarray
    P: np.ndarray
    affine: bool
    rows: np.ndarray
    k: np.ndarray
    c: np.ndarray
    h: float
    levels: list
    told: list
    allowed: float
    scale: float


def is_affine(machine):
    """Return True if all mesh forces are ``k(t) (x - e) + c(t) (x - e)'`` at any time and loads have no kinks."""
    smooth = all(load.breaks.size < 2 for load in machine.loads) and not any(m.friction for m in machine.meshes)
    return closed(machine.law) and smooth and not machine.curved


def plan(machine, h, x=None, adapt=False):
    """`RunMatrices` of a machine for steps of `h` seconds, with its contact laws linearised at compressions `x` [m].

    With `adapt`, the matrices for the error estimate of steps are included.
    """
    K, C, k, c = machine.linear(x)
    squared, modes = modal(K - machine.frame, machine.mass)
    n = len(squared)
    unit = math.sqrt(squared[-1]) or 1.0  # Scaling gives displacements and velocities one order of magnitude.
    D = modes.T @ C @ modes
    A = np.block([[np.zeros((n, n)), unit * np.eye(n)], [-(np.diag(squared) + modes.T @ machine.frame @ modes) / unit, -D]])
    turn, size = _blocks(A, squared, D)
    back = np.linalg.inv(turn)
    A = (back @ A @ turn).reshape(2 * n // size, size, 2 * n // size, size)
    A = A[np.arange(len(A)), :, np.arange(len(A))]
    zero = np.zeros((n, n))
    basis = np.block([[modes / unit, zero], [zero, modes]]) @ turn
    to_modes = modes.T * machine.mass
    inverse = back @ np.block([[unit * to_modes, zero], [zero, to_modes]])
    rub = [row for m in machine.meshes for row, _ in m.friction]
    rows = np.concatenate([-machine.G, -np.array(rub).reshape(-1, n), np.array([p.row for p in machine.loads]).reshape(-1, n)])
    B = back[:, n:] @ modes.T @ rows.T
    pressed, law = x, machine.law
    x, v = machine.G @ basis[:n], machine.G @ basis[n:]
    affine = is_affine(machine)
    P = x + law["damping_per_stiffness"][:, None] * v if affine else np.concatenate([x, *([v] if _needs_rates(law, rub) else [])])
    opens = bool((law["backlash"] > 0).any())
    local = adapt and opens and is_bent(machine)
    count = 1 + (DEEPER if local else LEVELS if opens or any(load.breaks.size > 1 for load in machine.loads) else 0)
    levels = [_matrices(A, B, P, h / 2**level) for level in range(count)]
    told = [_told(P, F[:, 2 * B.shape[1] :], k, c) for *_, F in levels]
    allowed = LOCAL * (h / default_step(machine)) ** 4 if local else math.inf
    scale = float(np.abs(k * pressed).max()) if local and pressed is not None else 0.0
    return RunMatrices(basis, inverse, P, affine, rows, k, c, h, levels, told, allowed, scale)


def _told(P, end, k, c):
    """Return the linear mesh forces at the end of a step per force f, where f changes the state z by ``end @ f``."""
    x, m = P @ end, len(k)
    return x[:m] * k[:, None] + (x[m:] * c[:, None] if len(P) > m else 0.0)


def is_bent(machine):
    """Return True if a mesh force is nonlinear in compression or rate: an exponent, or damping that grows with the depth."""
    return bool((machine.law["straight"] == 0).any())


def cycle_rate(machine):
    """Return the steps per second that resolve mesh cycles, `STEPS` each [1/s]; 0 without mesh frequencies."""
    return STEPS * (machine.fastest * max((abs(m.frequency) for m in machine.meshes), default=0.0))


def default_step(machine):
    """Return the step [s] that resolves mesh cycles (`STEPS` per cycle) and mesh vibration (`SHARE` of a period).

    A mesh excites its bodies up to about ``sqrt(k sum(row**2 / m))``. Supports of any stiffness are in the exact linear part.
    """
    x = machine.working()
    squared = machine.linear(x)[2] * (machine.G**2 / machine.mass).sum(axis=1)
    top = math.sqrt(squared.max()) / (2 * math.pi) if squared.size else natural_frequencies(machine)[0][-1]
    return 1 / max(cycle_rate(machine), top / SHARE)


def _needs_rates(law, rub):
    """Return whether a force depends on the rate of compression."""
    film = (law["film"] != 1) & (law["damping"] > 0)
    rates = (law["damping_per_stiffness"] > 0) | (law["straight"] == 0) | (law["least"] == 0) | film
    return bool(rub) or rates.any()


def _blocks(A, squared, D):
    """Return coordinates in which A has real blocks on its diagonal, and their size: 2, or that of A if this fails."""
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
        return np.eye(2 * n), 2 * n
    return turn, 2


def _matrices(A, B, P, h):
    """Matrices of one step length."""
    count, size, _ = A.shape

    def on(blocks, columns):
        return (blocks @ columns.reshape(count, size, -1)).reshape(columns.shape)

    def before(blocks):  # P times the blocks
        return np.einsum("pis,ist->pit", P.reshape(-1, count, size), blocks).reshape(P.shape)

    half, phi_1, _, _ = _phi(A * (h / 2))
    E, *phi = _phi(A * h)
    Q = h / 2 * on(phi_1, B)
    phi = [h * on(each, B) for each in phi]
    F = phi[0] - 3 * phi[1] + 4 * phi[2], 2 * phi[1] - 4 * phi[2], 4 * phi[2] - phi[1]
    S, R = P @ Q, P @ on(half, Q)
    return E, np.concatenate([before(half), before(E)]), S, np.hstack([R - S, 2 * S]), np.hstack(F)


def _phi(Z):
    """``exp(Z), phi_1(Z), phi_2(Z), phi_3(Z)`` of blocks ``(n, s, s)``, ``phi_j(z) = sum z**i / (i + j)!``.

    Each block is scaled below 1/2. Its Taylor series is evaluated, and the result is doubled by ``2**j phi_j(2 z) = exp(z)
    phi_j(z) + sum over i from 1 to j of phi_i(z) / (j - i)!`` (B. Skaflestad, W. M. Wright, Appl. Numer. Math. 59 (2009)
    783-799).
    """
    size = np.abs(Z).sum(axis=-1).max(axis=-1)
    halved = np.maximum(np.ceil(np.log2(np.maximum(size, 1e-300) / 0.5)), 0).astype(int)
    Z, identity = Z / 2.0 ** halved[:, None, None], np.eye(Z.shape[-1])
    third = np.zeros_like(Z)
    for i in range(14, -1, -1):
        third = Z @ third + identity / math.factorial(i + 3)
    second = Z @ third + identity / 2
    first = Z @ second + identity
    E = Z @ first + identity
    for done in range(halved.max(initial=0)):
        doubled = (done < halved)[:, None, None]
        third = np.where(doubled, (E @ third + first / 2 + second + third) / 8, third)
        second = np.where(doubled, (E @ second + first + second) / 4, second)
        first = np.where(doubled, (E @ first + first) / 2, first)
        E = np.where(doubled, E @ E, E)
    return E, first, second, third

"""The exponential step of order four that the fast path takes, on arrays.

``u = (q, v)`` is brought to coordinates z in which the linear part - springs, and meshes at their mean stiffness - is exact,
``z' = A z + B f(t, P z)``: f are the deviations of the mesh forces from the linear part and the loads, P z what they depend on,
the compressions of the meshes. The step is that of Cox and Matthews; its stages are only needed as P z, so that small matrices
carry them:

    y = P exp(A h/2) z,  w = P exp(A h) z
    f1 = f(t, P z), f2 = f(t + h/2, y + S f1), f3 = f(t + h/2, y + S f2), f4 = f(t + h, w + R f1 + S (2 f3 - f1))
    z+ = exp(A h) z + F1 f1 + F2 (f2 + f3) + F3 f4

`gearfe.dynamics.motion.loop` takes these steps one after the other, in scalar arithmetic; here they are taken on arrays, by
`gearfe.dynamics.motion.steady` with as many columns as there are starts.

References
----------
S. M. Cox, P. C. Matthews, J. Comput. Phys. 176 (2002) 430-455, eqs. 26-29; A.-K. Kassam, L. N. Trefethen, SIAM J. Sci. Comput.
26 (2005) 1214-1233.
"""

import numpy as np

from .propagator import dense

UNSTABLE = "the machine is unstable (a parametric resonance without enough damping), or the step is too long"


class Step:
    """Steps of a `gearfe.dynamics.motion.propagator.Plan`, each level of them, in as few array calls as can be.

    Parameters
    ----------
    plan : Plan
    columns : tuple of int
        ``()`` for one state ``(2n,)``; ``(c,)`` for c of them, ``(2n, c)``.

    Attributes
    ----------
    rows : int
        Of the arrays x that the forces are asked at: those of ``plan.P``, and where all forces are affine zeros below them, so
        that x and f have one shape.
    width : int
        Of the forces: meshes, friction rows and loads.
    stages : tuple of ndarray
        x at which the second, third and fourth force of the last step were taken.
    """

    def __init__(self, plan, columns=()):
        n, wide = plan.P.shape[1], plan.levels[0][2].shape[1]
        self.width, self.rows = wide, wide if plan.affine else len(plan.P)
        self.P = self._padded(plan.P)
        self.levels = [self._joined(len(plan.P), *level) for level in plan.levels]
        # f2, z, f1, f3 and f4 below each other: each stage is one product with a part of them
        whole = np.zeros((n + 4 * wide, *columns))
        self.all, self.upper, self.lower = whole[wide:], whole[: wide + n], whole[wide : n + 2 * wide]
        self.z, self.longer = whole[wide : wide + n], whole[wide : n + 3 * wide]
        self.forces = (self.all[n : n + wide], whole[:wide], self.all[n + wide : n + 2 * wide], self.all[n + 2 * wide :])
        self.start = np.empty((self.rows, *columns))
        self.stages = tuple(np.empty((self.rows, *columns)) for _ in range(3))

    def _padded(self, matrix):
        return np.concatenate([matrix, np.zeros((self.rows - len(matrix), matrix.shape[1]))])

    def _joined(self, p, E, Y, S, T, F):
        parts = [Y[:p], S], [S, Y[:p]], [Y[p:], T]
        return *(self._padded(np.hstack(part)) for part in parts), np.hstack([dense(E), F])

    def __call__(self, z, level, force, j):
        """State one step of `level` after `z`.

        ``force(x, out, i)`` fills in the forces at x ``(rows, ...)``, i half steps after that of ``i = j``, the step's start.
        """
        second, third, fourth, end = self.levels[level]
        x1, (x2, x3, x4), (f1, f2, f3, f4) = self.start, self.stages, self.forces
        self.z[:] = z
        self.P.dot(z, x1)
        force(x1, f1, j)
        second.dot(self.lower, x2)
        force(x2, f2, j + 1)
        third.dot(self.upper, x3)
        force(x3, f3, j + 1)
        fourth.dot(self.longer, x4)
        force(x4, f4, j + 2)
        f3 += f2
        return end.dot(self.all)

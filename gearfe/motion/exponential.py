"""The exponential step of order four that the fast path takes, on arrays.

``u = (q, v)`` is brought to coordinates z in which the linear part - springs, and meshes at their mean stiffness - is exact,
``z' = A z + B f(t, P z)``: f are the deviations of the mesh forces from the linear part and the loads, P z what they depend on,
the compressions of the meshes. The step is that of Cox and Matthews; its stages are only needed as P z, so that small matrices
carry them:

    y = P exp(A h/2) z,  w = P exp(A h) z
    f1 = f(t, P z), f2 = f(t + h/2, y + S f1), f3 = f(t + h/2, y + S f2), f4 = f(t + h, w + R f1 + S (2 f3 - f1))
    z+ = exp(A h) z + F1 f1 + F2 (f2 + f3) + F3 f4

`gearfe.motion.numpy_loop` takes these steps one after the other, and `gearfe.motion.steady` with as many columns as there are
starts; `gearfe.motion.numba_loop` is the same step in scalar arithmetic, for numba.

References
----------
S. M. Cox, P. C. Matthews, J. Comput. Phys. 176 (2002) 430-455, eqs. 26-29; A.-K. Kassam, L. N. Trefethen, SIAM J. Sci. Comput.
26 (2005) 1214-1233.
"""

import numpy as np

from .propagator import dense

UNSTABLE = "the machine is unstable (a parametric resonance without enough damping), or the step is too long"


class Step:
    """Steps of a `gearfe.motion.propagator.Plan`, each level of them, in as few array calls as can be.

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
        self.width = plan.levels[0][2].shape[1]
        self.rows = self.width if plan.affine else len(plan.P)
        self.levels = [self._stacked(plan, *one) for one in plan.levels]
        n, rows, wide = plan.P.shape[1], self.rows, self.width
        self.both = np.empty((n + 3 * rows, *columns))  # z, x1, x2 or x3, x4 without the forces of the step
        self.parts = tuple(self.both[low:high] for low, high in ((0, n), *((n + i * rows, n + (i + 1) * rows) for i in range(3))))
        self.extra = np.empty((n, *columns))
        self.stages = tuple(np.empty((rows, *columns)) for _ in range(3))
        f = self.forces = np.zeros((4 * wide, *columns))  # of the stages 1, 3, 4, 2
        self.each = tuple(f[i * wide : (i + 1) * wide] for i in (0, 3, 1, 2))
        self.f13, self.f134 = f[: 2 * wide], f[: 3 * wide]

    def _stacked(self, plan, E, Y, S, T, F):
        p = len(plan.P)

        def pad(matrix):
            return np.concatenate([matrix, np.zeros((self.rows - p, matrix.shape[1]))])

        return np.concatenate([dense(E), pad(plan.P), pad(Y[:p]), pad(Y[p:])]), pad(S), pad(T), F

    def __call__(self, z, level, force, j):
        """State one step of `level` after `z`.

        ``force(x, out, i)`` fills in the forces at x ``(rows, ...)``, i half steps after that of ``i = j``, the step's start.
        """
        whole, S, T, F = self.levels[level]
        new, x1, y, w = self.parts
        x2, x3, x4 = self.stages
        f1, f2, f3, f4 = self.each
        whole.dot(z, self.both)
        force(x1, f1, j)
        S.dot(f1, x2)
        x2 += y
        force(x2, f2, j + 1)
        S.dot(f2, x3)
        x3 += y
        force(x3, f3, j + 1)
        T.dot(self.f13, x4)
        x4 += w
        force(x4, f4, j + 2)
        f3 += f2
        F.dot(self.f134, self.extra)
        return new + self.extra

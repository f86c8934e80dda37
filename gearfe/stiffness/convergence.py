"""`convergence`: stiffness of a case over resolution and order, with error estimate and true difference."""

import os
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..core.case import Case
from ..core.table import Column, Table, stiffness_column
from ..core.units import NEWTON_PER_UM
from ..figures.convergence_plots import plot_convergence
from ..geometry.aliases import Floats
from .solve import Solve, solve

REFINES = (0.5, 0.7, 1.0, 1.4, 2.0)


@dataclass(frozen=True, slots=True)
class Convergence:
    """Stiffness of one case by one method, from coarse to fine.

    Attributes
    ----------
    method : str
    refine, order : tuple, shape (solves,)
        Resolution and polynomial order of each solve; the order is None for methods without one.
    k : ndarray, shape (solves, phases)
        Mesh stiffness [N/m].
    error : ndarray, shape (solves, phases)
        Its estimated error [N/m].
    seconds : tuple of float, shape (solves,)
        CPU time of each solve with its estimate.
    """

    method: str
    refine: tuple[float, ...]
    order: tuple[int | None, ...]
    k: Floats
    error: Floats
    seconds: tuple[float, ...]

    @property
    def difference(self) -> Floats:
        """Difference of `k` from the finest solve, which is the last one ``(solves, phases)`` [N/m]."""
        return np.abs(self.k - self.k[-1])

    @property
    def table(self) -> Table:
        """Table of each solve: mean stiffness, its estimate, and its difference from the finest solve.

        The estimate and the difference of the mean, then the largest of both over the phases, in percent of k.
        """
        percent = ("estimate of the mean", "difference of the mean", "largest estimate", "largest difference")
        columns = ["method", Column("refine", form="{:g}"), Column("order", form="{:d}"), stiffness_column("mean k", 6)]
        columns += [*(Column(name, "%", "{:.3f}") for name in percent), Column("CPU time", "s", "{:.1f}")]
        mean = self.k.mean(axis=1)
        values = [self.error.mean(axis=1) / mean, np.abs(mean / mean[-1] - 1)]
        values += [(self.error / self.k).max(axis=1), (self.difference / self.k[-1]).max(axis=1)]
        rows = zip(self.refine, self.order, mean / NEWTON_PER_UM, *(100 * np.array(values)), self.seconds, strict=True)
        return Table(columns, [[self.method, *row] for row in rows], f"Convergence of {self.method}")

    def __repr__(self) -> str:
        """Title and table."""
        return f"Convergence of {self.method}\n\n{self.table}"

    def plot(self, path: str | os.PathLike[str] | None = None) -> Any:
        """Draw the largest estimate and the largest difference over the resolution, with a line for each order.

        Save to `path` if given.
        """
        estimate, away = 100 * (self.error / self.k).max(axis=1), 100 * (self.difference / self.k[-1]).max(axis=1)
        return plot_convergence(self.method, np.array(self.refine), self.order, estimate, away, path)


def convergence(
    case: Case, how: Solve | None = None, *, refines: Sequence[float] = REFINES, orders: Sequence[int] | None = None
) -> Convergence:
    """Solve a case at several resolutions and orders, each time with an error estimate.

    Parameters
    ----------
    case : Case
        With one load.
    how : Solve, optional
        Method and phases; default: ``Solve()``. Its `refine`, `order` and `error` are replaced.
    refines : sequence of float
        Resolutions, from coarse to fine.
    orders : sequence of int, optional
        Polynomial orders, for methods that have one; default: from one less to one more than that of the method.

    Returns
    -------
    Convergence
        The finest solve is the last one.

    Raises
    ------
    ValueError
        If the case has several loads, no resolution is given, or the method has no error estimate.

    Examples
    --------
    >>> import math, gearfe as gf
    >>> rack = dict(m_n=2.0, alpha_n=math.radians(20), b=20.0)
    >>> pair = gf.GearPair(gf.Gear(z=21, r_bore=7.4, **rack), gf.Gear(z=31, r_bore=11.4, **rack))
    >>> case = gf.Case(pair, force=2000.0, material=gf.Material())
    >>> found = gf.convergence(case, gf.Solve(phases=4), refines=(0.7, 1.0), orders=(3, 4))
    >>> bool((found.difference <= found.error).all())
    True
    """
    how = how or Solve()
    method, _ = how.chosen(case)
    if case.several or not len(refines) or not method.converged:
        given = f"method = {method.name!r}, {len(case.forces)} loads, refines = {refines!r}"
        raise ValueError(f"{given}: give a converged method, one load, and at least one resolution")
    if method.order is None:
        orders = (None,)  # type: ignore[assignment]
    elif orders is None:
        orders = (method.order - 1, method.order, method.order + 1)
    steps = [(float(refine), order) for refine in refines for order in orders or ()]
    if not steps:
        raise ValueError(f"orders = {orders!r}, but give at least one polynomial order, or None for the default orders")
    curves, seconds = [], []
    for refine, order in steps:
        started = time.process_time()
        curves.append(solve(case, replace(how, refine=refine, order=order, error=True)))
        seconds.append(time.process_time() - started)
    k, error = (np.array([getattr(curve, name) for curve in curves]) for name in ("k", "error"))
    refine_of, order_of = zip(*steps, strict=True)
    return Convergence(method.name, refine_of, order_of, k, error, tuple(seconds))

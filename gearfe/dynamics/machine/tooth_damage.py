"""`ToothDamage`: a damaged tooth of a mesh, and the table of its stiffness change."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...core.checks import whole
from ...stiffness.curve import StiffnessCurve
from .force_law import ForceLaw
from .mesh_curves import ALIKE, Change, Curve, Samples, cells_of, changed, evenly
from .phase_table import PhaseTable, table


@dataclass(frozen=True, slots=True)
class ToothDamage:
    """A damaged tooth of one of the two bodies of a mesh.

    Parameters
    ----------
    body : int
        0 or 1: whose tooth.
    tooth : int
        Its number.
    curve : StiffnessCurve, Samples or ForceLaw
        Stiffness over the tooth's whole engagement (``span="tooth"``): phase 0 is where its pair enters. A law where the mesh
        has one. A curve over all mesh cycles until the tooth returns repeats without end.
    every : int, optional
        Mesh cycles until it returns, if these are not the teeth of its body: the hunting period of two damaged teeth that are in
        mesh with each other. Such a curve replaces those of the teeth before it in `GearMesh.damage`.
    """

    body: int
    tooth: int
    curve: Curve | ForceLaw
    every: int | None = None

    def __post_init__(self) -> None:
        """Raise ValueError unless `body` is 0 or 1, and `tooth` and `every` are whole numbers."""
        if self.body not in (0, 1) or isinstance(self.body, bool):
            raise ValueError(f"damaged tooth: body = {self.body!r}, but give 0 or 1")
        whole("damaged tooth: tooth", self.tooth)
        if self.every is not None:
            whole("damaged tooth: every", self.every, 1)

    def change(self, usual: Sequence[Change], first: float, cycles: int, name: str = "k") -> PhaseTable:
        """Return the change of `name` by this tooth as a `PhaseTable`, relative to the sum of the `usual` changes.

        The change is zero one cell before and after the table. `first` is the unwrapped phase at which the tooth enters, and
        `cycles` the mesh cycles after which it returns. A curve that lasts `cycles` is periodic. For curves at the same
        samples, the coefficients of the cubics are subtracted, so that the sum is exactly the cubic through the curve itself.
        """
        curve = Samples(*self.curve.at(self.curve.force)) if isinstance(self.curve, ForceLaw) and name == "k" else self.curve
        phase, values = np.asarray(curve.phase, dtype=float), getattr(curve, name, None)
        values = np.zeros(phase.size) if values is None else np.asarray(values, dtype=float)
        if phase.size < 2 or not (np.diff(phase) > 0).all():
            raise ValueError("the phases of a damaged tooth's curve must rise: use mesh_stiffness(..., span='tooth')")
        steps = np.diff(phase)
        width, whole = steps.mean(), 0 < phase[0] + cycles - phase[-1] < 1.5 * steps.max()
        if np.ptp(steps) > ALIKE * width:
            grid, values = evenly(phase, values - changed(usual, first + phase), cycles if whole else None)
            return _change(grid, values, whole)
        grid = phase[0] + width * np.arange(phase.size)
        if whole:
            own = table(values, grid[0], width, periodic=True)
        else:
            beyond = width * np.array([-2, -1])
            before, after = (changed(usual, first + end) for end in (grid[0] + beyond, grid[-1] - beyond[::-1]))
            own = table(np.concatenate([before, values, after]), grid[0] - 2 * width, width, periodic=False)
            own = PhaseTable(grid[0] - width, width, own.cells[1:-1])
        cells = cells_of(usual, first + own.start, width, len(own.cells))
        if cells is not None and isinstance(self.curve, StiffnessCurve):
            return PhaseTable(own.start, width, own.cells - cells)
        return _change(grid, values - changed(usual, first + grid), whole)


def _change(grid, values, whole):
    """Return the `PhaseTable` of a change at equally spaced phases. It is periodic, or zero one cell beyond either end."""
    width = grid[1] - grid[0]
    values = values if whole else np.concatenate([[0.0], values, [0.0]])
    return table(values, grid[0] if whole else grid[0] - width, width, periodic=whole)

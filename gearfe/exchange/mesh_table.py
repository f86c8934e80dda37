"""Mesh stiffness over the angle of the pinion until it repeats, as the tables that other programs read."""

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..core.case import Case
from ..core.files import Content, save_as, written
from ..geometry.aliases import Floats, StrPath
from ..stiffness.mesh_cycle import mesh_cycle
from ..stiffness.solve import Solve

NAMES = ("angle_rad", "k_N_per_m", "unloaded_m")


class MeshTable(NamedTuple):
    """Stiffness and unloaded transmission error of a case at rising mesh phases, until the same teeth meet again.

    The rows are closer together where pairs enter or leave. Between two rows both are linear, and after the last row comes the
    first: ``F = k (delta - unloaded)`` while positive, where ``delta = r_b1 phi_1 - r_b2 phi_2`` is the approach along the line
    of action. Phase 0 is the entry of tooth 0 of both gears.
    """

    case: Case
    phase: Floats
    k: Floats
    unloaded: Floats
    cycles: int

    @property
    def angle(self) -> Floats:
        """Angle of the pinion [rad]."""
        return 2 * math.pi * self.phase / self.case.pair.gear_1.z

    def at(self, phase: Floats) -> tuple[Floats, Floats]:
        """Return stiffness [N/m] and unloaded transmission error [m] at phases, as a program that reads the table has them."""
        return tuple(np.interp(phase, self.phase, values, period=self.cycles) for values in (self.k, self.unloaded))  # type: ignore[return-value]


def mesh_table(case: Case, how: Solve | None = None) -> MeshTable:
    """Return the `MeshTable` of a case with its damage and deviations.

    It raises the ValueErrors of `gearfe.mesh_cycle`.
    """
    cycle = mesh_cycle(case, how, fine=True)
    phase = cycle.solved
    return MeshTable(case, phase, cycle.sampled("k", phase), cycle.sampled("unloaded", phase), cycle.cycles)


def write_mesh_table(path: StrPath, case: Case, how: Solve | None = None) -> None:
    """Write the stiffness of a case over the angle of the pinion, for lookup tables of other programs.

    The columns are ``angle_rad, k_N_per_m, unloaded_m``, see `MeshTable`. The last row repeats the first one after the period.

    Parameters
    ----------
    path : path
        ``.mat`` for Simulink and Simscape, or ``.txt`` for blocks of Modelica such as CombiTable1Ds, with the table ``mesh``.
    case : Case
        Pair, load and damage.
    how : Solve, optional
        Method, and phases per mesh cycle. Further ones are added where pairs enter or leave.

    Raises
    ------
    ValueError
        If the path has another suffix or cannot be written; as `gearfe.mesh_cycle`.
    """
    suffix = Path(path).suffix.lower()
    if suffix not in (".mat", ".txt"):
        raise ValueError(f"{path}: a mesh table is .mat (Simulink, Simscape) or .txt (Modelica)")
    table = mesh_table(case, how)
    end = 2 * math.pi * table.cycles / case.pair.gear_1.z
    columns = [np.append(table.angle, end), *(np.append(values, values[0]) for values in (table.k, table.unloaded))]
    if suffix == ".mat":
        save_as(suffix, path, Content("gearfe mesh table", {}, dict(zip(NAMES, columns, strict=True)), {"cycles": table.cycles}))
        return
    lines = ["#1", f"double mesh({columns[0].size},3) # {', '.join(NAMES)}"]
    lines += [" ".join(f"{value:.17g}" for value in row) for row in zip(*columns, strict=True)]
    with written(path) as name:
        Path(name).write_text("\n".join(lines) + "\n", encoding="utf-8")

"""`transmission_error`: transmission error over the mesh cycle at several loads (Harris map)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Unpack

import numpy as np

from ..core.case import Case
from ..core.table import Column, Table
from ..figures.error_plots import plot_transmission_error
from ..geometry.aliases import Floats
from ..geometry.pair.gear_pair import GearPair
from .curve import StiffnessCurve
from .mesh_stiffness import StiffnessOptions, split_arguments
from .solve import Loads, Materials, Solve, solve


@dataclass(frozen=True, slots=True)
class TransmissionError:
    """Transmission error of a pair over phase under several loads, as a length on the line of action.

    Attributes
    ----------
    force : ndarray, shape (m,)
        Forces along the line of action [N].
    phase : ndarray, shape (n,)
        Mesh phase.
    te : ndarray, shape (m, n)
        Transmission error under each load, including the unloaded part [m].
    unloaded : ndarray, shape (n,)
        Unloaded transmission error [m], 0 for involutes.
    curves : tuple of StiffnessCurve
        One for each load: stiffness, load sharing, pressure.
    """

    force: Floats
    phase: Floats
    te: Floats
    unloaded: Floats
    curves: tuple[StiffnessCurve, ...]

    def __repr__(self) -> str:
        """Return the number of phases and the peak-to-peak value under each load."""
        loads = zip(self.peak_to_peak, self.force, strict=True)
        each = ", ".join(f"{1e6 * most:.3f} um under {force:.6g} N" for most, force in loads)
        return f"TransmissionError at {self.phase.size} phases, peak-to-peak {each}"

    @property
    def peak_to_peak(self) -> Floats:
        """Largest minus smallest transmission error over the phases for each load ``(m,)`` [m]."""
        return np.ptp(self.te, axis=1)

    def harmonics(self, count: int = 4) -> Floats:
        """Amplitudes of the first mesh harmonics for each load ``(m, count)`` [m].

        ValueError if the phases are not equidistant over whole mesh cycles, or too few.
        """
        n = self.phase.size
        cycles = (self.phase[-1] - self.phase[0]) * n / (n - 1) if n > 1 else 0.0
        even = n > 1 and np.abs(np.diff(self.phase) - cycles / n).max() < 1e-9
        if not even or abs(cycles - round(cycles)) > 1e-6 or n < 2 * count * round(cycles) + 1:
            raise ValueError(
                f"{count} harmonics of {n} phases over {cycles:.6g} mesh cycles: give equidistant phases over whole cycles, more "
                f"than {2 * count} in each (the default does)"
            )
        return 2 / n * np.abs(np.fft.rfft(self.te, axis=1))[:, round(cycles) * np.arange(1, count + 1)]

    def record(self) -> Table:
        """Return a `Table` of the transmission error over the phase [m], with a column per load."""
        columns = {f"te at {force:.6g} N": row for force, row in zip(self.force, self.te, strict=True)}
        columns["te unloaded"] = self.unloaded
        rows = np.column_stack([self.phase, *columns.values()]).tolist()
        return Table(["phase", *(Column(name, "m") for name in columns)], rows)

    def table(
        self, plain: TransmissionError | None = None, r_b: float | None = None, healthy: TransmissionError | None = None
    ) -> Table:
        """Return a `Table` of peak-to-peak, mean and first harmonics by load [um].

        It also contains the peak-to-peak values of unmodified involutes and of the `healthy` pair, and the torque if the base
        radius of the pinion `r_b` [mm] is given.
        """
        shown: dict[Column, list[Any]] = {Column("force", "N", "{:.6g}"): [*self.force, "unloaded"]}
        if r_b is not None:
            shown[Column("torque", "N m", "{:.4g}")] = [*1e-3 * r_b * self.force, None]
        others = {"of involutes": plain, "healthy": healthy}
        spans = {"peak-to-peak": self} | {name: one for name, one in others.items() if one is not None}
        in_um = {name: [*one.peak_to_peak, np.ptp(one.unloaded)] for name, one in spans.items()}
        in_um["mean"] = [*self.te.mean(axis=1), self.unloaded.mean()]
        in_um |= {f"harmonic {n + 1}": [*part, np.nan] for n, part in enumerate(self.harmonics(3).T)}
        for name, values in in_um.items():
            shown[Column(name, "um", "{:z.3f}")] = [1e6 * value for value in values]
        return Table(tuple(shown), list(zip(*shown.values(), strict=True)))

    def plot(self, path: str | Path | None = None, title: str | None = None) -> Any:
        """Draw the error over the phase, and its peak-to-peak value over the load. Save to `path` if given."""
        return plot_transmission_error(self, path, title)


def transmission_error(
    pair: GearPair | Case,
    forces: float | Loads | None = None,
    material: Materials = None,
    *,
    torque: float | Loads | None = None,
    **options: Unpack[StiffnessOptions],
) -> TransmissionError:
    """Compute the loaded transmission error of a pair over the mesh cycle at several loads, which share one solve.

    The driven gear lags by ``te`` on the line of action: elastic deflection plus the unloaded part (modified flanks, pitch), with
    ``te - unloaded = force / k``. Its variation over the mesh cycle excites vibration. S. L. Harris (Proc. Inst. Mech. Eng. 172
    (1958) 87-112) drew it over phase for several loads: with a tip relief it is flat at one of them.

    Parameters
    ----------
    pair : GearPair or Case
    forces : float or sequence of float
        Forces along the line of action [N]; default those of the case.
    material : Material or (Material, Material)
    torque : float or sequence of float, optional
        Instead of `forces`: torques on the pinion [N m].
    **options
        Options of `mesh_stiffness`: ``flanks``, ``method``, ``phases``, ``pose`` and so on.

    Returns
    -------
    TransmissionError

    Raises
    ------
    ValueError
        If an input is impossible; the message states which.

    Examples
    --------
    >>> import math, gearfe as gf
    >>> rack = dict(m_n=3.0, alpha_n=math.radians(20), b=20.0)
    >>> pair = gf.GearPair(gf.Gear(z=24, r_bore=15.0, **rack), gf.Gear(z=36, r_bore=20.0, **rack))
    >>> steel = gf.Material(E=207e3, nu=0.3)
    >>> relief = dict(tip_relief=0.010, tip_exponent=1)
    >>> flanks = {
    ...     name: gf.Flank(tip_start_roll=gear.roll_a - 4.7, **relief)
    ...     for name, gear in (("pinion", pair.gear_1), ("wheel", pair.gear_2))
    ... }
    >>> for given in (None, flanks):
    ...     error = gf.transmission_error(pair, [1000.0, 3000.0], steel, flanks=given, phases=32)
    ...     print([round(1e6 * float(span), 1) for span in error.peak_to_peak])
    [1.3, 3.6]
    [2.6, 0.4]
    """
    return errors_under_loads(*split_arguments("transmission_error", pair, forces, material, torque, options))


def errors_under_loads(case: Case, how: Solve) -> TransmissionError:
    """Return the `TransmissionError` of a case under its loads."""
    return errors_of(solve(replace(case, force=case.forces), how))


def errors_of(curves: Iterable[StiffnessCurve]) -> TransmissionError:
    """Return the `TransmissionError` of curves at the same phases, one per load."""
    curves = tuple(curves)
    te, phase = np.array([curve.te for curve in curves]), curves[0].phase
    unloaded = np.zeros(phase.size) if curves[0].unloaded is None else curves[0].unloaded
    return TransmissionError(np.array([curve.meta["force_N"] for curve in curves]), phase, te, unloaded, curves)

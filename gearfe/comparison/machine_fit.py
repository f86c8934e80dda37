"""`fit_machine`: parameters of a scene's machine from a healthy record, and that record with a simulated fault."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.special import chdtri, stdtrit

from ..core.table import Column, Table
from ..dynamics.machine.of_scene import build_machine
from ..dynamics.machine.stages import Fault
from ..dynamics.motion.transfer_path import gain_of_modes, through_frf
from ..geometry.aliases import Floats
from ..scene.dotted_keys import find_key, set_values
from ..scene.load import Scene, read_tables, scene_of
from ..scene.schema import LISTS
from ..signal.known_lines import line_amplitudes, noise_amplitudes
from ..signal.series import Signal
from .fitted_lines import BAND, machine_lines, resolved_lines, steady_part
from .settled import recorded

PATH = ("path.frequency_Hz", "path.damping_ratio", "path.mass_kg")
STARTS = 6  # starting points per parameter; the best two or more are refined, at most half of them


@dataclass(frozen=True, slots=True)
class MachineFit:
    """A machine fitted to a healthy record.

    Attributes
    ----------
    scene : Scene
        Scene with the fitted values.
    channel : str
        Channel of the machine that the record is compared with.
    values : dict
        Fitted value by key, in the unit of the key.
    intervals : dict
        95 % interval by key. It is the whole range of `vary` where the record does not determine the value.
    determined : dict
        Whether the interval is narrower than the range on both sides.
    frequency, measured, fitted, noise : ndarray, shape (n,)
        Lines [Hz], their amplitudes in the record and in the machine, and the standard deviation of the first.
    misfit : float
        Root mean square of (measured - fitted) / noise per degree of freedom. Above 1 the model does not explain the record.
    left_out : float
        Beginning of the given record that is not used, because its lines differ from those of its second half [s]. `record` is
        the rest.
    """

    scene: Scene
    record: Signal
    channel: str
    values: dict[str, float]
    intervals: dict[str, tuple[float, float]]
    determined: dict[str, bool]
    frequency: Floats
    measured: Floats
    fitted: Floats
    noise: Floats
    misfit: float
    left_out: float = 0.0

    def __repr__(self) -> str:
        rows = [[key, value, *self.intervals[key], "yes" if self.determined[key] else "no"] for key, value in self.values.items()]
        number = "{:.4g}"
        table = Table(["key", *(Column(name, "", number) for name in ("value", "from", "to")), "determined"], rows)
        return f"{table.markdown()}\n\n{self.summary}"

    @property
    def summary(self) -> str:
        """Quality of the fit in sentences."""
        start = (
            f"The first {self.left_out:.3g} s are left out, because their lines differ from later ones. " if self.left_out else ""
        )
        return start + (
            f"The lines of machine and record differ by {100 * self.error:.1f} % (rms), {self.misfit:.2g} times the noise. "
            f"Intervals of 95 %{', widened by that factor' if self.misfit > 1 else ''}; "
            "'no' marks values that the record does not determine."
        )

    @property
    def error(self) -> float:
        """Root mean square difference between the lines of machine and record, relative to the record."""
        return float(np.linalg.norm(self.fitted - self.measured) / np.linalg.norm(self.measured))

    def with_fault(self, case: str) -> tuple[Signal, dict[str, Any]]:
        """Return the record with the change by a simulated fault, and its labels.

        Healthy and damaged machine are simulated with the fitted values. Their difference is added to the record at its mesh
        phase. The angular position of the damaged tooth is that of the machine at time 0.

        Parameters
        ----------
        case : str
            Case of damage of the scene.

        Returns
        -------
        Signal
            Of length and rate of the record.
        dict
            ``faults`` (list of gear, tooth, damage in words, frequency [Hz]), and ``error``: the part by which healthy lines of
            machine and record differ. The change by the fault is at least as uncertain.

        Raises
        ------
        ValueError
            If the scene has no such case.
        """
        healthy, faulty = (build_machine(self.scene, one) for one in (None, case))
        shift, rate, modes = self._shift(healthy), self.record.rate, _modes(self.values)
        runs = (recorded(one, self.record.duration, rate, start=shift) for one in (healthy, faulty))
        before, after = (_through(one.signal(self.channel), modes).values[: self.record.values.size] for one in runs)
        signal = replace(self.record, values=self.record.values + after - before, name=f"{self.record.name}, {case}")
        return signal, {"faults": [_label(one) for one in faulty.faults], "error": self.error}

    def _shift(self, machine):
        """Return the time shift [s] with which the lines of the machine have the phases of the record."""
        ours = machine_lines(machine, self.channel, self.frequency) * gain_of_modes(self.frequency, _modes(self.values))
        theirs = line_amplitudes(self.record, self.frequency)
        times = np.linspace(0, 1 / self.frequency[0], 20 * self.frequency.size + 1)[:-1]
        match = np.exp(2j * math.pi * np.outer(times, self.frequency)) @ (ours * theirs.conj())
        return float(times[np.argmax(match.real)])


def fit_machine(
    scene: Any, record: Signal, vary: Mapping[str, tuple[float, float]], *, channel: str, harmonics: int = 8, seed: int = 0
) -> MachineFit:
    """Fit values of a scene's machine to a healthy record at constant speed.

    The amplitudes of the mesh lines are compared. Least squares weigh each line by the noise of the record around it.
    Starting points are refined until the noise explains the differences, at most half of them.
    Intervals follow from the linearised model at the solution. They include other solutions and starting points that explain the
    record as well. If lines differ by more than their noise, intervals are widened.
    A beginning whose lines differ from those of the second half, such as a start from rest, is left out.

    Parameters
    ----------
    scene : str or path
        Scene with a machine; it must have the speed and the load of the record.
    record : Signal
        Of the healthy machine.
    vary : dict
        Lowest and highest value by key of the scene, such as ``"shaft.idler.bearings_N_per_um": (20, 500)``; in lists all entries
        have the value. A transfer path of one mode has the keys ``"path.frequency_Hz"``, ``"path.damping_ratio"`` and
        ``"path.mass_kg"``; without them the record is the channel itself. Positive values are fitted by their logarithm.
    channel : str
        Channel of the machine, a force if there is a path: ``"spring bearing idler2 x"``.
    harmonics : int
        Of each mesh frequency, as far as 0.4 of the rate of the record.
    seed : int
        Of the starting points.

    Returns
    -------
    MachineFit

    Raises
    ------
    ValueError
        If a range or key is invalid, the record has another speed or still changes in its middle, or has fewer lines than there
        are keys.
    """
    low, high = _ranges(vary)
    file, tables = read_tables(scene)
    logs = low > 0

    def changed(x: Floats) -> tuple[Scene, dict[str, float]]:
        values = dict(zip(vary, np.where(logs, np.exp(np.where(logs, x, 0.0)), x).tolist(), strict=True))
        return scene_of(file, set_values(tables, _entries(tables, values))), values

    ends = np.where(logs, np.log(np.where(logs, low, 1.0)), low), np.where(logs, np.log(np.where(logs, high, 1.0)), high)
    middle, whole = build_machine(changed((ends[0] + ends[1]) / 2)[0]), record
    record = steady_part(whole, resolved_lines(middle, whole, harmonics))
    frequency = resolved_lines(middle, record, harmonics)
    if frequency.size < low.size:
        raise ValueError(
            f"{low.size} keys vary, but the record has only {frequency.size} mesh lines below {BAND:g} of its sampling rate: "
            "vary "
            "fewer keys, or give a record of a higher rate"
        )
    measured, noise = np.abs(line_amplitudes(record, frequency)), noise_amplitudes(record, frequency)

    def lines(x: Floats) -> Floats:
        fitted, values = changed(x)
        return np.abs(machine_lines(build_machine(fitted), channel, frequency) * gain_of_modes(frequency, _modes(values)))

    def residuals(x: Floats) -> Floats:  # Noise increases the mean of a measured amplitude, so the residuals include it.
        return (measured - np.hypot(lines(x), noise)) / noise

    from scipy.optimize import least_squares
    from scipy.stats import qmc

    starts = qmc.Halton(low.size, seed=seed).random(STARTS * low.size) * (ends[1] - ends[0]) + ends[0]
    costs = np.array([float(np.sum(residuals(x) ** 2)) / 2 for x in starts])
    steps = {"diff_step": 1e-3, "x_scale": ends[1] - ends[0], "xtol": 1e-4, "ftol": 1e-6}
    refined, free = [], frequency.size - low.size
    for x in starts[np.argsort(costs)[: len(starts) // 2]]:
        refined.append(least_squares(residuals, x, bounds=ends, **steps))
        found = min(refined, key=lambda one: one.cost)
        if len(refined) > 1 and 2 * found.cost <= free:  # The noise explains the rest. A larger rest may be a local minimum.
            break
    misfit = math.sqrt(2 * found.cost / free) if free else 1.0
    fitted, values = changed(found.x)
    alike = found.cost + chdtri(low.size, 0.05) / 2 * max(misfit, 1.0) ** 2  # points of no larger cost explain the record too
    near = [(one.x, _reach(one.jac, max(misfit, 1.0), free, ends[1] - ends[0])) for one in refined if one.cost <= alike]
    hull = np.array([*starts[costs <= alike], *(x - reach for x, reach in near), *(x + reach for x, reach in near)])
    bounds = [np.where(logs, np.exp(np.where(logs, end, 0.0)), end) for end in (hull.min(axis=0), hull.max(axis=0))]
    inside = (bounds[0] > low) & (bounds[1] < high)
    intervals = zip(np.maximum(bounds[0], low).tolist(), np.minimum(bounds[1], high).tolist(), strict=True)
    return MachineFit(
        fitted, record, channel, values, dict(zip(vary, intervals, strict=True)),
        dict(zip(vary, inside.tolist(), strict=True)), frequency, measured, lines(found.x), noise, misfit,
        whole.duration - record.duration,
    )  # fmt: skip


def _ranges(vary):
    if not isinstance(vary, Mapping) or not vary:
        raise ValueError(f"vary = {vary!r}, but give the lowest and the highest value by key of the scene")
    for key, ends in vary.items():
        numbers = isinstance(ends, (tuple, list)) and len(ends) == 2 and all(isinstance(one, (int, float)) for one in ends)
        if not (numbers and -math.inf < ends[0] < ends[1] < math.inf):
            raise ValueError(f"vary: {key} = {ends!r}, but give a lowest and a larger highest value")
    there = [key for key in vary if key.startswith("path.")]
    if there and set(there) != set(PATH):
        raise ValueError(f"vary: {', '.join(there)}, but a transfer path needs {', '.join(PATH)}")
    return np.array(list(vary.values()), dtype=float).T


def _entries(tables, values):
    """Return the fitted numbers by key. Each entry of a list is a separate number."""
    out = {}
    for dotted, value in values.items():
        if dotted in PATH:
            continue
        key, home = find_key(dotted, tables), tables
        if not (key.type in LISTS and dotted.endswith(f".{key.name}")):
            out[dotted] = value
            continue
        for part in dotted.split("."):
            home = home.get(part, ())
        out |= {f"{dotted}.{i}": value for i in range(len(home))}
    return out


def _modes(values):
    """Return the modes of the transfer path, one or none."""
    return [tuple(values[key] for key in PATH)] if PATH[0] in values else []


def _through(signal, modes):
    if not modes:
        return signal
    lines = np.fft.rfftfreq(signal.values.size, 1 / signal.rate)
    return through_frf(signal, lines, gain_of_modes(lines, modes))


def _reach(jacobian, scale, free, whole):
    """Return the half-widths of 95 % confidence intervals. An undetermined parameter has its whole range as interval."""
    _, sizes, ways = np.linalg.svd(jacobian * whole, full_matrices=False)
    spread = 1 / np.maximum(sizes, 1e-12)
    quantile = float(stdtrit(free, 0.975)) if scale > 1 and free else 1.96
    return quantile * scale * whole * np.sqrt(np.sum((ways.T * spread) ** 2, axis=1))


def _label(fault: Fault):
    return {"gear": fault.gear, "tooth": fault.tooth, "damage": fault.what, "frequency_Hz": fault.frequency}

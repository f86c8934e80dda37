"""Analysis of the simulated responses of a machine, healthy and damaged, and indicators of its gears."""

import math
import warnings

import numpy as np

from ..core.table import Column, Table
from ..signal.gear_indicators import gear_indicators
from ..signal.orders import synchronous_average
from ..signal.series import Signal
from .simulated import RANGE, fault_lines
from .vibration import analyse

ROUNDING = 1e-9  # Motions below this part of the largest motion are rounding errors.
OF_GEARS = ("FM4", "NA4", "energy ratio")  # indicators by gear, of `gearfe.signal.gear_indicators`
NONE = {"FM4": math.nan, "NA4": math.nan}


def analysis(found, channel=None):
    """`Analysis` of a channel of `responses`, by default the force of the first mesh of the driven stage.

    The lines are those of gears with deviating teeth. The stage is that of the first such gear. The case ``"healthy"`` alone,
    with equal teeth, has no such lines.
    """
    first, faults = next(iter(found.values())), list(found.values())[-1].machine.faults
    gears, main = {one.gear: one for one in reversed(faults)}, faults[0] if faults else None
    stage, several, turning, _ = fault_lines(list(found.values())[-1].machine)
    channel = channel or f"force {_mesh_of(first.machine, stage).name}"
    rate = 1 / (first.time[1] - first.time[0])
    signals = {
        case: Signal(np.asarray(one[channel], dtype=float), rate, one.unit(channel), name=case) for case, one in found.items()
    }
    _check_moving(list(found.values())[-1], channel)
    options = {"carrier": stage.carrier, "channel": channel}
    if main is not None:
        others = {name: one.frequency for name, one in gears.items() if abs(one.frequency / main.frequency - 1) > 1e-9}
        return analyse(signals, stage.mesh, several, turning=turning, others=others, **options)
    if set(found) == {"healthy"}:
        return analyse(signals, stage.mesh, **options)
    return analyse(signals, stage.mesh, stage.fault, turning=stage.turning, **options)


def _check_moving(response, channel):
    """Raise ValueError if the motion of a degree of freedom consists of rounding errors only."""
    head, _, tail = channel.partition(" ")
    dofs = response.machine.dofs
    if head not in dofs:
        return
    alike = [i for i, name in enumerate(dofs) if response.unit(name) == response.unit(head)]
    moved = {"": response.q, "velocity": response.v}[tail] if tail != "acceleration" else response.accelerations()
    sizes = moved.std(axis=0)
    own, largest = sizes[dofs.index(head)], sizes[alike].max()
    if own < ROUNDING * largest:
        unit = response.unit(channel)
        raise ValueError(
            f"channel = {channel!r} has an rms of {own:.2g} {unit}, which is rounding error: other channels of this kind have up "
            f"to {largest:.2g} {unit}; give a channel that moves"
        )


def _mesh_of(machine, stage):
    """Return the mesh with the name of a stage, or else the first mesh with the frequency of the stage."""
    alike = [one for one in machine.meshes if abs(abs(one.frequency) - stage.mesh) < 1e-6 * stage.mesh]
    return next((one for one in alike if one.name == stage.name), alike[0])


def gears_table(found):
    """`Table` of indicators of the gears of parallel stages by case of `responses`, or None for a single stage.

    They are those of the synchronous average of the mesh force. Records of fewer than two revolutions have none. FM4 and NA4 are
    nan where the energy ratio is below `RANGE`: such a difference signal is the error of the integration.
    """
    machine, rows = next(iter(found.values())).machine, []
    for stage in reversed(machine.stages) if len(machine.stages) > 1 else ():
        mesh = _mesh_of(machine, stage)
        for z, (gear, turning) in zip(mesh.teeth, stage.returns.items(), strict=False) if stage.carrier is None else ():
            signals = [one.signal(f"force {mesh.name}", turning) for one in found.values()]
            if min(signal.duration for signal in signals) * turning >= 2:
                of_cases = [_of_average(signal, z) for signal in signals]
                rows.append([gear, mesh.name, *(of_case[name] for name in OF_GEARS for of_case in of_cases)])
    columns = [f"{name}, {case}" for name in OF_GEARS for case in found]
    return Table(["gear", "force of mesh", *(Column(name, "", "{:.4g}") for name in columns)], rows) if rows else None


def _of_average(signal, z):
    """Return the indicators of the synchronous average of a gear's signal, without those of integration errors alone."""
    with warnings.catch_warnings():  # The teeth are known, and a missing tooth can exceed all mesh lines.
        warnings.filterwarnings("ignore", "the average has no line at")
        found = gear_indicators(synchronous_average(signal)[0], z)
    return found if found["energy ratio"] >= RANGE else found | NONE

"""One condition of a data set: simulation, sensor signals, and windows with their labels."""

import math
from dataclasses import replace
from typing import Any

import numpy as np

from ...comparison.settled import recorded
from ...comparison.simulated import channel_unit
from ...core.threads import own_warnings
from ...dynamics.machine.of_scene import build_machine, flat_machine
from ...dynamics.machine.sensor import Sensor
from ...dynamics.machine.tables import Machine
from ...dynamics.motion.response import Response
from ...dynamics.motion.step_control import default_step
from ...signal.series import decimate
from ...stiffness.solve import Solve
from ..store.shards import ShardColumn, arrow, fields, schema_of
from .conditions import Condition
from .faults import CASE, FAULTS
from .plan import Plan

EDGE = 64  # samples simulated before and after the windows, for the filter of `decimate`


def columns_of(plan: Plan) -> dict[str, ShardColumn]:
    """Return the columns of the windows except the signal, with the random inputs by key."""
    return fields("windows") | dict.fromkeys(plan.scatter, ShardColumn("number"))


def samples_of(plan: Plan) -> int:
    """Return the number of samples of a window."""
    return round(plan.window["seconds"] * plan.window["rate_Hz"])


def simulated(plan: Plan, condition: Condition) -> tuple[Machine, Response, int]:
    """Return machine and response of a condition, and the number of response samples per window sample."""
    fault = None if condition.fault is None else plan.fault[condition.fault]
    scene = plan.scene_at(condition.values, fault, condition.severity)
    case = CASE if fault is not None and FAULTS[fault["kind"]].damage else None
    machine, _ = heard(plan, build_machine(scene, case, phases=plan.phases, method=plan.curves))
    rate = plan.window["rate_Hz"]
    finer = max(1, math.ceil(1 / (default_step(machine) * rate)))
    count = samples_of(plan) * plan.window["count"] + 2 * EDGE
    # revolutions of the slowest gear
    start = condition.start * max(mesh.teeth[0] / abs(mesh.frequency) for mesh in machine.meshes)
    return machine, recorded(machine, count / rate, rate * finer, start=start), finer


def heard(plan: Plan, machine: Machine) -> tuple[Machine, list[str]]:
    """Return the machine with the sensors on its housing, and the channel of the response of each sensor."""
    sensors, channels = {}, []
    for row in plan.sensor:
        if row["housing"] is not None:
            sensors[f"housing {row['name']}"] = Sensor(housing=row["housing"], angle=math.radians(row["angle_deg"]))
        channels.append(row["channel"] if row["housing"] is None else f"sensor housing {row['name']}")
    return replace(machine, sensors=machine.sensors | sensors), channels


def losses(machine: Machine) -> tuple[float, float]:
    """Return maximum and mean relative stiffness loss over the engagement of the damaged tooth, for the worst mesh."""
    worst = (0.0, 0.0)
    for mesh in machine.meshes:
        for _, _, change in mesh.changes:
            # The adjacent teeth mesh symmetrically before and after.
            phase = np.linspace(-0.25, change.start + change.end + 0.25, 1001)
            loss = -change(phase) / mesh.cycle(phase % 1.0)
            worst = max(worst, (float(loss.max()), float(loss.mean())))
    return worst


def rows_of(plan: Plan, condition: Condition) -> list[dict[str, Any]]:
    """Return all windows of a condition with signal and labels."""
    with own_warnings() as caught:
        machine, response, finer = simulated(plan, condition)
    same = _labels(plan, condition, machine, response)
    same["notes"] = "; ".join(dict.fromkeys(str(warning.message) for warning in caught)) or None
    count, size = plan.window["count"], samples_of(plan)
    first = float(response.time[0]) + EDGE / plan.window["rate_Hz"]
    out = []
    for place, (sensor, channel) in enumerate(zip(plan.sensor, heard(plan, machine)[1], strict=True)):
        fine = response.signal(channel)
        signal = decimate(fine, fine.rate / finer).values[EDGE : EDGE + count * size]
        for level, noise in enumerate(sensor["noise"]):
            rng = np.random.default_rng([plan.seed, condition.number, place, level])
            values = (signal + noise * rng.standard_normal(signal.size)).astype(np.float32).reshape(count, size)
            labels = {"sensor": sensor["name"], "unit": fine.unit, "rms": float(np.std(signal)), "noise": noise}
            labels["snr_dB"] = 20 * math.log10(labels["rms"] / noise) if noise and labels["rms"] else None
            for i, window in enumerate(values):
                at = {"window": i, "start_s": first + i * size / plan.window["rate_Hz"], "signal": window}
                out.append(same | labels | at)
    return out


def _labels(plan, condition, machine, response):
    """Return the labels that all windows of a condition share."""
    fault = None if condition.fault is None else plan.fault[condition.fault]
    stage, frequency, turning = machine.fault_frequencies()
    tooth = next(iter(machine.faults), None)
    largest, mean = losses(machine)
    stats = response.stats
    return condition.scatter | {
        "condition": condition.number, "side": condition.side, "fault": condition.label, "seed": plan.seed,
        "gear": fault.get("gear") if fault else None, "severity": condition.severity,
        "body": tooth and tooth.gear, "tooth": tooth and tooth.tooth,
        "severity_unit": FAULTS[fault["kind"]].unit if fault else "-", "loss_max": largest, "loss_mean": mean,
        "machine": plan.scene, "speed_rpm": condition.speed, "torque_Nm": condition.torque, "mesh_Hz": stage.mesh,
        "turning_Hz": turning, "fault_Hz": frequency, "carrier_Hz": stage.carrier,
        "rate_Hz": plan.window["rate_Hz"], "error": stats.get("error"), "free": stats["free"],
    }  # fmt: skip


def table_of(plan: Plan, rows: list[dict[str, Any]]) -> Any:
    """Return the windows of `rows_of` as a pyarrow table: labels, then the signal as a list of `samples_of` float32 numbers."""
    pa, labels = arrow(), columns_of(plan)
    form = schema_of(labels)
    out = pa.Table.from_arrays([pa.array([row.get(name) for row in rows], form.field(name).type) for name in labels], schema=form)
    flat = pa.array(np.concatenate([row["signal"] for row in rows]))
    signal = pa.FixedSizeListArray.from_arrays(flat, samples_of(plan))
    return out.append_column(pa.field("signal", signal.type, metadata={"kind": "signal", "unit": "see unit"}), signal)


def slowest_fault(plan: Plan, values: dict[str, float]) -> float:
    """Return the lowest engagement frequency of a faulty tooth [Hz] at the `values` of speed and torque."""
    stage = flat_machine(plan.scene_at(values)).stages[-1]
    out = [stage.fault or stage.turning]
    for fault in plan.fault:
        if FAULTS[fault["kind"]].damage:
            scene = plan.scene_at(values, fault, fault["severity"][0])
            out += [tooth.frequency for tooth in flat_machine(scene, CASE).faults]
    return min(out)


def check_machine(plan: Plan) -> dict[str, str]:
    """Return the unit of each sensor. Reject unknown sensors and methods, and rates and windows that do not resolve a fault.

    Raises
    ------
    ValueError
        With the frequencies.
    """
    speeds, torques = plan.operation["speed_rpm"], plan.operation["torque_Nm"]
    values = {"machine.speed_rpm": max(speeds), "machine.torque_Nm": max(torques)}
    scene, how = plan.scene_at(values), Solve(plan.curves, plan.phases)
    for pair in scene.pairs.values():
        how.chosen(pair.case())[0].refuses(pair.case(), how)
    machine, channels = heard(plan, flat_machine(scene))
    stage, window, spread = machine.stages[-1], plan.window, plan.operation["spread"]
    top = stage.mesh * (1 + spread)
    if window["harmonics"] * top > window["rate_Hz"] / 2:
        raise ValueError(
            f"[window] rate_Hz = {window['rate_Hz']:g}, but {window['harmonics']} harmonics of the mesh at {max(speeds):g} rpm "
            f"reach {window['harmonics'] * top:.4g} Hz: give {2 * window['harmonics'] * top:.4g} or more, or fewer harmonics"
        )
    slow = slowest_fault(plan, values) * min(speeds) / max(speeds) * (1 - spread)
    if window["seconds"] * slow < 1:
        raise ValueError(
            f"[window] seconds = {window['seconds']:g}, but at {min(speeds):g} rpm a faulty tooth meshes every {1 / slow:.4g} s, "
            f"so that a window of a damaged machine may not contain the damage: give {1 / slow:.3g} s or more"
        )
    if samples_of(plan) < 16:
        raise ValueError(f"a window of {samples_of(plan)} samples: give a longer one")
    units = {}
    for i, (sensor, channel) in enumerate(zip(plan.sensor, channels, strict=True)):
        try:
            units[sensor["name"]] = channel_unit(machine, channel)
        except ValueError as error:
            raise ValueError(f"[sensor {i + 1}] {sensor['name']}: {error}") from error
    return units

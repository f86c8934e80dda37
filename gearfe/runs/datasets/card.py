"""Data card of a data set: contents, generation, split, estimated errors and neglected effects."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ...core.table import Column, Table
from ...scene.schema import schema_of
from ..store.shards import columns
from .conditions import Condition
from .faults import FAULTS, HEALTHY
from .plan import SIDES, Plan
from .windows import samples_of

if TYPE_CHECKING:
    from .opened import Dataset

SILENT = 1e-4  # a healthy machine below this part of a fault's level counts as silent
FILTERED = """\
filter: simulated at a whole multiple of this rate, as fine as the machine asks for, then brought down by a linear-phase filter
  without delay, half of the amplitude at {half:g} Hz, 53 dB less from 1.16 times that on; where the rate itself is as fine, one
  that leaves nothing above half of it. Noise is added after it"""
ERRORS = """\
The loss is that of the mesh stiffness while the damaged tooth is in contact; errors of the machine take none. The error of the
motion is that of the integration, relative to its range; that of the stiffness (`gearfe stiffness --error`) comes on top, and
what the model leaves out, below."""
READING = """\
```python
import gearfe as gf

made = gf.open_dataset(".")
signals, labels = made.windows({"side": "train"})
```

or without gearfe `pandas.read_parquet("windows")`."""
LIMITS = """\
- Simulated, not measured: a classifier trained on it has shown nothing about a real gearbox until it was tried on one.
- Speed and torque are constant within a condition; masses, bearings, supports and damping are those of the scene and its model.
- The mesh stiffness is that of held bores and perfect flanks under a constant load; flanks do not lose contact.
- Noise is white and Gaussian, of a stated size; there is no housing but that of the sensor's model, and no other machine nearby.
- One damaged tooth in a machine. Severities are the labels; the loss of stiffness beside them is what the vibration feels.
"""


def card(made: "Dataset", plan: Plan, every: Sequence[Condition]) -> str:
    """Text of ``card.md``, in Markdown."""
    labels = made.labels() if len(made) else None
    parts = [f"# {plan.title}", _what(plan, every), "## Windows by class and side", _classes(labels)]
    parts += ["## Split", _split(plan)]
    parts += ["## Error and loss", _errors(labels), "## Levels", _levels(labels)]
    parts += ["## What it does not model", LIMITS, "## Columns", _columns(plan)]
    parts += ["## Reading it", READING, _failed(made, every), _made(made)]
    return "\n\n".join(part.strip() for part in parts if part) + "\n"


def _what(plan, every):
    window, operation = plan.window, plan.operation
    severity = {kind: schema_of("gearfe.runs")[f"{kind}_fault"].keys["severity"].text for kind in FAULTS}
    speeds, torques, spread = (operation[key] for key in ("speed_rpm", "torque_Nm", "spread"))
    lines = [
        f"{len(every)} conditions, simulated by gearfe on the machine of the scene `{plan.scene}`, each cut into",
        f"{window['count']} windows of {window['seconds']:g} s, {samples_of(plan)} samples at {window['rate_Hz']:g} Hz.",
        "",
        *(f"- fault `{f['kind']}` at {_listed(f['severity'])}: {severity[f['kind']]}" for f in plan.fault),
        f"- speeds {_listed(speeds)} rpm, torques {_listed(torques)} N m, both by a part of {spread:g} more or less",
        *(
            f"- sensor `{s['name']}`: {s['channel'] or 'housing, ' + s['housing']}; noise {_listed(s['noise'])} rms"
            for s in plan.sensor
        ),
        *(f"- differs from machine to machine: `{key}` {spec}" for key, spec in plan.scatter.items()),
        f"- {FILTERED.format(half=window['rate_Hz'] / 2)}",
        f"- seed {plan.seed}; stiffness curves by `{plan.curves}`, the same method for healthy and faulty machines",
    ]
    return "\n".join(lines)


def _listed(values):
    return ", ".join(f"{value:g}" for value in values)


def _classes(labels):
    if labels is None:
        return "None yet."

    def counts(part):
        return [*(int((part["side"] == side).sum()) for side in SIDES), int(part["condition"].nunique())]

    return _by_class(labels, [Column(name, form="{}") for name in (*SIDES, "conditions")], counts)


def _by_class(labels, head, cells):
    """Table with a row for each class: the `cells` of its part of the labels."""
    classes = labels.groupby(["fault", "severity"])
    rows = [[fault, None if fault == HEALTHY else severity, *cells(part)] for (fault, severity), part in classes]
    return Table(("fault", Column("severity", form="{:g}"), *head), rows).markdown()


def _split(plan):
    shares = ", ".join(f"{side} {plan.split[side]:g}" for side in SIDES)
    if plan.split["by"] == "operation":
        return f"{shares}. By operation: no two sides share a combination of speed and torque, and none a condition."
    return (
        f"{shares}. By condition: all windows of one simulated machine, with all sensors and noise, lie on one side. Sides share "
        "combinations of speed and torque; a classifier should be tested with another machine at a known operation."
    )


def _errors(labels):
    if labels is None:
        return ""

    def cells(part):
        return [100 * part["loss_max"].mean(), 100 * part["loss_mean"].mean(), 100 * part["error"].max()]

    head = [Column(name, "%", "{:.2f}") for name in ("largest loss of stiffness", "mean loss")]
    return f"{_by_class(labels, [*head, Column('error of the motion, worst', '%', '{:.2g}')], cells)}\n\n{ERRORS}"


def _levels(labels):
    """Return the table of levels by class and sensor, with a note if a healthy machine is silent because all teeth are equal."""
    if labels is None:
        return ""
    sensors = list(dict.fromkeys(labels["sensor"]))
    level = labels.groupby(["fault", "severity", "sensor"])["rms"].median()
    classes = list(dict.fromkeys(level.index.droplevel("sensor")))
    units = labels.groupby("sensor")["unit"].first()

    def cells(part):
        return [part.loc[part["sensor"] == sensor, "rms"].median() for sensor in sensors]

    table = _by_class(labels, [Column(sensor, units[sensor], "{:.3g}") for sensor in sensors], cells)
    silent = [
        channel
        for channel in sensors
        if any(level[HEALTHY, 0.0, channel] < SILENT * level[(*label, channel)] for label in classes)
    ]
    out = f"Median rms before noise, without the mean.\n\n{table}"
    if silent:
        out += f"\n\n**Of the healthy machine {', '.join(silent)} hears nothing**: it is perfectly equal all round, so that any "
        out += "fault is detected by its presence. Let `[scatter]` make machines differ, for instance in `machine.runout_um`."
    return out


def _columns(plan):
    rows = [[f"`{name}`", field.unit, text] for name, (field, text) in columns("windows").items()]
    rows += [[f"`{key}`", "as in the scene", ""] for key in plan.scatter]
    rows.append(["`signal`", "see `unit`", f"{samples_of(plan)} numbers of 4 bytes"])
    return Table(("column", "unit", "meaning"), rows).markdown()


def _failed(made, every):
    lost = made.failed()
    if not lost:
        return ""
    listed = "\n".join(f"- {name}: {error}" for name, error in list(lost.items())[:5])
    return f"## Conditions that could not be simulated\n\n{len(lost)} of {len(every)}:\n\n{listed}"


def _made(made):
    return "Made by " + ", ".join(f"{name} {value}" for name, value in made.about["made"].items()) + "."

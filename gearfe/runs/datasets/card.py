"""Data card of a data set: contents, generation, split, estimated errors and neglected effects."""

from collections.abc import Sequence
from importlib import resources
from typing import TYPE_CHECKING

import numpy as np

from ...core.table import Column, Table
from ...scene.schema import schema_of
from ..store.shards import columns
from .conditions import Condition
from .faults import FAULTS, HEALTHY
from .plan import SIDES, Plan
from .windows import samples_of

if TYPE_CHECKING:
    from .opened import Dataset

SILENT = 1e-4  # A healthy machine counts as silent below this part of a fault's level.


def card(made: "Dataset", plan: Plan, every: Sequence[Condition]) -> str:
    """Return the text of ``card.md`` of a data set (Markdown), from the template of that name."""
    import jinja2

    maker = jinja2.Environment(trim_blocks=True, keep_trailing_newline=True)
    maker.filters["listed"] = lambda values: ", ".join(f"{value:g}" for value in np.atleast_1d(values))
    template = maker.from_string(resources.files(__package__).joinpath("card.md").read_text(encoding="utf-8"))
    severity = {kind: schema_of("gearfe.runs")[f"{kind}_fault"].keys["severity"].text for kind in FAULTS}
    return template.render(
        plan=plan, every=every, samples=samples_of(plan), sides=SIDES, severity=severity, columns=_columns(plan),
        failed=made.failed(), made=made.about["made"], **(_tables(made.labels()) if len(made) else {}),
    )  # fmt: skip


def _tables(labels):
    """Return the tables of windows, errors and levels by class, and the sensors for which the healthy machine is silent."""
    sensors = list(dict.fromkeys(labels["sensor"]))
    units = labels.groupby("sensor")["unit"].first()

    def counts(part):
        return [*(int((part["side"] == side).sum()) for side in SIDES), int(part["condition"].nunique())]

    def errors(part):
        return [100 * part["loss_max"].mean(), 100 * part["loss_mean"].mean(), 100 * part["error"].max()]

    def levels(part):
        return [part.loc[part["sensor"] == sensor, "rms"].median() for sensor in sensors]

    losses = [Column(name, "%", "{:.2f}") for name in ("largest loss of stiffness", "mean loss")]
    return {
        "classes": _by_class(labels, [Column(name, form="{}") for name in (*SIDES, "conditions")], counts),
        "errors": _by_class(labels, [*losses, Column("error of the motion, worst", "%", "{:.2g}")], errors),
        "levels": _by_class(labels, [Column(sensor, units[sensor], "{:.3g}") for sensor in sensors], levels),
        "silent": [sensor for sensor in sensors if _silent(labels[labels["sensor"] == sensor])],
    }


def _silent(labels):
    """Return whether the healthy machine is silent at a sensor, because all its teeth are equal."""
    level = labels.groupby(["fault", "severity"])["rms"].median()
    return level[HEALTHY, 0.0] < SILENT * level.max()


def _by_class(labels, head, cells):
    """Return a table with a row per class. `cells` returns the cells from the labels of the class."""
    classes = labels.fillna({"gear": ""}).groupby(["fault", "gear", "severity"])
    rows = [[fault, gear, None if fault == HEALTHY else severity, *cells(part)] for (fault, gear, severity), part in classes]
    return Table(("fault", "gear", Column("severity", form="{:g}"), *head), rows).markdown()


def _columns(plan):
    rows = [[f"`{name}`", field.unit, text] for name, (field, text) in columns("windows").items()]
    rows += [[f"`{key}`", "as in the scene", ""] for key in plan.scatter]
    rows.append(["`signal`", "see `unit`", f"{samples_of(plan)} numbers of 4 bytes"])
    return Table(("column", "unit", "meaning"), rows).markdown()

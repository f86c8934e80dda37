"""`dataset`: generate or resume a data set in a folder; `plan_dataset`: estimate its cost."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from ...geometry.aliases import StrPath
from ...stiffness.disk import program
from ..cost import Cost, estimated
from ..runner import Tally, check_workers, results
from ..store.folder import begin, check_same, durable, locked
from ..store.shards import arrow, encoded, unfinished, write_shard
from .card import card
from .conditions import Condition, conditions
from .opened import FAILED, FORMAT, SHAPE, WINDOWS, Dataset, open_dataset
from .plan import Plan, read_plan
from .windows import check_machine, rows_of, table_of

EXPORTS = ("mat", "hdf5")


def dataset(
    plan: StrPath | Mapping[str, Any],
    folder: StrPath,
    *,
    also: Sequence[str] = (),
    workers: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Dataset:
    """Generate a labelled vibration data set. An interrupted data set is resumed by the same call.

    Every condition (a fault, a severity, a speed, a torque, random parameters of the machine) is simulated once. The signals of
    all sensors with all levels of noise are cut into windows and written as one Parquet file in ``windows/``. A file is complete
    or absent. ``card.md`` describes the data set.

    Parameters
    ----------
    plan : str or path or dict
        A TOML file, or a dictionary of the same structure: see `gearfe.runs.datasets.plan`.
    folder : str or path
        New, empty, or of the same plan.
    also : sequence of {"mat", "hdf5"}
        Write every side of the split as one file of these formats too (``train.mat``, ``train.h5`` ...), at the end.
    workers : int, optional
        Number of processes, one thread each; default one per core. 1: in this process.
    progress : callable, optional
        Called with (finished conditions, number of conditions).

    Raises
    ------
    ValueError
        If the plan is invalid: an unknown fault type, a severity outside its bounds, a rate too low for the mesh harmonics, a
        window too short for the fault, or too few conditions for the split. Also if the folder contains anything else, was begun
        by another version, or cannot be written.
    RuntimeError
        If pyarrow is missing, or a condition ended its process twice. Finished conditions stay, and the same call resumes.
    """
    check_workers(workers)
    unknown = [export for export in also if export not in EXPORTS]
    if unknown or isinstance(also, str):
        raise ValueError(f"also = {also!r}, but it lists {' and '.join(EXPORTS)}")
    arrow()
    checked = read_plan(plan)
    every = conditions(checked)
    about = _about(checked, len(every), check_machine(checked))
    stored = begin(folder, about, SHAPE)
    place = Path(folder)
    with locked(place):
        check_same(place, stored, about, "plan")
        (place / WINDOWS).mkdir(exist_ok=True)
        with locked(place / WINDOWS):
            _fill(place, checked, every, workers, progress)
        made = open_dataset(folder)
        durable(place / "card.md", card(made, checked, every).encode())
        for form in also:
            made.export(form)
    return made


def _about(plan, count, units):
    """Return the note of a folder of windows."""
    return {
        "format": FORMAT,
        "title": plan.title,
        "conditions": count,
        "plan": plan.content(),
        "units": units,
        "made": program(),
    }


def _fill(place, plan, every, workers, progress):
    """Simulate the conditions that are not yet in the folder."""
    failed = [condition.stem for condition in (place / FAILED).glob("condition-*.txt")]
    left = unfinished(place / WINDOWS, [condition.name for condition in every], "data set", failed)
    tally = Tally("conditions", len(every), progress)
    tally.add(len(every) - len(left))
    todo = [condition for condition in every if condition.name in left]
    for _, result in results(partial(simulate_condition, plan), todo, workers):
        if result is None:
            raise RuntimeError(
                "a process was killed or ran out of memory, also with its condition alone. Finished conditions are kept: "
                "call the function again, with fewer workers if memory was short"
            )
        name, content, error = result
        if error:
            (place / FAILED).mkdir(exist_ok=True)
            durable(place / FAILED / f"{name}.txt", error.encode())
        else:
            write_shard(place / WINDOWS, name, content)
        tally.add(1)


def simulate_condition(plan: Plan, condition: Condition) -> tuple[str, bytes, str]:
    """Return name and encoded windows of a condition, or the error that prevents them."""
    try:
        table = table_of(plan, rows_of(plan, condition))
    except (ValueError, RuntimeError) as error:
        return condition.name, b"", f"{type(error).__name__}: {error}"
    return condition.name, encoded(table), ""


def plan_dataset(plan: StrPath | Mapping[str, Any], folder: StrPath = ".", workers: int | None = None) -> Cost:
    """Estimate the cost of a data set without writing anything. Its last condition is simulated.

    ValueError if the plan is invalid, like `gearfe.dataset`.
    """
    check_workers(workers)
    checked = read_plan(plan)
    every = conditions(checked)
    check_machine(checked)
    made = rows_of(checked, every[-1])  # This first run loads modules, compiled loops and gears.

    def trial():
        return encoded(table_of(checked, rows_of(checked, every[-1]))), 1, []

    text = f"{len(every)} conditions, {len(every) * len(made)} windows"
    return estimated(text, len(every), len(every), trial, folder, workers)

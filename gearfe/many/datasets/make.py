"""`dataset`: all conditions of a data set into a folder, going on where it was stopped."""

import json
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, wait
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path
from typing import Any

from ...steps import reached
from ...stiffness.cache import program
from ...studies.batches import check_workers, processes
from ..store.folder import begin, durable, locked
from ..store.shards import arrow, check_shards, encoded, shard_names, write_shard
from .card import card
from .conditions import Condition, conditions
from .opened import FAILED, FORMAT, WINDOWS, Dataset, open_dataset
from .plan import Plan, read_plan
from .windows import check_machine, rows_of, table_of

AHEAD = 2  # conditions handed out for each process
EXPORTS = ("mat", "hdf5")


def dataset(
    plan: str | os.PathLike[str] | Mapping[str, Any],
    folder: str | os.PathLike[str],
    *,
    also: Sequence[str] = (),
    workers: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Dataset:
    """Make a data set of labelled vibration windows; called again after it was stopped, it goes on where it was.

    Every condition (a fault, a severity, a speed, a torque, a machine of its own scatter) is simulated once, heard by all sensors
    with all levels of noise, cut into windows and written as one Parquet file in ``windows/``, which is whole or not there.
    ``card.md`` describes the whole.

    Parameters
    ----------
    plan : str or path or dict
        A TOML file, or a dictionary of the same structure: see `gearfe.many.datasets.plan`.
    folder : str or path
        New, empty, or of the same plan.
    also : sequence of {"mat", "hdf5"}
        Write every side of the split as one file of these formats too (``train.mat``, ``train.h5`` ...), at the end.
    workers : int, optional
        Processes of this machine, one thread each; default one per core. 1: in this process.
    progress : callable, optional
        Called with (conditions done, conditions in all).

    Returns
    -------
    Dataset
        As of `gearfe.open_dataset`.

    Raises
    ------
    ValueError
        If the plan cannot be: an unknown kind of fault, a severity outside its bounds, a rate too low for the mesh harmonics, a
        window too short to hold the fault, too few conditions for the split...; or the folder holds anything else, was begun by
        another version, or cannot be written.
    RuntimeError
        If pyarrow is missing, or a process ended before its condition was done: what is finished stays, call it again.
    """
    check_workers(workers)
    unknown = [one for one in also if one not in EXPORTS]
    if unknown or isinstance(also, str):
        raise ValueError(f"also = {also!r}, but it lists {' and '.join(EXPORTS)}")
    arrow()
    checked = read_plan(plan)
    every = conditions(checked)
    told = check_machine(checked)
    about = _about(checked, len(every), told)
    stored = begin(folder, about)
    place = Path(folder)
    with locked(place):
        _compare(place, stored, about)
        for name in (WINDOWS, FAILED):
            (place / name).mkdir(exist_ok=True)
        with locked(place / WINDOWS):
            _fill(place, checked, every, workers or os.cpu_count() or 1, progress)
        made = open_dataset(folder)
        with durable(place / "card.md") as file:
            file.write(card(made, checked, every).encode())
        for form in also:
            made.export(form)
    return made


def _about(plan, count, told):
    """Note of a folder of windows."""
    return {
        "format": FORMAT,
        "title": plan.title,
        "conditions": count,
        "plan": plan.content(),
        "units": told["units"],
        "made": program(),
    }


def _compare(folder, stored, about):
    """Refuse to mix two data sets, or two versions, in one folder."""
    mine, there = (json.loads(json.dumps(one)) for one in (about, stored))
    changed = [name for name in mine["plan"] if mine["plan"][name] != there["plan"].get(name)]
    if changed:
        raise ValueError(
            f"{folder} holds another data set: its {', '.join(changed)} differ; give a new folder, or the plan as it was "
            f"({folder}/about.json has all of it)"
        )
    versions = [
        f"{name} = {there['made'].get(name)}, not {value}"
        for name, value in mine["made"].items()
        if there["made"].get(name) != value
    ]
    if versions:
        raise ValueError(
            f"{folder} was begun by another program, with {'; '.join(versions)}: finish it with that, or give a new folder"
        )


def _fill(place, plan, every, workers, progress):
    """Simulate the conditions that are not there yet."""
    check_shards(place / WINDOWS)
    there = set(shard_names(place / WINDOWS)) | {one.stem for one in (place / FAILED).glob("condition-*.txt")}
    unknown = there - {one.name for one in every}
    if unknown:
        raise ValueError(f"{place / WINDOWS} holds {min(unknown)}, which is none of this data set's: take it out")
    todo = [one for one in every if one.name not in there]
    done = len(every) - len(todo)
    _say(done, len(every), progress)
    for name, content, error in _made(plan, todo, min(workers, max(1, len(todo)))):
        if error:
            with durable(place / FAILED / f"{name}.txt") as file:
                file.write(error.encode())
        else:
            write_shard(place / WINDOWS, name, content)
        done += 1
        _say(done, len(every), progress)


def _say(done, total, progress):
    """Say how far it is to whoever listens."""
    reached(f"{done} of {total} conditions", done / total)
    if progress is not None:
        progress(done, total)


def _made(plan, todo, workers) -> Iterator[tuple[str, bytes, str]]:
    """What `simulate_condition` gives of each, as they end."""
    if workers == 1:
        yield from (simulate_condition(plan, one) for one in todo)
        return
    waiting = list(reversed(todo))
    running: set[Any] = set()
    try:
        with processes(workers) as pool:
            while waiting or running:
                while waiting and len(running) < AHEAD * workers:
                    running.add(pool.submit(simulate_condition, plan, waiting.pop()))
                ended, running = wait(running, return_when=FIRST_COMPLETED)
                yield from (one.result() for one in ended)
    except BrokenProcessPool as error:
        raise RuntimeError(
            "a process ended before its condition was done: killed, or out of memory; what is finished stays, so call it again, "
            "with fewer workers if memory was short"
        ) from error


def simulate_condition(plan: Plan, condition: Condition) -> tuple[str, bytes, str]:
    """Name and encoded windows of a condition, or the error why there are none."""
    try:
        made = table_of(plan, rows_of(plan, condition))
    except (ValueError, RuntimeError) as error:
        return condition.name, b"", f"{type(error).__name__}: {error}"
    return condition.name, encoded(made), ""

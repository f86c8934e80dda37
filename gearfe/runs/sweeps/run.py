"""`sweep`: compute or resume all cases of a study in a folder; `plan_sweep`: estimate its cost."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from typing import Any

from ...geometry.aliases import StrPath
from ...stiffness.disk import program
from ..cost import Cost, estimated
from ..runner import Tally, alone, check_workers, results
from ..store.folder import begin, check_same, locked
from ..store.shards import encoded, table, unfinished, write_shard
from .blocks import DONE, blocks, compute, lost, rows, shard
from .runs import FORMAT, SHAPE, Runs, open_runs
from .study import Study, read_study, slim


def _check_processes(workers, scheduler):
    check_workers(workers)
    if scheduler is not None and not scheduler.strip():
        raise ValueError(f"scheduler = {scheduler!r}, but give the address of a Dask scheduler, such as 'tcp://host:8786'")
    if workers is not None and scheduler is not None:
        raise ValueError(f"workers = {workers}, but a scheduler has its own workers: give either workers or scheduler")


def sweep(
    study: StrPath | Mapping[str, Any],
    folder: StrPath,
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    mixed: bool = False,
    progress: Callable[[int, int], object] | None = None,
) -> Runs:
    """Compute all cases of a study and store them in a folder. An interrupted sweep is resumed by the same call.

    Cases are computed in blocks of some seconds, each written as one file that is complete or absent. If a process is killed or a
    disk is full, only the blocks under way are lost. A case that fails is stored with its error message, and the other cases are
    computed.

    Parameters
    ----------
    study : str or path or dict
        A TOML file, or a dictionary of the same structure, see `gearfe.runs.sweeps.study`.
    folder : str or path
        New, empty, or of the same study.
    workers : int, optional
        Number of processes, one thread each; default one per core. 1: in this process.
    scheduler : str, optional
        Address of a Dask scheduler, ``"tcp://host:8786"``: its workers compute instead.
    mixed : bool
        Resume a folder that another version of gearfe or its libraries began; each row states its version.
    progress : callable, optional
        Called with (finished cases, number of cases).

    Raises
    ------
    ValueError
        If the study is invalid, or the folder holds another study or anything else, is damaged, cannot be written or is written
        by another process. Also if its results are of another version, or no scheduler answers. The content of the folder stays.
    RuntimeError
        If pyarrow or, for a scheduler, distributed is missing; the message names what to install.
    """
    _check_processes(workers, scheduler)
    checked = read_study(study)
    every, fields = blocks(checked)
    stored = begin(folder, _about(checked, sum(len(block.cases) for block in every)), SHAPE)
    with locked(folder):
        if stored["study"]["block"] != checked.block:  # The block size is not part of the study's definition.
            checked = replace(checked, block=stored["study"]["block"])
            every, fields = blocks(checked)
        about = _about(checked, stored["cases"])
        check_same(folder, stored, about, "study", mixed=mixed)
        left = unfinished(folder, [block.name for block in every], "study")
        todo = [block for block in every if block.name in left]
        tally = Tally("cases", stored["cases"], progress)
        tally.add(tally.total - sum(len(block.cases) for block in todo))
        small = slim(checked)
        for ended, result in results(partial(compute, small, fields), todo, workers, scheduler=scheduler):
            content, source = result or shard(fields, lost(ended) if scheduler else _case_by_case(small, ended))
            if source != about["made"]["source"]:
                raise RuntimeError(
                    f"a worker has gearfe of source {source}, this process {about['made']['source']}: install the same there"
                )
            write_shard(folder, ended.name, content)
            tally.add(len(ended.cases))
    if tally.done != tally.total:
        raise RuntimeError(
            f"{tally.total - tally.done} of {tally.total} cases were started but returned no result: start the sweep again"
        )
    return open_runs(folder)


def _case_by_case(study, block):
    """Return the rows of a block that ended its process, case by case. Cases that end a process alone are recorded as lost."""
    singles = [block.single(i) for i in range(len(block.cases))]
    return [row for single, result in alone(partial(rows, study), singles) for row in result or lost(single)]


def _about(study: Study, cases: int) -> dict[str, Any]:
    """Return the note of a folder of results."""
    return {"format": FORMAT, "title": study.title, "cases": cases, "study": study.content(), "made": program()}


def plan_sweep(study: StrPath | Mapping[str, Any], folder: StrPath = ".", *, workers: int | None = None) -> Cost:
    """Estimate the cost of a sweep without writing anything. One block from its middle is computed.

    Parameters
    ----------
    study : str or path or dict
        See `gearfe.sweep`.
    folder : str or path
        Folder in which the free space is read.
    workers : int, optional
        Processes; default one per core.

    Raises
    ------
    ValueError
        If the study is invalid.
    RuntimeError
        If pyarrow is missing.

    Examples
    --------
    >>> study = {"scene": "planetary_pitting", "vary": {"gear.sun.r_bore_mm": [6.0, 7.0]}, "options": {"method": "coupled"}}
    >>> plan_sweep(study).cases
    2
    """
    check_workers(workers)
    checked = read_study(study)
    every, fields = blocks(checked)
    small, chosen = slim(checked), every[len(every) // 2]
    rows(small, chosen.single(0))  # This first run loads modules and tables.

    def trial():
        made = rows(small, chosen)
        return encoded(table(made, fields)), len(made), [row["error"] for row in made if row["status"] != DONE]

    cases = sum(len(block.cases) for block in every)
    text = f"{cases} cases in {len(every)} block{'s' * (len(every) > 1)}"
    return estimated(text, cases, len(every), trial, folder, workers)

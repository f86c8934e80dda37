"""`sweep`: all cases of a study into a folder, going on where it was stopped."""

import math
import os
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from ...steps import reached
from ...stiffness.cache import program
from ...studies.batches import check_workers
from ..store.folder import begin, locked
from ..store.shards import check_shards, shard_names, write_shard
from .blocks import blocks, jobs
from .cluster import cluster
from .local import local
from .runs import FORMAT, Runs, open_runs
from .study import Study, read_study


def sweep(
    study: str | os.PathLike[str] | Mapping[str, Any],
    folder: str | os.PathLike[str],
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    mixed: bool = False,
    progress: Callable[[int, int], object] | None = None,
) -> Runs:
    """Compute all cases of a study into a folder; called again after it was stopped, it goes on where it was.

    Cases are computed in blocks of seconds, each written as one file that is whole or not there: a process that is killed at any
    moment, or a disk that runs full, costs the blocks under way. A case that cannot be has its error in its row, and the others
    go on.

    Parameters
    ----------
    study : str or path or dict
        A TOML file, or a dictionary of the same structure, see `gearfe.many.sweeps.study`.
    folder : str or path
        New, empty, or of the same study.
    workers : int, optional
        Processes of this machine, one thread each; default one per core. 1: in this process.
    scheduler : str, optional
        Address of a Dask scheduler, ``"tcp://host:8786"``: its workers compute instead.
    mixed : bool
        Go on although the folder was begun by another version of gearfe or of its libraries; each row says by which it was made.
    progress : callable, optional
        Called with (cases done, cases in all).

    Returns
    -------
    Runs
        As of `gearfe.open_runs`.

    Raises
    ------
    ValueError
        If the study cannot be; the folder holds another study or anything else, is damaged, cannot be written or is being written
        by another process; its results were made by another version; or no scheduler answers. What is in the folder stays.
    RuntimeError
        If pyarrow or, for a scheduler, distributed is missing; the message names what to install.
    """
    check_workers(workers)
    if scheduler is not None and not (isinstance(scheduler, str) and scheduler.strip()):
        raise ValueError(f"scheduler = {scheduler!r}, but give the address of a Dask scheduler, such as 'tcp://host:8786'")
    if workers is not None and scheduler is not None:
        raise ValueError("workers are processes of this machine, a scheduler has its own: give one of them")
    checked = read_study(study)
    every, fields = blocks(checked)
    about = _about(checked, sum(len(one.numbers) for one in every))
    stored = begin(folder, about)
    with locked(folder):
        checked = _compared(folder, stored, about, checked, mixed)
        if checked.block != about["study"]["block"]:
            every, fields = blocks(checked)
        todo = _todo(folder, every)
        total = stored["cases"]
        sizes = {one.name: len(one.numbers) for one in every}
        done = total - sum(sizes[one.name] for one in todo)
        _say(done, total, progress)
        work = jobs(checked, todo, fields)
        count = min(workers or os.cpu_count() or 1, max(1, len(todo)))
        for name, content, source in local(work, count) if scheduler is None else cluster(work, scheduler):
            if source != about["made"]["source"]:
                raise RuntimeError(
                    f"a worker has gearfe of source {source}, this process {about['made']['source']}: install the same there"
                )
            write_shard(folder, name, content)
            done += sizes[name]
            _say(done, total, progress)
    if done != total:
        raise RuntimeError(f"{total - done} of {total} cases were handed out and never came back: start the sweep again")
    return open_runs(folder)


def _say(done, total, progress):
    """How far it is."""
    reached(f"{done} of {total} cases", done / total)
    if progress is not None:
        progress(done, total)


def _about(study: Study, cases: int) -> dict[str, Any]:
    """Note of a folder of results."""
    return {"format": FORMAT, "title": study.title, "cases": cases, "study": study.content(), "made": program()}


def _compared(folder, stored, about, study, mixed):
    """The study as it is to go on, if the folder holds it; its blocks are those of the folder."""
    mine, there = about["study"], stored["study"]
    changed = list(_differences(there | {"block": 0}, mine | {"block": 0}))
    if changed:
        more = f" and {len(changed) - 1} more" if len(changed) > 1 else ""
        raise ValueError(
            f"{folder} holds another study, begun with {changed[0]}{more}: give a new folder, or the study as it was "
            f"({folder}/about.json has all of it)"
        )
    versions = list(_differences(stored["made"], about["made"]))
    if versions and not mixed:
        raise ValueError(
            f"{folder} was begun by another program, with {'; '.join(versions)}: finish it with that, give a new folder, or go "
            "on with mixed = True (--mixed): each row says which made it"
        )
    return replace(study, block=there["block"])


def _differences(there, here, path=""):
    """Texts that say which values differ."""
    if isinstance(there, dict) and isinstance(here, dict):
        for name in dict.fromkeys((*there, *here)):
            yield from _differences(there.get(name), here.get(name), f"{path}.{name}" if path else name)
    elif isinstance(there, list) and isinstance(here, list) and len(there) == len(here):
        for i, (one, other) in enumerate(zip(there, here, strict=True)):
            yield from _differences(one, other, f"{path}.{i}")
    elif there != here and not (_is_nan(there) and _is_nan(here)):
        yield f"{path} = {_short(there)}, not {_short(here)}"


def _is_nan(value):
    return isinstance(value, float) and math.isnan(value)


def _short(value):
    text = repr(value)
    return text if len(text) < 60 else f"{text[:50]}...{text[-5:]}"


def _todo(folder, every):
    """Blocks that are not in the folder yet; refuses shards that are of no block."""
    check_shards(folder)
    there, known = set(shard_names(folder)), {one.name for one in every}
    if there - known:
        raise ValueError(f"{folder} holds {min(there - known)}.parquet, which is none of this study's: take it out")
    return [one for one in every if one.name not in there]

"""`plan_sweep`: what a sweep will take, from cases of it that are computed for that."""

import os
import resource
import shutil
import sys
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..store.shards import encoded, table
from .blocks import DONE, rows
from .blocks import blocks as blocks_of
from .study import read_study, slim


@dataclass(frozen=True, slots=True)
class Plan:
    """What a sweep will take."""

    cases: int  # in all
    blocks: int  # shards they make
    seconds: float  # of processor, all cases together
    workers: int  # processes that share it
    memory: float  # of each process [bytes]: the largest of this one so far
    disk: float  # the whole folder [bytes]
    free: float  # there [bytes]
    tried: int  # cases that were computed for this
    failed: int  # of these
    error: str  # of the first that cannot be; empty if there is none

    def text(self) -> str:
        """Lines for people."""
        out = [
            f"{self.cases} cases in {self.blocks} block{'s' if self.blocks > 1 else ''}",
            f"time: about {_time(self.seconds)} of processor, {_time(self.seconds / self.workers)} with {self.workers} processes",
            f"memory: about {self.memory / 1e6:.0f} MB in each process",
            f"disk: about {_size(self.disk)}, {_size(self.free)} are free",
            f"from {self.tried} cases computed now, {self.failed} of them failed",
        ]
        return "\n".join([*out, *([f"the first that failed: {self.error}"] if self.error else [])])


def plan_sweep(
    study: str | os.PathLike[str] | Mapping[str, Any], folder: str | os.PathLike[str] = ".", *, workers: int | None = None
) -> Plan:
    """Say what a sweep will take, without writing anything: one block from the middle of it is computed.

    Parameters
    ----------
    study : str or path or dict
        As of `gearfe.sweep`.
    folder : str or path
        Where it would be written: how much is free there.
    workers : int, optional
        Processes; default one per core.

    Raises
    ------
    ValueError
        If the study cannot be.
    RuntimeError
        If pyarrow is missing.

    Examples
    --------
    >>> study = {"scene": "planetary_pitting", "vary": {"gear.sun.r_bore_mm": [6.0, 7.0]}, "options": {"method": "coupled"}}
    >>> plan_sweep(study).cases
    2
    """
    checked = read_study(study)
    every, fields = blocks_of(checked)
    checked = slim(checked)
    chosen = every[len(every) // 2]
    rows(checked, chosen.single(0))  # imports and tables that are made once
    started = time.process_time()
    computed = rows(checked, chosen)
    tried = len(computed)
    content = encoded(table(computed, fields))
    per_case = (time.process_time() - started) / tried
    cases = sum(len(one.cases) for one in every)
    wrong = [row["error"] for row in computed if row["status"] != DONE]
    unit = 1 if sys.platform == "darwin" else 1024
    place = Path(folder).absolute()
    existing = next(one for one in (place, *place.parents) if one.exists())
    return Plan(
        cases, len(every), per_case * cases, workers or os.cpu_count() or 1,
        float(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit), len(content) / tried * cases,
        float(shutil.disk_usage(existing).free), tried, len(wrong), wrong[0] if wrong else "",
    )  # fmt: skip


def _time(seconds):
    if seconds < 120:
        return f"{seconds:.3g} s"
    return f"{seconds / 60:.3g} min" if seconds < 7200 else f"{seconds / 3600:.3g} h"


def _size(size):
    return f"{size / 1e6:.3g} MB" if size < 1e9 else f"{size / 1e9:.3g} GB"

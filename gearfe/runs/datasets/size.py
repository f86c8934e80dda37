"""`size_of`: what a data set will take, from one condition of it that is simulated for that."""

import os
import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ..store.shards import encoded
from .conditions import conditions
from .plan import read_plan
from .windows import check_machine, rows_of, table_of


@dataclass(frozen=True, slots=True)
class Size:
    """Conditions and windows of a data set, processor time [s] and disk [bytes] of all of it."""

    conditions: int
    windows: int
    seconds: float
    disk: float

    def text(self, workers: int | None = None) -> str:
        """Lines for people."""
        count = workers or os.cpu_count() or 1
        return (
            f"{self.conditions} conditions, {self.windows} windows\n"
            f"time: about {self.seconds:.3g} s of processor, {self.seconds / count:.3g} s with {count} processes\n"
            f"disk: about {self.disk / 1e6:.3g} MB\nfrom one condition simulated now"
        )


def size_of(plan: str | os.PathLike[str] | Mapping[str, Any]) -> Size:
    """Say what a data set will take, without writing anything: its last condition is simulated.

    ValueError if the plan cannot be, as `gearfe.dataset`.
    """
    checked = read_plan(plan)
    every = conditions(checked)
    check_machine(checked)
    rows_of(checked, every[-1])  # imports, compiled loops and gears that are made once
    started = time.process_time()
    rows = rows_of(checked, every[-1])
    size = len(encoded(table_of(checked, rows)))
    return Size(len(every), len(every) * len(rows), len(every) * (time.process_time() - started), float(len(every) * size))

"""Expected cost of a sweep or a data set, from computed sample cases."""

import os
import resource
import shutil
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from ..core.time_limit import VARIABLE, hours_allowed


@dataclass(frozen=True, slots=True)
class Cost:
    """Expected cost of a sweep or a data set."""

    text_of_cases: str
    cases: int  # number of cases
    blocks: int  # number of files
    seconds: float  # CPU time of all cases
    workers: int  # number of processes
    memory: float  # memory of each process [bytes]: the peak of this one so far
    disk: float  # size of the whole folder [bytes]
    free: float  # free disk space [bytes]
    tried: int  # number of sample cases
    failed: int  # number of failed sample cases
    error: str  # first error of a sample case; empty if there is none

    def text(self) -> str:
        """Return the cost as lines of text."""
        out = [
            self.text_of_cases,
            f"time: about {_time(self.seconds)} of processor, {_time(self.seconds / self.workers)} with {self.workers} processes",
            f"memory: about {self.memory / 1e6:.0f} MB in each process",
            f"disk: about {_size(self.disk)}, {_size(self.free)} are free",
            f"from {self.tried} case{'s' * (self.tried > 1)} computed now, {self.failed} of them failed",
        ]
        if self.seconds / self.workers > 3600 * (limit := hours_allowed()):
            out.append(f"limit: {limit:g} h of elapsed time; the environment variable {VARIABLE} raises it")
        return "\n".join([*out, *([f"the first that failed: {self.error}"] if self.error else [])])


def estimated(
    text: str, cases: int, blocks: int, trial: Callable[[], tuple[bytes, int, list[str]]], folder: object, workers: int | None
) -> Cost:
    """Estimate the `Cost` of `cases`. ``trial`` computes some of them, and returns file, number and errors.

    `folder` is the output folder.
    """
    started = time.process_time()
    content, tried, wrong = trial()
    seconds = (time.process_time() - started) / tried * cases
    unit = 1 if sys.platform == "darwin" else 1024
    memory = float(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit)
    place = Path(str(folder)).absolute()
    free = shutil.disk_usage(next(one for one in (place, *place.parents) if one.exists())).free
    disk = len(content) / tried * cases
    processes = workers or os.cpu_count() or 1
    return Cost(text, cases, blocks, seconds, processes, memory, disk, float(free), tried, len(wrong), next(iter(wrong), ""))


def _time(seconds):
    if seconds < 120:
        return f"{seconds:.3g} s"
    return f"{seconds / 60:.3g} min" if seconds < 7200 else f"{seconds / 3600:.3g} h"


def _size(size):
    return f"{size / 1e6:.3g} MB" if size < 1e9 else f"{size / 1e9:.3g} GB"

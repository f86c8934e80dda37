"""Many cases in parallel processes, each timed. The result of a failed case is its error."""

import multiprocessing
import pickle
import sys
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

from ..core.case import Case
from ..stiffness.mesh_stiffness import mesh_stiffness
from .runner import Tally, check_workers, count_of, results


@dataclass(frozen=True, slots=True)
class Batch:
    """Results of `batch`, in the order of its cases.

    `results` holds the results of the function, or the ValueError or RuntimeError that it raised. `seconds` are the times of the
    cases, `elapsed` is the total time with `workers` processes.
    """

    results: list[Any]
    seconds: list[float]
    elapsed: float
    workers: int


def batch(
    cases: Iterable[Case | Mapping[str, Any]],
    *,
    work: Callable[..., Any] | None = None,
    workers: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Batch:
    """Run a function for many cases in parallel processes.

    Parameters
    ----------
    cases : iterable of Case or dict
        First argument of `work`, or its keyword arguments.
    work : callable, optional
        Default `mesh_stiffness`; for several processes a function that can be imported by name.
    workers : int, optional
        Processes, one thread each; default one per core. 1: in this process. A plain script needs no guard, unless `work` or
        something in the cases is defined in it: then it needs the usual ``if __name__ == "__main__":``.
    progress : callable, optional
        Called with (cases done, cases in all).

    Raises
    ------
    ValueError
        If `workers` is not a whole number from 1 on, or `work` cannot be handed to other processes.
    RuntimeError
        If a process ended with a case, also when it was tried again alone.

    Examples
    --------
    >>> batch([{"x": 2.0}, {"x": -1.0}], work=float.fromhex, workers=0)
    Traceback (most recent call last):
    ...
    ValueError: workers = 0, but it must be a whole number from 1 on
    """
    check_workers(workers)
    work = work or mesh_stiffness
    every = list(cases)
    if not every:
        raise ValueError("cases: give a list of at least one Case or dict")
    if getattr(multiprocessing.current_process(), "_inheriting", False):
        sys.exit(1)  # A worker imported an unguarded script, and the parent process prints the remedy.
    workers = count_of(workers, every)
    of_script = workers > 1 and _of_script(work, every)
    started, tally = time.perf_counter(), Tally("cases", len(every), progress)
    size = max(1, min(16, len(every) // (4 * workers))) if workers > 1 else 1
    parts = [range(start, min(start + size, len(every))) for start in range(0, len(every), size)]
    jobs = [(part, every[part.start : part.stop]) for part in parts]
    rows: list[Any] = [None] * len(every)
    for (part, _), outcomes in results(partial(_timed, work), jobs, workers, own=of_script):
        if outcomes is None:
            guard = 'work or cases are defined in this script: write the call under if __name__ == "__main__":; or '
            reason = "a worker process ended before its cases were done: killed, or out of memory"
            raise RuntimeError(f"{guard if of_script else ''}{reason}")
        for i, row in zip(part, outcomes, strict=True):
            rows[i] = row
            tally.add(1)
    return Batch([row[0] for row in rows], [row[1] for row in rows], time.perf_counter() - started, workers)


def _of_script(work, cases):
    """Return True if workers need definitions from the caller's script.

    Raises ValueError if the work is not serialisable.
    """
    try:
        return any(b"__main__" in pickle.dumps((work, case)) for case in cases)
    except (AttributeError, TypeError, pickle.PicklingError) as error:
        raise ValueError(f"{error}: processes need functions that can be imported by name; or use workers = 1") from error


def _timed(work, job):
    """Return result (or error) and seconds of each case of a job."""
    out = []
    for case in job[1]:
        started = time.perf_counter()
        try:
            result = work(case) if isinstance(case, Case) else work(**case)
        except (ValueError, RuntimeError) as error:
            result = error
        out.append((result, time.perf_counter() - started))
    return out

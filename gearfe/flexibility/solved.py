"""Cache of solved gears in this process.

Every method stores its solutions (bodies, sectors, tables of corner contact) in a `SolvedGears`. With ``cache=True`` it is that
of this process. With ``cache=False`` it is an empty one for one call: nothing solved before is used, and nothing is stored or
displaced.
"""

import os
import threading
import time
from collections import OrderedDict
from collections.abc import Callable, Collection, Hashable
from dataclasses import dataclass, field, fields, is_dataclass, replace
from typing import Any

import numpy as np

from ..core.checks import truth

GEARS = ("section", "solid", "energy")  # first part of the keys of solved gears that are stored on disk
MOST = 512 * 2**20  # memory of the results kept [bytes]


@dataclass(frozen=True, slots=True)
class _Solve:
    """A solution in progress: number of its thread, its result, and whether it has ended."""

    thread: int
    found: list = field(default_factory=list)
    ended: threading.Event = field(default_factory=threading.Event)


class SolvedGears:
    """Cache of results by their inputs, limited in memory. The least recently used results are removed first.

    Threads may share it. Of those that ask for the same at the same time one solves, the others wait and get the same object; if
    it fails nothing is kept, its error is its own, and the next of them tries. A solve may ask for other results, but not for
    its own: nobody then waits for one who waits for him.

    Parameters
    ----------
    most : int
        Memory of all results together [bytes]; the last one stays however large it is.
    """

    def __init__(self, most: int = MOST) -> None:
        self.most = most
        self._kept: OrderedDict[Any, tuple[Any, int]] = OrderedDict()
        self._solving: dict[Hashable, _Solve] = {}
        self._lock = threading.Lock()
        self.size = 0  # memory of the kept results [bytes]

    def get(self, key: Hashable, solve: Callable[[], object]) -> Any:
        """Return the stored result of `key`. If it is missing, compute it by `solve` and store it.

        Raises
        ------
        RuntimeError
            If `solve` requests `key` itself, and any error of `solve`.
        """
        while True:
            with self._lock:
                if key in self._kept:
                    self._kept.move_to_end(key)
                    return self._kept[key][0]
                other = self._solving.get(key)
                if other is None:
                    started = self._solving[key] = _Solve(threading.get_ident())
                    break
            if other.thread == threading.get_ident():
                raise RuntimeError(f"the solve of {key!r} requires its own result (circular request)")
            other.ended.wait()
            if other.found:
                return other.found[0]
        try:
            started.found.append(solve())
            self._keep(key, started.found[0])
            return started.found[0]
        finally:
            with self._lock:
                self._solving.pop(key, None)
            started.ended.set()

    def _keep(self, key, found):
        size = memory(found)
        with self._lock:
            self._kept[key] = found, size
            self.size += size
            while self.size > self.most and len(self._kept) > 1:
                self.size -= self._kept.popitem(last=False)[1][1]

    def of(self, kinds: Collection[str]) -> "SolvedGears":
        """Return the stored results whose keys begin with one of `kinds`, as a separate cache."""
        out = SolvedGears(self.most)
        with self._lock:
            out._kept.update((key, one) for key, one in self._kept.items() if key[0] in kinds)
        out.size = sum(size for _, size in out._kept.values())
        return out

    def __contains__(self, key: Hashable) -> bool:
        """Return whether a result is stored."""
        with self._lock:
            return key in self._kept

    def __len__(self) -> int:
        """Return the number of stored results."""
        return len(self._kept)

    def clear(self) -> None:
        """Remove all stored results."""
        with self._lock:
            self._kept.clear()
            self.size = 0

    def begin_anew(self) -> None:
        """Remove unfinished solves in a forked child process, whose computing threads do not exist there."""
        self._lock, self._solving = threading.Lock(), {}


PROCESS = SolvedGears()
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=PROCESS.begin_anew)


def solved_gears(cache: "bool | SolvedGears") -> SolvedGears:
    """Return the cache to use: that of this process for True, an empty one for False, and a `SolvedGears` unchanged."""
    if isinstance(cache, SolvedGears):
        return cache
    return PROCESS if truth("cache", cache) else SolvedGears()


def timed(solve: Callable[[], Any], healthy: Any = None) -> Any:
    """Return the flexibility computed by `solve` with its `seconds`, which include those of the required `healthy` gear."""
    started = time.perf_counter()
    found = solve()
    return replace(found, seconds=time.perf_counter() - started + (healthy.seconds if healthy else 0.0))


def memory(value) -> int:
    """Return the memory of all nested arrays of a result [bytes]. Repeated arrays are counted repeatedly."""
    if isinstance(value, np.ndarray):
        return value.nbytes
    if isinstance(value, dict):
        return sum(memory(part) for part in value.values())
    if isinstance(value, (tuple, list)):
        return sum(memory(part) for part in value)
    if is_dataclass(value):
        return sum(memory(getattr(value, field.name)) for field in fields(value))
    return 0

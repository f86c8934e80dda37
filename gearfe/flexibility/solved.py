"""Gears solved before, kept in this process: the one place where results that took a solve are looked up.

Every method keeps what it solved for (bodies, sectors, tables of corner contact) in a `SolvedGears`. With ``cache=True`` that is
the one of this process, with ``cache=False`` an empty one that lasts as long as the call: nothing solved before is used, and
nothing is stored or displaced.
"""

import threading
from collections import OrderedDict
from collections.abc import Callable, Hashable
from dataclasses import fields, is_dataclass

import numpy as np
from scipy.interpolate import BivariateSpline, PPoly

MOST = 512 * 2**20  # memory of the results kept [bytes]


class SolvedGears:
    """Results by what was asked for, bounded in memory: those not asked for the longest go first.

    Threads may share it. Two that ask for the same at the same time may both solve; they get the same object.

    Parameters
    ----------
    most : int
        Memory of all results together [bytes]; the last one stays however large it is.
    """

    def __init__(self, most: int = MOST):
        self.most = most
        self._kept: OrderedDict = OrderedDict()
        self._lock = threading.Lock()
        self.size = 0  # of what is kept [bytes]

    def get(self, key: Hashable, solve: Callable[[], object]):
        """What is kept under `key`, or else what `solve` gives."""
        with self._lock:
            if key in self._kept:
                self._kept.move_to_end(key)
                return self._kept[key][0]
        found = solve()
        size = memory(found)
        with self._lock:
            if key in self._kept:  # another thread was quicker
                return self._kept[key][0]
            self._kept[key] = found, size
            self.size += size
            while self.size > self.most and len(self._kept) > 1:
                self.size -= self._kept.popitem(last=False)[1][1]
        return found

    def __len__(self):
        """Number of results kept."""
        return len(self._kept)

    def clear(self):
        """Forget all of them."""
        with self._lock:
            self._kept.clear()
            self.size = 0


PROCESS = SolvedGears()


def solved_gears(cache: "bool | SolvedGears") -> SolvedGears:
    """Where to look and to keep: True the results of this process, False none so far; a `SolvedGears` is itself."""
    if isinstance(cache, SolvedGears):
        return cache
    return PROCESS if cache else SolvedGears()


def memory(value) -> int:
    """Memory of a result [bytes]: the arrays in it, however deep; what is in it twice counts twice."""
    if isinstance(value, np.ndarray):
        return value.nbytes
    if isinstance(value, PPoly):
        return value.x.nbytes + value.c.nbytes
    if isinstance(value, BivariateSpline):
        return sum(part.nbytes for part in (*value.get_knots(), value.get_coeffs()))
    if isinstance(value, dict):
        return sum(memory(part) for part in value.values())
    if isinstance(value, (tuple, list)):
        return sum(memory(part) for part in value)
    if is_dataclass(value):
        return sum(memory(getattr(value, field.name)) for field in fields(value))
    return 0

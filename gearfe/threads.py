"""Threads of the linear algebra: one inside of gearfe, unless the user has chosen their number.

Most matrices here are so small that several threads mostly wait for each other; on a busy machine that takes many times as long.
"""

import contextlib
import functools
import os
import threading
from collections.abc import Callable, Iterator
from typing import Any, ParamSpec, TypeVar

P = ParamSpec("P")
R = TypeVar("R")
CHOSEN = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "BLIS_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")
LARGE = "fe3d"  # the one method whose matrices are large: more threads make it faster

_limiting = threading.Lock()


@functools.cache
def _libraries() -> Any:
    """The linear algebra of numpy and scipy, looked for once: that takes some milliseconds."""
    import scipy.linalg  # noqa: F401 - loads what is to be found
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController().select(user_api="blas")


@contextlib.contextmanager
def one_thread() -> Iterator[None]:
    """In the block the linear algebra has one thread; if a variable of `CHOSEN` is set, as many as that says.

    The limit is the process's: of calls that overlap in several threads only the first one sets it and takes it back, or the
    numbers of before would be lost. The others may run on after it with more threads, which costs time and nothing else.
    """
    if any(map(os.environ.get, CHOSEN)) or not _limiting.acquire(blocking=False):
        yield
        return
    try:
        with _libraries().limit(limits=1):
            yield
    finally:
        _limiting.release()


def single(function: Callable[P, R]) -> Callable[P, R]:
    """The function with `one_thread` around it, unless its ``method`` is `LARGE`."""

    @functools.wraps(function)
    def limited(*args: P.args, **kwargs: P.kwargs) -> R:
        with contextlib.nullcontext() if kwargs.get("method") == LARGE else one_thread():
            return function(*args, **kwargs)

    return limited

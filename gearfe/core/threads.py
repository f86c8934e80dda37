"""Settings of the whole process, shared by all threads: number of threads of linear algebra, and warnings.

Linear algebra uses one thread inside gearfe, unless the user has set the number. Most matrices are so small that several threads
mainly wait for each other, which is many times slower on a busy computer.
"""

import contextlib
import functools
import os
import threading
import warnings
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from typing import Any, ParamSpec, TypeVar

P = ParamSpec("P")
R = TypeVar("R")
CHOSEN = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "BLIS_NUM_THREADS", "VECLIB_MAXIMUM_THREADS")

# Python locks each module during its import. If two threads import parts of one package at the same time, an import can
# fail with a deadlock error.
loading = threading.RLock()


class Shared:
    """Process-wide setting shared by blocks of several threads. The first block sets it, and the last one restores it.

    A thread that leaves its block does not affect threads in other blocks. The former state is restored after the last one, in
    any order.

    Parameters
    ----------
    made : callable
        Without arguments; returns the context manager that makes the change.
    """

    def __init__(self, made: Callable[[], AbstractContextManager[Any]]) -> None:
        self._made, self._turn, self._inside = made, threading.Lock(), 0
        self._opened: AbstractContextManager[Any] = contextlib.nullcontext()

    def __enter__(self) -> None:
        with self._turn:
            if not self._inside:
                opened = self._made()
                opened.__enter__()
                self._opened = opened
            self._inside += 1

    def __exit__(self, *error: object) -> None:
        with self._turn:
            self._inside -= 1
            if not self._inside:
                self._opened.__exit__(None, None, None)


@functools.cache
def _libraries() -> Any:
    """Return the linear algebra libraries of numpy and scipy. They are searched only once."""
    with loading:
        import scipy.linalg  # noqa: F401 - loads what is to be found
        from threadpoolctl import ThreadpoolController

    return ThreadpoolController().select(user_api="blas")


_limited = Shared(lambda: _libraries().limit(limits=1))


@contextlib.contextmanager
def one_thread() -> Iterator[None]:
    """Use one thread for linear algebra in the block, or the number in an environment variable of `CHOSEN`.

    The limit holds for the whole process until the last overlapping block of any thread has ended.
    """
    if any(os.environ.get(name) not in (None, "", "1") for name in CHOSEN):
        yield
        return
    with _limited:
        yield


_turn = threading.RLock()


@contextlib.contextmanager
def in_turn() -> Iterator[None]:
    """Run the block while no other thread runs such a block.

    Short solutions mostly hold Python's interpreter lock. Threads that pass this lock to each other many times per millisecond
    need more processor time than threads that wait for the whole solution.
    """
    with _turn:
        yield


def _new_turn():
    """Replace the lock in a forked child process, which does not contain the thread that holds it."""
    global _turn
    _turn = threading.RLock()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_new_turn)


def single(function: Callable[P, R]) -> Callable[P, R]:
    """Return the function wrapped in `one_thread`."""

    @functools.wraps(function)
    def limited(*args: P.args, **kwargs: P.kwargs) -> R:
        with one_thread():
            return function(*args, **kwargs)

    return limited


class _Lists(threading.local):
    """Lists that collect warnings of this thread, from the outermost to the innermost block, each with a kind of warning."""

    def __init__(self) -> None:
        self.open: list[tuple[type[Warning], list[Any]]] = []


_lists = _Lists()


@contextlib.contextmanager
def _dealt() -> Iterator[None]:
    """Direct every shown warning in the block to the list of its thread, if that thread has one for its kind."""
    with warnings.catch_warnings():
        before = warnings.showwarning

        def show(message, category, filename, lineno, file=None, line=None):
            for kind, caught in reversed(_lists.open):
                if issubclass(category, kind):
                    caught.append(warnings.WarningMessage(message, category, filename, lineno, file, line))
                    return
            before(message, category, filename, lineno, file, line)

        warnings.showwarning = show
        yield


_dealing = Shared(_dealt)


@contextlib.contextmanager
def own_warnings(kind: type[Warning] = UserWarning) -> Iterator[list[Any]]:
    """Collect warnings of a kind from this thread in the given list within the block. They are not shown.

    ``warnings.catch_warnings(record=True)`` is unsuitable for several threads. The list would contain warnings of other threads,
    and changed filters could remain.
    """
    caught: list[Any] = []
    with _dealing:
        warnings.simplefilter("always", kind)
        _lists.open.append((kind, caught))
        try:
            yield caught
        finally:
            _lists.open.pop()

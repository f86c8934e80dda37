"""Pools of new single-thread processes. They end with this process and do not run the caller's script again."""

import contextlib
import multiprocessing
import multiprocessing.connection
import os
import sys
import threading
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor

from ..core.threads import Shared

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


@contextlib.contextmanager
def processes(workers: int, *, own: bool = False) -> Iterator[ProcessPoolExecutor]:
    """Return a pool of new single-thread processes, which always end with this process.

    With `own`, workers need definitions of the caller's script and run it again.
    """
    spawn = multiprocessing.get_context("spawn")
    with (
        _told_one,
        contextlib.nullcontext() if own else _hidden,
        ProcessPoolExecutor(workers, mp_context=spawn, initializer=_end_with_parent) as pool,
    ):
        before = set(multiprocessing.active_children())
        try:
            yield pool
        except (KeyboardInterrupt, SystemExit):  # Running tasks would delay the end.
            for worker in set(multiprocessing.active_children()) - before:
                worker.terminate()
            raise


@contextlib.contextmanager
def _one_in_environment():
    """Limit processes started here to one thread by environment variables, which libraries read on start."""
    before = {name: os.environ.get(name) for name in THREADS}
    os.environ.update(dict.fromkeys(THREADS, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            os.environ.pop(name, None) if value is None else os.environ.update({name: value})


def _end_with_parent():
    """End this process when its parent is gone, because a killed parent sends no signal to its workers."""
    parent = multiprocessing.parent_process()

    def watch():
        if parent is not None:
            multiprocessing.connection.wait([parent.sentinel])
            os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


@contextlib.contextmanager
def _without_main():
    """Prevent workers started here from running the caller's script: they find no main module to import."""
    main = sys.modules["__main__"]
    hidden = {name: getattr(main, name) for name in ("__file__", "__spec__") if getattr(main, name, None) is not None}
    for name in hidden:
        setattr(main, name, None)
    try:
        yield
    finally:
        for name, value in hidden.items():
            setattr(main, name, value)


_told_one, _hidden = Shared(_one_in_environment), Shared(_without_main)  # Pools of several threads may overlap.

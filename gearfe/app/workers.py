"""Solver processes, each with one task at a time. A new task of a page replaces its waiting tasks. Dead processes are restarted.

Each page and each of its buttons has a lane. A new task of a lane replaces the task of that lane that still waits. Tasks that
take seconds never use all processes, so that sliders of other users still work.
"""

import asyncio
import contextlib
import json
import multiprocessing
import threading
import time
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Any

SLOW = {
    "solid": 8.0,
    "stress": 8.0,
    "spectrum": 6.0,
    "report": 40.0,
    "csv": 2.0,
}  # initial duration estimates of slow tasks [s]
LIMIT = {"report": 300.0, "solid": 120.0, "stress": 120.0, "spectrum": 120.0}  # time limits of slow tasks [s]
QUICK_LIMIT = 20.0  # limit of all other tasks [s]
MEMORY = 4 * 2**30  # memory limit of one process [bytes]
MOST = 64  # largest number of waiting tasks
STALE = {"stale": True}
START = 40.0  # time limit for the start of a process [s]


def _work(pipe: Connection, memory: int) -> None:
    """Run a solver process: answer one task after another until its pipe is closed."""
    import signal

    signal.signal(signal.SIGINT, signal.SIG_IGN)  # The server, not the terminal, ends this process.
    with contextlib.suppress(ImportError, ValueError, OSError):  # Windows has no such limit, and the system's limit may be lower.
        import resource

        resource.setrlimit(resource.RLIMIT_DATA, (memory, memory))
    from .solving import answer, begin

    begin()
    with contextlib.suppress(EOFError, BrokenPipeError):
        pipe.send(b"ready")
        while True:
            pipe.send(answer(*pipe.recv()))


class Worker:
    """Solver process with its pipe. `ended` is the reason why the process ended, empty while it runs."""

    def __init__(self, context: Any, memory: int):
        self.pipe, other = context.Pipe()
        self.process = context.Process(target=_work, args=(other, memory), daemon=True, name="gearfe solver")
        # The start takes about a second, while the page loads.
        self.starting = threading.Thread(target=self._start, args=(other,), daemon=True)
        self.starting.start()
        self.ready, self.ended = False, ""

    def _start(self, other: Connection) -> None:
        self.process.start()
        other.close()

    def ask(self, kind: str, given: dict[str, Any]) -> bytes:
        """Send a task to the process and wait for its answer as JSON.

        The answer states if the process ended, or was killed because it was too slow.
        """
        seconds = LIMIT.get(kind, QUICK_LIMIT)
        self.starting.join()
        try:
            if not self.ready and not self.pipe.poll(START):
                seconds = START
            else:
                self.ready = self.ready or self.pipe.recv() == b"ready"
                self.pipe.send((kind, given))
                if self.pipe.poll(seconds):
                    return bytes(self.pipe.recv())
            self.ended = f"this took more than {seconds:g} s and was ended: take a smaller case, or compute it in Python"
        except (EOFError, OSError):
            self.ended = "the solver ended with this case, perhaps out of memory; a new one is started"
        return _json({"refused": self.ended})

    def kill(self) -> None:
        """Kill the process, in any state."""
        self.starting.join()
        self.process.kill()

    def end(self) -> None:
        """Kill the process and close the pipe to it."""
        self.kill()
        self.process.join()
        self.pipe.close()


@dataclass(eq=False, slots=True)
class Task:
    """Task that waits for a process, or is being solved by a process."""

    lane: str
    kind: str
    given: dict[str, Any]
    answer: "asyncio.Future[bytes]"
    worker: Worker | None = None

    @property
    def slow(self) -> bool:
        """True if the task takes seconds."""
        return self.kind in SLOW


class Pool:
    """Solver processes and waiting tasks. All its methods are called in one event loop.

    There are `count` processes, at least 2, because one is reserved for tasks that take less than a second. Each has `memory`
    [bytes]. At most `most` tasks wait. Further tasks are rejected with a message.
    """

    def __init__(self, count: int, *, memory: int = MEMORY, most: int = MOST):
        names = multiprocessing.get_all_start_methods()
        self.context: Any = multiprocessing.get_context("forkserver" if "forkserver" in names else "spawn")
        if "forkserver" in names:
            self.context.set_forkserver_preload(["gearfe.app.solving"])
        self.memory, self.most, self.count = memory, most, max(count, 2)
        self.free = [Worker(self.context, memory) for _ in range(self.count)]
        self.waiting: list[Task] = []
        self.running: set[asyncio.Task] = set()
        self.expected = dict(SLOW)
        self.slow = 0  # number of running tasks that take seconds

    async def ask(self, lane: str, kind: str, given: dict[str, Any], tell: Callable[[dict], Awaitable[object]]) -> bytes:
        """Answer to a task in JSON.

        `tell` is called twice a second with the number of tasks ahead of this one, then once with the expected seconds of a
        slow task. A cancelled task (its page was closed) leaves the queue. If it is slow and already running, its process is
        ended.
        """
        for other in [queued for queued in self.waiting if queued.lane == lane]:
            self.waiting.remove(other)
            other.answer.set_result(_json(STALE))
        if len(self.waiting) >= self.most:
            return _json({"refused": f"{len(self.waiting)} others wait for the solvers: please try again in a while"})
        task = Task(lane, kind, given, asyncio.get_running_loop().create_future())
        self.waiting.append(task)
        self._deal()
        try:
            told = False
            while not task.answer.done():
                if task.slow and task.worker and not told:
                    told = True
                    await tell({"expected": self.expected[kind]})
                await asyncio.wait([task.answer], timeout=0.5)
                if task in self.waiting:
                    await tell({"waiting": self.waiting.index(task)})
            return task.answer.result()
        finally:
            if task in self.waiting:
                self.waiting.remove(task)
            elif task.slow and task.worker and not task.answer.done():
                task.worker.kill()

    def _deal(self) -> None:
        """Assign the longest-waiting tasks to free processes. One process remains free of long tasks."""
        for task in list(self.waiting):
            if self.free and not (task.slow and self.slow >= self.count - 1):
                self.waiting.remove(task)
                self.slow += task.slow
                task.worker = self.free.pop()
                run = asyncio.ensure_future(self._run(task, task.worker))
                self.running.add(run)
                run.add_done_callback(self.running.discard)

    async def _run(self, task: Task, worker: Worker) -> None:
        started = time.perf_counter()
        reply = await asyncio.to_thread(worker.ask, task.kind, task.given)
        if not task.answer.done():
            task.answer.set_result(reply)
        if worker.ended:
            await asyncio.to_thread(worker.end)
            worker = await asyncio.to_thread(Worker, self.context, self.memory)
        elif task.slow:
            self.expected[task.kind] = time.perf_counter() - started
        self.slow -= task.slow
        self.free.append(worker)
        self._deal()

    def end(self) -> None:
        """Kill the idle processes. Working processes are daemons, which end with the server."""
        while self.free:
            self.free.pop().end()


def _json(answer: dict[str, Any]) -> bytes:
    return json.dumps(answer).encode()

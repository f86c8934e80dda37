"""Progress bar on a terminal while a verb works. In a pipe, lines at intervals replace the bar."""

import contextlib
import sys
import time

from ...core.steps import is_heard, listening
from .shell import harmless, tell

INTERVAL = 30.0  # interval between progress lines if the output is not a terminal [s]


def _log(text, interval=INTERVAL):
    """Return a progress listener that prints at most one line per `interval`: completed part, elapsed and remaining time."""
    started = last = time.monotonic()

    def step(what, done):
        nonlocal last
        now = time.monotonic()
        if now - last >= interval:
            last, gone = now, now - started
            left = f", about {gone * (1 - done) / done:.0f} s left" if done > 0 else ""
            tell(f"{what or text}: {100 * done:.0f} % after {gone:.0f} s{left}")

    return step


@contextlib.contextmanager
def working(text):
    """Show a progress bar with elapsed and remaining seconds (in a pipe: lines). Returns a function that prints a note."""
    if sys.stderr is None or not sys.stderr.isatty():
        with contextlib.nullcontext() if is_heard() else listening(_log(text)):
            yield tell
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn
    from rich.table import Column

    def wide(width):
        return Column(min_width=width, no_wrap=True)

    columns = (  # The description is truncated before the clock.
        BarColumn(bar_width=16, table_column=wide(16)),
        TimeElapsedColumn(wide(7)),
        TextColumn("gone, left", table_column=wide(10)),
        TimeRemainingColumn(table_column=wide(7)),
        TextColumn("{task.description}", markup=False, table_column=Column(no_wrap=True, overflow="ellipsis", ratio=1)),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True, expand=True, speed_estimate_period=600) as progress:
        task = progress.add_task(harmless(text), total=None)

        def step(what, done):
            progress.update(task, completed=done, total=1.0, **({"description": harmless(what)} if what else {}))

        with listening(step):
            yield lambda line: progress.console.print(harmless(f"gearfe: {line}"), markup=False, highlight=False)

"""Progress bar on a terminal while a verb works; only notes in a pipe."""

import contextlib
import sys

from ...core.steps import listening
from .shell import harmless, tell


@contextlib.contextmanager
def working(text):
    """Show a bar with elapsed and remaining seconds, on a terminal only; returns a function that prints a note."""
    if sys.stderr is None or not sys.stderr.isatty():
        yield tell
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn
    from rich.table import Column

    def wide(width):
        return Column(min_width=width, no_wrap=True)

    columns = (  # a long description is cut, never the clock
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

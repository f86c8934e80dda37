"""What is shown on a terminal while a verb works: a bar, the seconds gone and left; nothing but notes in a pipe."""

import contextlib
import sys

from ..steps import listening
from .shell import harmless, tell


@contextlib.contextmanager
def working(text):
    """A bar with the seconds gone and, once a step is done, left, on a terminal only; gives a function that prints a note."""
    if sys.stderr is None or not sys.stderr.isatty():
        yield tell
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        TimeElapsedColumn(),
        TextColumn("gone, left"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True, speed_estimate_period=600) as progress:
        task = progress.add_task(harmless(text), total=None)

        def step(what, done):
            progress.update(task, completed=done, total=1.0, **({"description": harmless(what)} if what else {}))

        with listening(step):
            yield lambda line: progress.console.print(harmless(f"gearfe: {line}"), markup=False, highlight=False)

"""What is shown on a terminal while a verb works: a bar, the seconds gone and left; nothing but notes in a pipe."""

import contextlib
import sys


class Notes:
    """Prints notes to standard error; steps are shown on a terminal only."""

    def __call__(self, line):
        """Print a line."""
        print(f"gearfe: {line}", file=sys.stderr, flush=True)

    def step(self, text, done, total):
        """Say that `done` of `total` steps are done and `text` is next."""


class Bar(Notes):
    """The same above a bar of `rich`."""

    def __init__(self, progress, task):
        self.progress, self.task = progress, task

    def __call__(self, line):
        """Print a line above the bar."""
        self.progress.console.print(f"gearfe: {line}", markup=False, highlight=False)

    def step(self, text, done, total):
        """Move the bar; the time left is reckoned from the steps done."""
        self.progress.update(self.task, description=text, completed=done, total=total)


@contextlib.contextmanager
def working(text):
    """A bar with the seconds gone and, once steps are counted, left, on a terminal only; gives a `Notes`."""
    if sys.stderr is None or not sys.stderr.isatty():
        yield Notes()
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    left = TimeRemainingColumn(elapsed_when_finished=False)
    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn(), TextColumn("gone, left"), left)
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        yield Bar(progress, progress.add_task(text, total=None))

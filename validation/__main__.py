"""``python -m validation PAGE ... | all | check``: compute validation pages, or compare cheap rows with the tables."""

import argparse
import importlib
import os
import re
import sys

from .shared import kept_rows, page
from .shared.page import MACHINES, QUESTIONS

PAGES = QUESTIONS | MACHINES


def main():
    """Compute the pages named on the command line."""
    parser = argparse.ArgumentParser(prog="python -m validation", description="Compute validation pages.")
    parser.add_argument("pages", nargs="*", choices=[*PAGES, "all", "check", []], metavar="PAGE", help="pages, all, or check")
    parser.add_argument("--list", action="store_true", help="list the pages and the CPU seconds of each")
    parser.add_argument("--text", action="store_true", help="write pages from their tables, compute nothing that is on file")
    parser.add_argument("--reference", action="store_true", help="compute the independent values of the pages first")
    arguments = parser.parse_args()
    os.environ["GEARFE_CACHE"] = ""  # Cached gears on disk may be results of other source versions.
    if arguments.list or not arguments.pages:
        print("\n".join(listed()))
    elif arguments.pages == ["check"]:
        from .check import check

        sys.exit(check())
    else:
        for name in PAGES if "all" in arguments.pages else arguments.pages:
            compute(name, again=not arguments.text, reference=arguments.reference)


def listed():
    """Return lines with the pages, their subjects, and the CPU seconds of each page and of its independent values."""
    lines, total = [], [0.0, 0.0]
    for name, question in PAGES.items():
        parts = page.read(name)[1].split(page.REFERENCES)
        seconds = [float(re.search(r"(\d+) CPU s", part)[1]) for part in parts if part]
        total = [one + two for one, two in zip(total, [*seconds, 0.0, 0.0], strict=False)]
        lines.append(f"{name:20s} {' + '.join(f'{one:.0f}' for one in seconds):>12s} CPU s  {question}")
    return [*lines, f"{'all':20s} {' + '.join(f'{one:.0f}' for one in total):>12s} CPU s  (+: independent values)"]


def compute(name, *, again=True, reference=False):
    """Compute a page, and state at its foot the version that computed it.

    Parameters
    ----------
    name : str
        One of `PAGES`.
    again : bool
        False: write the page from its tables.
    reference : bool
        Compute its independent values first.
    """
    made = importlib.import_module(f"validation.make.{'machines' if name in MACHINES else name}")
    own = (name,) if name in MACHINES else ()
    if reference and hasattr(made, "reference"):
        seconds = spent(made.reference)
        page.sign(name, seconds, reference=True)
    if again:
        seconds = spent(made.run, *own)
        page.sign(name, seconds)
        print(f"{name}: {seconds:.1f} s of CPU", flush=True)
    else:
        made.run(*own, again=False)


def spent(work, *inputs):
    """Return the CPU seconds of a computation, including rows that an earlier run of the same sources computed."""
    kept_rows.before.clear()
    started = kept_rows.cpu()
    work(*inputs)
    return kept_rows.cpu() - started + sum(kept_rows.before)


if __name__ == "__main__":
    main()

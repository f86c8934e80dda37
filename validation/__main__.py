"""``python -m validation PAGE``: rebuild a validation page; without PAGE: all of them."""

import argparse
import importlib
import os
import subprocess
import sys

from .shared import renew, slow, state
from .shared.page import QUESTIONS

PAGES = QUESTIONS | {
    "own_model": "(a file: the example of a curve exported by MATLAB)",
    "readme": "(a file: the table and the program output in the README)",
    "tutorials": "(files: what the scripts of the documentation print, for their test)",
}

PARTS = {
    "machines": ("herringbone_machine", "planetary_pitting", "helical_pitting", "compound_planetary")
}  # each a job of its own
ROWS = ("detection", "dynamics", "hard", "sample", "three")  # parts of these pages: beginnings of rows to compute anew


def main():
    """Do what is asked for."""
    parser = argparse.ArgumentParser(prog="python -m validation", description="Rebuild validation pages; see what is old.")
    parser.add_argument("page", nargs="?", choices=[*PAGES, "slow", "renew"], metavar="PAGE", help="a page, slow or renew")
    parts = "of machines: pages; of pages with rows on file: beginnings of those to compute anew; of slow: test files"
    parser.add_argument("parts", nargs="*", metavar="PART", help=parts)
    parser.add_argument("--list", action="store_true", help="name the pages, what is on them and what they take")
    parser.add_argument(
        "--stale", action="store_true", help="list what was computed by other code, and bring first lines up to date"
    )
    parser.add_argument(
        "--age", type=int, metavar="DAYS", help="with --stale: change nothing, fail if something is old for longer"
    )
    parser.add_argument("--minutes", type=float, default=60.0, help="with renew: how long (default 60)")
    parser.add_argument("--reference", action="store_true", help="compute the finite elements that are not on file (resumable)")
    arguments = parser.parse_args()
    if arguments.parts and arguments.page not in ("slow", *PARTS, *ROWS):
        parser.error(f"only slow, {', '.join([*PARTS, *ROWS])} can be made in part; {arguments.page} is made as a whole")
    if arguments.stale:
        sys.exit(stale(arguments.age))
    if arguments.page == "renew":
        failed = renew.renew(jobs(), arguments.minutes)
        sys.exit(f"failed, and nothing of theirs was kept: {', '.join(failed)}" if failed else None)
    if arguments.list or arguments.page is None:
        print(listed())
    elif arguments.reference:
        importlib.import_module(f"validation.make.{arguments.page}").reference()
    else:
        compute(arguments.page, arguments.parts)


def jobs():
    """Pages, and parts of pages that are computed by themselves."""
    return [job for page in PAGES for job in ([f"{page} {part}" for part in PARTS[page]] if page in PARTS else [page])]


def listed():
    """Pages, CPU seconds of the last run of each, and what is on them."""
    found = renew.jobs(jobs())
    return "\n".join(f"{page:14s} {renew.cost([j for j in found if j.words[0] == page]):>10s}  {PAGES[page]}" for page in PAGES)


def stale(age):
    """Print what is old; with an age, a text to fail with if something is for too long, or if a page claims to be newer than it is."""
    found = renew.jobs(jobs())
    print("\n".join(renew.report(found)))
    if age is None:
        print("\n".join(f"{page}.md: first line brought up to date" for page in state.stamp()))
        return None
    late, wrong = renew.too_old(found, age), state.stamp(write=False)
    out = (
        [f"old for more than {age} days: {', '.join(sorted({j.words[0] for j in late}))}: python -m validation renew"]
        if late
        else []
    )
    out += [f"first lines of {', '.join(wrong)} are not up to date: python -m validation --stale"] if wrong else []
    return "\n".join(out) or None


def compute(page, parts):
    """Compute a page, or parts of one, in this process, and record what with."""
    if page in ("slow", *PARTS) and len(parts) != 1:
        for part in parts or (slow.files() if page == "slow" else PARTS[page]):
            subprocess.run([sys.executable, "-m", "validation", page, part], check=True)
        return
    os.environ["GEARFE_CACHE"] = ""  # what is read from the disk was not computed by what is imported
    state.watch()
    if page == "slow":
        slow.run(parts[0])
    else:
        state.running.append(page)
        made = importlib.import_module(f"validation.make.{page}")
        made.run(parts) if parts else made.run()
        if len(state.running) == 1:  # no rows that are kept, and recorded, one by one
            state.ended(page, " ".join(parts), state.cpu())
    state.stamp()
    print(f"{' '.join([page, *parts])}: {state.cpu():.1f} s of CPU")


if __name__ == "__main__":
    main()

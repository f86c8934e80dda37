"""``python -m validation PAGE``: rebuild a validation page; ``--stale``: what is old; ``renew``: compute that again."""

import argparse
import importlib
import os
import subprocess
import sys
import time

from .shared import kept_rows, places, renew, slow, state
from .shared.page import QUESTIONS

PAGES = QUESTIONS | {
    "own_model": "(a file: the example of a curve exported by MATLAB)",
    "readme": "(a file: the table and the program output in the README)",
    "tutorials": "(files: what the scripts of the documentation print, for their test)",
}

PARTS = {  # what is computed at once, where that is not the page
    "machines": ("herringbone_machine", "planetary_pitting", "helical_pitting", "compound_planetary"),
    **dict.fromkeys(("herringbone", "sample"), ("all",)),
    "outlines": ("", "arbiter"),
    "three": ("", "decks"),
}
ROWS = (
    "detection",
    "dynamics",
    "hard",
    "holes",
    "joint",
    "map",
    "outlines",
    "rig",
    "sample",
    "sets",
    "sweeps",
    "three",
)  # parts: rows, by beginnings
ALONE = ("speed", "sweeps")  # pages that say what time things take
CONTINUED = {  # tables that a job continues where they lie: it counts as computed only if it begins without them
    "herringbone --reference": (str(places.ROOT / "gearfe/scene/scenes/herringbone_fe3d.csv"),),  # where gearfe reads it: by hand
    "outlines arbiter": ("outlines.csv", "outlines_fresh.csv", "outlines_plane.csv", "outlines_unloaded.csv"),
    "three --reference": ("pairs_three.csv",),
}


def main():
    """Do what is asked for."""
    parser = argparse.ArgumentParser(prog="python -m validation", description="Rebuild validation pages; see what is old.")
    parser.add_argument("page", nargs="?", choices=[*PAGES, "slow", "renew"], metavar="PAGE", help="a page, slow or renew")
    parts = "of pages that keep rows: beginnings of those to compute anew, or all; of machines and renew: pages; of slow: files"
    takes = ("slow", "renew", *PARTS, *ROWS)
    parser.add_argument("parts", nargs="*", metavar="PART", help=parts)
    parser.add_argument("--list", action="store_true", help="name the pages, what is on them and what they take")
    parser.add_argument("--stale", action="store_true", help="list what other code computed, and bring first lines up to date")
    parser.add_argument("--age", type=int, metavar="DAYS", help="with --stale: change nothing, fail if it is so for longer")
    parser.add_argument("--minutes", type=float, default=60.0, help="with renew: how long (default 60)")
    parser.add_argument("--processes", type=int, default=1, help="with renew: how many jobs at a time (default 1)")
    parser.add_argument("--reference", action="store_true", help="compute independent values that are not on file, or PART anew")
    arguments = parser.parse_intermixed_args()
    page, parts = arguments.page, arguments.parts
    if parts and page not in takes and not arguments.reference:
        parser.error(f"only {', '.join(sorted(set(takes)))} take parts; {page} is made as a whole")
    if arguments.stale:
        sys.exit(stale(arguments.age))
    elif page == "renew":
        failed = renewed(parts, arguments.minutes, arguments.processes)
        sys.exit(f"failed, and nothing of theirs was kept: {', '.join(failed)}" if failed else None)
    elif arguments.list or page is None:
        print(listed())
    elif page in ("slow", "machines") and len(parts) != 1:
        for part in parts or (slow.files() if page == "slow" else PARTS[page]):
            subprocess.run([sys.executable, "-m", "validation", page, part], check=True)
    else:
        compute(page, parts, arguments.reference)


def renewed(pages, minutes, processes):
    """Compute again what is old, of some pages or of all; decks first, since they tell which runs are old. What failed."""
    end = time.monotonic() + 60 * minutes
    decks = [job for job in found() if " ".join(job.words) == state.DECKS and job.old]
    failed = renew.renew(decks, minutes, {}) if decks and (not pages or {"three", "outlines"} & set(pages)) else []
    wanted = [job for job in found() if not pages or job.words[0] in pages]
    left = (end - time.monotonic()) / 60
    return failed + renew.renew(wanted, left, CONTINUED, processes=processes, alone=ALONE)


def whole():
    """What is computed as a whole: pages or parts of them, and independent values."""
    pages = [f"{page} {part}".strip() for page in PAGES for part in PARTS.get(page, ("",))]
    return [*pages, *(job for job in CONTINUED if job.endswith("--reference"))]


def found():
    """All jobs: with the rows that are kept one by one and the slow tests."""
    return renew.jobs(whole(), ROWS)


def listed():
    """Pages, CPU seconds of the last run of each, and what is on them."""
    jobs = found()
    return "\n".join(f"{page:14s} {PAGES[page]} {renew.cost([j for j in jobs if j.words[0] == page])}" for page in PAGES)


def stale(age):
    """Print what is old; with an age, the text of a failure: what is old for longer, pages that say another number; else None."""
    jobs = found()
    print("\n".join(renew.report(jobs)))
    if age is None:
        print("\n".join(f"{page}.md: first line brought up to date" for page in state.stamp()))
        return None
    late = sorted({" ".join(job.words[:1]) for job in renew.too_old(jobs, age)})
    wrong, out = state.stamp(write=False), []
    if late:
        out.append(f"old for more than {age} days, see python -m validation renew: {', '.join(late)}")
    if wrong:
        out.append(f"first lines that python -m validation --stale brings up to date: {', '.join(wrong)}")
    return "\n".join(out) or None


def compute(page, parts, reference):
    """Compute a page, parts of one or its independent values in this process, and record what with."""
    os.environ["GEARFE_CACHE"] = ""  # what is read from the disk was not computed by what is imported
    state.watch(finely=page not in ALONE)  # noting calls takes time
    if page == "slow":
        slow.run(parts[0])
    else:
        job = f"{page} --reference" if reference else " ".join([page, *parts])
        tables = [places.TABLES / name for name in CONTINUED.get(job, ())]
        begun = [table for table in tables if table.is_file()]
        state.run.job = job
        made = importlib.import_module(f"validation.make.{page}")
        if reference:
            for table in {table for name, table in state.read()[0] if parts and name.startswith(f"{job} ")}:
                kept_rows.forget(table.removesuffix(".jsonl"), parts)
            made.reference()
        else:
            made.run(parts) if parts else made.run()
        if job in whole() and not begun and all(table.is_file() for table in tables):
            state.ended(state.cpu(), tables)
    if "GEARFE_PAGES" not in os.environ:  # else `renew` moves the pages, and does it then
        state.stamp()
    print(f"{' '.join([page, *parts])}: {state.cpu():.1f} s of CPU")


if __name__ == "__main__":
    main()

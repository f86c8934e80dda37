"""``python -m validation PAGE``: rebuild a validation page; without PAGE: all of them."""

import argparse
import csv
import importlib
import resource
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor, as_completed

from .shared import places
from .shared.page import QUESTIONS

PAGES = QUESTIONS | {
    "own_model": "(a file: the example of a curve exported by MATLAB)",
    "readme": "(a file: the table and the program output in the README)",
    "tutorials": "(files: what the scripts of the documentation print, for their test)",
}

LONG_RUNS = ("sample", "three", "herringbone", "outlines")  # pages whose independent values --reference computes
LONG = {
    "map": "a thousand pairs",
    "sweeps": "thousands of cases, where they are not kept",
}  # left out of "everything": minutes each
TIMED = ("speed", "readme")  # they print seconds of the clock; other pages print CPU seconds, which hardly depend on company
PARTS = {
    "machines": ("herringbone_machine", "planetary_pitting", "helical_pitting", "compound_planetary")
}  # each a job of its own
ROWS = ("detection", "dynamics", "hard", "herringbone", "holes", "map", "sample", "speed", "sweeps", "three")
# parts of these pages: beginnings of rows to compute anew, or all
SECONDS = places.TABLES / "seconds.csv"  # of the last run of everything


def main():
    """Run the page asked for, or all of them."""
    parser = argparse.ArgumentParser(prog="python -m validation", description="Rebuild the validation pages.")
    parser.add_argument("page", nargs="?", choices=list(PAGES), metavar="PAGE", help=f"default: all but {', '.join(LONG)}")
    parser.add_argument(
        "parts",
        nargs="*",
        metavar="PART",
        help="of machines: only these pages; of pages that keep rows: beginnings of those to compute anew, or all",
    )
    parser.add_argument("--list", action="store_true", help="name the pages, what is on them and what they took")
    parser.add_argument(
        "--reference", action="store_true", help="compute the three-dimensional finite elements that are not on file (resumable)"
    )
    arguments = parser.parse_args()
    if arguments.parts and arguments.page not in (*PARTS, *ROWS):
        parser.error(f"only machines, {', '.join(ROWS)} can be made in part; {arguments.page} is made as a whole")
    if arguments.list:
        print(listed())
    elif arguments.reference:
        for name in [arguments.page] if arguments.page else LONG_RUNS:
            importlib.import_module(f"validation.make.{name}").reference()
    elif arguments.page is None:
        sys.exit(everything())
    else:
        started = time.perf_counter()
        made = importlib.import_module(f"validation.make.{arguments.page}")
        made.run(arguments.parts) if arguments.parts else made.run()
        print(f"{' '.join([arguments.page, *arguments.parts])}: {time.perf_counter() - started:.0f} s, {_cpu():.1f} s of CPU")


def listed():
    """Pages, CPU seconds of the last run of everything, and what is on them."""
    took = known_seconds()
    cost = {page: f"{sum(took.get(job, 0.0) for job in jobs_of(page)):.0f} s" for page in PAGES if took}
    cost |= dict.fromkeys(LONG, "long")
    return "\n".join(f"{page:14s} {cost.get(page, ''):>6s}  {about}" for page, about in PAGES.items())


def jobs_of(page):
    """What is run for a page: the page, or each of its parts."""
    return [f"{page} {part}" for part in PARTS[page]] if page in PARTS else [page]


def known_seconds():
    """CPU seconds of jobs in the last run of everything."""
    if not SECONDS.is_file():
        return {}
    with SECONDS.open(encoding="utf-8", newline="") as file:
        return {row["job"]: float(row["CPU seconds"]) for row in csv.DictReader(file)}


def everything():
    """Rebuild all pages but the long ones, each in a fresh process as alone; returns the number of jobs that failed.

    Pages that print seconds of the clock run one at a time, at the end, the others two at a time, the longest first.
    """
    took = known_seconds()
    jobs = [job for page in PAGES if page not in LONG for job in jobs_of(page)]
    wanted = sorted(jobs, key=lambda job: -took.get(job, 0.0))
    started, failed, new, waiting = time.perf_counter(), [], {}, set(wanted)
    for workers, pages in ((2, [p for p in wanted if p not in TIMED]), (1, [p for p in wanted if p in TIMED])):
        with ThreadPoolExecutor(workers) as pool:
            for job in as_completed([pool.submit(_alone, page) for page in pages]):
                page, code, told = job.result()
                waiting.remove(page)
                if code:
                    failed.append(page)
                    print("\n".join(told[-15:]))
                else:
                    new[page] = float(told[-1].split(", ")[-1].split()[0])
                last = "FAILED" if code else "; ".join([*[line for line in told if line.startswith("wrote")][-1:], told[-1]])
                left = sum(took.get(p, 0.0) / (1 if p in TIMED else 2) for p in waiting)
                at = f"{time.perf_counter() - started:.0f} s" + (f", about {left:.0f} s left" if took else "")
                print(f"[{len(wanted) - len(waiting)}/{len(wanted)}, {at}] {last}", flush=True)
    with SECONDS.open("w", encoding="utf-8", newline="") as file:
        rows = [(page, f"{seconds:.1f}") for page, seconds in ({p: took[p] for p in wanted if p in took} | new).items()]
        csv.writer(file, lineterminator="\n").writerows([("job", "CPU seconds"), *sorted(rows)])
    print(f"{len(wanted)} jobs in {time.perf_counter() - started:.0f} s" + (f"; failed: {', '.join(failed)}" if failed else ""))
    print("left out: " + "; ".join(f"{page} ({why})" for page, why in LONG.items()))
    return len(failed)


def _alone(page):
    """Name, exit code and printed lines of a page or a part of one."""
    done = subprocess.run([sys.executable, "-m", "validation", *page.split()], capture_output=True, text=True, check=False)
    return page, done.returncode, (done.stderr + done.stdout).splitlines()


def _cpu():
    """CPU seconds of this process and of those it waited for."""
    return sum(sum(resource.getrusage(who)[:2]) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))


if __name__ == "__main__":
    main()

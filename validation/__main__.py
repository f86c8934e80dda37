"""``python -m validation PAGE``: rebuild a validation page; without PAGE: all of them."""

import argparse
import importlib
import os
import subprocess
import sys

from .shared import renew, slow, state

PAGES = {
    "machines": "every printed number of the four machines beside ours, with verdicts",
    "herringbone_scan": "article S4: which readings of what it does not print bear its table (resumable)",
    "herringbone": "article S4: ten rows of stiffness against finite elements, and what moves them",
    "sample": "finite elements against the energy model, and both error estimates, on random pairs (resumable)",
    "sample_three": "the same in three dimensions: narrow and wide gears, rings, cracks (resumable)",
    "cracks": "crack reductions and their conventions",
    "assumptions": "what the assumptions of the scenes do to the stiffness",
    "outlines": "gaps and stiffness of random pairs against whole outlines pressed together (--reference: resumable)",
    "truth": "independent values of others, and CalculiX, beside ours",
    "measured": "measured gearboxes of others, as far as their numbers are public",
    "flanks": "modified flanks against CalculiX, the transmission error over load (resumable)",
    "sweeps": "thousands of cases: cost, kills, full disks, a cluster; cracks among manufacturing scatter (resumable)",
    "shortcomings": "what gearfe falls short of: the expected failures of its tests",
    "speed": "seconds against error of every method",
    "before_after": "seconds, memory and errors beside those of an earlier commit, in one run",
    "threads": "threads of the caller: bits, crashes, gears solved twice; seconds with threads of the linear algebra",
    "formulations": "closed forms on known pairs, and what each ingredient changes",
    "map": "errors of the closed forms over thousands of gear pairs",
    "surrogate": "stand-ins for the energy model: error on fresh cases, time of a call",
    "dataset": "a classifier trained on a simulated data set, and what it finds by severity",
    "hard": "hard cases, each with its outcome",
    "three": "three dimensions: energy model against hexahedra of the whole gear",
    "pairs_three": "stiffness of pairs in three dimensions against hexahedra of both gears (long: --reference)",
    "outsider_three": "three dimensions against CalculiX: whole gears in contact and under line loads (--reference)",
    "holed_cracks": "pits cut out of cracked teeth: the ten rows of S4 with holes (resumable)",
    "holes": "pits as real holes: volume cut, and what the missing material does to k",
    "pictures": "stress pictures of every scene and damage case",
    "hard_three": "hard cases in three dimensions, each with its outcome",
    "speed_three": "seconds and memory against error in three dimensions",
    "cost_three": "cost of the energy model in three dimensions over teeth, width, helix angle, order and phases",
    "centroid": "the sideband centroid SC of S0 and S1 against severity and impacts",
    "dynamics": "integrators: seconds against error, all machines at their own steps (resumable)",
    "hard_dynamics": "hard cases of the dynamics, each with its outcome (resumable)",
    "own_model": "the example of a curve exported by MATLAB",
    "readme": "the table and the program output in the README",
    "tutorials": "what the scripts of the documentation print, for their test",
}

LONG_RUNS = ("pairs_three", "herringbone", "outsider_three", "outlines")  # pages whose finite elements --reference computes
PARTS = {
    "machines": ("herringbone_machine", "planetary_pitting", "helical_pitting", "compound_planetary")
}  # each a job of its own
ROWS = ("dynamics", "hard_dynamics")  # pages whose rows are kept: parts are beginnings of those computed anew


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

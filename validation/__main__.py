"""``python -m validation PAGE``: rebuild a validation page; without PAGE: all of them."""

import argparse
import importlib
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor, as_completed

PAGES = {
    "machines": "every printed number of the four machines beside ours, with verdicts",
    "herringbone": "article S4: ten rows of stiffness against finite elements, and what moves them",
    "cracks": "crack reductions and their conventions",
    "assumptions": "what the assumptions of the scenes do to the stiffness",
    "truth": "independent values of others, and CalculiX, beside ours",
    "slow": "the slow tests and what they print",
    "speed": "seconds against error of every method",
    "formulations": "closed forms on known pairs, and what each ingredient changes",
    "map": "errors of the closed forms over thousands of gear pairs",
    "hard": "hard cases, each with its outcome",
    "three": "three dimensions: energy model against hexahedra of the whole gear",
    "pairs_three": "stiffness of pairs in three dimensions against hexahedra of both gears (long: --reference)",
    "holes": "pits as real holes: volume cut, and what the missing material does to k",
    "pictures": "stress pictures of every scene and damage case",
    "hard_three": "hard cases in three dimensions, each with its outcome",
    "speed_three": "seconds and memory against error in three dimensions",
    "centroid": "the sideband centroid SC of S0 and S1 against severity and impacts",
    "dynamics": "integrators: seconds against error on 55 degrees of freedom",
    "hard_dynamics": "hard cases of the dynamics, each with its outcome",
    "own_model": "the example of a curve exported by MATLAB",
    "readme": "the table and the program output in the README",
}

LONG_RUNS = ("pairs_three", "herringbone")  # pages whose finite elements --reference computes
LONG = {
    "slow": "runs the slow tests",
    "map": "thousands of gears",
    "three": "brute-force finite elements of whole gears",
    "speed_three": "brute-force finite elements of whole gears",
}  # left out of "everything": minutes to an hour each
TIMED = ("speed", "hard", "hard_three", "dynamics", "hard_dynamics", "readme")  # they print seconds


def main():
    """Run the page asked for, or all of them."""
    about = "; ".join(f"{page}: {text}" for page, text in PAGES.items())
    parser = argparse.ArgumentParser(prog="python -m validation", description="Rebuild the validation pages.")
    parser.add_argument("page", nargs="?", choices=list(PAGES), help=f"default: all but {', '.join(LONG)}. {about}")
    parser.add_argument(
        "--reference", action="store_true", help="compute the three-dimensional finite elements that are not on file (resumable)"
    )
    arguments = parser.parse_args()
    if arguments.reference:
        for name in [arguments.page] if arguments.page else LONG_RUNS:
            importlib.import_module(f"validation.make.{name}").reference()
        return
    if arguments.page is None:
        sys.exit(everything())
    started = time.perf_counter()
    importlib.import_module(f"validation.make.{arguments.page}").run()
    print(f"{arguments.page}: {time.perf_counter() - started:.0f} s")


def everything():
    """Rebuild all pages but the long ones, each in a fresh process as alone; returns the number of pages that failed.

    Pages that print seconds run one at a time, at the end, the others two at a time.
    """
    wanted, started, failed = [page for page in PAGES if page not in LONG], time.perf_counter(), []
    done = 0
    for workers, pages in ((2, [p for p in wanted if p not in TIMED]), (1, [p for p in wanted if p in TIMED])):
        with ThreadPoolExecutor(workers) as pool:
            for job in as_completed([pool.submit(_alone, page) for page in pages]):
                page, code, told, seconds = job.result()
                done += 1
                lines = told.splitlines()
                if code:
                    failed.append(page)
                    print("\n".join(lines[-15:]))
                last = "FAILED" if code else next((line for line in reversed(lines) if line.startswith("wrote")), "done")
                at = time.perf_counter() - started
                print(f"[{done}/{len(wanted)}, {at:.0f} s] {page}: {seconds:.0f} s, {last}", flush=True)
    print(f"{len(wanted)} pages in {time.perf_counter() - started:.0f} s" + (f"; failed: {', '.join(failed)}" if failed else ""))
    print("left out: " + "; ".join(f"{page} ({why})" for page, why in LONG.items()))
    return len(failed)


def _alone(page):
    """Name, exit code, output and seconds of a page."""
    started = time.perf_counter()
    done = subprocess.run([sys.executable, "-m", "validation", page], capture_output=True, text=True, check=False)
    return page, done.returncode, done.stdout + done.stderr, time.perf_counter() - started


if __name__ == "__main__":
    main()

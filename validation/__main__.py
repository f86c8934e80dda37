"""``python -m validation PAGE``: rebuild a validation page; without PAGE: all of them."""

import argparse
import importlib
import subprocess
import sys
import time

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
            importlib.import_module(f"validation.{name}").reference()
        return
    if arguments.page is None:
        sys.exit(everything())
    started = time.perf_counter()
    importlib.import_module(f"validation.{arguments.page}").run()
    print(f"{arguments.page}: {time.perf_counter() - started:.0f} s")


def everything():
    """Rebuild all pages but the long ones, each in a fresh process as alone; returns the number of pages that failed."""
    wanted, failed, started = [page for page in PAGES if page not in LONG], [], time.perf_counter()
    for i, page in enumerate(wanted, 1):
        print(f"[{i}/{len(wanted)}] {page}: {PAGES[page]} ({time.perf_counter() - started:.0f} s so far)", flush=True)
        if subprocess.run([sys.executable, "-m", "validation", page], check=False).returncode:
            failed.append(page)
    print(f"{len(wanted)} pages in {time.perf_counter() - started:.0f} s" + (f"; failed: {', '.join(failed)}" if failed else ""))
    print("left out: " + "; ".join(f"{page} ({why})" for page, why in LONG.items()))
    return len(failed)


if __name__ == "__main__":
    main()

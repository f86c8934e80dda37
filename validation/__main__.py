"""``python -m validation PAGE``: rebuild a validation page."""

import argparse
import importlib

PAGES = {
    "cracks": "crack reductions and their conventions",
    "slow": "the slow tests and what they print",
    "speed": "seconds against error of every method",
    "formulations": "closed forms on known pairs, and what each ingredient changes",
    "map": "errors of the closed forms over thousands of gear pairs",
    "hard": "hard cases, each with its outcome",
    "three": "three dimensions: energy model against hexahedra of the whole gear",
    "pairs_three": "stiffness of pairs in three dimensions against hexahedra of both gears (long: --reference)",
    "hard_three": "hard cases in three dimensions, each with its outcome",
    "speed_three": "seconds and memory against error in three dimensions",
    "centroid": "the sideband centroid SC of S0 and S1 against severity and impacts",
    "dynamics": "integrators: seconds against error on 55 degrees of freedom",
    "hard_dynamics": "hard cases of the dynamics, each with its outcome",
    "own_model": "the example of a curve exported by MATLAB",
    "readme": "the table and the program output in the README",
}


def main():
    """Run the page asked for."""
    about = "; ".join(f"{page}: {text}" for page, text in PAGES.items())
    parser = argparse.ArgumentParser(prog="python -m validation", description="Rebuild the validation pages.")
    parser.add_argument("page", choices=list(PAGES), help=about)
    parser.add_argument("--reference", action="store_true", help="first compute the finite elements that the page's table lacks")
    arguments = parser.parse_args()
    page = importlib.import_module(f"validation.{arguments.page}")
    if arguments.reference and not hasattr(page, "reference"):
        parser.error(f"page {arguments.page!r} has no long reference runs")
    if arguments.reference:
        page.reference()
    page.run()


if __name__ == "__main__":
    main()

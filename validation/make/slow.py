"""Run the slow tests and keep what they printed."""

import subprocess
import sys
import time
from pathlib import Path

from gearfe.files import written

from ..shared import machine
from ..shared.places import PAGES, ROOT

PAGE = PAGES / "slow.md"
TELLING = (" inside", "curves,", "N/mm:", "ring, phase", "passed", "failed", "skipped")


def run():
    """Write `slow.md`; raise RuntimeError if a slow test failed."""
    started = time.perf_counter()
    command = [sys.executable, "-m", "pytest", "-m", "slow", "-s", "-q"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    text = page(done.stdout, time.perf_counter() - started)
    with written(PAGE) as name:
        Path(name).write_text(text, encoding="utf-8")
    print(text)
    if done.returncode:
        raise RuntimeError(f"slow tests failed:\n{done.stdout[-3000:]}")


def page(printed, seconds):
    """The page from what the tests printed."""
    told = [line.lstrip(".") for line in printed.splitlines() if any(word in line for word in TELLING)]
    return "\n".join(
        [
            "# Slow tests: last result",
            "",
            f"Made by `python -m validation slow` (`pytest -m slow`) on {machine.describe()},",
            f"{seconds:.0f} s: error estimate against the true error on 48 random pairs at every phase, `ritz` against refined",
            "finite elements on 24 random pairs, fuzzing of 300 random pairs and cracks by both, nonlinear contact in CalculiX",
            "(difference of k), three dimensions.",
            "",
            "```text",
            *told,
            "```",
            "",
        ]
    )

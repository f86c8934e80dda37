"""Store the output of the documentation scripts next to their test."""

import os
import subprocess
import sys
import tempfile

from ..shared.places import ROOT

SITE = ROOT / "gearfe" / "docs"
RECORD = ROOT / "tests" / "docs" / "printed"


def run(again=True):
    """Run every script in an empty folder and write its output."""
    own = {"PYTHONPATH": str(ROOT), "MPLBACKEND": "Agg", "OMP_NUM_THREADS": "1"}
    for script in sorted(SITE.glob("tutorials/*.py")) + sorted(SITE.glob("gallery/*.py")):
        with tempfile.TemporaryDirectory() as folder:
            command = [sys.executable, "-W", "error", script]
            done = subprocess.run(command, cwd=folder, env=os.environ | own, capture_output=True, text=True, check=True)
        if done.stdout:
            (RECORD / f"{script.stem}.txt").write_text(done.stdout, encoding="utf-8")
        print(f"{script.stem}: {len(done.stdout.splitlines())} lines")

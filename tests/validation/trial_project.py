"""A project of one page, whose job imports one module and reads one file of data."""

import os
import re
import shutil
import subprocess
import sys

from validation.shared import places

MODULE = '"""One."""\n\n\ndef one():\n    """Give 1."""\n    return 1  # that is one\n'
MAKE = """
import time
from pathlib import Path
from validation.shared.kept_rows import kept
from validation.shared.places import PAGES, ROOT, TABLES

def run(parts=()):
    from gearfe.used import one
    more = float((ROOT / "gearfe" / "data.csv").read_text())
    with (TABLES / "cracks.csv").open("w") as file:
        file.write("name,value\\nfirst,")
        file.flush()
        time.sleep(more)
        file.write(f"{one()}\\nsecond,2\\n")
    (PAGES / "cracks.md").write_text("# How much?\\n\\nMuch.\\n")
"""
KEPT = "from validation.shared.kept_rows import kept\n\n\ndef run(parts=()):\n"
KEPT += "    for name in ('one', 'two'):\n        print(kept('dynamics_rows', name, lambda: {'value': 1}, parts))\n"
KEPT += "\n\ndef reference():\n    for name in ('three', 'four'):\n        kept('dynamics_far', name, lambda: {'value': 1})\n"


def trial(tmp_path):
    """Make it in a folder."""
    home = places.HOME
    for folder in ("gearfe", "geometry", "tests", "validation/make", "validation/pages/tables"):
        (tmp_path / folder).mkdir(parents=True)
        (tmp_path / folder / "__init__.py").touch()
    shutil.copytree(home / "shared", tmp_path / "validation" / "shared", ignore=shutil.ignore_patterns("arbiter", "__pycache__"))
    for name in ("__init__.py", "__main__.py"):
        shutil.copy(home / name, tmp_path / "validation")
    text = re.sub(
        "PAGES = QUESTIONS.*?\n}", "PAGES = {'cracks': '', 'dynamics': ''}", (home / "__main__.py").read_text(), flags=re.S
    )
    text = re.sub(
        "CONTINUED = {.*?\n}",
        "CONTINUED = {'cracks': ('cracks.csv',), 'dynamics --reference': ('dynamics_far.jsonl',)}",
        text,
        flags=re.S,
    )
    (tmp_path / "validation/__main__.py").write_text(text)
    for name, text in {
        "gearfe/used.py": MODULE,
        "gearfe/idle.py": MODULE,
        "gearfe/data.csv": "0\n",
        "validation/make/cracks.py": MAKE,
        "validation/make/dynamics.py": KEPT,
    }.items():
        (tmp_path / name).write_text(text)
    return tmp_path


def told(project, *words, code=0):
    """What `python -m validation` prints in the project; its exit code is asserted."""
    own = {name: value for name, value in os.environ.items() if not name.startswith(("GIT_", "GEARFE_"))}
    own |= {"PYTHONPATH": "", "PYTHONDONTWRITEBYTECODE": "1"}  # which does not see a change of a digit within the second
    command = [sys.executable, "-m", "validation", *words]
    done = subprocess.run(command, cwd=project, env=own, capture_output=True, text=True, check=False)
    assert done.returncode == code, done.stdout + done.stderr
    return done.stdout + done.stderr


def old(project):
    """Rows of the page that `--stale` calls old."""
    lines = [line.split() for line in told(project, "--stale").splitlines() if line.startswith("cracks ")]
    assert len(lines) <= 1
    return int(lines[0][1]) if lines else 0


def first_line(project):
    return (project / "validation" / "pages" / "cracks.md").read_text().partition("\n")[0]

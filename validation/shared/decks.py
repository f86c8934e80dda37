"""Decks of CalculiX: a run is of the present code as long as the present code writes its deck.

`write` notes the digests of all decks of runs on file in `tables/decks.csv`, in a minute; `state.present` compares.
"""

import csv
import hashlib
import re
import resource
import subprocess
import tempfile
from pathlib import Path

from gearfe.core.files import written

from . import places

NUMBER = re.compile(rb"-?\d+\.\d*(?:[eE][-+]?\d+)?")


def digest(path):
    """Sixteen hexadecimal digits of a deck, its numbers to six decimals: no machine or version agrees on the last ones."""
    text = NUMBER.sub(lambda found: b"%.6f" % (round(float(found[0]), 6) + 0.0), Path(path).read_bytes())
    return hashlib.sha256(text).hexdigest()[:16]


def write(*makers):
    """Write the table; `makers` write decks in a folder, one after the other, and give the job of the run and the path."""
    with tempfile.TemporaryDirectory() as folder:
        rows = [(job, digest(path)) for maker in makers for job, path in maker(Path(folder))]
    places.TABLES.mkdir(exist_ok=True)
    with written(places.TABLES / "decks.csv") as name, open(name, "w", encoding="utf-8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([("job", "deck"), *rows])


def calculix(folder, name):
    """Run CalculiX and give its CPU seconds; RuntimeError with its last words if it has no result."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run(["ccx", "-i", name], cwd=folder, capture_output=True, text=True, check=False)
    if not (folder / f"{name}.dat").exists() or not (folder / f"{name}.dat").stat().st_size:
        raise RuntimeError(f"CalculiX gave no result: {done.stdout[-500:]}")
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before

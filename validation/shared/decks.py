"""Decks of CalculiX: runs of the program, and digests by which a test finds a deck that is no longer the one of a run on file."""

import hashlib
import re
import resource
import subprocess
from pathlib import Path

NUMBER = re.compile(rb"-?\d+\.\d*(?:[eE][-+]?\d+)?")


def digest(path):
    """Sixteen hexadecimal digits of a deck, its numbers to six decimals: no machine or version agrees on the last ones."""
    text = NUMBER.sub(lambda found: b"%.6f" % (round(float(found[0]), 6) + 0.0), Path(path).read_bytes())
    return hashlib.sha256(text).hexdigest()[:16]


def calculix(folder, name):
    """Run CalculiX and give its CPU seconds; RuntimeError with its last words if it has no result."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run(["ccx", "-i", name], cwd=folder, capture_output=True, text=True, check=False)
    if not (folder / f"{name}.dat").exists() or not (folder / f"{name}.dat").stat().st_size:
        raise RuntimeError(f"CalculiX gave no result: {done.stdout[-500:]}")
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before

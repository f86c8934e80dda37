"""Decks of CalculiX: runs of the program, and digests by which tests detect changed decks."""

import hashlib
import re
import resource
import shutil
import subprocess
import tempfile
from pathlib import Path

NUMBER = re.compile(rb"-?\d+\.\d*(?:[eE][-+]?\d+)?")


def digest(path):
    """Return sixteen hexadecimal digits of a deck, with six decimals, because further digits vary between computers."""
    text = NUMBER.sub(lambda found: b"%.6f" % (round(float(found[0]), 6) + 0.0), Path(path).read_bytes())
    return hashlib.sha256(text).hexdigest()[:16]


def calculix(folder, name):
    """Run CalculiX and return its CPU seconds. Raises RuntimeError with its last output if there is no result."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run(["ccx", "-i", name], cwd=folder, capture_output=True, text=True, check=False)
    if not (folder / f"{name}.dat").exists() or not (folder / f"{name}.dat").stat().st_size:
        raise RuntimeError(f"CalculiX gave no result: {done.stdout[-500:]}")
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def installed():
    """Return whether CalculiX is installed. If not, print that stored runs are kept."""
    if not shutil.which("ccx"):
        print("  CalculiX (ccx) is not installed: the committed rows are kept (Debian: apt-get install calculix-ccx)")
    return shutil.which("ccx") is not None


def pressed(write):
    """Run a three-dimensional contact deck with CalculiX, and return the result as a table row.

    Parameters
    ----------
    write : callable
        Writes ``pair.inp`` into a folder and returns the deck.

    Returns
    -------
    row : dict
        Digest of the deck, nodes, CPU seconds, mean of both forces [N], forces apart.
    carried : dict
        Force [N] of each tooth pair and where along the width it acts [mm].
    """
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        deck = write(folder)
        seconds = calculix(folder, "pair")
        first, second = deck.forces(folder / "pair.dat")
        carried = deck.carried(folder / "pair.dat") if hasattr(deck, "carried") else {}
        nodes = sum(part.points.shape[1] for part in deck.parts)
        row = {"deck": digest(folder / "pair.inp"), "nodes": nodes, "seconds": round(seconds, 1)}
    return row | {"force": (first + second) / 2, "forces apart": float(f"{first / second - 1:.3g}")}, carried

"""Results shared by processes on disk: solved gears, and the compliance that planetary sets add to meshes.

A stored result is used only if its digest agrees with the requested key: the gear, its material and damage, the options, the
source code of both packages and the versions of the libraries. If the file is another one or damaged, the result is computed and
the file is replaced. The folder is ``$GEARFE_CACHE``, by default ``~/.cache/gearfe``. An empty ``GEARFE_CACHE`` switches the disk
off.
"""

import contextlib
import hashlib
import os
import sys
from functools import lru_cache, partial
from pathlib import Path

import numpy as np

from ..core.extras import installed_version
from ..flexibility.solved import PROCESS
from .flexibility_file import read_flexibility, write_flexibility

LIBRARIES = ("numpy", "scipy", "scikit-fem", "gmsh")


def folder():
    """Return the folder of stored flexibilities, or None if the disk cache is off."""
    place = os.environ.get("GEARFE_CACHE")
    if place is None:
        with contextlib.suppress(RuntimeError):  # A user without a home directory has no folder of results.
            return Path.home() / ".cache" / "gearfe"
    return Path(place) if place else None


def stored_arrays(kind, case, solve):
    """Return the arrays that `solve` computes for a `case`. A result stored in this process or on disk is used.

    `kind` names the computation. The text of `case` (`repr`) must state all inputs.
    """
    with np.printoptions(threshold=sys.maxsize, floatmode="unique"):  # all digits of all values
        key = repr(case)
    return kept_on_disk(kind, None, (key,), solve, PROCESS)


def file_of(key):
    """Return the path of a stored result (None if the disk cache is off), and its key as text."""
    place = folder()
    if place is None:
        return None, ""
    text = repr((*key, made_by()))
    return place / f"{hashlib.sha256(text.encode()).hexdigest()}.gear", text


def kept_on_disk(kind, gear, case, solve, kept):
    """Return a result from `kept`, from the disk (only with the cache of this process), or from `solve`."""
    return kept.get((kind, gear, *case), partial(_stored, kind, gear, case, solve) if kept is PROCESS else solve)


def _stored(kind, gear, case, solve):
    file, key = file_of((kind, gear, *case))
    if file is None:
        return solve()
    stored = read_flexibility(file, key, gear)
    if stored is not None:
        return stored
    solved = solve()
    with contextlib.suppress(OSError, ValueError):  # Without a writable disk, results are only not stored.
        file.parent.mkdir(parents=True, exist_ok=True)
        write_flexibility(file, key, solved)
    return solved


@lru_cache(maxsize=1)
def made_by() -> tuple[str, tuple[tuple[str, str], ...]]:
    """Return a hash of the source code of both packages and of the library versions."""
    digest = hashlib.sha256()
    for source in sources():
        digest.update(source.read_bytes())
    return digest.hexdigest(), tuple((name, installed_version(name)) for name in LIBRARIES)


def program() -> dict[str, str]:
    """Return the versions of gearfe, its source code and its libraries, which studies store."""
    source, libraries = made_by()
    return {"gearfe": installed_version("gearfe"), "source": source[:12], **dict(libraries)}


def sources():
    """Return the source files of both packages. The documentation is excluded, because a build of the site writes into it."""
    home = Path(__file__).resolve().parents[1]
    folders = (os.walk(home), os.walk((home / "geometry").resolve()))  # In a checkout `geometry` is a link: no walk follows it.
    found = {Path(place, name) for walk in folders for place, _, names in walk for name in names if name.endswith(".py")}
    return sorted(file for file in found if home / "docs" not in file.parents)

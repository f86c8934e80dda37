"""Gears solved before: kept in this process, and on disk between processes.

A stored flexibility is used only if its whole key, spelled out and stored beside it, equals the one asked for: the gear, its
material and damage, the options, the source code of both packages and the versions of the libraries that made it. The folder
is ``$GEARFE_CACHE``, by default ``~/.cache/gearfe``; an empty ``GEARFE_CACHE`` switches the disk off.
"""

import hashlib
import os
import pickle
from functools import lru_cache
from importlib.metadata import version
from pathlib import Path

import geometry

from . import fe
from .energy import ritz
from .export import written

LIBRARIES = ("numpy", "scipy", "scikit-fem", "gmsh")


def folder():
    """Folder of stored flexibilities, None if switched off."""
    place = os.environ.get("GEARFE_CACHE", str(Path.home() / ".cache" / "gearfe"))
    return Path(place) if place else None


def solved_gear(gear, material, cracks=(), *, cache=True, **options):
    """Flexibility of a gear by finite elements, from the cache if it is there.

    Parameters
    ----------
    gear : Gear
    material : Material
    cracks : tuple of Crack
    cache : bool
        False: solve anew, store nothing.
    **options
        As in `gearfe.fe.flexibility`: neighbours, state, refine, teeth.

    Returns
    -------
    Flexibility
    """
    ordered = tuple(sorted(options.items()))
    return _kept(gear, material, cracks, ordered) if cache else _solve(gear, material, cracks, ordered, cache=False)


@lru_cache(maxsize=32)
def _kept(gear, material, cracks, options):
    place = folder()
    if place is None:
        return _solve(gear, material, cracks, options, cache=True)
    key = repr((gear, material, cracks, options, sorted(fe.EDGES.items()), _made_by()))
    file = place / f"{hashlib.sha256(key.encode()).hexdigest()}.pickle"
    try:
        stored_key, stored = pickle.loads(file.read_bytes())
        if stored_key == key:
            return stored
    except (OSError, pickle.UnpicklingError, EOFError, ValueError, AttributeError, ImportError, IndexError):
        pass  # absent, cut off or from another version: solve
    solved = _solve(gear, material, cracks, options, cache=True)
    try:
        place.mkdir(parents=True, exist_ok=True)
        with written(file) as name:
            Path(name).write_bytes(pickle.dumps((key, solved)))
    except (OSError, ValueError):
        pass  # a full or read-only disk costs only the reuse
    return solved


def _solve(gear, material, cracks, options, *, cache):
    if not cracks:
        return fe.flexibility(gear, material, **dict(options))
    healthy = _kept(gear, material, (), options) if cache else _solve(gear, material, (), options, cache=False)
    return fe.cracked_flexibility(gear, material, cracks, healthy, **dict(options))


@lru_cache(maxsize=1)
def _made_by():
    """Hash of the source of both packages, and the versions of the libraries."""
    digest = hashlib.sha256()
    for package in (Path(geometry.__file__).parent, Path(__file__).parent):
        for source in sorted(package.rglob("*.py")):
            digest.update(source.read_bytes())
    return digest.hexdigest(), tuple((name, version(name)) for name in LIBRARIES)


def clear():
    """Forget the gears kept in this process (files stay)."""
    _kept.cache_clear()
    ritz.clear()

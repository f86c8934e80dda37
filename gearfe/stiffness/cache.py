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

from ..elements import fe
from ..elements.fe_gear3d import solid_flexibility
from ..energy.ritz import plane as ritz
from ..files import written

LIBRARIES = ("numpy", "scipy", "scikit-fem", "gmsh")
MOST = 32  # gears kept in this process
_known = {}


def folder():
    """Folder of stored flexibilities, None if switched off."""
    place = os.environ.get("GEARFE_CACHE", str(Path.home() / ".cache" / "gearfe"))
    return Path(place) if place else None


def solved_gear(gear, material, cracks=(), *, cache=True, **options):
    """Flexibility of a gear's section by finite elements, from the cache if it is there.

    Parameters
    ----------
    gear : Gear
    material : Material
    cracks : tuple of Crack
    cache : bool
        False: solve anew, store nothing.
    **options
        As in `gearfe.elements.fe.flexibility`: neighbours, state, refine, teeth.

    Returns
    -------
    Flexibility
    """

    def solve():
        if not cracks:
            return fe.flexibility(gear, material, **options)
        healthy = solved_gear(gear, material, cache=cache, **options)
        return fe.cracked_flexibility(gear, material, cracks, healthy, **options)

    return _kept(("section", gear, material, cracks, sorted(options.items()), sorted(fe.EDGES.items())), solve, cache)


def solved_solid(gear, material, cracks=(), *, cache=True, tell=None, **options):
    """Flexibility of a gear of finite width by finite elements of all of it, from the cache if it is there.

    Parameters
    ----------
    gear : Gear
    material : Material
    cracks : tuple of Crack
    cache : bool
        False: solve anew, store nothing.
    tell : callable, optional
        Gets one line of text before each solve: which gear, the solver, the expected memory.
    **options
        As in `gearfe.elements.fe_gear3d.solid_flexibility`: neighbours, degree, refine, solver.

    Returns
    -------
    Flexibility3D
    """

    def said(plan):
        damage = f", {len(cracks)} cracks" if cracks else ""
        tell(f"z = {gear.z}, b = {gear.b:g} mm{damage}: {plan}")

    def solve():
        healthy = solved_solid(gear, material, cache=cache, tell=tell, **options) if cracks else None
        return solid_flexibility(gear, material, cracks, healthy=healthy, tell=said if tell else None, **options)

    return _kept(("solid", gear, material, cracks, sorted(options.items())), solve, cache)


def _kept(what, solve, cache):
    """What `solve` gives, from this process or the disk if it is there."""
    if not cache:
        return solve()
    key = repr((*what, _made_by()))
    if key not in _known:
        if len(_known) >= MOST:
            del _known[next(iter(_known))]
        _known[key] = _stored(key, solve)
    return _known[key]


def _stored(key, solve):
    place = folder()
    if place is None:
        return solve()
    file = place / f"{hashlib.sha256(key.encode()).hexdigest()}.pickle"
    try:
        stored_key, stored = pickle.loads(file.read_bytes())
        if stored_key == key:
            return stored
    except (OSError, pickle.UnpicklingError, EOFError, ValueError, AttributeError, ImportError, IndexError):
        pass  # absent, cut off or from another version: solve
    solved = solve()
    try:
        place.mkdir(parents=True, exist_ok=True)
        with written(file) as name:
            Path(name).write_bytes(pickle.dumps((key, solved)))
    except (OSError, ValueError):
        pass  # a full or read-only disk costs only the reuse
    return solved


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
    _known.clear()
    ritz.clear()

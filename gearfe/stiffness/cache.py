"""Cache of gears solved by finite elements or in three dimensions: in this process, and on disk between processes.

A stored flexibility is used only if its digest agrees with the requested key: the gear, its material and damage, the options, the
source code of both packages and the versions of the libraries. If the file is another one or damaged, the gear is solved and the
file is replaced. The folder is ``$GEARFE_CACHE``, by
default ``~/.cache/gearfe``; an empty ``GEARFE_CACHE`` switches the disk off.
"""

import contextlib
import hashlib
import os
from functools import lru_cache, partial
from importlib.metadata import version
from pathlib import Path

from ..flexibility.energy.ritz.solid import flexibility3d
from ..flexibility.finite_elements import fe
from ..flexibility.finite_elements.fe_gear3d import MeshedGear, solid_flexibility
from ..flexibility.solved import PROCESS, solved_gears, timed
from ..geometry.damage.crack import Crack, meshed_path
from ..geometry.damage.kinds import told
from .flexibility_file import read_flexibility, write_flexibility

LIBRARIES = ("numpy", "scipy", "scikit-fem", "gmsh")


def folder():
    """Folder of stored flexibilities, None if switched off."""
    place = os.environ.get("GEARFE_CACHE")
    if place is None:
        with contextlib.suppress(RuntimeError):  # A user without a home directory has no such folder.
            return Path.home() / ".cache" / "gearfe"
    return Path(place) if place else None


def solved_gear(gear, material, cracks=(), *, cache=True, **options):
    """Return the flexibility of a gear's section by finite elements, from the cache if possible.

    `gearfe.flexibility.solved.solved_gears` describes `cache`. With False the gear is solved again and nothing is stored.
    Files are used only together with the stored results of this process. `options` are those of
    `finite_elements.fe.damaged_flexibility`: broken, neighbours, state, refine, teeth.
    """
    kept = solved_gears(cache)

    def solve():
        if not (cracks or options.get("broken")):
            return timed(lambda: fe.flexibility(gear, material, **options))
        healthy = solved_gear(gear, material, cache=kept, **{name: value for name, value in options.items() if name != "broken"})
        return timed(lambda: fe.damaged_flexibility(gear, material, cracks, healthy, **options), healthy)

    case = (material, cracks, tuple(sorted(options.items())), tuple(sorted(fe.EDGES.items())))
    return _kept("section", gear, case, solve, kept)


def solved_solid(gear, material, damage=(), *, cache=True, tell=None, **options):
    """Return the `Flexibility3D` of a gear of finite width by finite elements of the whole gear, from the cache if possible.

    `solved_gear` describes `cache`. `options` are those of `finite_elements.fe_gear3d.MeshedGear`: neighbours, degree, less,
    refine, section, shaft. `tell` gets one line of text before each solve with the gear, the unknowns, the expected seconds and
    memory.
    """
    kept = solved_gears(cache)
    for one in damage:
        if isinstance(one, Crack):
            meshed_path(gear, one)  # Invalid cracks raise an error before the healthy gear is solved.

    def said(plan):
        hurt = f", {told({'': gear}, {'': damage})}" if damage else ""
        tell(f"z = {gear.z}, b = {gear.b:g} mm{hurt}: {plan}")

    def solve():
        healthy = solved_solid(gear, material, cache=kept, tell=tell, **options) if damage else None
        keywords = {"healthy": healthy, "tell": said if tell else None, "cache": kept}
        return timed(lambda: solid_flexibility(MeshedGear(gear, damage, **options), material, **keywords), healthy)

    return _kept("solid", gear, _solid_case(material, damage, options), solve, kept)


def solved_energy(gear, material, damage=(), *, cache=True, **options):
    """Return the `Flexibility3D` of a gear of finite width by the energy model, from the cache if possible.

    `solved_gear` describes `cache`. `options` are those of `energy.ritz.solid.flexibility3d`: neighbours, order, axial, refine.
    """
    kept = solved_gears(cache)
    solve = partial(flexibility3d, gear, material, damage, cache=kept, **options)
    return _kept("energy", gear, _solid_case(material, damage, options), solve, kept)


def _solid_case(material, damage, options):
    return material, damage, tuple(sorted(options.items()))


def gears_alone():
    """Return the solved gears of this process in a separate cache, without other results of the process."""
    return PROCESS.of(("section", "solid", "energy"))


def unsolved(gear, material, damage=(), *, cache=True, **options):
    """Return the costs (`finite_elements.solver.SolveCost`) of the solves that `solved_solid` still requires, by key.

    RuntimeError, with the numbers, if one of them does not fit into memory.
    """
    key = ("solid", gear, *_solid_case(material, damage, options))
    kept = solved_gears(cache)
    if key in kept or (kept is PROCESS and (file := _file(key)[0]) and file.exists()):
        return {}
    before = unsolved(gear, material, cache=kept, **options) if damage else {}
    return before | {key: MeshedGear(gear, damage, **options).plan()}


def _file(key):
    """Return the path of a result on disk, None if that is switched off, and its key as text."""
    place = folder()
    if place is None:
        return None, ""
    text = repr((*key, made_by()))
    return place / f"{hashlib.sha256(text.encode()).hexdigest()}.gear", text


def _kept(kind, gear, case, solve, kept):
    """Return the result of `solve` from `kept`, from the disk if `kept` is that of this process, or by solving."""
    return kept.get((kind, gear, *case), partial(_stored, kind, gear, case, solve) if kept is PROCESS else solve)


def _stored(kind, gear, case, solve):
    file, key = _file((kind, gear, *case))
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
    """Hash of the source of both packages, and the versions of the libraries."""
    digest = hashlib.sha256()
    for source in sources():
        digest.update(source.read_bytes())
    return digest.hexdigest(), tuple((name, version(name)) for name in LIBRARIES)


def program() -> dict[str, str]:
    """Versions of gearfe, its source and its libraries, which studies store."""
    source, libraries = made_by()
    return {"gearfe": version("gearfe"), "source": source[:12], **dict(libraries)}


def sources():
    """Source files of both packages."""
    home = Path(__file__).resolve().parents[1]
    folders = (os.walk(home), os.walk((home / "geometry").resolve()))  # In a checkout `geometry` is a link: no walk follows it.
    return sorted({Path(place, name) for walk in folders for place, _, names in walk for name in names if name.endswith(".py")})


def clear():
    """Remove all results stored in this process. Files are kept."""
    PROCESS.clear()

"""What is written beside a stiffness curve: gears, materials, options and versions; nothing reads it to decide anything."""

from dataclasses import asdict, replace
from functools import lru_cache
from importlib.metadata import PackageNotFoundError, version

VERSIONS = ("gearfe", "numpy", "scipy", "scikit-fem", "gmsh")


def provenance(pair, materials, method, options):
    """`meta` of a `StiffnessCurve` without its force, of a method (its name) with its `options`."""
    gears = {name: asdict(gear) for name, gear in (("gear_1", pair.gear_1), ("gear_2", pair.gear_2))}
    held = "hubs on supports" if options.get("supports") else "bores held"
    return {
        "method": method,
        "width_mm": min(pair.gear_1.b, pair.gear_2.b),
        **gears,
        "a_mm": pair.a,
        "eps_alpha": pair.eps_alpha,
        "materials": [asdict(m) for m in materials],
        "stiffness": f"secant F / (loaded - unloaded transmission error), along the line of action, {held}",
        **options,
        "versions": {name: _version(name) for name in VERSIONS},
    }


def damage_of(cracks, pits):
    """Cracks and pits of pinion and wheel as tables, numbered by pair; empty without any."""
    if not any(cracks) and not any(pits):
        return {}
    return {
        name: [asdict(replace(d, tooth=sense * d.tooth)) for found in (cracks, pits) for d in found[i]]
        for i, (name, sense) in enumerate((("pinion", 1), ("wheel", -1)))
    }


@lru_cache(maxsize=16)
def _version(name):
    try:
        return version(name)
    except PackageNotFoundError:
        return "not installed"

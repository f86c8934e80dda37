"""Metadata of a stiffness curve: gears, materials, options and versions. No computation uses them."""

from dataclasses import asdict, replace

from ..core.case_parts import SIDES
from ..core.extras import installed_version

VERSIONS = ("gearfe", "numpy", "scipy", "scikit-fem", "gmsh")


def provenance(case, method, options):
    """Return `meta` of a `StiffnessCurve` without the force, from a `Case`, a method name and its `options`."""
    pair = case.pair
    gears = {name: asdict(gear) for name, gear in (("gear_1", pair.gear_1), ("gear_2", pair.gear_2))}
    on_supports = case.held is not None
    extras = {"damage": damage_of(case)} if case.damaged else {}
    if case.forms and case.flanks:
        extras["flanks"] = {name: asdict(flank) for name, flank in case.flanks.items() if flank}
    if case.misalignment is not None:
        extras["misalignment"] = asdict(case.misalignment)
    if on_supports:
        extras["supports"] = {name: asdict(held) for name, held in case.supports.items() if held}
    return {
        "method": method,
        "width_mm": pair.b_w,
        **gears,
        "a_mm": pair.a,
        "eps_alpha": pair.eps_alpha,
        "materials": [asdict(m) for m in case.materials],
        "stiffness": "secant F / (loaded - unloaded transmission error), along the line of action, "
        + ("hubs on supports" if on_supports else "bores held"),
        **options,
        **extras,
        "versions": versions(),
    }


def versions():
    """Versions of gearfe and of the libraries it computes with, by name."""
    return {name: installed_version(name) for name in VERSIONS}


def damage_of(case):
    """Return damage of pinion and wheel as tables with its kind, numbered by tooth pair."""
    return {
        name: [
            {"kind": hurt._nouns[0], **asdict(replace(hurt, tooth=sense * hurt.tooth))}
            for damages in (case.cracks, case.pits, case.broken)
            for hurt in damages[i]
        ]
        for i, (name, sense) in enumerate(SIDES)
    }

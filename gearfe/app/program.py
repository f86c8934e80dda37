"""Python program that reproduces the numbers of the live page."""

from dataclasses import fields
from typing import Any

from ..comparison.losses import damaged_teeth
from ..scene.load import Scene
from ..stiffness.solve import Solve

TEXT = """\
import numpy as np

import gearfe as gf

# {title}: lengths in mm, angles in rad, E in MPa, force in N along the line of action
pair = gf.GearPair(
    {one},
    {two},
    a={a!r},
)
run = dict(
    force={force!r},
    material={material},{options}
    method={method!r},
    phases={phases},{why}
)
{numbers}"""
HEALTHY = """\
healthy = gf.mesh_stiffness(pair, **run)
for zone, k in healthy.zones().items():
    print(f"{zone}: healthy {k / 1e6:.4g} N/um")
"""
DAMAGED = """\
damage = {damage}
healthy = gf.mesh_stiffness(pair, **run)
damaged = gf.mesh_stiffness(pair, damage=damage, **run)
for zone, k in healthy.zones().items():
    print(f"{{zone}}: healthy {{k / 1e6:.4g}} N/um, damaged {{damaged.zones()[zone] / 1e6:.4g}} N/um")
"""
SEVERAL = """\
damage = {damage}
cycles = {cycles}  # first phase of the mesh cycle in which each damaged tooth is in the middle, times {count}
for tooth, first in cycles.items():
    run["phases"] = (first + np.arange({count})) / {count}
    healthy = gf.mesh_stiffness(pair, **run)
    damaged = gf.mesh_stiffness(pair, damage=damage, **run)
    print(tooth)
    for zone, k in healthy.zones().items():
        print(f"{{zone}}: healthy {{k / 1e6:.4g}} N/um, damaged {{damaged.zones()[zone] / 1e6:.4g}} N/um")
"""


def program(scene: Scene, phases: int = 64, solid: int = 16) -> str:
    """Return a program that prints the zones of a scene's pair, healthy and damaged, as on the page."""
    chosen = scene.pair()
    pair, damage = chosen.pair, next(iter(chosen.damage.values()), {})
    case = chosen.case(next(iter(chosen.damage), None))
    method = Solve().chosen(case)[0].name
    count = solid if method == "ritz3d" else phases
    firsts = {one.words: round(one.phases(case, count)[0] * count) for one in damaged_teeth(case)}
    spelled, why, numbers = str(count), "", HEALTHY
    if len(firsts) == 1:
        spelled, why = f"({next(iter(firsts.values()))} + np.arange({count})) / {count}", "  # the damaged tooth in the middle"
        numbers = DAMAGED.format(damage=said(damage))
    elif damage:
        numbers = SEVERAL.format(damage=said(damage), cycles=firsts, count=count)
    options = {name: value for name in ("face", "groove", "flanks", "misalignment") if (value := getattr(chosen, name))}
    if method == "ritz" and options.get("face", "spur") != "spur":
        options.pop("face")
    return TEXT.format(
        title=" ".join(scene.title.split()), one=said(pair.gear_1), two=said(pair.gear_2), a=pair.a, force=chosen.force,
        material=said(chosen.materials), options="".join(f"\n    {name}={said(option)}," for name, option in options.items()),
        method=method, phases=spelled, why=why, numbers=numbers,
    )  # fmt: skip


def said(one: Any) -> str:
    """Return a value as source text. Arguments of gearfe's classes are omitted where they have their default.

    >>> from gearfe import Crack
    >>> said({"pinion": [Crack(length=2.0)]})
    "{'pinion': [gf.Crack(length=2.0)]}"
    """
    if isinstance(one, dict):
        return "{" + ", ".join(f"{name!r}: {said(value)}" for name, value in one.items()) + "}"
    if isinstance(one, list):
        return f"[{', '.join(map(said, one))}]"
    if isinstance(one, tuple):
        return f"({', '.join(map(said, one))}{',' if len(one) == 1 else ''})"
    if not hasattr(one, "__dataclass_fields__"):
        return repr(one)
    arguments = [(f.name, getattr(one, f.name)) for f in fields(one) if f.init and getattr(one, f.name) != f.default]
    return f"gf.{type(one).__name__}({', '.join(f'{name}={said(value)}' for name, value in arguments)})"

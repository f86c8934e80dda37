"""Gears solved by finite elements or in three dimensions, stored in this process or on disk (`gearfe.stiffness.disk`).

Finite elements are imported where they are used: scikit-fem takes 0.2 s to load, which the energy model does not need.
"""

from functools import partial

from ..flexibility.energy.ritz.solid import flexibility3d
from ..flexibility.solved import PROCESS, solved_gears, timed
from ..geometry.damage.crack import Crack, meshed_path
from ..geometry.damage.kinds import told
from .disk import file_of, kept_on_disk


def solved_gear(gear, material, cracks=(), *, cache=True, **options):
    """Return the flexibility of a gear's section by finite elements. A stored result is used if there is one.

    `gearfe.flexibility.solved.solved_gears` describes `cache`. With False the gear is solved again and nothing is stored.
    Files are used only together with the stored results of this process. `options` are those of
    `finite_elements.fe.damaged_flexibility`: broken, neighbours, state, refine, teeth.
    """
    from ..flexibility.finite_elements import fe

    kept = solved_gears(cache)

    def solve():
        if not (cracks or options.get("broken")):
            return timed(lambda: fe.flexibility(gear, material, **options))
        healthy = solved_gear(gear, material, cache=kept, **{name: value for name, value in options.items() if name != "broken"})
        return timed(lambda: fe.damaged_flexibility(gear, material, cracks, healthy, **options), healthy)

    case = (material, cracks, tuple(sorted(options.items())), tuple(sorted(fe.EDGES.items())))
    return kept_on_disk("section", gear, case, solve, kept)


def solved_solid(gear, material, damage=(), *, cache=True, tell=None, **options):
    """Return the `Flexibility3D` of a whole gear by finite elements. A stored result is used if there is one.

    `solved_gear` describes `cache`. `options` are those of `finite_elements.fe_gear3d.MeshedGear`: neighbours, degree, less,
    refine, section, shaft. `tell` gets one line of text before each solve with the gear, the unknowns, the expected seconds and
    memory.
    """
    from ..flexibility.finite_elements.fe_gear3d import MeshedGear, solid_flexibility

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

    return kept_on_disk("solid", gear, _solid_case(material, damage, options), solve, kept)


def solved_energy(gear, material, damage=(), *, cache=True, **options):
    """Return the `Flexibility3D` of a gear of finite width by the energy model. A stored result is used if there is one.

    `solved_gear` describes `cache`. `options` are those of `energy.ritz.solid.flexibility3d`: neighbours, order, axial, refine.
    """
    kept = solved_gears(cache)
    solve = partial(flexibility3d, gear, material, damage, cache=kept, **options)
    return kept_on_disk("energy", gear, _solid_case(material, damage, options), solve, kept)


def _solid_case(material, damage, options):
    return material, damage, tuple(sorted(options.items()))


def unsolved(gear, material, damage=(), *, cache=True, **options):
    """Return the costs (`finite_elements.solver.SolveCost`) of solves that `solved_solid` still requires, by key.

    RuntimeError, with the numbers, if one of them does not fit into memory.
    """
    from ..flexibility.finite_elements.fe_gear3d import MeshedGear

    key = ("solid", gear, *_solid_case(material, damage, options))
    kept = solved_gears(cache)
    if key in kept or (kept is PROCESS and (file := file_of(key)[0]) and file.exists()):
        return {}
    before = unsolved(gear, material, cache=kept, **options) if damage else {}
    return before | {key: MeshedGear(gear, damage, **options).plan()}


def clear():
    """Remove all results stored in this process. Files are kept."""
    PROCESS.clear()

"""Verb ``gearfe planetary``: a whole planetary set of a scene."""

from .progress import working
from .verbs import print_assumptions

FRAMES = 16  # frames of an animation per mesh cycle


def planetary_set(arguments):
    """Run ``gearfe planetary``."""
    from ...comparison.told_set import ENGAGED, set_headline, set_table, spread, told_set, told_span
    from ...figures.set_motion import check_moving
    from ...planetary_sets.animation import animate_planetary_set
    from ...planetary_sets.loaded_gears import check_meshable
    from ...planetary_sets.of_scene import build_set
    from ...planetary_sets.shape import plot_planetary_set
    from ...planetary_sets.solve import planetary_stiffness
    from ...scene.load import load_scene

    if arguments.animate is not None:
        check_moving(arguments.animate)
    scene = load_scene(arguments.scene)
    case = build_set(scene, arguments.case)
    if arguments.picture or arguments.animate:
        check_meshable(case)
    at, refine = spread(case, arguments.positions, arguments.cycles), arguments.refine
    with working("loads of all meshes"):
        healthy = planetary_stiffness(build_set(scene), at, refine=refine, error=False) if arguments.case else None
        found = planetary_stiffness(case, at, refine=refine)
    print(f"{scene.title}\n\n{set_headline(found, healthy)}\n\n{told_set(case)};\n{told_span(at)}\n\n{set_table(found)}")
    if healthy:
        print(f"\nthe same set healthy, {told_span(at)}\n\n{set_table(healthy)}")
    print_assumptions(scene, arguments.assumptions)
    if arguments.output:
        found.save(arguments.output)
    if arguments.plot:
        found.plot(arguments.plot)
    if arguments.picture:
        plot_planetary_set(found, 0, arguments.picture)
    if arguments.animate:
        with working("moving picture"):
            cycles = arguments.cycles or (ENGAGED if case.damage else 1)
            moving = planetary_stiffness(case, spread(case, FRAMES * cycles, cycles), refine=refine, error=False)
            animate_planetary_set(moving, arguments.animate)
    for path in filter(None, (arguments.output, arguments.plot, arguments.picture, arguments.animate)):
        print(f"written: {path}")

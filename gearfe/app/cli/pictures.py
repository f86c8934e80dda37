"""Verbs ``gearfe render`` and ``gearfe mesh``: stress, contact and meshes of one pair."""

from .progress import working
from .verbs import plot_title


def render(arguments):
    """Run ``gearfe render``."""
    from ...comparison.losses import damaged_teeth
    from ...comparison.pattern import render_pattern
    from ...comparison.root_iso import told_root
    from ...core.files import check_output
    from ...core.units import in_newton_per_um
    from ...scene.load import load_scene
    from ...strength.render import render_contact, render_stress

    if arguments.what != "stress":
        check_output(arguments.output, "picture")
    scene = load_scene(arguments.scene)
    case, title = scene.case(arguments.pair, arguments.case), plot_title(scene, arguments)
    first, *others = [one.words for one in damaged_teeth(case)] or [""]
    if others and arguments.phase is None:
        print(f"{first}; other phases (--phase) show {'; '.join(others)}")
    if arguments.what == "pattern":
        if arguments.phase is not None:
            raise ValueError("--what pattern shows a whole mesh cycle: leave out --phase, or use --what contact")
        with working("contact pattern"):
            print(render_pattern(case, arguments.output, title=title).told())
    elif arguments.what == "contact":
        with working("contact lines"):
            told = render_contact(case, arguments.output, phase=arguments.phase, title=title)
        print(f"phase {told['phase']:.4g}: k {in_newton_per_um(told['k'])} N/um, largest pressure {told['pressure']:.0f} MPa")
    else:
        with working("stress"):
            told = render_stress(case, arguments.output, refine=arguments.refine, phase=arguments.phase, title=title)
        print(told["text"])
        error = f", estimated error {told['root_error']:.0f} MPa" if "root_error" in told else ""
        print(f"largest von Mises stress on the fillets {told['root']:.0f} MPa{error}")
        for line in () if arguments.case else told_root(case):
            print(line)
    print(f"written: {arguments.output}")


def mesh(arguments):
    """Run ``gearfe mesh``."""
    from ...contact.bodies import seen_gears
    from ...decks.mesh_file import export_mesh
    from ...scene.load import load_scene

    if arguments.close_up and not arguments.picture:
        raise ValueError("--close-up belongs to a picture: give --picture FILE, too")
    case = load_scene(arguments.scene).case(arguments.pair, arguments.case)
    side = ("pinion", "wheel").index(arguments.gear)
    gear = case.pair.gears[side]
    if case.face == "herringbone":
        gear = seen_gears(case.pair, case.face, case.groove)[side][0]
    options = {"cells": arguments.cells, "teeth": arguments.teeth, "refine": arguments.refine}
    with working("mesh"):
        made = export_mesh(arguments.output, gear, (*case.cracks[side], *case.pits[side]), **options)
        if arguments.picture:
            from ...strength.mesh_picture import render_mesh

            render_mesh(made, arguments.picture, close_up=arguments.close_up)
    print(f"{arguments.gear}, z = {gear.z}: {made.points.shape[1]:,} nodes, {made.cells.shape[1]:,} cells")
    print(f"written: {arguments.output}" + (f", {arguments.picture}" if arguments.picture else ""))

"""Verbs for reports, new scenes, checks, frequencies, completion, and information on the computer."""

import os

from .progress import working

SPEEDS = 121  # number of speeds of a Campbell diagram


def report(arguments):
    """Run ``gearfe report``."""
    from ...reports.page import report as run

    if os.path.isdir(arguments.scene):
        from ...reports.sweep_page import sweep_report

        with working("report"):
            page = sweep_report(arguments.scene, arguments.output)
    else:
        with working("report"):
            page = run(arguments.scene, arguments.output, arguments.case, duration=arguments.duration)
    print(f"written: {page} ({page.stat().st_size / 1e6:.1f} MB)")


def new(arguments):
    """Run ``gearfe new``."""
    from ...scene.new import new_scene

    options = {"teeth": arguments.teeth, "module": arguments.module, "helix_deg": arguments.helix}
    options |= {"torque_Nm": arguments.torque, "crack": arguments.crack}
    amount, length = arguments.tip_relief or (None, None)
    options |= {"width": arguments.width, "ring": arguments.ring, "tip_relief_um": amount, "tip_length_mm": length}
    options |= {"alpha_deg": arguments.alpha, "x": tuple(arguments.x), "bore_mm": arguments.bore}
    file = new_scene(arguments.output, **options)
    print(f"written: {file}\n\n  gearfe check {file}\n  gearfe compare {file} --case cracked")


def check(arguments):
    """Run ``gearfe check``."""
    from ...comparison.check_scene import check_scene
    from ...comparison.scene_cost import told_cost
    from ...comparison.told_scene import told
    from ...figures.pair_plot import plot_pair
    from ...scene.load import load_scene

    drawn = arguments.picture is not None
    if not drawn and (arguments.pair or arguments.case):
        raise ValueError("--pair and --case select the drawn pair, but no picture is requested: add --picture FILE")
    scene = load_scene(arguments.scene)
    neglected = check_scene(scene)
    for line in (*told(scene), *neglected, told_cost(scene)):
        print(line)
    if drawn:
        chosen = scene.pair(arguments.pair)
        case = arguments.case or next(iter(chosen.damage), None)
        title = ", ".join((scene.name, arguments.pair or next(iter(scene.pairs)), case or "healthy"))
        plot_pair(chosen.case(case), path=arguments.picture, title=title)
        print(f"written: {arguments.picture}")


def lines(arguments):
    """Run ``gearfe lines``."""
    from ...comparison.printed_lines import printed_lines
    from ...dynamics.machine.lines import lines_table
    from ...scene.load import load_scene

    scene = load_scene(arguments.scene)
    table = lines_table(scene)
    print(f"{scene.title}\n\n{table.title}\n\n{table}")
    if printed := printed_lines(scene):
        print(f"\nvalues printed by the sources, and computed values\n\n{printed}")
    if arguments.output:
        table.save(arguments.output)
        print(f"written: {arguments.output}")
    if arguments.picture:
        from ...figures.train_plot import plot_train

        plot_train(scene, arguments.picture)
        print(f"written: {arguments.picture}")


def modes(arguments):
    """Run ``gearfe modes``."""
    import numpy as np

    from ...dynamics.machine.mode_words import critical_speeds, modes_table
    from ...dynamics.machine.of_scene import build_machine
    from ...scene.load import load_scene

    low, high = arguments.speeds
    if not 0 < low < high:
        raise ValueError(f"--speeds {low:g} {high:g}: give two increasing positive factors of the scene's speed")
    scene = load_scene(arguments.scene)
    with working("stiffness of the meshes"):
        machine = build_machine(scene, arguments.case)
    top = arguments.top or 3 * max(stage.mesh for stage in machine.stages)
    table, found = critical_speeds(machine, scene.machine["speed_rpm"], np.linspace(low, high, SPEEDS))
    print(f"{scene.title}\n\nnatural frequencies up to {top:.5g} Hz, mean mesh stiffness\n\n{modes_table(machine, top)}\n")
    print(f"critical speeds of the driving shaft\n\n{table}")
    if arguments.plot:
        from ...figures.campbell_plot import plot_campbell

        plot_campbell(found, arguments.plot)
        print(f"written: {arguments.plot}")


def schema(arguments):
    """Run ``gearfe schema``."""
    from ...scene.describe import json_schema, keys_page
    from ...scene.schema import scene_schema, schema_of

    print(keys_page(scene_schema(), schema_of("gearfe.runs")) if arguments.page else json_schema(scene_schema()))


def app(arguments):
    """Run ``gearfe app``."""
    from ..server import opened, serve

    start = arguments.scene and opened(arguments.scene, arguments.pair, arguments.case)
    names = ("port", "workers", "public", "users", "tasks")
    serve(start=start, browser=not arguments.no_browser, **{name: getattr(arguments, name) for name in names})


def completion(arguments):
    """Run ``gearfe completion``."""
    from .completion import script

    print(script(arguments.shell, arguments.verbs), end="")


def info(arguments):
    """Run ``gearfe info``."""
    from .machine_info import citation, lines

    for line in citation() if arguments.cite else lines():
        print(line)

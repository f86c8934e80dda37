"""Verbs around the computing: a page of a scene, a scene to start from, completion, what this machine has."""

import os

from .progress import working


def report(arguments):
    """``gearfe report``."""
    from ..files import check_output
    from ..reports.page import report as run

    check_output(arguments.output, "page")
    if os.path.isdir(arguments.scene):
        from ..reports.sweep_page import sweep_report

        with working("report"):
            made = sweep_report(arguments.scene, arguments.output)
    else:
        with working("report"):
            made = run(arguments.scene, arguments.output, arguments.case, duration=arguments.duration)
    print(f"written: {made} ({made.stat().st_size / 1e6:.1f} MB)")


def new(arguments):
    """``gearfe new``."""
    from ..scene.new import new_scene

    options = {"teeth": tuple(arguments.teeth), "module": arguments.module, "helix_deg": arguments.helix}
    made = new_scene(arguments.output, width=arguments.width, ring=arguments.ring, **options)
    print(f"written: {made}\n\n  gearfe check {made}\n  gearfe compare {made} --case cracked")


def check(arguments):
    """``gearfe check``."""
    from ..scene.load import load_scene
    from ..studies.told_scene import told

    for line in told(load_scene(arguments.scene)):
        print(line)


def completion(arguments):
    """``gearfe completion``."""
    from .completion import script

    print(script(arguments.shell, arguments.verbs), end="")


def info(arguments):
    """``gearfe info``."""
    from .machine_info import lines

    for line in lines():
        print(line)

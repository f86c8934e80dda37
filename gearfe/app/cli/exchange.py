"""Verbs for exchange with other programs and for crack growth."""

from pathlib import Path

from .progress import working


def import_file(arguments):
    """Run ``gearfe import``."""
    from ...core.files import written
    from ...exchange.rexs import import_rexs
    from ...scene.toml_file import toml

    out = Path(arguments.output or Path(arguments.file).with_suffix(".toml").name)
    if out.suffix != ".toml" or out.exists():
        said = "exists and is not overwritten" if out.exists() else "is not a .toml file"
        raise ValueError(f"{out} {said}: give another name with -o")
    unit = import_rexs(arguments.file, load_case=arguments.load_case)
    print(f"{unit.closing()}\n")
    for note in unit.scene.assumptions:
        print(f"assumed: {note['what']}, because {note['why']}")
    for text in unit.left_out:
        print(f"not read: {text}")
    with written(out) as name:
        Path(name).write_text(toml(unit.tables), encoding="utf-8")
    print(f"written: {out}\n\n  gearfe check {out}\n  gearfe compare {out}")


def export_file(arguments):
    """Run ``gearfe export``."""
    from ...exchange.exports import export

    scene_file, out = arguments.scene, arguments.output
    options = {name: getattr(arguments, name) for name in ("pair", "case", "gear", "method", "phases", "refine")}
    with working("export"):
        for line in export(scene_file, out, **options):
            print(line)
    print(f"written: {out}")


def grow(arguments):
    """Run ``gearfe crack``."""
    import math

    from ...figures.growth_plot import animate_growth, plot_growth
    from ...figures.set_motion import check_moving
    from ...geometry.tooth.slot import Slot
    from ...scene.load import load_scene
    from ...strength.crack_model import CrackModel
    from ...strength.growth import grow_crack, single_crack
    from ...strength.paris import ParisLaw

    case = load_scene(arguments.scene).pair(arguments.pair).case(arguments.case)
    found = single_crack(case)
    if found is None:
        raise ValueError(f"--case {arguments.case}: crack growth starts from one crack: choose a case with a single crack")
    side, crack = found
    if arguments.animate:
        check_moving(arguments.animate)
    law = ParisLaw(*arguments.paris, threshold=arguments.threshold) if arguments.paris else None
    held = arguments.held and [tuple(map(math.radians, arguments.held))]
    slots = [Slot(radius, width, *map(math.radians, ends)) for radius, width, *ends in arguments.slot or ()]
    model = CrackModel(arguments.method, arguments.loading, arguments.criterion, held, tuple(slots))
    options = {"step": arguments.step, "steps": arguments.steps, "refine": arguments.refine}
    with working("crack"):
        growth = grow_crack(case, crack, side, law=law, model=model, **options)
    if law:
        life, factor = growth.cycles[-1], arguments.scatter
        print(f"{life:.3g} revolutions; {life / factor:.3g} to {life * factor:.3g} if C differs by a factor of {factor:g}")
    print(growth)
    if arguments.output:
        growth.table().save(arguments.output)
        print(f"written: {arguments.output}")
    gear = case.pair.gears[side == "wheel"]
    if arguments.animate:
        animate_growth(growth, gear, arguments.animate)
        print(f"written: {arguments.animate}")
    if arguments.plot:
        plot_growth(growth, gear, arguments.plot)
        print(f"written: {arguments.plot}")

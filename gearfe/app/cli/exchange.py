"""Verbs that exchange gears with other programs."""

from pathlib import Path

from .progress import working


def import_file(arguments):
    """``gearfe import``."""
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
    """``gearfe export``."""
    from ...exchange.exports import export

    scene_file, out = arguments.scene, arguments.output
    options = {name: getattr(arguments, name) for name in ("pair", "case", "gear", "method", "phases", "refine")}
    with working("export"):
        for line in export(scene_file, out, **options):
            print(line)
    print(f"written: {out}")

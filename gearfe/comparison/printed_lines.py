"""Printed frequencies and radii of a scene's sources, compared with those of its machine and gears."""

from ..dynamics.machine.lines import scene_lines
from ..scene.load import Scene
from ..scene.verdicts import judge, text

ORDER = "order_of_"  # references of frequencies over the rotation of a named shaft


def printed_lines(scene: Scene) -> str:
    """Table of the printed orders and radii with their verdicts, as Markdown. The result is empty if the sources print none.

    Rows of a reference ``order_of_SHAFT`` name a line of `scene_lines`, such as ``"stage high, mesh frequency"``. Rows of
    ``radius`` name a gear and one of its radii, such as ``"sun, tip"``.
    """
    kept = [one for one in scene.references if one.id == "radius" or one.id.startswith(ORDER)]
    if not kept:
        return ""
    lines = {f"{line.part}, {line.name}": line.frequency for line in scene_lines(scene)}
    radii = {
        f"{name}, {which}": radius
        for name, gear in scene.gears.items()
        for which, radius in (("root", gear.r_f), ("base", gear.r_b), ("tip", gear.r_a))
    }
    rows = []
    for one in kept:
        shaft = lines.get(f"shaft {one.id.removeprefix(ORDER)}, shaft frequency")
        found = radii if shaft is None else {name: value / shaft for name, value in lines.items()}
        rows += judge(one, {row.case: found[row.case] for row in one.rows})
    return text(kept, rows)

"""The transverse outline of a gear with its damage as DXF (ezdxf) or SVG."""

from collections.abc import Sequence
from html import escape
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..core.extras import missing
from ..core.files import written
from ..geometry.aliases import Floats, StrPath
from ..geometry.damage.chip import Chip
from ..geometry.damage.kinds import Damage, parts_of
from ..geometry.damage.missing import MissingTooth
from ..geometry.mesh.outline import outline, stations
from ..geometry.tooth.gear import Gear
from ..geometry.tooth.profile import turned

FINE = 0.02  # largest distance of adjacent points [m_n]; the chord error is below 0.1 um per mm of module


class OutlineLines(NamedTuple):
    """Closed outline of the teeth and open lines of damage, ``(2, n)`` [mm], and the radius of the held edge."""

    teeth: Floats
    damage: list[Floats]
    held: float


def outline_lines(gear: Gear, damage: Sequence[Damage] = ()) -> OutlineLines:
    """Lines of a gear in its transverse section at z = 0. Tooth 0 points along y.

    Missing teeth and chips are not in the outline. Cracks, and pits and spalls over their height, are separate lines.
    """
    damage = parts_of(gear, damage)
    broken = [one for one in damage if isinstance(one, (MissingTooth, Chip))]
    size = FINE * gear.m_n
    teeth = outline(gear, {0: stations(gear, size)}, fillet_size=size, size=size, far_size=size, broken=broken)[0][:, ::2]
    lines = []
    for one in damage:
        if one not in broken:
            lines.append(turned(one.outline(gear), 2 * np.pi * one.tooth / gear.z))
    return OutlineLines(teeth, lines, gear.held)


def write_outline(path: StrPath, gear: Gear, damage: Sequence[Damage] = ()) -> None:
    """Write the transverse outline of a gear with its damage [mm], as ``.dxf`` or ``.svg``.

    A DXF file has the layers TEETH, HELD (bore or rim) and DAMAGE.

    Parameters
    ----------
    path : path
        Its suffix decides.
    gear : Gear
    damage : sequence of damage
        Of this gear, as in a `gearfe.Case`.

    Raises
    ------
    ValueError
        If the path has another suffix or cannot be written, or the damage is impossible on this gear.
    RuntimeError
        If ezdxf is missing; the message names what to install.
    """
    suffix = Path(path).suffix.lower()
    if suffix not in (".dxf", ".svg"):
        raise ValueError(f"{path}: an outline is .dxf or .svg")
    lines = outline_lines(gear, damage)
    with written(path) as name:
        if suffix == ".svg":
            Path(name).write_text(_svg(lines), encoding="utf-8")
        else:
            _dxf(lines).saveas(name)


def _dxf(lines):
    try:
        import ezdxf
    except ImportError as error:
        raise missing("ezdxf", error) from error
    drawing = ezdxf.new("R2010", units=4)  # unit code 4 is mm
    space = drawing.modelspace()
    for layer, colour in (("TEETH", 7), ("HELD", 5), ("DAMAGE", 1)):
        drawing.layers.add(layer, color=colour)
    space.add_lwpolyline(lines.teeth.T.tolist(), close=True, dxfattribs={"layer": "TEETH"})
    space.add_circle((0, 0), lines.held, dxfattribs={"layer": "HELD"})
    for line in lines.damage:
        space.add_lwpolyline(line.T.tolist(), dxfattribs={"layer": "DAMAGE"})
    return drawing


def _svg(lines):
    half = 1.02 * max(float(np.hypot(*lines.teeth).max()), lines.held)
    path = "M" + "L".join(f"{x:.6g},{-y:.6g}" for x, y in lines.teeth.T) + "Z"
    drawn = [f'<path d="{path}"/>', f'<circle r="{lines.held:.6g}"/>']
    drawn += [f'<path stroke="red" d="M{"L".join(f"{x:.6g},{-y:.6g}" for x, y in line.T)}"/>' for line in lines.damage]
    box = f"{-half:.6g} {-half:.6g} {2 * half:.6g} {2 * half:.6g}"
    look = f'fill="none" stroke="black" stroke-width="{half / 1000:.3g}"'
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{2 * half:.6g}mm" height="{2 * half:.6g}mm" viewBox="{escape(box)}">'
        f"<g {look}>{''.join(drawn)}</g></svg>\n"
    )

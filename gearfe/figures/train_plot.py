"""Picture of a gearbox from the side: shafts with their gears and bearings to scale, tooth numbers and speeds."""

import math
import os
from typing import TYPE_CHECKING

from ..core.files import save_figure
from .look import COLOURS, blank

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..scene.load import Scene


def plot_train(scene: "Scene", path: str | os.PathLike[str] | None = None, *, dpi: int = 120) -> "Figure":
    """Draw the shafts of a gearbox one below the other, along the flow of power. Save to `path` if given.

    Axes are drawn in one plane at their centre distances, whatever the directions of the pairs.

    Parameters
    ----------
    scene : Scene
        With a `train`.
    path : path, optional
    dpi : int
        Dots per inch of the picture.

    Raises
    ------
    ValueError
        If the scene has no gearbox.
    """
    if scene.train is None:
        raise ValueError(f"scene {scene.name} has no gearbox: give [machine] model = 'gearbox'")
    figure, axes = blank((9, 6))
    for name, (left, height) in _places(scene).items():
        shaft, at = scene.train.shafts[name], left
        for section in shaft.sections:
            _box(axes, at, height, section.length, section.diameter, COLOURS[0])
            at += section.length
        for place in shaft.bearings:
            axes.plot([left + place], [height - shaft.sections[0].diameter / 2], "^", color="black", markersize=7)
        for gear, place in shaft.gears.items():
            made = scene.gears[gear]
            _box(axes, left + place - made.b / 2, height, made.b, 2 * made.r_a, COLOURS[1])
            axes.annotate(f"{gear}\nz = {made.z}", (left + place, height), ha="center", va="center", fontsize=8)
        rpm = scene.train.speeds[name] * 30 / math.pi
        axes.annotate(f"{name}, {rpm:.5g} rpm", (left, height + shaft.sections[0].diameter / 2), va="bottom", fontsize=8)
    for stage in scene.train.stages.values():
        _planets(axes, scene, stage)
    axes.set(xlabel="position along the shafts [mm]", ylabel="[mm]", title=scene.title)
    axes.set_aspect("equal")
    axes.margins(0.15)
    return save_figure(figure, path, dpi)


def _box(axes, left, height, length, thick, colour):
    """Draw a cylindrical part as a rectangle, seen from the side."""
    from matplotlib.patches import Rectangle

    axes.add_patch(Rectangle((left, height - thick / 2), length, thick, facecolor=colour, edgecolor="black", alpha=0.5))
    axes.update_datalim([(left, height - thick / 2), (left + length, height + thick / 2)])
    axes.autoscale_view()


def _places(scene):
    """Return the axial position of the left end of each shaft, and the height of its axis [mm]."""
    train = scene.train
    out = {train.ends["motor"]["shaft"]: (0.0, 0.0)}
    for link in train.links:
        known, other = (link.one, link.two) if link.one in out else (link.two, link.one)
        left, height = out[known]
        if link.name in train.pairs:
            one, two, _ = train.pairs[link.name]
            ends = (one, two) if known == link.one else (two, one)
            left += train.shafts[known].gears[ends[0]] - train.shafts[other].gears[ends[1]]
            pair = scene.pair(link.name).pair
            height -= 0.0 if other in out else pair.a * (-1 if any(abs(height - pair.a - y) < 1 for _, y in out.values()) else 1)
        elif link.name in train.stages:
            stage = train.stages[link.name]
            sun = train.shafts[link.one].gears[stage.gears[0]]
            left += sun - stage.at if known == link.one else stage.at - sun
        else:
            left += train.shafts[known].length if known == link.one else -train.shafts[other].length
        out[other] = left, height
    return out


def _planets(axes, scene, stage):
    """Draw the planets above and below the sun, and the ring."""
    sun = stage.gears[0]
    left, height = _places(scene)[scene.train.homes[sun]]
    middle, planet = left + scene.train.shafts[scene.train.homes[sun]].gears[sun], scene.gears[stage.gears[1]]
    a, ring = scene.pair(stage.pairs[0]).pair.a, scene.gears[stage.gears[2]]
    for side in (1, -1):
        _box(axes, middle - planet.b / 2, height + side * a, planet.b, 2 * planet.r_a, COLOURS[2])
        rim = ring.r_rim - ring.r_a
        _box(axes, middle - ring.b / 2, height + side * (ring.r_a + rim / 2), ring.b, rim, COLOURS[3])
    told = f"{stage.n_planets} x z = {planet.z}\nring z = {ring.z}"
    axes.annotate(told, (middle, height + a), ha="center", va="center", fontsize=8)

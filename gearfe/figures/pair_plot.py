"""Drawing of a gear pair in mesh with its damage, to scale in the transverse section (matplotlib)."""

import math
import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..core.case import Case
from ..core.files import save_figure
from ..geometry.damage.kinds import Damage, by_side
from ..geometry.pair.gear_pair import GearPair
from ..geometry.tooth.drawing import outline_points
from ..geometry.tooth.profile import cartesian
from .look import COLOURS, GEARS, blank

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HURT = COLOURS[1]  # colour of damage
NEAR = 3.6  # half-height of the close-up [m_n]


def plot_pair(
    pair: GearPair | Case,
    damage: Mapping[str, Sequence[Damage]] | None = None,
    path: str | os.PathLike[str] | None = None,
    title: str = "",
) -> "Figure":
    """Draw both gears, and next to them the teeth in mesh with damage and the path of contact, to scale.

    The damaged tooth, or tooth 0, is in contact at the pitch point. For helical gears the transverse section is drawn.

    Parameters
    ----------
    pair : GearPair or Case
    damage : dict, optional
        Damage by gear, see `gearfe.mesh_stiffness`; default that of the case. Cracks of part of the width are drawn with their
        full length, pits over their height.
    path : path, optional
        Picture file; its suffix decides (png, svg, pdf).
    title : str
        Title: scene, pair, case.

    Raises
    ------
    ValueError
        If the damage is impossible on these gears.

    Examples
    --------
    >>> import math, gearfe as gf
    >>> rack = dict(m_n=2.0, alpha_n=math.radians(20), b=20.0)
    >>> pair = gf.GearPair(gf.Gear(z=21, r_bore=7.4, **rack), gf.Gear(z=31, r_bore=11.4, **rack))
    >>> figure = gf.plot_pair(pair, {"pinion": [gf.Crack(level=0.3)]})
    >>> [axes.get_aspect() for axes in figure.axes]
    [1.0, 1.0]
    """
    if isinstance(pair, Case):
        damage, pair = pair.damage if damage is None else damage, pair.pair
    by_gear = by_side(damage)
    tooth = next((hurt.tooth for damages in by_gear for hurt in damages), 0)
    pitch = pair.gear_1.r_b * math.tan(pair.alpha_wt)  # roll length at the pitch point
    turns = [float(turn) for turn in pair.turn(pitch - tooth * pair.p_bt)]
    figure, views = blank((10, 5.2), 1, 2)
    for i in (0, 1):
        _draw_gear(views, pair, i, turns[i], by_gear[i])
    along = np.array(pair.path) - pitch
    line = np.array([along * math.cos(pair.alpha_wt), pair.pitch_radius_1 + along * math.sin(pair.alpha_wt)])
    views[1].plot(*line, color="#222222", linestyle="--", linewidth=1.2, zorder=3, label="path of contact")
    for noun in sorted({hurt._nouns[0] for damages in by_gear for hurt in damages}):
        views[1].plot([], [], color=HURT, linewidth=2.5, label=noun)
    half = NEAR * pair.gear_1.m_n
    views[1].set(xlim=(-1.15 * half, 1.15 * half), ylim=(pair.pitch_radius_1 - half, pair.pitch_radius_1 + half))
    views[1].legend(loc="lower right")
    for axes in views:
        axes.set(aspect="equal", xlabel="[mm]", ylabel="[mm]")
        axes.grid(visible=False)
    rim = pair.gear_2.r_rim
    second = pair.centre_2 - (0.0 if rim is None else 0.5 * (pair.gear_2.r_f + rim))
    for name, height in (("pinion", 0.0), ("wheel" if rim is None else "ring", second)):
        views[0].text(0.0, height, name, ha="center", va="center", fontsize=9)
    views[0].set_title(f"{pair.gear_1.z} and {pair.gear_2.z} teeth, {pair.a:.5g} mm apart")
    seen = ", transverse section" if pair.gear_1.beta else ""
    views[1].set_title(f"the teeth in mesh{seen}; contact ratio {pair.eps_alpha:.2f}")
    figure.suptitle(title)
    return save_figure(figure, path, dpi=110)


def _draw_gear(views, pair, i, turn, damages):
    """Draw the outline of gear 1 (`i` = 0) or 2 (`i` = 1) with its damage."""
    gear = pair.gears[i]
    frame = _turned(turn) * [(1, pair.outward)[i], 1]  # The frame of a ring gear is mirrored.
    centre = [[0.0], [(0.0, pair.centre_2)[i]]]
    shapes = [frame @ points + centre for points in (outline_points(gear, points=24), _edge(gear))]
    ahead = (1, -1)[i] * 2 * math.pi / gear.z  # angle from a tooth to that of the next tooth pair [rad]
    for axes in views:
        _fill(axes, shapes, GEARS[i])
        for hurt in damages:
            line = frame @ _turned(ahead * hurt.tooth) @ hurt.outline(gear) + centre
            axes.plot(*line, color=HURT, linewidth=2.5, solid_capstyle="round", zorder=4)


def _turned(angle):
    """Return the matrix of a clockwise rotation."""
    return np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])


def _edge(gear):
    """Return bore or rim as a circle ``(2, n)`` [mm], opposite in direction to the teeth, so that the area between is filled."""
    radius = gear.r_rim if gear.internal else gear.r_bore
    return cartesian(np.full(181, radius), np.linspace(2 * math.pi, 0.0, 181))


def _fill(axes, shapes, colour):
    """Fill the area between closed outlines."""
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    points = np.hstack([np.hstack([shape, shape[:, :1]]) for shape in shapes])
    codes = [code for shape in shapes for code in (Path.MOVETO, *[Path.LINETO] * (shape.shape[1] - 1), Path.CLOSEPOLY)]
    axes.add_patch(PathPatch(Path(points.T, codes), facecolor=colour, edgecolor="#333333", linewidth=0.8))
    axes.autoscale_view()

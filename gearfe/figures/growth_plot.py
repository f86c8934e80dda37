"""Pictures (matplotlib) of a growing root crack: its path in the section, and the stress intensity over its length."""

import math
from typing import Any

import numpy as np

from ..core.files import save_figure, written
from ..geometry.aliases import StrPath
from ..geometry.damage.crack import crack_path
from ..geometry.tooth.drawing import outline_points
from ..geometry.tooth.gear import Gear
from ..geometry.tooth.profile import cartesian
from .look import COLOURS, blank

RATE = 4  # frames per second
ROOM = 1.2  # space around the tooth and the crack [modules]


def plot_growth(growth: Any, gear: Gear, path: StrPath | None = None) -> Any:
    """Draw the last step of a `gearfe.Growth` in its `gear`. Return the figure."""
    figure, show = _drawn(growth, gear)
    show(len(growth.cracks) - 1)
    return save_figure(figure, path, dpi=100)


def animate_growth(growth: Any, gear: Gear, path: StrPath) -> None:
    """Draw the steps of a `gearfe.Growth` in its `gear` as a .gif file."""
    from matplotlib.animation import PillowWriter

    figure, show = _drawn(growth, gear)
    writer = PillowWriter(fps=RATE)
    with written(path) as name:
        writer.setup(figure, name, 100)
        for i in range(len(growth.cracks)):
            show(i)
            writer.grab_frame()
        writer.finish()


def _drawn(growth, gear):
    """Return a figure of the gear without the crack, and a function that draws the crack of a given step."""
    figure, (body, curve) = blank((8.0, 3.6), 1, 2)
    circle = cartesian(gear.held, np.linspace(-math.pi, math.pi, 721))
    for loop in (outline_points(gear, points=24), circle, *(slot.outline(0.1 * gear.m_n) for slot in growth.slots)):
        body.fill(*loop, fill=False, edgecolor="0.3", linewidth=0.8)
    last = crack_path(gear, growth.cracks[-1])
    room, (low, high) = ROOM * gear.m_n, sorted((gear.r_a, gear.r_f))
    body.set(xlim=(last[0].min() - 2 * room, last[0].max() + 2 * room), aspect="equal")
    body.set(ylim=(min(low, last[1].min()) - room, max(high, last[1].max()) + room / 2))
    body.axis("off")
    curve.plot(growth.length, growth.K_I, color="0.7")
    curve.set(xlabel="length [mm]", ylabel="K_I [MPa sqrt(mm)]", xlim=(0, None), ylim=(0, None))
    (crack,), (point,) = body.plot([], [], color=COLOURS[1], linewidth=2), curve.plot([], [], "o", color=COLOURS[1])

    def show(i):
        crack.set_data(*crack_path(gear, growth.cracks[i]))
        point.set_data(growth.length[i : i + 1], growth.K_I[i : i + 1])
        after = "" if growth.cycles is None else f" after {growth.cycles[i]:.3g} revolutions"
        body.set_title(f"{growth.length[i]:.2f} mm{after}", fontsize=10)

    return figure, show

"""Animation of a loaded planetary set."""

import os
from pathlib import Path

from ..core.checks import whole
from ..core.record import ranged
from ..core.steps import part
from ..figures.set_motion import check_moving, draw_motion
from .curves import SetCurves
from .shape import loaded_shapes

MOST = 512  # largest number of frames


def animate_planetary_set(
    curves: SetCurves,
    path: str | os.PathLike[str],
    *,
    magnified: float | None = None,
    rate: int = 8,
    dpi: int = 80,
) -> Path:
    """Animate a loaded set, one frame per position. All gears are deformed and coloured by stress.

    The carrier is fixed, and the ring rotates with its pads. The animation repeats without a jump after one mesh cycle, or after
    one pitch of the pads for a ring on pads. `plot_planetary_set` describes the picture. All frames have the same magnification
    and colours.

    Parameters
    ----------
    curves : SetCurves
        As `planetary_stiffness` gives it, of a case that `plot_planetary_set` takes.
    path : path
        The file: ``.gif``.
    magnified : float, optional
        How many times as large displacements are drawn; default: so that the largest is seen.
    rate : int
        Frames in a second.
    dpi : int
        Dots per inch of a frame, which is 8 inches wide.

    Returns
    -------
    pathlib.Path
        The file.

    Raises
    ------
    ValueError
        If the set cannot be meshed gear by gear, the file cannot be written, or an argument is out of range.
    """
    check_moving(path)
    if magnified is not None:
        ranged("magnified", magnified, above=0.0)
    whole("rate", rate, 1)
    if curves.position.size > MOST:
        raise ValueError(f"{curves.position.size} positions are too many frames: give curves of at most {MOST}")
    with part("gears", 0.0, 0.3):
        positions = loaded_shapes(curves, range(curves.position.size))
    with part("frames", 0.3, 1.0):
        draw_motion(positions, path, magnified=magnified, rate=rate, dpi=dpi)
    return Path(path)

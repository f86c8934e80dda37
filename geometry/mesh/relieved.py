"""Meshed gears with modified flanks: the same mesh, bent.

Every node of a tooth turns about the gear's axis by ``C / r_b``, C the material removed at its radius and height: all of it on
the loaded flank, nothing on the other, linear in between, and fading from the form circle to the root. So no element is
distorted by more than the slope of C.
"""

from collections.abc import Callable, Iterable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..tooth.flank_form import FlankForm
from ..tooth.gear import Gear
from ..tooth.profile import cartesian
from .section_mesh import Section


def relieved(body: Section, form: FlankForm, order: np.ndarray, sense: int) -> Section:
    """The section with the loaded flanks of some teeth modified.

    Parameters
    ----------
    body : Section
    form : FlankForm
        Of its gear.
    order : ndarray of int
        Pairs whose teeth are modified.
    sense : int
        Tooth of pair k: 1 for the pinion (tooth k), -1 for the wheel (tooth -k).
    """
    points = body.mesh.doflocs.copy()
    for k in np.asarray(order).tolist():
        _turn_back(points, body.gear, sense * k, lambda roll, _, k=k: form.of(k).removed(roll) + form.shift(k))
    return replace(body, mesh=replace(body.mesh, doflocs=points))


def relieved_points(points: NDArray[np.float64], gear: Gear, form: FlankForm, teeth: Iterable[int]) -> NDArray[np.float64]:
    """Nodes ``(3, n)`` [mm] of a gear in its own frame, z from the end face at 0, with the loaded flanks of `teeth` modified."""
    out = points.copy()
    for tooth in teeth:

        def lost(roll, z, tooth=tooth):
            return form.at(z).removed(roll) + form.at(z).shift(np.full(roll.size, tooth))

        _turn_back(out, gear, tooth, lost)
    return out


def _turn_back(points: NDArray[np.float64], gear: Gear, tooth: int, lost: Callable[[NDArray, NDArray], NDArray]) -> None:
    """Turn the nodes of a tooth, ``(2, n)`` of a section or ``(3, n)``; `lost` is removed at roll lengths and heights [mm]."""
    radius = np.hypot(*points[:2])
    z = points[2] if len(points) == 3 else np.zeros(radius.size)
    centre = 2 * np.pi * tooth / gear.z + gear.twist_rate * z
    angle = (np.arctan2(points[0], points[1]) - centre + np.pi) % (2 * np.pi) - np.pi
    inside = np.flatnonzero((np.abs(angle) < np.pi / gear.z) & (gear.outward * (radius - gear.r_f) > 0))
    radius, angle = radius[inside], angle[inside]
    roll = np.sqrt(np.maximum(radius**2 - gear.r_b**2, 0.0))
    removed = lost(np.clip(roll, *sorted((gear.roll_f, gear.roll_a))), z[inside])
    inner = gear.outward * (radius - gear.r_form) < 0
    half = np.array([gear.half_thickness(r) for r in np.where(inner, gear.r_form, radius).tolist()])
    across = np.clip((angle / half + 1) / 2, 0.0, 1.0)
    fade = np.clip((radius - gear.r_f) / (gear.r_form - gear.r_f), 0.0, 1.0)
    points[:2, inside] = cartesian(radius, angle + centre[inside] - across * fade * removed / gear.r_b)

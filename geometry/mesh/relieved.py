"""A meshed gear section with modified flanks: the same mesh, bent."""

from dataclasses import replace

import numpy as np

from ..tooth.modified import FlankForm
from .section_mesh import Section


def relieved(body: Section, form: FlankForm, order: np.ndarray, sense: int) -> Section:
    """The section with the loaded flanks of some teeth modified.

    Every node of such a tooth turns about the gear's centre by ``C / r_b``, C the material removed at its radius: all of it on
    the loaded flank, nothing on the other (or as much with `both_sides`), linear in between, and fading from the form circle to
    the root. So no element is distorted by more than the slope of C.

    Parameters
    ----------
    body : Section
    form : FlankForm
        Of its gear.
    order : ndarray of int
        Pairs whose teeth are modified.
    sense : int
        Tooth of pair k: 1 for the pinion (tooth k), -1 for the wheel (tooth -k).

    Returns
    -------
    Section
    """
    gear, points = body.gear, body.mesh.doflocs.copy()
    radius = np.hypot(*points)
    for k in np.asarray(order).tolist():
        centre = 2 * np.pi * (sense * k) / gear.z
        angle = (np.arctan2(points[0], points[1]) - centre + np.pi) % (2 * np.pi) - np.pi
        inside = (np.abs(angle) < np.pi / gear.z) & (gear.outward * (radius - gear.r_f) > 0)
        roll = np.sqrt(np.maximum(radius[inside] ** 2 - gear.r_b**2, 0.0))
        least, most = sorted((gear.roll_f, gear.roll_a))
        removed = form.of(k).removed(np.clip(roll, least, most)) + form.shift(k)
        inner = gear.outward * (radius[inside] - gear.r_form) < 0
        half = np.array([gear.half_thickness(r) for r in np.where(inner, gear.r_form, radius[inside])])
        across = np.clip(angle[inside] / half, -1.0, 1.0)
        across = across if form.flank.both_sides else (across + 1) / 2
        fade = np.clip((radius[inside] - gear.r_f) / (gear.r_form - gear.r_f), 0.0, 1.0)
        turned = angle[inside] + centre - across * fade * removed / gear.r_b
        points[:, inside] = radius[inside] * np.array([np.sin(turned), np.cos(turned)])
    return replace(body, mesh=replace(body.mesh, doflocs=points))

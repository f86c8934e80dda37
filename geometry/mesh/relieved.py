"""Section mesh of a gear with modified flanks, made by displacement of nodes."""

from dataclasses import replace

import numpy as np

from ..tooth.modified import FlankForm
from .section_mesh import Section


def relieved(body: Section, form: FlankForm, order: np.ndarray, sense: int) -> Section:
    """Return the section with modified loaded flanks of some teeth.

    Every node of such a tooth is rotated about the gear's centre by ``C / r_b``, with the material C removed at its radius. The
    rotation is complete on the loaded flank and zero on the other flank (complete with `both_sides`), linear in between, and
    decreases from the form circle to the root. The distortion of elements is therefore at most the slope of C.

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
    points = body.mesh.doflocs.copy()
    for k in np.asarray(order).tolist():
        own, angle = form.of(k), 2 * np.pi * (sense * k) / body.gear.z
        bend(points, body.gear, angle, lambda roll, _, own=own, k=k: own.removed(roll) + form.shift(k), form.flank.both_sides)
    return replace(body, mesh=replace(body.mesh, doflocs=points))


def bend(points, gear, centre, removed, both_sides):
    """Rotate the nodes `points` ``(2 or 3, n)`` of a tooth about the axis, in place, by the material removed at their radius.

    `centre` is the angle of the tooth's centre-line [rad], a number or ``(n,)``. ``removed(roll, inside)`` returns the
    material removed [mm] at the roll lengths of the nodes `inside`, which belong to the tooth.
    """
    radius, angle = np.hypot(*points[:2]), np.arctan2(*points[:2])
    angle = (angle - centre + np.pi) % (2 * np.pi) - np.pi
    inside = np.flatnonzero((np.abs(angle) < np.pi / gear.z) & (gear.outward * (radius - gear.r_f) > 0))
    r, angle, centre = radius[inside], angle[inside], np.broadcast_to(centre, radius.shape)[inside]
    roll = np.clip(np.sqrt(np.maximum(r**2 - gear.r_b**2, 0.0)), *gear.flank_rolls)
    inner = gear.outward * (r - gear.r_form) < 0
    half = np.array([gear.half_thickness(one) for one in np.where(inner, gear.r_form, r).tolist()])
    across = np.clip(angle / half, -1.0, 1.0)
    across = across if both_sides else (across + 1) / 2
    fade = np.clip((r - gear.r_f) / (gear.r_form - gear.r_f), 0.0, 1.0)
    turned = angle + centre - across * fade * removed(roll, inside) / gear.r_b
    points[:2, inside] = r * np.array([np.sin(turned), np.cos(turned)])

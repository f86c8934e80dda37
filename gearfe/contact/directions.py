"""Directions of the contact forces on both gears.

A contact force acts along the common normal of both flanks. On the path of contact of involutes this is the line of action.
Elsewhere, and on modified flanks, the normal differs from it (by `geometry.tooth.flank_form.FlankForm.slope`). The force then has
another torque, and the tooth deflects along the normal and the tangent of its involute.
"""

from typing import NamedTuple

import numpy as np

from ..geometry.aliases import Floats
from ..geometry.pair.approach import approach
from ..geometry.tooth.side import side


class Direction(NamedTuple):
    """Directions of contact forces ``(n,)`` relative to the force F along the line of action (see `Contacts`).

    `rate`: closing speed for a unit approach, F over the force along the contact normal. `turns` ``(2, n)``: torque on pinion and
    wheel over that of the same F on the path. `parts` ``(2, 2, n)``: components of the force for a unit F on pinion and wheel,
    along the involute's normal and along the tangent away from the gear's centre.
    """

    rate: Floats
    turns: Floats
    parts: Floats


def met(contact, at, roll, host):
    """Return gap, contact point on the other gear [mm] and force `Direction` for points on one gear's profile.

    The force is normal to the other gear's profile. If one gear has an edge at the contact, give the points of that gear.

    Parameters
    ----------
    at : (ndarray of int, ndarray of int)
        Number of the phase and column of the pair of each place, shapes like that of `roll`.
    roll : ndarray
        Places on the side of the `host`, 0 the pinion, 1 the wheel [mm].
    host : int

    Returns
    -------
    gap, other : ndarray
        nan where nothing is met.
    direction : Direction
    """
    pair, points = contact.pair, contact.found
    options = {"start": points.gap[at], "flanks": contact.flanks, "order": points.order[at[1]]}
    gap, other, *forces = approach(pair, roll, points.nominal[at], driver=host == 0, **options)
    sense = 1 if host == 0 else -1
    arms, out = np.array(forces[:2][::sense]), np.array(forces[2:][::sense])
    rate = arms.mean(axis=0)
    parts = [_parts(*place) for place in zip(pair.gears, (roll, other)[::sense], arms, out, strict=True)]
    return gap, other, Direction(rate, arms / rate, np.array(parts) / rate)


def _parts(gear, roll, arm, out):
    """Return parts ``(2, n)`` of unit forces along the involute's normal and the tangent away from the centre (`Direction`)."""
    radius = side(gear, roll)[0]
    across = np.minimum(gear.r_b / radius, 1.0)
    inside = -gear.outward * np.sqrt(1 - across**2)  # radial component of the normal, positive outwards
    round_ = arm * gear.r_b / radius
    return np.array([round_ * across + out * inside, out * across - round_ * inside])


def leaning(contact, matrices):
    """Return flexibilities and torques of single contacts whose forces deviate from the involute normals (modified flanks).

    `matrices` are the smooth flexibilities ``(phases, pairs, pairs)`` of pinion and wheel between contacts along the involutes'
    normals [mm per N/mm].

    Returns
    -------
    matrices : list of ndarray
        Flexibility between the contacts along their actual normals [mm per N/mm].
    coefficient : ndarray, shape (phases, pairs)
        Coefficient of the half-plane logarithm [mm per N/mm].
    turns : ndarray, shape (2, phases, pairs)
        See `Direction`.
    """
    points, out = contact.found, []
    where = np.isfinite(points.gap)
    _, _, way = met(contact, where.nonzero(), points.roll_1[where], 0)
    # Otherwise no flank faces the pinion's point: the corner of the wheel touches, which is a row of hat functions.
    sure = np.isfinite(way.rate)
    where[where], way = sure, Direction(*(values[..., sure] for values in way))
    rate, turns, parts = np.ones(where.shape), np.ones((2, *where.shape)), np.zeros((2, 2, *where.shape))
    rate[where], turns[:, where], parts[:, 0], parts[:, :, where] = way.rate, way.turns, 1.0, way.parts
    log, diagonal = np.log(contact.pair.gear_1.m_n), np.arange(points.order.size)
    places = zip(contact.flexibility, contact.coefficients, matrices, points.rolls, (1, -1), turns, parts, strict=True)
    for flexible, coefficient, matrix, roll, sense, turn, (normal, tangent) in places:
        local, alone = coefficient * log, np.diagonal(matrix, axis1=1, axis2=2)
        total = turn[:, :, None] * turn[:, None] * matrix
        for k, order in enumerate(points.order.tolist()):
            leans = flexible.yields_across(roll[:, k], sense * order)
            smooth = alone[:, k] - local
            if leans is None:
                total[:, k, k] = turn[:, k] ** 2 * smooth
            else:
                across, along = leans
                total[:, k, k] = (
                    normal[:, k] ** 2 * smooth + 2 * normal[:, k] * tangent[:, k] * across + tangent[:, k] ** 2 * (along - local)
                )
        total[:, diagonal, diagonal] += local / rate**2
        out.append(total)
    return out, sum(contact.coefficients) / rate**2, turns

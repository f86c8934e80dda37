"""Tables over the mesh phase: impact-law coefficient, contact lines of helical gears, losses by pits, friction weights.

In all tables the damaged tooth is tooth 0 of the pinion. Phases are those of `gearfe.GearPair`.
"""

import math

import numpy as np

from ...flexibility.hertz import contact_modulus
from .contact_law import friction_coefficient
from .mesh_curves import Samples
from .phase_table import table

COUNT = 256  # phases in a cycle
SI = 1e3**1.5  # conversion of N/mm^1.5 to N/m^1.5


def engaged(pair, phase):
    """Phases ``(n, pairs)`` of all tooth pairs at mesh phases `phase`. Pairs off the path of contact have nan."""
    pair_phase = np.asarray(phase, dtype=float)[..., None] + np.arange(
        -math.ceil(pair.eps_alpha) - 1, math.ceil(pair.eps_alpha) + 2
    )
    pair_phase = pair_phase - np.floor(np.asarray(phase, dtype=float))[..., None]
    return np.where((pair_phase >= 0) & (pair_phase < pair.eps_alpha), pair_phase, np.nan)


def impact_cycle(pair, materials, *, lost=None):
    """Return the coefficient of ``F = K delta**1.5`` over a cycle: sum of ``4/3 sqrt(R) E*`` of all pairs [N/m^1.5].

    All pairs have the same deflection, each with the radius of curvature R at its contact. `lost` is the part of its contact
    line that the damaged tooth 0 has lost, as a function of its phase. With `lost`, the result is over the whole engagement of
    tooth 0.
    """
    # Phases are offset by half a step, because engagements end at whole steps.
    phase = _steps(pair.eps_alpha, lost) + 0.5 / COUNT
    pair_phase = engaged(pair, phase)
    first = np.abs(pair_phase - phase[:, None]) < 1e-9
    weight = 1.0 if lost is None else np.where(first, 1.0 - np.asarray(lost(phase))[:, None], 1.0)
    return Samples(phase, SI * np.nansum(weight * _hertz(pair, pair_phase, materials), axis=1))


def _steps(length, lost):
    """Return phases of a cycle.

    With `lost`, they cover the engagement of `length` cycles and an eighth of a cycle on either side.
    """
    return (np.arange(COUNT) if lost is None else np.arange(-COUNT // 8, math.ceil((length + 0.125) * COUNT))) / COUNT


def _hertz(pair, phase, materials):
    radius_1, radius_2 = pair.curvature_radii(phase)
    return 4 / 3 * np.sqrt(pair.relative_radius(radius_1, radius_2)) * contact_modulus(materials)


def contact_line(pair, phase, *, width=None):
    """Length of the contact line of one helical tooth pair [mm] at an array of phases.

    The line is on the flank at the phases ``0...eps_alpha + eps_beta``. The path of contact and the face width limit it.
    """
    width = width or pair.b_w
    over, slope = pair.eps_beta_of(width), math.cos(pair.gear_1.beta_b)
    low, high = np.maximum(np.asarray(phase, dtype=float) - over, 0.0), np.minimum(phase, pair.eps_alpha)
    return np.maximum(high - low, 0.0) / over * width / slope


def line_cycle(pair, coefficient, *, lost=None, width=None):
    """Coefficient of the impact law of a helical pair over a cycle [N/m^1.5].

    It is `coefficient` [N/mm^1.5] times the total length of the contact lines relative to its mean (contact-line-percentage
    method). The force on a pair is proportional to the length of its line. `impact_cycle` describes `lost`, here in mm.
    """
    width = width or pair.b_w
    total = pair.eps_alpha + pair.eps_beta_of(width)
    mean = pair.eps_alpha * width / math.cos(pair.gear_1.beta_b)
    phase = _steps(total, lost)
    around_it = phase[:, None] + np.arange(-math.ceil(total + 1 + phase.max()), math.ceil(total) + 2)
    length = contact_line(pair, around_it, width=width).sum(axis=1)
    if lost is not None:
        length = length - np.minimum(lost(phase), contact_line(pair, phase, width=width))
    return Samples(phase, SI * coefficient * length / mean)


def friction_weights(pair, speeds, *, static, dynamic, v_static, v_dynamic, count=512):
    """Weights of the three rows of `gearfe.dynamics.machine.layout.Layout.rubbing` over a cycle, as tables.

    The pairs in contact share the force equally. Each slips at ``speed_1 roll_1 + outward speed_2 roll_2``, without
    the vibration. `speeds` are those of both gears relative to the frame [rad/s], counter-clockwise positive.
    """
    phase = (np.arange(count) + 0.5) / count
    roll_1, roll_2 = (1e-3 * r for r in pair.curvature_radii(engaged(pair, phase)))
    slip = speeds[0] * roll_1 + pair.outward * speeds[1] * roll_2
    mu = friction_coefficient(slip, static=static, dynamic=dynamic, v_static=v_static, v_dynamic=v_dynamic)
    share = 1 / np.isfinite(slip).sum(axis=1, keepdims=True)
    whole = (np.nansum(share * mu * arm, axis=1) for arm in (np.ones_like(roll_1), roll_1, roll_2))
    grid = np.arange(count) / count
    return tuple(table(np.interp(grid, phase, values, period=1.0), 0.0, 1 / count, periodic=True) for values in whole)

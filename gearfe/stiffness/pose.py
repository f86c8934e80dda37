"""Pose of the loaded gears: mean pose (default of all methods), or rotation of one gear while the other is fixed."""

from dataclasses import replace

import numpy as np

from ..flexibility.section_contact import MARKS
from ..geometry.pair.modified import flank_contacts

SHIFT = {"mean": 0.0, "pinion": 0.5, "wheel": -0.5}  # phase shift relative to the approach over the base pitch
SETTLED, PART = 1e-7, 1e-3  # tolerance of the phase, absolute and relative to the shift by the elastic approach (for light loads)
LEAST = 1e-13  # smallest required change, above the rounding of a phase
MOST = 20  # largest number of solutions


def in_pose(curve_at, phase, pair, pose, flanks=None):
    """Return the curve for rotation of only one gear (`pose` ``pinion`` or ``wheel``), from curves in the mean pose.

    With the wheel fixed at its position at `phase` and the pinion rotated by an approach delta, both are in the mean pose at
    ``phase + delta / (2 p_bt)``. With the pinion fixed, it is ``phase - delta / (2 p_bt)`` (`geometry.pair.contacts`). Delta
    depends on the phase itself, so the shift is found by iteration at each phase. RuntimeError if it does not converge.

    `curve_at` maps phases ``(n,)`` to their `StiffnessCurve` in the mean pose. With modified `flanks`, one gear is also rotated
    without load until they touch.
    """
    shift = SHIFT[pose] / pair.p_bt
    at, curve = _settled(
        curve_at,
        phase,
        pose,
        lambda curve: shift * 1e3 * curve.te,
        lambda curve: np.clip(PART * abs(shift) * 1e3 * curve.deflection, LEAST, SETTLED),
    )
    if flanks is not None:
        least = _settled(lambda p: flank_contacts(pair, p, flanks=flanks).gap.min(axis=1), phase, pose, lambda gap: shift * gap)
        unloaded = least[1]
        deflection = curve.deflection + (curve.unloaded - unloaded * 1e-3)
        curve = replace(curve, deflection=deflection, unloaded=unloaded * 1e-3, k=curve.meta["force_N"] / deflection)
    meta = curve.meta | {"pose": pose}
    meta |= {name: phase[np.isin(at, meta[name])].tolist() for name in MARKS if name in meta}
    return replace(curve, phase=phase, meta=meta)


def _settled(solve, phase, pose, moved, enough=lambda found: LEAST):
    """Iterate ``at = phase + moved(solve(at))`` until it changes by less than `enough`. Return ``at`` and ``solve(at)``."""
    at = phase
    for _ in range(MOST):
        found = solve(at)
        target = phase + moved(found)
        if (np.abs(target - at) < enough(found)).all():
            return at, found
        at = target
    raise RuntimeError(f"the pose {pose!r} did not converge in {MOST} solves; lower the force, or use pose = 'mean'")

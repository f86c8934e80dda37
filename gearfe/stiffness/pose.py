"""Which gear an approach turns: the mean pose that every method solves in, or one gear against the held other."""

from dataclasses import replace

import numpy as np

SHIFT = {"mean": 0.0, "pinion": 0.5, "wheel": -0.5}  # of the phase, in approaches over the base pitch
SETTLED = 1e-7  # of a base pitch
MOST = 20


def check_pose(pose):
    """ValueError unless the pose is known."""
    if pose not in SHIFT:
        raise ValueError(f"pose = {pose!r}, but it must be one of {', '.join(SHIFT)}")


def in_pose(curve_at, phase, p_bt, pose):
    """Stiffness curve of gears of which only one turns, from curves in the mean pose.

    With the wheel held at its place at `phase` and the pinion turned by an approach delta, both stand as in the mean pose at
    ``phase + delta / (2 p_bt)``; with the pinion held, at ``phase - delta / (2 p_bt)`` (`geometry.pair.contacts`). Delta is the
    approach found there, so the shift is solved for, phase by phase.

    Parameters
    ----------
    curve_at : callable
        Maps phases ``(n,)`` to their `StiffnessCurve` in the mean pose.
    phase : ndarray, shape (n,)
    p_bt : float
        Transverse base pitch [mm].
    pose : {"pinion", "wheel"}

    Returns
    -------
    StiffnessCurve

    Raises
    ------
    RuntimeError
        If the shift does not settle.
    """
    at = phase
    for _ in range(MOST):
        curve = curve_at(at)
        wanted = phase + SHIFT[pose] * 1e3 * curve.lte / p_bt
        if np.abs(wanted - at).max() < SETTLED:
            break
        at = wanted
    else:
        raise RuntimeError(f"the pose {pose!r} did not settle in {MOST} solves; lower the force, or use pose = 'mean'")
    meta = curve.meta | {"pose": pose}
    if "crack_closed_phases" in meta:
        meta["crack_closed_phases"] = phase[np.isin(at, meta["crack_closed_phases"])].tolist()
    return replace(curve, phase=phase, meta=meta)

"""Which gear an approach turns: the mean pose that every method solves in, or one gear against the held other."""

from dataclasses import replace

import numpy as np

from ..flexibility.section_contact import MARKS

SHIFT = {"mean": 0.0, "pinion": 0.5, "wheel": -0.5}  # of the phase, in approaches over the base pitch
SETTLED = 1e-7  # of a base pitch
MOST = 20


def check_pose(pose):
    """ValueError unless the pose is known."""
    if pose not in SHIFT:
        raise ValueError(f"pose = {pose!r}, but it must be one of {', '.join(SHIFT)}")


def in_pose(curve_at, phase, pair, pose, flanks=None):
    """Stiffness curve of gears of which only one turns, from curves in the mean pose.

    With the wheel held at its place at `phase` and the pinion turned by an approach delta, both stand as in the mean pose at
    ``phase + delta / (2 p_bt)``; with the pinion held, at ``phase - delta / (2 p_bt)`` (`geometry.pair.contacts`). Delta is the
    approach found there, so the shift is solved for, phase by phase.

    Parameters
    ----------
    curve_at : callable
        Maps phases ``(n,)`` to their `StiffnessCurve` in the mean pose.
    phase : ndarray, shape (n,)
    pair : GearPair
    pose : {"pinion", "wheel"}
    flanks : (FlankForm, FlankForm), optional
        Modifications: without load, too, one gear is turned until flanks touch.

    Returns
    -------
    StiffnessCurve

    Raises
    ------
    RuntimeError
        If the shift does not settle.
    """
    shift = SHIFT[pose] / pair.p_bt
    at, curve = _settled(curve_at, phase, lambda curve: shift * 1e3 * curve.te, pose)
    if flanks is not None:
        _, unloaded = _settled(lambda p: pair.contacts(p, flanks=flanks).gap.min(axis=1), phase, lambda gap: shift * gap, pose)
        lte = curve.te - unloaded * 1e-3
        curve = replace(curve, lte=lte, unloaded=unloaded * 1e-3, k=curve.meta["force_N"] / lte)
    meta = curve.meta | {"pose": pose}
    meta |= {name: phase[np.isin(at, meta[name])].tolist() for name in MARKS if name in meta}
    return replace(curve, phase=phase, meta=meta)


def _settled(solve, phase, moved, pose):
    """Phases at which what is solved is as far from `phase` as `moved` says, and what is solved there."""
    at = phase
    for _ in range(MOST):
        found = solve(at)
        wanted = phase + moved(found)
        if np.abs(wanted - at).max() < SETTLED:
            return at, found
        at = wanted
    raise RuntimeError(f"the pose {pose!r} did not settle in {MOST} solves; lower the force, or use pose = 'mean'")

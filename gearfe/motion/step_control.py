"""The step of the fast path: what two runs of different steps differ by, and a step for which that is small.

The error of a step is set by the mesh cycles, by the modes the meshes excite, by how steep the stiffness curves are and by the
damaged tooth; no frequency alone tells it. So a short stretch of the motion is run at a step and at half of it, and the step
changed until both agree.
"""

import math

import numpy as np

from .fixed_step import fixed_steps
from .propagator import default_step, is_bent

WANTED, WANTED_OPEN = 7e-4, 5e-3  # of the range, while the meshes stay closed and where contact is lost
CYCLES = 3.5  # of the slowest mesh, in a stretch
HALVINGS = 6
SMOOTH, ROUGH = 1.2, 2.0  # error over the difference to half the step: of order four, and where local halving rules
TURNS = ("theta", "tilt_x", "tilt_y")


def difference(one, two):
    """Largest difference of two responses at the same times, relative to ranges of the second.

    Returns
    -------
    displacement : float
        Of any translation over the largest range of a translation, or of any rotation over that of a rotation.
    force : float
        Of any mesh force over its own range; forces that vary by less than a millionth of the largest do not count.
    """
    away, size = np.abs(one.q - two.q).max(axis=0), np.ptp(two.q, axis=0)
    turns = np.array([name.rpartition(".")[2] in TURNS for name in two.machine.dofs])
    kinds = [(away[kind].max(), size[kind].max()) for kind in (turns, ~turns) if kind.any()]
    displacement = max(float(error / limit) if limit else 0.0 for error, limit in kinds)
    if not two.machine.meshes:
        return displacement, 0.0
    force, reference = one.mesh(), two.mesh()
    size = np.ptp(reference, axis=0)
    size = np.where(size > 1e-6 * np.abs(reference).max(), size, np.inf)
    return displacement, float((np.abs(force - reference).max(axis=0) / size).max())


def stretch(machine, duration):
    """Start and length [s] of a stretch to tell the error on: `CYCLES` mesh cycles, with the worst damaged tooth among them."""
    rates = [abs(m.frequency) for m in machine.meshes if m.frequency]
    if not rates:
        return 0.0, min(duration, 1000 * default_step(machine))
    length = min(duration, CYCLES / min(rates))
    worst, start = 0.0, 0.0
    for mesh in machine.meshes:
        for (_, _, change), times in zip(mesh.changes, mesh.entries(duration) if mesh.frequency else (), strict=False):
            depth = np.abs(change.cells[:, 0]).max() / mesh.cycle.mean
            if times.size and depth > worst:
                worst, before = depth, 0.5 if mesh.frequency > 0 else CYCLES - 0.5
                start = times[0] - before / abs(mesh.frequency)
    return max(0.0, min(start, duration - length)), length


def chosen_step(machine, duration, initial=None, numba=None, *, adapt=False, watch=None):
    """Step of the fast path, no longer than `default_step`, whose error on a `stretch` is at most `WANTED` of the range.

    Where contact is lost on the stretch, `WANTED_OPEN`.

    Parameters
    ----------
    machine : Machine
    duration : float
        Of the whole run [s].
    initial : ndarray, shape (2n,), optional
        State from which the stretch starts; default: at rest.
    numba : bool, optional
    adapt : bool
        Of `gearfe.motion.fixed_step.fixed_steps`: the step is then the longest.
    watch : callable, optional
        Gets the seconds that a simulated second takes at each step tried; may raise.

    Returns
    -------
    dt : float
        [s]
    error : float
        Difference of displacements and mesh forces at half the step, the larger of `difference`, times `SMOOTH` or `ROUGH`.
    length : float
        Of the stretch [s].
    """

    def error(h):
        try:
            doubt, lost, _, cost = estimate(machine, duration, h, initial, numba, adapt=adapt)
        except RuntimeError:
            if h < 0.9 * low:
                raise
            return math.inf, False
        if watch is not None:
            watch(cost)
        return doubt, lost

    length = stretch(machine, duration)[1]
    h = min(default_step(machine), length)
    low = h / 2**HALVINGS
    doubt, lost = error(h)
    while doubt > (WANTED_OPEN if lost else WANTED) and h > low:
        h *= max(0.25, min(0.8, 0.9 * (WANTED / doubt) ** 0.25)) if not lost else 0.5
        doubt, lost = error(h)
    return h, doubt, length


def estimate(machine, duration, h, initial=None, numba=None, *, adapt=False):
    """Error of the step `h` on a `stretch`: the larger `difference` to a run at half the step, times `SMOOTH` or `ROUGH`.

    Returns
    -------
    error : float
    lost : bool
        Whether contact is lost there.
    length : float
        Of the stretch [s].
    cost : float
        Seconds for a simulated second at this step, from what the run at half of it took longer.
    """
    start, length = stretch(machine, duration)
    if initial is None:
        initial = np.concatenate([machine.rest(start), np.zeros(len(machine.dofs))])
    steps = math.ceil(length / h * (1 - 1e-12))
    options = {"numba": numba, "start": start, "adapt": adapt}
    one, two = (fixed_steps(machine, length, c * steps, initial, every=c, **options) for c in (1, 2))
    cost = max(two.stats["seconds"] - one.stats["seconds"], 0.0) / length
    return (ROUGH if adapt and is_bent(machine) else SMOOTH) * max(difference(one, two)), two.stats["losses"] > 0, length, cost

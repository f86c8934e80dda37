"""Machines with variable speed."""

from collections.abc import Sequence
from dataclasses import replace

from ...core.checks import numbers
from .speed import Speed
from .tables import Machine


def with_speed(machine: Machine, times: Sequence[float], factors: Sequence[float]) -> Machine:
    """Return the machine with variable speed: a run-up, a coast-down, or speed fluctuation.

    The phases of all meshes follow from the integrated speed, and so do damaged teeth, errors and the carrier. Loads have their
    own histories. Give the torque that belongs to the speed profile as ``(times, values)``, including the torque that
    accelerates the rotors, because the machine vibrates about the prescribed motion. Stiffness curves are those of one load.
    The weights of Coulomb friction are those of the nominal speed.

    Parameters
    ----------
    machine : Machine
    times : sequence of float
        [s]
    factors : sequence of float
        Speed over that of the machine at these times; straight between them.

    Returns
    -------
    Machine

    Raises
    ------
    ValueError
        If the times do not rise, or a factor is negative or not finite.

    Examples
    --------
    >>> import gearfe as gf
    >>> machine = gf.with_speed(gf.single_mesh(1.0, 1e8, 500.0), [0.0, 1.0], [0.2, 1.2])
    >>> float(machine.turned(1.0))  # the mean factor is 0.7
    0.7
    """
    return replace(
        machine, speed=Speed(tuple(numbers("times", times, " [s]").ravel()), tuple(numbers("factors", factors, "").ravel()))
    )

"""Differences of two runs of a machine at equal output times, relative to the ranges of the motion."""

from typing import NamedTuple

import numpy as np

from .response import acceleration, mesh_channels

TURNS = ("theta", "tilt_x", "tilt_y")


class Seen(NamedTuple):
    """Unfiltered quantities of two runs at the output times that are compared.

    Attributes
    ----------
    q : ndarray, shape (t, n)
        Displacements.
    force : ndarray, shape (t, m)
        Mesh forces.
    acceleration : ndarray, shape (t, n)
    """

    q: np.ndarray
    force: np.ndarray
    acceleration: np.ndarray


def seen(response):
    """Return the `Seen` quantities of a response."""
    machine, t, q, v = response.machine, response.time, response.q, response.v
    meshes = mesh_channels(machine, t, q, v)
    return Seen(q, meshes[2], acceleration(machine, t, q, v, meshes=meshes))


def differences(one, two, machine):
    """Largest differences of `Seen` of two runs at the same times, relative to ranges of the second.

    Returns
    -------
    displacement : float
        Difference of any translation relative to the largest range of a translation, or of any rotation relative to that of a
        rotation.
    force : float
        Difference of any mesh force relative to its range. Forces that vary by less than 1e-6 of the largest are ignored.
    acceleration : float
        The same for accelerations.
    """
    moved, shaken = (_by_kind(getattr(one, name), getattr(two, name), machine) for name in ("q", "acceleration"))
    if not machine.meshes:
        return moved, 0.0, shaken
    size = np.ptp(two.force, axis=0)
    size = np.where(size > 1e-6 * np.abs(two.force).max(), size, np.inf)
    return moved, float((np.abs(one.force - two.force).max(axis=0) / size).max()), shaken


def deviation(one, two):
    """Return the largest of the `differences` of displacements and mesh forces, and the largest of accelerations."""
    *moved, shaken = differences(seen(one), seen(two), two.machine)
    return max(moved), shaken


def _by_kind(one, two, machine):
    away, size = np.abs(one - two).max(axis=0), np.ptp(two, axis=0)
    turns = np.array([name.rpartition(".")[2] in TURNS for name in machine.dofs])
    kinds = [(away[kind].max(), size[kind].max()) for kind in (turns, ~turns) if kind.any()]
    return max(float(error / limit) if limit else 0.0 for error, limit in kinds)

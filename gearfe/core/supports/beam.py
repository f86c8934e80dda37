"""Straight round shafts with loads at a few positions: flexibilities of stepped Timoshenko beams and of torsion bars."""

import math
from typing import NamedTuple

import numpy as np


class ShaftPiece(NamedTuple):
    """A part of a shaft: its length, outside diameter and bore [mm]."""

    length: float
    diameter: float
    bore: float = 0.0

    @property
    def area(self) -> float:
        """Area of the cross section [mm**2]."""
        return math.pi / 4 * (self.diameter**2 - self.bore**2)

    @property
    def second_moment(self) -> float:
        """Second moment about a diameter [mm**4]. The polar one is twice as large."""
        return math.pi / 64 * (self.diameter**4 - self.bore**4)

    def shear_factor(self, nu: float) -> float:
        """Effective shear area over area for circles and tubes (G. R. Cowper, J. Appl. Mech. 33 (1966) 335-340)."""
        m = (self.bore / self.diameter) ** 2
        return 6 * (1 + nu) * (1 + m) ** 2 / ((7 + 6 * nu) * (1 + m) ** 2 + (20 + 12 * nu) * m)


def bending_flexibility(sections, material, bearings, stiffness, at):
    """Displacements and slopes at some positions by unit forces and moments at the same positions.

    Each piece between two positions is one exact element of a Timoshenko beam (J. S. Przemieniecki, Theory of Matrix Structural
    Analysis, 1968, section 5.6): there is no discretisation error.

    Parameters
    ----------
    sections : sequence of Section
    material : Material
    bearings : (float, float)
        Positions that are held across the axis [mm].
    stiffness : (float, float)
        Of the bearings [N/mm], inf: rigid.
    at : ndarray, shape (k,)
        Positions [mm].

    Returns
    -------
    ndarray, shape (2 k, 2 k)
        Displacements first, then slopes.
    """
    nodes, pieces = pieces_between(sections, [*bearings, *at])
    total = np.zeros((2 * nodes.size,) * 2)
    for i, (length, section) in enumerate(pieces):
        total[2 * i : 2 * i + 4, 2 * i : 2 * i + 4] += beam_element(length, section, material)
    free = np.ones(2 * nodes.size, dtype=bool)
    for place, hold in zip(bearings, stiffness, strict=True):
        row = 2 * _nearest(nodes, place)
        if math.isinf(hold):
            free[row] = False
        else:
            total[row, row] += hold
    wanted = np.array([2 * _nearest(nodes, place) for place in at])
    return _flexibility(total, free, np.concatenate([wanted, wanted + 1]))


def beam_element(length, section, material):
    """Stiffness ``(4, 4)`` of a piece between displacement and slope of its left and its right end."""
    bending = material.E * section.second_moment
    phi = 12 * bending / (section.shear_factor(material.nu) * material.shear_modulus * section.area * length**2)
    direct, cross = (4 + phi) * length**2, (2 - phi) * length**2
    part = np.array(
        [
            [12, 6 * length, -12, 6 * length],
            [6 * length, direct, -6 * length, cross],
            [-12, -6 * length, 12, -6 * length],
            [6 * length, cross, -6 * length, direct],
        ]
    )
    return bending / (length**3 * (1 + phi)) * part


def twist_flexibility(sections, material, held, at):
    """Twist ``(k, k)`` [rad] at positions `at` [mm] by unit torques there [N mm], for a shaft fixed at the position `held`."""
    nodes, pieces = pieces_between(sections, [held, *at])
    total = np.zeros((nodes.size,) * 2)
    for i, (length, section) in enumerate(pieces):
        stiff = material.shear_modulus * 2 * section.second_moment / length
        total[i : i + 2, i : i + 2] += stiff * np.array([[1, -1], [-1, 1]])
    free = np.arange(nodes.size) != _nearest(nodes, held)
    return _flexibility(total, free, np.array([_nearest(nodes, place) for place in at]))


def pieces_between(sections, places):
    """Return the positions of steps and `places` in rising order, and length and section of each piece between them."""
    ends = np.cumsum([0.0, *(section.length for section in sections)])
    nodes = np.unique(np.concatenate([ends, np.clip(places, 0.0, ends[-1])]))
    nodes = nodes[np.append(True, np.diff(nodes) > 1e-9 * ends[-1])]
    which = np.clip(np.searchsorted(ends, (nodes[1:] + nodes[:-1]) / 2) - 1, 0, len(sections) - 1)
    return nodes, [(float(step), sections[k]) for step, k in zip(np.diff(nodes), which, strict=True)]


def _nearest(nodes, place):
    return int(np.argmin(np.abs(nodes - place)))


def _flexibility(total, free, wanted):
    """Return the rows and columns `wanted` of the inverse of a stiffness. Unknowns that are not `free` are fixed."""
    inverse = np.zeros(total.shape)
    at = np.flatnonzero(free)
    inverse[np.ix_(at, at)] = np.linalg.inv(total[np.ix_(at, at)])
    flexibility = inverse[np.ix_(wanted, wanted)]
    return (flexibility + flexibility.T) / 2

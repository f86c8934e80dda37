"""Elastic bodies of both gears (or of their halves) and the flexibility between cells of the contact lines.

Heights are measured from the end that touches first. The roll length of the pinion decreases with the height, so that its helix
angle beta is negative here. In its own frame the wheel has the opposite angle; so has a ring, whose frame is mirrored.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from itertools import groupby, product
from typing import Any, NamedTuple

import numpy as np
from scipy.linalg import block_diag

from ..core.steps import steps
from ..flexibility.energy.ritz.solid import axial_degree, flexibility3d
from ..geometry.damage.crack import check_single
from ..geometry.damage.front import crack_in_band


def seen_gears(pair, face, groove):
    """Return ``[(Gear, offset [mm]), ...]`` for pinion and wheel, or for one half of each herringbone gear.

    The offset is the distance from the end face of the gear to the common face width.
    """
    out = []
    common = pair.b_w
    for gear, sense in ((pair.gear_1, -1), (pair.gear_2, 1)):
        width = (gear.b - groove) / 2 if face == "herringbone" else gear.b
        out.append((replace(gear, beta=sense * abs(gear.beta), b=width), (gear.b - common) / 2))
    return out


def seen_damage(gear, damage, seen, band):
    """Return the cracks and broken teeth of `gear` that lie within the width of the body `seen`.

    `band` (first, last) leads away from the end face of `gear` at which the body begins.
    """
    first, inwards = (0.0, 1.0) if band[0] < band[1] else (gear.b, -1.0)
    in_band = (crack_in_band(one, gear.b, first, first + inwards * seen.b) for one in damage)
    return tuple(one for one in in_band if one is not None)


class Bodies(NamedTuple):
    """Solver of the elastic bodies of gears: the energy model (`energy_bodies`), finite elements, or a user's model.

    - ``flexible(gear, material, damage, neighbours=n, **shaft)`` returns a `Flexibility3D`.
    - `coarser` (optional) is the same function with a coarser discretisation, for an error estimate.
    - ``ahead(wanted, neighbours=n)`` (optional) is called first, with the arguments of all later calls of `flexible`:
      ``[(arguments, shaft), ...]``.
    """

    flexible: Callable[..., Any]
    coarser: Callable[..., Any] | None = None
    ahead: Callable[..., Any] | None = None


def energy_bodies(order=3, axial=None, refine=1.0, cache=True, solve=flexibility3d):
    """`Bodies` by `energy.ritz.solid`. For the error estimate, section order and axial degree are lower.

    The axial degree is lower by a quarter, because a constant difference would underestimate the error of wide gears. `solve`
    has the arguments of `flexibility3d`.
    """

    def of(order, less):
        def flexible(gear, material, damage, neighbours):
            degree = axial_degree(gear.b, gear.m_n) if axial is None else axial
            degree -= max(2, round(degree / 4)) if less else 0
            options = {"order": order, "axial": degree, "refine": refine, "cache": cache}
            return solve(gear, material, damage, neighbours=neighbours, **options)

        return flexible

    return Bodies(of(order, False), of(order - 1, True))


def _check_cracks(case, gear, body, cracks, bands):
    """Raise ValueError unless each crack lies in a band, and each band has at most one crack on one side of a tooth."""
    for crack in cracks:
        if not any(seen_damage(gear, [crack], body, band) for band in bands):
            raise ValueError(f"crack open from z = {crack.width} mm: this is inside the relief groove of {case.groove:g} mm")
    for band in bands:
        check_single(body, seen_damage(gear, cracks, body, band))


def bodies_of(case, bands, flexible, ahead=None):
    """Return ``[[(Flexibility3D, offset [mm]), ...], ...]`` of both gears for each band. The contact begins at the offset.

    `Bodies` describes `flexible` and `ahead`, which gets the number of neighbours. `geometry.pair.lines.bands_of` makes `bands`.
    Gears that are one piece with their shaft get it as ``shaft``, seen from the end that touches first.

    Raises
    ------
    ValueError
        If a crack lies in the relief groove, or a body has two on one side of a tooth.
    """
    pair, shafts = case.pair, [held if held and held.integral else None for held in case.held or (None, None)]
    seen = seen_gears(pair, case.runs, case.groove)
    gears = list(zip(pair.gears, seen, case.materials, case.cracks, case.broken, shafts, strict=True))
    for gear, (body, _), _, own, _, _ in gears:
        _check_cracks(case, gear, body, own, bands)
    wanted = [
        [
            ((body, material, seen_damage(gear, own + broken, body, band)), _as_seen(shaft, band), offset)
            for gear, (body, offset), material, own, broken, shaft in gears
        ]
        for band in bands
    ]
    if ahead:
        ahead([(arguments, held) for own in wanted for arguments, held, _ in own])
    return [[(flexible(*arguments, **held), offset) for arguments, held, offset in steps(own)] for own in steps(wanted)]


def _as_seen(shaft, band):
    return {} if shaft is None else {"shaft": shaft if band[0] < band[1] else shaft.turned()}


def between(cells, bodies):
    """Compute the approach ``(n, n)`` of the `Cells` of each phase per unit normal force on each, without half-space [mm/N].

    `bodies` are those of `bodies_of`.
    """
    out = [np.zeros((group.z.size,) * 2) for group in cells]
    order, half, depth, *rolls = (
        np.concatenate([getattr(group, name) for group in cells]) for name in ("order", "half", "depth", "roll_1", "roll_2")
    )
    start = np.cumsum([0, *(group.z.size for group in cells)])
    phase = np.repeat(np.arange(len(cells)), np.diff(start))
    new = np.append(True, (np.diff(half) != 0) | (np.diff(order) != 0) | (np.diff(phase) != 0))
    ends = np.append(np.flatnonzero(new), new.size).tolist()
    for number, gears in enumerate(bodies):
        group = [(a, b) for a, b in zip(ends[:-1], ends[1:], strict=True) if half[a] == number]
        for (body, offset), sense, roll in zip(gears, (1, -1), rolls, strict=True):
            lines = [_Line(int(phase[a]), sense * int(order[a]), slice(a, b), int(start[phase[a]])) for a, b in group]
            _add(out, body, body.basis(roll, depth + offset, sense * order), lines)
    return [(matrix + matrix.T) / 2 for matrix in out]


class _Line(NamedTuple):
    """Cells of one tooth in one phase: the slice `at` of all cells. `start` is the number of the phase's first cell."""

    phase: int
    tooth: int
    at: slice
    start: int

    @property
    def own(self):
        """The slice `at`, counted from the first cell of the phase."""
        return slice(self.at.start - self.start, self.at.stop - self.start)


def _add(out, body, rows, lines):
    """Add the flexibility of one body at the cells of all phases to `out`. `rows` are its basis functions at all cells."""
    pairs = {}
    for _, group in groupby(lines, lambda line: line.phase):
        for lower, upper in product(list(group), repeat=2):
            if lower.tooth <= upper.tooth:
                pairs.setdefault((lower.tooth, upper.tooth), []).append((lower, upper))
    for (first, second), couples in pairs.items():
        kernel = body.between(first, second)
        if kernel is None:
            continue
        left = np.concatenate([rows[lower.at] for lower, _ in couples]) @ kernel
        ends = np.cumsum([lower.at.stop - lower.at.start for lower, _ in couples])[:-1]
        for (lower, upper), weighted in zip(couples, np.split(left, ends), strict=True):
            approach = weighted @ rows[upper.at].T
            out[lower.phase][lower.own, upper.own] += approach
            if first != second:
                out[lower.phase][upper.own, lower.own] += approach.T


def mirrors_of(cells, bodies):
    """Return the images in the end faces of both bodies: weight of the mirrored loads [mm**2/N], distances of the cells [mm].

    The result is ``[(weight, near ends (n,), far ends (n,)), ...]``. The distances are those of the ends of the cells from the
    end face, along the lines.
    """
    faces = {}
    for side, far in ((False, False), (False, True), (True, False), (True, True)):
        low, high, weight = np.zeros(cells.z.size), np.zeros(cells.z.size), 0.0
        for half in np.unique(cells.half).tolist():
            at, (body, offset) = cells.half == half, bodies[half][side]
            ends = [cells.depth[at] + offset + sign * cells.width[at] / 2 for sign in (-1, 1)]
            low[at], high[at] = (np.array(ends) if not far else body.gear.b - np.array(ends[::-1])) / math.cos(body.gear.beta_b)
            weight, place = body.edge, (far, offset, body.gear.b)  # The end faces of gears with equal width are flush.
        faces[place] = (weight + faces.get(place, (0.0,))[0], low, high)
    return list(faces.values())


def faces_of(cells, bodies):
    """Return the crack faces of all bodies in the form of `joined_lines.System`, or None without cracks.

    Returns
    -------
    (ndarray (m, n), ndarray (m, m), ndarray (m,)) or None
        Opening of the crack faces under unit normal forces on the cells, opening under unit forces that push the faces
        apart [mm/N], and the half of the gear of each face.
    """
    rows, influences, halves = [], [], []
    for half in np.unique(cells.half).tolist():
        at = np.flatnonzero(cells.half == half)
        for (body, offset), sense, roll in zip(bodies[half], (1, -1), cells.rolls, strict=True):
            if body.seam is not None and body.seam.influence.size:
                row = np.zeros((body.seam.influence.shape[0], cells.z.size))
                row[:, at] = body.opening(sense * cells.order[at], roll[at], cells.depth[at] + offset)
                rows.append(row)
                influences.append(body.seam.influence)
                halves.append(np.full(row.shape[0], half))
    return (np.concatenate(rows), block_diag(*influences), np.concatenate(halves)) if rows else None

"""Pads under the rim of a ring: their tractions as forces on its mesh, and flexibility between pads and teeth."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from ..flexibility.finite_elements.elasticity import GAUSS_3
from ..flexibility.hertz import half_plane, hat_logarithm
from ..geometry.aliases import Floats
from .rim_supports import RimSupports
from .whole_gear import PLACES, WholeGear

TERMS = 10  # number of polynomials on a pad, radial and tangential
POINTS = 64  # quadrature points of the polynomials
FINE = 400  # quadrature points where a polynomial has a jump
SPREAD = 3  # half-width of the hat function that distributes a traction on the mesh [rim edges]


@dataclass(frozen=True, slots=True)
class Pads:
    """Tractions of pads on the rim, p in total by pad, direction and polynomial.

    `load` ``(z, r, p)`` are the nodal forces of unit tractions, distributed over several edges. `close` is the same on the
    edges under the pad only. `turns` ``(3, p)`` are their forces along x and y and their clockwise torque [mm]. `compliance`
    ``(p, p)`` is added to the flexibility of the rim's mesh under them [mm per N/mm]. It contains springs and the local
    deflection near each pad. `WholeGear.loose_inverse` describes `moved`, the displacements of the edge by harmonic.
    """

    load: Floats
    close: Floats
    turns: Floats
    compliance: Floats
    moved: NDArray[np.complex128]


def pads_on(whole: WholeGear, support: RimSupports, width: float, moved: NDArray[np.complex128]) -> Pads:
    """Return the `Pads` of a ring. The face `width` [mm] shares their stiffness. `Pads` describes `moved`."""
    gear, z, nodes = whole.gear, whole.gear.z, whole.angle.size
    step = 4 * math.pi / (z * nodes)  # angle of a rim edge
    terms = 1 if support.pushes else TERMS
    place = np.cos((np.arange(POINTS) + 0.5) * math.pi / POINTS)
    shapes = chebyshev.chebvander(place, terms - 1) / POINTS
    stiff = (support.radial, support.tangential)
    held = [which for which in (0, 1) if stiff[which] > 0]
    hats = [_hat(which, step, z * nodes) for which in (0, 1)]
    columns, close, turns, compliance, local = [], [], [], [], []
    for middle in support.middles:
        angle = middle + place * support.width / (2 * gear.held)
        at = (angle + math.pi / z) / step  # position from the first corner [rim edges]
        number = np.arange(math.floor(at.min()), math.floor(at.max()) + 2)
        weight = np.maximum(1 - np.abs(number[:, None] - at), 0.0) @ shapes
        out, inx = np.sin(angle), np.cos(angle)
        force = np.array([out, inx, 0 * angle]), np.array([inx, -out, np.full(angle.size, gear.held)])
        for which in held:
            hat = zip(number.tolist(), weight, strict=True)  # two unknowns at every second node (the vertices) under the pad
            columns.append(sum(np.roll(hats[which], 4 * n)[:, None] * row for n, row in hat))
            close.append(_nodal((angle + math.pi / z) % (2 * math.pi), which, step / 2, z * nodes) @ shapes)
            turns.append(force[which] @ shapes)
            compliance.append(np.append(width / stiff[which], np.zeros(terms - 1)))
        edge = step * gear.held
        local.append(_sharper(whole, support.width, number * edge, edge, weight)[np.ix_(held, held)])
    p = len(held) * terms
    total = np.zeros((support.count * p,) * 2)
    for k, pad in enumerate(local):
        total[k * p : (k + 1) * p, k * p : (k + 1) * p] = pad.transpose(0, 2, 1, 3).reshape(p, p)
    load, own = (np.concatenate(values, axis=1).reshape(z, 2 * nodes, -1) for values in (columns, close))
    return Pads(load, own, np.concatenate(turns, axis=1), total + np.diag(np.concatenate(compliance)), moved)


def _hat(which, step, count):
    """Return forces ``(2 count,)`` on rim nodes by a unit hat of traction on the first node, radial (0) or tangential (1)."""
    points, weights = GAUSS_3
    edges = np.arange(-SPREAD, SPREAD)
    angle = step * (edges[:, None] + (points + 1) / 2)
    share = (1 - np.abs(angle) / (SPREAD * step)) * weights / (2 * SPREAD)
    return _nodal(angle.ravel(), which, step / 2, count) @ share.ravel()


def _nodal(angle, which, step, count):
    """Return forces ``(2 count, n)`` on rim nodes, radial and tangential, of unit forces at `angle` from the first node."""
    edge = np.floor(angle / (2 * step)).astype(int)
    t = angle / step - 2 * edge - 1
    shapes = np.array([t * (t - 1) / 2, 1 - t**2, t * (t + 1) / 2])
    out, column = np.zeros((2 * count, angle.size)), np.arange(angle.size)
    for a, shape in enumerate(shapes):
        lean = angle - step * (2 * edge + a)
        parts = (np.cos(lean), np.sin(lean)) if which == 0 else (-np.sin(lean), np.cos(lean))
        for direction, part in enumerate(parts):
            np.add.at(out, (2 * ((2 * edge + a) % count) + direction, column), shape * part)
    return out


def _sharper(whole, width, tops, edge, weight):
    """Return the motion of a pad under its tractions minus that under hat functions ``(2, 2, terms, terms)`` [mm per N/mm].

    The two differ only near the pad, where the rim is a half-plane. On a half-plane, tractions ``T_n(s) / (pi sqrt(1 -
    s**2))`` move the surface along themselves by c ``ln(4 / width)`` (n = 0) or ``c T_n(s) / n``, and across themselves by the
    jump of Flamant's field.
    """
    terms, material = weight.shape[1], whole.material
    knots = tops + SPREAD * edge * np.array([[-1], [0], [1]])
    along = np.append(math.log(4 / width), 1 / (2 * np.arange(1, terms)))
    direct = half_plane(material) * (np.diag(along) - weight.T @ hat_logarithm(knots, knots) @ weight)
    modulus, ratio = material.plane_modulus("plane strain"), material.nu / (1 - material.nu)
    angle, order = (np.arange(FINE) + 0.5) * math.pi / FINE, np.arange(1, terms)
    ahead = np.column_stack([1 - 2 * angle / math.pi, -2 * np.sin(angle[:, None] * order) / (math.pi * order)])
    jump = np.cos(angle[:, None] * np.arange(terms)).T @ ahead / FINE
    masses = np.array([1.0, -2.0, 1.0]) / (SPREAD * edge) ** 2  # second derivative of a unit hat function
    apart = knots[:, :, None, None] - knots
    spread = np.einsum("p,pnqm,q->nm", masses, np.sign(apart) * apart**4 / 24, masses)
    across = -(1 - ratio) / (2 * modulus) * (jump - weight.T @ spread @ weight)
    return np.array([[direct, across], [across.T, direct]])


def _series(load):
    """Return the harmonics ``(h, r, p)`` of nodal forces ``(z, r, p)``."""
    return np.fft.rfft(load, axis=0)


def among(pads):
    """Return the displacements ``(p, p)`` of pads under the tractions of all pads [mm per N/mm]."""
    z, waves = pads.load.shape[0], _series(pads.load)
    r = waves.shape[1]
    weight = np.full(waves.shape[0], 2.0)
    weight[0] = 1.0
    if z % 2 == 0:
        weight[-1] = 1.0
    out = np.einsum("h,hrp,hrs,hsq->pq", weight, waves.conj(), pads.moved[:, :, -r:], waves, optimize=True).real / z
    return (out + out.T) / 2


def by_teeth(pads):
    """Return the displacements ``(p, z, PLACES)`` of pads under loads on the teeth [mm per N/mm]."""
    z, waves = pads.load.shape[0], _series(pads.load)
    spectrum = np.einsum("hrp,hra->hpa", waves.conj(), pads.moved[:, :, :PLACES], optimize=True)
    return np.fft.irfft(spectrum.conj(), n=z, axis=0).transpose(1, 0, 2)

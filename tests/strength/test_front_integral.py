"""Stress intensities along a front, by the interaction integral: elliptic cracks with closed and with published solutions."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.special import ellipe
from usual import STEEL

from gearfe.flexibility.finite_elements.hexahedron import face_shapes
from gearfe.flexibility.finite_elements.solid_assembly import assemble
from gearfe.flexibility.finite_elements.solver import factor, plan
from gearfe.geometry.mesh.solid import HEX
from gearfe.strength.crack_front import SHALLOW, TUBE
from gearfe.strength.front_integral import front_intensity

WIDEST = TUBE[1] * SHALLOW  # tube around a front that runs out, as in gears: in the largest depth, which is 1
CORNERS = ((0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1))  # of a quad in (across the front, along it)
HOLE = 1e-3  # its radius, in crack lengths
BLEND = 1.6  # from that many crack lengths on, lines run over into the block's outline


def graded(first, ratio, largest, end):
    """Places from 0 to `end`, further and further apart."""
    out, step = [0.0], first
    while out[-1] < end:
        out.append(out[-1] + step)
        step = min(step * ratio, largest)
    return np.array(out) * end / out[-1]


class Quarter:
    """Upper half of a quarter of a block with a crack in its base, ``(x / c)**2 + (y / a)**2 < 1``, pulled at its top.

    The block reaches to x = `wide`, y = `deep`, z = `tall`. Its wall at x = 0 is one of symmetry, that at y = 0 too, or free.
    """

    def __init__(self, a, c, deep, wide, tall, *, pieces, tip=0.02):
        self.a, self.c, self.tall = a, c, tall
        self.phi = np.linspace(0, math.pi / 2, pieces + 1)
        far = max(deep / a, wide / c) - BLEND  # the lines end on a thin hole along the axis, which leaves the tension as it is
        inner, outer = 1 - graded(tip, 1.5, 0.35, 1.0)[::-1], 1 + graded(tip, 1.5, 0.35, BLEND - 1)[1:]
        inner[0] = HOLE
        across = np.concatenate([inner, outer, BLEND + graded(0.35, 1.5, 3.0, far)[1:] / far])
        lines = across, self.phi, graded(tip * a, 1.5, 3.0 * a, tall)
        r, p, z = (np.interp(np.arange(2 * len(v) - 1) / 2, np.arange(len(v)), v) for v in lines)
        number = np.arange(r.size * p.size * z.size).reshape(r.size, p.size, z.size)
        i, j, k = (v.ravel() for v in np.meshgrid(*(np.arange(0, v.size - 2, 2) for v in (r, p, z)), indexing="ij"))
        cells = np.array([number[i + CORNERS[q][0], j + CORNERS[q][1], k + level] for q, level in HEX])
        r, p, z = np.meshgrid(r, p, z, indexing="ij")
        used, self.cells = np.unique(cells, return_inverse=True)
        self.cells = self.cells.reshape(cells.shape)
        part, half = np.clip(r - BLEND, 0, 1), math.pi / 4
        x = (1 - part) * np.minimum(r, BLEND) * c * np.cos(p) + part * np.where(p < half, wide, wide * (2 - p / half))
        y = (1 - part) * np.minimum(r, BLEND) * a * np.sin(p) + part * np.where(p < half, deep * p / half, deep)
        self.points = np.array([v.ravel()[used] for v in (x, y, z)])
        self.ligament = np.isin(used, number[2 * (inner.size - 1) :, :, 0])
        self.top = np.array([number[i + CORNERS[q][0], j + CORNERS[q][1], -1] for q in range(8)])[:, k == 0]
        self.top = np.searchsorted(used, self.top)

    def pulled(self, *, free_surface):
        """Displacements ``(3, n)`` under unit stress."""
        held = np.zeros(self.points.shape, dtype=bool)
        held[0] = np.abs(self.points[0]) < 1e-9
        held[2] = self.ligament
        held[1] = np.abs(self.points[1]) < 1e-9
        if free_surface:
            held[1] = held[0] & (self.points[1] > self.points[1].max() - 1e-9) & (self.points[2] > self.tall - 1e-9)
        matrix = assemble(self.points, self.cells, STEEL, np.arange(self.points.shape[1]))
        free = np.flatnonzero(~held.T.ravel())
        force = np.zeros((self.points.shape[1], 3))
        np.add.at(force[:, 2], self.top, self._even())
        moved = np.zeros(force.size)
        moved[free] = factor(matrix[free][:, free].tocsc(), plan(free.size))(force.ravel()[free, None])[:, 0]
        return moved.reshape(-1, 3).T

    def _even(self):
        """Nodal forces ``(8, faces)`` of unit stress on the top."""
        at, weight = np.polynomial.legendre.leggauss(3)
        x, y = (v.ravel() for v in np.meshgrid(at, at))
        step, place = 1e-6, self.points[:2, self.top]
        (a, b), (c, d) = (
            np.einsum("dnf,nq->dfq", place, (face_shapes(x + h, y + v) - face_shapes(x - h, y - v)) / (2 * step))
            for h, v in ((step, 0), (0, step))
        )
        return np.einsum("nq,fq,q->nf", face_shapes(x, y), np.abs(a * d - b * c), np.outer(weight, weight).ravel())

    def intensity(self, moved, radius):
        """K_I, K_II, K_III ``(3, pieces + 1)`` along the front; the lower half is the mirror image."""
        mirror = np.array([[1.0], [1.0], [-1.0]])
        flip = [HEX.index((node, 2 - level)) for node, level in HEX]
        points, moved = np.hstack([self.points, self.points * mirror]), np.hstack([moved, moved * mirror])
        cells = np.hstack([self.cells, (self.cells + self.points.shape[1])[flip]])
        x, y, flat = np.cos(self.phi), np.sin(self.phi), 0 * self.phi
        ahead = np.array([x / self.c, y / self.a, flat])
        ahead = (ahead / np.linalg.norm(ahead, axis=0)).T
        front = np.array([self.c * x, self.a * y, flat]).T
        return front_intensity(points, cells, moved, STEEL, front, ahead, np.tile([0.0, 0.0, 1.0], (x.size, 1)), radius)


def newman_raju(a, c, deep, wide, phi):
    """K_I of a semi-elliptic surface crack in a plate under unit tension; a <= c, `wide` half the plate's width.

    J. C. Newman, I. S. Raju, Eng. Fract. Mech. 15 (1981) 185-192, equations 2 to 10.
    """
    ratio, part, sin = a / c, a / deep, np.sin(phi)
    shape = 1 + 1.464 * ratio**1.65
    m_1, m_2 = 1.13 - 0.09 * ratio, -0.54 + 0.89 / (0.2 + ratio)
    m_3 = 0.5 - 1 / (0.65 + ratio) + 14 * (1 - ratio) ** 24
    g = 1 + (0.1 + 0.35 * part**2) * (1 - sin) ** 2
    angle = (ratio**2 * np.cos(phi) ** 2 + sin**2) ** 0.25
    finite = math.sqrt(1 / math.cos(math.pi * c / (2 * wide) * math.sqrt(part)))
    return (m_1 + m_2 * part**2 + m_3 * part**4) * g * angle * finite * math.sqrt(math.pi * a / shape)


def embedded(a, c, phi):
    """K_I of an elliptic crack in an infinite body under unit tension, a <= c (G. R. Irwin, J. Appl. Mech. 29 (1962) 651-654)."""
    return math.sqrt(math.pi * a) / ellipe(1 - (a / c) ** 2) * (np.sin(phi) ** 2 + (a / c * np.cos(phi)) ** 2) ** 0.25


@pytest.mark.slow
def test_a_penny_in_a_large_body():
    """Sneddon's 2 / pi sqrt(pi a); by symmetry there are no other modes."""
    body = Quarter(1.0, 1.0, 10.0, 10.0, 10.0, pieces=4)
    found = body.intensity(body.pulled(free_surface=False), 0.2)
    print(np.round(100 * (found[0] / embedded(1.0, 1.0, body.phi) - 1), 2), "%")
    assert_allclose(embedded(1.0, 1.0, body.phi), 2 / math.sqrt(math.pi), rtol=1e-12)
    assert_allclose(found[0], 2 / math.sqrt(math.pi), rtol=0.01)
    assert np.abs(found[1:]).max() < 1e-9


def test_newman_and_raju_at_their_limits():
    """A long shallow crack is an edge crack, 1.12 sqrt(pi a); the half circle is 1.04 times the penny where it is deepest."""
    assert_allclose(newman_raju(1.0, 1e4, 1e4, 1e7, math.pi / 2), 1.12 * math.sqrt(math.pi), rtol=0.01)
    assert_allclose(newman_raju(1.0, 1.0, 1e4, 1e4, math.pi / 2), 1.04 * 2 / math.sqrt(math.pi), rtol=0.002)


@pytest.mark.slow
def test_an_ellipse_in_a_large_body():
    body = Quarter(1.0, 2.0, 10.0, 20.0, 15.0, pieces=12, tip=0.01)
    found = body.intensity(body.pulled(free_surface=False), WIDEST)[0]
    print(np.round(100 * (found / embedded(1.0, 2.0, body.phi) - 1), 2), "%")
    assert_allclose(found, embedded(1.0, 2.0, body.phi), rtol=0.01)


@pytest.mark.slow
def test_a_surface_crack_of_newman_and_raju():
    """Within 3 % along the whole front; they say that their equation is within 5 % of their finite elements."""
    c, deep = 2.5, 2.0
    body = Quarter(1.0, c, deep, 8 * c, 8 * c, pieces=12, tip=0.01)
    found = body.intensity(body.pulled(free_surface=True), WIDEST)[0]
    want = newman_raju(1.0, c, deep, 8 * c, body.phi)
    print(f"a/c = {1 / c:g}, a/t = {1 / deep:g}:", np.round(100 * (found / want - 1), 2), "%")
    assert_allclose(found, want, rtol=0.03)

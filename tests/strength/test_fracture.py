"""Stress intensity on strips with known answers, and on a cracked tooth."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from usual import STEEL

import gearfe as gf
from gearfe.flexibility.finite_elements.elasticity import HeldSection, edge_shapes
from gearfe.geometry.mesh.outline import along
from gearfe.geometry.mesh.section_mesh import fill
from gearfe.geometry.tooth.profile import arc_at
from gearfe.strength.fracture import tip_intensity
from gearfe.strength.kink import growth_angle

GEAR = gf.Gear(z=18, m_n=2.0, alpha_n=math.radians(20), beta=math.radians(16), b=30.0, r_bore=9.0)


def strip(width, height, a, angle, near):
    """Rectangle pulled at its ends [1 MPa] with an edge crack of length a from the middle of its left side."""

    def leg(start, stop, first, last, largest):
        return along(np.array([start, stop]).T, first, last, largest)[:, :-1]

    coarse = width / 16
    corners = [(0, 0), (0, -height), (width, -height), (width, height), (0, height), (0, 0)]
    sizes = [near, coarse, coarse, coarse, coarse, near]
    legs = [leg(corners[i], corners[i + 1], sizes[i], sizes[i + 1], coarse) for i in range(5)]
    vertices = np.hstack(legs)
    middles = (vertices + np.roll(vertices, -1, axis=1)) / 2
    rim = np.empty((2, 2 * vertices.shape[1]))
    rim[:, ::2], rim[:, 1::2] = vertices, middles
    tip = a * np.array([math.cos(angle), math.sin(angle)])
    inner = along(np.array([(0, 0), tip]).T, near, a / 100, near)[:, 1:]
    mesh, faces = fill(rim, np.empty((2, 0)), [(0, inner)])
    ends = {
        name: mesh.facets_satisfying(lambda x, y=y: np.isclose(x[1], y)) for name, y in (("top", height), ("bottom", -height))
    }
    held = ends["bottom"][:1]  # far from the crack; the load is in balance
    body = HeldSection(mesh.with_boundaries(mesh.boundaries | {"held": held}), STEEL)
    force = np.zeros((2 * mesh.doflocs.shape[1], 1))
    t, w = np.polynomial.legendre.leggauss(3)
    for name, sign in (("top", 1), ("bottom", -1)):
        for facet in ends[name]:
            nodes = np.append(mesh.facets[:, facet], mesh.nvertices + facet)
            length = np.ptp(mesh.doflocs[0, nodes[:2]]) / 2
            force[2 * nodes + 1, 0] += sign * (edge_shapes(t)[0] @ w) * length
    return tip_intensity(body, body.solve(force)[:, 0], faces[0])


@pytest.mark.slow
@pytest.mark.parametrize(("ratio", "factor"), [(0.1, 1.1892), (0.2, 1.3673), (0.3, 1.6599), (0.4, 2.1114), (0.5, 2.8246)])
def test_edge_cracked_strip(ratio, factor):
    """Tension of a long strip: K_I / (sigma sqrt(pi a)) of A. C. Kaya, F. Erdogan, Q. Appl. Math. 45 (1987) 105-122."""
    found = strip(1.0, 3.0, ratio, 0.0, 0.01)
    assert_allclose(found.K_I, factor * math.sqrt(math.pi * ratio), rtol=1e-3)
    assert abs(found.K_II) < 1e-3 * found.K_I


def test_slanted_edge_crack():
    """45 degrees at the edge of a half-plane: F_I = 0.705, F_II = 0.364 (Murakami 1987, p. 3.2)."""
    found = strip(40.0, 40.0, 1.0, math.radians(45), 0.05)
    assert_allclose([found.K_I, abs(found.K_II)], np.array([0.705, 0.364]) * math.sqrt(math.pi), rtol=4e-3)
    finer = strip(40.0, 40.0, 1.0, math.radians(45), 0.025)
    assert_allclose([found.K_I, found.K_II], [finer.K_I, finer.K_II], rtol=1e-3)


@pytest.mark.quick
def test_growth_angle():
    assert growth_angle(1.0, 0.0) == 0.0
    assert math.isnan(growth_angle(-1.0, 0.3))
    t = growth_angle(1.0, 0.4)
    assert_allclose(1.0 * math.sin(t) + 0.4 * (3 * math.cos(t) - 1), 0, atol=1e-12)


@pytest.mark.parametrize(
    ("start", "level", "known"),
    [
        ("30deg", 0.3, 104.74),
        pytest.param("30deg", 0.5, 94.90, marks=pytest.mark.slow),
        pytest.param("60deg", 0.3, 90.05, marks=pytest.mark.slow),
        ("60deg", 0.5, 72.35),
    ],
)
def test_crack_of_a_ring(start, level, known):
    """Truth: 13 ring teeth between polygons cut by a polygon of the cutter, Delaunay triangles of second order, a slit of
    separate nodes from the polygon's own tangent point, K from the stiffness derivative and the opening.
    """
    ring = gf.Gear(z=84, m_n=2.0, alpha_n=math.radians(20), b=20.0, r_rim=95.0, x=-0.4617, addendum=0.859, rack_tip_radius=0.2)
    found = gf.stress_intensity(ring, gf.Crack(level=level, start=start), 82.558, 100.0, STEEL)
    assert_allclose(found.K_I, known, rtol=3e-3)


def compliance(flexible, roll):
    """S(s, s) of the cracked tooth, glued part and opening."""
    opening = flexible.seam.at([float(arc_at(GEAR, roll))], [0])
    glued = flexible.matrix(np.array([roll]), [0])[0, 0]
    return glued + (opening @ flexible.seam.stiffness @ opening.T)[0, 0]


@pytest.mark.parametrize("method", [pytest.param("fe", marks=pytest.mark.slow), "ritz"])
def test_stress_intensity_is_the_energy_released(method):
    """dC/da = 2 (K_I**2 + K_II**2) (1 - nu**2) / E for a unit load (Irwin), by differences of the tooth's compliance."""
    from gearfe.flexibility.energy.ritz import plane as ritz
    from gearfe.flexibility.finite_elements import fe

    radius, lengths = 19.5, (1.0, 1.1)
    roll = math.sqrt(radius**2 - GEAR.r_b**2)
    cracks = [(gf.Crack(length=a),) for a in lengths]
    if method == "fe":
        healthy = fe.flexibility(GEAR, STEEL, neighbours=1)
        cracked = [fe.damaged_flexibility(GEAR, STEEL, crack, healthy, refine=1.5) for crack in cracks]
    else:
        cracked = [ritz.flexibility(GEAR, STEEL, crack) for crack in cracks]
    values = [compliance(one, roll) for one in cracked]
    k = gf.stress_intensity(GEAR, gf.Crack(length=1.05), radius, 1.0, STEEL)
    released = 2 * (k.K_I**2 + k.K_II**2) * (1 - STEEL.nu**2) / STEEL.E
    assert_allclose(np.diff(values)[0] / 0.1, released, rtol=0.02)


def test_the_whole_load_acts_at_the_tip_too(tmp_path):
    near, at = (gf.stress_intensity(GEAR, gf.Crack(level=0.3), r, 100.0, STEEL).K_I for r in (GEAR.r_a - 0.05, GEAR.r_a))
    assert abs(at / near - 1) < 0.1
    for radius in (GEAR.r_a, GEAR.r_form):
        _, load = gf.write_inp(tmp_path / "tip.inp", GEAR, radius, 100.0, STEEL, refine=0.6)
        assert_allclose(np.hypot(load[0::2].sum(), load[1::2].sum()), 100.0, rtol=1e-9)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: gf.stress_intensity(GEAR, gf.Crack(level=0.3), 19.5, -1.0, STEEL), "line_load = -1.0"),
        (lambda: gf.stress_intensity(GEAR, gf.Crack(level=0.3), 25.0, 1.0, STEEL), "not on the involute flank"),
        (lambda: gf.Crack(), "give one of them"),
        (lambda: gf.Crack(level=1.0), "between 0 and 1"),
        (lambda: gf.Crack(level=0.3, angle=45.0), "radians"),
        (lambda: gf.Crack(level=0.3, start="foot"), "30deg, 60deg, root, middle"),
        (lambda: gf.Crack(length=1.0, turning=True), "level"),
        (lambda: gf.stress_intensity(GEAR, gf.Crack(length=20.0), 19.5, 1.0, STEEL), "sector|held edge"),
        (lambda: gf.stress_intensity(GEAR, gf.Crack(level=0.995, turning=True), 19.5, 1.0, STEEL), "opposite fillet"),
    ],
)
def test_bad_input(call, message):
    with pytest.raises(ValueError, match=message):
        call()

import math
import os
import subprocess
import sys

import numpy as np
import pytest
from exact_area import section_area
from numpy.testing import assert_allclose
from skfem import Basis, ElementTriP2

import gearfe as gf
from gearfe.flexibility.finite_elements.fe import mesh_gear
from gearfe.geometry.mesh import mesher, outline, section_mesh
from gearfe.geometry.tooth.profile import cartesian, flank

GEAR = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 20.0}


@pytest.fixture(scope="module")
def section():
    return mesh_gear(gf.Gear(z=21, r_bore=7.4, **GEAR), read=range(1, 3))


def test_boundary_lies_on_the_profile(section):
    gear, points = section.gear, section.mesh.doflocs
    assert_allclose(points[:, section.flank[0]], cartesian(*flank(gear, section.roll[0])), atol=1e-12)
    radius, angle = flank(gear, section.roll[1])
    assert_allclose(points[:, section.flank[1]], cartesian(radius, angle + 2 * math.pi / 21), atol=1e-12)
    bore = section.mesh.boundaries["held"]
    assert_allclose(np.hypot(*points[:, section.mesh.nvertices + bore]), gear.r_bore, rtol=1e-12)


def test_area_converges_to_that_of_the_exact_outline(section):
    gear, exact = section.gear, section_area(section.gear)
    errors = []
    for refine in (1, 2):
        basis = Basis(mesh_gear(gear, read=range(1, 3), refine=refine).mesh, ElementTriP2(), intorder=6)
        assert basis.dx.min() > 0, "no inverted triangle"
        errors.append(abs(basis.dx.sum() / exact - 1))
    print("area errors", errors)
    assert errors[0] < 3e-4
    assert errors[1] < errors[0] / 4, "third order or better"


@pytest.mark.slow
@pytest.mark.parametrize(("z", "bore"), [(5, 0.3), (12, 0.95), (17, 0.5), (60, 0.9), (200, 0.5)])
def test_hard_gears_mesh(z, bore):
    r_f = gf.Gear(z=z, r_bore=0.1, **GEAR).r_f
    mesh = mesh_gear(gf.Gear(z=z, r_bore=bore * r_f, **GEAR), read=range(1, 2))
    assert Basis(mesh.mesh, ElementTriP2(), intorder=4).dx.min() > 0


def test_session_is_closed_after_an_error():
    import gmsh

    with pytest.raises(KeyError), mesher.gmsh_session():
        raise KeyError
    assert not gmsh.isInitialized()


@pytest.mark.skipif(os.name != "posix", reason="no signals to keep")
def test_a_closed_pipe_is_an_error_after_a_session_as_before():
    """gmsh takes back that Python ignores SIGPIPE: a killed worker of a sweep then ended the whole program without a word."""
    code = "import os; from gearfe.geometry.mesh import mesher\nwith mesher.gmsh_session():\n    pass\n"
    code += "one, two = os.pipe(); os.close(one); os.write(two, b'x')"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "BrokenPipeError" in done.stderr


def test_missing_gmsh_names_the_packages(monkeypatch):
    monkeypatch.setitem(sys.modules, "gmsh", None)
    with pytest.raises(RuntimeError, match="libglu1-mesa"), mesher.gmsh_session():
        pass


def test_same_tooth_twice_is_refused():
    gear = gf.Gear(z=5, r_bore=1.0, **GEAR)
    roll = outline.stations(gear, 0.5)
    with pytest.raises(ValueError, match="not distinct"):
        section_mesh.section(gear, {0: roll, 5: roll}, fillet_size=0.5, size=1.0, far_size=1.0)


def test_edges_are_as_long_as_asked_where_they_are_fine():
    """0.1 from 4 to 6, no longer than 1 anywhere, and from one to the next no more than a quarter of an edge longer."""
    steps = np.diff(places := outline.spaced(0.0, 10.0, 1.0, [(4.0, 6.0, 0.1)]))
    inside = (places[:-1] >= 4) & (places[1:] <= 6)
    assert_allclose(steps[inside], 0.1, rtol=0.05)
    assert inside.sum() in (19, 20)
    assert steps.max() < 1.05
    assert (np.maximum(steps[1:] / steps[:-1], steps[:-1] / steps[1:]) < 1.3).all()

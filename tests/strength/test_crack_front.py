"""Stress intensities along the front of a crack in a gear: its middle against the section, mirrored fronts, bad input."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from usual import STEEL

import gearfe as gf
from gearfe.flexibility.finite_elements import line_load, solver
from gearfe.strength import crack_front
from gearfe.strength.crack_front import _axes

GEAR = gf.Gear(z=18, m_n=2.0, alpha_n=math.radians(20), b=6.0, r_bore=9.0)
RADIUS, LOAD = 19.0, 100.0  # mm, N/mm


def intensities(crack, refine=0.6, gear=GEAR):
    return gf.stress_intensity_along_front(gear, crack, RADIUS, LOAD, STEEL, refine=refine)


@pytest.mark.parametrize(
    ("crack", "change", "message"),
    [
        (gf.Crack(level=0.4, tooth=1), {}, "straight crack of tooth 0"),
        (gf.Crack(level=0.4, width=(0.0, 7.0)), {}, "beyond the face, which ends at 6 mm"),
        (gf.Crack(level=0.4), {"radius": 9.0}, "not on the involute"),
    ],
)
def test_bad_input_is_refused(crack, change, message):
    run = {"radius": RADIUS, "line_load": LOAD} | change
    with pytest.raises(ValueError, match=message):
        gf.stress_intensity_along_front(GEAR, crack, material=STEEL, **run)


def short(*given):
    raise MemoryError


@pytest.mark.parametrize(("free", "assemble"), [(1e7, lambda *given: pytest.fail("assembled")), (1e12, short)])
def test_too_little_memory_is_told_with_the_number(free, assemble, monkeypatch):
    monkeypatch.setattr(solver, "free_memory", lambda: free)
    monkeypatch.setattr(line_load, "assemble", assemble)
    with pytest.raises(RuntimeError, match=r"unknowns.* about .* GB .*a smaller refine"):
        intensities(gf.Crack(level=0.4), refine=0.3)


def test_axes_of_a_front_on_a_helix():
    """Unit vectors at right angles, the front's direction among them; on a spur gear the crack's plane does not turn."""
    z = np.linspace(0.0, 6.0, 601)
    mouth, tip = np.array([1.5, 16.0]), np.array([0.2, 14.8])
    part = np.array([1 - 0.1 * z, np.full(z.size, -0.1)])
    gear = gf.Gear(z=18, m_n=2.0, alpha_n=math.radians(20), b=6.0, r_bore=9.0, beta=0.3)
    front, ahead, normal = _axes(gear, mouth, tip, z, part)
    along = np.gradient(front, z, axis=0)[1:-1]
    along /= np.linalg.norm(along, axis=1)[:, None]
    assert_allclose(np.cross(ahead, normal)[1:-1], along, atol=1e-5)
    assert_allclose(np.linalg.norm(ahead, axis=1), 1.0, rtol=1e-12)
    flat = _axes(GEAR, mouth, tip, z, part)[2]
    assert_allclose(flat, np.tile(flat[0], (z.size, 1)), atol=1e-12)


def test_without_contraction_a_spur_gear_is_its_section(monkeypatch):
    """Poisson's ratio 0: every height is the section, in both modes. With tubes finer than the mesh K_II was off by 7 to 11 %."""
    monkeypatch.setattr(crack_front, "LAYERS", 2)  # nothing changes along the width
    monkeypatch.setattr(crack_front, "END_LAYER", 1.0)
    gear = replace(GEAR, b=2.0)
    run = gear, gf.Crack(level=0.4), gear.r, LOAD, gf.Material(E=207e3, nu=0.0)
    found, plane = gf.stress_intensity_along_front(*run, refine=0.4), gf.stress_intensity(*run)
    print(np.round(100 * (found.K_I / plane.K_I - 1), 2), np.round(100 * (found.K_II - plane.K_II) / plane.K_I, 2))
    assert_allclose(found.K_I, plane.K_I, rtol=0.02)
    assert_allclose(found.K_II, plane.K_II, atol=0.02 * plane.K_I)

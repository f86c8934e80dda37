"""What the quads of a section lack: against the energy model in plane strain, its decrease, and where it is put."""

import functools
import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.flexibility.end_faces import edge_factor
from gearfe.flexibility.energy.ritz.solid import flexibility3d
from gearfe.flexibility.finite_elements import section_error
from gearfe.flexibility.finite_elements.fe3d import Patches, mesh_patches
from gearfe.flexibility.finite_elements.fe_gear3d import PER_HAT, SIZES
from gearfe.flexibility.finite_elements.section_error import finer_section, plane_hats
from gearfe.flexibility.halfspace import half_space
from gearfe.flexibility.solid import PLACES, Flexibility3D, hats, own_distance, own_mirrors

GEAR = gf.Gear(z=12, x=0.2, m_n=2.0, alpha_n=math.radians(20), b=6.0, r_bore=6.0, rack_tip_radius=0.2)


@pytest.fixture(scope="module")
def hats_at():
    """Plane-strain displacement of the hats by resolution."""
    return functools.cache(lambda refine: plane_hats(GEAR, gf.Material(), (), refine))


@pytest.mark.slow
def test_the_finest_section_is_that_of_the_energy_model_in_plane_strain(hats_at):
    model = flexibility3d(GEAR, gf.Material(), axial=0, order=5)
    half = half_space(gf.Material())
    local = own_distance(GEAR, 0) + edge_factor(gf.Material()) * own_mirrors(GEAR, 0)
    assert_allclose(hats_at(2.0), model.near[0] + half * local, rtol=1e-3)


@pytest.mark.slow
def test_sections_are_too_stiff_and_less_so_the_finer(hats_at):
    """The finest being a reference, edges of 1 leave less than a tenth of a percent, those of 0.5 far more."""
    lacking = {refine: 1 - hats_at(refine).sum() / hats_at(2.0).sum() for refine in (0.5, 1.0)}
    print(lacking)
    assert 0 < lacking[1.0] < 1e-3
    assert lacking[0.5] > 2 * lacking[1.0]


def test_a_section_changes_steadily_with_the_helix_angle(hats_at):
    """Of a gear that is hardly helical it is that of the spur gear, to within the meshes."""
    almost = plane_hats(replace(GEAR, beta=1e-3), gf.Material(), (), 1.0)
    assert_allclose(almost, hats_at(1.0), rtol=1e-3)


def leaning():
    """A helical gear and the spur gear of the same transverse section."""
    beta = math.radians(30)
    spur = {name: getattr(GEAR, name) * math.cos(beta) for name in ("x", "addendum", "dedendum", "rack_tip_radius")}
    spur |= {"m_n": GEAR.m_n / math.cos(beta), "alpha_n": math.atan(math.tan(GEAR.alpha_n) / math.cos(beta))}
    spur, helical = (replace(GEAR, r_bore=9.0, **own) for own in (spur, {"beta": beta}))
    assert_allclose([spur.r_b, spur.r_a, spur.r_f], [helical.r_b, helical.r_a, helical.r_f], rtol=1e-9)
    return spur, helical


def test_a_mesh_is_the_same_every_time():
    """gmsh's frontal triangles for quads gave this one 164 nodes more now and then, by the addresses of its memory."""
    spur, made = leaning()[0], []
    for _ in range(8):
        made.append(
            mesh_patches(
                replace(spur, b=0.02), Patches((0,), hats(spur), 1), refine=0.5, per_hat=PER_HAT, layer=0.01, sizes=SIZES
            )
        )
        assert np.array_equal(made[-1].points, made[0].points)
        assert np.array_equal(made[-1].cells, made[0].cells)


def test_forces_that_lean_by_a_helix_are_taken_in_the_section(monkeypatch):
    """A force at right angles to a helical flank has cos(beta_b) of it in the section, and is read along it: both are undone.

    On the mesh of the spur gear of the same transverse section, which does not lean, nothing else is left of the helix.
    """
    spur, helical = leaning()
    places = hats(spur)
    monkeypatch.setattr(section_error, "hats", lambda gear: places)
    want = plane_hats(spur, gf.Material(), (), 0.5)
    thin = replace(spur, b=section_error.THIN * helical.m_n)
    monkeypatch.setattr(
        section_error,
        "mesh_patches",
        lambda gear, *given, **more: replace(mesh_patches(thin, *given, **more), gear=gear),
    )
    assert_allclose(plane_hats(helical, gf.Material(), (), 0.5), want, rtol=2e-3)


@pytest.mark.slow
def test_what_a_section_lacks_is_added_to_every_axial_mode(hats_at, monkeypatch):
    """To the near part of each tooth, of a cracked one with its crack; nothing changes between teeth."""
    monkeypatch.setattr(section_error, "FINER", 2.0)
    size = 2 * PLACES
    near, far = {0: np.zeros((size, size)), 1: np.zeros((size, size))}, {(0, 1): np.ones((size, size))}
    plain = Flexibility3D(GEAR, 1, 1.0, near, far, 0)
    crack = gf.Crack(level=0.4, tooth=1, width=(0.0, 2.0))
    more = finer_section(plain, gf.Material(), (crack,), refine=0.5)
    want = hats_at(1.0) - hats_at(0.5)
    for first in (0, 1):
        assert_allclose(more.near[0][first::2, first::2], want, rtol=1e-9)
    assert not more.near[0][0::2, 1::2].any()
    assert np.abs(more.near[1] - more.near[0]).max() > 0.05 * np.abs(want).max()
    assert more.far is plain.far

"""The pose: which gear an approach turns, one convention at both ends of double contact."""

import shutil
import subprocess

import numpy as np
import pytest
from numpy.testing import assert_allclose
from usual import RACK, STEEL

import gearfe as gf
from gearfe.geometry.pair.approach import approach

LOAD = 300.0  # N/mm


def solved(pair, phase, pose="mean", **options):
    return gf.mesh_stiffness(pair, LOAD * 20, STEEL, method="ritz", phases=[phase], pose=pose, **options)


@pytest.mark.quick
@pytest.mark.parametrize("phase", [0.3, 0.63, 0.65, 0.93, 0.95, 0.97])
def test_turning_one_gear_is_the_mean_pose_half_an_approach_away(pair, phase):
    for pose, sign in (("pinion", 1), ("wheel", -1)):
        one = solved(pair, phase, pose)
        mean = solved(pair, phase + sign * one.deflection[0] * 1e3 / 2 / pair.p_bt)
        assert_allclose(one.k, mean.k, rtol=1e-5)
        assert one.phase[0] == phase
        assert one.meta["pose"] == pose


def test_the_poses_differ_near_the_ends_of_double_contact_only(pair):
    k = {(phase, pose): solved(pair, phase, pose).k[0] for phase in (0.3, 0.95) for pose in ("pinion", "mean", "wheel")}
    assert 0.005 < k[0.95, "pinion"] / k[0.95, "mean"] - 1 < 0.02
    assert 0.005 < k[0.95, "mean"] / k[0.95, "wheel"] - 1 < 0.02
    assert abs(k[0.3, "pinion"] / k[0.3, "wheel"] - 1) < 2e-3


@pytest.mark.parametrize("phase", [0.1, 0.64, 0.66, 0.94, 0.97])
def test_no_gear_is_preferred(phase):
    """Both gears alike: driving forwards into an entry is driving backwards out of an exit."""
    gear = gf.Gear(z=25, r_bore=9.0, **RACK)
    pair = gf.GearPair(gear, gear)
    mirrored = (pair.eps_alpha - phase) % 1
    assert_allclose(solved(pair, phase).k, solved(pair, mirrored).k, rtol=1e-5)
    # a gear that turns at the entry is the other gear at the mirrored exit
    assert_allclose(solved(pair, phase, "pinion").k, solved(pair, mirrored, "wheel").k, rtol=1e-5)


def test_a_corner_just_off_the_path_opens_with_the_square_of_the_distance(pair):
    end = pair.path[1]
    away = np.array([1e-3, 2e-3, 4e-3])
    gap, _ = approach(pair, pair.gear_1.roll_a, end + away)[:2]
    assert_allclose(gap[1:] / gap[:-1], 4, rtol=0.01)


def test_the_estimate_of_every_pose_is_the_mean_poses(pair):
    one = solved(pair, 0.95, "wheel", error=True)
    mean = solved(pair, 0.95 - one.deflection[0] * 1e3 / 2 / pair.p_bt, error=True)
    assert_allclose(one.error, mean.error, rtol=1e-3)


def test_an_unknown_pose_is_refused(pair):
    with pytest.raises(ValueError, match="pose = 'gear', but it must be one of mean, pinion, wheel"):
        solved(pair, 0.1, "gear")


@pytest.mark.slow
def test_the_pose_holds_in_three_dimensions():
    pair = gf.GearPair(gf.Gear(z=21, r_bore=7.4, **RACK), gf.Gear(z=31, r_bore=11.4, **RACK))
    wide = {"method": "ritz3d", "face": "spur"}
    one = gf.mesh_stiffness(pair, LOAD * 20, STEEL, phases=[0.95], pose="pinion", **wide)
    at = 0.95 + one.deflection[0] * 1e3 / 2 / pair.p_bt
    mean = gf.mesh_stiffness(pair, LOAD * 20, STEEL, phases=[at], **wide)
    assert_allclose(one.k, mean.k, rtol=1e-5)


@pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX (ccx) is not installed: apt-get install calculix-ccx")
@pytest.mark.slow
def test_calculix_in_the_same_pose(pair, tmp_path):
    """Nonlinear contact with large displacements, the same gears turned."""
    phase, pose = 0.95, "wheel"
    curve = solved(pair, phase, pose)
    deck = gf.write_contact_inp(tmp_path / "pair.inp", pair, phase, curve.deflection[0] * 1e3, LOAD, (STEEL, STEEL), pose=pose)
    subprocess.run(["ccx", "-i", "pair"], cwd=tmp_path, capture_output=True, timeout=600, check=False)
    difference = LOAD / deck.force(tmp_path / "pair.dat") - 1
    print(f"phase {phase}, {pose}: {100 * difference:+.3f} %")
    assert abs(difference) < 0.005

"""A crack softens its gear while other teeth carry: every tooth's load opens it, until the tooth is too far away."""

import numpy as np
import pytest
from usual import PAIR, RACK

import gearfe as gf
from gearfe.flexibility import plane

CYCLES = np.arange(-5, 6) + 0.3


def curve(level, name="ritz", phases=CYCLES, **options):
    """Curve around the engagement of a cracked tooth of the pinion."""
    run = {"method": name, "phases": phases, "cache": False, **options}
    return gf.mesh_stiffness(PAIR, 2000.0, gf.Material(), damage={"pinion": [gf.Crack(level=level)]}, **run)


@pytest.mark.slow
@pytest.mark.parametrize("level", [0.5, 0.9])
def test_a_crack_counts_while_other_teeth_carry(level, monkeypatch):
    """With all 21 teeth solved k is the same up to three teeth away, and within the estimate of the contact further away."""
    found = curve(level, error=True)
    monkeypatch.setattr(plane, "FURTHER", 10)
    whole = curve(level).k
    off, near = found.k / whole - 1, ~(found.force[:, np.abs(found.order) > 3] > 0).any(axis=1)
    assert near.sum() == 6
    assert np.abs(off[near]).max() < 1e-7
    assert (np.abs(found.k - whole) < found.meta["error_of_contact"]).all()
    assert off.max() > 1e-4, "every tooth was solved: the estimate is not tried"


@pytest.mark.slow
def test_finite_elements_and_the_energy_model_agree_before_the_tooth_enters():
    """The loss of k one and two mesh cycles before the tooth is in mesh, by methods that share the contact alone."""
    before = CYCLES[3:6]  # the last with the cracked tooth
    healthy = [gf.mesh_stiffness(PAIR, 2000.0, gf.Material(), method=name, phases=before).k for name in ("ritz", "fe")]
    energy, finite = (1 - curve(0.9, name, before).k / k for name, k in zip(("ritz", "fe"), healthy, strict=True))
    np.testing.assert_allclose(finite[:2], energy[:2], rtol=0.03)
    assert 0.004 < energy[:2].min() < energy[:2].max() < 0.03


def test_a_mesh_cycle_has_all_of_it():
    """Where a curve of one tooth ends, k differs from that of a healthy cycle by less than its estimate."""
    case = gf.Case(PAIR, 2000.0, gf.Material(), damage={"pinion": [gf.Crack(level=0.5)]})
    (part,) = gf.mesh_cycle(case, gf.Solve(phases=8, method="ritz", error=True)).parts
    first, last = part.curve.phase[[0, -1]]
    assert first < -3
    assert last > PAIR.eps_alpha + 3
    healthy = gf.mesh_stiffness(PAIR, 2000.0, gf.Material(), method="ritz", phases=part.curve.phase).k
    assert (np.abs(1 - part.curve.k / healthy)[[0, -1]] < (part.curve.error / healthy)[[0, -1]]).all()


@pytest.mark.slow
@pytest.mark.parametrize("level", [0.5, 0.9])
def test_three_dimensions_count_a_crack_as_far_as_sections(level):
    """Without lateral contraction a spur pair is its section, up to five teeth away, within the estimate."""
    rack = RACK | {"b": 4.0}
    pair = gf.GearPair(gf.Gear(z=21, r_bore=7.4, **rack), gf.Gear(z=31, r_bore=11.4, **rack))
    run = {"phases": CYCLES[::2], "cache": False, "damage": {"pinion": [gf.Crack(level=level)]}, "error": True}
    plane, solid = (gf.mesh_stiffness(pair, 400.0, gf.Material(nu=0.0), method=name, **run) for name in ("ritz", "ritz3d"))
    assert (np.abs(solid.k - plane.k) < solid.error).all()
    assert np.abs(solid.k / plane.k - 1)[1:-1].max() < 1e-3

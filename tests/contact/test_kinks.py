"""Kinks of modified flanks: how far the flank turns there, and rows as long as what is pressed."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.contact import kink_law
from gearfe.geometry.pair.flanks import flank_forms


def test_what_a_kink_adds_in_three_dimensions_is_that_of_its_own_flank(monkeypatch):
    """Where it is the nearer kink, one of the mate that hardly bends changes nothing; nor does another size."""
    monkeypatch.setattr(kink_law, "LOADS", np.array([0.3, 1.0]))
    monkeypatch.setattr(kink_law, "PLACES", 3)

    def table(s, **more):
        rack = {"m_n": 3.0 * s, "alpha_n": math.radians(20), "b": 20.0 * s}
        pair = gf.GearPair(gf.Gear(z=24, r_bore=15.0 * s, **rack), gf.Gear(z=36, r_bore=20.0 * s, **rack))
        made = {"wheel": gf.Flank(tip_chamfer=0.2 * s)} | {side: gf.Flank(**own) for side, own in more.items()}
        law = kink_law.KinkLaw(pair, (gf.Material(), gf.Material()), 200.0 * s, flank_forms(pair, made))
        at, unit, _, (spline, least, most) = law.zones[-1]
        return at + 1.9 * unit * math.sqrt(most), spline(np.log([[least], [most]]), np.linspace(-1, 1, 6))

    beside, alone = table(1.0)
    assert np.abs(alone).max() < 1.6, "beside the logarithm of a strip, 5 to 8; where contact is on the ridge, 1.5"
    relief = {"root_relief": 1e-9, "root_start_roll": beside}
    assert_allclose(table(1.0, pinion=relief)[1][:, :4], alone[:, :4], atol=0.005)
    assert_allclose(table(25.0)[1], alone, atol=1e-5)
    assert np.ptp(alone) > 0.1


@pytest.mark.slow
def test_pinion_and_wheel_exchanged_where_a_chamfer_carries():
    """Lines of a helical pair touch the ridge far off the path: the same whichever gear is called pinion, law and gaps."""
    rack = {"m_n": 6.0, "alpha_n": math.radians(20), "b": 39.163, "beta": math.radians(15)}
    gears, flank = (
        (gf.Gear(z=18, x=0.1643, r_bore=16.2, **rack), gf.Gear(z=28, x=-0.1535, r_bore=25.2, **rack)),
        gf.Flank(tip_chamfer=0.534),
    )
    materials, phase = (gf.Material(E=207e3, nu=0.27), gf.Material(E=110e3, nu=0.33)), np.array([0.0, 0.99])
    pair, other = gf.GearPair(*gears), gf.GearPair(*gears[::-1])
    one = gf.mesh_stiffness(pair, 17526.0, materials, method="ritz3d", phases=phase, flanks={"pinion": flank})
    last = pair.eps_alpha + abs(pair.eps_beta)
    two = gf.mesh_stiffness(other, 17526.0, materials[::-1], method="ritz3d", phases=last - phase, flanks={"wheel": flank})
    assert_allclose(two.k, one.k, rtol=1e-7)

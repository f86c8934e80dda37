"""Modified flanks on gears whose flexibility is known at single places: closed forms and models of the user's own."""

from types import SimpleNamespace

from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.flexibility.energy.ritz.plane import flexibility


def test_a_relief_on_gears_that_are_known_at_single_places():
    """The energy model's own values through `matrix` alone give its k, but for what loads across the normal add.

    Closed forms are near it, too.
    """
    pair, steel = gf.load_scene("planetary_pitting").pair().pair, gf.Material(207e3, 0.3)
    gears = ("pinion", pair.gear_1), ("wheel", pair.gear_2)
    flanks = {side: gf.Flank(tip_relief=0.015, tip_start_diameter=2 * gear.r_a - 1.2) for side, gear in gears}
    made = [SimpleNamespace(matrix=flexibility(gear, steel).matrix) for _, gear in gears]
    run = {"pair": pair, "force": 2000.0, "material": steel, "phases": 16, "extended": False}
    want = gf.mesh_stiffness(**run, method="ritz", flanks=flanks)
    got = gf.mesh_stiffness(**run, method=gf.OwnFlexibility(*made), flanks=flanks)
    assert_allclose(got.k, want.k, rtol=2e-3)
    assert abs(got.k / gf.mesh_stiffness(**run, method="ritz").k - 1).max() > 0.05, "the relief is felt"
    closed = gf.mesh_stiffness(**run, method="coupled", flanks=flanks)
    assert_allclose(closed.k.mean(), want.k.mean(), rtol=0.02)

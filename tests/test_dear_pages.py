"""Pages without cheap rows and frozen ones: some of their rows computed again."""

import json
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from validation.shared.places import TABLES

pytestmark = pytest.mark.slow


def test_errors_of_the_energy_model_are_those_of_the_page():
    """Of sections, against the page's finite elements."""
    scene = gf.load_scene("planetary_pitting").pair()
    case = {"force": scene.force, "material": scene.materials, "cache": False}
    truth = gf.mesh_stiffness(scene.pair, method="fe", refine=6.0, **case).k
    known = {row[1]: row for row in json.loads((TABLES / "speed.json").read_text(encoding="utf-8"))["sections"]["rows"]}
    for order in (2, 3, 4, 5, 6):
        off = np.abs(gf.mesh_stiffness(scene.pair, method="ritz", order=order, **case).k / truth - 1)
        assert_allclose([off.mean(), off.max()], known[f"ritz, order {order}"][3:5], rtol=1e-3)


def test_bores_move_the_stiffness_as_the_scene_says():
    """1.74 times from 0.33 to 0.85 of the root radius, which reasons of verdicts quote."""
    one, k = gf.load_scene("herringbone").pairs["sun_planet"], []
    for part in (0.33, 0.85):
        pair = gf.GearPair(*(replace(g, r_bore=part * g.r_f) for g in (one.pair.gear_1, one.pair.gear_2)), one.pair.a)
        k.append(gf.mesh_stiffness(pair, one.force, one.materials, method="ritz3d", face=one.face, phases=6).k.mean())
    quoted = f"change the value {k[1] / k[0]:.2f} times"
    assert any(quoted in str(one) for one in gf.load_scene("herringbone").references)


@pytest.mark.parametrize("key", ["planetary_pitting sun_planet", "planetary_pitting planet_ring"])
def test_full_width_changes_the_stiffness_as_the_page_says(key):
    """Spur pairs of the page of what scenes need: their section against their full width."""
    scene, name = key.split()
    case = gf.load_scene(scene).pairs[name].case()
    used, wide = (gf.solve(case, gf.Solve(method, 16, cache=False)).k.mean() for method in ("auto", "ritz3d"))
    rows = map(json.loads, (TABLES / "needs.jsonl").read_text(encoding="utf-8").splitlines())
    known = next(row for row in rows if row["row"] == key)
    assert_allclose([used, wide / used - 1], [known["k"], known["change"][0]], rtol=1e-3)

"""The scan of what article S4 does not print: tables are those of this code, closed forms those of `mesh_stiffness`."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from validation.shared import herringbone_scan as scan
from validation.shared import herringbone_scan_closed as closed
from validation.shared import herringbone_scan_nodes as nodes
from validation.shared.herringbone_scan_page import bore_factor
from validation.shared.herringbone_scan_sets import Scan, sets


@pytest.fixture(scope="module")
def ritz():
    return scan.Ritz3D()


@pytest.mark.parametrize("name", ["plane sun_planet 0 0.455", "0 planet_ring 0.8 0.4"])
def test_nodes_are_those_of_this_code(name, ritz):
    work, *case = nodes.jobs()[name]
    assert_allclose(work(*case), ritz.known[name], rtol=2e-5)


@pytest.mark.parametrize("place", [5, 11])
def test_readings_are_those_of_this_code(place, ritz, monkeypatch):
    """Without a ring the foundation of one is nothing, and both of its forms are one."""
    real = closed.closed_pits
    either = {"sun_planet": scan.READINGS[0]}
    monkeypatch.setattr(closed, "closed_pits", lambda pair, case, kind: real(pair, case, either.get(pair, kind)))
    row = scan.load()[place]
    reading = scan.readings()[int(row["number"])]
    found = scan.numbers(scan.curves(ritz, reading), reading.group)
    assert len(found) > 70
    assert_allclose([float(row[name]) for name in found], list(found.values()), rtol=2e-3, atol=2e-3)


@pytest.mark.parametrize(("name", "bores"), [("sun_planet", (0.5, 0.45)), ("planet_ring", (0.6,))])
@pytest.mark.parametrize("foundation", scan.READINGS)
def test_closed_forms_are_those_of_mesh_stiffness(name, bores, foundation):
    chosen = gf.load_scene(scan.SCENE).pairs[name]
    pair = nodes.changed(chosen.pair, bores=bores)
    run = {"phases": nodes.cycle(pair, chosen.face), "face": chosen.face, "variants": {"foundation": foundation}}
    for length in (0.0, 0.3, 0.55):
        damage = nodes.cracked(pair, length, 45.0, "30deg")
        want = gf.mesh_stiffness(pair, chosen.force, chosen.materials, method="published", damage=damage, **run).k
        got = scan.closed("published", name, 0).stiffness(bores, length, foundation)
        assert_allclose(got, want, rtol=5e-4 if length == 0.55 else 1e-6)


def test_the_scene_quotes_the_bore_factor_of_this_code(ritz):
    scene = gf.load_scene(scan.SCENE)
    quoted = f"{bore_factor(ritz):.2f} times"
    assert any(quoted in str(one) for one in scene.references)
    assert quoted == "1.74 times"


def test_sobol_sample_is_large_and_fills_its_ranges():
    found = scan.readings()
    assert len(found) == scan.SIZE >= 500
    for name, (low, high) in scan.RANGES.items():
        values = np.array([getattr(one, name) for one in found])
        assert low <= values.min() <= values.max() <= high
        if name not in ("group", "own"):
            assert np.histogram(values, 16, (low, high))[0].min() > scan.SIZE / 16 * 0.7


def test_sets_are_nested():
    table = Scan()
    found = {what: first for what, first, _ in sets(table)}
    both = found["all ten means and all ten maxima"]
    assert 0 < both <= found["all ten means agree below 3 %"] <= found["the five means of sun and planet"] < len(table.table)

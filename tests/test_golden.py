"""Committed tables: cheap rows computed again, and pages that are what their tables say.

Made anew by ``python -m validation PAGE``.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.comparison.compare import damage_cycle
from gearfe.comparison.printed_stiffness import printed_cases
from gearfe.comparison.solved_curves import solve_fitted
from gearfe.scene import verdicts
from gearfe.scene.stored import read_curves
from validation import __main__ as main
from validation import check
from validation.make import herringbone, machines
from validation.shared import herringbone_page, places, table_rows
from validation.shared import page as pages
from validation.shared.page import text

PAGES = list(machines.PAGES)


@pytest.mark.parametrize("page", PAGES)
def test_every_printed_number_has_a_function_and_rows(page):
    asked, rows = machines.references(page), table_rows.read(page)
    assert {one.id for one in asked} == set(machines.functions(page)), "a reference without function, or a function without one"
    wanted = [(one.id, row.case, row.pair or "") for one in asked for row in one.rows]
    assert [row[:3] for row in rows] == wanted, "run python -m validation PAGE"
    printed = [row.value for one in asked for row in one.rows]
    assert_allclose([row.printed for row in rows], printed, rtol=1e-5, err_msg="run python -m validation PAGE")


@pytest.mark.parametrize("page", PAGES)
def test_what_is_not_reproduced_has_a_reason(page):
    by_id = {one.id: one for one in machines.references(page)}
    for row in table_rows.read(page):
        if row.verdict not in (verdicts.REPRODUCED, verdicts.FORMULA):
            assert verdicts.reasons(by_id[row.id], row), f"{row.id}, {row.case}: {row.verdict} without reason or correction"


@pytest.mark.slow
@pytest.mark.parametrize("page", PAGES)
def test_cheap_rows_are_what_the_table_says(page):
    known = {row[:3]: row for row in table_rows.read(page)}
    for row in machines.quick_rows(page).values():
        old = known[row[:3]]
        assert row.verdict == old.verdict, f"{row.id}, {row.case}"
        assert math.isnan(row.ours) == math.isnan(old.ours)
        assert_allclose(row.ours, old.ours, rtol=machines.GOLDEN_RTOL, atol=1e-12, err_msg=f"{row.id}, {row.case}")


@pytest.mark.slow
@pytest.mark.parametrize("page", PAGES)
def test_pages_are_not_stale(page):
    assert pages.read(page)[0] == machines.text(page), f"{page}.md is stale: run python -m validation PAGE"
    for name in machines.module(page).PICTURES:
        picture = machines.FOLDER / f"{name}.png"
        assert picture.is_file(), f"{name}.png is missing: run python -m validation PAGE"
        assert picture.stat().st_size < 120_000


def test_references_computed_elsewhere_exist():
    ids = {one.id for page in PAGES for one in machines.gf.load_scene(machines.PAGES[page]).references}
    assert set(machines.ELSEWHERE) <= ids


@pytest.mark.parametrize("name", ["planetary_pitting", pytest.param("helical_pitting", marks=pytest.mark.slow)])
def test_assumed_bores_and_forces_change_the_stiffness_as_on_file(name):
    (label, one), *_ = gf.load_scene(name).pairs.items()
    gears, method = (one.pair.gear_1, one.pair.gear_2), "ritz3d" if one.pair.gear_1.beta else "ritz"
    softer = gf.GearPair(*(replace(gear, r_bore=0.5 * gear.r_bore) for gear in gears), one.pair.a)
    run = {"method": method, "face": one.face} | ({"phases": 8} if method == "ritz3d" else {})
    k = [gf.mesh_stiffness(pair, force, one.materials, **run).k.mean()
         for pair, force in ((one.pair, one.force), (softer, one.force), (one.pair, 2 * one.force))]  # fmt: skip
    rows = table_rows.rows_of(places.TABLES / "assumptions.csv")
    known = {row["change"]: float(row["value"]) for row in rows if (row["scene"], row["pair"]) == (name, label)}
    assert_allclose(k[0], known["as assumed [N/m]"], rtol=machines.GOLDEN_RTOL)
    assert_allclose(100 * (np.array(k[1:]) / k[0] - 1), [known["bores halved"], known["force doubled"]], rtol=1e-3)


@pytest.mark.parametrize("name", sorted(machines.gf.load_scene(page).name for page in machines.PAGES.values()))
def test_every_assumption_says_what_depends_on_it(name):
    assert not [one["what"] for one in machines.gf.load_scene(name).assumptions if not one["depends"]]


def test_every_page_can_be_asked_for():
    for page in main.PAGES:
        assert (places.HOME / "make" / f"{page}.py").is_file(), page
    assert set(check.PAGES) < set(main.PAGES)
    assert set(machines.PAGES) == set(pages.MACHINES)


@pytest.mark.slow
def test_page_of_the_ten_rows_is_not_stale(monkeypatch):
    """A pair without a ring, which knows of no foundation of one, is solved once for both."""
    real, known = gf.mesh_stiffness, {}

    def once(**run):
        key = repr((run["pair"], run.get("damage"), run["pair"].gear_2.internal and run["variants"]))
        if key not in known:
            known[key] = real(**run)
        return known[key]

    monkeypatch.setattr(gf, "mesh_stiffness", once)
    on_disk = pages.read("herringbone")[0]
    assert on_disk == text("herringbone", *herringbone.text()), "herringbone.md is stale: run python -m validation herringbone"


def test_finite_elements_on_file_are_of_the_scene_as_it_is():
    scene = gf.load_scene("herringbone")
    stored = read_curves(scene)
    assert set(printed_cases(scene)) <= set(stored), "run python -m validation herringbone --reference"
    rows = {(r["pair"], r["case"]): r for r in herringbone_page.load("herringbone") if r["method"] == "fe3d"}
    for pair, case in printed_cases(scene):
        assert_allclose(float(rows[pair, case or "healthy"]["mean [N/m]"]), stored[pair, case][1].mean(), rtol=1e-5)


def test_a_closed_form_of_the_ten_rows():
    """The page computes the other again."""
    pair, method = "planet_ring", "textbook"
    chosen = gf.load_scene("herringbone").pairs[pair]
    for row in herringbone_page.load("herringbone"):
        if (row["pair"], row["method"]) == (pair, method) and row["case"] in ("healthy", "case1"):
            case = None if row["case"] == "healthy" else row["case"]
            k = solve_fitted(chosen.case(case), gf.Solve(method, damage_cycle(chosen))).k
            assert_allclose([k.mean(), k.max()], [float(row["mean [N/m]"]), float(row["max [N/m]"])], rtol=1e-4)


@pytest.mark.parametrize("pair", ["sun_planet", "planet_ring"])
def test_energy_model_of_the_ten_rows(pair):
    """Healthy sun and planet, recomputed; and below 3 % of the finite elements in all rows, in mean and maximum."""
    rows = [r for r in herringbone_page.load("herringbone") if (r["pair"], r["method"]) == (pair, "ritz3d")]
    if pair == "sun_planet":
        chosen = gf.load_scene("herringbone").pairs[pair]
        found = solve_fitted(chosen.case(), gf.Solve("ritz3d", damage_cycle(chosen)[::8]))
        healthy = read_curves(gf.load_scene("herringbone"))[pair, None][1][::8]
        assert_allclose(found.k, healthy, rtol=float(rows[0]["largest error at a phase"]) + 1e-4)
    assert len(rows) == 5
    for row in rows:
        assert max(abs(float(row["error of mean"])), abs(float(row["error of max"]))) < 0.03

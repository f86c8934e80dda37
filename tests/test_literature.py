"""What others print: the articles' machines with their verdicts, and boundary elements, other finite elements, codes, standards.

Whether gearfe finds a printed number is a recorded verdict (`validation/pages/tables/*.csv`): a test computes the number again
and fails if the verdict changes, either way. Numbers of long simulations are computed again with their pages alone.
"""

import functools
import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.scene import verdicts
from validation.make import machines, truth
from validation.shared import page as pages
from validation.shared import places, reference, table_rows

TABLES = reference.load()


def rows(name):
    return [
        pytest.param(row, TABLES[name], id=str(row.get("name", {k: v for k, v in row.items() if k != "value"})))
        for row in TABLES[name]["rows"]
    ]


@pytest.mark.parametrize(("row", "table"), rows("tooth_deflection"))
def test_tooth_deflection(row, table):
    assert_allclose(reference.tooth_deflection(row), row["value"], rtol=table["tolerance"], err_msg=table["source"])


@pytest.mark.parametrize(("row", "table"), rows("single_pair"))
def test_single_pair_stiffness(row, table):
    assert_allclose(reference.single_pair(row, table), row["value"], rtol=table["tolerance"], err_msg=table["source"])


@pytest.mark.slow
@pytest.mark.parametrize(("row", "table"), rows("root_stress"))
def test_root_stress(row, table):
    assert_allclose(reference.root_stress(row), row["value"], rtol=table["tolerance"], err_msg=table["source"])


@pytest.mark.quick
@pytest.mark.parametrize("method", ["fe", "ritz"])
@pytest.mark.parametrize(("row", "table"), rows("healthy"))
def test_healthy_curves(row, table, method):
    assert_allclose(reference.healthy(row, method=method), row["value"], rtol=table["tolerance"], err_msg=table["source"])


def test_few_teeth_on_a_plain_rim_are_too_soft():
    """What the `teeth` option costs: a 5-tooth model is 0.05 to 0.4 % softer at its stiffest, in double contact."""
    row = TABLES["healthy"]["rows"][3]
    whole, five = reference.healthy(row, method="fe"), reference.healthy(row, teeth=5)
    loss = 1 - five[1] / whole[1]
    assert 0.0005 < loss < 0.004, f"5 teeth: {100 * loss:.2f} % softer"


@pytest.mark.quick
def test_beam_code_with_its_conventions():
    got = reference.beam_code()
    for row in TABLES["beam_code"]["rows"]:
        assert_allclose(got[row["quantity"]], row["value"], rtol=TABLES["beam_code"]["tolerance"], err_msg=row["quantity"])


@pytest.mark.slow
@pytest.mark.parametrize(("row", "table"), rows("formulations"))
def test_errors_of_the_textbook(row, table):
    for zone, errors in zip(("single", "double"), reference.formulation(row, teeth=5), strict=True):
        assert_allclose([errors.min(), errors.max()], row[zone], atol=table["tolerance"], err_msg=f"{zone}: {table['source']}")


@pytest.mark.slow
@pytest.mark.parametrize(("row", "table"), rows("load_trend"))
def test_error_of_the_textbook_moves_with_the_load(row, table):
    composed, whole = reference.load_trend(row["line_load"])
    assert_allclose(composed, row["value"], atol=table["tolerance"], err_msg=table["source"])
    assert 1.0 < whole - composed < 2.5, "the source's own truth is stiffer than the whole contact"


@pytest.mark.quick
def test_iso_stiffness():
    got = reference.iso()
    for row, rtol in zip(TABLES["iso"]["rows"], (1e-5, 1e-4, 1e-4), strict=True):
        assert_allclose(got[row["quantity"]], row["value"], rtol=rtol, err_msg=row["quantity"])


def test_hertz_constant_of_article_s0():
    """S0 prints K = 3.0459e5 N/mm^1.5 = 4/3 sqrt(R) E* with the curvature radii r sin(20) of the pitch point."""
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 20.0}
    pair = gf.GearPair(gf.Gear(z=21, r_bore=7.4, **rack), gf.Gear(z=31, r_bore=11.4, **rack))
    rho = pair.curvature_radii(pair.pitch_phase)
    from gearfe.flexibility.hertz import contact_modulus

    steel = gf.Material(E=207e3, nu=0.25)
    assert_allclose(4 / 3 * np.sqrt(rho[0] * rho[1] / sum(rho)) * contact_modulus((steel, steel)), 3.0459e5, rtol=2e-5)


@functools.cache
def now(page, name):
    """Rows of a reference computed now, by case and pair."""
    return {row[1:3]: row for row in machines.computed(page, {name})}


def printed():
    """Rows of all machines but those of long simulations, which their pages compute again."""
    for page in machines.PAGES:
        by_id, soon = {one.id: one for one in machines.references(page)}, machines.functions(page, quick=True)
        for row in table_rows.read(page):
            name = "-".join(filter(None, (page, row.id, row.case, row.pair)))
            if row.id in soon:
                yield pytest.param(page, row, by_id[row.id], id=name)


@pytest.mark.quick
@pytest.mark.parametrize(("page", "row", "source"), list(printed()))
def test_verdict_on_a_printed_number(page, row, source):
    found = now(page, row.id)
    ours = found[row[1:3]].ours
    if row.verdict == verdicts.NEVER:
        assert math.isnan(ours), "something is computed now: judge it"
        return
    if row.verdict not in (verdicts.NOT, verdicts.TREND):
        assert_allclose(ours, row.ours, rtol=1e-2, atol=1e-9, err_msg="not as on the page: run python -m validation PAGE")
    if row.verdict == verdicts.FORMULA:
        return
    target = row.printed if math.isnan(row.corrected) else row.corrected
    met = source.within(ours, target)
    if row.verdict == verdicts.ASSUMED:
        assert met or source.trend
        return
    assert met == (row.verdict in (verdicts.REPRODUCED, verdicts.CORRECTED)), f"{source.source}: {row.printed}, found {ours}"
    if row.verdict == verdicts.TREND:
        values = [
            one.ours
            for one in sorted(found.values(), key=lambda one: one.printed if math.isnan(one.corrected) else one.corrected)
        ]
        assert values == sorted(values), f"{source.source}: the order of the cases"
    assert found[row[1:3]].verdict == row.verdict, "the recorded verdict no longer holds: run python -m validation PAGE"


@pytest.mark.parametrize("page", machines.PAGES)
def test_every_machine_has_rows_in_the_ordinary_run(page):
    soon = set(machines.functions(page, quick=True))
    assert soon <= set(machines.functions(page))
    again = [row for row in table_rows.read(page) if row.id in soon]
    assert {row.verdict for row in again} & {verdicts.REPRODUCED, verdicts.CORRECTED}
    assert {row.verdict for row in again} & {verdicts.NOT, verdicts.TREND}, "some that gearfe does not find, too"


def test_truth_page_is_not_stale():
    assert pages.read("truth")[0] == truth.text(), "run python -m validation truth"


def test_rows_of_the_truth_page():
    rows = {row[:2]: row for row in truth.read()}
    assert {key for key, row in rows.items() if not row.holds} == set(truth.REASONS)
    assert set(TABLES) <= {table for table, _ in rows}, "a table of reference.toml without a row on the page"
    for row in truth.quick_rows(TABLES):
        assert_allclose(row.ours, rows[row[:2]].ours, rtol=1e-5, atol=1e-9, err_msg=str(row[:2]))
        assert row.holds == (row[:2] not in truth.REASONS), row


def test_contact_in_calculix_as_committed():
    """The pair of the frozen page, used in no scene and no other test. Near the ends of double contact k changes steeply."""
    rack = {"m_n": 2.5, "alpha_n": math.radians(20), "b": 20.0}
    pair = gf.GearPair(gf.Gear(z=23, x=0.2, r_bore=12.0, **rack), gf.Gear(z=37, x=-0.05, r_bore=20.0, **rack))
    phase, ours, theirs = np.loadtxt(places.TABLES / "calculix.csv", delimiter=",", skiprows=1, unpack=True)
    far = np.abs((phase[:, None] - [0.0, pair.eps_alpha % 1.0] + 0.5) % 1.0 - 0.5).min(axis=1) >= 0.06
    assert far.sum() >= 6
    again = gf.mesh_stiffness(pair, 150.0 * 20.0, gf.Material(E=206e3, nu=0.3), phases=phase).k
    assert_allclose(again, ours, rtol=1e-4, err_msg="the frozen rows of the page truth")
    assert_allclose(again[far], theirs[far], rtol=0.005, err_msg="nonlinear contact of both gears in CalculiX")
    assert_allclose(again, theirs, rtol=0.02, err_msg="the same near the ends of double contact")

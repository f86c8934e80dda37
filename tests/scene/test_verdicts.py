"""Verdicts: what a row is judged by, what counts, and what the scenes say of themselves."""

import math
import re

import pytest

import gearfe as gf
from gearfe.scene import verdicts
from gearfe.scene.references import Printed, Reference
from gearfe.scene.schema import scene_schema

SCENES = ("planetary_pitting", "compound_planetary", "helical_pitting", "herringbone")


def reference(*rows, relative=0.03, absolute=None, trend=False, unit="N/m"):
    return Reference("k", "stiffness", unit, "table", relative, absolute, "because", trend, "", tuple(rows))


def printed(case, value, corrected=None, correction="", reason="why", kind="model"):
    return Printed(case, None, value, corrected, correction, reason, kind)


def judged(ours, *rows, **options):
    one = reference(*rows, **options)
    return verdicts.judge(one, {row.case: value for row, value in zip(rows, ours, strict=True)})


def test_a_value_that_its_row_calls_swapped_is_not_reproduced():
    """S4, planet3: 1.2506 is 1.7 % from the printed 1.23, but the row says 1.15 is meant: +8.7 %."""
    (row,) = judged([1.2506], printed("planet3", 1.23, corrected=1.15, correction="rows swapped"))
    assert row.verdict == verdicts.NOT
    assert row.difference == pytest.approx(8.75, abs=0.01)
    one = reference(printed("planet3", 1.23, corrected=1.15, correction="rows swapped"))
    assert verdicts.reasons(one, row) == ["rows swapped", "why"]


def test_the_corrected_value_is_reproduced_after_a_correction():
    (row,) = judged([1.16], printed("planet3", 1.23, corrected=1.15, correction="rows swapped"))
    assert row.verdict == verdicts.CORRECTED
    (row,) = judged([1.23], printed("a", 1.23, correction="other formula"))
    assert row.verdict == verdicts.CORRECTED


def test_agreement_that_an_assumption_sets_is_none():
    """The healthy range of S4's sun is that of the runout assumed; where it does not agree, it is as wrong as any."""
    rows = [Printed(str(value), None, value, None, "", "why", "model", "the runout assumed") for value in (1.0, 2.0)]
    found = judged([1.01, 3.0], *rows)
    assert [row.verdict for row in found] == [verdicts.ASSUMED, verdicts.NOT]
    assert verdicts.reasons(reference(*rows), found[0]) == ["the runout assumed"]
    assert verdicts.counts(found) == "2 numbers of a model: 1 set by an assumption, 1 not reproduced"
    assert [row.verdict for row in judged([5.0, 9.0], *rows, trend=True)] == [verdicts.ASSUMED] * 2
    corrected = Printed("a", None, 2.0, 1.0, "swapped", "why", "model", "the runout assumed")
    assert judged([1.0], corrected)[0].verdict == verdicts.ASSUMED


def test_the_order_is_that_of_the_corrected_values():
    rows = [printed("a", 2.0, corrected=1.0, correction="swapped"), printed("b", 1.0, corrected=2.0, correction="swapped")]
    assert [row.verdict for row in judged([5.0, 9.0], *rows, trend=True)] == [verdicts.TREND] * 2
    assert [row.verdict for row in judged([9.0, 5.0], *rows, trend=True)] == [verdicts.NOT] * 2


@pytest.mark.parametrize(
    ("change", "word"), [(0.32, "not reproduced"), (0.34, "trend only"), (2.9, "trend only"), (3.1, "not reproduced")]
)
def test_a_trend_changes_by_a_third_to_three_times_the_printed_change(change, word):
    rows = printed("healthy", 10.0), printed("faulty", 11.0)
    assert [row.verdict for row in judged([20.0, 20.0 + 2 * change], *rows, trend=True)] == [word] * 2


def test_the_headline_counts_results_of_a_model_only():
    rows = judged(
        [1.0, 1.0, 1.0, 2.0, None, 1.0],
        printed("typed", 1.0, kind="input"), printed("sum", 1.0, kind="arithmetic"), printed("good", 1.0), printed("bad", 1.0),
        printed("measured", 1.0), printed("formula", math.nan),
    )  # fmt: skip
    told = verdicts.counts(rows)
    assert told.startswith("3 numbers of a model: 1 reproduced, 1 not reproduced, 1 not reproducible; apart from them 2 inputs")
    assert told.endswith("1 value without a printed number")


def test_three_rows_with_one_verdict_are_one_line_with_ranges():
    one = reference(*(printed(case, value) for case, value in zip("abcd", (1e6, 2e6, 4e6, 1e6), strict=True)))
    rows = verdicts.judge(one, {"a": 3e6, "b": 3e6, "c": 6e6, "d": 1e6})
    lines = next(line for line in verdicts.listed([one], rows) if "|" in line).splitlines()[2:]
    assert "| a to c (3) | model | 1 to 4 | 3 to 6 | +50.00 % to +200.00 % | **not reproduced** |" in lines[0]
    assert "| d |  | 1 | 1 |  | reproduced |" in lines[1]
    assert len(lines) == 2


def test_kinds_are_known(tmp_path):
    scene = gf.load_scene("herringbone")
    assert {row.kind for one in scene.references for row in one.rows} == set(scene_schema()["reference"].keys["kind"].choices)


@pytest.mark.parametrize("name", SCENES)
def test_every_reference_of_the_scenes_states_its_kind(name):
    from importlib import resources

    text = (resources.files("gearfe.scene.scenes") / f"{name}.toml").read_text(encoding="utf-8")
    for table in text.split("[[reference]]")[1:]:
        head = table.split("rows = [")[0]
        assert re.search(r'^kind = "(input|arithmetic|model)"$', head, re.M), head


@pytest.mark.parametrize("name", SCENES)
def test_tolerances_have_reasons_and_results_can_fail(name):
    for one in gf.load_scene(name).references:
        assert len(one.tolerance) > 8, f"{one.id}: {one.tolerance!r} is no reason"
        for row in one.rows:
            if row.kind == "model" and not math.isnan(row.value) and one.unit != "statement":
                assert not one.within(2.0 * row.target + 1e-12, row.target), f"{one.id}, {row.case}: twice the value would pass"
                assert not one.within(0.5 * row.target - 1e-12, row.target), f"{one.id}, {row.case}: half the value would pass"


def test_what_the_planetary_scene_says_of_its_pulses_is_what_runs():
    scene = gf.load_scene("planetary_pitting")
    impact = scene.machine["impact"]
    told = next(one["what"] for one in scene.assumptions if one["what"].startswith("impact law"))
    assert f"{impact['pulse_Nm']:g} N m" in told
    assert f"{1e3 * impact['pulse_width_s']:g} ms" in told
    assert f"{impact['pulse_period_s']:g} s" in told


def test_what_the_herringbone_scene_says_of_its_errors_is_what_runs():
    scene = gf.load_scene("herringbone")
    told = next(one["what"] for one in scene.assumptions if one["what"].startswith("errors"))
    for key in ("profile_error_um", "runout_um", "misplaced_y_um", "backlash_um"):
        assert f"{scene.machine[key]:g} um" in told, key


def test_values_that_are_nearly_one_have_no_order():
    """Two of ours within a thousandth rise only by rounding."""
    rows = printed("a", 1.0), printed("b", 1.002)
    assert [row.verdict for row in judged([5.0, 5.004], *rows, trend=True)] == [verdicts.NOT] * 2
    assert [row.verdict for row in judged([5.0, 5.006], *rows, trend=True)] == [verdicts.TREND] * 2

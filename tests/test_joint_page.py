"""Joint draws of inputs that articles do not print: the draws, the machine that one changes, and what the page says of them."""

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from validation.make import joint, machines, planetary_numbers, planetary_repeats
from validation.shared import joint_inputs, simulated, table_rows
from validation.shared import page as pages
from validation.shared.kept_rows import stored

PAGES = list(joint_inputs.RANGES)


@pytest.mark.parametrize("page", PAGES)
def test_every_input_is_drawn_once_in_each_part_of_its_range(page):
    """A Latin hypercube: sorted, the draws of an input lie one in each of so many equal parts of its logarithm."""
    found = joint_inputs.draws(page)
    assert len(found) == joint_inputs.DRAWS
    for name, (low, high) in joint_inputs.RANGES[page].items():
        place = np.sort([math.log(one[name] / low) / math.log(high / low) for one in found]) * joint_inputs.DRAWS
        assert (np.floor(place) == np.arange(joint_inputs.DRAWS)).all(), name
    assert joint_inputs.draws(page) == found, "the same every time"


@pytest.mark.slow
def test_a_draw_changes_the_machine_as_it_says():
    made = simulated.machine("herringbone")
    one = joint_inputs.Draw("herringbone_machine", 0, (("load", 0.5), ("supports", 4.0), ("groove", 9.0), ("damping", 2.0)))
    got = joint_inputs.changed(made, one)
    before, after = ({s.name: s for s in m.springs} for m in (made, got))
    assert_allclose(after["sunL-ground x"].k, 4 * before["sunL-ground x"].k)
    assert_allclose(after["sunL-ground x"].c, 2 * 2 * before["sunL-ground x"].c, err_msg="the ratio twice, the stiffness 4 times")
    assert_allclose(after["sun groove theta"].k, 9 * before["sun groove theta"].k)
    assert_allclose(after["sunL-ground theta"].k, before["sunL-ground theta"].k, err_msg="the drive is another input")
    assert_allclose([one.value for one in got.loads], [0.5 * one.value for one in made.loads])
    assert got.meshes[0].error == made.meshes[0].error
    more = joint_inputs.changed(made, joint_inputs.Draw("herringbone_machine", 0, (("errors", 3.0), ("play", 0.5))))
    assert_allclose([e[0] for e in more.meshes[0].error], [3 * e[0] for e in made.meshes[0].error])
    assert_allclose(more.meshes[0].backlash, 0.5 * made.meshes[0].backlash)


def test_pulses_grow_with_the_load_and_by_themselves():
    made = simulated.own_law("planetary_pitting")
    got = joint_inputs.changed(made, joint_inputs.Draw("planetary_pitting", 0, (("load", 0.5), ("pulses", 3.0))))
    (times, was), (_, now) = (next(one.value for one in m.loads if one.name == "carrier torque") for m in (made, got))
    base, peak = was[0], was[np.argmax(np.abs(was))]
    assert_allclose(now[0], 0.5 * base)
    assert_allclose(now[np.argmax(np.abs(was))] - now[0], 0.5 * 3 * (peak - base))
    assert len(times) == len(now)


def test_a_mode_of_the_housing_raises_its_own_line():
    """An oscillator driven at its natural frequency answers with 1 / (2 zeta), far below with 1."""
    time = np.arange(4000) / 4000.0
    one = gf.Signal(np.sin(2 * np.pi * 200 * time) + np.sin(2 * np.pi * 2 * time), 4000.0, "m/s2")
    draw = joint_inputs.Draw("helical_pitting", 0, (("mode_over_f_m", 2.0), ("mode_damping", 0.05)))
    found = gf.spectrum(joint_inputs.through_mode(one, draw, 100.0))
    assert_allclose(gf.find_lines(found, {"mode": 200.0, "slow": 2.0})["mode"][1], 1 / (2 * 0.05), rtol=1e-3)
    assert_allclose(gf.find_lines(found, {"slow": 2.0})["slow"][1], 1.0, rtol=1e-3)


def test_what_decides_a_statement(monkeypatch):
    """On rows in which a statement holds where one input is large, that input is named; where nothing does, none."""
    rows = [{"inputs": dict(one.values)} for one in joint_inputs.draws("helical_pitting")]
    monkeypatch.setattr(joint, "rows_of", lambda _: rows)
    load = np.array([row["inputs"]["load"] for row in rows])
    half = joint_inputs.DRAWS // 2
    chance = 1 - (1 - 2 / math.comb(2 * half, half)) ** len(joint_inputs.RANGES["helical_pitting"])
    said = f"torque: {half}, 0 ({chance:.2g})"
    assert joint.decides("helical_pitting", load > np.median(load)) == said
    assert joint.decides("helical_pitting", np.ones(joint_inputs.DRAWS, bool)) == ""
    lone = np.zeros(joint_inputs.DRAWS, bool)
    lone[0] = True
    assert joint.decides("helical_pitting", lone) == "none"


@pytest.mark.parametrize("yes", range(1, 8))
def test_what_chance_makes_of_halves(yes):
    """All ways to place so many draws that hold among eight, counted one by one."""
    ways = [sum(2 * (place > 3) - 1 for place in one) for one in itertools.combinations(range(8), yes)]
    held = np.arange(8) < yes
    for apart in range(5):
        alone = float((np.abs(ways) >= apart).mean())
        assert_allclose(joint.by_chance(apart, held, 1), alone, atol=1e-12)
        assert_allclose(joint.by_chance(apart, held, 3), 1 - (1 - alone) ** 3, atol=1e-12)


@pytest.mark.parametrize("page", PAGES)
def test_pages_say_what_the_draws_found(page):
    rows = [row for key, row in stored("joint").items() if key.startswith(f"{page} ")]
    assert len(rows) == joint_inputs.DRAWS, "run python -m validation joint"
    for row, draw in zip(joint.rows_of(page), joint_inputs.draws(page), strict=True):
        assert_allclose(list(row["inputs"].values()), [value for _, value in draw.values])
    text = pages.read(page)[0]
    assert machines.drawn_jointly(page) in text
    for line in joint.section(page, machines.decided(page, table_rows.read(page))):
        assert line in text
    assumed = {row.case for row in table_rows.read(page) if row.verdict == "set by an assumption"}
    assert sum(joint.counts(page)) == len(set(joint.said(page)) - assumed)


@pytest.mark.slow
def test_a_draw_is_computed_again():
    """The cheapest page's first draw gives the row on file."""
    draw = joint_inputs.draws("helical_pitting")[0]
    assert joint.home("helical_pitting").drawn(draw)["holds"] == stored("joint")["helical_pitting 00"]["holds"]


def test_pits_of_a_level_lie_on_one_line():
    """S0: L = b - N l; with pits 1 mm wide, 5, 10 and 15 of the 20 mm go at once, in rows of five always 5 mm."""
    found = planetary_numbers.line_length()
    assert_allclose([found[f"{case}, least"] for case in planetary_numbers.CASES], [15.0, 10.0, 5.0], rtol=1e-3)
    own = simulated.scene("planetary_pitting").pairs["sun_planet"]
    for case in planetary_numbers.CASES:
        row = own.damage[case]["pinion"]
        assert len(row) == len(own.damage[f"{case}_rows"]["pinion"])
        assert {pit.radius for pit in row} == {own.pair.pitch_radius_1}
        assert min(b.z - a.z for a, b in zip(row, row[1:], strict=False)) > 2 * row[0].axes[1], "they do not overlap"


def test_levels_are_apart_where_their_ranges_are():
    case = dict(zip(planetary_repeats.CASES, ([1.0, 2.0], [2.1, 3.0], [3.1, 3.2]), strict=True))
    assert planetary_repeats.apart(case)
    assert not planetary_repeats.apart(case | {"moderate": [1.9, 3.0]})
    falling = {name: [-x for x in values] for name, values in case.items()}
    assert not planetary_repeats.apart(falling), "a centroid that falls does not rise with severity"
    assert planetary_repeats.apart(falling, rising=False), "but tells the levels apart"


@pytest.mark.slow
def test_a_crack_of_60_percent_is_case_3_without_pits():
    from validation.make import herringbone_runs

    crack, both, healthy = (herringbone_runs.made(case) for case in (herringbone_runs.CRACK60, "case3", None))
    k = [one.meshes[0].changes[0][2].cells[:, 0].min() for one in (crack, both)]
    assert not healthy.meshes[0].changes
    assert k[0] < 0, "a crack lowers the stiffness"
    assert k[1] < k[0] < 0.9 * k[1], "the pits of case 3 take a little more"
    assert replace(crack, meshes=()).dofs == healthy.dofs


def test_lines_of_drawn_records_do_not_leak():
    """Records of draws hold whole periods of mesh and fault lines: else a healthy mesh line leaks into a sideband."""
    from validation.make import compound_planetary, helical_pitting, herringbone_runs, planetary_runs

    mesh, fault = compound_planetary.frequencies()
    lines = [(compound_planetary.DRAWN, f) for f in (*mesh, *fault)]
    lines += [(planetary_runs.DRAWN, f) for f in planetary_runs.speeds()[2:]]
    lines += [(helical_pitting.SECONDS, f) for f in helical_pitting.frequencies().values()]
    lines += [(herringbone_runs.SECONDS, f) for f in herringbone_runs.speeds()[2:]]
    for seconds, frequency in lines:
        assert abs(seconds * frequency - round(seconds * frequency)) < 1e-6, f"{frequency} Hz in {seconds} s"


def test_what_is_printed_of_the_measured_acceleration_is_counted_on_it(monkeypatch):
    """A force whose RMS never rises says nothing of the ring's acceleration, whose RMS the articles print."""
    held = {planetary_repeats.FORCE: False, planetary_repeats.SENSOR: True}
    rows = [{"holds": {"rms rises with severity": held, "impacts raise the force": {planetary_repeats.FORCE: False}}}] * 3
    monkeypatch.setattr(joint, "rows_of", lambda _: rows)
    assert {word: found.all() for word, found in joint.judged("planetary_pitting").items()} == {
        "rms rises with severity": True,
        "impacts raise the force": False,
    }
    assert joint.counts("planetary_pitting") == (1, 1, 0)
    assert joint.judges("planetary_pitting").startswith("the first one. For 'rms rises with severity', ")
    assert joint.judges("helical_pitting") == "the first one"

"""What damage takes: beside the healthy pair, one number for one question wherever it is asked."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.app.cli import main
from gearfe.comparison.compare import beside_health, compare_cases
from gearfe.comparison.losses import (
    damage_phases,
    damaged_teeth,
    headline,
    kind_of,
    loss,
    loss_errors,
    percent_with_doubt,
    told_damage,
    within,
)
from gearfe.comparison.told_scene import told_supports
from gearfe.stiffness.methods import METHODS


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    path = tmp_path_factory.mktemp("losses") / "my.toml"
    return gf.new_scene(path, teeth=(17, 23), width=8.0)


@pytest.fixture(scope="module")
def found(scene):
    return gf.compare(scene, case="cracked", phases=16)


@pytest.mark.slow
def test_healthy_curves_are_of_the_same_phases(found):
    assert found.healthy.keys() == found.curves.keys()
    for name, curve in found.healthy.items():
        assert_allclose(curve.phase, found.curves[name].phase, rtol=0, atol=1e-12)
        assert (curve.k >= found.curves[name].k * (1 - 1e-9)).all(), name
        assert "damage" not in curve.meta or not any(curve.meta["damage"].values())


def test_mean_of_a_healthy_pair_is_the_same_over_any_cycle(found, scene):
    healthy = gf.compare(scene, phases=16)
    by_zone = {row.zone: row.k for row in healthy.rows() if row.method == "fe"}
    same = within(found.healthy["fe"], found.first_tooth()[1]).zones()
    for zone in ("single", "double", "mean", "max"):
        assert_allclose(same[zone], by_zone[zone], rtol=1e-6, err_msg=zone)


def test_phases_have_the_tooth_in_the_middle_and_in_contact(pair):
    for tooth in (0, 2, -1):
        phase = damage_phases(gf.Case(pair, 1000.0, gf.Material()), 64, tooth) + tooth
        assert abs(phase.mean() - pair.eps_alpha / 2) < 1 / 64
        assert 0 <= phase.min() < phase.max() <= pair.eps_alpha
        assert_allclose(np.sort(phase % 1), np.arange(64) / 64, atol=1e-12)


@pytest.mark.slow
def test_every_method_has_a_column_or_a_reason(found, scene):
    for one in (
        found,
        gf.compare("planetary_pitting", "planet_ring", phases=4, refine=0.35),
    ):
        assert one.curves.keys() | one.left_out.keys() == set(METHODS)
        assert not one.curves.keys() & one.left_out.keys()
    assert "healthy gears only" in found.left_out["coupled"]
    assert "not for rings" in one.left_out["textbook"]


@pytest.mark.slow
def test_losses_are_judged_by_a_finer_solve(found, scene):
    """The estimate covers what a two and a half times finer mesh of the finite elements changes."""
    rough = gf.compare(scene, case="cracked", phases=16, refine=0.4)
    for zone, value in rough.losses()["fe"].items():
        assert abs(found.losses()["fe"][zone] - value) <= rough.first_tooth()[2][zone], zone


def test_case_and_cases_give_the_same_numbers(found, scene):
    every = compare_cases(gf.load_scene(scene), phases=16)
    assert every.subject == found.subject == ("stage", "cracked")
    fe = [[row.k for row in one.rows() if row[:3] == ("stage", "cracked", "fe")] for one in (every, found)]
    assert_allclose(*fe, rtol=1e-6)
    for name in ("fe", "ritz", "textbook", "herringbone_article"):
        one, other = every.losses()[name], found.losses()[name]
        assert one.keys() == other.keys()
        assert_allclose(list(one.values()), list(other.values()), rtol=1e-5)


@pytest.mark.slow
def test_terminal_report_and_python_say_the_same(found, scene, capsys):
    assert main(["compare", str(scene), "--case", "cracked", "--phases", "16"]) == 0
    text = capsys.readouterr().out
    assert text.splitlines()[2] == found.headline
    cells = [[cell.strip() for cell in line.split("|")[1:-1]] for line in text.splitlines() if line.startswith("| ")]
    for row in found.loss_table().cells():
        assert row in cells
    assert "assumed: bore" in text
    assert main(["compare", str(scene), "--cases", "--phases", "16"]) == 0
    told = capsys.readouterr().out
    single, mean = re.findall(r"(\d+\.\d) ±", found.headline)
    assert f"{mean} % on average" in told
    assert float(single) > float(mean)


def test_losses_of_known_curves():
    """Half of a cycle with two pairs, 300 N/um, loses a tenth; the other, 200 N/um, a fifth."""
    phase, none = np.arange(8) / 8, np.zeros((8, 1))
    k = np.where(phase <= 0.5, 3e8, 2e8)
    made = [
        gf.StiffnessCurve(phase, one, one, none[:, 0], np.array([0]), none, none, meta={"eps_alpha": 1.5})
        for one in (k, k * np.where(phase <= 0.5, 0.9, 0.8))
    ]
    lost = loss(*made)
    assert_allclose([lost["double"], lost["single"], lost["most at a phase"]], [0.1, 0.2, 0.2], rtol=1e-12)
    assert_allclose(lost["mean"], (5 * 30 + 3 * 40) / (5 * 300 + 3 * 200), rtol=1e-12)
    assert headline("a crack", "cracked", lost, {}).endswith(
        "20.0 % softer where the cracked tooth carries alone; 12.9 % on average"
    )


def test_doubt_by_whole_gears_adds_both_estimates():
    """Finite elements in three dimensions are not solved again: 1 % of healthy and 2 % of damaged k make 3 % of what is left."""
    phase, none = np.arange(8) / 8, np.zeros((8, 1))
    two = [
        gf.StiffnessCurve(phase, k, k, none[:, 0], np.array([0]), none, none, error=part * k, meta={"eps_alpha": 1.5})
        for k, part in ((np.full(8, 3e8), 0.01), (np.full(8, 2.4e8), 0.02))
    ]
    case = gf.load_scene("planetary_pitting").case()
    doubt = loss_errors(*two, case, gf.Solve("fe3d"))
    assert doubt.keys() == loss(*two).keys()
    assert_allclose(list(doubt.values()), 0.8 * 0.03, rtol=1e-12)
    assert loss_errors(*two, case, gf.Solve("fe", refine=0.3)) == {}, "there are no meshes so coarse"


def test_doubts_are_rounded_up():
    assert percent_with_doubt(0.158, 0.00201) == "15.8 ± 0.3 %"
    assert percent_with_doubt(0.158, 0.0) == "15.8 ± 0.1 %"
    assert percent_with_doubt(0.158, float("nan")) == "15.8 %"


def test_damage_in_words(pair):
    pit = gf.Pit(radius=21.0, z=10.0, axes=(0.5, 0.5), depth=0.2)
    crack = gf.Crack(length=2.0, angle=np.radians(60))
    assert told_damage(pair, {"pinion": [crack]}) == "2 mm crack at 60 degrees"
    assert told_damage(pair, {"pinion": [crack], "wheel": [replace(crack, length=1.0)]}) == "2 cracks"
    assert told_damage(pair, {"pinion": [gf.Crack(level=0.7, turning=True)]}).startswith("turning crack of level 0.7")
    assert kind_of({"pinion": [crack]}) == "cracked"
    assert told_damage(pair, {"pinion": [crack, pit]}) == "2 mm crack at 60 degrees and 1 pit"
    assert [kind_of({"pinion": one}) for one in ([crack], [pit], [crack, pit])] == ["cracked", "pitted", "damaged"]


def test_reference_that_cannot_be_is_refused(scene):
    with pytest.raises(ValueError, match="must be one of fe, ritz3d, fe3d"):
        gf.compare(scene, reference="textbook")
    with pytest.raises(ValueError, match="pits change along the width"):
        gf.compare("planetary_pitting", case="mild", reference="fe")


def test_what_shafts_and_springs_take_is_told(scene, tmp_path, capsys):
    text = scene.read_text()
    springs = re.search(r"^#\[support\.output\]\n(#.*\n)+?#radial_N_per_um.*\n", text, re.M)[0]
    text = text.replace(springs, springs.replace("\n#", "\n")[1:])
    (tmp_path / "soft.toml").write_text(text)
    assert main(["stiffness", str(tmp_path / "soft.toml"), "--phases", "8"]) == 0
    (alone,) = re.findall(
        r"cause \d+ % of the deflection, which k contains; teeth and gear bodies alone have (\S+) N/um", capsys.readouterr().out
    )
    chosen = gf.load_scene(scene).pair()
    rigid = gf.mesh_stiffness(chosen.case(), phases=8)
    assert float(alone) == pytest.approx(rigid.k.mean() / 1e6, rel=0.01)
    assert not told_supports(rigid)


@pytest.mark.parametrize("hurt", [
    gf.Crack(length=2.0, tooth=5), gf.MissingTooth(tooth=5), gf.Chip(depth=1.0, tooth=5),
    gf.Pit(radius=21.0, z=10.0, axes=(0.5, 4.0), depth=0.2, tooth=5), gf.Flank(pitch=[0.02 * (k == 5) for k in range(21)]),
], ids=lambda hurt: type(hurt).__name__)  # fmt: skip
def test_a_tooth_out_of_sight_is_pointed_out(hurt):
    """Tooth 5 is not in mesh between phases 0 and 1."""
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 20.0}
    pair = gf.GearPair(gf.Gear(z=21, r_bore=7.4, **rack), gf.Gear(z=31, r_bore=11.4, **rack))
    options = {"flanks": {"pinion": hurt}} if isinstance(hurt, gf.Flank) else {"damage": {"pinion": [hurt]}}
    case = gf.Case(pair, 2000.0, gf.Material(), **options)
    with pytest.warns(UserWarning, match="no tooth with damage or deviations is in contact"):
        unseen = gf.mesh_stiffness(case, phases=4)
    seen = gf.mesh_stiffness(case, phases=[*(unseen.phase - 5), *(unseen.phase - 4)])
    assert abs(seen.te - np.tile(unseen.te, 2)).max() > 1e-7


def test_pair_20_has_tooth_3_of_17_and_tooth_20_of_38():
    rack = {"m_n": 3.0, "alpha_n": math.radians(20), "b": 15.0}
    pair = gf.GearPair(gf.Gear(z=17, r_bore=10.9, **rack), gf.Gear(z=38, r_bore=26.6, **rack))
    damage = {"pinion": [gf.Crack(length=2.0, tooth=3)], "wheel": [gf.Crack(length=2.0, tooth=20)]}
    told = damaged_teeth(gf.Case(pair, 1000.0, gf.Material(), damage=damage))
    assert {one.pair: one.words for one in told} == {
        3: "tooth 3 of the pinion: 2 mm crack at 45 degrees",
        20: "tooth 3 of the pinion and tooth 20 of the wheel: 2 cracks",
    }


@pytest.mark.parametrize("other", [gf.Chip(depth=0.4), gf.Crack(length=2.0)])
def test_chips_of_both_gears_in_one_pair_have_a_mesh_cycle_each(other):
    """In the middle of the engagement neither tip is in contact. Each loss is that of the chip alone in the same cycle."""
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 20.0}
    pair = gf.GearPair(gf.Gear(z=21, r_bore=9.2, **rack), gf.Gear(z=31, r_bore=14.2, **rack))
    case = gf.Case(pair, 2000.0, gf.Material(), damage={"pinion": [gf.Chip(depth=0.4)], "wheel": [other]})
    found = beside_health(case, gf.Solve("ritz", 32))
    first, second = found.by_tooth()
    assert first.headline.startswith("tooth 0 of the pinion: chip 0.4 mm deep at 45 degrees: the mesh is ")
    for side, one in (("pinion", first), ("wheel", second)):
        alone = beside_health(replace(case, damage={side: case.damage[side]}), gf.Solve("ritz", 32))
        losses, wanted = one.losses()["ritz"], alone.losses()["ritz"]
        assert losses["mean"] > 0.02
        if isinstance(other, gf.Chip):
            assert_allclose([losses[zone] for zone in wanted], list(wanted.values()), atol=1e-4)
    assert "chipped" in first.definition


def test_damage_of_the_unloaded_flank_is_described_as_such():
    """A planet's chip on the flank of the sun does not change the mesh with the ring."""
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 20.0}
    pair = gf.GearPair(gf.Gear(z=21, r_bore=9.2, **rack), gf.Gear(z=31, r_bore=14.2, **rack))
    told = {}
    for side in ("loaded", "unloaded"):
        case = gf.Case(pair, 2000.0, gf.Material(), damage={"wheel": [gf.Chip(depth=0.4, tooth=3, side=side)]})
        told[side] = [one.words for one in damaged_teeth(case)]
    words = "tooth 3 of the wheel: chip 0.4 mm deep at 45 degrees"
    assert told == {"loaded": [words], "unloaded": [f"{words} on the unloaded flank"]}

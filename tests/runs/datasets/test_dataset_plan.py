"""What a data set may hold: what is refused, how conditions are drawn and split."""

import copy

import numpy as np
import pytest

from gearfe.runs.datasets.conditions import _dealt, conditions
from gearfe.runs.datasets.plan import read_plan

pytestmark = pytest.mark.quick

SMALL = {
    "title": "cracks",
    "scene": "planetary_pitting",
    "seed": 3,
    "repeats": 4,
    "window": {"seconds": 0.05, "count": 2, "rate_Hz": 8000.0, "harmonics": 5},
    "operation": {"speed_rpm": [900.0, 1000.0], "torque_Nm": [100.0], "spread": 0.02},
    "fault": [{"kind": "crack", "gear": "sun", "severity": [0.2, 0.4]}, {"kind": "misplaced", "severity": [20.0]}],
    "sensor": [{"name": "ring", "channel": "ring.x acceleration", "noise": [0.0, 0.5]}],
    "scatter": {"machine.profile_error_um": {"uniform": [0.2, 1.0]}},
    "split": {"train": 0.5, "validation": 0.25, "test": 0.25},
}


def changed(**values):
    """`SMALL` with values at dotted places, ``window__rate_Hz``."""
    out = copy.deepcopy(SMALL)
    for place, value in values.items():
        home = out
        *path, last = [int(part) if part.isdigit() else part for part in place.split("__")]
        for part in path:
            home = home[part]
        home[last] = value
    return out


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (
            changed(fault__0__kind="rust"),
            "kind = 'rust', but it must be one of crack, pits, missing_tooth, chip, runout, misplaced",
        ),
        (changed(fault__0__severity=[0.2, 1.2]), r"severity = \[0\.2, 1\.2\], but each number must lie between 0\.01 and 0\.9"),
        (changed(fault__0__severity=[0.2, 0.2]), "give different numbers"),
        (changed(fault__0__gear="moon"), "no such gear|only the teeth"),
        (changed(fault__0__body="planet2"), r"damages body 'planet2' as \w+ of pair \w+, but bodies with this gear are sun"),
        (changed(fault__0__depth=1.0), "unknown key 'depth'"),
        (changed(fault=[]), "no damaged class"),
        (changed(window__rate_Hz=-1.0), "rate_Hz = -1"),
        (changed(window__count=0), "count = 0"),
        (changed(operation__speed_rpm=[]), "speed_rpm"),
        (changed(operation__spread=0.7), "spread = 0.7"),
        (changed(sensor__0__channel=None), "expected a text|give channel"),
        (changed(sensor__0__housing="planet_ring"), "one of them"),
        (changed(sensor__0__noise=[-1.0]), r"noise = \[-1\.0\], but each number must be at least 0"),
        (changed(split__train=0.9), "add up to 1"),
        (changed(split__by="luck"), "be one of condition, operation"),
        (changed(scatter={"machine.colour": {"uniform": [0, 1]}}), "colour"),
        (changed(scatter={"machine.speed_rpm": {"uniform": [900, 1000]}}), "set by the operation"),
        (changed(scatter={"machine.profile_error_um": {"uniform": [1.0, 0.2]}}), "rise"),
        (changed(scene="helical_pitting2"), "no scene"),
        (changed(title=3), "expected a text"),
        ("nowhere.toml", "no data set"),
    ],
)
def test_what_cannot_be_is_refused(given, said):
    with pytest.raises(ValueError, match=said):
        read_plan(given)


def test_file_and_dictionary_are_the_same(tmp_path):
    text = """
title = "cracks"
scene = "planetary_pitting"
seed = 3
repeats = 4
window = { seconds = 0.05, count = 2, rate_Hz = 8000.0, harmonics = 5 }
operation = { speed_rpm = [900.0, 1000.0], torque_Nm = [100.0], spread = 0.02 }
fault = [{ kind = "crack", gear = "sun", severity = [0.2, 0.4] }, { kind = "misplaced", severity = [20.0] }]
sensor = [{ name = "ring", channel = "ring.x acceleration", noise = [0.0, 0.5] }]
scatter = { "machine.profile_error_um" = { uniform = [0.2, 1.0] } }
split = { train = 0.5, validation = 0.25, test = 0.25 }
"""
    (tmp_path / "set.toml").write_text(text)
    assert read_plan(tmp_path / "set.toml").content() == read_plan(SMALL).content()


def test_conditions_are_every_combination_each_drawn_anew():
    every = conditions(read_plan(SMALL))
    assert len(every) == 2 * 4 * (1 + 2 + 1)
    assert [one.number for one in every] == list(range(32))
    assert every == conditions(read_plan(SMALL))
    assert len({one.speed for one in every}) == len({one.start for one in every}) == 32
    for one in every:
        assert abs(one.speed / [900, 1000][one.nominal] - 1) < 0.02
        assert 0.2 <= one.scatter["machine.profile_error_um"] <= 1.0
    other = conditions(read_plan(changed(seed=4)))
    assert all(one.speed != two.speed for one, two in zip(every, other, strict=True))


def test_every_class_is_split_by_shares():
    every = conditions(read_plan(SMALL))
    for label, severity in (("healthy", 0.0), ("crack", 0.2), ("crack", 0.4), ("misplaced", 20.0)):
        sides = [one.side for one in every if (one.label, one.severity) == (label, severity)]
        assert sorted(sides) == ["test"] * 2 + ["train"] * 4 + ["validation"] * 2, label


@pytest.mark.parametrize(
    ("shares", "sizes"), [((0.58, 0.22, 0.2), [6, 2, 2]), ((0.4, 0.28, 0.32), [4, 3, 3]), ((0.9, 0.05, 0.05), [8, 1, 1])]
)
def test_what_is_left_over_goes_where_most_is_missing(shares, sizes):
    """Ten of them by the largest remainders; every side that has a share has one at least."""
    dealt = _dealt(10, np.array(shares), np.random.default_rng(0), "ten")
    assert np.bincount(dealt, minlength=3).tolist() == sizes


def test_split_by_operation_shares_none():
    given = changed(split__by="operation", operation__speed_rpm=[700.0, 800.0, 900.0, 1000.0])
    sides = {}
    for one in conditions(read_plan(given)):
        sides.setdefault(one.nominal, set()).add(one.side)
    assert all(len(own) == 1 for own in sides.values())
    assert set.union(*sides.values()) == {"train", "validation", "test"}
    with pytest.raises(ValueError, match="2 combinations of speed and torque for 3 parts of the split"):
        conditions(read_plan(changed(split__by="operation")))
    with pytest.raises(ValueError, match=r"conditions of healthy for 3 sides|2 conditions"):
        conditions(read_plan(changed(repeats=1)))


def test_forces_go_with_the_torque():
    plan = read_plan(SMALL)
    scene = plan.scene_at({"machine.torque_Nm": 50.0}, plan.fault[0], 0.2)
    assert {pair.force for pair in scene.pairs.values()} == {1000.0}
    assert scene.pair().damage["fault"]["pinion"][0].level == 0.2
    assert plan.scene_at({}, plan.fault[1], 20.0).machine["misplaced_um"] == 20.0

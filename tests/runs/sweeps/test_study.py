"""What a study says: grids, samples and keys, and refusals that name what is wrong."""

import numpy as np
import pytest
from scipy import stats

from gearfe.runs.sweeps.blocks import blocks
from gearfe.runs.sweeps.study import read_study, values
from gearfe.scene.dotted_keys import set_values

pytestmark = pytest.mark.quick

CRACK = {"case": "cracked", "gear": "sun", "level": 0.2}
BASE = {"scene": "planetary_pitting", "pair": "sun_planet", "case": "cracked", "crack": [CRACK]}
STUDY = BASE | {
    "vary": {"crack": {"cracked": {"level": [0.1, 0.2]}}, "pair.sun_planet.force_N": {"from": 1000, "to": 2000, "count": 3}},
    "along": [{"gear.sun.r_bore_mm": [7.0, 7.4], "gear.planet.r_bore_mm": [11.0, 11.4]}],
}


def test_every_combination_once():
    columns, point, draw = values(read_study(STUDY))
    assert list(columns) == ["crack.cracked.level", "pair.sun_planet.force_N", "gear.sun.r_bore_mm", "gear.planet.r_bore_mm"]
    rows = list(zip(*columns.values(), strict=True))
    assert len(set(rows)) == len(rows) == 12
    assert set(columns["pair.sun_planet.force_N"]) == {1000.0, 1500.0, 2000.0}
    assert {row[2:] for row in rows} == {(7.0, 11.0), (7.4, 11.4)}
    assert point.tolist() == list(range(12))
    assert not draw.any()


def test_quoted_and_nested_keys_are_the_same_study():
    nested = BASE | {"vary": {"crack": {"cracked": {"level": [0.1, 0.2]}}}}
    quoted = BASE | {"vary": {"crack.cracked.level": [0.1, 0.2]}}
    assert read_study(nested).content() == read_study(quoted).content()


def test_logarithmic_steps():
    steps = {"from": 100, "to": 10000, "count": 3, "spacing": "log"}
    columns, *_ = values(read_study(BASE | {"vary": {"pair.sun_planet.force_N": steps}}))
    np.testing.assert_allclose(columns["pair.sun_planet.force_N"], [100, 1000, 10000])


def test_a_sample_has_its_distributions_and_correlation_and_meets_every_combination():
    sample = {
        "method": "sobol",
        "count": 1024,
        "of": {
            "gear.sun.x": {"normal": [0.0, 0.01]},
            "gear.planet.x": {"normal": [0.1, 0.02], "within": [0.07, 0.13]},
            "gear.sun.b_mm": {"uniform": [19.0, 21.0], "also": ["gear.planet.b_mm"]},
            "material.42Cr.nu": {"triangular": [0.28, 0.3, 0.31]},
            "gear.sun.z_cutter": {"choice": [20, 30]},
        },
        "correlated": [{"between": ["gear.sun.x", "gear.sun.b_mm"], "value": -0.6}],
    }
    columns, point, draw = values(read_study(STUDY | {"sample": sample, "seed": 3}))
    assert len(point) == 12 * 1024
    own = {key: np.array(column) for key, column in columns.items()}
    one = {key: column[point == 5] for key, column in own.items()}
    other = {key: column[point == 9] for key, column in own.items()}
    assert draw[point == 5].tolist() == list(range(1024))
    np.testing.assert_array_equal(one["gear.sun.x"], other["gear.sun.x"])
    np.testing.assert_array_equal(own["gear.sun.b_mm"], own["gear.planet.b_mm"])
    assert abs(np.std(one["gear.sun.x"]) - 0.01) < 1e-4
    assert one["gear.planet.x"].min() >= 0.07
    assert one["gear.planet.x"].max() <= 0.13
    truth = stats.truncnorm(-1.5, 1.5, 0.1, 0.02)
    assert stats.kstest(one["gear.planet.x"], truth.cdf).statistic < 0.01
    assert stats.kstest(one["material.42Cr.nu"], stats.triang(2 / 3, 0.28, 0.03).cdf).statistic < 0.01
    assert set(one["gear.sun.z_cutter"]) == {20, 30}
    scores = stats.norm.ppf((one["gear.sun.b_mm"] - 19) / 2)
    assert abs(np.corrcoef(one["gear.sun.x"], scores)[0, 1] + 0.6) < 0.02
    again, *_ = values(read_study(STUDY | {"sample": sample, "seed": 3}))
    assert again == columns
    assert values(read_study(STUDY | {"sample": sample, "seed": 4}))[0] != columns


def test_keys_set_the_tables_of_a_case():
    tables = read_study(STUDY).tables
    wanted = {"crack.cracked.level": 0.4, "pits.mild.axes_mm.1": 0.7, "machine.impact.friction.0": 0.1, "machine.speed_rpm": 5.0}
    made = set_values(tables, wanted)
    assert made["crack"][0]["level"] == 0.4
    assert [one["axes_mm"] for one in made["pits"] if one["case"] == "mild"] == [[0.5, 0.7]]
    assert made["machine"]["impact"]["friction"] == [0.1, 0.05]
    assert made["machine"]["speed_rpm"] == 5.0
    assert tables["crack"][0]["level"] == 0.2


def test_blocks_hold_every_case_once_and_keep_groups_together():
    study = read_study(STUDY | {"block": 5})
    made, fields = blocks(study)
    assert sorted(told["number"] for one in made for told in one.told) == list(range(12))
    for key in ("crack.cracked.level", "gear.sun.r_bore_mm"):
        assert fields[key].kind == "number"
    homes = {}
    for one in made:
        for case in one.cases:
            homes.setdefault((case["gear.sun.r_bore_mm"], case["crack.cracked.level"]), set()).add(one.name)
    assert all(len(names) == 1 for names in homes.values())  # groups of three loads in blocks of about five
    assert [one.name for one in made] == sorted(one.name for one in made)
    alone, _ = blocks(read_study(BASE | {"block": 2, "vary": {"pair.sun_planet.force_N": [float(n) for n in range(1, 8)]}}))
    assert [len(one.cases) for one in alone] == [2, 2, 3]


CORRELATED = {"count": 4, "of": {key: {"uniform": [0, 1]} for key in ("gear.sun.x", "gear.planet.x")}}
AGAIN = {"between": ["gear.sun.x", "gear.planet.x"], "value": 0.5}
REFUSED = {
    "no such pair": {"pair": "sun_moon"},
    "no scene 'none'": {"scene": "none"},
    "there is no 'levl'": {"vary": {"crack.cracked.levl": [0.1]}},
    "there is no 'moon'": {"vary": {"gear.moon.x": [0.1]}},
    "a key begins with": {"vary": {"gears.sun.x": [0.1]}},
    "names no single value": {"vary": {"gear.sun": [0.1]}},
    "give a list of values": {"vary": {"gear.sun.x": 0.1}},
    "the list contains a value twice": {"vary": {"gear.sun.x": [0.1, 0.1]}},
    "from > 0": {"vary": {"gear.sun.x": {"from": 0, "to": 1, "count": 3, "spacing": "log"}}},
    "must have equal lengths": {"along": [{"gear.sun.x": [0.1], "gear.planet.x": [0.1, 0.2]}]},
    "varies twice": {"vary": {"gear.sun.x": [0.1]}, "along": [{"gear.sun.x": [0.2]}]},
    "such as 64 or 128": {"sample": {"method": "sobol", "count": 100, "of": {"gear.sun.x": {"uniform": [0, 1]}}}},
    "is no distribution": {"sample": {"count": 4, "of": {"gear.sun.x": {"within": [0, 1]}}}},
    "must rise": {"sample": {"count": 4, "of": {"gear.sun.x": {"uniform": [1, 0]}}}},
    "standard deviation is > 0": {"sample": {"count": 4, "of": {"gear.sun.x": {"normal": [1, 0]}}}},
    "contains no values of uniform": {
        "sample": {"count": 4, "of": {"gear.sun.x": {"uniform": [1000, 2000], "within": [5000, 6000]}}}
    },
    "within applies to a distribution": {"sample": {"count": 4, "of": {"gear.sun.x": {"choice": [0, 1], "within": [0, 1]}}}},
    "correlated twice": {"sample": CORRELATED | {"correlated": [AGAIN, AGAIN | {"between": AGAIN["between"][::-1]}]}},
    "two different keys": {"sample": CORRELATED | {"correlated": [AGAIN | {"between": ["gear.sun.x", "gear.sun.x"]}]}},
    "cases, but a study has at most": {"sample": CORRELATED | {"count": 10**7}, "vary": {"gear.sun.b_mm": [19.0, 20.0]}},
    "is no value of a scene": {"vary": {"gear.sun.x": [0.1, float("nan")]}},
}


@pytest.mark.parametrize("told", REFUSED)
def test_refusals_say_what_is_wrong(told):
    with pytest.raises(ValueError, match=told):
        read_study(BASE | REFUSED[told])


def test_contradicting_correlations_and_files_that_cannot_be_read(tmp_path):
    of = {key: {"normal": [0.0, 0.01]} for key in ("gear.sun.x", "gear.planet.x", "gear.ring.x")}
    between = [("gear.sun.x", "gear.planet.x", 0.9), ("gear.planet.x", "gear.ring.x", 0.9), ("gear.sun.x", "gear.ring.x", -0.9)]
    wrong = [{"between": [a, b], "value": v} for a, b, v in between]
    with pytest.raises(ValueError, match="contradict each other"):
        values(read_study(BASE | {"sample": {"count": 4, "of": of, "correlated": wrong}}))
    with pytest.raises(ValueError, match="no study"):
        read_study(tmp_path / "none.toml")
    (tmp_path / "s.toml").write_text("scene = [")
    with pytest.raises(ValueError, match=r"s\.toml: not readable"):
        read_study(tmp_path / "s.toml")

"""`gf.compare` of a pair of one's own, without a scene; scenes by name."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.comparison.comparison import Comparison


@pytest.mark.slow
def test_a_pair_without_a_scene_is_compared_as_in_one():
    chosen = gf.load_scene("planetary_pitting").pair()
    own = {"force": chosen.force, "material": chosen.materials}
    run = {"models": {"mine": lambda phase: 3e8 + 0 * phase}, "phases": 4, "refine": 0.3}
    one = gf.compare(pair=chosen.pair, **own, **run)
    other = gf.compare("planetary_pitting", **run)
    assert one.subject == ("21/31", None)
    assert list(one.curves) == list(other.curves)
    for name in one.curves:
        assert_allclose(one.curves[name].k, other.curves[name].k, rtol=1e-12)
    assert_allclose(one.curves["mine"].k, 3e8)
    torque = chosen.force * 1e-3 * chosen.pair.gear_1.r_b
    bare = gf.compare(
        chosen.pair, torque=torque, material=chosen.materials, phases=4, refine=0.5, damage={"pinion": gf.Crack(level=0.3)}
    )
    assert bare.reference.meta["force_N"] == pytest.approx(chosen.force)
    assert bare.reference.k.min() < 0.97 * np.interp(1.0, [0, 1], [one.reference.k.max()] * 2)
    assert "coupled" not in bare.curves


def test_a_model_that_is_a_tenth_too_stiff_is_told_so():
    """Two pairs touch over half of the cycle, 300 N/um for 200; the other model says 330 for 220."""
    phase, none = np.arange(8) / 8, np.zeros((8, 1))
    k = np.where(phase <= 0.5, 3e8, 2e8)
    truth, stiffer = (
        gf.StiffnessCurve(phase, part * k, part * k, none[:, 0], np.array([0]), none, none, meta={"eps_alpha": 1.5})
        for part in (1.0, 1.1)
    )
    case = gf.load_scene("planetary_pitting").case()
    key = ("21/31", None)
    made = Comparison({key: case}, (key,), {(*key, "fe"): truth, (*key, "mine"): stiffer})
    rows = list(made.rows())
    assert [row.zone for row in rows[::2]] == ["single", "double", "mean", "max"]
    for fe, own in zip(rows[::2], rows[1::2], strict=True):
        assert_allclose([own.k, own.error], [1.1 * fe.k, 0.1], rtol=1e-12)
    assert {row[-1] for row in made.table().cells()[1:]} == {"+10.0 %"}


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"force": 10.0}, "needs its load and material"),
        ({"force": 10.0, "torque": 1.0, "material": gf.Material()}, "give one of them"),
        ({"force": [10.0, 20.0], "material": gf.Material()}, r"force = \[10.0, 20.0\], but it needs a number"),
        ({"force": 10.0, "material": gf.Material(), "case": "mild"}, "no scene and no case"),
        ({"force": 10.0, "material": gf.Material(), "damage": gf.Crack(level=0.3)}, "damage = Crack.*, but give a dict"),
    ],
)
def test_what_is_missing_is_said(given, said):
    with pytest.raises(ValueError, match=said):
        gf.compare(pair=gf.load_scene("planetary_pitting").pair().pair, **given)

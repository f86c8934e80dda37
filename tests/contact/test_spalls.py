"""Spalls in the methods: lost contact in three dimensions and in plain sums, their limits, the scene's table, words, pictures."""

import math
import tomllib
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from usual import STEEL

import gearfe as gf
from gearfe.comparison.losses import kind_of, told_damage
from gearfe.scene.dotted_keys import check_key, set_values
from gearfe.scene.load import load_scene, scene_of

RACK = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 12.0}
SPALL = gf.Spall(radius=21.0, z=5.0, sides=(1.5, 4.0), depth=0.2, corner=0.3)
PHASES = [0.2, 0.5, 0.8, 1.1, 1.4]
SCENE = """
title = "spalled pair"
source = "none"
material.steel = {E_MPa = 207e3, nu = 0.3}
gear.pinion = {z = 21, m_n_mm = 2.0, alpha_n_deg = 20.0, b_mm = 12.0, material = "steel", r_bore_mm = 7.4}
gear.wheel = {z = 31, m_n_mm = 2.0, alpha_n_deg = 20.0, b_mm = 12.0, material = "steel", r_bore_mm = 11.4}
pair.stage = {gear_1 = "pinion", gear_2 = "wheel", force_N = 1200.0}
[[spall]]
case = "spalled"
gear = "pinion"
radius_mm = 21.0
z_mm = 5.0
sides_mm = [1.5, 4.0]
depth_mm = 0.2
corner_mm = 0.3
"""


def pair(beta=0.0):
    return gf.GearPair(gf.Gear(z=21, r_bore=7.4, beta=beta, **RACK), gf.Gear(z=31, r_bore=11.4, beta=-beta, **RACK))


def solved(*damage, on=None, side="pinion", method="ritz3d", **options):
    run = {"phases": PHASES, "refine": 0.5} | options if method == "ritz3d" else {"phases": PHASES} | options
    return gf.mesh_stiffness(on or pair(), 1200.0, STEEL, method=method, damage={side: list(damage)} if damage else None, **run)


METHODS = ["ritz3d", "textbook", "herringbone_article"]


@pytest.mark.parametrize("method", METHODS)
def test_a_spall_over_the_whole_width_leaves_its_pair_no_load(method):
    """While the line is in it, the neighbour carries all; before and after, the pair is healthy."""
    made = pair()
    start = made.path[0]
    first, last = (start + at * made.p_bt for at in (0.05, 0.45))  # roll lengths of the spall's ends, tooth 0 with a neighbour
    arcs = np.array([first, last]) ** 2 / (2 * made.gear_1.r_b)
    radius = math.sqrt(made.gear_1.r_b**2 + 2 * made.gear_1.r_b * arcs.mean())
    wide = gf.Spall(radius=radius, z=6.0, sides=(float(np.ptp(arcs)), 13.0), depth=0.3)
    phases = [0.1, 0.25, 0.4, 0.5, 0.58]
    hurt, whole = (solved(*damage, method=method, phases=phases) for damage in ((wide,), ()))
    own = hurt.force[:, hurt.order == 0].sum(axis=1)
    assert_allclose(own[:3], 0.0, atol=1e-9)
    assert_allclose(hurt.force[:3].sum(axis=1), 1200.0, rtol=1e-9)
    assert (whole.force[:3, whole.order == 0] > 100.0).all()
    if method == "ritz3d":
        assert_allclose(hurt.k[3:], whole.k[3:], rtol=2e-3)
        alone = solved(replace(wide, sides=(wide.sides[0], 50.0), depth=0.5), phases=phases[:3])
        assert_allclose(hurt.k[:3], alone.k, rtol=1e-12, err_msg="what lies beyond the face, and the depth, say nothing")


@pytest.mark.parametrize("method", METHODS)
def test_the_smaller_the_spall_the_nearer_to_health(method):
    at = {"method": method, "phases": [pair().pitch_phase]}  # where the line runs through its centre
    whole = solved(**at).k
    losses = [1 - solved(replace(SPALL, sides=(s, 3 * s), corner=0.2 * s), **at).k / whole for s in (1.0, 0.1, 0.01)]
    assert_allclose(losses[2], 0.0, atol=1e-3)
    assert max(abs(losses[0])) > 5 * max(abs(losses[1])) > 0
    assert_allclose(solved(replace(SPALL, side="unloaded")).k, solved().k, rtol=1e-12)


def test_shallow_spalls_carry_on_their_floor():
    """Under so little depth the flanks meet on the floor: stiffer than a deep spall, softer than none."""
    deep, shallow, none = (solved(*one, phases=[0.8]).k for one in ((SPALL,), (replace(SPALL, depth=1e-3),), ()))
    assert deep[0] < shallow[0] < none[0]


def test_scene_words_and_sweep(tmp_path):
    file = tmp_path / "spalled.toml"
    file.write_text(SCENE)
    chosen = load_scene(file).pair()
    assert chosen.damage == {"spalled": {"pinion": [SPALL]}}
    damage = chosen.damage["spalled"]
    assert told_damage(chosen.pair, damage) == "1.5 x 4 mm spall"
    assert told_damage(
        chosen.pair, {"pinion": [SPALL, gf.Crack(level=0.2)], "wheel": [gf.Pit(31.0, 5.0, (0.4, 0.4), 0.1)] * 2}
    ) == ("1.11 mm crack at 45 degrees (level 0.2), 2 pits and 1.5 x 4 mm spall")
    assert kind_of(damage) == "spalled"
    curve = gf.mesh_stiffness(chosen.case("spalled"), phases=[0.8], refine=0.5)
    assert (curve.meta["method"], curve.meta["why"]) == ("ritz3d", "spalls change along the width")
    assert curve.meta["damage"]["pinion"] == [
        {
            "kind": "spall",
            "radius": 21.0,
            "z": 5.0,
            "sides": (1.5, 4.0),
            "depth": 0.2,
            "corner": 0.3,
            "tooth": 0,
            "side": "loaded",
        }
    ]
    tables = tomllib.loads(SCENE)
    check_key("spall.spalled.sides_mm.1", tables, {})
    longer = scene_of("longer", set_values(tables, {"spall.spalled.sides_mm.1": 6.0}))
    assert longer.pair().damage["spalled"]["pinion"] == [replace(SPALL, sides=(1.5, 6.0))]


def test_both_halves_of_a_herringbone_gear(tmp_path):
    text = SCENE.replace("force_N = 1200.0", 'force_N = 1200.0, face = "herringbone"') + "both_halves = true\n"
    file = tmp_path / "double.toml"
    file.write_text(text)
    assert load_scene(file).pair().damage["spalled"]["pinion"] == [SPALL, replace(SPALL, z=7.0)]
    file.write_text(SCENE + "both_halves = true\n")
    with pytest.raises(ValueError, match=r"\[spall 1\]: .*only herringbone gears have halves"):
        load_scene(file)


def test_a_spall_that_takes_the_whole_flank_is_warned_of():
    with (
        pytest.warns(UserWarning, match="spall with sides of 30 x 90 mm removes the whole flank of z = 21"),
        pytest.raises((ValueError, RuntimeError)),
    ):
        solved(replace(SPALL, sides=(30.0, 90.0), depth=1.0), phases=[0.8])


def test_two_spalls_that_together_take_the_whole_flank_are_warned_of():
    chosen, halves = (
        pair(),
        [replace(SPALL, sides=(30.0, 0.6 * pair().gear_1.b), z=part * pair().gear_1.b) for part in (0.25, 0.75)],
    )
    with pytest.warns(UserWarning, match="2 hollows together remove the whole flank of tooth 0 of z = 21"):
        gf.Case(chosen, 1200.0, STEEL, damage={"pinion": halves})


def test_pair_plot_and_mesh_show_it(tmp_path):
    figure = gf.plot_pair(pair(), {"pinion": [SPALL]})
    assert "spall" in [text.get_text() for text in figure.axes[1].get_legend().get_texts()]
    made = gf.export_mesh(tmp_path / "tooth.msh", pair().gear_1, [SPALL, gf.Crack(level=0.2)], teeth=1, refine=0.5)
    assert made.faces["pits"].size
    with pytest.raises(ValueError, match="damage has spalls, but only meshes of tetrahedra can have spalls"):
        gf.export_mesh(tmp_path / "tooth.msh", pair().gear_1, [SPALL], cells="hexahedra")


@pytest.mark.slow
def test_fe3d_loses_what_ritz3d_loses():
    """Bodies by hexahedra and by the energy model; both have the same cells of contact."""
    lost, rack = [], RACK | {"b": 5.0}
    made = gf.GearPair(gf.Gear(z=21, r_bore=7.4, **rack), gf.Gear(z=31, r_bore=11.4, **rack))
    spall = replace(SPALL, z=2.0, sides=(1.5, 2.0))
    for method in ("ritz3d", "fe3d"):
        hurt, whole = (solved(*one, on=made, method=method, phases=[0.8], refine=0.5, error=True) for one in ((spall,), ()))
        ratio = hurt.k[0] / whole.k[0]
        lost.append((1 - ratio, ratio * (hurt.error[0] / hurt.k[0] + whole.error[0] / whole.k[0])))
    (one, about), (other, near) = lost
    assert min(one, other) > 0.05
    assert abs(one - other) < about + near, "inside of the sum of both estimates"

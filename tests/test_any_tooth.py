"""Every verb that takes damage, with damage on a gear and a tooth by chance: its result is not the healthy one, or it refuses."""

import random
from dataclasses import replace

import numpy as np
import pytest

import gearfe as gf
from gearfe.app.cli import main
from gearfe.comparison.losses import LARGEST, damage_phases
from gearfe.comparison.machine_vibration import analysis
from gearfe.comparison.simulated import responses, simulated_gear
from gearfe.planetary_sets.of_scene import build_set
from gearfe.runs.sweeps.kinds import KINDS
from gearfe.scene.load import read_tables, scene_of
from gearfe.signal.tooth_verdict import entered_teeth, tooth_verdict

RACK = {"m_n_mm": 3.0, "alpha_n_deg": 20.0, "b_mm": 15.0, "material": "steel"}
TEETH = {"pinion": 17, "wheel": 38}
CHANCE = random.Random(17)  # the same gears and teeth in every run of the tests
PLACES = [(gear, CHANCE.randrange(1, z)) for gear, z in TEETH.items()]
KIND = {  # table of a damage, what its headline begins with, and the least loss of stiffness at a phase
    "crack": ({"angle_deg": 60.0, "length_mm": 2.5}, "2.5 mm crack at 60 degrees", 0.02),
    "chip": (
        {"angle_deg": 60.0, "depth_mm": 1.5, "radius_mm": 4.0},
        "chip 1.5 mm deep at 60 degrees with a radius of 4 mm",
        0.02,
    ),
    "missing_tooth": ({}, "missing tooth", 0.3),
    "pits": ({"count": 2, "axes_mm": [0.8, 5.0], "depth_mm": 0.4, "middle_mm": 7.5, "pitch_mm": 7.0}, "2 pits", 0.02),
}
PITCH_RADIUS = {"pinion": 25.5, "wheel": 57.0}  # mm
CHOICES = [(*place, kind, 0.0) for place in PLACES for kind in KIND]
CHOICES += [(*CHANCE.choice(PLACES), kind, 12.0) for kind in KIND]  # helical


def options_of(method):
    return {
        "stiffness": {"span": None, "method": method, "phases": 8},
        "transmission error": {"span": None, "method": method, "phases": 8},
        "vibration": {"phases": 8, "curves": method, "duration_s": 0.5, "rate_Hz": None, "method": "fast", "channel": None,
                      "signal": False},
    }  # fmt: skip


def tables(gear, tooth, kind="crack", beta=0.0):
    """A pair with damage of one tooth."""
    radius = {"radius_mm": PITCH_RADIUS[gear]} if kind == "pits" else {}
    rack = {name: RACK | {"beta_deg": sign * beta} for name, sign in (("pinion", 1), ("wheel", -1))}
    return {
        "title": "pair",
        "source": "own gear pair",
        "material": {"steel": {"E_MPa": 206000.0, "nu": 0.3}},
        "gear": {"pinion": rack["pinion"] | {"z": 17, "r_bore_mm": 10.9}, "wheel": rack["wheel"] | {"z": 38, "r_bore_mm": 26.6}},
        "pair": {"stage": {"gear_1": "pinion", "gear_2": "wheel", "force_N": 1669.3}},
        "machine": {"model": "helical_pair", "speed_rpm": 2400.0, "torque_Nm": 40.0, "backlash_um": 300.0},
        kind: [{"case": "cracked", "gear": gear, "tooth": tooth} | KIND[kind][0] | radius],
    }


@pytest.mark.slow
@pytest.mark.parametrize(("gear", "tooth", "kind", "beta"), CHOICES)
def test_every_kind_of_result_shows_a_tooth_by_chance(gear, tooth, kind, beta):
    scene, method = scene_of("pair.toml", tables(gear, tooth, kind, beta)), "ritz3d" if beta or kind == "pits" else "ritz"
    case, (_, words, least) = scene.case(case="cracked"), KIND[kind]
    how = gf.Solve(method, 8, "tooth")
    hurt = gf.solve(case, how)
    healthy = gf.mesh_stiffness(**case.healthy.as_dict(), method=method, phases=hurt.phase)
    assert (1 - hurt.k / healthy.k).max() > 0.05
    assert np.abs(hurt.te - healthy.te).max() > 0.05 * np.ptp(healthy.te)
    compared = gf.compare(scene, case="cracked", phases=8)
    hertz = 680 / TEETH[gear]
    assert compared.headline.startswith(f"tooth {tooth} of the {gear}: {words} ({hertz:.3g} Hz, {gear}): ")
    assert all(found[LARGEST] > least for found in compared.losses().values())
    for result, options in options_of(method).items():
        work = KINDS[result].work
        rows = [
            work(scene, one, options) if KINDS[result].whole else work(replace(scene.case(case=one), force=[1669.3]), options)
            for one in (None, "cracked")
        ]
        name = {"stiffness": "k_min", "transmission error": "te_peak_to_peak", "vibration": "peak"}[result]
        before, after = (row[0][name] for row in rows)
        assert abs(after / before - 1) > 2e-5, (result, before, after)
    found = responses(scene, "cracked", duration=0.5, phases=8)
    lines = analysis(found)
    turn = found["cracked"].machine.stages[-1].mesh / TEETH[gear]
    assert lines.lines["f_r"] == pytest.approx(turn)
    assert "f_m - f_r" in lines.standing()


@pytest.mark.parametrize(("gear", "tooth", "kind", "beta"), [
    pytest.param(*choice, marks=pytest.mark.slow if choice[3] or choice[2] == "pits" else ()) for choice in CHOICES
])  # fmt: skip
def test_verbs_print_a_tooth_by_chance(tmp_path, capsys, gear, tooth, kind, beta):
    from gearfe.scene.toml_file import toml

    path, words, hertz = tmp_path / "pair.toml", KIND[kind][1], 680 / TEETH[gear]
    path.write_text(toml(tables(gear, tooth, kind, beta)), encoding="utf-8")
    assert main(["stiffness", str(path), "--case", "cracked", "--phases", "8"]) == 0
    assert f"tooth {tooth} of the {gear}: {words} ({hertz:.3g} Hz, {gear})" in capsys.readouterr().out
    assert main(["te", str(path), "--case", "cracked", "--phases", "8", "--forces", "1000"]) == 0
    hurt = capsys.readouterr().out
    assert main(["te", str(path), "--phases", "8", "--forces", "1000"]) == 0
    assert hurt != capsys.readouterr().out
    assert main(["dynamics", str(path), "--case", "cracked", "--duration", "0.4"]) == 0
    assert f"tooth {tooth} of the {gear}: {words}; it meshes at {hertz:.4g} Hz" in capsys.readouterr().out


def unstated(name):
    """Tables of a built-in scene without statements on its source."""
    return {key: value for key, value in read_tables(name)[1].items() if key not in ("assumption", "given", "reference")}


def test_a_set_has_the_tooth_or_refuses():
    """The planetary set has cracks and broken teeth of each gear; what it lacks it names."""
    given = unstated("planetary_pitting")
    given |= {"set": {"n_planets": 3}, "crack": [{"case": "x", "gear": "planet", "tooth": 4, "level": 0.3}]}
    given |= {"missing_tooth": [{"case": "x", "gear": "ring", "tooth": 2}, {"case": "x", "gear": "planet", "body": "planet2"}]}
    given |= {"chip": [{"case": "x", "gear": "planet", "tooth": 7, "depth_mm": 0.5, "radius_mm": 2.0, "pair": "planet_ring"}]}
    made = build_set(scene_of("set.toml", given), "x")
    assert made.damage == {
        "planet1": (gf.Crack(level=0.3, tooth=4), gf.Chip(depth=0.5, tooth=7, side="unloaded", radius=2.0)),
        "planet2": (gf.MissingTooth(),),
        "ring": (gf.MissingTooth(tooth=2),),
    }
    with pytest.raises(ValueError, match="no pits or spalls"):
        build_set(scene_of("set.toml", given), "mild")


@pytest.mark.parametrize(("gear", "tooth"), PLACES)
def test_damage_given_in_python_is_that_of_the_file(gear, tooth):
    """Curves and machine; a copy of a scene whose pairs had other damage was healthy in its machine."""
    read = scene_of("pair.toml", tables(gear, tooth))
    given = scene_of("pair.toml", tables(gear, 0)).with_damage("own", {"stage": read.pair().damage["cracked"]})
    assert given.case(case="own") == read.case(case="cracked")
    ours, theirs = (gf.build_machine(one, case, phases=8) for one, case in ((given, "own"), (read, "cracked")))
    assert ours.faults == theirs.faults
    at = np.linspace(0.0, 0.06, 500)
    np.testing.assert_array_equal(ours.meshes[0].k(at), theirs.meshes[0].k(at))
    with pytest.raises(ValueError, match="side 'sun', but there is pinion, wheel"):
        read.with_damage("own", {"stage": {"sun": []}})
    with pytest.raises(TypeError, match="damage"):
        replace(read.pair(), damage={})


def test_transmission_error_of_every_damaged_tooth(tmp_path, capsys):
    """A chipped pinion tooth touches with its tip at the end of its engagement; a second tooth has a table of its own."""
    from gearfe.scene.toml_file import toml

    given = tables("pinion", 5, "chip")
    given["crack"] = [{"case": "cracked", "gear": "wheel", "tooth": 9, "level": 0.4}]
    (path := tmp_path / "pair.toml").write_text(toml(given), encoding="utf-8")
    assert main(["te", str(path), "--case", "cracked", "--phases", "8"]) == 0
    out = capsys.readouterr().out
    assert [f"the mesh cycle, tooth {tooth}" in out for tooth in ("5 of the pinion: chip", "9 of the wheel: 3")] == [True] * 2
    rows = [[float(cell) for cell in line.split("|")[3:5]] for line in out.splitlines() if line.startswith("|    1669.3")]
    case = scene_of("pair.toml", given).case(case="cracked")
    for (span, healthy), tooth in zip(rows, (5, 9), strict=True):
        alone = {side: [one for one in found if one.tooth == tooth] for side, found in case.damage.items()}
        phases = damage_phases(replace(case, damage=alone), 8)
        te = [gf.mesh_stiffness(replace(one, force=1669.3), phases=phases).te for one in (case, case.healthy)]
        np.testing.assert_allclose([span, healthy], 1e6 * np.ptp(te, axis=1), atol=6e-4)
        assert abs(np.subtract(*te)).max() > 1e-6


def test_a_pair_of_equal_planets_has_one_of_them_damaged_as_its_machine_has():
    given = {
        key: value
        for key, value in read_tables("compound_planetary")[1].items()
        if key not in ("assumption", "given", "reference")
    }
    given |= {"missing_tooth": [{"case": "x", "gear": "planet", "tooth": 5}]}
    scene = scene_of("compound.toml", given)
    assert scene.case("planet_planet", "x").damage == {"pinion": (gf.MissingTooth(tooth=5),)}
    assert scene.case("sun_planet", "x").damage == {"wheel": (gf.MissingTooth(tooth=5),)}


def test_damage_of_a_planet_that_its_pair_leaves_out_is_pointed_out():
    given = unstated("planetary_pitting")
    rows = [{"case": "x", "gear": "planet", "body": f"planet{k}", "tooth": k, "level": 0.3} for k in (2, 3)]
    scene = scene_of("set.toml", given | {"crack": rows})
    with pytest.warns(UserWarning, match="also damages planet3"):
        assert [one.tooth for one in scene.case("sun_planet", "x").damage["wheel"]] == [2]


@pytest.mark.parametrize(("gear", "tooth"), [("pinion", 5), ("wheel", 5), ("wheel", 11)])
def test_the_average_of_a_record_names_the_damaged_tooth(gear, tooth):
    """Largest impulse of a simulated record below resonance: the damaged tooth is one of the last two that entered there."""
    given = tables(gear, tooth)
    given["machine"]["speed_rpm"] = 1000.0
    records = simulated_gear(scene_of("pair.toml", given), "cracked", gear, duration=2.0)
    verdict = tooth_verdict(records["simulated cracked"], TEETH[gear], records["simulated healthy"])
    assert tooth in entered_teeth(verdict.angle, TEETH[gear])
    assert f"tooth {tooth} " in verdict.told(TEETH[gear])


@pytest.mark.slow
def test_a_picture_of_one_of_several_teeth_names_the_others(tmp_path, capsys):
    from gearfe.scene.toml_file import toml

    given = tables("pinion", 5)
    given["crack"] = [*given["crack"], {"case": "cracked", "gear": "wheel", "tooth": 9, "level": 0.4}]
    (path := tmp_path / "pair.toml").write_text(toml(given), encoding="utf-8")
    assert main(["render", str(path), "--case", "cracked", "-o", str(tmp_path / "stress.png")]) == 0
    assert "tooth 5 of the pinion: 2.5 mm crack at 60 degrees; other phases (--phase) show tooth 9 of the wheel" in (
        capsys.readouterr().out
    )

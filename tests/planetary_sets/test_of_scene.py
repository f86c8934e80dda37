"""Sets of scenes are those that the same numbers make in Python; their curves in files and as a moving picture."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from PIL import Image
from set_page import SCENE, loaded
from sets import STEEL, case, gears

import gearfe as gf
from gearfe.figures.set_motion import draw_motion
from gearfe.planetary_sets import animation
from gearfe.planetary_sets.added import added_compliance
from gearfe.planetary_sets.shape import loaded_shapes

PADS = SCENE[SCENE.index("[ring.support]") : SCENE.index("[pin.first]")]


def test_a_scene_says_the_set_that_python_makes(tmp_path):
    found = gf.build_set(loaded(tmp_path, SCENE), "cracked")
    ring = gf.RimSupports(6, 5.0, first=math.radians(10))
    force = 120e3 / (3 * gears().sun.r_b)
    same = replace(gears(), a=gf.GearPair(gears().sun, gears().planet).a)
    options = {"pin": 3e5, "errors": [(0, 0.005), (0, 0), (0, 0)], "ring": ring}
    assert found == gf.PlanetaryCase(same, force, STEEL, damage={"sun": [gf.Crack(level=0.3)]}, **options)


@pytest.mark.parametrize(
    ("support", "ring"),
    [
        ("", "held"),
        ('[ring.support]\nkind = "held"\n', "held"),
        ('[ring.support]\nkind = "bed"\nradial_MPa_per_mm = 1e4\ntangential_MPa_per_mm = 5e3\n', gf.RimBed(1e4, 5e3)),
        (
            '[ring.support]\nkind = "pads"\ncount = 4\nwidth_mm = 8\nradial_N_per_um = 0\ntangential_N_per_um = 50\n',
            gf.RimSupports(4, 8.0, radial=0.0, tangential=5e4),
        ),
        ('[ring.support]\nkind = "lugs"\ncount = 5\nwidth_mm = 8\n', gf.RimSupports(5, 8.0, radial=0.0, pushes=True)),
    ],
    ids=["none", "held", "bed", "pads", "lugs"],
)
def test_what_holds_the_ring(tmp_path, support, ring):
    assert gf.build_set(loaded(tmp_path, SCENE.replace(PADS, support))).ring == ring


def test_flanks_and_cracks_are_those_of_the_gears(tmp_path):
    """A planet's crack is one, on the flank of the sun; one of the ring's mesh alone is on the other flank of its tooth."""
    flanks = "".join(f'[flank.{gear}]\ngear = "{gear}"\nprofile_crowning_um = {um}\n' for gear, um in (("sun", 3), ("planet", 5)))
    crack = '[[crack]]\ncase = "planet"\ngear = "planet"\nlevel = 0.2\ntooth = 4\n'
    text = SCENE.replace(PADS, "")
    found = gf.build_set(loaded(tmp_path, text + flanks + crack), "planet")
    assert {name: one.profile_crowning for name, one in found.flanks.items() if name != "ring"} == {
        "sun": 0.003, "planet1": 0.005, "planet2": 0.005, "planet3": 0.005,
    }  # fmt: skip
    assert found.damage == {"planet1": (gf.Crack(level=0.2, tooth=4),)}
    inner = gf.build_set(loaded(tmp_path, text + crack + 'pair = "planet_ring"\n'), "planet")
    assert inner.damage == {"planet1": (gf.Crack(level=0.2, tooth=4, side="unloaded"),)}
    named = gf.build_set(loaded(tmp_path, text + crack + 'body = "planet2"\n'), "planet")
    assert named.damage == {"planet2": (gf.Crack(level=0.2, tooth=4),)}
    with pytest.raises(ValueError, match="damages body 'planet4', but the planet of the set is planet1, planet2, planet3"):
        gf.build_set(loaded(tmp_path, text + crack + 'body = "planet4"\n'), "planet")
    ring = gf.build_set(loaded(tmp_path, SCENE + '[[crack]]\ncase = "ring"\ngear = "ring"\nlevel = 0.2\n'), "ring")
    assert ring.damage == {"ring": (gf.Crack(level=0.2),)}
    with pytest.raises(ValueError, match=r"give it one \[flank.NAME\] table without pair"):
        gf.build_set(loaded(tmp_path, text + flanks + 'pair = "sun_planet"\n'))


@pytest.mark.parametrize(
    ("more", "which", "message"),
    [
        ("", "broken", "no case 'broken' in the set of scene s; it has cracked"),
        ('[[spall]]\ncase = "x"\ngear = "sun"\nradius_mm = 21\nz_mm = 10\nsides_mm = [1, 2]\ndepth_mm = 0.1\n', "x",
         "case 'x' has a spall, but the section of a set has no pits or spalls"),
        ('[support.a]\ngear = "sun"\nradial_N_per_um = 100\n', None, r"pair 'sun_planet' has shafts, springs or misalignment"),
    ],
)  # fmt: skip
def test_what_a_set_does_not_know_is_refused(tmp_path, more, which, message):
    with pytest.raises(ValueError, match=message):
        gf.build_set(loaded(tmp_path, SCENE + more), which)


@pytest.mark.parametrize(
    ("more", "why"),
    [
        ('[support.a]\ngear = "sun"\nradial_N_per_um = 100\n', "has shafts, springs or misalignment"),
        ('[flank.a]\ngear = "planet"\npair = "sun_planet"\nprofile_crowning_um = 3\n', "another flank with the sun"),
        ('[flank.a]\ngear = "sun"\nhelix_crowning_um = 3\n', "change along the width"),
    ],
)
def test_pairs_that_a_set_does_not_model_stay_isolated(tmp_path, more, why):
    """The machine then has isolated pairs; the set itself is rejected, and an impossible set stays an error."""
    made = loaded(tmp_path, SCENE.replace(PADS, "") + more)
    assert added_compliance(made) is None
    with pytest.raises(ValueError, match=why):
        gf.build_set(made)
    with pytest.raises(ValueError, match="width_mm = -1"):
        added_compliance(loaded(tmp_path, SCENE.replace("width_mm = 5 ", "width_mm = -1 ")))


def test_places_that_cannot_be_name_the_table(tmp_path):
    with pytest.raises(ValueError, match=r"s.toml \[ring.support\] width_mm = -1, but it must be above 0 mm"):
        gf.build_set(loaded(tmp_path, SCENE.replace("width_mm = 5 ", "width_mm = -1 ")))
    angles = SCENE.replace("n_planets = 3 ", "planet_angles_deg = [0, 121, 240] #")
    with pytest.raises(ValueError, match=r"s.toml \[set\]: planets at 0, 121, 240 degrees cannot be assembled"):
        gf.build_set(loaded(tmp_path, angles))
    with pytest.raises(ValueError, match=r"scene helical_pitting has no \[set\] table"):
        gf.build_set(gf.load_scene("helical_pitting"))


def test_files_hold_the_curves(tmp_path):
    found = gf.planetary_stiffness(case(pin=1e5, errors=[(0, 0.01), (0, 0), (0, 0)]), 2)
    for suffix in ("csv", "npz", "json"):
        found.save(tmp_path / f"x.{suffix}")
    _, meta, head, *rows = (tmp_path / "x.csv").read_text().splitlines()
    table = dict(zip(head.split(","), np.array([row.split(",") for row in rows], dtype=float).T, strict=True))
    assert_allclose(table["k planet-ring 3 [N/m]"], found.k[1, :, 2], rtol=0)
    assert_allclose(table["force sun-planet 1 [N]"], found.force[0, :, 0], rtol=0)
    assert_allclose(table["te [m]"], found.te, rtol=0)
    assert json.loads(meta.removeprefix("# meta: "))["case"].startswith("PlanetaryCase(")
    with np.load(tmp_path / "x.npz") as kept:
        assert_allclose(kept["pair_force"], found.pair_force, rtol=0)
    data = json.loads((tmp_path / "x.json").read_text())
    assert data["k"] == found.k.tolist()
    assert data["units"]["k"] == "N/m"


@pytest.mark.slow
def test_frames_are_the_pictures_of_their_positions(tmp_path, monkeypatch):
    """Gears meshed once for all frames move as those meshed for one position; a file has a frame for each of them."""
    found = gf.planetary_stiffness(case(ring=gf.RimSupports(6, 4.8, first=0.2)), [0.1, 0.6])
    drawn = []
    monkeypatch.setattr(
        animation, "draw_motion", lambda every, *args, **how: drawn.append(every) or draw_motion(every, *args, **how)
    )
    path = gf.animate_planetary_set(found, tmp_path / "bent.gif", dpi=20)
    (every,) = drawn
    shapes, pads = every[1]  # gears are placed by those of the first position
    ((alone, same),) = loaded_shapes(found, [1])
    assert_allclose(pads, same, rtol=1e-12)
    most = [[np.hypot(*shape.moved).max() for shape in one] for one in (shapes, alone)]
    assert_allclose(*most, rtol=0.01)
    angles = np.unwrap([np.arctan2(*pads) for _, pads in every], axis=0)
    assert_allclose(np.diff(angles, axis=0), -0.5 * 2 * math.pi / 84, rtol=1e-9)  # the ring turns against the sun
    with Image.open(path) as moving:
        assert (moving.n_frames, moving.size) == (2, (160, 160))

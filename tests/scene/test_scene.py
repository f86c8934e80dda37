from importlib import resources

import pytest

import gearfe as gf
from gearfe.scene.load import scene_names

TEXT = (resources.files("gearfe.scenes") / "planetary_pitting.toml").read_text()


def test_built_in_scene():
    assert "planetary_pitting" in scene_names()
    scene = gf.load_scene("planetary_pitting")
    assert (scene.gears["sun"].z, scene.gears["planet"].z) == (21, 31)
    assert scene.pair().pair.eps_alpha == pytest.approx(1.6149, rel=1e-4)
    assert len(scene.assumptions) >= 4
    assert [len(scene.pair().damage[case]["pinion"]) for case in ("mild", "moderate", "severe")] == [5, 10, 15]
    assert scene.pair().case("mild")["damage"]["pinion"][0].radius == 21.0
    with pytest.raises(ValueError, match="it has mild, moderate, severe"):
        scene.pair().case("broken")


@pytest.mark.parametrize(("name", "cases"), [("compound_planetary", 5), ("helical_pitting", 3), ("herringbone", 8)])
def test_the_other_machines(name, cases):
    pair = gf.load_scene(name).pair()
    assert len(pair.damage) == cases
    for case in pair.damage:
        run = pair.case(case) | {"face": None}
        curve = gf.mesh_stiffness(**run, method="textbook", variants={"crack_model": "straight"}, phases=4)
        assert (curve.k > 0).all()


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("z = 21", "z = 21\nteeth = 3", r"s.toml \[gear.sun\]: unknown key 'teeth'; expected z, m_n_mm"),
        ("z = 21", 'z = "21"', r"\[gear.sun\] z = '21': expected a whole number"),
        ("z = 21", "z = 21.0", "expected a whole number"),
        ("r_bore_mm = 7.4\n", "", r"\[gear.sun\]: give r_bore_mm \(an external gear\) or r_rim_mm"),
        ("m_n_mm = 2.0\n", "", r"\[gear.sun\]: missing key 'm_n_mm'; expected a number in mm"),
        ("alpha_n_deg = 20.0", "alpha_n_deg = nan", "alpha_n_deg = nan: expected a number in degrees"),
        ("force_N = 2000.0", "force_N = -1.0", "force_N = -1.0"),
        ("force_N = 2000.0", "force_N = true", "expected a number in N"),
        ('gear_2 = "planet"', 'gear_2 = "moon"', "no such gear; there is sun, planet, ring"),
        ('material = "20CrMnTi"', 'material = "tin"', "no such material; there is 20CrMnTi, 42Cr"),
        ("z = 21", "z = 3", r"\[gear.sun\]: z = 3, but a gear needs at least 5 teeth"),
        ("a_mm = 52.0", "a_mm = 50.0", r"\[pair.sun_planet\]: a = 50 mm"),
        ("[pair.sun_planet]", "[gearing.x]", "unknown key 'gearing'"),
        ("title =", "titel =", "unknown key 'titel'"),
        ("E_MPa = 207000.0", "E_MPa = 0.0", "E = 0.0 MPa"),
        ("z = 21", "z = = 21", "not readable as TOML"),
    ],
)
def test_errors_name_file_table_and_key(tmp_path, old, new, message):
    path = tmp_path / "s.toml"
    assert old in TEXT
    path.write_text(TEXT.replace(old, new, 1))
    with pytest.raises(ValueError, match=message):
        gf.load_scene(path)


def test_damage_of_one_pair_only():
    scene = gf.load_scene("herringbone")
    assert "planet1" in scene.pairs["planet_ring"].damage
    assert "planet1" not in scene.pairs["sun_planet"].damage
    with pytest.raises(ValueError, match="only the sun has damage"):
        gf.build_machine(scene, "planet1", method="textbook")


@pytest.mark.parametrize(
    ("name", "message"), [("sun_moon", "no such pair; there is sun_planet"), ("planet_ring", "'planet_ring' has no gear 'sun'")]
)
def test_damage_of_another_pair_is_refused(tmp_path, name, message):
    path = tmp_path / "s.toml"
    path.write_text(TEXT.replace('case = "mild"', f'case = "mild"\npair = "{name}"', 1))
    with pytest.raises(ValueError, match=message):
        gf.load_scene(path)


def test_unknown_scene_and_pair():
    with pytest.raises(ValueError, match="built in are compound_planetary, helical_pitting, herringbone, planetary_pitting"):
        gf.load_scene("nonsense")
    with pytest.raises(ValueError, match="it has sun_planet, planet_ring"):
        gf.load_scene("planetary_pitting").pair("sun_moon")

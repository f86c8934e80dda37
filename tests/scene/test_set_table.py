"""Tables [set], [ring.support], [pin.NAME]: units, what is deduced, mistakes; of the scene on the how-to page."""

import math

import pytest
from set_page import SCENE, loaded

OTHER = '[gear.other]\nz = 31\nm_n_mm = 2.0\nalpha_n_deg = 20\nb_mm = 20\nr_bore_mm = 9\nmaterial = "steel"\n'
OTHER += '[pair.a]\ngear_1 = "sun"\ngear_2 = "other"\nforce_N = 1\n'
OTHER += '[pair.b]\ngear_1 = "other"\ngear_2 = "ring"\na_mm = 52\nforce_N = 1\n'


def test_units_are_those_of_the_keys(tmp_path):
    scene = loaded(tmp_path, SCENE)
    assert scene.set.pairs == ("sun_planet", "planet_ring")
    assert scene.set.force * 3 * scene.gears["sun"].r_b == pytest.approx(120e3)
    assert scene.set.pin == 3e5
    assert scene.set.errors == ((0.0, 0.005), (0.0, 0.0), (0.0, 0.0))
    assert scene.set.planet_angles is None
    turned = loaded(
        tmp_path, SCENE.replace("n_planets = 3 ", "planet_angles_deg = [0, 120, 240] #").replace("torque_Nm = 120", "")
    )
    assert turned.set.planet_angles == pytest.approx([0, 2 * math.pi / 3, 4 * math.pi / 3])
    assert turned.set.force == 2000


@pytest.mark.parametrize(("planets", "machine", "message"), [
    ("n_planets = 3 ", 2, r"s.toml \[set\]: 3 planets, but \[machine\] has n_planets = 2, equally spaced: give the same planets"),
    ("planet_angles_deg = [0, 120, 240] #", 3, ""),
    ("planet_angles_deg = [0, 120, 205.71428571428572] #", 3, "3 planets at unequal angles, but"),
])  # fmt: skip
def test_set_and_machine_have_the_same_planets(tmp_path, planets, machine, message):
    """A set of two planets stood beside a machine of three, without a message."""
    text = SCENE.replace("n_planets = 3 ", planets)
    text += f'[machine]\nmodel = "planetary"\nspeed_rpm = 100\ntorque_Nm = 120\nn_planets = {machine}\n'
    if not message:
        assert loaded(tmp_path, text).set is not None
        return
    with pytest.raises(ValueError, match=message):
        loaded(tmp_path, text)


def test_a_scene_without_a_set_has_none(tmp_path):
    assert loaded(tmp_path, SCENE[: SCENE.index("[set]")]).set is None


def test_of_several_sets_the_one_of_the_named_gears(tmp_path):
    with pytest.raises(
        ValueError, match=r"2 sets are in the pairs .* name sun, planet, ring: sun, planet, ring; sun, other, ring"
    ):
        loaded(tmp_path, SCENE + OTHER)
    found = loaded(tmp_path, (SCENE + OTHER).replace("[set]", '[set]\nplanet = "other"')).set
    assert found.pairs == ("a", "b")
    assert found.gears.planet.r_bore == 9


def test_assumptions_speak_of_a_set(tmp_path):
    note = (
        '[[assumption]]\nwhat = "six pads"\nwhy = "a guess"\nholds = { "ring.support.count" = 6, "pin.first.body" = "planet1" }\n'
    )
    assert len(loaded(tmp_path, SCENE + note).assumptions) == 1
    other = loaded(tmp_path, (SCENE + note).replace("count = 6\n", "count = 5\n"))
    assert not other.assumptions
    assert other.changed == ("ring.support.count = 5 (assumed in the original: 6)",)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (SCENE[SCENE.index("[set]") : SCENE.index("[ring")], "", r"\[ring\] belongs to a planetary set: add a table \[set\]"),
        ("n_planets = 3 ", "#", r"\[set\]: give n_planets \(number of planets\) or planet_angles_deg"),
        ("n_planets = 3 ", "planet_angles_deg = [] #",
         r"\[set\] planet_angles_deg = \[\]: give the angle of each planet, or n_planets"),
        ("n_planets = 3 ", "n_planets = 4 #", r"\[set\]: 4 planets cannot be spaced equally"),
        ("[set]\n", '[set]\nsun = "moon"\n', r"\[set\] sun = 'moon': no such gear; there is sun, planet, ring"),
        ("[set]\n", '[set]\nsun = "planet"\n', r"\[set\]: two pairs are needed: give one with the sun as gear_1"),
        ("torque_Nm = 120", "torque_Nm = 120\nforce_N = 2000", r"\[set\]: force_N and torque_Nm exclude each other"),
        ("[set]\n", "[set]\ndamaged_planet = 0\n", r"'damaged_planet' \(former key, counted from 0: give body = .planet1., the"),
        ('body = "planet1"\n', "planet = 0\n", r"\[pin.first\]: unknown key 'planet' \(former key, counted from 0: give body"),
        ('body = "planet1"\n', 'body = "planet4"\n', r"\[pin.first\] body = 'planet4': no such planet of the set"),
        ("[pin.first]", '[pin.second]\nbody = "planet1"\n[pin.first]', r"\[pin.first\]: the pin of planet1 is \[pin.second\]"),
        ("[pin.first]", "[[pin]]", r"\[\[pin\]\] is a list of tables, but they have names: write \[pin.NAME\]"),
        ('kind = "pads"', 'kind = "held"', r"\[ring.support\]: kind = 'held' has no count; expected no other key"),
        ('kind = "pads"', 'kind = "bed"', r"kind = 'bed' needs radial_MPa_per_mm"),
        ("width_mm = 5 ", "#", r"kind = 'pads' needs width_mm"),
        ('kind = "pads"', 'kind = "lugs"\nradial_N_per_um = 2', r"kind = 'lugs' has no radial_N_per_um; expected count"),
    ],
)  # fmt: skip
def test_mistakes_are_explained(tmp_path, old, new, message):
    assert old in SCENE
    with pytest.raises(ValueError, match=message):
        loaded(tmp_path, SCENE.replace(old, new))

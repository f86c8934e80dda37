"""A machine takes the backlash that its teeth have, unless its scene states another."""

import pytest

import gearfe as gf
from gearfe.scene.load import scene_of
from gearfe.scene.toml_file import read_toml

pytestmark = pytest.mark.quick


@pytest.mark.parametrize("stated", [None, 30.0])
def test_the_mesh_has_the_backlash_of_its_pair(tmp_path, stated):
    gf.new_scene(tmp_path / "own.toml")
    tables = read_toml(tmp_path / "own.toml")
    tables["gear"]["wheel"]["E_sn_um"] = -50.0
    tables["machine"] = {"model": "helical_pair", "speed_rpm": 1500.0, "torque_Nm": 40.0}
    tables["machine"] |= {} if stated is None else {"backlash_um": stated}
    scene = scene_of("own.toml", tables)
    pair = scene.pair().pair
    assert pair.backlash == pytest.approx(50e-3 * pair.gear_2.r_b / pair.gear_2.r, rel=1e-9)
    wanted = pair.backlash if stated is None else 1e-3 * stated
    assert [mesh.backlash for mesh in gf.build_machine(scene, phases=8).meshes] == pytest.approx([1e-3 * wanted])


def test_a_scene_states_the_allowance_in_three_ways(tmp_path):
    """As E_sn, as the generating profile shift, or as the backlash of the pair, which a simulation has too."""
    gf.new_scene(tmp_path / "own.toml", helix_deg=12.0)

    def pair_of(**change):
        tables = read_toml(tmp_path / "own.toml")
        for name, (key, value) in change.items():
            tables["pair" if name == "stage" else "gear"][name][key] = value
        return scene_of("own.toml", tables).pair().pair

    stated = pair_of(wheel=("E_sn_um", -50.0))
    shifted = pair_of(wheel=("x_E", stated.gear_2.x_E))
    assert shifted.gear_2.E_sn == pytest.approx(-0.05, rel=1e-9)
    loose = pair_of(stage=("backlash_um", 120.0))
    assert loose.backlash == pytest.approx(0.12, rel=1e-9)
    assert loose.gear_1.E_sn == pytest.approx(loose.gear_2.E_sn, rel=1e-12)
    with pytest.raises(ValueError, match=r"these gears have .* um at a_mm"):
        pair_of(wheel=("E_sn_um", -50.0), stage=("backlash_um", 10.0))

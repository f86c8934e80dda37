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

"""Limits: kinds of values, plausible loads, resolution, memory; a torque for the force; a curve at any phase; units in files."""

import math
import resource
import subprocess
import sys
import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.app.cli import main
from gearfe.core import memory
from gearfe.core.files import read
from gearfe.stiffness import limits


def test_a_torque_on_the_pinion_is_a_force_on_its_base_circle(pair, steel):
    force = 40.0 / (1e-3 * pair.gear_1.r_b)
    run = {"material": steel, "method": "textbook", "phases": 4}
    by_torque = gf.mesh_stiffness(pair, torque=40.0, **run)
    assert by_torque.meta["force_N"] == pytest.approx(force, rel=1e-15)
    assert_allclose(by_torque.k, gf.mesh_stiffness(pair, force, **run).k, rtol=1e-15)
    assert len(gf.mesh_stiffness(pair, torque=[20.0, 40.0], **run)) == 2
    for given in ({}, {"force": force, "torque": 40.0}):
        with pytest.raises(ValueError, match="give one of them"):
            gf.mesh_stiffness(pair, **given, **run)


def test_loads_beyond_small_strains_are_refused_and_large_ones_said(pair, steel):
    run = {"pair": pair, "material": steel, "phases": 8}
    for method in ("textbook", "ritz"):
        with pytest.raises(ValueError, match=r"force = 1e\+07 N.*% of the module"):
            gf.mesh_stiffness(force=1e7, method=method, **run)
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            gf.mesh_stiffness(force=6e4, method=method, **run)
        words = " ".join(str(one.message) for one in said)
        assert "more than teeth withstand" in words
        assert ("flanks yield" in words) == (method == "ritz"), "a plain sum knows no pressure"
        gf.mesh_stiffness(force=2e4, method=method, **run)  # 500 N/mm per mm of module: a word would be an error here
    own = gf.OwnFlexibility(lambda gear, material, radius, tooth: np.diag(1e-3 + 0 * radius))
    with pytest.raises(ValueError, match="where teeth break"):
        gf.mesh_stiffness(force=2e4, method=own, **run)


def test_a_curve_is_a_function_of_the_phase(pair, steel):
    curve = gf.mesh_stiffness(pair, 2000.0, steel, method="textbook", phases=16)
    assert_allclose(curve(curve.phase), curve.k)
    assert_allclose(curve(np.add.outer([3.0, -2.0], curve.phase)), [curve.k, curve.k])
    assert curve(1 - 1 / 32) == pytest.approx((curve.k[0] + curve.k[-1]) / 2)
    tooth = gf.mesh_stiffness(
        pair, 2000.0, steel, method="textbook", phases=16, span="tooth", damage={"pinion": gf.Crack(level=0.3)}
    )
    assert_allclose(tooth(tooth.phase), tooth.k)
    for wrong in (5.0, -1.0):
        with pytest.raises(ValueError, match="not a whole mesh cycle"):
            tooth(wrong)


@pytest.mark.parametrize("suffix", [".npz", ".mat"])
def test_files_state_the_unit_of_every_array(pair, steel, suffix, tmp_path):
    import json

    path = tmp_path / f"k{suffix}"
    gf.mesh_stiffness(pair, 2000.0, steel, method="ritz", phases=4, error=True).save(path)
    found = read(path, "signal")
    units = json.loads(str(found["units_json"].item()))
    assert set(units) == set(found) - {"meta", "units_json"}
    assert units | {"order": "-", "phase": "-"} == {
        "phase": "-", "order": "-", "k": "N/m", "k_tangent": "N/m", "deflection": "m", "force": "N", "pressure": "Pa", "error":
        "N/m"
    }  # fmt: skip


def test_memory_is_that_of_the_smallest_limit(tmp_path, monkeypatch):
    files = [tmp_path / name for name in ("max", "current", "stat")]
    for file, text in zip(files, ("4000000000", "3000000000", "anon 1\ninactive_file 500000000\n"), strict=True):
        file.write_text(text)
    monkeypatch.setattr(memory, "CONTROL_GROUP", ((*map(str, files), "inactive_file"),))
    assert memory._group_free() == 1.5e9
    assert memory.free_memory() <= 1.5e9
    files[0].write_text("max\n")
    assert memory._group_free() == math.inf
    monkeypatch.setattr(limits, "free_memory", lambda: 1e9)
    with pytest.raises(
        RuntimeError, match=r"refine = 10: about .* unknowns a section, which need about .* GB, but 1 GB are free"
    ):
        limits.check_section(10.0)
    limits.check_section(4.0)


def test_a_limit_of_the_shell_is_seen():
    code = "from gearfe.core.memory import free_memory; print(free_memory())"
    limit = 6 * 10**9

    def held():
        resource.setrlimit(resource.RLIMIT_AS, (limit, limit))

    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, preexec_fn=held)
    assert 1e9 < float(done.stdout) < limit


def test_the_section_estimate_is_that_of_meshes(pair):
    """Unknowns of two real meshes, within a third."""
    from gearfe.flexibility.finite_elements.fe import mesh_gear

    for refine in (1.0, 2.0):
        mesh = mesh_gear(pair.gear_1, read=(1, 2), refine=refine)
        expected = sum(factor * refine**power for power, factor in enumerate(limits.SECTION))
        assert 0.7 < expected / (2 * mesh.mesh.doflocs.shape[1]) < 1.4


def test_versions(capsys):
    from gearfe.app.cli import main

    with pytest.raises(SystemExit):
        main(["--version"])
    assert capsys.readouterr().out == f"gearfe {gf.__version__}\n"
    assert gf.__version__[0].isdigit()


@pytest.mark.slow
@pytest.mark.parametrize("damage", [None, {"pinion": [gf.Pit(radius=21.0, z=10.0, axes=(0.8, 2.0), depth=0.2)]}])
def test_three_dimensions_from_the_lightest_to_the_heaviest_load(pair, steel, damage):
    """0.06 N/mm: sound, and softer than under load; 5e6 N: refused with what was given and what to do."""
    run = {"method": "ritz3d", "phases": [0.3, 0.8], "damage": damage, "refine": 0.3}
    light, load = (gf.mesh_stiffness(pair, force, steel, **run) for force in (0.06 * 20, 2000.0))
    np.testing.assert_allclose(light.force.sum(axis=1), 0.06 * 20, rtol=1e-9)
    assert (0.5 * load.k < light.k).all()
    assert (light.k < load.k).all()
    with pytest.raises(ValueError, match=r"force = 5e\+06 N on 20 mm: .* give a smaller force"):
        gf.mesh_stiffness(pair, 5e6, steel, **run)


def test_the_command_line_refuses_the_heaviest_load_in_three_dimensions(capsys):
    assert main(["stiffness", "planetary_pitting", "--method", "ritz3d", "--force", "5e6"]) == 1
    said = capsys.readouterr().err
    assert said.startswith("gearfe: --force = 5e+06 N on 20 mm")
    assert len(said.splitlines()) == 1

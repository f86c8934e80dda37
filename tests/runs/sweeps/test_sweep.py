"""A sweep's results are those of single calls, survive a kill, and are refused where they do not belong."""

import json
from dataclasses import replace

import numpy as np
import pytest

import gearfe as gf
from gearfe.app.cli import main
from gearfe.runs.store import shards
from gearfe.runs.sweeps import run

STUDY = {
    "scene": "planetary_pitting",
    "pair": "sun_planet",
    "case": "cracked",
    "crack": [{"case": "cracked", "gear": "sun", "level": 0.2}],
    "options": {"method": "textbook", "phases": 8},
    "vary": {
        "gear.sun.r_bore_mm": [6.0, 6.5, 7.0, 99.0],
        "crack.cracked.level": [0.1, 0.2, 0.3, 0.4],
        "pair.sun_planet.force_N": [500.0, 1000.0, 2000.0],
    },
    "block": 3,
}


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    return gf.sweep(STUDY, tmp_path_factory.mktemp("sweep") / "runs", workers=1)


def test_rows_are_those_of_single_calls_and_a_case_that_cannot_be_says_so(undisturbed):
    table = undisturbed.table()
    assert len(table) == len(undisturbed) == 48
    assert table["status"].value_counts().to_dict() == {"done": 36, "failed": 12}
    failed = table[table["status"] == "failed"]
    assert set(failed["gear.sun.r_bore_mm"]) == {99.0}
    assert failed["error"].str.contains("r_bore").all()
    pair = gf.load_scene("planetary_pitting").pair("sun_planet")
    for number in (0, 17, 35):
        row = table.loc[number]
        gears = gf.GearPair(replace(pair.pair.gear_1, r_bore=row["gear.sun.r_bore_mm"]), pair.pair.gear_2, pair.pair.a)
        crack = {"pinion": [gf.Crack(level=row["crack.cracked.level"])]}
        run = {"force": row["pair.sun_planet.force_N"], "material": pair.materials, "damage": crack, "span": "tooth"}
        alone = gf.mesh_stiffness(gears, method="textbook", phases=8, **run)
        assert row["k_mean"] == alone.k.mean()
        found = undisturbed.curves(["k"], {"crack.cracked.level": (0.05, 0.45)}).sel(number=number)
        np.testing.assert_array_equal(found["k"].dropna("place"), alone.k)


def test_tables_and_curves_are_filtered_and_have_units(undisturbed):
    some = undisturbed.table(["k_mean"], {"crack.cracked.level": (0.15, 0.35), "pair.sun_planet.force_N": [500.0, 2000.0]})
    assert len(some) == 4 * 2 * 2
    assert some.attrs["units"] == {"k_mean": "N/m"}
    curves = undisturbed.curves(where={"status": "done"})
    assert curves["k"].attrs["units"] == "N/m"
    assert curves["k"].sizes["number"] == 36
    assert np.isfinite(curves["k"]).all()
    with pytest.raises(ValueError, match="no curve"):
        undisturbed.curves(["k_mean"])
    with pytest.raises(ValueError, match="no column 'q'"):
        undisturbed.table(where={"q": 1})
    with pytest.raises(ValueError, match="no column 'q'"):
        undisturbed.table(["q"])
    assert "48 of 48" in repr(undisturbed)


def test_another_study_version_or_shard_is_noticed(undisturbed, tmp_path, monkeypatch):
    with pytest.raises(ValueError, match=r"holds another study, begun with options\.phases = 8, not 16"):
        gf.sweep(STUDY | {"options": {"method": "textbook", "phases": 16}}, undisturbed.folder)
    assert len(gf.sweep(STUDY | {"block": 7}, undisturbed.folder)) == 48  # how it is cut is no other study
    small = STUDY | {"vary": {"crack.cracked.level": [0.1, 0.2]}}
    gf.sweep(small, tmp_path / "runs", workers=1)
    other = run.program() | {"source": "0" * 12, "numpy": "0.1"}
    monkeypatch.setattr(run, "program", lambda: other)
    with pytest.raises(ValueError, match="begun by another program, with source"):
        gf.sweep(small, tmp_path / "runs")
    (tmp_path / "runs" / "block-000000.parquet").unlink()
    with pytest.raises(RuntimeError, match="a worker has gearfe of source"):
        gf.sweep(small, tmp_path / "runs", workers=1, mixed=True)
    monkeypatch.undo()
    about = json.loads((tmp_path / "runs" / "_about.json").read_text())
    (tmp_path / "runs" / "_about.json").write_text(json.dumps(about | {"made": about["made"] | {"source": "0" * 12}}))
    assert len(gf.sweep(small, tmp_path / "runs", workers=1, mixed=True)) == 2
    (tmp_path / "runs" / "_about.json").write_text(json.dumps(about))
    half = shards.encoded(shards.read(tmp_path / "runs").slice(0, 1))
    (tmp_path / "runs" / "other.parquet").write_bytes((tmp_path / "runs" / "block-000000.parquet").read_bytes())
    with pytest.raises(ValueError, match=r"block-000000\.parquet and other\.parquet with the same rows"):
        gf.sweep(small, tmp_path / "runs")
    (tmp_path / "runs" / "other.parquet").write_bytes(half)
    with pytest.raises(ValueError, match=r"other\.parquet, which does not belong to this study"):
        gf.sweep(small, tmp_path / "runs")


def test_options_that_contradict_are_refused(tmp_path):
    for options in ({"workers": 0}, {"workers": True}, {"workers": 1, "scheduler": "tcp://x"}):
        with pytest.raises(ValueError, match=r"workers|scheduler"):
            gf.sweep(STUDY, tmp_path / "runs", **options)
    assert not (tmp_path / "runs").exists()


def test_a_plan_says_what_it_will_take(tmp_path):
    plan = gf.plan_sweep(STUDY, tmp_path, workers=2)
    assert (plan.cases, plan.blocks, plan.tried, plan.failed) == (48, 16, 3, 0)
    assert plan.seconds > 0
    assert plan.disk > 0
    assert "48 cases in 16 blocks" in plan.text()
    assert not list(tmp_path.iterdir())


def test_verb_plans_sweeps_and_goes_on(tmp_path, capsys):
    (tmp_path / "s.toml").write_text(
        'title = "bores"\nscene = "planetary_pitting"\npair = "sun_planet"\n'
        'options.method = "textbook"\noptions.phases = 8\nvary.gear.sun.r_bore_mm = [6.0, 7.0, 99.0]\n'
    )
    verb = ["sweep", str(tmp_path / "s.toml"), "-o", str(tmp_path / "runs"), "--workers", "1"]
    assert main([*verb, "--dry-run"]) == 0
    assert "3 cases in 1 block\n" in capsys.readouterr().out
    assert not (tmp_path / "runs").exists()
    for _ in range(2):
        assert main(verb) == 0
        told = capsys.readouterr().out
        assert "bores: 3 cases, 2 done, 1 failed" in told
        assert "1 times: ValueError" in told
    (tmp_path / "s.toml").write_text((tmp_path / "s.toml").read_text().replace("7.0", "7.1"))
    assert main(verb) == 1
    assert "another study, begun with axes.0.gear.sun.r_bore_mm.1 = 7.0, not 7.1" in capsys.readouterr().err

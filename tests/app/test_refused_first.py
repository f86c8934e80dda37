"""What cannot be is refused before work begins, and each option of each verb stands any text."""

import pytest

from gearfe.app.cli import main
from gearfe.comparison import simulated
from gearfe.reports import findings


def never(*_, **__):
    raise AssertionError("work has begun")


@pytest.mark.parametrize("value", ["-1", "nan", "inf", "-0.0001"])
def test_a_duration_that_cannot_be(value, monkeypatch, tmp_path, capsys):
    monkeypatch.setattr(findings, "compare", never)
    monkeypatch.setattr(simulated, "build_machine", never)
    page = str(tmp_path / "x.html")
    assert main(["report", "planetary_pitting", "-o", page, "--duration", value]) == 1
    assert "duration = " in capsys.readouterr().err
    assert main(["dynamics", "planetary_pitting", "--duration", value]) == 1
    assert "duration = " in capsys.readouterr().err
    assert main(["dynamics", "planetary_pitting", "--method", value]) == 1
    assert "method = " in capsys.readouterr().err


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["-o", ""], "the name of the folder is empty"),
        (["-o", "out", "--scheduler", ""], "scheduler = '', but give the address"),
        (["-o", "out", "--scheduler", " "], "scheduler = ' ', but give the address"),
        (["-o", "out", "--workers", "0"], "workers = 0"),
    ],
)
def test_a_sweep_that_goes_nowhere(options, told, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "s.toml").write_text('scene = "planetary_pitting"\n[vary]\n"gear.sun.r_bore_mm" = [7.0, 7.4]\n')
    assert main(["sweep", "s.toml", *options]) == 1
    assert told in capsys.readouterr().err
    assert [one.name for one in tmp_path.iterdir()] == ["s.toml"]


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--mesh", "nan"], "mesh = nan Hz, but a frequency"),
        (["--mesh", "1e30"], "but a contains frequencies up to 500 Hz"),
        (["--mesh", "100", "--fault", "0"], "fault = 0.0 Hz"),
        (["--mesh", "100", "--carrier", "-1"], "carrier = -1.0 Hz"),
        (["--pulses", "0"], "--pulses 0"),
    ],
)
def test_frequencies_that_cannot_be(options, told, tmp_path, capsys):
    path = tmp_path / "run.csv"
    path.write_text("time [s],a [g]\n" + "".join(f"{i / 1000},{(7919 * i) % 101}\n" for i in range(400)))
    assert main(["signal", str(path), *options]) == 1
    assert told.replace("but a contains", "but run a contains") in capsys.readouterr().err


@pytest.mark.parametrize("option", ["--case", "--pair", "--method", "--force", "-o", "--pose"])
def test_nothing_behind_an_option(option, capsys):
    """``--case=--``, of which older argparse makes an empty list."""
    with pytest.raises(SystemExit) as ended:
        main(["stiffness", "planetary_pitting", f"{option}=--" if option != "-o" else "-o"])
    assert ended.value.code == 2
    assert "expected one argument" in capsys.readouterr().err


WHOLE = """title = "teeth"\nscene = "planetary_pitting"\nkind = "stiffness"\npair = "sun_planet"\n
[options]\nphases = 8\nmethod = "textbook"\n\n[vary]\ngear.sun.z = {{ from = {}, to = {}, count = 2 }}\n"""


def test_steps_of_teeth_are_whole_and_a_sweep_without_a_result_fails(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "whole.toml").write_text(WHOLE.format(20, 21), encoding="utf-8")
    assert main(["sweep", "whole.toml", "-o", "whole", "--workers", "1"]) == 0
    assert "2 cases, 2 done" in capsys.readouterr().out
    (tmp_path / "half.toml").write_text(WHOLE.format(20.5, 21.5), encoding="utf-8")
    for options in (["--dry-run"], ["--workers", "1"]):
        assert main(["sweep", "half.toml", "-o", "half", *options]) == 1
        assert "[gear.sun] z = 20.5" in capsys.readouterr().err

"""What a file says cannot steer the terminal; messages of a verb speak of its options."""

import io
import os
import pty
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import gearfe as gf
from gearfe.app.cli import main, shell
from gearfe.signal.indicator_table import tabulate_indicators

STEERS = "\x1b[31m\x1b]0;owned\x07\x9b2J\u202e"
QUOTED = "\\u001b[31m\\u001b]0;owned\\u0007\\u009b2J\\u202e"  # the same in TOML
SCENE = f"""\
title = "two gears {QUOTED}"
source = "own"
later = ["nothing {QUOTED}"]
[material.steel]
E_MPa = 206000.0
nu = 0.3
[gear.pinion]
z = 21
m_n_mm = 2.0
alpha_n_deg = 20.0
b_mm = 20.0
r_bore_mm = 7.4
material = "steel"
[gear.wheel]
z = 31
m_n_mm = 2.0
alpha_n_deg = 20.0
b_mm = 20.0
r_bore_mm = 11.4
material = "steel"
[pair."stage {QUOTED}"]
gear_1 = "pinion"
gear_2 = "wheel"
force_N = 2000.0
[[crack]]
case = "cracked {QUOTED} $x_$ |<b>"
gear = "pinion"
level = 0.3
[[assumption]]
what = "width {QUOTED}"
why = "none {QUOTED}"
"""


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / f"own{STEERS.replace('/', '')}.toml"
    path.write_text(SCENE, encoding="utf-8")
    return path


def quiet(text):
    return not shell.STEERING.search(text)


@pytest.mark.slow
@pytest.mark.parametrize("more", [["--case", f"cracked {STEERS} $x_$ |<b>"], ["--pair", "none"], ["--case", "none"]])
def test_no_verb_passes_on_what_steers_a_terminal(scene, more, capsys, tmp_path):
    for verb in (["stiffness", "--method", "textbook", "--plot", str(tmp_path / "p.png")], ["compare", "--refine", "0.2"]):
        code = main([verb[0], str(scene), *verb[1:], "--phases", "4", *more])
        said = capsys.readouterr()
        assert code == ("none" in more)
        assert quiet(said.out)
        assert quiet(said.err)
        assert "\\x1b[31m" in said.out + said.err


def test_names_of_columns_and_files(tmp_path, capsys):
    path = tmp_path / f"run{STEERS}.csv"
    path.write_text(f"time [s],a{STEERS} [g],b{STEERS} [g]\n" + "".join(f"{i / 10},{i % 3},1\n" for i in range(20)))
    for more in ([], ["--list"], ["--column", "c"]):
        main(["signal", str(path), *more])
        said = capsys.readouterr()
        assert quiet(said.out + said.err)
        assert "\\x1b[31m" in said.out + said.err


def test_on_a_terminal_too(scene):
    """The bar's own codes stay; those of the file do not come through, nor does what rich would take for its markup."""
    leader, follower = pty.openpty()
    command = [sys.executable, "-m", "gearfe", "stiffness", f"no[bold]{STEERS}"]
    environment = os.environ | {"PYTHONPATH": str(Path(gf.__file__).parents[1]), "TERM": "xterm"}
    done = subprocess.run(command, stdout=follower, stderr=follower, env=environment, check=False)
    os.close(follower)
    told = os.read(leader, 100_000).decode()
    os.close(leader)
    assert done.returncode == 1
    assert "owned\x07" not in told
    assert "]0;owned\\x07" in told
    assert "no[bold]\\x1b[31m" in told


def test_harmless_text_stays():
    assert shell.harmless("± µm\n\tx, 日本 é") == "± µm\n\tx, 日本 é"
    assert shell.harmless("a\rb\x7f") == "a\\rb\\x7f"
    stream = io.StringIO()
    print("x\x1b", file=shell.Harmless(stream))
    assert stream.getvalue() == "x\\x1b\n"


def test_messages_speak_of_options(tmp_path, capsys):
    path = tmp_path / "run.csv"
    np.savetxt(path, np.arange(20.0))
    for more, said in (
        ([], "give --rate"),
        (["--rate", "10"], "or as --unit"),
        (["--rate", "10", "--unit", "g", "--column", "x"], "give one as --column"),
    ):
        assert main(["signal", str(path), *more]) == 1
        told = capsys.readouterr().err
        assert said in told
        assert "=\n" not in told
    assert shell.as_options(ValueError("rate = 3, give rate= or rates="), ["rate"]) == "--rate = 3, give --rate or rates="


def test_tables_keep_their_columns():
    """A name with a bar or a line end stays one cell of a Markdown table."""
    noise = np.random.default_rng(1).normal(size=256)
    signals = {name: gf.Signal(noise, 1000.0, "g") for name in ("plain", "a|b\nc")}
    table = tabulate_indicators(gf.indicator_table(signals, healthy="plain"))
    for text in (table.markdown(), str(table)):
        assert {line.replace(r"\|", "").count("|") for line in text.splitlines()} == {4}
    assert table.cells()[0] == ["indicator", "plain", "a|b c"]

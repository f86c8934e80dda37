import shutil
import subprocess

import pytest

from gearfe.app.cli import main
from gearfe.scene.load import scene_names


def completed(script, *words):
    ask = f"COMP_WORDS=({' '.join(repr(word) for word in words)}); COMP_CWORD={len(words) - 1}; _gearfe; echo ${{COMPREPLY[@]}}"
    done = subprocess.run(["bash", "-c", f"{script}\n{ask}"], capture_output=True, text=True, check=True)
    return done.stdout.split()


@pytest.mark.skipif(shutil.which("bash") is None, reason="no bash")
def test_bash_completes_verbs_options_choices_and_scenes(capsys):
    assert main(["completion", "bash"]) == 0
    script = capsys.readouterr().out
    assert completed(script, "gearfe", "rep") == ["report"]
    assert completed(script, "gearfe", "stiffness", "pl") == ["planetary_pitting"]
    assert set(completed(script, "gearfe", "compare", "")) >= set(scene_names())
    assert completed(script, "gearfe", "stiffness", "x", "--pha") == ["--phases"]
    assert completed(script, "gearfe", "render", "x", "--what", "") == ["stress", "contact", "pattern"]
    assert completed(script, "gearfe", "completion", "z") == ["zsh"]
    assert completed(script, "gearfe", "te", "planetary_pitting", "--case", "mi") == ["mild", "mild_rows"]
    assert completed(script, "gearfe", "te", "planetary_pitting", "--pair", "p") == ["planet_ring"]
    assert completed(script, "gearfe", "te", "planetary_pitting", "--method", "fe") == ["fe", "fe3d"]


def test_zsh_reads_the_same_completions(capsys):
    assert main(["completion", "zsh"]) == 0
    text = capsys.readouterr().out
    assert "bashcompinit" in text
    assert "complete -o default -F _gearfe gearfe" in text


def test_info_says_what_is_there_and_what_would_help(capsys, tmp_path, monkeypatch):
    monkeypatch.setenv("GEARFE_CACHE", str(tmp_path))
    (tmp_path / "a.gear").write_bytes(b"0" * 1_500_000)
    assert main(["info"]) == 0
    text = capsys.readouterr().out
    assert f"{tmp_path}, 1 files, 1.5 MB" in text
    for word in ("gearfe 0.", "threads: ", "memory: ", "solvers: ", "mesher: gmsh starts", "renderer: "):
        assert word in text

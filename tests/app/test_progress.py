"""How far a verb is: steps that rise from 0 towards 1, shown on a terminal, silent elsewhere."""

import os
import pty
import re
import subprocess
import sys

import pytest

from gearfe.app.cli import main
from gearfe.app.cli.progress import _log
from gearfe.core.steps import is_heard, listening, part, steps


def heard(work):
    """What a listener gets during `work`: parts of the work that are done."""
    said = []
    with listening(lambda text, done: said.append(done)):
        work()
    return said


def test_parts_of_parts_run_once_from_start_to_end():
    def work():
        with part("a", 0.0, 0.5):
            list(steps(range(4)))
        for _ in steps([1, 2], weights=[1, 4]):
            with part("b", 0.5, 1.0):
                pass

    assert heard(work) == pytest.approx([0, 0, 0.125, 0.25, 0.375, 0, 0.1, 0.2, 0.6])


def test_a_failure_leaves_nobody_listening():
    def failing():
        with listening(lambda *_: None), part("a", 0.0, 1.0):
            raise ValueError("x")

    with pytest.raises(ValueError, match="x"):
        failing()
    assert heard(lambda: list(steps("ab"))) == [0.0, 0.5]


def test_an_abandoned_iterator_leaves_nobody_listening():
    """Its part of the work ends when the iterator is deleted, which can be after the listener has left."""
    with listening(lambda *_: None):
        left = steps("ab")
        next(left)
    assert not is_heard()
    del left
    assert not is_heard()


@pytest.mark.parametrize(
    ("line", "least"),
    [
        ("stiffness planetary_pitting --method ritz3d --phases 2 --refine 0.3", 10),
        ("compare planetary_pitting --phases 2 --refine 0.2", 5),
        ("te planetary_pitting --forces 1000 2000 --phases 8 --refine 0.3", 3),
    ],
)
def test_verbs_say_how_far_they_are(line, least, capsys):
    said = heard(lambda: main(line.split()))
    assert len(said) >= least
    assert said == sorted(said)
    assert said[0] == 0.0
    assert 0.5 <= said[-1] < 1.0


@pytest.mark.slow
def test_a_terminal_shows_the_time_left(tmp_path):
    """On a pseudo-terminal; without numbers of seconds, which the machine decides."""
    screen, terminal = pty.openpty()
    command = [sys.executable, "-m", "gearfe", "stiffness", "planetary_pitting"]
    command += ["--method", "fe", "--error", "--phases", "2", "--refine", "0.3"]
    environment = os.environ | {"TERM": "xterm", "GEARFE_CACHE": str(tmp_path), "COLUMNS": "64"}
    with subprocess.Popen(command, stderr=terminal, stdout=subprocess.DEVNULL, env=environment) as run:
        os.close(terminal)
        text = b""
        while True:
            try:
                text += os.read(screen, 4096)
            except OSError:
                break
    assert run.returncode == 0
    assert re.search(rb"0:\d\d:\d\d\x1b\[0m gone, left", text), "a long description takes the clock's place"
    assert b"estimate of the" in text


def test_a_pipe_gets_a_line_at_intervals(capsys):
    step = _log("sweep", interval=0.0)
    step("block 2 of 8", 0.25)
    assert "gearfe: block 2 of 8: 25 % after 0 s, about 0 s left" in capsys.readouterr().err
    _log("sweep")("block 2 of 8", 0.25)
    assert capsys.readouterr().err == ""

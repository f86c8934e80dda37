"""Every way a verb can end: one line, an exit code, no traceback."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import gearfe
from gearfe.app.cli import shell

ENVIRONMENT = os.environ | {"PYTHONPATH": str(Path(gearfe.__file__).parents[1]), "PYTHONUNBUFFERED": "1"}
COMMAND = [sys.executable, "-m", "gearfe"]


def failing(error):
    def work():
        raise error

    return work


def test_interrupted_work_that_goes_on_says_so(capfd):
    assert shell.run(failing(KeyboardInterrupt()), ["output", "dry_run"]) == 130
    assert capfd.readouterr().err.endswith("the same command goes on where it was\n")


@pytest.mark.parametrize(
    ("error", "code", "said"),
    [
        (ValueError("z = 4, but"), 1, "gearfe: z = 4, but\n"),
        (RuntimeError("no contact"), 1, "gearfe: no contact\n"),
        (KeyboardInterrupt(), 130, "gearfe: interrupted; no incomplete file remains\n"),
        (MemoryError(), 1, "gearfe: not enough memory; a smaller --refine or fewer --phases need less\n"),
        (PermissionError(13, "Permission denied", "x.csv"), 1, "gearfe: cannot read or write x.csv: Permission denied\n"),
    ],
)
def test_one_line_and_a_code(error, code, said, capfd):
    if isinstance(error, OSError):  # standard output is given up then: in a process of its own
        text = "from gearfe.app.cli import shell\ndef work():\n    raise PermissionError(13, 'Permission denied', 'x.csv')\n"
        done = subprocess.run(
            [sys.executable, "-c", f"{text}raise SystemExit(shell.run(work))"], capture_output=True, text=True, env=ENVIRONMENT,
            check=False,
        )  # fmt: skip
        assert (done.returncode, done.stderr) == (code, said)
        return
    assert shell.run(failing(error)) == code
    assert capfd.readouterr().err == said


def test_a_mistake_of_ours_stays_a_traceback():
    with pytest.raises(AttributeError):
        shell.run(failing(AttributeError("a bug")))


def test_characters_an_output_does_not_know_are_spelled_out():
    code = "from gearfe.app.cli import shell; raise SystemExit(shell.run(lambda: print('1 ± 2 µm, ∂')))"
    environment = ENVIRONMENT | {"PYTHONIOENCODING": "ascii"}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment, check=True)
    assert done.stdout == "1 +- 2 um, ?\n"


def test_a_reader_that_has_gone_is_no_error():
    with subprocess.Popen([*COMMAND, "scenes"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=ENVIRONMENT) as process:
        process.stdout.close()
        said = process.stderr.read()
    assert (process.returncode, said) == (141, b"")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="this system has no /dev/full")
def test_a_full_disk_is_said():
    with open("/dev/full", "w") as full:
        done = subprocess.run([*COMMAND, "scenes"], stdout=full, stderr=subprocess.PIPE, text=True, env=ENVIRONMENT, check=False)
    assert (done.returncode, done.stderr) == (1, "gearfe: cannot read or write: No space left on device\n")


WORK = ["stiffness", "planetary_pitting", "--method", "fe", "--refine"]
BEGUN = f"""
import sys
from gearfe.app.cli import main
main([*{WORK}, "0.2", "--phases", "1"])
print("begun")
raise SystemExit(main(sys.argv[1:]))
"""


def test_interrupted_work_leaves_one_line_and_no_file(tmp_path, tmp_path_factory):
    """All modules are loaded before: an interrupt that falls into an import is handled, but Python may then end by the signal."""
    target = tmp_path / "k.csv"
    command = [sys.executable, "-c", BEGUN, *WORK, "4", "-o", str(target)]
    environment = ENVIRONMENT | {"GEARFE_CACHE": str(tmp_path_factory.mktemp("empty"))}
    ignored = signal.signal(signal.SIGINT, signal.default_int_handler)  # a run in the background inherits that it is ignored
    try:
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment)
    finally:
        signal.signal(signal.SIGINT, ignored)
    with process:
        assert "begun\n" in iter(process.stdout.readline, "")
        time.sleep(0.3)
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=60)
    assert process.returncode == 130
    assert said == "gearfe: interrupted; no incomplete file remains\n"
    assert list(tmp_path.iterdir()) == []

"""Killed writers, full disks, processes that share a cache, clocks that jump: nothing lost, nothing half-written."""

import os
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import gearfe as gf
from gearfe.cli import main
from gearfe.files import suffixes
from gearfe.stiffness import cache
from gearfe.stiffness.flexibility_file import read_flexibility, write_flexibility

ROOT = Path(gf.__file__).parents[1]
ENVIRONMENT = os.environ | {"PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1"}
WRITER = """
import sys, numpy as np
from gearfe.files import Content, save
from matplotlib.figure import Figure
from gearfe.files import save_figure
path = sys.argv[1]
values = np.arange(30_000.0)
content = Content("test", {"x [m]": values}, {"x": values}, {"why": "test"}, {"x": "m"})
figure = Figure(figsize=(4, 4))
figure.subplots().plot(values)
print("ready", flush=True)
while True:
    save_figure(figure, path, 50) if path.endswith((".png", ".svg", ".pdf")) else save(path, "curve", content)
"""


@pytest.mark.parametrize("suffix", [*suffixes("curve"), ".png"])
def test_a_killed_writer_leaves_the_old_file_or_a_new_one(tmp_path, suffix):
    """Killed at any moment: what stands there is whole, the old or the new."""
    target = tmp_path / f"x{suffix}"
    target.write_bytes(b"old")
    whole = set()
    for delay in (0.0, 0.07):
        with subprocess.Popen([sys.executable, "-c", WRITER, str(target)], stdout=subprocess.PIPE, env=ENVIRONMENT) as writer:
            assert writer.stdout.readline() == b"ready\n"
            time.sleep(delay)
            writer.send_signal(signal.SIGKILL)
        whole.add(len(target.read_bytes()))
    assert len(whole - {3}) <= 1 or suffix in (".png", ".mat"), "one whole length"  # those state when they were written
    left = [path.name for path in tmp_path.iterdir() if path != target]
    assert all(name.startswith(".x-") for name in left), "hidden, beside it, never in its place"


@pytest.mark.parametrize("arguments", [["-o", "k.csv"], ["-o", "k.npz"], ["-o", "k.mat"], ["-o", "k.json"], ["--plot", "k.png"]])
def test_a_full_disk_is_said_and_leaves_the_old_file(tmp_path, arguments, capfd, monkeypatch):
    """No file may grow beyond 2000 bytes: the write fails in its middle."""
    monkeypatch.chdir(tmp_path)
    target = tmp_path / arguments[1]
    target.write_bytes(b"old")
    code = (
        "import resource, signal, sys; signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        "from gearfe.cli import main\n"
        "import matplotlib.figure, gearfe.stiffness.solve, scipy.io, matplotlib.font_manager\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))\n"
        "raise SystemExit(main(sys.argv[1:]))"
    )
    command = [sys.executable, "-c", code, "stiffness", "planetary_pitting", "--method", "textbook", *arguments]
    done = subprocess.run(command, capture_output=True, text=True, env=ENVIRONMENT | {"GEARFE_CACHE": ""}, check=False)
    assert done.returncode == 1, done.stderr
    assert "cannot" in done.stderr
    assert "Traceback" not in done.stderr
    assert target.read_bytes() == b"old"
    assert [path.name for path in tmp_path.iterdir()] == [target.name]


def test_two_processes_share_one_cache(tmp_path):
    """Both solve the same gears at once; both get the same numbers, and no file is broken."""
    code = (
        "import gearfe as gf, math\n"
        "g = dict(m_n=2.0, alpha_n=math.radians(20), b=4.0)\n"
        "pair = gf.GearPair(gf.Gear(z=18, r_bore=9.0, **g), gf.Gear(z=20, r_bore=9.0, **g))\n"
        "print(gf.mesh_stiffness(pair, 800.0, gf.Material(), method='fe', refine=0.4, phases=3).k.tolist())"
    )
    environment = ENVIRONMENT | {"GEARFE_CACHE": str(tmp_path)}
    command = [sys.executable, "-c", code]
    both = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment) for _ in range(2)]
    said = [one.communicate()[0] for one in both]
    assert said[0] == said[1] != ""
    files = sorted(tmp_path.iterdir())
    assert [file.suffix for file in files] == [".npz", ".npz"]
    for file in files:  # clocks that jump: times of files say nothing
        os.utime(file, (0, 4_000_000_000))
    third = subprocess.run(command, capture_output=True, text=True, env=environment, check=True).stdout
    assert third == said[0]
    assert sorted(tmp_path.iterdir()) == files


def test_a_file_limit_costs_only_the_reuse(tmp_path, monkeypatch):
    """The cache's disk takes no more: the gear is solved, nothing is left."""
    monkeypatch.setenv("GEARFE_CACHE", str(tmp_path))
    before, handler = resource.getrlimit(resource.RLIMIT_FSIZE), signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, before[1]))
    try:
        with pytest.raises(ValueError, match="cannot write"):
            write_flexibility(tmp_path / "x.npz", "key", {"a": np.zeros(10_000)})
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, handler)
    assert list(tmp_path.iterdir()) == []
    assert read_flexibility(tmp_path / "x.npz", "key", dict) is None
    assert cache.folder() == tmp_path


def test_a_folder_that_may_not_be_written_is_refused_first(tmp_path, capsys):
    closed = Path("/proc") if Path("/proc").is_dir() else tmp_path  # where not even root may write
    tmp_path.chmod(0o500)
    assert main(["stiffness", "planetary_pitting", "-o", str(closed / "k.csv")]) == 1
    assert "writable folder" in capsys.readouterr().err

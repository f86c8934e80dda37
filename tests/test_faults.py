"""Killed writers, full disks, processes that share a cache, clocks that jump: nothing lost, nothing half-written."""

import json
import math
import os
import resource
import signal
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.app.cli import main
from gearfe.core.files import PART, suffixes
from gearfe.flexibility.finite_elements import fe
from gearfe.stiffness import cache, disk
from gearfe.stiffness.flexibility_file import read_flexibility, write_flexibility

ROOT = Path(gf.__file__).parents[1]
ENVIRONMENT = os.environ | {"PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1"}
WRITER = """
import os, signal, sys, time, numpy as np
from gearfe.core.files import Content, save
from matplotlib.figure import Figure
from gearfe.core.files import save_figure
values = np.arange(30_000.0)
content = Content("test", {"x [m]": values}, {"x": values}, {"why": "test"}, {"x": "m"})
figure = Figure(figsize=(4, 4))
figure.subplots().plot(values)
begun, begin = os.pipe()
for path in sys.argv[1:]:
    for delay in (0.0, 0.07):
        writer = os.fork()
        if not writer:
            os.write(begin, b".")
            while True:
                save_figure(figure, path, 50) if path.endswith(".png") else save(path, "curve", content)
        os.read(begun, 1)
        time.sleep(delay)
        os.kill(writer, signal.SIGKILL)
        os.waitpid(writer, 0)
        print(path, os.path.getsize(path))
"""


@pytest.mark.slow
def test_a_killed_writer_leaves_the_old_file_or_a_new_one(tmp_path):
    """Killed at any moment: what stands there is whole, the old or the new."""
    targets = [tmp_path / f"x{suffix}" for suffix in (*suffixes("curve"), ".png")]
    for target in targets:
        target.write_bytes(b"old")
    command = [sys.executable, "-c", WRITER, *map(str, targets)]
    said = subprocess.run(command, capture_output=True, text=True, env=ENVIRONMENT, check=True).stdout
    sizes = {target: set() for target in targets}
    for path, size in map(str.split, said.splitlines()):
        sizes[Path(path)].add(int(size))
    for target, whole in sizes.items():
        assert whole, target
        assert len(whole - {3}) <= 1 or target.suffix in (".png", ".mat"), (
            "one whole length"
        )  # those state when they were written
    left = [path.name for path in tmp_path.iterdir() if path not in targets]
    assert all(name.startswith(PART) for name in left), "hidden, beside it, never in its place"


FULL = """
import os, resource, signal, sys
from gearfe.app.cli import main
import matplotlib.figure, gearfe.stiffness.solve, scipy.io, matplotlib.font_manager
work = ["stiffness", "planetary_pitting", "--method", "textbook"]
main(work)  # what it computes is there when each run begins
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))
codes = []
for name in sys.argv[1:]:
    run = os.fork()
    if not run:
        code = 99
        try:
            code = main([*work, "--plot" if ".png" in name else "-o", name])
        finally:
            os._exit(code)
    codes.append(os.waitstatus_to_exitcode(os.waitpid(run, 0)[1]))
print(codes)
"""


@pytest.mark.slow
def test_a_full_disk_is_said_and_leaves_the_old_file(tmp_path):
    """No file may grow beyond 2000 bytes: the write fails in its middle."""
    names = ["k.csv", "k.json", "k.mat", "k.npz", "k.png"]
    for name in names:
        (tmp_path / name).write_bytes(b"old")
    environment = ENVIRONMENT | {"GEARFE_CACHE": ""}
    command = [sys.executable, "-c", FULL, *names]
    done = subprocess.run(command, capture_output=True, text=True, env=environment, cwd=tmp_path, check=True)
    assert done.stdout.splitlines()[-1] == str([1] * 5), done.stderr
    assert [name for line in done.stderr.splitlines() for name in names if "cannot" in line and name in line] == names, (
        done.stderr
    )
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == dict.fromkeys(names, b"old")


@pytest.mark.slow
def test_two_processes_share_one_cache(tmp_path, monkeypatch):
    """Both solve the same gears at once; both get the same numbers, and no file is broken."""
    run = {"method": "fe", "refine": 0.4, "phases": 3}
    code = (
        "import gearfe as gf, math\n"
        "g = dict(m_n=2.0, alpha_n=math.radians(20), b=4.0)\n"
        "pair = gf.GearPair(gf.Gear(z=18, r_bore=9.0, **g), gf.Gear(z=20, r_bore=9.0, **g))\n"
        f"print(gf.mesh_stiffness(pair, 800.0, gf.Material(), **{run}).k.tolist())"
    )
    environment = ENVIRONMENT | {"GEARFE_CACHE": str(tmp_path)}
    command = [sys.executable, "-c", code]
    both = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment) for _ in range(2)]
    said = [one.communicate()[0] for one in both]
    assert said[0] == said[1] != ""
    files = sorted(tmp_path.iterdir())
    assert [file.suffix for file in files] == [".gear", ".gear"]
    for file in files:  # clocks that jump: times of files say nothing
        os.utime(file, (0, 4_000_000_000))
    monkeypatch.setenv("GEARFE_CACHE", str(tmp_path))
    monkeypatch.setattr(fe, "flexibility", None)  # nothing is solved again
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 4.0}
    pair = gf.GearPair(gf.Gear(z=18, r_bore=9.0, **rack), gf.Gear(z=20, r_bore=9.0, **rack))
    cache.clear()
    third = gf.mesh_stiffness(pair, 800.0, gf.Material(), **run)
    assert_allclose(third.k, json.loads(said[0]), rtol=1e-12)
    cache.clear()
    assert sorted(tmp_path.iterdir()) == files


def test_a_file_limit_costs_only_the_reuse(tmp_path, monkeypatch):
    """The cache's disk takes no more: the gear is solved, nothing is left."""
    monkeypatch.setenv("GEARFE_CACHE", str(tmp_path))
    before, handler = resource.getrlimit(resource.RLIMIT_FSIZE), signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, before[1]))
    try:
        with pytest.raises(ValueError, match="cannot write"):
            write_flexibility(tmp_path / "x.gear", "key", {"a": np.zeros(10_000)})
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, handler)
    assert list(tmp_path.iterdir()) == []
    assert read_flexibility(tmp_path / "x.gear", "key", None) is None
    assert disk.folder() == tmp_path


def test_a_folder_that_may_not_be_written_is_refused_first(tmp_path, capsys):
    closed = Path("/proc") if Path("/proc").is_dir() else tmp_path  # where not even root may write
    tmp_path.chmod(0o500)
    assert main(["stiffness", "planetary_pitting", "-o", str(closed / "k.csv")]) == 1
    assert "writable folder" in capsys.readouterr().err


@pytest.mark.parametrize("gigabytes", [1.0, *(pytest.param(size, marks=pytest.mark.slow) for size in (0.9, 1.2, 1.5))])
def test_too_little_memory_for_a_picture_is_said_and_leaves_no_file(gigabytes, tmp_path):
    """CHOLMOD and VTK end the process where memory is refused to them."""
    code = f"""
import resource
from gearfe.app.cli import main
resource.setrlimit(resource.RLIMIT_AS, ({int(gigabytes * 1e9)},) * 2)
raise SystemExit(main(["render", "planetary_pitting", "-o", "x.png"]))
"""
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, env=ENVIRONMENT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 1
    assert any(text in done.stderr for text in ("GB are free", "not enough memory", "does not load")), done.stderr
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
@pytest.mark.parametrize("gigabytes", [1.0, 1.2, 1.4])
def test_too_little_memory_for_a_full_solve_is_said(gigabytes):
    """Libraries reserve address space at their first use, which the plan of the memory counts."""
    code = f"""
import math, resource
import gearfe as gf
resource.setrlimit(resource.RLIMIT_AS, ({int(gigabytes * 1e9)},) * 2)
gear = gf.Gear(z=13, m_n=2.0, x=0.3, r_bore=8.0, alpha_n=math.radians(20), beta=0.26, b=12.0)
try:
    gf.root_stress_along_width(gear, 14.0, 100.0, gf.Material(E=207e3, nu=0.3), refine=0.4)
except RuntimeError as error:
    print(error)
"""
    done = subprocess.run([sys.executable, "-c", code], env=ENVIRONMENT, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert "GB are free" in done.stdout or not done.stdout


def test_a_file_name_outside_utf_8_is_drawn(tmp_path):
    from matplotlib.figure import Figure

    from gearfe.core.files import save_figure

    figure = Figure()
    figure.suptitle("\udcff $x")
    assert save_figure(figure, tmp_path / "x.png", 20).get_suptitle() == "? $x"


@pytest.mark.slow
def test_switched_off_compilation_is_said(tmp_path):
    code = "import gearfe as gf; m = gf.single_mesh(1.0, 1e8, 500.0, force=100.0); gf.simulate(m, 0.01)"
    environment = ENVIRONMENT | {"NUMBA_DISABLE_JIT": "1"}
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
    )
    assert "NUMBA_DISABLE_JIT is set" in done.stderr.splitlines()[-1]


@pytest.mark.parametrize("kind", ["SystemExit(143)", "TypeError"])
def test_a_terminated_command_leaves_no_file(tmp_path, kind):
    """Libraries may convert the exit to an error of any kind."""
    code = f"""
import os, signal, sys
from gearfe.app.cli.shell import run
from gearfe.core.files import written
from gearfe.geometry.mesh.mesher import gmsh_session
def work():
    with gmsh_session():
        pass
    with written("x.csv") as name:
        open(name, "w").close()
        try:
            os.kill(os.getpid(), signal.SIGTERM)
        except SystemExit:
            raise {kind} from None
sys.exit(run(work))
"""
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, env=ENVIRONMENT, check=False)
    assert done.returncode == 128 + signal.SIGTERM
    assert not list(tmp_path.iterdir())


def test_a_terminated_program_leaves_no_file(tmp_path):
    code = """
import os, signal
from gearfe.core.files import written
with written("x.csv") as name:
    os.kill(os.getpid(), signal.SIGTERM)
"""
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, env=ENVIRONMENT, check=False)
    assert done.returncode == 128 + signal.SIGTERM
    assert not list(tmp_path.iterdir())


def test_a_pdf_embeds_fonts_that_publishers_accept(tmp_path):
    from matplotlib.figure import Figure

    from gearfe.core.files import save_figure

    figure = Figure()
    figure.suptitle("k")
    save_figure(figure, tmp_path / "k.pdf", 50)
    content = (tmp_path / "k.pdf").read_bytes()
    assert b"/Type3" not in content
    assert b"/TrueType" in content or b"/Type0" in content


def test_a_zip_archive_is_no_installation(tmp_path):
    with zipfile.ZipFile(tmp_path / "gearfe.zip", "w") as archive:
        for name in ("__init__.py", "__init__.pyi"):
            archive.write(ROOT / "gearfe" / name, f"gearfe/{name}")
    environment = ENVIRONMENT | {"PYTHONPATH": str(tmp_path / "gearfe.zip")}
    command = [sys.executable, "-c", "import gearfe"]
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert "is in a zip archive: unpack it" in done.stderr.splitlines()[-1]


def test_a_link_stays_and_a_pipe_is_no_file(tmp_path):
    (tmp_path / "data").mkdir()
    (tmp_path / "data" / "target.csv").write_text("old")
    (tmp_path / "link.csv").symlink_to(tmp_path / "data" / "target.csv")
    os.mkfifo(tmp_path / "pipe.csv")
    (tmp_path / "full.csv").symlink_to("/dev/full")
    pair = gf.GearPair(*[gf.Gear(z=z, m_n=2.0, alpha_n=0.35, b=20.0, r_bore=10.0) for z in (25, 31)])
    curve = gf.mesh_stiffness(pair, 1000.0, gf.Material(), method="textbook", phases=4)
    curve.to_csv(tmp_path / "link.csv")
    assert (tmp_path / "link.csv").is_symlink()
    assert (tmp_path / "data" / "target.csv").read_text() != "old"
    for name in ("pipe.csv", "full.csv"):
        with pytest.raises(ValueError, match="pipe or a device"):
            curve.to_csv(tmp_path / name)
    assert len(list(tmp_path.rglob("*"))) == 5

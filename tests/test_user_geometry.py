"""A user's own file `geometry.py` beside gearfe, imported first or last, from a checkout and from a wheel."""

import subprocess
import sys
import tarfile
import zipfile

import pytest
from conftest import ROOT

PROGRAM = """
import pickle, sys

{first}
import gearfe as gf
{last}

assert geometry.MARK == "the user's own", geometry
pair = gf.GearPair(*(gf.Gear(z=z, m_n=2.0, alpha_n=0.35, b=20.0, r_bore=9.0) for z in (21, 31)))
case = gf.Case(pair, 1000.0, gf.Material(), damage={{"pinion": [gf.Crack(level=0.2)]}})
again = pickle.loads(pickle.dumps(case))
assert again == case and isinstance(again.pair, gf.GearPair) and isinstance(again.cracks[0][0], gf.Crack)
assert gf.Gear.__module__ == "gearfe.geometry.tooth.gear"
from gearfe.geometry.tooth.gear import Gear
assert Gear is gf.Gear
own = [name for name in sys.modules if name.partition(".")[0] == "geometry"]
assert own == ["geometry"], own
print(gf.mesh_stiffness(case, phases=2, cache=False).k.mean() > 1e8, gf.__file__)
"""
ORDERS = {"first": ("import geometry", ""), "last": ("", "import geometry")}


def built(kind, source, target):
    """The archive that hatchling builds of a folder."""
    command = [sys.executable, "-m", "hatchling", "build", "-t", kind, "-d", str(target)]
    subprocess.run(command, cwd=source, check=True, capture_output=True)
    return next(target.iterdir())


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    return built("wheel", ROOT, tmp_path_factory.mktemp("wheel"))


@pytest.fixture(scope="module")
def installed(wheel, tmp_path_factory):
    folder = tmp_path_factory.mktemp("installed")
    zipfile.ZipFile(wheel).extractall(folder)
    return folder


@pytest.mark.slow
@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("home", ["checkout", "wheel"])
def test_a_users_geometry_and_that_of_gearfe_do_not_meet(home, order, tmp_path, installed, monkeypatch):
    (tmp_path / "geometry.py").write_text('MARK = "the user\'s own"\n', encoding="utf-8")
    first, last = ORDERS[order]
    program = tmp_path / "program.py"
    program.write_text(PROGRAM.format(first=first, last=last), encoding="utf-8")
    place = ROOT if home == "checkout" else installed
    monkeypatch.setenv("PYTHONPATH", str(place))
    done = subprocess.run([sys.executable, str(program)], cwd=tmp_path, capture_output=True, text=True)
    assert done.stdout == f"True {place / 'gearfe' / '__init__.py'}\n", done.stderr


def test_a_second_copy_of_geometry_is_refused(tmp_path):
    """In a checkout its folder is found as `geometry` too: its classes would not be those of gearfe."""
    done = subprocess.run([sys.executable, "-c", "import geometry.tooth.gear"], cwd=ROOT, capture_output=True, text=True)
    assert "import gearfe.geometry" in done.stderr


def test_a_source_distribution_builds_the_same_wheel(wheel, tmp_path):
    with tarfile.open(built("sdist", ROOT, tmp_path / "sdist")) as archive:
        archive.extractall(tmp_path / "source", **({"filter": "data"} if hasattr(tarfile, "data_filter") else {}))
    other = built("wheel", next((tmp_path / "source").iterdir()), tmp_path / "wheel")
    one, two = ({file.filename: file.CRC for file in zipfile.ZipFile(path).infolist()} for path in (wheel, other))
    assert one == two
    assert {"gearfe/__init__.pyi", "gearfe/geometry/tooth/gear.py", "gearfe/geometry/py.typed"} <= set(one)
    assert not [name for name in one if not name.startswith("gearfe")]

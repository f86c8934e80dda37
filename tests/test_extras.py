"""What is said about extras is what the project's metadata says, and that is what ``pyproject.toml`` says."""

import re
import tomllib
from pathlib import Path

import pytest

from gearfe.app.cli.machine_info import OPTIONAL, advice
from gearfe.core import extras

ROOT = Path(__file__).resolve().parent.parent
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
READ = [*sorted((ROOT / "gearfe").rglob("*.md")), *sorted((ROOT / "gearfe").rglob("*.py")), ROOT / "README.md", ROOT / ".ci/run"]


def plain(requirements):
    return {re.match(r"[\w.-]+", one)[0].lower() for one in requirements}


def test_the_metadata_are_those_of_the_project():
    """Fails after a change of ``pyproject.toml`` until the project is installed again, as its messages then are of before."""
    found = extras.requirements()
    assert plain(found[""]) == plain(PROJECT["dependencies"])
    written = {name: plain(own) for name, own in PROJECT["optional-dependencies"].items() if name != "all"}
    assert {name: plain(own) for name, own in found.items() if name not in ("", "all")} == written


def test_every_extra_that_is_named_anywhere_exists():
    known = set(PROJECT["optional-dependencies"])
    for path in READ:
        if path.name == "CHANGES.md":
            continue
        for names in re.findall(r"(?:gearfe|\"\.|'\.)\[([a-z, ]+)\]", path.read_text(encoding="utf-8")):
            assert set(re.split(", *", names)) <= known, f"{path.relative_to(ROOT)} names [{names}]"


def test_every_optional_package_of_a_user_is_told_of():
    own = {name for extra, names in extras.requirements().items() if extra and extra not in extras.COLLECTIONS for name in names}
    assert {name.lower() for name in own} == {name.lower() for name in OPTIONAL}


def test_a_missing_package_is_named_with_the_extras_that_bring_it(monkeypatch):
    told = str(extras.missing("pyuff", ImportError("no module")))
    assert told == "this needs pyuff (no module): pip install pyuff, or pip install 'gearfe[signals]'"
    monkeypatch.setattr(extras, "requirements", dict)
    assert str(extras.missing("pyuff", ImportError("no module"))).endswith(": pip install pyuff")


@pytest.mark.parametrize("package", ["npTDMS", "nptdms", "NPTDMS"])
def test_names_of_packages_are_compared_as_pip_does(package):
    assert extras.bringing(package) == ("signals",)


def test_info_says_what_is_missing_and_what_brings_it(monkeypatch):
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None if name == "xarray" else True)
    assert list(advice()) == ["not installed: xarray, for curve.to_xarray(): pip install xarray, or pip install 'gearfe[data]'"]

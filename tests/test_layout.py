"""The order of the packages, which `[tool.importlinter]` of `pyproject.toml` states, and what their files owe each other."""

import ast
import importlib
import re
import subprocess
import sys

import grimp
import lazy_loader
import pytest
from conftest import ROOT
from importlinter.cli import lint_imports

import gearfe
from gearfe.stiffness.methods import ROWS

pytestmark = pytest.mark.quick

LOADERS = re.compile(r"\b(import_module|__import__)\(")
TABLE = ROOT / "gearfe/stiffness/methods.py"  # loads the solvers of its rows by name
SITE = ROOT / "gearfe/docs"  # scripts of the documentation, no part of the package
FILES = [path for top in ("gearfe", "geometry", "validation") for path in (ROOT / top).rglob("*.py") if SITE not in path.parents]


def test_imports_follow_the_contracts(capsys, monkeypatch):
    """Layers of packages without circles, imports inside functions too; heavy libraries stay where they belong."""
    monkeypatch.chdir(ROOT)
    assert lint_imports(no_cache=True, no_logo=True) == 0, capsys.readouterr().out


def test_modules_are_imported_as_such():
    """Import-linter does not see a module that is loaded by its name: only the table of methods does so, from below."""
    named = [path for path in FILES if path.is_relative_to(ROOT / "gearfe") and LOADERS.search(path.read_text(encoding="utf-8"))]
    assert named == [TABLE]
    assert all(row.home.startswith(("gearfe.flexibility.", "gearfe.stiffness.")) for row in ROWS)


def test_nothing_inside_imports_the_public_face():
    """`import gearfe` is for users: inside it would reach every package, upwards too."""
    graph = grimp.build_graph("gearfe", cache_dir=None)
    assert not graph.find_modules_that_directly_import("gearfe")


def test_every_package_says_what_is_in_it():
    packages = [path for path in FILES if path.name == "__init__.py"]
    assert len(packages) > 3
    for path in packages:
        assert ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))), f"{path} has no docstring"


def test_no_public_name_is_that_of_a_module():
    """Importing a module binds its name in the package, over a function of the same name."""
    modules = {path.stem for path in (ROOT / "gearfe").iterdir()}
    assert not modules & set(gearfe.__all__)


def test_an_unknown_public_name_is_answered_with_the_nearest():
    with pytest.raises(AttributeError, match="no 'mesh_stifness'; nearest: mesh_stiffness"):
        gearfe.mesh_stifness  # noqa: B018
    assert dir(gearfe) == gearfe.__all__


def test_command_line_starts_without_heavy_imports():
    heavy = "{'numpy', 'scipy', 'skfem', 'gmsh', 'pyvista', 'matplotlib', 'starlette', 'uvicorn'}"
    code = f"import sys, gearfe.app.cli; print(sorted({heavy} & set(sys.modules)))"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.strip() == "[]"


def test_every_package_has_quick_tests():
    folders = {path: list(path.glob("**/test_*.py")) for path in (ROOT / "tests").iterdir() if path.is_dir()}
    bare = [
        path.name
        for path, files in folders.items()
        if files and not any("pytest.mark.quick" in one.read_text(encoding="utf-8") for one in files)
    ]
    assert not bare, f"no test of tests/{bare} is marked quick"


def test_the_public_names_are_those_of_the_stub():
    """The fast reader of the stub finds the names that the parser of lazy_loader finds, and each is in its module."""
    _, _, names = lazy_loader.attach_stub("gearfe", gearfe.__file__)
    assert sorted(names) == sorted(gearfe.__all__)
    found = {name: module for module, own in gearfe._by_module().items() for name in own}
    assert {name for name, module in found.items() if not hasattr(importlib.import_module(f"gearfe.{module}"), name)} == set()

"""Imports point one way, and heavy libraries stay where they belong."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import gearfe

ROOT = Path(__file__).parents[1]
FILES = sorted([*ROOT.glob("geometry/**/*.py"), *ROOT.glob("gearfe/**/*.py")])
ALLOWED = {
    "gmsh": {"geometry/mesh/mesher.py"},
    "pyvista": {"gearfe/stress/render.py"},
    "matplotlib": {"gearfe/pictures/stiffness_plots.py", "gearfe/pictures/vibration_plots.py"},
}


def name_of(path):
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def imports(path, *, everywhere):
    """Absolute names of the modules a file imports, at its top or anywhere in it."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    package = path.relative_to(ROOT).parent.parts
    for node in ast.walk(tree) if everywhere else tree.body:
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = (
                ".".join((*package[: len(package) - node.level + 1], *filter(None, [node.module]))) if node.level else node.module
            )
            yield base
            yield from (f"{base}.{alias.name}" for alias in node.names)


@pytest.mark.parametrize("path", FILES, ids=name_of)
def test_heavy_imports_stay_home(path):
    for module in imports(path, everywhere=True):
        top = module.split(".")[0]
        assert top not in ALLOWED or str(path.relative_to(ROOT)) in ALLOWED[top], f"{name_of(path)} imports {top}"


@pytest.mark.parametrize("path", [p for p in FILES if "geometry" in p.parts], ids=name_of)
def test_geometry_never_imports_gearfe(path):
    assert not [m for m in imports(path, everywhere=True) if m.split(".")[0] == "gearfe"]


def test_no_public_name_is_that_of_a_module():
    """Importing a module binds its name in the package, over a function of the same name."""
    modules = {path.stem for path in FILES if path.parent.name == "gearfe"} | {path.name for path in (ROOT / "gearfe").iterdir()}
    assert not modules & set(gearfe.__all__)


def test_no_import_cycle():
    names = {name_of(p) for p in FILES}
    graph = {name_of(p): {m for m in imports(p, everywhere=False) if m in names} - {name_of(p)} for p in FILES}
    done = set()

    def visit(node, trail):
        assert node not in trail, f"import cycle: {' -> '.join([*trail, node])}"
        if node not in done:
            for other in graph[node]:
                if not node.startswith(f"{other}."):  # a package is the start of its own modules
                    visit(other, [*trail, node])
            done.add(node)

    for node in graph:
        visit(node, [])


def test_command_line_starts_without_heavy_imports():
    heavy = "{'numpy', 'scipy', 'skfem', 'gmsh', 'pyvista', 'matplotlib'}"
    code = f"import sys, gearfe.cli; print(sorted({heavy} & set(sys.modules)))"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.strip() == "[]"

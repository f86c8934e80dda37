"""The order of the rooms: imports, those inside functions too, point down only; heavy libraries stay where they belong."""

import ast
import subprocess
import sys
from functools import cache

import pytest
from conftest import ROOT

import gearfe
from gearfe.stiffness.methods import ROWS

pytestmark = pytest.mark.quick

FLOORS = (  # from the ground: a package imports only from floors below its own
    ("geometry/checks.py", "geometry/kept.py"),
    ("geometry/tooth",),
    ("geometry/damage",),
    ("geometry/pair", "geometry/mesh"),
    ("gearfe/core",),
    ("gearfe/flexibility", "gearfe/signal", "gearfe/scene"),
    ("gearfe/contact", "gearfe/decks"),
    ("gearfe/figures",),
    ("gearfe/stiffness",),
    ("gearfe/dynamics", "gearfe/strength"),
    ("gearfe/planetary_sets",),
    ("gearfe/comparison",),
    ("gearfe/runs",),
    ("gearfe/reports",),
    ("gearfe/app",),
    ("validation",),
)
FLOOR = {room: number for number, rooms in enumerate(FLOORS) for room in rooms}
FACES = (
    "geometry/__init__.py",
    "gearfe/__init__.py",
    "gearfe/__main__.py",
    "gearfe/scene/scenes/__init__.py",
)  # stand in no room
HOME = {  # where heavy libraries may be imported
    "gmsh": "geometry/mesh/",
    "pyvista": "gearfe/strength/",
    "vtk": "gearfe/strength/",
    "matplotlib": "gearfe/figures/",
    "starlette": "gearfe/app/",
    "uvicorn": "gearfe/app/",
}
LOADERS = ("import_module", "__import__")  # only the public face, `gearfe/__init__.py`, and the table of methods load by name
TABLE = "gearfe/stiffness/methods.py"
PACKAGES = ("geometry", "gearfe")
SITE = ROOT / "gearfe" / "docs"  # scripts of the documentation, no part of the package
FILES = {
    str(path.relative_to(ROOT)): path
    for top in (*PACKAGES, "validation")
    for path in sorted(ROOT.glob(f"{top}/**/*.py"))
    if SITE not in path.parents
}
SHIPPED = [name for name in FILES if name.startswith(PACKAGES)]


def room_of(name):
    """Room a file stands in: the folder, or the file itself, that `FLOORS` names; None for the faces of the packages."""
    if name in FACES:
        return None
    found = [room for room in FLOOR if name == room or name.startswith(f"{room}/")]
    assert found, f"{name} stands in no room: give it one, or name its room and floor in FLOORS"
    return found[0]


@cache
def asked(name, *, types=False):
    """Absolute names of all modules a file imports, at its top or inside its functions, with their lines.

    Imports under ``if TYPE_CHECKING:``, which name types and are never executed, are among them with `types`.
    """
    return tuple(_asked(name, types))


def _asked(name, types):
    package = FILES[name].relative_to(ROOT).parent.parts
    package = ("gearfe", *package) if package[0] == "geometry" else package  # where it is imported
    tree = ast.parse(FILES[name].read_text(encoding="utf-8"))
    if not types:
        tree.body = [node for node in tree.body if not (isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING")]
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from ((node.lineno, alias.name) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            above = package[: len(package) - node.level + 1] if node.level else ()
            base = ".".join((*above, *filter(None, [node.module])))
            yield node.lineno, base
            yield from ((node.lineno, f"{base}.{alias.name}") for alias in node.names)
        elif isinstance(node, ast.Call) and getattr(node.func, "attr", getattr(node.func, "id", "")) in LOADERS:
            if name == TABLE:
                yield from ((node.lineno, row.home.partition(":")[0]) for row in ROWS)
            seen = name in ("gearfe/__init__.py", TABLE) or name not in SHIPPED
            assert seen, f"{name}, line {node.lineno}: write an import as such, so that it is seen here"


def imported(name, *, types=False):
    """Files that a file imports, with the lines."""
    for line, module in asked(name, types=types):
        path = (
            module.removeprefix("gearfe.").replace(".", "/") if module.startswith("gearfe.geometry") else module.replace(".", "/")
        )
        other = f"{path}.py" if f"{path}.py" in FILES else f"{path}/__init__.py"
        if other in FILES and other != name:
            yield line, other


@pytest.mark.parametrize("name", FILES)
def test_imports_point_down(name):
    own = room_of(name)
    for line, other in imported(name):
        room = room_of(other)
        if own is None or room in (None, own):
            continue
        assert FLOOR[room] < FLOOR[own], (
            f"{name}, line {line}, imports {other}: {own} stands on floor {FLOOR[own]} and {room} on floor {FLOOR[room]}, "
            "but a room imports only from floors below its own; move what both need down"
        )


@pytest.mark.parametrize("name", SHIPPED)
def test_nothing_inside_imports_the_public_face(name):
    """`import gearfe` is for users: inside it would reach every room, upwards too."""
    if name not in FACES:
        top = [line for line, module in asked(name) if module == "gearfe"]
        assert not top, f"{name}, lines {top}, imports gearfe itself: import from the room"


@pytest.mark.parametrize("name", SHIPPED)
def test_heavy_libraries_stay_home(name):
    for line, module in asked(name):
        home = HOME.get(module.split(".")[0])
        assert home is None or name.startswith(home), f"{name}, line {line}, imports {module}: only {home} does"


def test_geometry_never_imports_gearfe():
    for name in SHIPPED:
        if name.startswith("geometry/"):
            own = [module for _, module in asked(name) if module.split(".")[0] == "gearfe"]
            assert all(module.startswith("gearfe.geometry") for module in own), name


def test_no_import_cycle():
    """No file is needed to read itself, not even for its types."""
    graph = {name: sorted({other for _, other in imported(name, types=True)}) for name in FILES}
    done = set()

    def visit(node, trail):
        assert node not in trail, f"import cycle: {' -> '.join([*trail[trail.index(node) :], node])}"
        if node not in done:
            for other in graph[node]:
                if not (other.endswith("/__init__.py") and node.startswith(other.removesuffix("__init__.py"))):
                    visit(other, [*trail, node])
            done.add(node)

    for node in graph:
        visit(node, [])


def test_every_room_says_what_is_in_it():
    rooms = [name for name in FILES if name.endswith("__init__.py")]
    assert len(rooms) > len(PACKAGES)
    for name in rooms:
        assert ast.get_docstring(ast.parse(FILES[name].read_text(encoding="utf-8"))), f"{name} has no docstring"


def test_no_public_name_is_that_of_a_module():
    """Importing a module binds its name in the package, over a function of the same name."""
    modules = {path.stem for path in (ROOT / "gearfe").iterdir()}
    assert not modules & set(gearfe.__all__)


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

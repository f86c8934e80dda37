"""Stiffness, tables and dynamics where VTK cannot be loaded; verbs that draw say what is missing."""

import json
import re
import subprocess
import sys

import pytest

CODE = """
import contextlib, io, json, sys

class Missing:
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] in ("vtk", "vtkmodules", "pyvista"):
            raise ImportError(f"libGL.so.1: cannot open shared object file (asked for {name})")

sys.meta_path.insert(0, Missing())
import gearfe
from gearfe.app.cli import main
done = []
for line in sys.argv[1:]:
    out, error = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(error):
        code = main(line.split())
    done.append((code, out.getvalue(), error.getvalue()))
print(json.dumps([done, callable(gearfe.compare)]))
"""
LINES = {
    "compare": "compare planetary_pitting --phases 4 --refine 0.4 --plot k.png",
    "dynamics": "dynamics planetary_pitting --duration 0.2",
    "render": "render planetary_pitting -o s.png",
}


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    """Exit code, output and errors by verb, all in one process; its folder; whether `gearfe.compare` is still the function."""
    folder = tmp_path_factory.mktemp("drawn")
    command = [sys.executable, "-c", CODE, *LINES.values()]
    said = subprocess.run(command, capture_output=True, text=True, check=True, cwd=folder).stdout
    found, whole = json.loads(said)
    return dict(zip(LINES, found, strict=True)) | {"folder": folder, "whole": whole}


@pytest.mark.slow
def test_tables_and_pictures_of_curves_need_no_vtk(done):
    code, out, error = done["compare"]
    assert code == 0, error
    assert re.search(r"^\| mean +\|", out, re.MULTILINE)
    assert (done["folder"] / "k.png").is_file()


def test_dynamics_needs_no_vtk(done):
    code, _, error = done["dynamics"]
    assert code == 0, error


def test_render_says_what_is_missing(done):
    code, _, error = done["render"]
    assert code == 1
    assert "pip install pyvista" in error
    assert "apt-get install" in error
    assert "Traceback" not in error


def test_the_command_leaves_the_function_compare_to_the_package(done):
    assert done["whole"]

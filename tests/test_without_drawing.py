"""Stiffness, tables and dynamics where VTK cannot be loaded; verbs that draw say what is missing."""

import re
import subprocess
import sys

CODE = """
import sys

class Missing:
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] in ("vtk", "vtkmodules", "pyvista"):
            raise ImportError(f"libGL.so.1: cannot open shared object file (asked for {name})")

sys.meta_path.insert(0, Missing())
from gearfe.cli import main
sys.exit(main(sys.argv[1:]))
"""


def run(*words):
    return subprocess.run([sys.executable, "-c", CODE, *words], capture_output=True, text=True)


def test_tables_and_pictures_of_curves_need_no_vtk(tmp_path):
    done = run("compare", "planetary_pitting", "--phases", "8", "--plot", str(tmp_path / "k.png"))
    assert done.returncode == 0, done.stderr
    assert re.search(r"^\| mean +\|", done.stdout, re.MULTILINE)
    assert (tmp_path / "k.png").is_file()


def test_dynamics_needs_no_vtk():
    done = run("dynamics", "planetary_pitting", "--duration", "0.2")
    assert done.returncode == 0, done.stderr


def test_render_says_what_is_missing(tmp_path):
    done = run("render", "planetary_pitting", "-o", str(tmp_path / "s.png"))
    assert done.returncode == 1
    assert "pip install pyvista" in done.stderr
    assert "apt-get install" in done.stderr
    assert "Traceback" not in done.stderr

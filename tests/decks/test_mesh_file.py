"""Meshes for other programs: read back, volumes and faces as they should be, what cannot be meshed refused."""

import math
import shutil
import subprocess

import meshio
import numpy as np
import pytest
from scipy.sparse import csc_array, tril
from scipy.sparse.linalg import spsolve

import gearfe as gf
from gearfe.app.cli import main
from gearfe.decks.pressed import read_rows
from gearfe.flexibility.finite_elements.hexahedron import TWENTY
from gearfe.flexibility.finite_elements.solid_assembly import assemble
from gearfe.geometry.mesh.holes import holed_sector

pytestmark = pytest.mark.quick

needs_ccx = pytest.mark.skipif(
    shutil.which("ccx") is None, reason="CalculiX (ccx) is not installed: apt-get install calculix-ccx"
)
GEAR = gf.Gear(z=13, x=0.3, r_bore=8.0, b=6.0, m_n=2.0, alpha_n=math.radians(20), beta=math.radians(15))
PIT = gf.Pit(radius=14.0, z=2.0, axes=(0.4, 0.4), depth=0.2)


def volume(points, cells):
    """Of straight tets [mm**3]."""
    a, b, c, d = points[cells[:, :4]].transpose(1, 0, 2)
    return np.einsum("im,im->i", np.cross(b - a, c - a), d - a) / 6


@pytest.mark.parametrize("suffix", [".msh", ".vtu", ".inp"])
def test_a_cracked_gear_is_read_back(tmp_path, suffix):
    crack = gf.Crack(level=0.5, width=(0.0, 3.0))
    path = tmp_path / f"gear{suffix}"
    made = gf.export_mesh(path, GEAR, [crack], refine=0.4)
    found = meshio.read(path)
    assert [block.type for block in found.cells] == ["hexahedron20"]
    np.testing.assert_array_equal(found.cells[0].data, made.cells.T)
    np.testing.assert_allclose(found.points, made.points.T, atol=1e-12)
    marks = {name: np.flatnonzero(values) for name, values in found.point_data.items()}
    sets = {name.lower(): nodes for name, nodes in found.point_sets.items()} if suffix == ".inp" else marks
    body, tooth = (np.sort(sets[f"crack_0_{side}"]) for side in ("body", "tooth"))
    front = np.intersect1d(body, tooth)
    assert 0 < front.size < body.size  # the faces share their front and nothing else
    assert found.points[tooth, 2].max() <= 3.0 + 1e-9
    np.testing.assert_allclose(np.hypot(*found.points[sets["held"], :2].T), 8.0, rtol=1e-12)


LOADED = """*INCLUDE, INPUT=gear.inp
*MATERIAL, NAME=STEEL
*ELASTIC
207000., 0.3
*SOLID SECTION, ELSET=GEAR, MATERIAL=STEEL
*BOUNDARY
HELD, 1, 3
*STEP
*STATIC
*CLOAD
FLANK_0, 1, -1.
FLANK_0, 3, 0.5
*NODE PRINT, NSET=ALL
U
*END STEP
"""


def displaced(part, order):
    """Displacements ``(nodes, 3)`` by gearfe's matrices under the nodal forces of `LOADED`."""
    free = np.setdiff1d(np.arange(part.points.shape[1]), part.held)
    cells = part.cells[np.argsort(TWENTY)] if len(part.cells) == 20 else part.cells
    lower = assemble(part.points, cells, gf.Material(E=207e3, nu=0.3), free, order=order)
    force = np.zeros((part.points.shape[1], 3))
    force[np.unique(part.faces["flank 0"])] = -1.0, 0.0, 0.5
    moved = np.zeros_like(force)
    moved[free] = spsolve(csc_array(lower + tril(lower, -1).T), force[free].ravel()).reshape(-1, 3)
    return moved


@needs_ccx
@pytest.mark.parametrize(
    ("damage", "options", "order"),  # degree of the quadrature: 2 x 2 x 2 points in C3D20R, 4 in C3D10
    [
        pytest.param([gf.Crack(level=0.5, width=(0.0, 3.0))], {"refine": 0.4}, 3, marks=pytest.mark.slow),
        ([PIT], {"teeth": 1, "refine": 0.5}, 2),
    ],
    ids=["hexahedra", "tetrahedra"],
)
def test_calculix_solves_the_mesh(tmp_path, damage, options, order):
    """The two sides share nodes and elements, and nothing of how they are read, integrated and solved."""
    part = gf.export_mesh(tmp_path / "gear.inp", GEAR, damage, **options)
    (tmp_path / "load.inp").write_text(LOADED, encoding="ascii")
    done = subprocess.run(["ccx", "-i", "load"], cwd=tmp_path, capture_output=True, text=True, timeout=300, check=False)
    assert "ERROR" not in done.stdout, done.stdout[-2000:]
    found = read_rows(tmp_path / "load.dat")
    moved = np.array([found[node] for node in range(1, part.points.shape[1] + 1)])
    own = displaced(part, order)
    np.testing.assert_allclose(moved, own, rtol=0, atol=1e-6 * np.abs(own).max())


def test_a_pit_is_missing_from_the_tooth(tmp_path):
    part = gf.export_mesh(tmp_path / "t.vtu", GEAR, [PIT], teeth=1)
    plugged = holed_sector(GEAR, (PIT,), teeth=1)
    sizes = volume(part.points.T, part.cells.T)
    assert sizes.min() > 0
    lost = volume(plugged.points.T, plugged.cells.T).sum() - sizes.sum()  # straight edges, but for the flank's middles
    assert abs(lost / (math.pi * 0.4**2 * 0.2) - 1) < 0.15  # its rim is a polygon
    assert "pits" in meshio.read(tmp_path / "t.vtu").point_data


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"damage": [PIT], "cells": "hexahedra"}, "damage has pits, but only meshes of tetrahedra can have pits"),
        ({"damage": [PIT, gf.Crack(level=0.3, width=(0.0, 3.0))]}, "at most one crack"),
        ({"cells": "hexahedra", "teeth": 3}, "teeth = 3"),
        ({"cells": "wedges"}, "one of tetrahedra, hexahedra"),
        ({"teeth": 2}, "odd number"),
    ],
)
def test_what_cannot_be_meshed_is_refused(tmp_path, options, message):
    with pytest.raises(ValueError, match=message):
        gf.export_mesh(tmp_path / "t.msh", GEAR, **options)
    with pytest.raises(ValueError, match="no format"):
        gf.export_mesh(tmp_path / "t.stl", GEAR)


def test_the_verb_writes_the_cracked_gear(tmp_path, capsys):
    assert main(["mesh", "compound_planetary", "--case", "crack50", "--refine", "0.4", "-o", str(tmp_path / "g.msh")]) == 0
    assert "nodes" in capsys.readouterr().out
    assert (tmp_path / "g.msh").exists()


def test_a_close_up_needs_its_damage(tmp_path):
    part = gf.export_mesh(tmp_path / "t.vtu", GEAR, teeth=1)
    with pytest.raises(ValueError, match="have no damage to show"):
        gf.render_mesh(part, tmp_path / "t.png", close_up="pits")
    with pytest.raises(ValueError, match="'crack' or 'pits'"):
        gf.render_mesh(part, tmp_path / "t.png", close_up="tip")


@pytest.mark.slow
@pytest.mark.parametrize(("ring", "side"), [(False, "unloaded"), (True, "loaded"), (True, "unloaded")])
def test_a_close_up_looks_into_pits_wherever_they_are(tmp_path, ring, side):
    """The camera once stood where the loaded flank of an external gear is: elsewhere it saw the next tooth, or the rim."""
    from matplotlib.image import imread

    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 4.0}
    gear = gf.Gear(z=40, r_rim=48.0, rack_tip_radius=0.3, **rack) if ring else gf.Gear(z=18, r_bore=10.0, **rack)
    pit = gf.Pit(radius=gear.r, z=2.0, axes=(0.4, 0.8), depth=0.15, side=side)
    part = gf.export_mesh(tmp_path / "t.vtu", gear, [pit], teeth=3, refine=0.5)
    gf.render_mesh(part, tmp_path / "t.png", close_up="pits", size=(200, 150))
    picture = imread(tmp_path / "t.png")[..., :3]
    assert (picture[..., 0] > picture[..., 2] + 0.2).mean() > 0.02  # orange


def test_a_close_up_shows_the_crack(tmp_path):
    from matplotlib.image import imread

    part = gf.export_mesh(tmp_path / "t.vtu", GEAR, [PIT, gf.Crack(level=0.5)], teeth=3, refine=0.6)
    gf.render_mesh(part, tmp_path / "t.png", close_up="crack", size=(400, 300))
    picture = imread(tmp_path / "t.png")[..., :3]
    orange = (picture[..., 0] > picture[..., 2] + 0.4).mean()
    print(f"crack: {100 * orange:.2f} % orange")
    assert orange > 0.002
    assert (picture.min(axis=2) < 0.9).mean() > 0.05


@pytest.mark.parametrize("cells", ["hexahedra", "tetrahedra"])
def test_a_mesh_above_the_free_memory_is_rejected_before_it_is_made(cells, tmp_path, monkeypatch):
    monkeypatch.setattr("gearfe.core.memory.free_memory", lambda: 1e10)
    gear = gf.Gear(z=21, m_n=2.0, alpha_n=math.radians(20), b=20.0, r_bore=7.4)
    with pytest.raises(ValueError, match=r"refine = 50: a mesh of .* nodes needs about .* GB, but 10 GB are free"):
        gf.export_mesh(tmp_path / "x.msh", gear, cells=cells, refine=50.0)

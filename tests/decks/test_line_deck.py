"""CalculiX solves the deck of a line load: the same elements, quadrature and nodal forces, another program."""

import math
import shutil
import subprocess

import numpy as np
import pytest
from scipy.sparse import csc_array, tril
from scipy.sparse.linalg import spsolve

import gearfe as gf
from gearfe.decks.pressed import read_rows
from gearfe.flexibility.finite_elements.hexahedron import TWENTY
from gearfe.flexibility.finite_elements.solid_assembly import assemble

STEEL = gf.Material(E=207e3, nu=0.3)
GEAR = gf.Gear(z=10, x=0.4, m_n=2.0, alpha_n=math.radians(20), beta=0.2, b=2.0, r_bore=6.0)


@pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX (ccx) is not installed: apt-get install calculix-ccx")
@pytest.mark.slow
@pytest.mark.parametrize("cracks", [(), (gf.Crack(level=0.4),)], ids=["healthy", "cracked"])
def test_calculix_gives_the_same_displacements(cracks, tmp_path):
    deck = gf.write_line_inp(tmp_path / "line.inp", GEAR, GEAR.r + 0.4, 100.0, STEEL, cracks=cracks, refine=0.35, layer=1.0)
    done = subprocess.run(["ccx", "-i", "line"], cwd=tmp_path, capture_output=True, text=True, timeout=300, check=False)
    assert "ERROR" not in done.stdout, done.stdout[-2000:]
    found = read_rows(tmp_path / "line.dat")
    part = deck.part
    free = np.setdiff1d(np.arange(part.points.shape[1]), part.held)
    lower = assemble(part.points, part.cells[np.argsort(TWENTY)], STEEL, free, order=3)  # C3D20R: 2 x 2 x 2 points
    own = np.zeros_like(deck.load)
    own[free] = spsolve(csc_array(lower + tril(lower, -1).T), deck.load[free].ravel()).reshape(-1, 3)
    moved = np.array([found[node] for node in range(1, own.shape[0] + 1)])
    np.testing.assert_allclose(moved, own, rtol=0, atol=1e-6 * np.abs(own).max())
    np.testing.assert_allclose(deck.deflection(tmp_path / "line.dat"), (own * deck.load).sum() / deck.force, rtol=1e-6)

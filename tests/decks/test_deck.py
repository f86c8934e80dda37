"""CalculiX on the same mesh and loads: a second solver's displacements."""

import shutil
import subprocess

import numpy as np
import pytest
from usual import RACK, STEEL

import gearfe as gf
from gearfe.flexibility.finite_elements.elasticity import HeldSection

CASES = {
    "healthy": (gf.Gear(z=21, r_bore=7.4, **RACK), 21.5, ()),
    "cracked": (gf.Gear(z=21, r_bore=7.4, **RACK), 21.5, (gf.Crack(level=0.4),)),
}


def run(folder, name):
    """Run CalculiX on one thread."""
    quiet = {"cwd": folder, "capture_output": True, "text": True, "timeout": 300, "check": False}
    return subprocess.run(["ccx", "-i", name], **quiet)


def displacements(folder, name, count):
    done = run(folder, name)
    data = (folder / f"{name}.dat").read_text().splitlines() if (folder / f"{name}.dat").exists() else []
    rows = [line.split() for line in data]
    rows = [r for r in rows if len(r) == 4 and r[0].isdigit()]
    assert len(rows) == count, done.stdout[-500:]
    out = np.zeros((count, 2))
    for node, x, y, _ in rows:
        out[int(node) - 1] = float(x), float(y)
    return out


needs_ccx = pytest.mark.skipif(
    shutil.which("ccx") is None, reason="CalculiX (ccx) is not installed: apt-get install calculix-ccx"
)


@needs_ccx
@pytest.mark.parametrize("name", list(CASES))
def test_calculix_gives_the_same_displacements(name, tmp_path):
    gear, radius, cracks = CASES[name]
    body, load = gf.write_inp(tmp_path / f"{name}.inp", gear, radius, 100.0, STEEL, cracks=cracks, refine=0.6)
    # CalculiX integrates a triangle at three points; so does this body
    same = HeldSection(body.mesh, STEEL, order=2)
    ours = same.solve(load)[:, 0].reshape(-1, 2)
    theirs = displacements(tmp_path, name, ours.shape[0])
    assert np.abs(ours - theirs).max() < 1e-6 * np.abs(ours).max()


def test_deck_is_complete(tmp_path):
    gear, radius, cracks = CASES["cracked"]
    path = tmp_path / "gear.inp"
    body, _ = gf.write_inp(path, gear, radius, 100.0, STEEL, cracks=cracks, refine=0.6)
    text = path.read_text()
    assert text.count("\n") > body.mesh.doflocs.shape[1] + body.nodes.shape[1]
    pushed = [line.split(", ") for line in text.split("*CLOAD\n")[1].split("*NODE PRINT")[0].splitlines()]
    total = np.array([sum(float(v) for _, d, v in pushed if d == k) for k in ("1", "2")])
    assert abs(np.hypot(*total) - 100) < 0.1
    with pytest.raises(ValueError, match=r"use one of \.inp"):
        gf.write_inp(tmp_path / "gear.txt", gear, radius, 100.0, STEEL)

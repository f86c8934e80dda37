"""The recipe of `gearfe.machine.contact_law`: a new law is one file and one row, seen to run in a copy of the library."""

import json
import math
import os
import shutil
import subprocess
import sys

from conftest import ROOT
from numpy.testing import assert_allclose
from scipy.optimize import brentq

LAW = '''
"""H. M. Lankarani, P. E. Nikravesh, J. Mech. Des. 112 (1990) 369-376, eq. 21: damping from the coefficient of restitution."""

from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class Lankarani:
    restitution: float
    speed: float
    power: float = 1.5
    straight: bool = field(default=False, init=False)

    @staticmethod
    def force(depth, rate, k, c, law):
        return k * depth**law.power * (1 + 3 * (1 - law.restitution**2) / (4 * law.speed) * rate) + c * rate

    @staticmethod
    def slopes(depth, rate, k, c, law):
        loss = 3 * (1 - law.restitution**2) / (4 * law.speed)
        return k * law.power * depth ** (law.power - 1) * (1 + loss * rate), k * depth**law.power * loss + c
'''
RUN = """
import json
from dataclasses import replace
import numpy as np
import gearfe as gf
from gearfe.machine.laws.lankarani import Lankarani
from machines import WAVE, two_masses

hit = gf.single_mesh(1.0, 1e9, 0.0, force=1e-3, backlash=np.inf, film=0.0, law=Lankarani(0.95, 0.1))
start = [-1e-6], [0.1]
own = {"law": Lankarani(0.8, 0.05, power=1.4), "backlash": 6e-5, "error": ((60e-6, 1500.0, 0.3),), "zeta": 0.0, "damping": 50.0}
mixed = two_masses(stiffness=5e9 / WAVE.mean() * WAVE, film=0.3, **own)
mixed = replace(mixed, meshes=(*mixed.meshes, gf.GearMesh("spring", np.array([0.5, 1.0]), 1e8 + 0 * WAVE, 500.0, zeta=0.02)))
told = {"left": []}
for method in ("fast", "DOP853"):
    run = gf.simulate(hit, 1.5e-3, rate=1e5, method=method, initial=start, filtered=False, rtol=1e-10)
    told["left"].append(float(-run.v[-1, 0] / 0.1))
runs = [gf.simulate(mixed, 0.01, rate=5e4, filtered=False, rtol=1e-10, **how) for how in ({"step": 1e-6}, {"method": "DOP853"})]
told["lost"] = [run.stats["losses"] for run in runs]
pairs = [[run.q for run in runs], [run.mesh() for run in runs]]
told["apart"] = [float((abs(one - two).max(0) / np.ptp(two, 0)).max()) for one, two in pairs]
print(json.dumps(told))
"""


def test_a_new_law_is_one_file_and_one_row(tmp_path):
    """Both integrators agree on it, also beside a mesh of another law; a mass that strikes it returns as the closed form says."""
    for name in ("gearfe", "geometry"):
        shutil.copytree(ROOT / name, tmp_path / name, ignore=shutil.ignore_patterns("docs"))  # what was compiled comes along
    (tmp_path / "gearfe/machine/laws/lankarani.py").write_text(LAW)
    table = tmp_path / "gearfe/machine/contact_law.py"
    text = table.read_text()
    assert text.count("(Spring, Hertz, Impact)") == 1
    text = text.replace("(Spring, Hertz, Impact)", "(Spring, Hertz, Impact, Lankarani)")
    table.write_text(text.replace("from .laws.spring", "from .laws.lankarani import Lankarani\nfrom .laws.spring"))
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(tmp_path), str(ROOT / "tests")])}
    environment.pop("NUMBA_CACHE_DIR", None)
    command = [sys.executable, "-W", "ignore", "-c", RUN]
    done = subprocess.run(command, capture_output=True, text=True, env=environment, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout)
    assert min(told["lost"]) > 3
    assert max(told["apart"]) < 1e-5
    loss = 3 * (1 - 0.95**2) / 4  # times the speed: with v' = -force, v dv / (1 + loss v) is the same on the way in and out

    def spent(v):
        return v / loss - math.log(1 + loss * v) / loss**2

    assert_allclose(told["left"], brentq(lambda v: spent(-v) - spent(1.0), 0.5, 1.0), rtol=1e-4)

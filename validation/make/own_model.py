"""An example of a stiffness curve as MATLAB's ``writetable`` leaves it: 15 digits, CRLF, the unit in the variable name."""

from pathlib import Path

import numpy as np

import gearfe as gf
from gearfe.core.files import written

from ..shared.places import PAGES

EXAMPLE = PAGES / "matlab_curve.csv"
ROWS = 128


def table():
    """Return the example's text: the textbook's total stiffness of the first pair of `planetary_pitting`."""
    chosen = gf.load_scene("planetary_pitting").pair()
    phase = np.arange(ROWS) / ROWS
    curve = gf.mesh_stiffness(chosen.pair, chosen.force, chosen.materials, method="textbook", phases=phase)
    rows = [f"{x:.15g},{k:.15g}" for x, k in zip(phase, curve.k, strict=True)]
    return "\r\n".join(["phase,k_N_per_m", *rows, ""])


def run(again=True):
    """Write the example again."""
    with written(EXAMPLE) as name:
        Path(name).write_bytes(table().encode())
    print(f"{EXAMPLE.name} remade")

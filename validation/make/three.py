"""Three dimensions: the energy model against brute-force hexahedra of the whole gear, patch by patch."""

import math
import time
import warnings
from pathlib import Path

import numpy as np

import gearfe as gf
from gearfe.elements import fe3d
from gearfe.energy.ritz import solid as ritz3d
from gearfe.energy.ritz.join import join
from gearfe.files import written
from gearfe.flexibility import solid as flexibility3d

from ..shared import machine
from ..shared.places import PAGES

PAGE = PAGES / "three.md"
STEEL = gf.Material(E=207e3, nu=0.3)
REFINES = (0.7, 1.0, 1.4)


def cases():
    """(name, gear, cracks) of every comparison."""
    rack = {"m_n": 2.0, "alpha_n": math.radians(20)}
    crack = (gf.Crack(level=0.3),)
    yield "z 18, spur, b/m 5", gf.Gear(z=18, r_bore=9.0, b=10.0, **rack), ()
    yield "z 18, 16 degrees, b/m 6", gf.Gear(z=18, r_bore=9.0, b=12.0, beta=math.radians(16), **rack), ()
    yield "z 18, 16 degrees, b/m 6, 30 % crack", gf.Gear(z=18, r_bore=9.0, b=12.0, beta=math.radians(16), **rack), crack
    yield "z 12, 30 degrees, b/m 5", gf.Gear(z=12, r_bore=6.0, b=10.0, beta=math.radians(30), **rack), ()
    yield "z 27, -16 degrees, b/m 10", gf.Gear(z=27, r_bore=14.0, b=20.0, beta=-math.radians(16), **rack), ()
    ring = {"r_rim": 52.0, "b": 10.0, "beta": math.radians(10), "tip_radius": 0.2, "addendum": 0.8}
    yield "ring z 40, 10 degrees, b/m 5", gf.Gear(z=40, **ring, **rack), ()


def both(gear, cracks):
    """Line-load flexibilities [mm per N] of the model and of the hexahedra by refinement, and what they cost.

    Returns
    -------
    model, reference : ndarray (hats,), ndarray (refinements, hats)
        Mean displacement of a hat under a uniform line load of 1 N on the same hat.
    coupling : (ndarray, ndarray)
        Of the next tooth, the latter of the finest mesh.
    """
    started = time.perf_counter()
    width, axial = gear.b, ritz3d.axial_degree(gear.b, gear.m_n)
    panels = [ritz3d.solid_sector(gear, STEEL, own, width=width, order=3, axial=axial, refine=1.0) for own in (cracks, ())]
    influence, _ = join(gear, {0: panels[0], 1: panels[1]}, panels[1])
    knots = flexibility3d.hats(gear)
    whole = np.flatnonzero(np.isclose(np.diff(knots, axis=0), flexibility3d.HAT * gear.m_n, rtol=1e-9).all(axis=0))  # not cut off
    at = whole * (axial + 1)
    model, next_tooth = (np.diag(influence[0, k][np.ix_(at, at)]) / width for k in (0, 1))
    seconds = [time.perf_counter() - started]
    patches = fe3d.Patches((0, 1), knots[:, whole], 1)
    values, dofs, coupling = [], [], None
    for refine in REFINES:
        started = time.perf_counter()
        mesh = fe3d.mesh_patches(gear, patches, cracks=cracks, refine=refine)
        found = fe3d.influence(mesh, STEEL, patches)
        seconds.append(time.perf_counter() - started)
        values.append(np.diag(found.matrix[0, :, 0, 0, :, 0]))
        coupling = np.diag(found.matrix[0, :, 0, 1, :, 0])
        dofs.append(found.dofs)
    return model, np.array(values), (next_tooth, coupling), dofs, seconds


def run():
    """Write `three.md` and print it."""
    lines = [
        "# Three dimensions: energy model against hexahedra",
        "",
        f"Made by `python -m validation three` on {machine.describe()}.",
        "Mean displacement of a hat of pressure (0.4 m_n to either side, uniform over the width) under the same hat of 1 N, at",
        "places along the flank: `ritz3d` (cubic, default degree) against 20-node hexahedra of the whole gear on three meshes.",
        "Difference: of the finest; last step: how far the hexahedra still moved there; next tooth: its displacement under the",
        "same load.",
        "",
        "| gear | unknowns of the meshes | difference, each hat | last step | next tooth | seconds, model / finest mesh |",
        "|---|---|---|---|---|---|",
    ]
    for name, gear, cracks in cases():
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)
            model, values, coupling, dofs, seconds = both(gear, cracks)
        away = ", ".join(f"{100 * v:+.2f}" for v in model / values[-1] - 1)
        step = 100 * np.abs(values[-1] / values[-2] - 1).max()
        other = 100 * np.abs(coupling[0] / coupling[1] - 1).max()
        sizes = " / ".join(f"{d:,}" for d in dofs)
        row = f"| {name} | {sizes} | {away} % | {step:.2f} % | {other:.2f} % | {seconds[0]:.1f} / {seconds[-1]:.0f} |"
        lines.append(row)
        print(row, flush=True)
    with written(PAGE) as name:
        Path(name).write_text("\n".join(lines) + "\n", encoding="utf-8")

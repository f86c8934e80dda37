"""Line load on the flank of tooth 0 of a gear in hexahedra, and the displacements."""

import math

import numpy as np

from ...core.checks import check_length
from ...geometry.mesh.solid import Solid
from ...geometry.tooth.profile import arc_at, roll_at_arc
from .fe3d import helicoid_normal, points_between
from .hexahedron import face_shapes
from .one_tooth import load_at
from .solid_assembly import assemble
from .solver import factor, plan

SPREAD = 0.15  # half width of the hat function over which a load is spread [m_n]
ACROSS, ALONG = 8, 4  # Gauss points of the load on an edge and along a layer


def check_spread(gear, half_width=None):
    """Return the half-width of the loaded strip [mm], by default `SPREAD` modules. ValueError if it is invalid."""
    check_length("half_width", half_width)
    spread = SPREAD * gear.m_n if half_width is None else half_width
    if not 0 < spread <= gear.m_n:
        raise ValueError(f"half_width = {half_width} mm, but the loaded strip is narrow: give 0 < half_width <= {gear.m_n} mm")
    return spread


def contact_line(gear, radius):
    """Return the function from height z [mm] to roll length of the contact line through `radius` [mm] at half the width."""
    middle, slope = float(roll_at_arc(gear, load_at(gear, radius))), gear.outward * math.tan(gear.beta_b)
    return lambda z: middle + slope * (z - gear.b / 2)


def strip(gear, roll, spread, refine):
    """Return the strip of the flank that is meshed finer for a line load: first arc, last arc, edge length [mm]."""
    least, most = gear.flank_rolls
    arcs = arc_at(gear, np.clip(roll(np.linspace(0.0, gear.b, 65)), least, most))
    return arcs.min() - spread, arcs.max() + spread, spread / 2 / refine


def under_line(mesh, roll, line_load, material, spread):
    """Displacements ``(nodes, 3)`` [mm] under `line_forces`, and the number of unknowns.

    Raises RuntimeError with the memory needed if the system does not fit, before it is assembled.
    """
    load = line_forces(mesh, roll, line_load, spread)
    free = np.setdiff1d(np.arange(mesh.points.shape[1]), mesh.held)
    rows = (3 * free[:, None] + np.arange(3)).ravel()
    cost, moved = plan(rows.size), np.zeros(load.size)  # The assembly takes memory too, so the plan comes first.
    try:
        moved[rows] = factor(assemble(mesh.points, mesh.cells, material, free), cost)(load[rows, None])[:, 0]
    except MemoryError as error:  # The plan excludes address space that is reserved and unused.
        raise RuntimeError(
            f"{cost} were expected, but memory ran out: raise the limit of memory (`ulimit -v`), or give a smaller refine"
        ) from error
    return moved.reshape(-1, 3), rows.size


def line_forces(mesh: Solid, roll, line_load, spread):
    """Nodal forces ``(3 nodes,)`` [N] of a line load on tooth 0 at roll lengths ``roll(z)``, 0 where it is off the flank.

    `line_load` is a number or a function of z [N/mm].
    """
    gear = mesh.gear
    edge, x, at, across = points_between(gear.outward * mesh.section.roll[0], (), ACROSS)
    layer, y, z, along = points_between(mesh.levels, (), ALONG)
    at, centre = gear.outward * at, roll(z)
    low, high = gear.flank_rolls
    on = (centre >= low) & (centre <= high)
    away = np.abs(arc_at(gear, at)[:, None] - arc_at(gear, np.clip(centre, low, high)))
    hat = np.maximum(1 - away / spread, 0.0) * (across * at / gear.r_b)[:, None]
    press = (line_load(z) if callable(line_load) else line_load) * along * on * hat / hat.sum(axis=0)
    value, nodes = face_shapes(x[:, None], y[None, :]), mesh.flank(0)[:, edge[:, None], layer[None, :]]
    force = np.zeros((mesh.points.shape[1], 3))
    np.add.at(force, nodes, -np.einsum("nsz,dsz->nszd", value * press, helicoid_normal(gear, at, z)))
    return force.ravel()

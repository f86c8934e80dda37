"""Checks, positions and nodal forces for functions of one gear with one loaded tooth."""

import math

import numpy as np

from ...core.cost import Cost, check_cost
from ...geometry.mesh.outline import stations
from ...geometry.mesh.section_mesh import section
from ...geometry.tooth.profile import arc_at
from .elasticity import HeldSection
from .fe import flank_load

MOST_LOAD = 0.05  # largest line load over E m_n; the largest possible stiffness b E / 5 gives an approach of m_n / 4
NARROW = 0.05  # half width of a narrow load [m_n]
BYTES, SECONDS = 1.7e7, 0.17  # memory [bytes] and time [s] of a section by ``refine**2``, measured at refine 1 and 4
SAMPLES = 65  # number of heights at which a load distribution is sampled


def check_line_load(line_load, gear, material):
    """Raise ValueError unless the line load is finite, compressive and compatible with small strains of these teeth."""
    if not 0 < line_load < math.inf:
        raise ValueError(f"line_load = {line_load!r} N/mm, but it must be finite and positive")
    most = MOST_LOAD * material.E * gear.m_n
    if line_load > most:
        raise ValueError(
            f"line_load = {line_load:g} N/mm, but under more than {most:.3g} N/mm (E m_n / {1 / MOST_LOAD:g}) a tooth bends by a "
            "quarter of the module and breaks: give a smaller one, in N/mm, lengths in mm, E in MPa"
        )


def check_load_along(line_load, gear, material):
    """Raise ValueError unless the load is a finite compression, or a function of z [mm] with such values, not all zero."""
    if not callable(line_load):
        return check_line_load(line_load, gear, material)
    z, b = np.linspace(0.0, gear.b, SAMPLES), gear.b
    try:
        values = np.asarray(line_load(z))
        load = np.broadcast_to(values, z.shape)
    except (TypeError, ValueError) as error:
        raise ValueError(f"line_load at {SAMPLES} heights z: {error}; give a function of an array of heights [mm]") from error
    if values.dtype.kind not in "iuf" or not np.isfinite(load).all() or load.min() < 0 or not load.max() > 0:
        raise ValueError(
            f"line_load from z = 0 to {b:g} mm gives {load[0]!s} to {load[-1]!s}, but loads are compressive: give numbers >= 0 "
            "[N/mm], somewhere > 0"
        )
    check_line_load(float(load.max()), gear, material)


def load_at(gear, radius):
    """Arc length from the base circle [mm] of the flank point at `radius` [mm]."""
    low, high = sorted((gear.r_form, gear.r_a))
    if not low <= radius <= high:
        raise ValueError(f"radius = {radius} mm is not on the involute flank: give {low:.6g} <= radius <= {high:.6g} mm")
    return float(arc_at(gear, math.sqrt(radius**2 - gear.r_b**2)))


def edge_lengths(gear, edges, refine):
    """Return the edge lengths [mm] of a table in modules at a resolution.

    Raises ValueError if a section with one loaded tooth at this resolution exceeds the free memory or the limit of time. Slow
    work is announced.
    """
    what, cost = f"refine = {refine:g}: a section with one loaded tooth", Cost(SECONDS * refine**2, BYTES * refine**2)
    check_cost(what, cost, "give a smaller refine")
    return {name: size * gear.m_n / refine for name, size in edges.items()}


def narrow_section(gear, material, state, edge, load, tooth=0, cracks=()):
    """Return the section of a gear meshed for a narrow load on a tooth, its `HeldSection`, and the nodal forces of a unit load.

    `edge` are its edge lengths [mm], `load` the arc [mm] of the load, its half width [mm] and the edge length there [mm].
    """
    arc, half_width, fine = load
    roll = stations(gear, edge["flank"], patches=[(arc - half_width, arc + half_width, fine)])
    mesh = section(gear, {tooth: roll}, fillet_size=edge["fillet"], size=edge["near"], far_size=edge["far"], cracks=cracks)
    return mesh, HeldSection(mesh.mesh, material, state=state), narrow_load(mesh, tooth, arc, half_width)


def narrow_load(mesh, tooth, arc, half_width):
    """Nodal forces of unit resultant, distributed as ``cos**2`` over `half_width` [mm] around `arc` [mm] on the flank."""

    def pressure(s):
        away = np.minimum(np.abs(s - arc) / half_width, 1.0)
        return np.cos(math.pi / 2 * away) ** 2 / half_width

    load = flank_load(mesh, tooth, pressure, np.array([0]), mesh.roll[tooth % mesh.gear.z].size - 1)
    return load / math.hypot(load[0::2].sum(), load[1::2].sum())

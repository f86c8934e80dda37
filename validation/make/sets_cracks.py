"""The part of the page `sets` on cracks whose faces touch: beside finite elements of whole bodies in contact."""

import math

import numpy as np

import gearfe as gf
from gearfe.core.table import Column, Table

STEEL = gf.Material(E=207e3, nu=0.3)
RACK = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 20.0}
CRACK = gf.Crack(length=3.0, angle=math.radians(20), start="root", tooth=-3)
# by position, with faces in contact and free: k of planet 0 and ring [N/(mm um)], load of planet 0 [N/mm], turn of the sun [um]
WHOLE_BODIES = {
    -8.4: ((9.6833, 99.941, 16.606), (9.6833, 99.941, 16.606)),
    -4.9: ((16.5037, 99.160, 12.173), (16.5037, 99.160, 12.173)),
    -1.4: ((6.8839, 98.156, 20.449), (4.5967, 78.600, 22.292)),
    0.1: ((6.7000, 99.679, 21.059), (6.3407, 96.866, 21.317)),
    1.6: ((7.9399, 99.723, 18.831), (7.9399, 99.723, 18.831)),
    3.6: ((7.9549, 95.799, 18.116), (7.9549, 95.799, 18.116)),
    4.6: ((8.0369, 95.952, 18.020), (8.0369, 95.952, 18.020)),
    6.1: ((11.3728, 99.120, 14.875), (11.3728, 99.120, 14.875)),
    9.2: ((16.8006, 100.000, 12.111), (16.8006, 100.000, 12.111)),
}
TEXT = """
## Cracks whose faces touch

A set of 21/31/84 teeth, N = 3, on six rigid pads of 4.8 mm, rim of 5 mm. Planet 0 is between two pads at position 0. The ring has
a crack of 3 mm at 20 degrees from the root of tooth -3. Where the bending ring presses the crack shut, its faces carry load. Free
faces would take a third of k of planet and ring there. The independent solution has all bodies with all teeth in straight cubic
triangles of another mesher (Triangle), separate nodes on both faces of the crack, and hats of pressure on whole outlines. The
contact of flanks and faces is one linear complementarity problem, without friction. Both sides share the outlines of the teeth,
the places of the gears, small displacements, scikit-fem's assembly and the sparse factorisation. Both are at the same pose.

| quantity | unit |
|---|---|
| k of planet 0 and ring | N/(mm um) |
| load of planet 0 | N/mm |
| turn of the sun times its base radius | um |

Estimated errors are those of `meta["error"]` over these positions.
"""


def ring_case(damage=True):
    """The set of the table."""
    ring = gf.Gear(z=84, r_rim=90.6, x=-0.4617, addendum=0.85, rack_tip_radius=0.3, **RACK)
    gears = gf.PlanetarySet(gf.Gear(z=21, r_bore=7.4, **RACK), gf.Gear(z=31, r_bore=11.4, **RACK), ring, 3)
    support = gf.RimSupports(6, 4.8, first=math.pi / 6)
    return gf.PlanetaryCase(gears, 2000.0, STEEL, ring=support, damage={"ring": [CRACK]} if damage else None)


def beside_whole_bodies():
    """Positions ``(p,)``, what is found here and by whole bodies ``(p, 3)``, and estimated relative errors ``(3,)``."""
    at = sorted(WHOLE_BODIES)
    found = gf.planetary_stiffness(ring_case(), at)
    own = np.column_stack([found.k[1, :, 0] / 2e7, found.force[0, :, 0] / 20, found.te * 1e6])
    error = found.meta["error"]
    return found, own, np.array([WHOLE_BODIES[one][0] for one in at]), [error["k"][1, 0], error["force"][0, 0], error["te"]]


def section():
    """Lines of the page."""
    found, own, whole, error = beside_whole_bodies()
    sound = gf.planetary_stiffness(ring_case(damage=False), found.position, error=False).k[1, :, 0] / 2e7
    names = ("k", "load", "turn")
    columns = [Column("position", form="{:g}"), "faces", Column("k, free faces")]
    columns += [
        column for name in names for column in (Column(name), Column(f"{name}, whole bodies"), Column("apart", "%", "{:+.2f}"))
    ]
    columns += [Column("loss of k", "%", "{:.2f}")]
    rows = []
    for i, at in enumerate(found.position.tolist()):
        faces = "touch" if at in found.meta["shut"] else "open"
        beside = [cell for a, b in zip(own[i], whole[i], strict=True) for cell in (a, b, 100 * (a / b - 1))]
        rows.append([at, faces, WHOLE_BODIES[at][1][0], *beside, 100 * (1 - own[i, 0] / sound[i])])
    told = ", ".join(f"{name} {100 * value:.2f} %" for name, value in zip(names, error, strict=True))
    return [TEXT, "", Table(columns, rows).markdown(), "", f"Estimated errors: {told}."]

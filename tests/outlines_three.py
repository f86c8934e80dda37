"""Undercut helical pairs whose form corners touch, pressed by CalculiX with whole flanks and fillets, and `ritz3d`."""

import math

import gearfe as gf
from validation.shared import kept_rows
from validation.shared.outsider import STEEL, told
from validation.shared.solid_pair import solid_contact

TABLE, OURS = "outlines_three", "outlines_three_ritz3d"  # tables of rows: runs of CalculiX; of `ritz3d`
LOAD = 600.0  # N/mm
PHASE = 0.0  # the line of one pair is all before the start of the path: there the form corner counts most
ASKED = 0.006  # largest difference asked for at corners
MESHES = ({"per_width": 1.0, "layers": 4}, {"per_width": 1.5, "layers": 4})


def cases():
    """Pairs by name."""
    return {
        "10/30, beta 10, b/m 4": pair_of((10, 30), (3.0, 18.0), 10, 8.0),
        "12/24, beta 15, b/m 5": pair_of((12, 24), (6.0, 14.4), 15, 10.0),
        "11/24, beta 20, b/m 6": pair_of((11, 24), (5.5, 14.4), 20, 12.0),
    }


def pair_of(teeth, bores, degrees, width):
    """Return a pair of standard gears; of the pinion, cut by a rack, the foot of the flanks is undercut."""
    gears = (
        gf.Gear(z=z, m_n=2.0, alpha_n=math.radians(20), beta=sense * math.radians(degrees), b=width, r_bore=bore)
        for z, bore, sense in zip(teeth, bores, (1, -1), strict=True)
    )
    return gf.GearPair(*gears)


def ours(name):
    """By `ritz3d`: k [N/um], approach [mm], what tooth pair 0 carries at right angles to its flanks [N]; k of the path alone."""
    pair = cases()[name]
    found, path = (solid_contact(pair, LOAD * pair.gear_1.b, STEEL, [PHASE], extended=on) for on in (True, False))
    cells = found.cells[0]
    return found.k[0] / 1e6, found.approach[0], float(cells.load[cells.order == 0].sum()), path.k[0] / 1e6


def wanted():
    """(name, mesh, key) of all runs."""
    return [(name, mesh, f"{name}, {told(mesh)}") for name in cases() for mesh in MESHES]


def stored():
    """Return the stored runs, as dicts with their case, mesh and what `ritz3d` finds."""
    theirs, found = kept_rows.stored(TABLE), kept_rows.stored(OURS)
    return [found[name] | {"case": name, "mesh": told(mesh)} | theirs[key] for name, mesh, key in wanted()]

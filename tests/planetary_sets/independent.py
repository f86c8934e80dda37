"""Sets beside solutions that share no contact with gearfe: finite elements of whole bodies, and CalculiX (page `sets`)."""

import math

import numpy as np
from sets import case, gears

import gearfe as gf
from gearfe.planetary_sets.standing import standing, tooth_angles

AT, ERROR = 0.3, 0.002  # position; mm by which planet 0 stands ahead
STANDS = {"at a support": 0.0, "between two": math.pi / 6}  # of six pads of 4.8 mm: angle from planet 0 to the next
CRACK = gf.Crack(length=3.0, angle=math.radians(20), start="root", tooth=-3)
# by position, from `whole_bodies` at refine 1: k of planet 0 and ring [N/(mm um)], load of planet 0 [N/mm], turn of the sun [um],
# and the force on the faces of the crack [N/mm]
WHOLE_BODIES = {
    -10.83: (8.42693, 99.9993, 18.0471, 0),
    -10.23: (8.68337, 99.9933, 20.046, 0),
    -6.05: (17.5079, 99.9015, 14.2691, 0),
    -1.4: (6.87009, 98.215, 20.507, 94.0272),
    -1.32: (6.88359, 98.4586, 22.794, 91.7203),
    0.1: (6.68513, 99.6726, 21.1136, 29.2418),
    3.27: (7.81337, 95.8217, 18.2121, 0),
    3.8: (7.93714, 96.2962, 20.392, 0),
    9.2: (16.78, 100.015, 12.1257, 0),
    13.21: (6.52094, 100.016, 21.4994, 2.72709),
}


def small(first):
    """The set that CalculiX solved (page `sets`), its first pad at an angle from planet 0 [rad]."""
    made = gears()
    angles = 2 * math.pi / 3 * np.arange(3)
    support = gf.RimSupports(6, 4.8, first=first - tooth_angles(made, angles, standing(made, angles, [AT]))[2])
    return case(ring=support, errors=[(0, ERROR), (0, 0), (0, 0)])


def ring_case():
    """The set of the table: a ring on six pads, with a crack."""
    return case(rim=90.6, ring=gf.RimSupports(6, 4.8, first=math.pi / 6), damage={"ring": [CRACK]})


def beside_whole_bodies():
    """Positions ``(p,)``, what is found here and by whole bodies ``(p, 3)``, and estimated relative errors ``(3,)``."""
    at = sorted(WHOLE_BODIES)
    found = gf.planetary_stiffness(ring_case(), at)
    own = np.column_stack([found.k[1, :, 0] / 2e7, found.force[0, :, 0] / 20, found.te * 1e6])
    error = found.meta["error"]
    return found, own, np.array([WHOLE_BODIES[one][:3] for one in at]), [error["k"][1, 0], error["force"][0, 0], error["te"]]

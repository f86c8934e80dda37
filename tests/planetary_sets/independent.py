"""Sets beside solutions that share no contact with gearfe: finite elements of whole bodies, and CalculiX (page `sets`)."""

import math

import numpy as np
from sets import case, gears

import gearfe as gf
from gearfe.planetary_sets.standing import standing, tooth_angles

AT, ERROR = 0.3, 0.002  # position; mm by which planet 0 stands ahead
STANDS = {"at a support": 0.0, "between two": math.pi / 6}  # of six pads of 4.8 mm: angle from planet 0 to the next
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
    return found, own, np.array([WHOLE_BODIES[one][0] for one in at]), [error["k"][1, 0], error["force"][0, 0], error["te"]]

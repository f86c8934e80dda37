"""Area of a gear's section from its outline, for tests of meshes."""

import math

import numpy as np

from gearfe.geometry.tooth.profile import fillet_length, flank, root_curve, root_half_angle


def section_area(gear):
    """Area [mm2] between bore and outline: twice the area inside half of a tooth, of tip arc, flank, fillet and root arc."""
    half = flank(gear, np.linspace(gear.roll_a, gear.roll_f, 4001)), root_curve(gear, np.linspace(fillet_length(gear), 0, 4001))
    radius, angle = np.concatenate(half, axis=1)
    twice = gear.r_a**2 * gear.half_thickness(gear.r_a) + gear.r_f**2 * (math.pi / gear.z - root_half_angle(gear))
    twice += ((radius[1:] ** 2 + radius[:-1] ** 2) / 2 * np.diff(angle)).sum()
    return gear.z * twice - math.pi * gear.r_bore**2

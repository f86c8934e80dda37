"""Independent checks that several tests share."""

import math
import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from gearfe.flexibility.halfspace import pair_kernel
from gearfe.geometry.damage.hollow import intervals, union_length
from gearfe.geometry.tooth.profile import fillet, flank, form_point


def form_mismatch(gear):
    """Distance [mm] between fillet and involute at the form point: zero up to rounding."""
    phi, roll = form_point(gear)
    radius, angle = fillet(gear, phi)
    return float(radius * (angle - flank(gear, roll)[1]))


def ellipse_loss(pair, pits, *, width=None):
    """Return the contact line length [mm] that elliptical pits remove from a helical pinion tooth, as a function of its phase.

    Parameters
    ----------
    pits : sequence of (float, float, float, float)
        Radius on the pinion, place across the width from where contact enters, axis along the width, axis along the profile [mm].
    """
    gear = pair.gear_1
    width = width or pair.b_w
    angle = abs(gear.beta_b)

    def lost(phase):
        out = np.zeros(np.shape(phase))
        for radius, z0, major, minor in pits:
            centre = math.sqrt(radius**2 - gear.r_b**2)
            stretch = centre / gear.r_b  # profile arc per length of the line of action
            # along the line: z, and roll = path start + phase p_bt - z tan(angle); it cuts (z - z0)**2/a**2 + s**2/b**2 = 1
            offset = (pair.path[0] + np.asarray(phase) * pair.p_bt - z0 * math.tan(angle) - centre) * stretch
            slant, a, b = math.tan(angle) * stretch, major / 2, minor / 2
            size = (slant * a) ** 2 + b**2
            out = out + 2 * a * b * np.sqrt(np.maximum(size - offset**2, 0.0)) / size / math.cos(angle)
        return out

    return lost


def pit_loss(pair, *, count, diameter, radius=None):
    """Part of the contact line of a spur tooth lost to a row of circular pits, as a function of its phase, as S0 has it.

    Pits of `diameter` [mm] lie side by side across the width at `radius` of the pinion (default: its pitch point); each takes the
    chord at which the line of contact crosses it.
    """
    gear, width = pair.gear_1, min(pair.gear_1.b, pair.gear_2.b)
    centre = math.sqrt((radius or pair.pitch_radius_1) ** 2 - gear.r_b**2)

    def lost(phase):
        roll = pair.path[0] + np.asarray(phase) * pair.p_bt
        along = (roll**2 - centre**2) / (2 * gear.r_b)  # arc of an involute
        return count * 2 * np.sqrt(np.maximum(diameter**2 / 4 - along**2, 0.0)) / width

    return lost


def line_kernel(start, stop, x):
    """`halfspace.pair_kernel` of all pairs of cells of one line ``(n, n)`` [1/mm]."""
    i, j = (part.ravel() for part in np.indices((start.size, start.size)))
    return pair_kernel((start, stop), i, j, x).reshape(start.size, start.size)


def together(count, work):
    """What `work` gives of the numbers of `count` threads that begin at once, errors as they are."""
    start = threading.Barrier(count)

    def one(i):
        start.wait()
        try:
            return work(i)
        except Exception as error:
            return error

    with ThreadPoolExecutor(count) as pool:
        return list(pool.map(one, range(count)))


def lost_width(gear, hollows, arc):
    """Width [mm] that the hollows of one flank take away at profile arcs `arc` [mm]."""
    return union_length(*intervals(gear, hollows, arc))

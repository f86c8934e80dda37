"""Columns of a stiffness file: quantities and units from the column names."""

import math
import re

FORCE = {"N": 1.0, "kN": 1e3, "MN": 1e6, "GN": 1e9}
LENGTH = {"m": 1.0, "mm": 1e-3, "um": 1e-6}
TURN = {"deg": math.pi / 180, "rad": 1.0}
ANGLES, RADII = ("angle", "pinion angle", "roll angle", "theta"), ("radius", "pinion radius", "contact radius")
ABSCISSAE = "'phase' (mesh cycles), 'angle [deg]' or 'angle [rad]' (of the pinion) or 'radius [mm]' (one pair, on the pinion)"
UNITS = "N/m, N/mm, N/um (also kN, MN, GN) or, per width, N/(mm um), N/(m um)"


def name_and_unit(cell):
    """Return name and unit of a column heading such as ``k [N/m]``, ``k (N/m)`` or ``k_N_per_m``."""
    for pattern in (r"(.*?)\s*\[(.*)\]", r"(.*?)\s*\((.*)\)", r"(.*?)_([kMG]?N_per_\w+|deg|rad|mm)"):
        if match := re.fullmatch(pattern, cell):
            return match[1].lower().replace("_", " "), match[2].strip()
    return cell.lower(), ""


def abscissa_of(path, cell):
    """Return the quantity of the first column and its scale."""
    name, unit = name_and_unit(cell)
    if name == "phase" and unit in ("", "-", "1"):
        return "phase", 1.0
    if name in ANGLES and unit in TURN:
        return "angle", TURN[unit]
    if name in RADII and unit == "mm":
        return "radius", 1.0
    raise ValueError(f"{path}: first column {cell!r}, but it must be {ABSCISSAE}")


def stiffness_of(path, cell):
    """Return the factor to N/m, and whether the stiffness is per face width."""
    unit = stiffness_unit(cell)
    if not unit:
        raise ValueError(f"{path}: second column {cell!r} states no known unit of stiffness; use k [unit] with {UNITS}")
    return unit


def stiffness_unit(cell):
    """Return the factor to SI units and whether the stiffness is per width, or None for an unknown unit."""
    unit = name_and_unit(cell)[1].replace("_per_", "/").replace("_", " ")
    for sign, plain in (("µ", "u"), ("μ", "u"), ("·", " "), ("*", " ")):
        unit = unit.replace(sign, plain)
    match = re.fullmatch(r"([kMG]?N) ?/ ?\(? ?(\w+)(?:[ /]+(\w+))? ?\)?", unit)
    if not match or not set(match.groups()[1:]) <= {*LENGTH, None}:
        return None
    force, *lengths = match.groups()
    return FORCE[force] / math.prod(LENGTH[length] for length in lengths if length), lengths[1] is not None

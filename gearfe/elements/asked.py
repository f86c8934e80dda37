"""What functions of single gears and teeth are asked for, checked before any work: gear, material, load, resolution."""

import math
from numbers import Real
from typing import Any

import numpy as np

from geometry.damage.crack import Crack
from geometry.damage.kinds import are
from geometry.tooth.gear import Gear

from ..material import Material

COARSEST = 0.2  # at 0.4 sections are off by 0.2 %, at 0.2 by 0.5 %, below they follow no mesh any more (25 % at 1e-9)
FINEST = 64.0  # edges of a 64th: k changes by less than rounding and contact leave
MOST_LOAD = 0.05  # N/mm over E m_n: no mesh of teeth is stiffer than b E / 5, so that it would approach by m_n / 4
SAMPLES = 65  # heights at which a load along the width is looked at


def is_number(value: Any) -> bool:
    """Whether it is a real number: no text, no truth value."""
    return isinstance(value, Real) and not isinstance(value, (bool, np.bool_))


def checked_refine(refine: Any) -> float:
    """The resolution, if meshes follow it: from `COARSEST` to `FINEST`.

    Raises
    ------
    ValueError
        If it is no number, or outside.
    """
    if not is_number(refine) or not math.isfinite(refine):
        raise ValueError(f"refine = {refine!r}, but give a finite number: it divides the edge lengths")
    if not COARSEST <= refine <= FINEST:
        why = (
            "meshes follow it no further and their results are not to be trusted"
            if refine < COARSEST
            else "k changes by less than 1e-6 from 16 on, and the memory is full"
        )
        raise ValueError(f"refine = {refine}, but give {COARSEST:g} to {FINEST:g}: {why}")
    return float(refine)


def check_gear(gear):
    """ValueError unless it is a `Gear`: a pair has two."""
    if not isinstance(gear, Gear):
        raise ValueError(f"gear = {gear!r}, but give one Gear, of a pair for instance pair.gear_1")


def check_one(gear, material, refine=1.0):
    """ValueError unless these are one gear, its one material and a resolution."""
    check_gear(gear)
    if not isinstance(material, Material):
        raise ValueError(f"material = {material!r}, but give the Material of this gear")
    checked_refine(refine)


def check_length(name, value):
    """ValueError unless a length is None (the default) or a positive number [mm]."""
    if value is not None and not (is_number(value) and math.isfinite(value) and value > 0):
        raise ValueError(f"{name} = {value!r} mm, but it is a length: give {name} > 0, or leave it out")


def check_line_load(line_load, gear, material):
    """ValueError unless the line load is a finite push that teeth of this module and material stand at small strains."""
    if not (is_number(line_load) and line_load > 0 and math.isfinite(line_load)):
        raise ValueError(f"line_load = {line_load!r} N/mm, but a tooth is pushed: give a finite line_load > 0")
    most = MOST_LOAD * material.E * gear.m_n
    if line_load > most:
        raise ValueError(
            f"line_load = {line_load:g} N/mm, but under more than {most:.3g} N/mm (E m_n / {1 / MOST_LOAD:g}) a tooth bends by a "
            "quarter of the module and breaks: give a smaller one, in N/mm, lengths in mm, E in MPa"
        )


def check_load_along(line_load, gear, material):
    """ValueError unless it is a finite push, or a function of heights z [mm] that gives finite pushes, not all zero."""
    if not callable(line_load):
        return check_line_load(line_load, gear, material)
    z, b = np.linspace(0.0, gear.b, SAMPLES), gear.b
    try:
        found = np.asarray(line_load(z))
        load = np.broadcast_to(found, z.shape)
    except (TypeError, ValueError) as error:
        raise ValueError(f"line_load at {SAMPLES} heights z: {error}; give a function of an array of heights [mm]") from error
    if found.dtype.kind not in "iuf" or not np.isfinite(load).all() or load.min() < 0 or not load.max() > 0:
        raise ValueError(
            f"line_load from z = 0 to {b:g} mm gives {load[0]!s} to {load[-1]!s}, but a tooth is pushed: give numbers >= 0 "
            "[N/mm], somewhere > 0"
        )
    check_line_load(float(load.max()), gear, material)


def check_cracks(cracks):
    """ValueError unless they are a sequence of `Crack`."""
    if not are(cracks, Crack):
        raise ValueError(f"cracks = {cracks!r}, but give a list of Crack, [] for none")

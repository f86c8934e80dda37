"""What `mesh_stiffness` is given, checked and brought into one form; errors say what was given and what to do."""

import math
import warnings
from dataclasses import replace
from inspect import signature
from numbers import Real

import numpy as np

from geometry.damage.crack import Crack, check_apart, check_through
from geometry.damage.pit import Pit
from geometry.pair.lines import FACES

from ..energy.closed import published, textbook
from ..energy.closed.plain_sum import plain_sum
from ..material import Material

CLOSED = {"textbook": textbook, "published": published}  # plain sums of tooth pairs
WIDE = ("ritz3d", "fe3d")  # in three dimensions
METHODS = ("auto", "ritz", "ritz3d", "fe", "fe3d", "coupled", *CLOSED)
NO_VARIANTS = (
    *("pair", "materials", "phase", "formulas", "gear", "material", "roll", "cracks", "pits", "variants", "face", "groove"),
)


def two_materials(material):
    """Materials of pinion and wheel."""
    materials = (material, material) if isinstance(material, Material) else material
    if not isinstance(materials, (tuple, list)) or len(materials) != 2 or not all(isinstance(m, Material) for m in materials):
        raise ValueError(f"material = {material!r}, but give one Material or a pair (pinion, wheel)")
    return tuple(materials)


def overlap(pair, face, groove):
    """Overlap ratio of a pair (of one half, if herringbone) whose teeth run as `face` says; 0 for spur."""
    width = min(pair.gear_1.b, pair.gear_2.b)
    if face == "herringbone":
        width = (width - groove) / 2
    return pair.eps_beta_of(width) if face in ("helical", "herringbone") else 0.0


def phase_array(phases, span, pair, overlap=0.0):
    """Phases spelled out; an engagement lasts as long as profile and overlap ratio together."""
    if span not in ("cycle", "tooth"):
        raise ValueError(f"span = {span!r}, but it must be 'cycle' or 'tooth'")
    if np.ndim(phases) == 0:
        if not isinstance(phases, Real) or not math.isfinite(phases) or phases != int(phases) or phases < 1:
            raise ValueError(f"phases = {phases}, but give a number of phases >= 1, or an array of phases")
        if span == "tooth":
            return np.arange(math.floor(-0.25 * phases), math.ceil((pair.eps_alpha + overlap + 0.25) * phases) + 1) / int(phases)
        return np.arange(int(phases)) / int(phases)
    phases = np.asarray(phases, dtype=float)
    if phases.ndim != 1 or phases.size == 0 or not np.isfinite(phases).all():
        raise ValueError("phases must be a non-empty array of finite numbers")
    return phases


def choose(method, pair, cracks, pits, face, teeth):
    """The method that ``auto`` stands for, and why."""
    if method != "auto":
        return method, "asked for"
    if teeth is not None:
        return "fe", "teeth are left out"
    if not all(crack.through for own in cracks for crack in own):
        return "ritz3d", "cracks change along the width"
    if any(pits):
        return "ritz3d", "pits change along the width"
    if face in ("helical", "herringbone") or (face is None and pair.gear_1.beta):
        return "ritz3d", "contact lines run across helical teeth"
    return "ritz", "spur gears, nothing changes along the width: plane strain"


def refuse(method, pair, cracks, pits, teeth, variants, face, groove):
    """Raise ValueError for what a method does not model."""
    if face not in (None, *FACES):
        raise ValueError(f"face = {face!r}, but it must be one of {', '.join(FACES)}")
    if method in ("ritz", "fe", "coupled") and face not in (None, "spur"):
        raise ValueError(
            f"face = {face!r} with method = {method!r}, a transverse section: use method = 'ritz3d' or a closed form"
        )
    if method in ("ritz", "fe", "coupled") and groove:
        raise ValueError(f"groove = {groove} mm with method = {method!r}, a transverse section: use face = 'herringbone'")
    ring, damaged = pair.gear_2.internal, any(cracks) or any(pits)
    if ring and method == "coupled":
        raise ValueError("method = 'coupled' has no ring: use method = 'ritz'")
    if ring and method in CLOSED and (variants or {}).get("foundation") not in ("none", "external"):
        raise ValueError(
            f"method = {method!r} has no foundation for a ring: give variants = {{'foundation': 'external'}} to leave the ring's "
            "out (or 'none' for both gears'), or use method = 'ritz'"
        )
    if damaged and method == "coupled":
        raise ValueError("damage with method = 'coupled', which has none: use 'ritz' or 'textbook'")
    if any(pits) and method not in (*CLOSED, *WIDE):
        raise ValueError(f"pits with method = {method!r}, a transverse section: use 'ritz3d', 'textbook' or 'published'")
    if method not in WIDE:
        check_through([crack for own in cracks for crack in own], f"method = {method!r}")
    if teeth is not None and method != "fe":
        raise ValueError(f"teeth = {teeth} with method = {method!r}: only 'fe' can leave teeth out")
    if variants and method not in CLOSED:
        raise ValueError(f"variants = {variants!r} with method = {method!r}: only {' and '.join(CLOSED)} have variants")
    if variants:
        known = [*signature(plain_sum).parameters, *signature(CLOSED[method].components).parameters]
        known = sorted(set(known) - set(NO_VARIANTS))
        for name in variants:
            if name not in known:
                raise ValueError(f"variants: {name!r} is none of method = {method!r}; it has {', '.join(known)}")


def by_gear(pair, damage):
    """Cracks and pits of pinion and wheel, numbered in each gear's own frame."""
    damage = {} if damage is None else damage
    unknown = set(damage) - {"pinion", "wheel"}
    if unknown:
        raise ValueError(f"damage of {unknown.pop()!r}, but it is given for 'pinion' and 'wheel'")
    cracks, pits = [], []
    for name, gear, sense in (("pinion", pair.gear_1, 1), ("wheel", pair.gear_2, -1)):
        given = damage.get(name) or ()
        given = (given,) if isinstance(given, (Crack, Pit)) else tuple(given)
        for one in given:
            if not isinstance(one, (Crack, Pit)):
                raise ValueError(f"damage of the {name}: {one!r} is neither a Crack nor a Pit")
        check_apart(gear, [one for one in given if isinstance(one, Crack)])
        own = [replace(one, tooth=sense * one.tooth) for one in given]
        cracks.append(tuple(one for one in own if isinstance(one, Crack)))
        pits.append(tuple(one for one in own if isinstance(one, Pit)))
    return tuple(cracks), tuple(pits)


def warn_if_unseen(pair, damage, order):
    """Warn if no cracked tooth is in contact at any of the phases."""
    seen = ((pair.gear_1, damage["pinion"]), (pair.gear_2, damage["wheel"]))
    if not any(crack["tooth"] % gear.z in order % gear.z for gear, cracks in seen for crack in cracks):
        warnings.warn(
            "no cracked tooth is in contact at these phases: tooth k is at phases from -k; use span='tooth' for tooth 0",
            stacklevel=4,
        )

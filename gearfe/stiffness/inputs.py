"""What `mesh_stiffness` is given, checked and brought into one form; errors say what was given and what to do."""

import math
import warnings
from dataclasses import replace
from inspect import signature

import numpy as np

from geometry.damage.crack import check_apart, check_through
from geometry.damage.kinds import by_side, split, why_wide

from ..elements.asked import is_number
from ..energy.closed.plain_sum import plain_sum
from ..material import Material
from .limits import check_count, check_range, numbers
from .methods import FACES, METHODS, NAMES, RING_FOUNDATIONS, Method, having
from .own_flexibility import OwnFlexibility
from .turns import check_length, cycles_in

NO_VARIANTS = (
    *("pair", "materials", "phase", "formulas", "gear", "material", "roll", "cracks", "pits", "variants", "face", "groove"),
    "flanks",
)

SPANS = ("cycle", "tooth", "revolution", "hunting")
CRACK_MODELS = tuple(dict.fromkeys(model for row in METHODS.values() for model in row.crack_models))


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
    if span not in SPANS:
        raise ValueError(f"span = {span!r}, but it must be one of {', '.join(SPANS)}")
    if np.ndim(phases) == 0:
        phases = check_count(phases)
        if span == "tooth":
            return np.arange(math.floor(-0.25 * phases), math.ceil((pair.eps_alpha + overlap + 0.25) * phases) + 1) / phases
        check_length(pair, span, phases)
        return np.arange(phases * cycles_in(pair, span)) / phases
    if span in ("revolution", "hunting"):
        raise ValueError(f"span = {span!r} with phases spelled out: give their number in each mesh cycle")
    phases = numbers("phases", phases, "")
    if phases.ndim != 1 or phases.size == 0 or not np.isfinite(phases).all():
        raise ValueError("phases must be a non-empty array of finite numbers")
    check_range(phases, pair.eps_alpha + overlap)
    return phases


def why_solid(pair, face, damage):
    """Why a pair needs three dimensions; empty if its transverse section is the whole truth.

    Parameters
    ----------
    pair : GearPair
    face : str or None
        How the teeth run; None: as their helix angle says.
    damage : sequence of damage
    """
    if why := why_wide(damage):
        return why
    if (face or ("helical" if pair.gear_1.beta else "spur")) != "spur":
        return "contact lines run across helical teeth"
    return ""


def choose(method, pair, cracks, pits, face, teeth, flanks=None, supports=None):
    """The method that ``auto`` stands for, and why."""
    if method != "auto":
        return method, "asked for"
    if teeth is not None:
        return "fe", "teeth are left out"
    if any(one.integral for one in supports or () if one):
        return "fe3d", "a gear is one piece with its shaft"
    why = why_solid(pair, face, [one for own in (*cracks, *pits) for one in own])
    why = why or ("flanks change along the width" if any(form.wide for form in flanks or ()) else "")
    why = why or ("shafts tilt the gears" if any(one.tilts for one in supports or () if one) else "")
    return ("ritz3d", why) if why else ("ritz", "spur gears, nothing changes along the width: plane strain")


def row_of(method):
    """The row of a method in the table, and the `OwnFlexibility` if it is one; the method must not be ``auto`` any more."""
    if isinstance(method, OwnFlexibility):
        return Method(method.name, "a model of one's own", "section", "", "", extended=method.extended, flanks=True), method
    return METHODS[method], None


def check_method(method):
    """Raise ValueError unless it is the name of a method or an `OwnFlexibility`."""
    if isinstance(method, OwnFlexibility) or (isinstance(method, str) and method in NAMES):
        return
    raise ValueError(f"method = {method!r}, but it must be one of {', '.join(NAMES)}, or an OwnFlexibility")


def refuse(row, pair, cracks, pits, teeth, variants, face, groove, flanks=None):
    """Raise ValueError for what the method of a `row` of the table does not model."""
    method = f"method = {row.name!r}"
    if not is_number(groove):
        raise ValueError(f"groove = {groove!r}, but give the width of the relief groove, a number [mm]")
    if face not in (None, *FACES):
        raise ValueError(f"face = {face!r}, but it must be one of {', '.join(FACES)}")
    if face not in (None, *row.faces):
        raise ValueError(f"face = {face!r} with {method}, a transverse section: use method = 'ritz3d' or a closed form")
    if groove and "herringbone" not in row.faces:
        raise ValueError(f"groove = {groove} mm with {method}, a transverse section: use face = 'herringbone'")
    if pair.eps_alpha + overlap(pair, face or ("helical" if row.kind == "solid" else "spur"), groove) < 1:
        raise ValueError(
            f"contact ratio {pair.eps_alpha:.4g} < 1 with {method}: without more overlap of helical teeth they lose contact; "
            "use method = 'ritz3d' and a face wide enough, or change a, addendum or profile shift"
        )
    ring, damaged = pair.gear_2.internal, any(cracks) or any(pits)
    if ring and row.rings == "no":
        raise ValueError(f"{method} has no ring: use method = 'ritz'")
    if ring and row.rings in RING_FOUNDATIONS and (variants or {}).get("foundation") not in RING_FOUNDATIONS:
        raise ValueError(
            f"{method} has no foundation for a ring: give variants = {{'foundation': 'external'}} to leave the ring's "
            "out ('none': both gears'; 'printed': that of external gears with h = 1, as article S4), or use method = 'ritz'"
        )
    if damaged and not row.cracks and not row.pits:
        raise ValueError(f"damage with {method}, which has none: use {having('cracks')}")
    if any(cracks) and not row.cracks:
        raise ValueError(f"cracks with {method}, which has none: use {having('cracks')}")
    if any(pits) and not row.pits:
        raise ValueError(
            f"{next(one for own in pits for one in own).nouns[1]} with {method}, a transverse section: use {having('pits')}"
        )
    found = [crack for own in cracks for crack in own]
    if row.cracks != "any":
        check_through(found, method)
    if teeth is not None and not row.teeth:
        raise ValueError(f"teeth = {teeth} with {method}: only {having('teeth')!r} can leave teeth out")
    if flanks is not None and not row.flanks:
        raise ValueError(f"modified flanks with {method}, which takes involutes only: use {having('flanks')}")
    if row.kind == "section" and any(form.wide for form in flanks or ()):
        raise ValueError(
            f"flanks that change along the width, or misalignment, with {method}, which knows no width: use method = 'ritz3d', "
            "'fe3d' or a plain sum"
        )
    if variants and not row.variants:
        raise ValueError(f"variants = {variants!r} with {method}: only {having('variants')} have variants")
    if variants is not None and not isinstance(variants, dict):
        raise ValueError(f"variants = {variants!r}, but give a dict: {{'foundation': 'none'}}")
    for name in variants or ():
        known = [*signature(plain_sum).parameters, *signature(row.load().components).parameters]
        known = sorted(set(known) - set(NO_VARIANTS))
        if name not in known:
            raise ValueError(f"variants: {name!r} is none of {method}; it has {', '.join(known)}")
        value = variants[name]
        if name == "theta_f" and value is not None and not (is_number(value) and 0 < value < math.pi / 2):
            raise ValueError(f"variants: theta_f = {value!r}, but a root half angle lies between 0 and pi/2 rad")
        if name == "crack_model" and value not in CRACK_MODELS:
            raise ValueError(f"variants: crack_model = {value!r}, but it must be one of {', '.join(CRACK_MODELS)}")


def forces_of(pair, force, torque):
    """Forces along the line of action [N] as a list: given, or from torques on the pinion [N m], ``T / r_b``."""
    if (force is None) == (torque is None):
        raise ValueError(
            f"force = {force!r}, torque = {torque!r}, but give one of them: the force along the line of action [N] or the torque "
            "on the pinion [N m]"
        )
    name, unit, given = ("force", " N", force) if torque is None else ("torque", " N m", torque)
    found = np.atleast_1d(numbers(name, given, f" [{unit.strip()}]"))
    if found.ndim > 1 or found.size == 0:
        raise ValueError(f"{name} = {given!r}, but give one {name} or a non-empty list of {name}s [{unit.strip()}]")
    for value in found.tolist():
        if not (math.isfinite(value) and value > 0):
            raise ValueError(f"{name} = {value}{unit}, but a mesh is pressed together: give a finite {name} > 0")
    return (found if torque is None else found * (1e3 / pair.gear_1.r_b)).tolist()


def refuse_numeric(row, *, refine, order, error, state):
    """Raise ValueError for an option of the discretisation that the method of a `row` has not: none is ignored in silence."""
    method = f"method = {row.name!r}"
    if order is not None and row.order is None:
        raise ValueError(f"order = {order!r} with {method}, which has no polynomials: only {having('order')} have an order")
    if order is not None and (not is_number(order) or not 2 <= order <= 8 or order != int(order)):
        raise ValueError(f"order = {order!r}, but give a whole number from 2 to 8, or None for that of the method")
    if refine != 1 and not row.converged:
        raise ValueError(f"refine = {refine:g} with {method}, which has no mesh: only {having('converged')} can be refined")
    if error and not row.error:
        raise ValueError(f"error = True with {method}, which has no estimate: only {having('error')} estimate their error")
    if state != "plane strain" and row.kind != "section":
        raise ValueError(f"state = {state!r} with {method}, which is no plane section: leave it out")


def said_of_face(pair, face):
    """Warn if the teeth are called helical, but are straight."""
    if face in ("helical", "herringbone") and not pair.gear_1.beta:
        warnings.warn(f"face = {face!r}, but the gears have no helix angle (beta = 0): their teeth are straight", stacklevel=3)


def by_gear(pair, damage):
    """What weakens pinion and wheel (cracks) and what takes their contact away (pits), numbered in each gear's own frame."""
    cracks, pits = [], []
    for gear, sense, given in zip((pair.gear_1, pair.gear_2), (1, -1), by_side(damage), strict=True):
        for text in filter(None, (one.doubts(gear) for one in given)):
            warnings.warn(text, stacklevel=4)
        weakens, removes = split(replace(one, tooth=sense * one.tooth) for one in given)
        check_apart(gear, split(given)[0])
        cracks.append(weakens)
        pits.append(removes)
    return tuple(cracks), tuple(pits)

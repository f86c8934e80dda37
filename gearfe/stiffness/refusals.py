"""Checks of a case against the abilities of a method, so that no other model is used silently."""

import math
from inspect import signature
from itertools import chain

from ..core.checks import is_number, one_of
from ..flexibility.energy.closed.plain_sum import plain_sum
from ..geometry.damage.chip import Chip
from ..geometry.damage.crack import check_through
from .limits import check_section, check_teeth
from .methods import METHODS, RING_FOUNDATIONS, having
from .supported import check_integral, check_tilt

NO_VARIANTS = ("case", "phase", "formulas", "variants", "gear", "material", "roll", "damage")
CRACK_MODELS = tuple(dict.fromkeys(model for row in METHODS.values() for model in row.crack_models))


def refuses(row, case, how):
    """Raise ValueError for parts of a `Case` that the method of a `row` does not model, and for options that it lacks.

    The message states the input and the methods that model it. RuntimeError if a section of finite elements does not fit into
    memory.
    """
    method = f"method = {row.name!r}"
    of_case = (refusal for group in (_teeth, _damage, _flanks) for refusal in group(row, case, method))
    for refusal in chain(of_case, _options(row, how, method)):
        raise ValueError(refusal)
    if row.cracks != "any":
        check_through([crack for cracks in case.cracks for crack in cracks], method)
    check_teeth(how.teeth, max(case.pair.gear_1.z, case.pair.gear_2.z))
    _check_variants(row, case, how, method)
    check_integral(case, row.name)
    if row.kind != "solid":
        check_tilt(case, row.name)
    if row.name == "fe":
        check_section(how.refine)


def _teeth(row, case, method):
    """Yield reasons against the method: face, groove, contact ratio below 1, ring gear."""
    if case.face not in (None, *row.faces):
        yield f"face = {case.face!r} with {method}, a transverse section: use method = 'ritz3d' or a closed form"
    if case.groove and "herringbone" not in row.faces:
        yield f"groove = {case.groove} mm with {method}, a transverse section: use face = 'herringbone'"
    ratio = case.pair.eps_alpha
    if ratio + case.overlap(case.face or ("helical" if row.kind == "solid" else "spur")) < 1:
        yield (
            f"contact ratio {ratio:.4g} < 1 with {method}: the teeth lose contact without more helical overlap; "
            "use method = 'ritz3d' and a face wide enough, or change a, addendum or profile shift"
        )
    if case.pair.gear_2.internal and row.rings == "no":
        yield f"{method} has no ring: use method = 'ritz'"


def _damage(row, case, method):
    kinds = {"damage": case.damaged and not row.pits, "cracks": any(case.cracks)}
    if not row.cracks:
        yield from (f"{kind} with {method}, which has none: use {having('cracks')}" for kind, hurt in kinds.items() if hurt)
    if not row.broken:
        yield from (f"a {one._nouns[0]} with {method}, which has none: use {having('broken')}" for one in sum(case.broken, ()))
    edged = [broken for form, broken in zip(case.forms or (), case.broken, strict=False) if form.edge is not None]
    if any(isinstance(one, Chip) for one in sum(edged, ())):
        yield "chips of rounded or chamfered tips: leave out tip_rounding and tip_chamfer, or the chips"
    if (pits := sum(case.pits, ())) and not row.pits:
        nouns = pits[0]._nouns[1]
        yield f"{nouns} with {method}, a transverse section: use {having('pits')}"


def _flanks(row, case, method):
    if case.forms is not None and not row.flanks:
        yield f"modified flanks with {method}, which models involutes only: use {having('flanks')}"
    if row.kind == "section" and any(form.wide for form in case.forms or ()):
        yield (
            f"flanks that change along the width, or misalignment, with {method}, which is two-dimensional: "
            "use method = 'ritz3d', "
            "'fe3d' or a plain sum"
        )


def _options(row, how, method):
    """Yield messages on options that the method lacks."""
    if how.teeth is not None and not row.teeth:
        yield f"teeth = {how.teeth} with {method}: only {having('teeth')!r} can omit teeth of the mesh"
    if how.variants and not row.variants:
        yield f"variants = {how.variants!r} with {method}: only {having('variants')} have variants"
    if how.order is not None and row.order is None:
        yield f"order = {how.order!r} with {method}, which has no polynomials: only {having('order')} have an order"
    if how.refine != 1 and not row.converged:
        yield f"refine = {how.refine:g} with {method}, which has no mesh: only {having('converged')} can be refined"
    if how.error and not row.error:
        yield f"error = True with {method}, which has no estimate: only {having('error')} estimate their error"
    if how.state != "plane strain" and row.kind != "section":
        yield f"state = {how.state!r} with {method}, which is no plane section: leave it out"


def _check_variants(row, case, how, method):
    """Raise ValueError for variants that the formulas lack, and for rings without a choice of the foundation."""
    variants = how.variants or {}
    if case.pair.gear_2.internal and row.rings in RING_FOUNDATIONS and variants.get("foundation") not in RING_FOUNDATIONS:
        raise ValueError(
            f"{method} has no foundation for a ring: give variants = {{'foundation': 'external'}} to leave the ring's "
            "out ('none': both gears'; 'printed': that of external gears with h = 1, as article S4), or use method = 'ritz'"
        )
    for name, value in variants.items():
        known = [*signature(plain_sum).parameters, *signature(row.load().components).parameters]
        known = sorted(set(known) - set(NO_VARIANTS))
        if name not in known:
            raise ValueError(f"variants: {name!r} is no variant of {method}; there are {', '.join(known)}")
        if name == "theta_f" and value is not None and not (is_number(value) and 0 < value < math.pi / 2):
            raise ValueError(f"variants: theta_f = {value!r}, but a root half angle lies between 0 and pi/2 rad")
        if name == "crack_model":
            one_of("variants: crack_model", value, CRACK_MODELS)

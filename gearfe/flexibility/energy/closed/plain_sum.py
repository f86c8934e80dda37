"""Independent tooth pairs in parallel. The compliance of a pair is the sum of those of two teeth and a contact."""

from functools import partial

import numpy as np

from ....geometry.damage.crack import check_through
from ....geometry.damage.hollow import check_hollows
from ....geometry.tooth.profile import flank
from ...hertz import linear_hertz, palmgren_line, weber_line
from ...section_contact import Solved
from . import herringbone_article
from .beam import load_angle
from .integrals import flank_edges
from .section import DamagedTooth
from .slices import faces_of, stations

CONTACTS = ("linear", "herringbone_article", "weber", "palmgren")


def plain_sum(case, phase, formulas, *, contact=None, crack_model="constant", lost="hertz", **variants):
    """Return a solver for independent tooth pairs on the path of contact, which have one common approach.

    Every slice of every pair carries the line load w with ``w (s_1 + s_2 + c(w / f) / f) = approach``. Here s are the
    flexibilities of its teeth, c is that of the contact, and f is the part of its contact that pits have left. The loads of all
    slices add up to the load. Teeth and slices do not support each other. Damage belongs to teeth: the others are healthy.

    Parameters
    ----------
    case : Case
        Axial components of force and elasticity are left out: a slice of a helical gear is a spur gear. A slice of modified
        flanks whose gap is not closed carries nothing. Without `face` the teeth are taken for straight.
    phase : ndarray
    formulas : module
        Such as `textbook` or `herringbone_article`: its ``components`` gives the flexibility of one tooth; its ``DEFAULTS``, if
        there are any, the `contact` of its source, and the ``root`` profile that its beams stand on if it is no variant.
    contact : {"linear", "herringbone_article", "weber", "palmgren"}, optional
        `gearfe.flexibility.hertz.linear_hertz`, `herringbone_article.contact`, `weber_line`, `palmgren_line`; default: as the
        source of `formulas`, the second for `herringbone_article` and the first otherwise. The last two depend on the load.
    crack_model : {"constant", "straight", "parabola"}
        Limit line of the material a crack leaves alive, see `gearfe.flexibility.energy.closed.section`.
    lost : {"hertz", "slices", "summed"}
        Reduction of the contact by pits. ``hertz``: the contact stiffness falls by the part of its line inside pits (Liang et al.
        2016). ``slices``: slices inside pits carry no load (uncoupled slices). ``summed``: the widths of all pits of the tooth
        are subtracted, wherever they are along the flank. This is article S4's ``k_h = E (L - sum dL) / 2 (1 - mu**2)``, "For
        multiple pits, I sum the reductions", with dL the largest 2 p_d and L the width of the half they lie in. In all cases the
        lost material weakens the section of the whole tooth (mean over all of b), not of single slices.
    **variants
        Passed on to ``formulas.components``.

    Returns
    -------
    solve : callable
        From the line load [N/mm of face width] to a `Solved`.
    details : dict
        ``outside``: tuple of `gearfe.flexibility.energy.closed.beam.Validity`, the ranges of validity that the gears are not in.

    Raises
    ------
    ValueError
        If an option is unknown, damage does not fit its gear, or at some phase pits leave no contact at all.
    """
    defaults = getattr(formulas, "DEFAULTS", {})
    contact = contact or defaults.get("contact", "linear")
    if contact not in CONTACTS:
        raise ValueError(f"contact = {contact!r}, but it must be one of {', '.join(CONTACTS)}")
    phase = np.atleast_1d(np.asarray(phase, dtype=float))
    pair, materials, damage = case.pair, case.materials, tuple(zip(case.cracks, case.pits, strict=True))
    gears = pair.gears
    for gear, (cracks, pits) in zip(gears, damage, strict=True):
        check_through(cracks, "a plain sum")
        check_hollows(gear, pits)
    root = variants.get("root", defaults.get("root", "fillet"))
    edges = partial(_edges, pair, damage=damage, crack_model=crack_model, root=root)
    at = stations(case, phase, lost=lost, edges=edges)
    empty = np.setdiff1d(np.arange(phase.size), at.phase)
    if empty.size:
        raise ValueError(f"no contact is left at phase {phase[empty[0]]:.6g}: damage covers the whole width; make it smaller")
    teeth, outside = np.zeros(at.roll_1.shape), {}
    order = at.order[at.column]
    places = zip(gears, materials, (at.roll_1, at.roll_2), (order, -order), damage, strict=True)
    for gear, material, roll, tooth, gear_damage in places:
        for where, tooth_damage in _by_tooth(gear, tooth, gear_damage, crack_model):
            flexibility = formulas.components(gear, material, roll[where], damage=tooth_damage, **variants)
            teeth[where] += flexibility.total
            outside |= dict.fromkeys(flexibility.outside)
    return _solver(at, phase.size, teeth, _law(case, at, contact)), {"outside": tuple(outside)}


def _by_tooth(gear, tooth, damage, crack_model):
    """Yield the contact positions of healthy teeth, then those of each damaged tooth, with their `DamagedTooth`."""
    damaged = {defect.tooth % gear.z for kind in damage for defect in kind}
    healthy = ~np.isin(tooth % gear.z, list(damaged))
    if healthy.any():
        yield healthy, DamagedTooth()
    for number in sorted(damaged):
        where = tooth % gear.z == number
        if where.any():
            yield where, DamagedTooth(*(tuple(d for d in kind if d.tooth % gear.z == number) for kind in damage), crack_model)


def _edges(pair, order, *, damage, crack_model, root):
    """Return by tooth pair the roll lengths of the pinion [mm] at which the compliance of a damaged tooth has kinks."""
    out = {}
    for number in order:
        pinion_rolls = []
        for k, (gear, tooth) in enumerate(((pair.gear_1, number), (pair.gear_2, -number))):
            for _, tooth_damage in _by_tooth(gear, np.array([tooth]), damage[k], crack_model):
                rolls = flank_edges(gear, root, tooth_damage) if tooth_damage else np.zeros(0)
                pinion_rolls += (rolls if k == 0 else pair.outward * (pair.length - rolls)).tolist()
        out[number] = pinion_rolls
    return out


def _law(case, at, contact):
    """Return the contact law: secant and tangent flexibility [mm per N/mm] as functions of the load per touching length."""
    pair, materials = case.pair, case.materials
    if contact in ("linear", "herringbone_article"):
        constant = linear_hertz(materials) if contact == "linear" else herringbone_article.contact(materials)
        return lambda line: (constant, constant)
    if contact == "palmgren":
        width = sum(abs(last - first) for first, last, _ in faces_of(case))
        return lambda line: palmgren_line(line, materials, width * at.touching)
    radius = pair.relative_radius(at.roll_1, at.roll_2)
    depth = [_depth(gear, roll) for gear, roll in ((pair.gear_1, at.roll_1), (pair.gear_2, at.roll_2))]
    return lambda line: weber_line(line, materials, radius, depth)


def _depth(gear, roll):
    """Distance [mm] from the flank to the tooth centre-line along the line of the load."""
    radius, angle = flank(gear, roll)
    return radius * np.sin(angle) / np.cos(load_angle(gear, roll))


def _solver(at, count, teeth, law):
    """Return the function `solve` of `plain_sum`, which finds the approach by fixed-point iteration.

    The iteration converges fast, because the contact compliance varies only with the logarithm of the load or with F**0.1.
    """

    def total(values):
        return np.bincount(at.phase, at.weight * values, minlength=count)

    unloaded, gap = None, np.zeros(teeth.shape)
    if at.gap is not None:
        unloaded = np.full(count, np.inf)
        np.minimum.at(unloaded, at.phase, at.gap)
        gap = at.gap - unloaded[at.phase]  # Gaps are relative to first contact, which avoids rounding errors at light loads.

    def solve(line_load):
        line = line_load / total(np.ones(teeth.shape))[at.phase]
        touch = np.ones(teeth.shape)
        for _ in range(200):
            secant, tangent = law(np.maximum(line, 1e-9 * line_load) / at.touching)
            flexibility = teeth + secant / at.touching
            stiffness = total(touch / flexibility)
            closing = (line_load + total(touch * gap / flexibility)) / stiffness
            new = (closing[at.phase] - gap) / flexibility
            closed = (new > 0).astype(float)
            settled = np.abs(touch * new - line).max() <= 1e-13 * line_load or np.ndim(secant) == 0
            settled &= bool((closed == touch).all())
            line, touch = closed * new, closed
            if settled:
                break
        else:
            raise RuntimeError(
                f"the load sharing of the tooth pairs did not converge at {line_load:g} N/mm: use contact = 'linear'"
            )
        tangent = total(touch / (teeth + tangent / at.touching))
        pairs = np.zeros((count, at.order.size))
        np.add.at(pairs, (at.phase, at.column), at.weight * line)
        return Solved(at.order, closing, tangent, pairs, np.full(pairs.shape, np.nan), unloaded=unloaded)

    return solve

"""Stiffness curves of gears of finite width, from contact along their contact lines."""

import time
from functools import partial

import numpy as np

from ..contact.solid import pair_stiffness3d
from ..elements.fe_gear3d import PER_HAT, SIZES
from ..elements.section_error import FINER, finer_section
from ..flexibility.solved import solved_gears
from ..steps import part, steps
from .cache import solved_solid, unsolved
from .curve import StiffnessCurve
from .estimate import MEAN, fixed_phases

# resolutions of the layers for the error estimate of finite elements, against the curve's; the first that carries the patches
COARSER = (0.7, 0.76, 0.83)
LESS = 2  # axial degrees less in it
# of the errors of finite elements in the edge length, at least: layers are regular; the quads of a section are not, and from one
# resolution to the next those at a hat may stay as they are
ORDER = {"layers": 2, "section": 1}
# P. J. Roache, J. Fluids Eng. 116 (1994) 405-413: 3 where two meshes are compared (layers), 1.25 where the order was seen (of
# sections on three resolutions: tests/elements/test_section_error.py)
SAFETY = {"layers": 3.0, "section": 1.25}


def wide_curves(
    forces,
    case,
    meta,
    *,
    brute,
    face,
    groove,
    refine,
    extended,
    order,
    error=False,
    flanks=None,
    supports=None,
    cache=True,
    tell=None,
):
    """`StiffnessCurve` of a pair in three dimensions under each force, by the energy model or by finite elements.

    Parameters
    ----------
    forces : sequence of float
        Along the transverse line of action [N].
    case : tuple
        ``pair, materials, phase, cracks, pits``: GearPair, two Material, ndarray, the damage of both in each gear's own frame.
    meta : dict
        Of the curve, without what is known only after the solve.
    brute : bool
        By finite elements of the whole gears, otherwise by the energy model.
    face, groove, extended
        As in `gearfe.contact.solid.pair_stiffness3d`.
    refine, order : float, int
        Of the gears; finite elements have no order.
    error : bool
        Estimate the discretisation error by longer cells along the contact lines and by other bodies, each on its own, the
        differences added. Of the energy model: by an order and a quarter of the axial degrees less. Of finite elements: by
        layers of `COARSER` resolution with `LESS` axial degrees less, and by what the section lacks in plane strain against one
        of `gearfe.elements.section_error.FINER` times its resolution. (Both apart, because the quads of a section do not get
        coarser in proportion: gmsh fills an outline, and the error stands still or jumps.) From a difference d between edges h
        and r h follows the error ``d / (r**p - 1)`` of the finer and ``r**p`` times that of the coarser, with p of `ORDER`; times
        `SAFETY`. The estimate at a phase is that of k there, or, because that can vanish by chance, the mean of those at the
        fixed phases of one base pitch about it (`estimate.fixed_phases`), whichever is larger: other phases of the list do not
        enter.
    flanks : (FlankForm, FlankForm), optional
        `geometry.pair.flanks.flank_forms`.
    supports : (Support or Shaft or None, Support or Shaft or None), optional
        Of the hubs of pinion and wheel.
    cache : bool or SolvedGears
        Where to look for what was solved before, see `gearfe.flexibility.solved.solved_gears`.
    tell
        Of the finite elements, see `gearfe.stiffness.cache.solved_solid`.

    Returns
    -------
    list of StiffnessCurve
        `pressure` is the largest of each pair's contact line, tip corners left out; nan where nothing else touches.
    """
    started = time.perf_counter()
    cache = solved_gears(cache)
    pair, materials, phase, cracks, pits = case
    options = {"pits": pits, "cracks": cracks, "cache": cache, "face": face, "groove": groove, "extended": extended}
    options |= {"flanks": flanks, "supports": supports}
    ahead = partial(_foretold, refine, cache, tell, error) if brute else None
    if brute:
        options["model"] = partial(solved_solid, refine=refine, cache=cache, tell=tell)
    else:
        options |= {"refine": refine, "order": order}
    with part("contact", 0.0, 0.6 if error else 1.0):
        found = pair_stiffness3d(pair, list(forces), materials, phase, error=error, ahead=ahead, **options)
    seconds = time.perf_counter() - started
    metas = [
        meta | {"force_N": force, "dofs": list(one.dofs), "seconds_contact": seconds}
        for force, one in zip(forces, found, strict=True)
    ]
    doubts = [None] * len(found)
    if error:
        less = (refine, cache, tell) if brute else None
        with part("estimate of the error", 0.6, 1.0):
            for i, one in enumerate(steps(found)):
                doubts[i], ratio = _doubt((pair, forces[i], materials), phase, one, options, less)
                metas[i] |= {"error_refine": ratio * refine} if brute else {}
    if any(cracks):
        for own, one in zip(metas, found, strict=True):
            own |= {"crack_closed_phases": phase[list(one.closed)].tolist()}
    for own, one in zip(metas, found, strict=True):
        if one.fillet:
            own["tip_in_fillet_phases"] = phase[list(one.fillet)].tolist()
    return [_curve(*own, flanks is not None) for own in zip(found, doubts, metas, strict=True)]


def _curve(found, doubt, meta, modified):
    """`StiffnessCurve` of a `Contact3D`."""
    pressure = np.zeros(found.load.shape)
    for i, cells in enumerate(found.cells):
        for k, order in enumerate(found.order):
            own = cells.pressure[(cells.order == order) & (cells.load > 0)]
            flat = own[np.isfinite(own)]
            pressure[i, k] = flat.max(initial=0.0) if flat.size or not own.size else np.nan
    used = found.load.max(axis=0) > 0
    return StiffnessCurve(
        phase=found.phase,
        k=found.k,
        k_tangent=found.k_tangent,
        lte=1e-3 * (found.approach - found.unloaded),
        order=found.order[used],
        force=found.load[:, used],
        pressure=1e6 * pressure[:, used],
        error=doubt,
        unloaded=1e-3 * found.unloaded if modified or found.unloaded.any() else None,
        lte_supports=None if found.supports is None else 1e-3 * found.supports,
        meta=meta,
    )


def _doubt(case, phase, found, options, brute):
    """Estimated error of k at `phase` [N/m], see `wide_curves`, and the part of the resolution it is estimated with."""
    turns = any(form.differs for form in options["flanks"] or ())
    healthy = not (any(options["cracks"]) or any(options["pits"]) or turns)
    fixed = fixed_phases(phase, healthy)
    further = fixed[np.abs(fixed[:, None] - phase).min(axis=1) > 1e-9]
    every = np.append(phase, further)
    more = pair_stiffness3d(*case, further, error=True, **options) if further.size else None
    ratio, away = 1.0, found.error
    if more is not None:
        away = np.append(away, more.error)
    if brute:
        ratio, coarse = _coarser((*case, every), options, *brute)
        k = found.k if more is None else np.append(found.k, more.k)
        finer = pair_stiffness3d(*case, every, **(options | {"model": partial(_finer_section, *brute)})).k
        along, across = ratio ** -ORDER["layers"], FINER ** ORDER["section"]
        lost, lacking = np.abs(coarse - k) / (along - 1), np.abs(finer - k) * across / (across - 1)
        away = away + SAFETY["layers"] * lost + SAFETY["section"] * lacking
    at_fixed = away[np.abs(fixed[:, None] - every).argmin(axis=1)]
    apart = np.abs(phase[:, None] - fixed)
    within = (np.abs((apart + 0.5) % 1 - 0.5) if healthy else apart) <= MEAN + 1e-9
    return np.maximum(away[: phase.size], (within * at_fixed).sum(axis=1) / within.sum(axis=1)), ratio


def _foretold(refine, cache, tell, error, bodies, *, neighbours):
    """Refuse what does not fit before the first body is solved, and `tell` what all of them take.

    `bodies` as `gearfe.contact.solid.pair_stiffness3d` gives them; with `error` the coarser ones of the estimate, too.
    """
    levels = [{"refine": refine}, {"refine": COARSER[0] * refine, "section": refine, "less": LESS}][: 1 + error]
    plans = {}
    for level in levels:
        for given, held in bodies:
            plans |= unsolved(*given, cache=cache, neighbours=neighbours, **level, **held)
    if tell and len(plans) > 1:
        seconds = float(f"{sum(one.seconds for one in plans.values()):.2g}")
        tell(f"{len(plans)} solves, about {seconds:g} s in all")


def _coarser(case, options, refine, cache, tell):
    """Part of the resolution at which coarser layers were possible, and their k."""
    for ratio in COARSER:
        less = {"refine": ratio * refine, "section": refine, "less": LESS}
        model = partial(solved_solid, cache=cache, tell=tell, **less)
        try:
            return ratio, pair_stiffness3d(*case, **(options | {"model": model})).k
        except RuntimeError as error:
            failed = error
    raise failed


def _finer_section(refine, cache, tell, gear, material, cracks=(), **options):
    """A gear of resolution `refine` whose section is finer."""
    found = solved_solid(gear, material, cracks, refine=refine, cache=cache, tell=tell, **options)
    section = {"refine": refine, "per_hat": PER_HAT, "sizes": SIZES}
    return finer_section(found, material, cracks, cache=cache, **section)

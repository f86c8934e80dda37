"""Stiffness curves of gears of finite width, from contact along their contact lines."""

import math
import time
import warnings
from functools import partial

import numpy as np

from ..contact.solid import pair_stiffness3d
from ..flexibility.solid import HAT
from ..flexibility.solved import solved_gears
from ..steps import part
from .cache import solved_solid
from .curve import StiffnessCurve
from .estimate import MEAN, fixed_phases

MORE = 1.01  # load of the second solve that gives the tangent
COARSER = (0.7, 0.76, 0.83)  # resolution of the error estimate of finite elements; the first whose section can be meshed in quads
LESS = 2  # axial degrees less in it


def wide_curve(
    force, case, meta, *, brute, face, groove, refine, extended, order, error=False, flanks=None, cache=True, tell=None
):
    """`StiffnessCurve` of a pair in three dimensions, by the energy model or by finite elements.

    Parameters
    ----------
    force : float
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
        Estimate the discretisation error by coarser bodies: of finite elements by a mesh with `COARSER` resolution and `LESS`
        axial degrees less, of the energy model by an order and `LESS` axial degrees less. The estimate at a phase is the
        difference of k there, or, because that can vanish by chance, the mean of those at the fixed phases of one base pitch
        about it (`estimate.fixed_phases`), whichever is larger: other phases of the list do not enter. Displacements approach
        their limit at least with the second power of the edges, so the difference is an upper bound.
    flanks : (FlankForm, FlankForm), optional
        `geometry.pair.flanks.flank_forms`.
    cache : bool or SolvedGears
        Where to look for what was solved before, see `gearfe.flexibility.solved.solved_gears`.
    tell
        Of the finite elements, see `gearfe.stiffness.cache.solved_solid`.

    Returns
    -------
    StiffnessCurve
        `pressure` is the largest of each pair's contact line, tip corners left out; nan where nothing else touches.
    """
    started = time.perf_counter()
    cache = solved_gears(cache)
    pair, materials, phase, cracks, pits = case
    warn_of_thin(pair)
    options = {"pits": pits, "cracks": cracks, "cache": cache, "face": face, "groove": groove, "extended": extended}
    options["flanks"] = flanks
    if brute:
        options["model"] = partial(solved_solid, refine=refine, cache=cache, tell=tell)
    else:
        options |= {"refine": refine, "order": order}
    done = 0.6 if error else 1.0
    with part("contact", 0.0, 0.7 * done):
        found = pair_stiffness3d(pair, force, materials, phase, error=error and not brute, **options)
    with part("its slope", 0.7 * done, done):
        more = pair_stiffness3d(pair, MORE * force, materials, phase, **options)
    doubt = None
    if error:
        with part("estimate of the error", done, 1.0):
            doubt, ratio = _doubt((pair, force, materials), phase, found, options, (refine, cache, tell) if brute else None)
            doubt = doubt + found.k * thin_doubt(pair, materials, found.k)
        meta = meta | ({"error_refine": ratio * refine} if brute else {})
    pressure = np.zeros(found.load.shape)
    for i, cells in enumerate(found.cells):
        for k, order in enumerate(found.order):
            own = cells.pressure[(cells.order == order) & (cells.load > 0)]
            flat = own[np.isfinite(own)]
            pressure[i, k] = flat.max(initial=0.0) if flat.size or not own.size else np.nan
    used = found.load.max(axis=0) > 0
    if any(cracks) and not brute:
        meta = meta | {"crack_closed_phases": phase[list(found.closed)].tolist()}
    return StiffnessCurve(
        phase=phase,
        k=found.k,
        k_tangent=1e3 * (MORE - 1) * force / (more.approach - found.approach),
        lte=1e-3 * (found.approach - found.unloaded),
        order=found.order[used],
        force=found.load[:, used],
        pressure=1e6 * pressure[:, used],
        error=doubt,
        unloaded=None if flanks is None else 1e-3 * found.unloaded,
        meta=meta | {"force_N": force, "dofs": list(found.dofs), "seconds_contact": time.perf_counter() - started},
    )


def thin_doubt(pair, materials, k):
    """How much too high k [N/m] of thin spur gears may be, in parts of it: they are narrower than the patches of the flanks.

    Between the width b of the face and that of a patch, ``2 HAT m_n``, flanks give way as in plane stress, ``2 / (pi E b) ln r``;
    cells see the half-space's decay there. The patch's mean has part of it, so that this is a bound and no estimate.
    """
    width, span = min(pair.gear_1.b, pair.gear_2.b), 2 * HAT * pair.gear_1.m_n
    if pair.gear_1.beta or width >= span:
        return 0.0 * k
    return 1e-3 * k * sum(2 / (math.pi * one.E * width) for one in materials) * math.log(span / width)


def warn_of_thin(pair):
    """Warn if spur gears are narrower than the patches of their flanks."""
    width, span = min(pair.gear_1.b, pair.gear_2.b), 2 * HAT * pair.gear_1.m_n
    if not pair.gear_1.beta and width < span:
        warnings.warn(
            f"spur gears of b = {width:g} mm are thinner than {span:g} mm ({2 * HAT:g} modules): k in three dimensions is 2 to "
            "6 % above plane stress; use method = 'ritz' with state = 'plane stress'",
            stacklevel=4,
        )


def _doubt(case, phase, found, options, brute):
    """Estimated error of k at `phase` [N/m], see `wide_curve`, and the part of the resolution it is estimated with."""
    turns = any(form.flank.pitch for form in options["flanks"] or ())
    healthy = not (any(options["cracks"]) or any(options["pits"]) or turns)
    fixed = fixed_phases(phase, healthy)
    further = fixed[np.abs(fixed[:, None] - phase).min(axis=1) > 1e-9]
    every = np.append(phase, further)
    more = pair_stiffness3d(*case, further, error=not brute, **options) if further.size else None
    ratio, away = 1.0, found.error
    if brute:
        ratio, coarse = _coarser((*case, every), options, *brute)
        away = np.abs(coarse - (found.k if more is None else np.append(found.k, more.k)))
    elif more is not None:
        away = np.append(away, more.error)
    at_fixed = away[np.abs(fixed[:, None] - every).argmin(axis=1)]
    apart = np.abs(phase[:, None] - fixed)
    within = (np.abs((apart + 0.5) % 1 - 0.5) if healthy else apart) <= MEAN + 1e-9
    return np.maximum(away[: phase.size], (within * at_fixed).sum(axis=1) / within.sum(axis=1)), ratio


def _coarser(case, options, refine, cache, tell):
    """Part of the resolution at which a coarser mesh was possible, and its k."""
    for ratio in COARSER:
        model = partial(solved_solid, refine=ratio * refine, cache=cache, tell=tell, less=LESS)
        try:
            return ratio, pair_stiffness3d(*case, **(options | {"model": model})).k
        except RuntimeError as error:
            failed = error
    raise failed

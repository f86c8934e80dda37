"""Stiffness curves of gears of finite width, from contact along their contact lines."""

import time
from dataclasses import replace
from functools import partial

import numpy as np

from ..contact.bodies import Bodies, energy_bodies
from ..contact.wide_contact import pair_stiffness3d
from ..core.steps import part, steps
from .cache import solved_energy, solved_solid, unsolved
from .curve import StiffnessCurve
from .estimate import MEAN, MODEL, fixed_phases
from .provenance import provenance

# resolutions of the layers for the finite element error estimate, relative to the curve's; the first valid one is used
COARSER = (0.7, 0.76, 0.83)
LESS = 2  # reduction of the axial degree in that estimate
# Lowest order of convergence of finite elements in the edge length. Layers are regular. Quads of a section are irregular, and
# those at a hat function may be unchanged at the next resolution.
ORDER = {"layers": 2, "section": 1}
# Safety factors of P. J. Roache, J. Fluids Eng. 116 (1994) 405-413: 3 for two meshes (layers), 1.25 if the order was observed
# (sections at three resolutions, tests/flexibility/test_section_error.py).
SAFETY = {"layers": 3.0, "section": 1.25}


def solid_curves(row, case, how, phase):
    """Return the `StiffnessCurve` of a pair in three dimensions for each force, by the energy model or finite elements.

    The estimate of the discretisation error (``how.error``) is the sum of two differences: from longer cells along the contact
    lines, and from coarser bodies. For the energy model these have an order one lower and three quarters of the axial degrees.
    For finite elements they have layers of `COARSER` resolution and `LESS` axial degrees less. The missing flexibility of the
    section in plane strain, relative to `finite_elements.section_error.FINER` times its resolution, is a separate part, because
    gmsh does not coarsen quads in proportion. A difference d between edges h and r h means an error of ``d / (r**p - 1)`` of
    the finer solution, with p from `ORDER`, multiplied by `SAFETY`. The error of the coarser one is ``r**p`` times as large.
    The estimate at a phase is that of k there or the mean of those at the fixed phases of one base pitch about it
    (`estimate.fixed_phases`), whichever is larger. Other phases of the list have no effect. The model error of the contact laws
    is added: `estimate.MODEL`, and sliding along cracked teeth at corners, and motion if no contact on the path carries load
    (`PhaseContact`).

    `pressure` is the largest of each pair's contact line without tip corners; nan if only corners touch.
    """
    started = time.perf_counter()
    written = {"face": case.runs, "groove": case.groove, "extended": how.extended, "refine": how.refine}
    order = row.order if how.order is None else how.order
    meta = provenance(case, row.name, written | ({"order": order} if row.order else {}))
    bodies = _bodies(how) if row.brute else energy_bodies(order, refine=how.refine, cache=how.cache, solve=solved_energy)
    options = {"bodies": bodies, "extended": how.extended, "cache": how.cache}
    with part(row.name, 0.0, 1.0), part("contact", 0.0, 0.6 if how.error else 1.0):
        contacts = pair_stiffness3d(replace(case, force=case.forces), phase, error=how.error, **options)
    costs = {"dofs": list(contacts[0].dofs), "seconds_contact": time.perf_counter() - started}
    costs |= {"seconds_gears": contacts[0].seconds}
    curves = [
        _curve(contact, meta | {"force_N": force} | costs, case) for force, contact in zip(case.forces, contacts, strict=True)
    ]
    if not how.error:
        return curves
    with part("estimate of the error", 0.6, 1.0):
        for i, contact in enumerate(steps(contacts)):
            doubt, ratio = _doubt(replace(case, force=case.forces[i]), phase, contact, options, how if row.brute else None)
            resolution = {"error_refine": ratio * how.refine} if row.brute else {}
            curves[i] = replace(curves[i], error=doubt, meta=curves[i].meta | resolution)
    return curves


def _curve(found, meta, case):
    """Return the `StiffnessCurve` of a `Contact3D`."""
    if any(case.cracks):
        meta |= {"crack_closed_phases": found.phase[list(found.closed)].tolist()}
    if found.fillet:
        meta |= {"tip_in_fillet_phases": found.phase[list(found.fillet)].tolist()}
    pressure = np.zeros(found.load.shape)
    for i, cells in enumerate(found.cells):
        for k, order in enumerate(found.order):
            of_pair = cells.pressure[(cells.order == order) & (cells.load > 0)]
            flat = of_pair[np.isfinite(of_pair)]
            pressure[i, k] = flat.max(initial=0.0) if flat.size or not of_pair.size else np.nan
    used = found.load.max(axis=0) > 0
    return StiffnessCurve(
        phase=found.phase,
        k=found.k,
        k_tangent=found.k_tangent,
        deflection=1e-3 * (found.approach - found.unloaded),
        order=found.order[used],
        force=found.load[:, used],
        pressure=1e6 * pressure[:, used],
        unloaded=1e-3 * found.unloaded if case.forms is not None or found.unloaded.any() else None,
        support_deflection=None if found.supports is None else 1e-3 * found.supports,
        meta=meta,
    )


def _doubt(case, phase, found, options, brute):
    """Return the estimated error of k at `phase` [N/m], see `solid_curves`, and the relative resolution of the coarser solve.

    `brute` are the options of finite elements (a `Solve`), or None for the energy model.
    """
    healthy = not (case.damaged or any(form.differs for form in case.forms or ()))
    fixed = fixed_phases(phase, healthy)
    further = fixed[np.abs(fixed[:, None] - phase).min(axis=1) > 1e-9]
    phases = np.append(phase, further)
    further_contact = pair_stiffness3d(case, further, error=True, **options) if further.size else None
    ratio, away = 1.0, found.error
    if further_contact is not None:
        away = np.append(away, further_contact.error)
    if brute:
        from ..flexibility.finite_elements.section_error import FINER

        ratio, coarse = _coarser(case, phases, options, brute)
        k = found.k if further_contact is None else np.append(found.k, further_contact.k)
        finer = pair_stiffness3d(case, phases, **(options | {"bodies": Bodies(partial(_finer_section, brute))})).k
        along, across = ratio ** -ORDER["layers"], FINER ** ORDER["section"]
        lost, lacking = np.abs(coarse - k) / (along - 1), np.abs(finer - k) * across / (across - 1)
        away = away + SAFETY["layers"] * lost + SAFETY["section"] * lacking
    at_fixed = away[np.abs(fixed[:, None] - phases).argmin(axis=1)]
    apart = np.abs(phase[:, None] - fixed)
    within = (np.abs((apart + 0.5) % 1 - 0.5) if healthy else apart) <= MEAN + 1e-9
    doubt = np.maximum(away[: phase.size], (within * at_fixed).sum(axis=1) / within.sum(axis=1))
    return doubt + found.off_path + MODEL * found.k, ratio


def _bodies(how):
    """Return `Bodies` that solve whole gears by finite elements."""
    return Bodies(partial(solved_solid, refine=how.refine, cache=how.cache, tell=how.tell), ahead=partial(_foretold, how))


def _foretold(how, bodies, *, neighbours):
    """Raise RuntimeError if a body does not fit into memory, before the first solve.

    Report the cost of all, with those of an estimate.
    """
    levels = [{"refine": how.refine}, {"refine": COARSER[0] * how.refine, "section": how.refine, "less": LESS}][: 1 + how.error]
    plans = {}
    for level in levels:
        for body, held in bodies:
            plans |= unsolved(*body, cache=how.cache, neighbours=neighbours, **level, **held)
    if how.tell and len(plans) > 1:
        seconds = float(f"{sum(plan.seconds for plan in plans.values()):.2g}")
        how.tell(f"{len(plans)} solves, about {seconds:g} s in all")


def _coarser(case, phase, options, how):
    """Return the relative resolution at which coarser layers were possible, and their k."""
    for ratio in COARSER:
        less = {"refine": ratio * how.refine, "section": how.refine, "less": LESS}
        bodies = Bodies(partial(solved_solid, cache=how.cache, tell=how.tell, **less))
        try:
            return ratio, pair_stiffness3d(case, phase, **(options | {"bodies": bodies})).k
        except RuntimeError as error:
            failed = error
    raise failed


def _finer_section(how, gear, material, damage=(), **options):
    """Return a gear corrected by a section of higher resolution."""
    from ..flexibility.finite_elements.section_error import finer_section

    flexibility = solved_solid(gear, material, damage, refine=how.refine, cache=how.cache, tell=how.tell, **options)
    return finer_section(flexibility, material, damage, refine=how.refine, cache=how.cache)

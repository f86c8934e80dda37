"""Stiffness curves of plane contact, from the flexibilities of two sections or from independent tooth pairs."""

import time
from dataclasses import asdict, replace

import numpy as np

from ..contact.pair_contact import PairContact
from ..core.steps import part, steps
from ..flexibility.energy.closed.plain_sum import plain_sum
from ..geometry.pair.contacts import neighbours_of
from .curve import StiffnessCurve
from .estimate import MODEL, estimate, fixed_phases, other_solves
from .own_flexibility import flexibility_of
from .provenance import provenance
from .supported import yielding


def sum_curves(row, case, how, phase):
    """Return the curves of independent tooth pairs in parallel, one for each load."""
    variants = how.variants or {}
    solve, details = plain_sum(case, phase, row.load(), **variants)
    options = variants | {"face": case.face or "spur", "groove": case.groove}
    options |= {"outside": [asdict(place) for place in details["outside"]]}
    meta = provenance(case, row.name, options)
    return [curve(case, phase, force, yielding(solve, case), meta) for force in case.forces]


def section_curves(row, case, how, phase):
    """Return curves of two sections in contact, one per load, with estimated errors on request."""
    with part(row.name, 0.0, 0.4 if how.error else 1.0):
        solve, details = section_solver(row, case, how, phase)
    meta = provenance(case, row.name, details)
    curves = [curve(case, phase, force, solve, meta) for force in case.forces]
    if not how.error:
        return curves
    with part("estimate of the error", 0.4, 1.0):
        return with_error(row, curves, case, how)


def section_solver(row, case, how, phase, hats=1.0, **coarser):
    """Return `solve` of two sections (line load [N/mm] to `gearfe.contact.pair_contact.Solved`), and its entries of `meta`.

    At phases ``(n,)``; hat functions at corners are `hats` times as long as those of the method. `coarser` are ``refine`` and
    ``order`` of an estimate, instead of those of `how`.
    """
    started = time.perf_counter()
    model, pair, numeric = row.own, case.pair, _numeric(row, how) | coarser
    extended = how.extended and (model or row).extended
    neighbours = neighbours_of(pair)

    def named(row, gear, material, cracks=(), broken=()):
        options = {"neighbours": neighbours, "state": how.state, **numeric}
        options |= {"broken": broken} if broken else {}
        options |= {"cache": how.cache} if row.kept else {}
        return row.load()(gear, material, *((cracks,) if row.cracks else ()), **options)

    gears = list(zip(pair.gears, case.materials, case.cracks, case.broken, strict=True))
    if model is None:
        flexible = [named(row, *gear) for gear in steps(gears)]
    else:
        flexible = [flexibility_of(model, i, gear, material, how.state, named) for i, (gear, material, *_) in enumerate(gears)]
    if hats != 1:
        flexible = [replace(body, fine=hats * body.fine) for body in flexible]
    contact = PairContact(pair, case.materials, flexible, phase, extended=extended, state=how.state, flanks=case.forms)
    details = {"state": how.state, "extended": extended, **numeric, **(model.told() if model else {})}
    if row.kept == "disk":
        details |= {"seconds_gears": sum({f.seconds for f in flexible})}
    if row.converged:
        details |= {"dofs": [f.dofs for f in flexible], "seconds_flexibility": time.perf_counter() - started}
    return yielding(contact.solve, case), details


def _numeric(row, how):
    """Return refine, order and teeth, as far as the method has these options."""
    has = {"refine": row.converged, "order": row.order is not None, "teeth": row.teeth}
    order = row.order if how.order is None else how.order
    return {name: value for name, value in (("refine", how.refine), ("order", order), ("teeth", how.teeth)) if has[name]}


def curve(case, phase, force, solve, meta):
    """Return the `StiffnessCurve` under a force [N] along the line of action.

    Values per width in N and mm are converted to SI units here. `solve` maps the line load [N/mm] to
    `gearfe.contact.pair_contact.Solved` at the phases ``(n,)``. `meta` is without the force.
    """
    started = time.perf_counter()
    width = case.pair.b_w
    solved = solve(force / width)
    used = solved.line_load.max(axis=0) > 0
    unloaded = None if solved.unloaded is None else solved.unloaded * 1e-3
    meta = meta | {"force_N": force, "seconds_contact": time.perf_counter() - started}
    if case.damaged:
        meta["crack_closed_phases"] = phase[list(solved.closed)].tolist()
    if solved.fillet:
        meta["tip_in_fillet_phases"] = phase[list(solved.fillet)].tolist()
    return StiffnessCurve(
        phase=phase,
        k=force / (solved.closing * 1e-3),
        k_tangent=solved.tangent * width * 1e3,
        deflection=solved.closing * 1e-3,
        order=solved.order[used],
        force=solved.line_load[:, used] * width,
        pressure=solved.pressure[:, used] * 1e6,
        meta=meta,
        unloaded=unloaded,
        support_deflection=None if solved.supports is None else solved.supports * 1e-3,
    )


def with_error(row, curves, case, how):
    """Return the curves with error estimates from other solves of the same case."""
    order = _numeric(row, how).get("order")
    periodic = not (case.damaged or any(form.differs for form in case.forms or ()))
    phase = curves[0].phase
    where = np.append(phase, fixed_phases(phase, periodic))
    solvers = [section_solver(row, case, how, where, **options)[0] for options in steps(({}, *other_solves(how.refine, order)))]
    out = []
    width = case.pair.b_w
    for fine in curves:
        solved = [solve(fine.meta["force_N"] / width) for solve in solvers]
        k = (fine.meta["force_N"] / (1e-3 * contact.closing) for contact in solved)
        doubt = estimate(phase, periodic, *k, energy=order is not None)
        contact = fine.k * (MODEL + solved[0].left_out[: phase.size])
        meta = fine.meta | {"error_of_contact": contact.tolist()}
        out.append(replace(fine, error=doubt + contact, meta=meta))
    return out

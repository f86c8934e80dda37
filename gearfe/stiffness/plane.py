"""Stiffness curves of plane contact: from the flexibilities of two sections, or from a plain sum of tooth pairs."""

import math
import time
import warnings
from dataclasses import asdict, replace

import numpy as np

from geometry.pair.contacts import near_pitches

from ..contact.plane import PairContact
from ..energy.closed.plain_sum import plain_sum
from ..steps import steps
from .curve import StiffnessCurve
from .estimate import coarser, estimate, finer_hats, fixed_phases
from .own_flexibility import flexibility_of
from .supported import yielding

MODEL = (
    1e-3  # of k: what the section's contact was off the pressed whole outlines where no mesh is to blame, in nine of ten phases
)


def sum_solver(row, pair, materials, phase, *, cracks, pits, variants, face, groove, flanks=None, yields=None):
    """`solve` of a plain sum (line load [N/mm] to `gearfe.contact.plane.Solved`), and what `meta` says of it."""
    options = {**variants, "face": face, "groove": groove}
    solve, details = plain_sum(pair, materials, phase, row.load(), cracks=cracks, pits=pits, flanks=flanks, **options)
    return yielding(solve, yields), options | {"outside": [asdict(one) for one in details["outside"]]}


def section_solver(
    row, own, pair, materials, phase, *, cracks, extended, state, cache, flanks=None, yields=None, hats=1.0, **numeric
):
    """`solve` of two sections in contact (line load [N/mm] to `gearfe.contact.plane.Solved`), and what `meta` says of it.

    Parameters
    ----------
    row : Method
    own : OwnFlexibility or None
        Instead of the flexibility of `row`.
    pair : GearPair
    materials : (Material, Material)
    phase : ndarray
    cracks : (tuple, tuple)
    extended : bool
        Where the method knows of tip corners.
    state : str
    cache : SolvedGears
        Where solved gears are looked up and kept.
    flanks : (FlankForm, FlankForm), optional
        Modifications, `geometry.tooth.modified.flank_forms`.
    yields : float, optional
        Approach by the supports of the hubs per line load [mm per N/mm].
    hats : float
        How many times shorter than those of the method the hats at corners are.
    **numeric
        ``refine``, ``order``, ``teeth``: each method gets those that it has.
    """
    started = time.perf_counter()
    extended = extended and (own or row).extended
    neighbours = math.ceil(pair.eps_alpha) + sum(near_pitches(pair)) - 2

    def named(row, gear, material, cracks=()):
        return _flexibility(row, gear, material, cracks, neighbours, state, cache, numeric)

    gears = list(zip((pair.gear_1, pair.gear_2), materials, cracks, strict=True))
    if own is None:
        flexible = [named(row, gear, material, found) for gear, material, found in steps(gears)]
    else:
        flexible = [flexibility_of(own, i, gear, material, state, named) for i, (gear, material, _) in enumerate(gears)]
    if hats != 1:
        flexible = [replace(one, fine=hats * one.fine) for one in flexible]
    contact = PairContact(pair, materials, flexible, phase, extended=extended, state=state, flanks=flanks)
    details = {"state": state, "extended": extended, **_numeric(row, numeric), **(own.told() if own else {})}
    if row.converged:
        details |= {"dofs": [f.dofs for f in flexible], "seconds_flexibility": time.perf_counter() - started}
    return yielding(contact.solve, yields), details


def _numeric(row, given):
    """Of refine, order (None: the method's own) and teeth those that a method has."""
    order = row.order if given["order"] is None else given["order"]
    has = {"refine": row.converged, "order": row.order is not None, "teeth": row.teeth}
    return {name: value for name, value in (given | {"order": order}).items() if has.get(name)}


def _flexibility(row, gear, material, cracks, neighbours, state, cache, numeric):
    """`Flexibility` of one gear by a method."""
    own = (cracks,) if row.cracks else ()
    kept = {"cache": cache} if row.kept else {}
    return row.load()(gear, material, *own, neighbours=neighbours, state=state, **kept, **_numeric(row, numeric))


def curve(pair, phase, force, solve, meta, damage=None):
    """`StiffnessCurve` under a force [N] along the line of action; warns if no tooth with `damage` is in contact.

    To SI, in one place: widths and millimetres become newtons and metres here.

    Parameters
    ----------
    pair : GearPair
    phase : ndarray
    force : float
    solve : callable
        From the line load [N/mm] to `gearfe.contact.plane.Solved`.
    meta : dict
        Without the force.
    damage : (sequence, sequence), optional
        Cracks and pits of pinion and wheel, teeth numbered in each gear's own frame.
    """
    started = time.perf_counter()
    width = min(pair.gear_1.b, pair.gear_2.b)
    solved = solve(force / width)
    used = solved.line_load.max(axis=0) > 0
    unloaded = None if solved.unloaded is None else solved.unloaded * 1e-3
    meta = meta | {"force_N": force, "seconds_contact": time.perf_counter() - started}
    if damage is not None:
        _warn_if_unseen(pair, damage, solved.order[used])
        meta["crack_closed_phases"] = phase[list(solved.closed)].tolist()
    if solved.fillet:
        meta["tip_in_fillet_phases"] = phase[list(solved.fillet)].tolist()
    return StiffnessCurve(
        phase=phase,
        k=force / (solved.closing * 1e-3),
        k_tangent=solved.tangent * width * 1e3,
        lte=solved.closing * 1e-3,
        order=solved.order[used],
        force=solved.line_load[:, used] * width,
        pressure=solved.pressure[:, used] * 1e6,
        meta=meta,
        unloaded=unloaded,
        lte_supports=None if solved.supports is None else solved.supports * 1e-3,
    )


def with_error(row, curves, case, options):
    """The curves with their estimated error, by other solves of the same `case` of `section_solver`."""
    pair, materials, phase = case
    order = _numeric(row, options).get("order")
    less, hats = coarser(options["refine"], order), finer_hats(order)
    turns = any(form.differs for form in options.get("flanks") or ())
    periodic = not (any(options["cracks"]) or turns)
    where = np.append(phase, fixed_phases(phase, periodic))
    solvers = [section_solver(row, None, pair, materials, where, **(options | one))[0] for one in steps(({}, *less, *hats))]
    out = []
    width = min(pair.gear_1.b, pair.gear_2.b)
    for one in curves:
        solved = [solve(one.meta["force_N"] / width) for solve in solvers]
        k, *others = (one.meta["force_N"] / (1e-3 * each.closing) for each in solved)
        doubt = estimate(phase, periodic, k, others[: len(less)], others[len(less) :])
        out.append(replace(one, error=doubt + one.k * (MODEL + solved[0].left_out[: phase.size])))
    return out


def _warn_if_unseen(pair, damage, order):
    """Warn if no damaged tooth is in contact at any of the phases."""
    gears = ((pair.gear_1, 1, damage[0]), (pair.gear_2, -1, damage[1]))
    if not any(sense * one.tooth % gear.z in order % gear.z for gear, sense, found in gears for one in found):
        warnings.warn(
            "no cracked tooth is in contact at these phases: tooth k is at phases from -k; use span='tooth' for tooth 0",
            stacklevel=4,
        )

"""Curves of cases by several methods, timed, with the errors of the losses, as a `Comparison`."""

import time
from dataclasses import replace

from ..core.case import Case
from ..core.steps import steps
from ..stiffness.curve import StiffnessCurve
from ..stiffness.methods import fitted
from ..stiffness.solve import Solve, solve
from .comparison import Comparison
from .losses import loss_errors, told_damage, within

COST = {"fe3d": 30.0, "ritz3d": 3.0, "fe": 3.0}  # approximate CPU time per curve [s], for the estimate of the remaining time


def compared(plan, asked, methods, how, cycles=None, *, fresh=False, known=None, left_out=None):
    """Return the `Comparison` of cases at their phases (`plan`, by key). The first of the `methods` is the reference.

    `how` is a `Solve` without method and phases. With `fresh`, the curves of the keys in `asked` are timed without stored
    solutions of gears, and error estimates are computed afterwards. `known` are available curves with their computing times
    [s].
    """
    solved, seconds, left_out, known, reference = {}, {}, left_out or {}, known or {}, methods[0]
    work, cost = _work(plan, asked if fresh else (), methods, known)
    for key, method, again in steps(work, lambda item: f"{_told(item[0], ', ')}: {item[1]}", cost):
        place = (*key, method)
        if place in known:
            solved[place], seconds[place] = known[place]
            continue
        case, phases = plan[key]
        timed = fresh and key in asked and not again
        own = replace(_one_method(how, method, reference, fresh, again), phases=phases, cache=not timed and how.cache)
        own = replace(own, error=own.error and not timed)
        started = time.perf_counter()
        try:
            solved[place] = solve_fitted(case, own)
        except ValueError as error:
            if method == reference:
                raise
            left_out[method if len(asked) == 1 else f"{method} of {_told(key)}"] = str(error)
        else:
            seconds.setdefault(place, time.perf_counter() - started)
    cases, phases = ({key: one[k] for key, one in plan.items()} for k in (0, 1))
    known = {key: replace(how, method=reference, phases=phases[key]) for key in asked if key[1]}
    teeth = {key: _losses(cases[key], key, solved, own, cycles) for key, own in known.items()}
    return Comparison(cases, asked, solved, seconds, teeth, left_out)


def _told(key, between=" "):
    return f"{key[0]}{between}{key[1] or 'healthy'}"


def _one_method(how, method, reference, fresh, again):
    """Return the `Solve` of a method. Error estimates are computed after the timed curves, except those of `fe3d`."""
    if method != reference:
        return replace(how, method=method, error=False, refine=1.0 if fresh else how.refine)
    return replace(how, method=method, error=how.error and (again or not fresh or method == "fe3d"))


def _work(plan, timed, methods, known):
    """Return key, method, whether the curve is a repetition for the error estimate, and relative cost of each curve."""
    work = [(key, method, False) for key in plan for method in methods] + [(key, methods[0], True) for key in timed]
    return work, [0.0 if (*key, name) in known else COST.get(name, 0.3) * (1 + again) for key, name, again in work]


def _losses(case, key, solved, how, cycles):
    """Phases of the zones and errors of the losses, by the words for each damaged tooth."""
    out = {}
    for words, cycle in (cycles or {told_damage(case.pair, case.damage): None}).items():
        curves = (within(solved[key[0], which, how.method], cycle) for which in (None, key[1]))
        rough = replace(how, phases=how.phases if cycle is None else cycle, error=False)
        out[words] = cycle, loss_errors(*curves, case, rough) if how.error else {}
    return out


def solve_fitted(case: Case, how: Solve) -> StiffnessCurve:
    """Curve of a case by a method as far as the method models it (`gearfe.stiffness.methods.fitted`)."""
    known, variants, _ = fitted(how.method, case)
    return solve(known, replace(how, variants=variants))

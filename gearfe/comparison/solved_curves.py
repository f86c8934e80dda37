"""Curves of cases by several methods, with computing times and errors of the losses, as a `Comparison`."""

import time
from dataclasses import replace

from ..core.case import Case
from ..core.steps import steps
from ..flexibility.solved import GEARS, PROCESS
from ..stiffness.cost import curve_cost
from ..stiffness.curve import StiffnessCurve
from ..stiffness.methods import fitted
from ..stiffness.solve import Solve, solve
from .comparison import Comparison
from .losses import kind_of, loss_errors, told_damage, within


def compared(plan, asked, methods, how, cycles=None, *, fresh=False, known=None, left_out=None):
    """Return the `Comparison` of cases at their phases (`plan`, by key). The first of the `methods` is the reference.

    `how` is a `Solve` without method and phases. With `fresh`, the curves of the keys in `asked` are timed as if no gear was
    solved before. Gears of the reference are solved once: those solved earlier count with the time of their solve. `known` are
    available curves with their computing times [s].
    """
    solved, seconds, left_out, known, reference = {}, {}, left_out or {}, known or {}, methods[0]
    work, cost = _work(plan, asked if fresh else (), methods, known)
    for key, method, again in steps(work, lambda item: f"{_told(item[0], ', ')}: {item[1]}", cost):
        place = (*key, method)
        if place in known:
            solved[place], seconds[place] = known[place]
            continue
        case, phases = plan[key]
        own = replace(how, method=method, phases=phases, error=how.error and method == reference and not again)
        if again:
            own = replace(own, cache=PROCESS.of(GEARS))
        elif fresh and method != reference:
            own = replace(own, refine=1.0, cache=key not in asked and how.cache)
        started = time.perf_counter()
        try:
            curve = solve_fitted(case, own)
        except ValueError as error:
            if method == reference:
                raise
            left_out[method if len(asked) == 1 else f"{method} of {_told(key)}"] = str(error)
            continue
        seconds[place] = time.perf_counter() - started
        if again:
            seconds[place] += curve.meta["seconds_gears"]
        else:
            solved[place] = curve
    cases, phases = ({key: one[k] for key, one in plan.items()} for k in (0, 1))
    known = {key: replace(how, method=reference, phases=phases[key]) for key in asked if key[1]}
    teeth = {key: _losses(cases[key], key, solved, own, cycles) for key, own in known.items()}
    return Comparison(cases, asked, solved, seconds, teeth, left_out)


def _told(key, between=" "):
    return f"{key[0]}{between}{key[1] or 'healthy'}"


def _work(plan, timed, methods, known):
    """Return key, method, whether the curve is a repeat for timing, and expected time of each curve [s].

    The reference is repeated with solved gears and without estimate of the error.
    """
    work = [(key, method, False) for key in plan for method in methods] + [(key, methods[0], True) for key in timed]
    times = {(key, name): curve_cost(case, Solve(), name).seconds for key, (case, _) in plan.items() for name in methods}
    return work, [0.0 if (*key, name) in known else times[key, name] * (0.1 if again else 1.0) for key, name, again in work]


def _losses(case, key, solved, how, cycles):
    """Return the phases of the zones, the errors of the losses and the kind, by the words for each damaged tooth."""
    out = {}
    for words, (cycle, kind) in (cycles or {told_damage(case.pair, case.damage): (None, kind_of(case.damage))}).items():
        curves = (within(solved[key[0], which, how.method], cycle) for which in (None, key[1]))
        rough = replace(how, phases=how.phases if cycle is None else cycle, error=False)
        out[words] = cycle, loss_errors(*curves, case, rough) if how.error else {}, kind
    return out


def solve_fitted(case: Case, how: Solve) -> StiffnessCurve:
    """Return the curve of a case by a method. Parts of the case that the method does not model are left out."""
    known, variants, _ = fitted(how.method, case)
    return solve(known, replace(how, variants=variants))

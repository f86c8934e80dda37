"""All pairs of a scene in all their cases of damage: stiffness by each method beside finite elements, and what damage takes."""

import time
import warnings
from dataclasses import dataclass, replace

import numpy as np

from ..core.case import overlap
from ..core.markdown import table_row
from ..core.steps import steps
from ..core.units import in_newton_per_um
from ..scene.parts import DAMAGE
from ..scene.stored import read_curves
from ..scene.verdicts import judge, text
from ..stiffness.methods import METHODS, SUMS, fitted
from ..stiffness.solve import Solve, solve
from .losses import damage_phases

PHASES = 32  # of the cycle of curves on file
COST = {"fe3d": 30.0, "ritz3d": 3.0, "fe": 1.0}  # about, of a curve, in CPU seconds: for the time left


@dataclass(frozen=True, slots=True)
class CaseCurve:
    """Stiffness over the cycle in which the damaged tooth is in the middle of its engagement.

    `k` ``(n,)`` of the mesh and `tooth` ``(n,)`` of the damaged tooth's own pair, its force over the common approach [N/m];
    `seconds` it took, when it was computed; `estimate` of the relative error of the mean, nan if there is none.
    """

    k: np.ndarray
    tooth: np.ndarray
    seconds: float
    estimate: float

    @property
    def mean(self):
        """Mean over the cycle [N/m]."""
        return float(self.k.mean())

    @property
    def largest(self):
        """Maximum over the cycle [N/m]."""
        return float(self.k.max())


@dataclass(frozen=True, slots=True)
class CaseTable:
    """Curves by (pair, case, method) for every pair and case of a scene; case None is healthy, `reference` names a method."""

    phases: dict
    curves: dict
    methods: tuple
    reference: str

    def cases(self):
        """(pair, case) in order."""
        return list(dict.fromkeys((pair, case) for pair, case, _ in self.curves))

    def errors(self, pair, case, method):
        """Relative errors of a method against the reference: of the mean, of the maximum, and the largest at one phase."""
        truth, curve = (self.curves[pair, case, name] for name in (self.reference, method))
        return curve.mean / truth.mean - 1, curve.largest / truth.largest - 1, float(np.abs(curve.k / truth.k - 1).max())

    def drops(self, pair, case, method):
        """What damage takes of the stiffness [-]: largest over the cycle, of the mean, and of the damaged tooth's own pair.

        The last is the mean of its pair's own stiffness over the cycle.
        """
        healthy, hurt = (self.curves[pair, which, method] for which in (None, case))
        return (
            float((1 - hurt.k / healthy.k).max()),
            1 - hurt.mean / healthy.mean,
            1 - float(hurt.tooth.mean() / healthy.tooth.mean()),
        )

    def table(self):
        """Markdown: per pair and case the reference, and every method's error of the mean and of the maximum."""
        others = [name for name in self.methods if name != self.reference]
        lines = [
            f"| pair | case | {self.reference} mean [N/um] | max [N/um] | "
            + " | ".join(f"{name} mean | max" for name in others) + " |",
            "|---" * (4 + 2 * len(others)) + "|",
        ]  # fmt: skip
        for pair, case in self.cases():
            truth = self.curves[pair, case, self.reference]
            cells = [_percent(error, "+.1f") for name in others for error in self.errors(pair, case, name)[:2]]
            head = [pair, case or "healthy", in_newton_per_um(truth.mean, 5), in_newton_per_um(truth.largest, 5)]
            lines.append(table_row([*head, *cells]))
        total = [sum(self.curves[pair, case, name].seconds for pair, case in self.cases()) for name in self.methods]
        return "\n".join([*lines, f"| seconds |  | {' | '.join(f'{seconds:.1f} | ' for seconds in total)} |"])

    @property
    def headline(self):
        """The case that takes most of the mean stiffness, in one sentence."""
        hurt = [key for key in self.cases() if key[1] is not None]
        pair, case = max(hurt, key=lambda key: self.drops(*key, self.reference)[1])
        largest, mean, _ = self.drops(pair, case, self.reference)
        return f"{pair}, {case}: takes most, up to {100 * largest:.1f} % of the mesh stiffness, {100 * mean:.1f} % of its mean"

    def drop_table(self):
        """Markdown: what each case takes, largest over the cycle and of the mean over it, by method."""
        columns = [f"{name} largest | mean" for name in self.methods]
        lines = ["| pair | case | " + " | ".join(columns) + " |", "|---" * (2 + 2 * len(self.methods)) + "|"]
        for pair, case in self.cases():
            if case is not None:
                cells = [_percent(drop, ".1f") for name in self.methods for drop in self.drops(pair, case, name)[:2]]
                lines.append(table_row([pair, case, *cells]))
        return "\n".join(lines)


def _percent(value, form):
    return "none" if np.isnan(value) else f"{100 * value:{form}} %"


def printed_beside(scene, published, reference, drops):
    """Our values for the stiffnesses that the source of a scene prints, by id of its reference, for `judge`.

    By (case, pair), case "healthy" without damage: mean stiffness [N/m] by the source's own formulas (`published`) and by the
    `reference`, and the largest loss of stiffness [%] (`drops`). The printed errors are recomputed from the printed (corrected)
    stiffnesses. Empty without such rows.
    """
    ids = {"stiffness_analytical": published, "stiffness_fe": reference, "stiffness_reduction": drops}
    targets = {entry.id: {(row.case, row.pair): row.target for row in entry.rows} for entry in scene.references}
    if not all(name in targets for name in (*ids, "stiffness_error")):
        return {}
    analytical, by_fe = targets["stiffness_analytical"], targets["stiffness_fe"]
    return ids | {
        "stiffness_error": {key: round(100 * abs(analytical[key] - by_fe[key]) / analytical[key], 2) for key in analytical}
    }


def printed_cases(scene):
    """(pair, case) of the stiffnesses that the source of a scene prints for healthy and damaged gears; none if it does not."""
    rows = [row for reference in scene.references if reference.id == "stiffness_fe" for row in reference.rows]
    return [(row.pair, None if row.case == "healthy" else row.case) for row in rows]


def printed_text(scene, table):
    """The source's own table of stiffness beside a `CaseTable`, as Markdown with verdicts; empty if it prints none."""
    means = {
        name: {(case or "healthy", pair): table.curves[pair, case, name].mean for pair, case in table.cases()}
        for name in ("published", table.reference)
    }
    drops = {(case, pair): 100 * table.drops(pair, case, table.reference)[0] for pair, case in table.cases() if case}
    ours = printed_beside(scene, means["published"], means[table.reference], drops)
    printed = [reference for reference in scene.references if reference.id in ours]
    return text(printed, [row for entry in printed for row in judge(entry, ours[entry.id])]) if printed else ""


def damage_cycle(chosen):
    """Phases ``(PHASES,)`` of curves on file: of the cycle in which tooth 0 of a pair is in the middle of its engagement."""
    length = chosen.pair.eps_alpha + overlap(chosen.pair, chosen.face, chosen.groove)
    return length / 2 - 0.5 + (np.arange(PHASES) + 0.5) / PHASES


def is_wide(chosen):
    """Whether a scene's pair needs three dimensions in any of its cases."""
    return any(chosen.case(case).why_wide for case in (None, *chosen.damage))


def case_curve(case, how):
    """`CaseCurve` of a `Case` as a `Solve` states, as far as its method models it."""
    known, variants, _ = fitted(how.method, case)
    started = time.perf_counter()
    curve = solve(known, replace(how, variants=variants))
    seconds = time.perf_counter() - started
    columns = np.flatnonzero(curve.order == (known.first_tooth or 0))
    tooth = curve.force[:, columns].sum(axis=1) / curve.lte
    doubt = float("nan") if curve.error is None else float((curve.error / curve.k).mean())
    return CaseCurve(curve.k, tooth, seconds, doubt)


def case_table(scene, cases=None, *, phases=64, compute=False, progress=None):
    """`CaseTable`: every pair and case of a scene by every method that has it.

    The reference is finite elements: of the section where that is the whole truth, else of the whole gears in three dimensions.
    The latter take minutes a gear: those of a built-in scene are read from the file that comes with it; without one for just
    these gears, loads and damages, the energy model `ritz3d` is the reference unless `compute` asks for them.

    `cases` are (pair, case), each pair with None (healthy) too; default all, pairs without damage too. `phases` counts those of
    the mesh cycle; where curves on file are read, theirs. `progress` gets a text before each solve. Formulas that have no value
    for a damage have nan; a warning says why. ValueError if the scene has no damage.
    """
    if not any(pair.damage for pair in scene.pairs.values()):
        names = " or ".join(f"[[{name}]]" for name in DAMAGE)
        raise ValueError(f"scene {scene.name} has no cases of damage: add {names} tables")
    wide = any(is_wide(pair) for pair in scene.pairs.values())
    stored = read_curves(scene) if wide else {}
    wanted = [(name, case) for name, pair in scene.pairs.items() for case in (None, *pair.damage)]
    wanted = wanted if cases is None else list(cases)
    solid = wide and (compute or all(key in stored for key in wanted))
    reference = "fe3d" if solid else "ritz3d" if wide else "fe"
    methods = (*dict.fromkeys([reference, "ritz3d" if wide else "ritz"]), *SUMS)
    taken = {(key, "fe3d") for key in stored}
    phases_of = damage_cycle if stored else (lambda chosen: damage_phases(chosen.case(), phases))
    curves, cycles = {}, {name: phases_of(chosen) for name, chosen in scene.pairs.items()}
    work = [(name, case, method) for name, case in wanted for method in methods]
    cost = [0.0 if (key[:2], key[2]) in taken else COST.get(key[2], 0.1) for key in work]
    for name, case, method in steps(work, lambda key: f"{key[0]} {key[1] or 'healthy'}: {key[2]}", cost):
        if ((name, case), method) in taken:
            _, k, tooth, estimate, seconds = stored[name, case]
            curves[name, case, method] = CaseCurve(k, tooth, seconds, estimate)
            continue
        if progress:
            progress(f"{name} {case or 'healthy'}: {method}")
        try:
            given = scene.case(name, case)
            curves[name, case, method] = case_curve(given, Solve(method, cycles[name] - (given.first_tooth or 0)))
        except ValueError as error:
            if METHODS[method].converged:
                raise
            warnings.warn(f"{method} has no value for {name} {case or 'healthy'}: {error}", stacklevel=2)
            nothing = np.full(cycles[name].size, np.nan)
            curves[name, case, method] = CaseCurve(nothing, nothing, 0.0, np.nan)
    return CaseTable(cycles, curves, methods, reference)

"""`Comparison`: stiffness of pairs in cases of damage by several methods, with errors, losses and cost, and its tables."""

import math
from collections.abc import Collection, Iterator
from dataclasses import dataclass, field, replace
from html import escape
from typing import Any, NamedTuple

from numpy.typing import NDArray

from ..core.case import Case
from ..core.table import Column, Table, stiffness_column
from ..core.units import NEWTON_PER_UM, in_newton_per_um
from ..stiffness.curve import StiffnessCurve
from .losses import LARGEST, headline, kind_of, loss, rounded_up, told_cycle, within

ZONES = ("single", "double", "triple", "mean", "max", LARGEST)
BRIEF = ("mean", "max", LARGEST)  # zones in tables of many cases
Key = tuple[str, str | None]  # pair and damage case (None: healthy)


class Row(NamedTuple):
    """One method in one zone: stiffness [N/m] and its cost [s], or nan if missing.

    `estimate` is the estimated relative discretisation error of k. `error` is the difference from the reference. `loss` is the
    relative loss of stiffness by the damage, and `doubt` the estimated error of the loss.
    """

    pair: str
    case: str | None
    method: str
    zone: str
    k: float
    estimate: float
    error: float
    loss: float
    doubt: float
    seconds: float


@dataclass(frozen=True, slots=True)
class Comparison:
    """Curves by pair, case and method, the first method being the reference.

    Attributes
    ----------
    cases : dict of (str, str or None) to Case
        Cases by the names of pair and case of damage; None is healthy. The healthy pair of a damaged one is included.
    asked : tuple of (str, str or None)
        Pairs and cases in the tables.
    solved : dict of (str, str or None, str) to StiffnessCurve
        Curves by pair, case and method. For one damaged pair, over the whole engagement of the damaged tooth.
    times : dict of (str, str or None, str) to float
        Seconds by pair, case and method, without imports and error estimates; none for untimed curves. Gears of the reference
        that were solved earlier count with the time of their solve.
    teeth : dict of (str, str) to dict of str to (ndarray or None, dict, str)
        For damaged pairs, by the text that describes a damaged tooth: the phases of zones, mean and max (None for all), by zone
        the estimated error of the loss by the reference, relative to the healthy stiffness, and the adjective of the tooth. The
        phases are those of its mesh cycle (`gearfe.comparison.losses.damage_phases`). Tables are for the first tooth, see
        `by_tooth`.
    left_out : dict of str to str
        Methods without a curve, and the reasons.
    """

    cases: dict[Key, Case]
    asked: tuple[Key, ...]
    solved: dict[tuple[str, str | None, str], StiffnessCurve]
    times: dict[tuple[str, str | None, str], float] = field(default_factory=dict)
    teeth: dict[Key, dict[str, tuple[NDArray | None, dict[str, float], str]]] = field(default_factory=dict)
    left_out: dict[str, str] = field(default_factory=dict)

    @property
    def methods(self) -> tuple[str, ...]:
        """Names of the requested methods, the reference first."""
        return tuple(dict.fromkeys(method for *key, method in self.solved if tuple(key) in self.asked))

    @property
    def subject(self) -> Key:
        """Pair and case with the largest loss of mean stiffness, which the headline describes."""
        return max(self.asked, key=lambda key: self.losses(key).get(self.methods[0], {}).get("mean", -math.inf))

    @property
    def curves(self) -> dict[str, StiffnessCurve]:
        """Curves of the `subject`, by method."""
        return self.of(*self.subject)

    @property
    def healthy(self) -> dict[str, StiffnessCurve]:
        """Curves of the `subject` without damage, by method, at the same phases.

        The result is empty for a healthy pair.
        """
        pair, case = self.subject
        return {} if case is None else self.of(pair, None)

    @property
    def reference(self) -> StiffnessCurve:
        """Reference curve of the `subject`, with which the other curves are compared."""
        return self.curves[self.methods[0]]

    @property
    def seconds(self) -> dict[str, float]:
        """Computing time [s] of the curves of the `subject`, by method."""
        return {name: self.times[*self.subject, name] for name in self.curves if (*self.subject, name) in self.times}

    @property
    def kind(self) -> str:
        """Adjective of the damaged teeth: "cracked", "pitted" or "damaged". The result is empty for healthy pairs."""
        kinds = {kind for key in self.asked for *_, kind in self.teeth.get(key, {}).values()}
        kinds = kinds or {kind_of(case.damage) for key in self.asked if (case := self.cases[key]).damaged}
        return "damaged" if len(kinds) > 1 else "".join(kinds)

    def by_tooth(self) -> list["Comparison"]:
        """Comparisons of the `subject` by damaged tooth, each over the mesh cycle of this tooth."""
        teeth = self.teeth.get(self.subject, {})
        if len(self.asked) > 1 or not teeth:
            return [self]
        return [replace(self, teeth={self.subject: {words: one}}) for words, one in teeth.items()]

    def first_tooth(self, key: Key | None = None) -> tuple[str, NDArray | None, dict[str, float]]:
        """Return the first damaged tooth of a pair (default: `subject`) in words, its phases and errors, see `teeth`."""
        words, (cycle, doubt, _) = next(iter(self.teeth.get(key or self.subject, {"": (None, {}, "")}).items()))
        return words, cycle, doubt

    def of(self, pair: str, case: str | None) -> dict[str, StiffnessCurve]:
        """Curves of a pair in a case by method."""
        return {name: curve for (*key, name), curve in self.solved.items() if tuple(key) == (pair, case)}

    def _cut(self, key, over=None):
        """Return the curves by method at the phases of the zones of `over` (default: the same pair and case)."""
        return {name: within(curve, self.first_tooth(over or key)[1]) for name, curve in self.of(*key).items()}

    def losses(self, key: Key | None = None) -> dict[str, dict[str, float]]:
        """Return the relative loss of stiffness by method and zone, and its maximum over the phase.

        The result is empty for a healthy pair.

        `key` names pair and case, by default those of the `subject`.
        """
        pair, case = key or self.subject
        if case is None or (pair, None) not in self.cases:
            return {}
        healthy, hurt = (self._cut((pair, which), (pair, case)) for which in (None, case))
        return {name: loss(healthy[name], hurt[name]) for name in hurt if name in healthy}

    def rows(self) -> Iterator[Row]:
        """Yield all computed values by pair, case, zone and method."""
        for key in self.asked:
            curves, losses = self._cut(key), self.losses(key)
            zones = {name: curve.zones() for name, curve in curves.items()}
            estimates = {name: curve.zone_errors() for name, curve in curves.items()}
            truth, doubt = zones[self.methods[0]], self.first_tooth(key)[2]
            largest = [LARGEST] if losses else []
            for zone in sorted([*truth, *largest], key=lambda zone: ZONES.index(zone) if zone in ZONES else 2):
                for name in curves:
                    k, first = zones[name].get(zone, math.nan), name == self.methods[0]
                    yield Row(
                        *key, name, zone, k, estimates[name].get(zone, math.nan),
                        math.nan if first else k / truth.get(zone, math.nan) - 1, losses.get(name, {}).get(zone, math.nan),
                        doubt.get(zone, math.nan) if first else math.nan, self.times.get((*key, name), math.nan),
                    )  # fmt: skip

    def record(self) -> Table:
        """`Table` of all `rows`."""
        parts = [Column(name, "%", "{:.2f}") for name in ("estimate", "error", "loss", "error of the loss")]
        columns = ("pair", "case", "method", "zone", Column("k", "N/m"), *parts, Column("time", "s", "{:.3g}"))
        return Table(columns, [
            [row.pair, row.case or "healthy", row.method, row.zone, row.k, *(100 * part for part in row[5:9]), row.seconds]
            for row in self.rows()
        ])  # fmt: skip

    @property
    def headline(self) -> str:
        """Answer in one sentence: the loss of mesh stiffness, or for a healthy pair the mean stiffness and the errors of methods.

        For a healthy pair its mean stiffness and the errors of methods.
        """
        key = self.subject
        which = f"{key[0]}, {key[1] or 'healthy'}: " if len(self.asked) > 1 else ""
        if self.losses(key):
            teeth = ((one.first_tooth(key), one.kind, one.losses(key)[self.methods[0]]) for one in self.by_tooth())
            return which + "; ".join(headline(words, kind, lost, doubt) for (words, _, doubt), kind, lost in teeth)
        first, *others = (row for row in self.rows() if (row.pair, row.case, row.zone) == (*key, "mean"))
        doubt = f" ± {in_newton_per_um(first.k * first.estimate, 2)}" if math.isfinite(first.estimate) else ""
        errors = ", ".join(f"{row.method} {100 * row.error:+.1f} %" for row in others)
        text = f"{which}healthy mesh stiffness {in_newton_per_um(first.k)}{doubt} N/um on average by {first.method}"
        return f"{text}; {errors}" if errors else text

    @property
    def definition(self) -> str:
        """Phases over which the zones and the mean are taken, in words."""
        return told_cycle(None if len(self.asked) > 1 else self._cut(self.subject)[self.methods[0]].phase, self.kind)

    def reasons(self) -> dict[str, str]:
        """Names of methods without a curve, joined by commas, by the reason why the curve is missing."""
        whys = dict.fromkeys(self.left_out.values())
        return {why: ", ".join(name for name, reason in self.left_out.items() if reason == why) for why in whys}

    def _pivot(self, zones, shown, kept):
        """Return columns and rows of a table with a row per pair, case and zone. A single pair or case has no column.

        `shown` are columns by method, each with its number of a `Row`. `kept` selects the rows.
        """
        labels = ("pair", "case", "zone")[-3 if len(self.asked) > 1 else -1 :]
        zones = zones or (BRIEF if len(self.asked) > 1 else None)
        rows: dict[tuple[str, ...], dict[str, Row]] = {}
        for row in self.rows():
            if kept(row) and (not zones or row.zone in zones):
                rows.setdefault((row.pair, row.case or "healthy", row.zone)[-len(labels) :], {})[row.method] = row
        cells = [(name, *part) for name, parts in shown.items() for part in parts]
        body = [[*at, *(number(by[name]) if name in by else "none" for name, _, number in cells)] for at, by in rows.items()]
        return [*labels, *(column for _, column, _ in cells)], body

    def table(self, zones: Collection[str] | None = None, *, digits: int = 4, mark: float = math.inf) -> Table:
        """`Table` of the reference [N/um] and every method with its error, by zone. The last row has the seconds.

        Parameters
        ----------
        zones : collection of str, optional
            Those that are shown; default all, of several cases the mean and the maximum.
        digits : int
            Of the stiffness.
        mark : float
            Errors of more than `mark` in size are emphasised [%].
        """
        error = Column("error", "%", "{:+.1f}", mark), lambda row: 100 * row.error
        shown = {name: [(stiffness_column(name, digits), _in_um), error] for name in self.methods}
        estimate = Column("estimate", "%", "± {:.2f}"), lambda row: 100 * row.estimate
        shown[self.methods[0]][1:] = [estimate] if any(row.estimate >= 0 for row in self.rows()) else []
        columns, body = self._pivot(zones, shown, lambda row: row.zone != LARGEST)
        if self.times:
            last: list[Any] = ["seconds", *([""] * (columns.index("zone")))]
            for name, parts in shown.items():
                total = sum(self.times.get((*key, name), 0.0) for key in self.asked)
                stored = any(self.solved[*key, name].meta.get("stored") for key in self.asked if (*key, name) in self.solved)
                last += [(total, "{:.4f}, stored" if stored else "{:.4f}"), *([None] * (len(parts) - 1))]
            body.append(last)
        return Table(columns, body, "errors of each method")

    def __repr__(self) -> str:
        """Headline in one line."""
        return f"<Comparison: {self.headline}>"

    def _repr_html_(self) -> str:
        """Headline and table of errors, which notebooks display."""
        return f"<p>{escape(self.headline)}</p>{self.table().html()}"

    def loss_table(self, zones: Collection[str] | None = None) -> Table | None:
        """Return a `Table` by zone of the reference stiffness [N/um], healthy and damaged, and of the loss by each method.

        The last row is at the phase of the largest loss. The result is None without damage.
        """
        first, *others = self.losses() or [""]
        lost, share = Column("", "%", "{:z.1f}"), lambda row: 100 * row.loss
        before = stiffness_column(f"healthy {first}"), lambda row: _in_um(row) / (1 - row.loss)
        doubt = Column("error of the loss", "%", lambda doubt: f"± {rounded_up(doubt):.1f} %"), lambda row: 100 * row.doubt
        shown = {
            first: [before, (stiffness_column(f"{self.kind} {first}"), _in_um), (lost._replace(name=f"loss by {first}"), share)]
        }
        shown[first] += [doubt] if self.first_tooth()[2] else []
        shown |= {name: [(lost._replace(name=f"by {name}"), share)] for name in others}
        columns, body = self._pivot(zones, shown, lambda row: math.isfinite(row.loss))
        return Table(columns, body, "loss of stiffness by the damage") if body else None


def _in_um(row):
    return row.k / NEWTON_PER_UM

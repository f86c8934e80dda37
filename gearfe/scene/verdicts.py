"""Comparison of printed results of a scene's sources with computed ones: rows with verdicts, and a table."""

import math
import re
from collections import Counter
from itertools import groupby
from typing import NamedTuple

from ..core.table import Table
from ..core.units import NEWTON_PER_UM

REPRODUCED, CORRECTED, TREND = "reproduced", "reproduced after a stated correction", "trend only"
NOT, NEVER, FORMULA = "not reproduced", "not reproducible", "no number printed"
STATEMENT = "statement"
DEPENDS = "depends"  # The statement holds for some of the values that the source omits.
ASSUMED = "set by an assumption"  # The result agrees, but an assumed value determines it.
DISTINCT = 1e-3  # Two computed values with a smaller relative difference have no order.
MANY = 3  # Rows with equal verdicts share a line from this number on.
CHANGE = 3.0  # A trend agrees if the relative change is between a third and three times the printed one.
SHOWN_AS = {"N/m": "N/um"}  # units of the sources: units shown
COLUMNS = ("id", "case", "pair", "printed", "corrected", "ours", "difference", "verdict", "kind")


class PrintedRow(NamedTuple):
    """A printed value and the computed one.

    `difference` is taken from the corrected value if there is one: in percent, or in the unit where the tolerance is. `kind`
    is that of `gearfe.scene.references.Printed`, or ``"statement"`` of a model's statement.
    """

    id: str
    case: str
    pair: str
    printed: float
    corrected: float
    ours: float
    difference: float
    verdict: str
    kind: str = "model"


def judge(reference, found):
    """Return the rows of a `Reference` with their verdicts.

    A row with a corrected value is judged by the corrected value only, because a value that is known to be wrong is not
    reproducible. `found` are our values by case, or by (case, pair) where the row names a pair. None means that there is no
    computed value, as for measurements.
    """
    ours = [_of(found, row) for row in reference.rows]
    ordered = reference.trend and _ordered([row.target for row in reference.rows], ours)
    out = []
    for row, value in zip(reference.rows, ours, strict=True):
        word = _verdict(reference, row, value, ordered)
        corrected = math.nan if row.corrected is None else row.corrected
        difference = _rounded(math.nan if value is None else _difference(reference, value, row.target))
        numbers = [_rounded(x) for x in (row.value, corrected, math.nan if value is None else value)]
        kind = STATEMENT if reference.unit == STATEMENT and row.kind == "model" else row.kind
        out.append(PrintedRow(reference.id, row.case, row.pair or "", *numbers, difference, word, kind))
    return out


def _of(found, row):
    key = row.case if row.pair is None else (row.case, row.pair)
    if key not in found:
        raise ValueError(f"nothing computed for {key}; there is {', '.join(map(str, found))}")
    return found[key]


def _verdict(reference, row, ours, ordered):
    if math.isnan(row.value):
        return FORMULA
    if ours is None:
        return NEVER
    if row.set_by and (ordered or reference.within(ours, row.target)):
        return ASSUMED
    if reference.within(ours, row.target):
        return CORRECTED if row.correction else REPRODUCED
    return TREND if ordered else NOT


def _ordered(printed, ours):
    """Return True if the computed values have the order of the printed ones and similar relative changes, see `CHANGE`."""
    if len(ours) < 2 or any(value is None for value in ours):
        return False
    for i, (a, x) in enumerate(zip(printed, ours, strict=True)):
        for b, y in zip(printed[:i], ours[:i], strict=True):
            close = abs(x - y) <= DISTINCT * max(abs(x), abs(y))
            if a != b and (close or not (a - b) * (x - y) > 0):
                return False
    parts = [[value / values[0] - 1 if values[0] else value for value in values[1:]] for values in (printed, ours)]
    return all(a == 0 or 1 / CHANGE <= x / a <= CHANGE for a, x in zip(*parts, strict=True))


def _difference(reference, ours, target):
    if abs(ours - target) <= 1e-9 * abs(target):
        return 0.0
    if reference.unit == "statement" or reference.relative is None:
        return ours - target
    return 100 * (ours / target - 1) if target else math.nan


def _rounded(value):
    return float(f"{value:.6g}")


def reasons(reference, row):
    """Return the reasons of a verdict: the correction that it uses, and why a value is not reproduced."""
    printed = next(entry for entry in reference.rows if (entry.case, entry.pair or "") == (row.case, row.pair))
    unfound = ["" if printed.corrected is None else printed.correction, printed.reason]
    found = {CORRECTED: [printed.correction], ASSUMED: [printed.set_by], TREND: unfound, NOT: unfound, NEVER: unfound}
    return [one for one in found.get(row.verdict, []) if one]


def counts(rows):
    """Return one line with the verdicts on numbers and statements of a model, and separately on inputs and arithmetic."""
    printed = [row for row in rows if row.verdict != FORMULA]
    model, said = ([row for row in printed if row.kind == kind] for kind in ("model", STATEMENT))
    rest = [row for row in printed if row.kind not in ("model", STATEMENT)]
    groups = ((model, f"{_count(model, 'number')} of a model"), (said, f"{_count(said, STATEMENT)} of a model"))
    parts = ["; ".join(f"{name}: {_words(rows)}" for rows, name in groups if rows)] if model or said else []
    if rest:
        parts.append(f"{_count(rest, 'input')} and arithmetic on printed numbers: {_words(rest)}")
    if len(rows) > len(printed):
        parts.append(f"{_count(rows[len(printed) :], 'value')} without a printed number")
    return "; apart from them ".join(parts[:2]) + "".join(f"; {part}" for part in parts[2:])


def _count(rows, noun):
    return f"{len(rows)} {noun}{'' if len(rows) == 1 else 's'}"


def _words(rows):
    verdicts = (REPRODUCED, CORRECTED, TREND, ASSUMED, DEPENDS, NOT, NEVER)
    many = {word: sum(row.verdict == word for row in rows) for word in verdicts}
    return ", ".join(f"{n} {'depend' if word == DEPENDS else word}" for word, n in many.items() if n)


def _cells(reference, rows, number):
    """Return the cells of the rows of a reference. A cell equal to the one above is empty.

    Consecutive rows with the same pair, kind and verdict are one line with ranges if there are `MANY` or more.
    """
    above, pair = ["", ""], None
    for (*own, there), group in groupby(rows, lambda row: (row.kind, marked(row.verdict), row.pair)):
        found = list(group)
        alike = len(found) >= MANY and reference.unit != STATEMENT and not any(math.isnan(row.ours) for row in found)
        for some in [found] if alike else [[row] for row in found]:
            name = "" if above[0] else f"{reference.quantity}{_unit(reference)} [{number}]"
            case = some[0].case if len(some) == 1 else f"{some[0].case} to {some[-1].case} ({len(some)})"
            case += f", {there}" if there and there != pair else ""
            shown = [_range(reference, [getattr(row, key) for row in some]) for key in ("printed", "corrected", "ours")]
            printed = shown[0] + (f" (corrected {shown[1]})" if shown[1] else "")
            kind, verdict = ("" if one == last else one for one, last in zip(own, above, strict=True))
            yield name, case, kind, printed, shown[2], _aways(reference, some), verdict
            above, pair = own, there


def _range(reference, values):
    low, high = _shown(reference, min(values)), _shown(reference, max(values))
    return low if low == high else f"{low} to {high}"


def _aways(reference, rows):
    ends = [_away(reference, find(rows, key=lambda row: row.difference)) for find in (min, max)]
    return ends[0] if ends[0] == ends[1] else " to ".join(end or "0" for end in ends)


def text(references, rows, elsewhere=()):
    """Return the counts of verdicts as Markdown, followed by the table of `listed`, whose parameters are these."""
    return "\n".join(
        [*(f"- {part}." for part in re.split("; (?:apart from them )?", counts(rows))), "", *listed(references, rows, elsewhere)]
    )


def listed(references, rows, elsewhere=()):
    """Return lines of Markdown: rows as a table, followed by sources, tolerances and reasons.

    Parameters
    ----------
    references : sequence of Reference
    rows : sequence of PrintedRow
    elsewhere : collection of str
        Cases of statements that another table lists with their verdicts.
    """
    codes, usual, notes = reason_codes(references, rows), usual_tolerance(references, rows), notes_of(references, rows)
    numbers = number_of(references, rows)
    shown = [row for row in rows if not (row.kind == STATEMENT and row.case in elsewhere)]
    cells = [cells for one in references for cells in _cells(one, [row for row in shown if row.id == one.id], numbers[one.id])]
    table = Table(("quantity", "case", "kind", "printed", "gearfe", "difference", "verdict"), cells).markdown()
    return [
        "An empty cell repeats the cell above. An empty difference is below 0.005 %. '(5)': ranges of 5 values. "
        "'[1]': note 1 below.",
        "",
        table,
        "",
        f"Sources, tolerances, reasons.{f' Unless a note states another tolerance, it is {usual[11:]}' if usual else ''}",
        "",
        *(f"{number}. {note}" for number, note in {numbers[name]: note for name, note in notes.items()}.items()),
        *(["", "Reasons that hold for several quantities:", ""] if codes else []),
        *(f"- {code}: {why}." for why, code in codes.items()),
    ]


def marked(verdict):
    """Return a verdict as Markdown. It is bold if the printed value is not reproduced."""
    return f"**{verdict}**" if verdict in (NOT, NEVER) else verdict


def notes_of(references, rows):
    """Return source, tolerance and reasons by reference id. References may share a text."""
    codes, usual = reason_codes(references, rows), usual_tolerance(references, rows)
    return {one.id: _told(one, [row for row in rows if row.id == one.id], codes, usual) for one in references}


def number_of(references, rows):
    """Return the number of the note of each reference, by its id."""
    notes = notes_of(references, rows)
    places = {note: number for number, note in enumerate(dict.fromkeys(notes.values()), 1)}
    return {name: places[note] for name, note in notes.items()}


def usual_tolerance(references, rows):
    """Return the most common tolerance of the references as a sentence.

    The result is empty if fewer than three share one.
    """
    known = Counter(_stated(one, [row for row in rows if row.id == one.id]) for one in references)
    del known[""]
    return next((size for size, count in known.most_common(1) if count > 2), "")


def reason_codes(references, rows):
    """Return codes R1, R2, ... for the reasons that several references share, by reason."""
    by_reason = {}
    for reference in references:
        for row in rows:
            for why in reasons(reference, row) if row.id == reference.id else ():
                by_reason.setdefault(why, set()).add(reference.id)
    shared = [why for why, names in by_reason.items() if len(names) > 1]
    return {why: f"R{number}" for number, why in enumerate(shared, 1)}


def _stated(reference, rows):
    silent = reference.unit == "statement" or all(row.verdict == FORMULA for row in rows)
    return "" if silent else f"Tolerance: {_tolerance(reference)} ({reference.tolerance})."


def _told(reference, rows, codes, usual):
    size = _stated(reference, rows)
    parts = [f"{reference.source}.", *([size] if size and size != usual else [])]
    parts += [_sentence(reference.note)] if reference.note else []
    by_reason = {}
    named = [row.case for row in rows]
    for row in rows:
        why = "; ".join(codes.get(one, one) for one in reasons(reference, row))
        if why:
            case = row.case if named.count(row.case) == 1 else f"{row.case}, {row.pair}"
            by_reason.setdefault((row.verdict, why), []).append(case)
    words = [word for word, _ in by_reason]
    for (word, why), cases in by_reason.items():
        alone = words.count(word) == 1 and len(cases) == sum(row.verdict == word for row in rows)
        which = "" if alone else f" ({'; '.join(cases)})"
        parts.append(f"{_sentence(word)[:-1]}{which}: {why}.")
    return " ".join(parts)


def _sentence(words):
    first = words[0] if words.startswith(("gearfe", "`")) else words[0].upper()
    return f"{first}{words[1:]}."


def _tolerance(reference):
    if (reference.absolute if reference.relative is None else reference.relative) < 1e-8:
        return "exact"
    if reference.relative is None:
        return f"{reference.absolute:g} {reference.unit}".removesuffix(" -")
    return f"{100 * reference.relative:g} %"


def _unit(reference):
    return "" if reference.unit in ("-", "statement") else f" [{SHOWN_AS.get(reference.unit, reference.unit)}]"


def _shown(reference, value):
    if math.isnan(value):
        return ""
    if reference.unit == "statement":
        return "yes" if value else "no"
    return f"{value / (NEWTON_PER_UM if reference.unit in SHOWN_AS else 1.0):.5g}"


def _away(reference, row):
    if math.isnan(row.difference) or reference.unit == "statement":
        return ""
    shown = f"{row.difference:+.3g}" if reference.relative is None else f"{row.difference:+.2f} %"
    return "" if re.fullmatch(r"\+0(\.00 %)?", shown) else shown

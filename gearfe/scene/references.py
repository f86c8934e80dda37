"""Printed numbers and statements of a scene's sources, with tolerance, citation and corrections."""

from dataclasses import dataclass

from ..core.units import NEWTON_PER_UM


@dataclass(frozen=True, slots=True)
class Printed:
    """One printed value.

    `case` is its damage case, `pair` a pair of the scene or None. `value` is the number as printed; for a statement 1 (true) or
    0; nan if the source gives a formula without a number. `corrected` (or None) is the value after the `correction` of the
    printed value or of its conditions. `reason` is the reason why it is not reproducible.

    `kind` is ``"input"``: the value is an input here, or was derived from it. ``"arithmetic"``: it follows from printed numbers
    without a model of the machine. ``"model"``: an independent result. `set_by` is an assumption of the scene, or a choice of
    ours, that sets our value. Agreement then proves nothing, and the verdict states this.
    """

    case: str
    pair: str | None
    value: float
    corrected: float | None
    correction: str
    reason: str
    kind: str = "model"
    set_by: str = ""

    @property
    def target(self) -> float:
        """Reference value: the corrected value if there is one, else the printed one."""
        return self.value if self.corrected is None else self.corrected


@dataclass(frozen=True, slots=True)
class Reference:
    """Quantity as printed by its source.

    `id` is the name of the function that computes it. `unit` is ``statement`` for statements. `source` is the article and the
    place in it. The tolerance is `relative`, a part of the printed value, or `absolute`, in `unit`, one of them; `tolerance` is
    its reason. `trend` is true if the source draws its conclusion from the order of the cases.
    """

    id: str
    quantity: str
    unit: str
    source: str
    relative: float | None
    absolute: float | None
    tolerance: str
    trend: bool
    note: str
    rows: tuple[Printed, ...]

    def within(self, ours: float, value: float) -> bool:
        """Whether `ours` is `value` within the tolerance."""
        allowed = self.absolute if self.relative is None else self.relative * abs(value)
        return abs(ours - value) <= allowed  # type: ignore[operator]  # one of the two is given


def read_references(file, tables):
    """Return the references of the checked [[reference]] tables of a scene file.

    ValueErrors state file, table and key.
    """
    out = tuple(_reference(file, f"reference {i + 1}, {row['id']}", row) for i, row in enumerate(tables))
    names = [reference.id for reference in out]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise ValueError(f"{file}: reference id {twice[0]!r} is used twice; give different ids")
    return out


def _reference(file, where, row):
    if not row["rows"]:
        raise ValueError(f"{file} [{where}]: rows = [], but a reference has printed values; give a row for each case")
    rows = tuple(_row(file, where, printed, row) for printed in row["rows"])
    places = [(printed.case, printed.pair) for printed in rows]
    twice = [place for place in places if places.count(place) > 1]
    if twice:
        raise ValueError(f"{file} [{where}]: two rows of case {twice[0][0]!r} and pair {twice[0][1]!r}; give different cases")
    keep = {key: row[key] for key in ("id", "quantity", "unit", "source", "relative", "absolute", "tolerance", "trend", "note")}
    return Reference(**keep, rows=rows)


def _row(file, where, row, reference):
    if (reference["unit"] == "statement") != (row["claim"] is not None):
        raise ValueError(f"{file} [{where}]: rows of unit 'statement' have claim = true or false, others printed = a number")
    both = {key: row[key] or reference[key] for key in ("kind", "correction", "reason", "set_by")}
    if row["corrected"] is not None and not both["correction"]:
        raise ValueError(f"{file} [{where}]: corrected = {row['corrected']}, but no correction; state what was changed")
    value, corrected = (None if number is None else float(number) for number in (row["printed"], row["corrected"]))
    value = float("nan") if value is None else value
    if corrected is None:
        both["correction"] = row["correction"]
    return Printed(row["case"], row["pair"], value if row["claim"] is None else float(row["claim"]), corrected, **both)


def printed_stiffness(scene, pair, case=None):
    """Return lines with the stiffnesses [N/um] that the sources print for a pair in a case (None: healthy), each once."""
    out, damaged = {}, scene.pair(pair).damage
    for reference in scene.references:
        for row in reference.rows if reference.unit == "N/m" else ():
            if row.pair == pair and (row.case == case if case else row.case not in damaged):
                value, corrected = (None if k is None else f"{k / NEWTON_PER_UM:.4g} N/um" for k in (row.value, row.corrected))
                note = "" if corrected is None else f"; {corrected} after a correction: {row.correction}"
                note += f"; where gearfe differs: {row.reason}" if row.reason else ""
                out[value, corrected, reference.source] = f"printed, {reference.quantity}: {value} ({reference.source}){note}"
    return list(out.values())

"""Page `truth`: gearfe compared with published values, other codes and CalculiX."""

from itertools import groupby
from typing import NamedTuple

from gearfe.core.threads import own_warnings

from ..shared import page, reference
from ..shared.places import TABLES
from ..shared.table_rows import rows_of, write_table

CSV = TABLES / "truth.csv"
RING = "the source does not give its ring fillet; a sharper one (cutter of 40 teeth, tip radius 0.1) gives 17.17"
REASONS = {  # reasons for rows outside their tolerance
    ("stage_17_37_91", "f_m"): "the source multiplies its rounded carrier frequency, 2.1 Hz, by 91; 800 rpm give 190.99 Hz",
    ("healthy_ring", "27/72, min, fe"): RING,
    ("healthy_ring", "27/72, min, ritz"): RING,
}
CONTACT = """
## Nonlinear contact in CalculiX

CalculiX has both gears of a pair 23/37 (m 2.5, x 0.2/-0.05, bores 12/20 mm, 150 N/mm). For each of
[twelve phases](tables/calculix.csv), their meshes have eight edges per Hertzian half-width. All flanks have surface-to-surface
contact (`gearfe.write_contact_inp`). Each gear is rotated by half of the approach of `ritz`.

k of `ritz` is larger at all phases, because the contact of CalculiX consists of springs. The pressure compresses them by 0.069 to
0.075 % of the approach. The difference is at most 0.125 % at least 0.06 cycles from an end of double contact (limit: 0.5 %), and
0.243 % nearer. Without the compression of the springs it is -0.005 to +0.056 %. `tests/test_literature.py` computes `ritz` again.
"""


class SourceRow(NamedTuple):
    """Value of a source and computed value. `tolerance` is relative, or absolute if `absolute`."""

    table: str
    case: str
    theirs: float
    ours: float
    tolerance: float
    absolute: bool

    @property
    def holds(self):
        """Return whether the computed value is within the tolerance."""
        size = self.tolerance if self.absolute else self.tolerance * abs(self.theirs)
        return abs(self.ours - self.theirs) <= size + 1e-9 * (self.theirs == 0)


def _row(name, case, theirs, ours, tolerance, absolute=False):
    return SourceRow(name, case, *(float(f"{float(x):.6g}") for x in (theirs, ours)), tolerance, absolute)


def _rows(table, name, found, absolute=False):
    """Return rows of a table of `reference.toml`. ``found(row)`` lists (case, source value, computed value)."""
    for row in table["rows"]:
        for one in found(row):
            yield _row(name, *one, table["tolerance"], absolute)


def quick_rows(tables):
    """Return the rows that take milliseconds."""
    got = reference.iso()
    for row, rtol in zip(tables["iso"]["rows"], (1e-5, 1e-4, 1e-4), strict=True):
        yield _row("iso", row["quantity"], row["value"], got[row["quantity"]], rtol)
    for name, found in (("iso_mesh", reference.iso_mesh()), ("beam_code", reference.beam_code())):
        yield from _rows(tables[name], name, lambda row, found=found: [(row["quantity"], row["value"], found[row["quantity"]])])
    one = tables["natural_frequencies"]
    for i, (theirs, ours) in enumerate(zip(one["value"], reference.natural_frequencies(), strict=True)):
        case = f"mode {i % 6 + 1}, {'translational' if i > 5 else 'rotational'}"
        yield _row("natural_frequencies", case, theirs, ours, one["tolerance"])
    names = ("f_m", "sun fault", "planet fault", "carrier", "contact ratio sun-planet", "contact ratio planet-ring")
    # The source rounds frequencies to one or two decimals.
    for table, digit in (("stage_17_37_91", 0.05), ("stage_21_31_84", 0.005)):
        one = tables[table]
        for i, (name, theirs, ours) in enumerate(zip(names, one["value"], reference.stage(table), strict=True)):
            yield _row(table, name, theirs, ours, *((digit * (1 + 1e-6), True) if i < 4 else (one["tolerance"], False)))


def solved_rows(tables):
    """Return the rows that require finite elements or the energy model."""
    for name, told, solve in (
        ("tooth_deflection", "z {z}", reference.tooth_deflection),
        ("single_pair", "s_R {s_R}", lambda row: reference.single_pair(row, tables["single_pair"])),
        ("root_stress", "z {z}, x {x:g}, tip radius {rack_tip_radius:g}", reference.root_stress),
    ):
        yield from _rows(tables[name], name, lambda row, told=told, solve=solve: [(told.format(**row), row["value"], solve(row))])
    one = tables["ring_root_stress"]
    row = one["rows"][0]
    stress, eps = reference.ring_root_stress(row)
    yield _row("ring_root_stress", f"ring z {row['z']}", row["value"], stress, one["tolerance"])
    yield _row("ring_root_stress", f"contact ratio 17/{row['z']}", row["eps_alpha"], eps, 1e-9)
    sizes, ring = ("mean", "max", "min"), tables["healthy_ring"]
    for method in ("fe", "ritz"):

        def healthy(row, method=method):
            cases = [f"{row['z'][0]}/{row['z'][1]}, {size}, {method}" for size in sizes]
            return zip(cases, row["value"], reference.healthy(row, method=method), strict=True)

        yield from _rows(tables["healthy"], "healthy", healthy)
        for size, theirs, ours in zip(sizes, ring["value"], reference.healthy_ring(method), strict=True):
            yield _row("healthy_ring", f"27/72, {size}, {method}", theirs, ours, ring["tolerance"])

    def crack(row):
        return [(f"{row['z'][0]}/{row['z'][1]}, {100 * row['level']:.0f} %", row["value"], 100 * reference.crack_reduction(row))]

    def formulations(row):
        for zone, errors in zip(("single", "double"), reference.formulation(row, teeth=5), strict=True):
            cases = [f"{row['name']}, {zone}, {name}" for name in ("least", "most")]
            yield from zip(cases, row[zone], (errors.min(), errors.max()), strict=True)

    def trend(row):
        return [(f"{row['line_load']:g} N/mm", row["value"], reference.load_trend(row["line_load"])[0])]

    for name, found in (("crack", crack), ("formulations", formulations), ("load_trend", trend)):
        yield from _rows(tables[name], name, found, absolute=True)


def read():
    """Return the committed rows."""
    return [
        SourceRow(r["table"], r["case"], float(r["theirs"]), float(r["ours"]), float(r["tolerance"]), r["absolute"] == "True")
        for r in rows_of(CSV)
    ]


def _summary(name, found, absolute, tolerance):
    """Return the row of a table: number of its values, differences, tolerance, and number outside."""
    off = [row.ours - row.theirs if absolute or not row.theirs else 100 * (row.ours / row.theirs - 1) for row in found]
    ends = [f"{end:+.2g}" if absolute else f"{end:+.3f} %" for end in (min(off), max(off))]
    away_by = ends[0] if ends[0] == ends[1] else " to ".join(ends)
    size = f"± {tolerance:.2g}" if absolute else f"{100 * tolerance:g} %"
    beyond = sum(not row.holds for row in found)
    return f"| {name} | {len(found)} | {away_by} | {size} | {f'**{beyond}**' if beyond else ''} |"


def text():
    """Return the page as Markdown, from its committed tables."""
    tables = reference.load()
    tables["calculix_linear"] = {
        "source": "CalculiX on the decks of gearfe.write_inp, the same mesh and the same Gauss points",
        "note": "largest displacement under 100 N/mm near the tip",
        "unit": "um",
    }
    rows = read()
    good = sum(row.holds for row in rows)
    answer = (
        f"{good} of {len(rows)} published or independent values agree within a tolerance that was set beforehand. The others "
        "have a stated reason. k differs from nonlinear contact in CalculiX by at most 0.125 %, away from the ends of double "
        "contact."
    )
    how = """
    `python -m validation truth` computes gearfe's values in [tables/truth.csv](tables/truth.csv). The published values are in
    `validation/sources/reference.toml`. gearfe shares the shapes of the gears with all sources, and the meshes with CalculiX. The
    rows of CalculiX are frozen, and commit 516db22 contains their code.
    """
    lines = [
        """
        ## Published and independently computed values

        Each row combines the values of a source with one tolerance. Values outside their tolerance follow.
        [tables/truth.csv](tables/truth.csv) lists all of them.

        | table | values | difference | tolerance | outside |
        |---|---|---|---|---|
        """
    ]
    for (table, absolute, tolerance), group in groupby(rows, lambda row: (row.table, row.absolute, row.tolerance)):
        lines.append(_summary(f"{table} [{tables[table].get('unit', '-')}]", list(group), absolute, tolerance))
    lines += ["", "Outside:", ""]
    for row in (row for row in rows if not row.holds):
        why = REASONS.get(row[:2], "no reason known")
        lines.append(f"- `{row.table}`, {row.case}: source {row.theirs:.6g}, gearfe {row.ours:.6g}. Reason: {why}.")
    lines += ["", "Sources (`note` in `validation/sources/reference.toml` has the gears and conditions of each):", ""]
    lines += [f"- `{table}`: {tables[table]['source']}" for table in dict.fromkeys(row.table for row in rows)]
    return page.text("truth", answer, how, lines, CONTACT)


def compute():
    """Compute all rows except those of CalculiX, and write the table."""
    tables, rows = reference.load(), []
    with own_warnings():
        for source in (quick_rows, solved_rows):
            for row in source(tables):
                rows.append(row)
                print(f"  {row.table}, {row.case}: {row.ours:.6g} ({row.theirs:.6g})", flush=True)
    rows += [row for row in read() if row.table == "calculix_linear"]  # stored with commit 516db22
    write_table(CSV, SourceRow._fields, rows)


def run(again=True):
    """Write the page. With `again`, its stored rows are computed again."""
    if again:
        compute()
    page.put("truth", text())


def cheap():
    """Yield the rows that `validation.check` computes again."""
    tables, known = reference.load(), {row[:2]: row for row in read()}
    for row in quick_rows(tables):
        yield f"{row.table}, {row.case}", known[row[:2]].ours, lambda row=row: row.ours

"""Comparison of contact laws: values of a page under the law of the article and under other laws."""

from .places import TABLES
from .table_rows import rows_of, write_table


def beside(name, functions, *laws):
    """Write ``tables/NAME_laws.csv``: values of several functions by case, for each contact law."""
    rows = []
    for quantity, function in functions.items():
        found = [function(law) for law in laws]
        shared = [case for case in found[0] if all(case in one for one in found)]
        rows += [(quantity, case, *(_cell(one[case]) for one in found)) for case in shared]
    write_table(TABLES / f"{name}_laws.csv", ("quantity", "case", *laws), rows)


def _cell(value):
    if isinstance(value, bool) or type(value).__name__ == "bool":
        return "yes" if value else "no"
    return f"{value:.6g}"


def tables(name, about, *laws):
    """Return the Markdown table of `beside`, without statements that have the same result under all laws."""
    rows = rows_of(TABLES / f"{name}_laws.csv")
    lines = [f"{about}.", "", f"| quantity | case | {' | '.join(laws)} |", "|---|---|" + "---|" * len(laws)]
    last = ""
    for row in rows:
        if len({row[law] for law in laws}) == 1 and row[laws[0]] in ("yes", "no"):
            continue
        shown = [row[law] if row[law] in ("yes", "no") else f"{float(row[law]):.4g}" for law in laws]
        lines.append(f"| {row['quantity'] if row['quantity'] != last else ''} | {row['case']} | {' | '.join(shown)} |")
        last = row["quantity"]
    return [*lines, ""]

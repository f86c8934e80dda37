"""Two laws of contact beside each other: what a page computes under the article's own, and under another."""

import csv

from gearfe.core.files import written

from .places import TABLES


def beside(name, functions, *laws):
    """Write the values of functions of a law, which give values by case, as ``tables/NAME_laws.csv``."""
    with written(TABLES / f"{name}_laws.csv") as target, open(target, "w", encoding="utf-8", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(("quantity", "case", *laws))
        for quantity, function in functions.items():
            first, *others = (function(law) for law in laws)
            for case, value in first.items():
                if all(case in other for other in others):
                    out.writerow((quantity, case, *(_cell(one) for one in (value, *(other[case] for other in others)))))


def _cell(value):
    if isinstance(value, bool) or type(value).__name__ == "bool":
        return "yes" if value else "no"
    return f"{value:.6g}"


def tables(name, about, *laws):
    """Lines of Markdown of what `beside` wrote."""
    with open(TABLES / f"{name}_laws.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    lines = [f"{about}.", "", f"| quantity | case | {' | '.join(laws)} |", "|---|---|" + "---|" * len(laws)]
    last = ""
    for row in rows:
        shown = [row[law] if row[law] in ("yes", "no") else f"{float(row[law]):.4g}" for law in laws]
        lines.append(f"| {row['quantity'] if row['quantity'] != last else ''} | {row['case']} | {' | '.join(shown)} |")
        last = row["quantity"]
    return [*lines, ""]

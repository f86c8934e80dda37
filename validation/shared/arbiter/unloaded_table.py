"""The unloaded comparison of all pairs, computed once and kept: a row for each pair, and what the page says of them."""

import itertools
import math

import numpy as np

from ..places import TABLES
from ..table_rows import rows_of, write_table
from .cases import COUNT, FIRST
from .unloaded import unloaded

TABLE = TABLES / "outlines_unloaded.csv"
FIELDS = ("seed", "pair", "rows", "largest_difference_um", "phase_48", "order", "gearfe_um", "arbiter_um", "touches", "refused")
LIMIT = 0.05  # um


def one_pair(rows):
    """Row of the table from all of one pair, as `unloaded` gives them."""
    seed, name, phase, *_, last = rows[0]
    if math.isnan(phase):
        return dict(zip(FIELDS, [seed, name, 0, *[""] * 6, last], strict=True))
    apart = [0.0 if row[4] == row[5] else abs(row[4] - row[5]) for row in rows]
    _, _, phase, order, mine, truth, piece = rows[int(np.argmax(apart))]
    numbers = [f"{max(apart):.3g}", round(48 * phase), order, f"{mine:.6g}", f"{truth:.6g}"]
    return dict(zip(FIELDS, [seed, name, len(rows), *numbers, piece, ""], strict=True))


def reference():
    """Compare `COUNT` pairs from seed `FIRST` on (about four minutes)."""
    pairs = (list(rows) for _, rows in itertools.groupby(unloaded(itertools.count(FIRST)), key=lambda row: row[0]))
    write_table(TABLE, FIELDS, [one_pair(rows).values() for rows in itertools.islice(pairs, COUNT)])
    print(f"wrote {TABLE.name}", flush=True)


def section():
    """Markdown of the page."""
    rows = rows_of(TABLE)
    compared = [row for row in rows if not row["refused"]]
    apart = np.array([float(row["largest_difference_um"]) for row in compared])
    share = " | ".join(f"{value:.3g}" for value in np.quantile(apart, [0.5, 0.9, 0.99, 1.0]))
    out = [
        "## Without load\n\n",
        f"Gaps of all neighbouring tooth pairs at 48 phases, where gearfe's or the arbiter's is below 3 um: {len(rows)} pairs, "
        f"{sum(int(row['rows']) for row in compared)} gaps, {len(rows) - len(compared)} pairs refused by gearfe. Differences of "
        f"more than {LIMIT} um: {(apart > LIMIT).sum()} pairs.\n\n",
        "| pairs | largest difference of a pair [um]: median | 90 % | 99 % | largest |\n|---|---|---|---|---|\n",
        f"| {apart.size} | {share} |\n\n",
        "| seed | pair | difference [um] | phase | tooth pair | gearfe [um] | arbiter [um] | what touches |\n",
        "|---|---|---|---|---|---|---|---|\n",
    ]
    for i in np.argsort(-apart)[:10]:
        seed, name, _, difference, phase, order, mine, truth, piece, _ = (compared[i][field] for field in FIELDS)
        out.append(f"| {seed} | {name} | {difference} | {phase}/48 | {order} | {mine} | {truth} | {piece} |\n")
    out += ["\n", *(f"Refused: seed {row['seed']}, {row['pair']}: {row['refused']}\n" for row in rows if row["refused"]), "\n"]
    return "".join(out)

"""Expensive rows of a page as JSON lines in `pages/tables`. An interruption loses at most one row.

Each row has the digest of the sources that computed it. A page that is computed again keeps the rows of the present sources.
"""

import json
import resource

from gearfe.core.files import written

from .places import TABLES, digest

BY, TIME = "made_by", "cpu_s"
before = []  # CPU seconds of rows stored by an earlier run of the same sources


def cpu():
    """Return the CPU seconds of this process and of its finished child processes."""
    return sum(sum(resource.getrusage(who)[:2]) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))


def stored(name):
    """Return all stored rows by their keys."""
    file = TABLES / f"{name}.jsonl"
    lines = file.read_text(encoding="utf-8").splitlines() if file.is_file() else []
    return {row["row"]: row for row in map(json.loads, lines)}


def begin(table):
    """Empty a table, unless an interrupted run of the same sources began it.

    A mark next to the table has the digest of these sources.
    """
    mark = table.with_name(f".{table.name}.made_by")
    if not mark.is_file() or mark.read_text(encoding="utf-8") != digest():
        table.unlink(missing_ok=True)
        mark.write_text(digest(), encoding="utf-8")


def kept(name, key, make, again=False):
    """Return row `key` of table `name`, read from the file, or computed by ``make()`` and stored.

    Parameters
    ----------
    name : str
        Stem of the table.
    key : str
        Name of the row.
    make : callable
        Computes the row.
    again : bool
        Compute rows of other sources again.

    Returns
    -------
    dict
    """
    known, started = stored(name), cpu()
    if key in known and not again:
        return known[key]
    if key in known and known[key].get(BY) == digest():
        before.append(known[key][TIME])
        return known[key]
    known[key] = {"row": key} | make() | {BY: digest(), TIME: round(cpu() - started, 1)}
    TABLES.mkdir(exist_ok=True)
    with written(TABLES / f"{name}.jsonl") as file, open(file, "w", encoding="utf-8") as out:
        out.writelines(f"{json.dumps(row)}\n" for row in known.values())
    print(f"{name}: {key}", flush=True)
    return known[key]

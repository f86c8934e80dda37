"""Rows of a page that are computed once: one JSON object a line in `pages/tables`, so that a stop loses one row at most."""

import json
from collections.abc import Mapping

from . import state
from .places import TABLES


class Row(Mapping):
    """A row on file: once it is looked into, what made it counts as called by this process. Not a dict, which C reads unseen."""

    def __init__(self, table, row):
        self._table, self._row = table, row

    def _read(self):
        state.bring(self._table, self._row["row"])
        return self._row

    def __getitem__(self, name):
        return self._read()[name]

    def __iter__(self):
        return iter(self._read())

    def __len__(self):
        return len(self._read())

    def __or__(self, other):
        return self._read() | dict(other)

    def __ror__(self, other):
        return other | self._read()


def stored(name):
    """All rows on file, each a `Row`, by their keys."""
    return {key: Row(name, row) for key, row in _on_file(name).items()}


def _on_file(name):
    file = TABLES / f"{name}.jsonl"
    lines = file.read_text(encoding="utf-8").splitlines() if file.is_file() else []
    return {row["row"]: row for row in map(json.loads, lines)}


def check(parts, *names):
    """Raise ValueError if a beginning of `parts` is that of no row of the tables `names`; with what rows there are."""
    known = [key for name in names for key in _on_file(name)]
    lost = [part for part in parts if part and not any(key.startswith(part) for key in known)]
    if known and lost:
        raise ValueError(f"no row begins with {', '.join(lost)}; there are: {'; '.join(known)}")


def forget(name, parts):
    """Take rows whose keys begin with one of `parts` out of a table, so that they are missing."""
    left = [row for key, row in _on_file(name).items() if not key.startswith(tuple(parts))]
    state.replace(TABLES / f"{name}.jsonl", "".join(f"{json.dumps(row)}\n" for row in left))


def kept(name, key, make, again=()):
    """Row `key` of table `name`: the one on file, or ``make()``, a dict, which is then put on file.

    `again`: beginnings of the keys of rows that are made anew.
    """
    known, started = _on_file(name), state.cpu()
    state.run.tables.add(name)
    if key in known and not any(key.startswith(part) for part in again):
        return Row(name, known[key])
    known[key] = {"row": key} | make()
    TABLES.mkdir(exist_ok=True)
    state.replace(TABLES / f"{name}.jsonl", "".join(f"{json.dumps(row)}\n" for row in known.values()))
    state.kept(name, key, state.cpu() - started, **{word: known[key][word] for word in ("deck",) if word in known[key]})
    print(f"{name}: {key}", flush=True)
    return known[key]

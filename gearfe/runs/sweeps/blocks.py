"""Blocks of cases, sorted so that cases with the same gears are together.

A block is computed by one process and stored as one shard.
"""

import threading
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import groupby
from typing import Any

import numpy as np

from ...core.steps import listening
from ...core.threads import own_warnings
from ...scene.dotted_keys import rank, set_values
from ...scene.load import Scene, scene_of
from ...scene.study_tables import trimmed
from ...stiffness.disk import program
from ..store.shards import ShardColumn, arrow, encoded, fields, table
from .kinds import KINDS
from .study import Study, of_case, values

FAILURES = (ValueError, RuntimeError, ArithmeticError, LookupError, TypeError, AssertionError, MemoryError)
DONE, FAILED, LOST = "done", "failed", "lost"
_ONE = threading.Lock()  # Processor time is counted per process, not per thread, so cases run one at a time.


@dataclass(frozen=True, slots=True)
class Block:
    """Cases of one shard `name`: values by key, and for each case its ``number``, ``point`` (combination) and ``draw``."""

    name: str
    cases: tuple[dict[str, Any], ...]
    told: tuple[dict[str, int], ...]

    def single(self, i: int) -> "Block":
        """Return a block with its i-th case only."""
        return Block(self.name, self.cases[i : i + 1], self.told[i : i + 1])


def blocks(study: Study) -> tuple[list[Block], dict[str, ShardColumn]]:
    """Return all cases of a study in reproducible blocks, and the columns of its results.

    Cases are sorted by the inputs of the healthy gears, then by damage, then by the rest, which shares both. A block holds whole
    groups of the same gears and damage, unless they are larger.
    """
    columns, point, draw = values(study)
    order, group = _sorted(columns, point.size)
    out = []
    for i, part in enumerate(_parts(group, study.block)):
        members = order[part]
        cases = tuple({key: column[j] for key, column in columns.items()} for j in members)
        told = tuple({"number": int(j), "point": int(point[j]), "draw": int(draw[j])} for j in members)
        out.append(Block(f"block-{i:06d}", cases, told))
    inputs = {key: ShardColumn(_kind(column)) for key, column in columns.items()}
    return out, fields("first") | inputs | fields(study.kind) | fields("last")


def _sorted(columns, count):
    """Return the order of the cases, and the group number (equal gears and damage) of each."""
    codes = {key: _codes(column) for key, column in columns.items()}
    names = sorted(codes, key=rank)  # The stable sort keeps the order of the study within one rank.
    order = np.lexsort([codes[name] for name in reversed(names)]) if names else np.arange(count)
    shared = np.array([codes[name][order] for name in names if rank(name) < 2]).reshape(-1, count)
    new = np.any(np.diff(shared, axis=1) != 0, axis=0)
    return order, np.concatenate([[0], np.cumsum(new)])


def _codes(column):
    """Return the numbers of distinct values in order of first appearance."""
    return np.asarray(arrow().array(list(map(repr, column))).dictionary_encode().indices)


def _parts(group, size):
    """Return slices of about `size` cases. A group is divided only if it is larger."""
    start, ends = 0, np.append(np.flatnonzero(np.diff(group)) + 1, group.size)
    for end, following in zip(ends, [*ends[1:], None], strict=True):
        while end - start >= size:
            cut = end if end - start < 2 * size else start + size
            yield slice(start, cut)
            start = cut
        if start < end and (following is None or following - start > size):
            yield slice(start, end)
            start = end


def _kind(column):
    """Return the kind of column for the values of a key."""
    types = frozenset(map(type, column))
    kinds = {"truth": {bool}, "whole": {int}, "number": {int, float}, "text": {str}}
    return next((kind for kind, held in kinds.items() if types <= held), "json")


def compute(study: Study, fields: Mapping[str, ShardColumn], block: Block) -> tuple[bytes, str]:
    """Compute a block. Return its encoded shard and the identity of the source code that computed it."""
    return shard(fields, rows(study, block))


def shard(fields: Mapping[str, ShardColumn], made: Sequence[Mapping[str, Any]]) -> tuple[bytes, str]:
    """Return the encoded shard of a block's rows, and the identity of the source code that computed them."""
    return encoded(table(made, fields)), _program()["source"]


def rows(study: Study, block: Block) -> list[dict[str, Any]]:
    """Return the rows of a block's cases. A failed case has its error in its row.

    Cases that differ in their load only are computed together. If one of them fails or has a note, each is computed alone, so
    that error and note are in the right row.
    """
    cases, out = block.cases, []
    built: dict[str, Scene] = {}
    keys = [_key(study, case) for case in cases]
    with _ONE, listening(lambda text, share: None):  # The progress of single cases is not reported.
        for _, same in groupby(range(len(cases)), keys.__getitem__):
            numbers = list(same)
            computed = _tried(study, [cases[i] for i in numbers], built)
            if len(numbers) > 1 and any(row["status"] != DONE or row["notes"] for row in computed):
                spent = computed[0]["seconds"]
                computed = [row for i in numbers for row in _tried(study, [cases[i]], built)]
                computed = [row | {"seconds": row["seconds"] + spent} for row in computed]
            out += [_told(block, i) | row for i, row in zip(numbers, computed, strict=True)]
    return out


def _tried(study, cases, built):
    """Return rows of cases that differ only in load, with shared processor time, or with the error of all."""
    started = time.process_time()
    with own_warnings() as caught:
        try:
            computed = [row | {"status": DONE} for row in _computed(study, cases, built)]
        except FAILURES as error:
            computed = [{"status": FAILED, "error": f"{type(error).__name__}: {error}"} for _ in cases]
    notes = "; ".join(dict.fromkeys(str(warning.message) for warning in caught))
    shared = {"notes": notes or None, "seconds": (time.process_time() - started) / len(cases)}
    return [row | shared for row in computed]


def lost(block: Block) -> list[dict[str, Any]]:
    """Return error rows for a block whose worker ended at every attempt."""
    error = "the process that computed it ended: killed, or out of memory"
    return [_told(block, i) | {"status": LOST, "error": error} for i in range(len(block.cases))]


def _told(block, i):
    """Return the columns of a row that identify its case and the program versions."""
    return block.told[i] | block.cases[i] | _program()


@cache
def _program():
    """Return the columns of each row that identify the program that made it."""
    versions = program()
    return {"version": versions["gearfe"], "source": versions["source"]}


def _computed(study, cases, built):
    """Return rows of cases that differ only in load. `built` caches their scene."""
    kind, case, key = KINDS[study.kind], cases[0], _key(study, cases[0])
    pair, damage, options = of_case(study, case)
    if key not in built:
        built.clear()
        tables = set_values(study.tables, {name: value for name, value in case.items() if kind.whole or not _is_force(name)})
        built[key] = scene_of("scene", tables if kind.whole else trimmed(tables, pair, damage))
    scene, hurt = built[key], None if damage == "healthy" else damage
    if kind.whole:
        return kind.work(scene, hurt, options)
    forces = tuple(load_case.get(f"pair.{pair}.force_N", scene.pair(pair).force) for load_case in cases)
    return kind.work(replace(scene.case(pair, hurt), force=forces), options)


def _key(study, case):
    """Return the inputs that define the scene of a case except the load, if the scene is a single pair."""
    return repr([(name, value) for name, value in case.items() if KINDS[study.kind].whole or not _is_force(name)])


def _is_force(key):
    return key.startswith("pair.") and key.endswith(".force_N")

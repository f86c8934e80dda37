"""Stored rows of the arbiter, compared with the stiffness of gearfe."""

import warnings
from itertools import groupby

import gearfe as gf

from ..table_rows import rows_of
from .cases import LOADED, loaded_case
from .kept import STEEL, TABLE


def beside(method, seeds=None, given=LOADED, table=TABLE):
    """Compare every row in `table` of the cases `given` (or of some `seeds`) with k of `method` [N/(mm um)].

    Yields
    ------
    (dict, dict)
        The row on file, and ``k``, ``estimate``, ``difference`` [%]; or ``refused``, the reason why gearfe has no curve.
    """
    cases = {str(row[0]): row for row in given}
    for seed, rows in groupby(rows_of(table), key=lambda row: row["seed"]):
        if seed not in cases or (seeds is not None and int(seed) not in seeds):
            continue
        rows = list(rows)
        pair, flanks, load, cracks, phases = loaded_case(cases[seed])
        damage = {name: some for name, some in zip(("pinion", "wheel"), cracks, strict=True) if some}
        modified = None if flanks is None else dict(zip(("pinion", "wheel"), flanks, strict=True))
        width = pair.b_w
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                curve = gf.mesh_stiffness(
                    pair, load * width, gf.Material(*STEEL), phases=phases, method=method, damage=damage or None, flanks=modified,
                    error=True, cache=False,
                )  # fmt: skip
            except (ValueError, RuntimeError) as error:
                yield from ((row, {"refused": str(error)}) for row in rows)
                continue
        for row, k, error in zip(rows, curve.k / 1e6 / width, curve.error / curve.k, strict=True):
            truth = float(row["k_N_um_mm"])
            yield row, {"k": float(k), "estimate": 100 * float(error), "difference": 100 * (float(k) / truth - 1)}

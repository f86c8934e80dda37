"""Which readings of the scan bear S4's claim: agreement with finite elements, printed stiffness, printed reductions."""

from functools import lru_cache

import numpy as np

import gearfe as gf

from . import herringbone_scan
from .herringbone_scan import GROUPS, READINGS, SCENE, load

CLAIM = 3.0  # percent: S4, "the maximum error is below 3 %"
WIDER = 5.0  # percent
NEAR, NEARER = 3.0, 1.0  # points of reduction


def rows():
    """Ten rows as (pair, case or "healthy")."""
    return [(pair, case or "healthy") for pair, case in herringbone_scan.rows()]


@lru_cache(maxsize=8)
def printed(what):
    """A printed quantity by row, after the stated corrections, in order of `rows`; nan where it has none."""
    found = next(one for one in gf.load_scene(SCENE).references if one.id == what)
    values = {(row.pair, row.case): row.value if row.corrected is None else row.corrected for row in found.rows}
    return np.array([values.get(key, np.nan) for key in rows()])


class Scan:
    """The table of the scan as arrays ``(readings, 10)``.

    `mean`, `largest` (maxima) [GN/m] of `ritz3d` and, by foundation of the ring, `published`; `drop` [%] of `ritz3d` and
    `published`; `phase`, the error of `published` at the worst phase [%]; `zone`, its errors where most and where fewest pairs
    touch.
    """

    def __init__(self, table=None):
        self.table = load() if table is None else table
        self.mean = {kind: self._read(kind, "mean") for kind in ("ritz3d", *READINGS)}
        self.largest = {kind: self._read(kind, "max") for kind in ("ritz3d", *READINGS)}
        self.drop = {kind: self._read(kind, "drop") for kind in ("ritz3d", "printed")}
        self.phase = self._read("printed", "phase")
        self.zone = {name: self._read("printed", name) for name in ("most", "fewest")}

    def _read(self, kind, what):
        names = [
            f"{pair} {case} {'printed' if pair == 'sun_planet' and kind == 'external' else kind} {what}" for pair, case in rows()
        ]
        return np.array([[float(row.get(name) or "nan") for name in names] for row in self.table])

    def column(self, name):
        """An input of all readings."""
        return np.array([float(row[name]) for row in self.table])

    def errors(self, kind):
        """Errors of the means [%], against `ritz3d`."""
        return 100 * (self.mean[kind] / self.mean["ritz3d"] - 1)

    def errors_of_max(self, kind):
        """Errors of the maxima [%]."""
        return 100 * (self.largest[kind] / self.largest["ritz3d"] - 1)

    def agree(self, kind, which=slice(None), limit=CLAIM):
        """Readings ``(readings,)`` in which the means agree."""
        return (np.abs(self.errors(kind)[:, which]) < limit).all(axis=1)

    def agree_max(self, kind, which=slice(None), limit=CLAIM):
        """Readings in which the maxima agree."""
        return (np.abs(self.errors_of_max(kind)[:, which]) < limit).all(axis=1)

    def absolute(self, kind, which=slice(None), limit=CLAIM):
        """Readings in which formulas and reference both have the printed stiffness: of the pair, or of a half 60 mm wide."""
        wide = np.array([GROUPS[int(group)][2] == 60.0 for group in self.column("group")])
        found = np.zeros(len(self.table), dtype=bool)
        for part, open_to in ((1.0, True), (0.5, wide)):
            ours = part * self.mean[kind] / printed("stiffness_analytical") * 1e9 - 1
            theirs = part * self.mean["ritz3d"] / printed("stiffness_fe") * 1e9 - 1
            found |= (100 * np.maximum(np.abs(ours), np.abs(theirs))[:, which] < limit).all(axis=1) & open_to
        return found

    def reduced(self, kind, limit, without=()):
        """Readings whose reductions by a method are the printed ones within so many points, some cases left out."""
        kept = [k for k, (_, case) in enumerate(rows()) if case != "healthy" and case[-1] not in without]
        return (np.abs(self.drop[kind] - printed("stiffness_reduction"))[:, kept] < limit).all(axis=1)

    def best(self, kind):
        """Index of the reading whose worst of ten means is nearest."""
        return int(np.nanargmin(np.abs(self.errors(kind)).max(axis=1)))


SUN = slice(0, 5)
RING = slice(5, 10)


def sets(scan):
    """Rows (what, readings in it with the printed foundation of the ring, without)."""

    def met(kind):
        return scan.agree(kind), scan.absolute(kind, limit=WIDER), scan.reduced("ritz3d", NEAR), scan.reduced("ritz3d", NEAR, "4")

    def both(found):
        return [int(np.sum(found(kind))) for kind in READINGS]

    return [
        ("`published` has a value", *both(lambda k: np.isfinite(scan.mean[k]).all(axis=1))),
        ("all ten means agree below 3 %", *both(scan.agree)),
        ("all ten maxima agree below 3 %", *both(scan.agree_max)),
        ("all ten means and all ten maxima", *both(lambda k: scan.agree(k) & scan.agree_max(k))),
        ("the five means of sun and planet", *both(lambda k: scan.agree(k, SUN))),
        ("the five means of planet and ring", *both(lambda k: scan.agree(k, RING))),
        ("the two healthy means", *both(lambda k: scan.agree(k, [0, 5]))),
        ("printed stiffness, formulas and reference within 3 %: ten rows", *both(scan.absolute)),
        ("the same within 5 %", *both(lambda k: scan.absolute(k, limit=WIDER))),
        ("the same within 5 %: the two healthy rows", *both(lambda k: scan.absolute(k, [0, 5], WIDER))),
        ("the same within 5 %: the healthy row of sun and planet", *both(lambda k: scan.absolute(k, [0], WIDER))),
        ("printed reductions by `ritz3d` within 3 points: eight rows", *both(lambda k: scan.reduced("ritz3d", NEAR))),
        ("the same without case 4", *both(lambda k: scan.reduced("ritz3d", NEAR, "4"))),
        ("the same within 1 point, without case 4", *both(lambda k: scan.reduced("ritz3d", NEARER, "4"))),
        ("printed reductions by `published` within 3 points: eight rows", *both(lambda k: scan.reduced("printed", NEAR))),
        ("the same without case 4", *both(lambda k: scan.reduced("printed", NEAR, "4"))),
        ("ten means, and printed stiffness within 5 %", *both(lambda k: met(k)[0] & met(k)[1])),
        ("ten means, and reductions within 3 points without case 4", *both(lambda k: met(k)[0] & met(k)[3])),
        ("all three", *both(lambda k: met(k)[0] & met(k)[1] & met(k)[2])),
    ]

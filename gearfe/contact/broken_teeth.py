"""Contacts of missing teeth and chipped tips."""

from dataclasses import replace

import numpy as np

from ..core.case_parts import SIDES
from ..geometry.damage.chip import Chip, Recess
from ..geometry.pair.contacts import Touch, touching
from ..geometry.pair.gear_pair import with_tips
from ..geometry.pair.modified import touching_modified


def with_broken(points, pair, flexibility, extended, flanks=None):
    """Return the contacts of a pair with missing or chipped teeth, and the ends of the path of contact ``(2, pairs)`` [mm].

    A missing tooth has an infinite gap. The flank of a chipped one ends at its corner. ValueError if no pair is left at a phase.
    """
    path = np.tile(np.array(pair.path)[:, None], points.order.size)
    points = _chipped(points, pair, flexibility, extended, path, flanks)
    gone = np.zeros(points.order.size, dtype=bool)
    for gear, own, teeth in zip(pair.gears, flexibility, points.teeth, strict=True):
        gone |= np.isin(teeth % gear.z, [tooth % gear.z for tooth in getattr(own, "missing", ())])
    if not gone.any():
        return points, path
    gap = np.where(gone, np.inf, points.gap)
    if not np.isfinite(gap).any(axis=1).all():
        raise ValueError(
            "at some phases only a missing tooth would be in contact: allow contact outside the path of contact "
            "(extended = True), or use a pair with a larger contact ratio"
        )
    return replace(points, gap=gap, corner_gap=np.where(gone, np.inf, points.corner_gap)), path


def without_recesses(case):
    """Return the pits and spalls of both gears without chip recesses, and the broken teeth with these chips restored."""
    pits = tuple(tuple(pit for pit in own if not isinstance(pit, Recess)) for own in case.pits)
    parts = [
        tuple(
            replace(one, tooth=sense * one.tooth)
            for one in (case.damage or {}).get(name, ())
            if not one.through and isinstance(one, Chip)
        )
        for name, sense in SIDES
    ]
    return pits, tuple((*own, *more) for own, more in zip(case.broken, parts, strict=True))


def _chipped(points, pair, flexibility, extended, path, flanks):
    """Return the contacts of flanks that end at the corners of chips, and write the ends of their path into `path`."""
    cut = [getattr(own, "tips", {}) for own in flexibility]
    if not any(cut):
        return points
    found = {name: getattr(points, name).copy() for name in Touch._fields}
    for k, order in enumerate(points.order.tolist()):
        ends = [tips.get(tooth % own.gear.z) for tips, own, tooth in zip(cut, flexibility, (order, -order), strict=True)]
        if any(ends):
            short = with_tips(pair, [end and end[0] for end in ends])
            path[:, k] = short.path
            nominal = points.nominal[:, k]
            met = touching(short, nominal, extended=extended)
            if flanks is not None:
                met = touching_modified(short, flanks, nominal, np.full(nominal.shape, order), met)
            for name, values in met._asdict().items():
                found[name][..., k] = values
    return replace(points, **found)

"""Unknowns of the contacts of a pair: selection of contacts that can close, and arrays for rows of different lengths."""

import numpy as np

from .rows import HatRow
from .sharing import stacked

# unknown properties of a contact
UNKNOWN = ("roll_1", "roll_2", "gap", "coefficient", "radius", "tilt", "turn_1", "turn_2", "fillet")
OVERLAP = 1e-3  # Smaller overlaps of crack faces, relative to the largest opening, are ignored.


def overlaps(opening):
    """Return whether crack faces overlap. The last axis of `opening` belongs to the faces."""
    return opening.min(axis=-1) < -OVERLAP * np.abs(opening).max(axis=-1)


def near_contacts(contacts, reach):
    """Return the contacts without the unknowns whose gap cannot close."""
    near = contacts["gap"] <= max(reach, contacts["gap"].min())
    if near.all():
        return contacts
    kept = {name: values if values is None else values[near] for name, values in contacts.items()}
    return kept | {"flexibility": contacts["flexibility"][np.ix_(near, near)]}


def aligned(rows):
    """Combine unknowns of `HatRow` records of different lengths in one array (see `_single`). Missing entries have nan gaps."""
    out = {name: stacked([getattr(row, name) for row in rows]) for name in HatRow._fields}
    for k, row in enumerate(rows):
        size = row.gap.size
        out["roll_1"][k, size:], out["roll_2"][k, size:], out["gap"][k, size:] = row.roll_1[-1], row.roll_2[-1], np.nan
    zero = np.zeros(out["gap"].shape)
    return out | {"coefficient": zero, "tilt": zero, "radius": zero + 1}


def unknowns_at(contact, wanted, rows, tilt):
    """Return the unknowns of the contact problems of a `PairContact` at some phases.

    Parameters
    ----------
    wanted : sequence of (int, ndarray of int, ndarray of int)
        Number of a phase; columns of the pairs that may touch; for each of them 0 for a single contact, or what makes it a
        row.
    rows : dict of (int, int) to Row
        Rows of hat functions by phase and column.
    tilt : ndarray, shape (phases, pairs)
        As of `line_contacts`.

    Returns
    -------
    list of dict
        ``flexibility``, ``gap``, ``coefficient`` of the logarithm, ``radius``, pair ``column`` and crack ``opening``.
    """
    alike, out = {}, {}  # groups of phases with the same touching pairs and corners
    for i, near, corner in wanted:
        alike.setdefault((tuple(near.tolist()), tuple((corner > 0).tolist())), []).append(i)
    for (near, row), phases in alike.items():
        out |= dict(zip(phases, _built(contact, np.array(phases), near, row, rows, tilt), strict=True))
    return [out[i] for i, _, _ in wanted]


def _built(contact, phases, near, row, rows, tilt):
    parts = [
        aligned([rows[i, column] for i in phases.tolist()]) if resolved else _single(contact, phases, column, tilt)
        for column, resolved in zip(near, row, strict=True)
    ]
    column = np.repeat(near, [part["gap"].shape[1] for part in parts])
    order = contact.found.order[column]
    values = {name: np.concatenate([part[name] for part in parts], axis=1) for name in UNKNOWN}
    total = 0.0
    for k, teeth in enumerate((order, -order), start=1):
        turn = values[f"turn_{k}"]
        total = total + turn[:, :, None] * turn[:, None] * contact.flexibility[k - 1].matrix(values[f"roll_{k}"], teeth)
    for part, k in zip(parts, near, strict=True):
        unknowns = np.flatnonzero(column == k)
        total[:, unknowns[:, None], unknowns] = (
            part["influence"] if "influence" in part else contact.alone[phases, k][:, None, None]
        )
    opening = contact.opening_at(values["roll_1"], values["roll_2"], order)
    if opening is not None:
        total = total + opening @ contact.stiffness @ opening.mT
    out, meets = [], np.isfinite(values["gap"])
    for k, on in enumerate(meets):
        unknowns = {name: values[name][k, on] for name in ("gap", "coefficient", "radius", "tilt", "fillet")}
        unknowns |= {"column": column[on], "flexibility": total[k][on][:, on]}
        out.append(unknowns | {"opening": None if opening is None else opening[k, on]})
    return out


def _single(contact, phases, column, tilt):
    """Return the unknowns ``(phases, 1)`` of one pair with Hertz's logarithm, one array for each name in `UNKNOWN`."""
    out = {name: getattr(contact.found, name)[phases, column, None] for name in ("roll_1", "roll_2", "gap")}
    out |= {"radius": contact.radius[phases, column, None], "tilt": tilt[phases, column, None]}
    out |= {"coefficient": contact.coefficient[phases, column, None], "fillet": np.zeros((phases.size, 1), dtype=bool)}
    return out | dict(zip(("turn_1", "turn_2"), contact.turns[:, phases, column, None], strict=True))

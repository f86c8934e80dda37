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

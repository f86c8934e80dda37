"""Load sharing of gears with crack faces that touch each other: unilateral contact between the faces, without friction."""

import numpy as np

from .sharing import ROUNDING, LineContacts, line_contact, line_contacts, stacked
from .sliding import bounded

STEPS = 30  # limit of steps to find the faces that touch, before contacts and faces are solved in one problem


def share_closing(contact, sets, line_load, carried, phases):
    """Solve contact problems of a `PairContact` again with contact between crack faces.

    Faces that overlap under the line loads with open cracks are first assumed to touch. Faces that touch are joined: this
    changes the flexibility between the contacts. Faces in tension then open and faces that overlap touch, until neither occurs.
    Sliding of the contacts is then computed for gears with these faces joined.

    Parameters
    ----------
    contact : PairContact
    sets : list of dict
        Of `gearfe.contact.unknowns.unknowns_at`.
    line_load : float
        [N/mm]
    carried : list of ndarray, shape (n,)
        Line loads of each set with open cracks [N/mm].
    phases : ndarray of int, shape (sets,)
        Numbers of the phases of the sets.

    Returns
    -------
    force, approach, tangent : ndarray (sets, n), (sets,), (sets,)
        As of `gearfe.contact.sharing.line_contacts`.
    """
    names = ("flexibility", "gap", "coefficient", "radius", "column")
    flexibility, gap, coefficient, radius, column = (stacked([one[name] for one in sets]) for name in names)
    filled = stacked([np.ones(one["gap"].size, dtype=bool) for one in sets])
    radius[~filled] = 1.0
    openings = np.zeros((*gap.shape, contact.faces.shape[0]))
    for out, one in zip(openings, sets, strict=True):
        out[: one["gap"].size] = one["opening"]
    problem = LineContacts(flexibility, gap, coefficient, radius, contact.modulus, np.zeros(gap.shape))
    posed = contact.faces, openings, line_load, filled
    start = stacked(carried)
    shut = (start[:, None] @ openings)[:, 0] < 0
    start, _, _, shut = _solved(*posed, problem, start, shut)
    stiffness = contact.stiffness - _joined(contact.faces, shut)
    tilt = np.take_along_axis(bounded(contact, line_load, phases, stiffness), column, axis=1)
    problem = problem._replace(tilt=np.where(filled & (coefficient > 0), tilt, 0.0))
    return _solved(*posed, problem, start, shut)[:3]


def _joined(faces, shut):
    """Return the stiffness ``(sets, faces, faces)`` between the faces `shut` ``(sets, faces)`` of each set, zero elsewhere."""
    out, known = np.zeros((*shut.shape, shut.shape[1])), {}
    for stiffness, on in zip(out, shut, strict=True):
        key = on.tobytes()
        if key not in known:
            at = np.ix_(on, on)
            known[key] = at, np.linalg.inv(faces[at])
        at, inverse = known[key]
        stiffness[at] = inverse
    return out


def _solved(faces, openings, load, filled, problem, start, shut):
    """Return line loads, approaches and tangents, and the faces that touch ``(sets, faces)``.

    `start` ``(sets, n)`` are line loads near those wanted, and `shut` the faces that are likely to touch.
    """
    sets = len(shut)
    force, approach, tangent = start.copy(), np.zeros(sets), np.zeros(sets)
    settled, shut, open_ = np.zeros(sets, dtype=bool), shut.copy(), np.arange(sets)
    for _ in range(STEPS):
        part, on = openings[open_], shut[open_]
        stiffness = _joined(faces, on)
        fields = (problem.gap, problem.coefficient, problem.radius, problem.tilt)
        gap, coefficient, radius, tilt = (values[open_] for values in fields)
        flexibility = problem.flexibility[open_] - part @ stiffness @ part.mT
        posed = LineContacts(flexibility, gap, coefficient, radius, problem.modulus, tilt)
        carried, approach[open_], tangent[open_], found = line_contacts(posed, load, filled[open_], force[open_])
        force[open_] = carried
        apart = (carried[:, None] @ part)[:, 0]
        pressed = -(stiffness @ apart[..., None])[..., 0]
        apart += pressed @ faces
        wanted = np.where(on, pressed > 0, apart < -ROUNDING * np.abs(apart).max(axis=1, keepdims=True))
        same = (wanted == on).all(axis=1)
        settled[open_[same & found]] = True
        left = ~same & found
        shut[open_[left]] = wanted[left]
        open_ = open_[left]
        if not open_.size:
            break
    for k in np.flatnonzero(~settled).tolist():
        n = filled[k].sum()
        force[k, :n], approach[k], tangent[k], shut[k] = _together(faces, openings[k, :n], load, problem, k, force[k, :n])
    return force, approach, tangent, shut


def _together(faces, opening, load, problem, k, start):
    """Return line loads, approach and tangent of set k and its touching faces, from one problem of contacts and faces."""
    n, m = len(opening), len(faces)
    values = (problem.gap, problem.coefficient, problem.radius, problem.tilt)
    gap, coefficient, radius, tilt = (
        np.append(each[k, :n], np.full(m, rest)) for each, rest in zip(values, (0, 0, 1, 0), strict=True)
    )
    whole = np.block([[problem.flexibility[k, :n, :n], opening], [opening.T, faces]])
    first = np.append(start, np.where(start @ opening < 0, load, 0.0))
    contacts = LineContacts(whole, gap, coefficient, radius, problem.modulus, tilt)
    force, approach, tangent = line_contact(contacts, load, np.append(np.ones(n), np.zeros(m)), first)
    return force[:n], approach, tangent, force[n:] > 0

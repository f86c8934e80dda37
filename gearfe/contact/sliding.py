"""Motion of contacts along the flanks under load, towards stiffer places, and the changes of approach and gaps."""

import math
from itertools import zip_longest

import numpy as np

from ..flexibility.hertz import half_width
from ..flexibility.plane import cracks_beyond
from ..geometry.tooth.profile import arc_at, flank_arcs, roll_at_arc
from .thinned import UNSURE

MOST = 0.05  # limit of the approach by sliding, relative to the deflection; larger values violate small strains
STEP = 0.01  # step along the flank for the derivative of a flexibility [m_n]


def sliding(contact, phases=slice(None), stiffness=None):
    """Compute the reduction of the approach by sliding, per square of the line load ``(phases, pairs)`` [mm per (N/mm)**2].

    `contact` is a `PairContact`, of which some `phases` are computed. `stiffness` ``(faces, faces)`` is that of its crack
    faces (default: all open).

    Under a line load P the flanks tilt by ``P S' / 2``. S' is the derivative of the pair's flexibility along them, R the relative
    radius of curvature. The contact moves by ``x = -R P S' / 2`` to the place where the flanks are parallel again. The approach
    is smaller by ``-(P S' x + x**2 / 2 R) = 3/8 R (P S')**2``. For ring pairs, whose flanks nearly conform, this is 0.5 % under
    a heavy load. Sliding is neglected at the ends of flanks.
    """
    stiffness = contact.stiffness if stiffness is None else stiffness
    alone, opening, on = contact.moved
    alone = alone[:, phases]
    if opening is not None:
        alone = alone + _quadratic(opening[:, phases], stiffness)
    slope = (alone[0] - alone[1]) / (2 * STEP * contact.pair.gear_1.m_n)
    return np.where(on[phases], 3 / 8 * contact.radius[phases] * slope**2, 0.0)


def moved_contacts(contact):
    """Return the pairs with contacts moved along the flanks by `STEP`, upwards and downwards on the pinion.

    The results are the flexibility of each pair with bonded crack faces ``(2, phases, pairs)`` [mm per N/mm], the opening of
    the crack faces ``(2, phases, pairs, faces)`` or None, and whether the places are on both flanks ``(phases, pairs)``.
    """
    points, step = contact.found, STEP * contact.pair.gear_1.m_n
    moved, rolls, on = step * np.array([1, -1])[:, None, None], [], np.isfinite(points.gap)
    alone = np.zeros((2, *on.shape))
    places = ((points.roll_1, points.order, moved), (points.roll_2, -points.order, -moved))
    for flexible, (roll, teeth, by) in zip(contact.flexibility, places, strict=True):
        gear = flexible.gear
        arc, (low, high) = arc_at(gear, roll), flank_arcs(gear)
        on &= (arc > low + step) & (arc < high - step)
        rolls.append(roll_at_arc(gear, arc + by))
        for k in range(teeth.size):
            alone[..., k] += flexible.matrix(rolls[-1][..., k, None], teeth[k : k + 1])[..., 0, 0]
    return alone, contact.opening_at(*rolls, points.order), on


def _quadratic(opening, stiffness):
    """Return ``opening @ stiffness @ opening`` of each contact, for `opening` ``(..., faces)``."""
    return np.einsum("...f,...f->...", opening @ stiffness, opening)


def slid(cells, phase, bodies, load, radius):
    """Return the reduction of the approach of cells by sliding, normal to the flanks ``(3, n)`` [mm].

    Each tooth pair slides under its own loads. With the tilt t of the flanks the reduction is ``3/2 R t**2``. The first row is
    for open cracks, the second for none, the third for the tilt by cracks alone (see `_cracks`).

    Parameters
    ----------
    cells, bodies
        See `gearfe.contact.bodies.between`. The cells are those of many phases.
    phase : ndarray, shape (n,)
        Number of the phase of each cell.
    load : ndarray, shape (n,)
        Loads of the cells [N].
    radius : ndarray, shape (n,)
        Relative radii of curvature at right angles to the flanks [mm].
    """
    tilt, places = np.zeros((2, load.size)), np.array([cells.half, cells.order, phase])
    (halves, orders, _), number = np.unique(places, axis=1, return_inverse=True)
    by_pair = np.split(np.argsort(number, kind="stable"), np.cumsum(np.bincount(number))[:-1])
    for half in np.unique(halves).tolist():
        pairs = [(int(orders[k]), by_pair[k]) for k in np.flatnonzero(halves == half).tolist()]
        on = np.concatenate([at for _, at in pairs])
        for (body, offset), sense, roll in zip(bodies[half], (1, -1), (cells.roll_1[on], cells.roll_2[on]), strict=True):
            gear, z, teeth = body.gear, cells.depth[on] + offset, sense * cells.order[on]
            arc, step = arc_at(gear, roll), STEP * gear.m_n
            rows, ahead, behind = (body.basis(roll_at_arc(gear, arc + side * step), z, teeth) for side in (0, 1, -1))
            slope, stop = sense / (2 * step) * (ahead - behind), 0
            whole = body if body.seam is None else body.healthy  # Only cracks have faces that open.
            for order, at in pairs:
                own = slice(stop, stop := stop + at.size)
                kernels = [one.between(sense * order, sense * order) for one in (body, whole)]
                fields = np.array([load[at] @ rows[own] @ kernel for kernel in kernels])
                tilt[:, at] += fields @ slope[own].T
    return 1.5 * radius * np.vstack([tilt, tilt[0] - tilt[1]]) ** 2


def bounded(contact, line_load, phases=slice(None), stiffness=None):
    """Return the result of `sliding` under a load [N/mm], limited to the part `MOST` of the deflection of a pair."""
    width = half_width(line_load, contact.radius[phases], contact.modulus)
    if stiffness is None:
        slides, yields = contact.sliding[phases], np.diagonal(contact.matrix[phases], axis1=1, axis2=2)
    else:
        slides, opening = sliding(contact, phases, stiffness), contact.opening[phases]
        yields = contact.alone[phases] + _quadratic(opening, stiffness)
    yields = yields + sum(contact.coefficients) * (np.log(2 / width) + 0.5)
    return np.minimum(slides, MOST * np.maximum(yields, 0.0) / line_load)


def left_out(contact, line, closing, beyond, shut):
    """Return the uncertain part of the approach ``(phases,)``, caused by tangential motion of bent teeth and by chamfers.

    The tip of a tooth deflects perpendicular to its centre-line. A part tan(alpha_wt) of the approach is therefore a motion u
    along the flanks, which has no effect on the path of contact. Off the path, let R be the relative radius of curvature, g
    the gap, and ``s = sqrt(2 R g)`` the distance from where the flanks would meet. The gap changes by about ``(s u + u**2 / 2)
    / R``. The effect is largest near base circles, where R is small.

    The arguments are line loads `line` [N/mm] and gaps `beyond` the first touch [mm] ``(phases, pairs)``. `closing`
    ``(phases,)`` is the approach under load [mm]. Crack faces touch at the phases `shut`. Cracks on teeth beyond those solved,
    in thin teeth, or with large displacements add to the uncertainty.
    """
    points, (start, end) = contact.found, contact.path
    off = (line > 0) & ((points.nominal < start) | (points.nominal > end))
    softer = _cut_away(contact, line) + UNSURE * np.abs(contact.thinner) * line
    softer = softer + _cracks_beyond(contact, line) + _cracks(contact, line, closing, shut)
    if not (off.any() or softer.any()):
        return np.zeros(closing.size)
    closed = closing[:, None] - beyond
    stiff = np.where(line > 0, line / np.maximum(closed, 1e-3 * closing[:, None]), 0.0)
    changed = np.where(off, _changed(contact, contact.radius, points.gap, closed, closing[:, None]), 0.0)
    return (stiff * (changed + softer)).sum(axis=1) / stiff.sum(axis=1) / closing


def _changed(contact, radius, gap, closed, closing):
    """Return the change of gaps off the path by sliding [mm], see `left_out`. It is limited to their closed part `closed`."""
    u = math.tan(contact.pair.alpha_wt) * closing
    return np.minimum((np.sqrt(2 * radius * np.maximum(gap, 0.0)) * u + u**2 / 2) / radius, closed)


def off_path(contact, cells, load, radius, approach):
    """Return the uncertain part of the `approach` [mm] of a `PhaseContact`, for the causes that `left_out` describes.

    It is zero where contact on the path carries. `load`, `radius` ``(n,)`` are those of the `Cells`.
    """
    on = np.flatnonzero(load > 0)
    places = list(zip(cells.order[on].tolist(), contact.pairs.parts(cells.z[on]).tolist(), strict=True))
    ends = {place: contact.pairs(*place).path for place in set(places)}
    start, end = np.array([ends[place] for place in places]).T
    if ((cells.nominal[on] >= start) & (cells.nominal[on] <= end)).any():
        return 0.0
    gap = math.cos(contact.beta_b) * cells.gap[on]
    closed = np.maximum(approach - gap, 1e-3 * approach)
    stiff, closing = load[on] / closed, approach - gap.min()
    return float(stiff @ _changed(contact, radius[on], gap, closed, closing) / stiff.sum() / closing)


def cracks_beyond_lines(cells, bodies, load, closing):
    """Return the part of the approach after first contact, `closing` [mm], that cracks outside the solved body may add."""
    out = 0.0
    for half in np.unique(cells.half).tolist():
        on = cells.half == half
        for (body, offset), sense, roll in zip(bodies[half], (1, -1), cells.rolls, strict=True):
            out += body.cracks_beyond(sense * cells.order[on], roll[on], cells.depth[on] + offset, load[on])
    return out / load.sum() / closing


def _cracks_beyond(contact, line):
    """Return the deflection ``(phases, pairs)`` [mm] that cracks may add to contacts on teeth outside the solved body."""
    out, order = np.zeros(line.shape), contact.found.order
    for flexible, teeth in zip(contact.flexibility, (order, -order), strict=True):
        beyond, most = cracks_beyond(flexible, teeth)
        far = ((line > 0) & beyond).any(axis=1)
        out += most * (far * line.sum(axis=1))[:, None]
    return out


def _cracks(contact, line, closing, shut):
    """Uncertain deflection ``(phases, pairs)`` [mm] by cracks in thin teeth, at large displacements and beyond `MOST`.

    The flexibility by a crack is proportional to ``h**-2``, with h the thickness of the tooth. The solved flexibility is that
    of the tooth without modifications. A tooth rotates about the tip of its crack by about u over the height of the tooth,
    where u is the deflection by the crack. The lever arm of the force changes by that ratio, and u with its square. The
    contact also moves along the tilted flank. With the tilt t by the crack, the approach changes by ``3/2 R t**2``, see
    `sliding`. This is uncertain for large tilts, as is the part beyond `MOST`. At the phases `shut`, faces of cracks touch,
    and only thin teeth count.
    """
    moved = np.maximum(contact.sliding * line**2 - MOST * closing[:, None], 0.0)
    out, teeth = np.zeros(line.shape), contact.found.teeth
    for flexible, numbers, thin, cracked in zip_longest(contact.flexibility, teeth, contact.thinning, contact.cracked):
        if cracked is not None:
            lost = np.array([thin.lost(tooth) for tooth in numbers.tolist()] if thin else 0.0)
            by_crack = cracked[0] * line
            out += ((1 - lost) ** -2 - 1) * by_crack
            moved += 2 * by_crack**2 / abs(flexible.gear.r_a - flexible.gear.r_f)
            moved += 1.5 * contact.radius * (line * cracked[1] / 2) ** 2
    return out + np.where(shut[:, None] | (line <= 0), 0.0, moved)


def cracked_contacts(contact):
    """Return for each gear the flexibility by open cracks and its `_slope` ``(phases, pairs)``, or None without cracks."""
    points, out, stop = contact.found, [], 0
    for flexible, roll, teeth in zip(contact.flexibility, points.rolls, points.teeth, strict=True):
        out.append(None)
        if flexible.seam is not None:
            faces = slice(stop, stop := stop + flexible.seam.influence.shape[0])
            by_crack = _quadratic(contact.opening[..., faces], flexible.seam.stiffness)
            out[-1] = by_crack, _slope(flexible, roll, teeth)
    return out


def _slope(flexible, roll, teeth):
    """Change of the flexibility by open cracks per length of flank ``(phases, pairs)``, from places one step to either side."""
    arc, step, seam = arc_at(flexible.gear, roll), STEP * flexible.gear.m_n, flexible.seam
    places = [flexible.clipped(arc + side, teeth) for side in (step, -step)]
    ahead, behind = (_quadratic(seam.at(place, (teeth % flexible.gear.z).tolist()), seam.stiffness) for place in places)
    apart = places[0] - places[1]
    return np.divide(ahead - behind, apart, out=np.zeros_like(apart), where=apart > 0)


def _cut_away(contact, line):
    """Return the additional deflection of contacts at the ridge of a chamfer ``(phases, pairs)`` [mm].

    The solved flexibility is that of the tooth without chamfer. The real tooth is a wedge there, narrower than a half-plane by
    the angle at which the flank turns. Between the contact's width and the chamfer's width, it is more compliant by about that
    part of two right angles.
    """
    points, out = contact.found, np.zeros(line.shape)
    for form, coefficient, roll in zip(contact.flanks or (), contact.coefficients, points.rolls, strict=False):
        if form.edge is None or form.edge.kink <= 0:
            continue
        gear, start = form.gear, form.edge.start
        arc, ridge, tip = (arc_at(gear, place) for place in (roll, start, gear.roll_a))
        width = half_width(np.maximum(line, 1e-9 * line.max()), contact.flat_radius, contact.modulus)
        part = math.atan(form.edge.kink * gear.r_b / start) / math.pi
        on = (line > 0) & (np.abs(arc - ridge) < width)
        out += np.where(on, coefficient * part * (np.log(np.maximum((tip - ridge) / width, 1.0)) + 0.5) * line, 0.0)
    return out

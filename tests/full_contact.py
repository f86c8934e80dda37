"""The independent check of the fast path: the whole contact zone as unknown pressures, no Hertz formula, no splitting.

Both flanks of every pair get a row of narrow hat pressures across the contact zone on a surface meshed for it; the full
influence matrix of all of them and the exact kinematic gaps make one linear complementarity problem. Slow, and used for
verification: the contact half width, the corner contact and the neighbour coupling all come out of it.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import hstack

from gearfe.contact.sharing import share
from gearfe.flexibility.finite_elements.elasticity import HeldSection
from gearfe.flexibility.finite_elements.fe import EDGES, flank_load
from gearfe.flexibility.hertz import contact_modulus, half_width
from gearfe.geometry.mesh.outline import stations
from gearfe.geometry.mesh.section_mesh import section
from gearfe.geometry.pair.approach import approach, facing
from gearfe.geometry.pair.modified import flank_contacts
from gearfe.geometry.tooth.profile import arc_at, roll_at_arc


@dataclass(frozen=True, slots=True)
class ContactZone:
    """What `full_contact` found.

    Attributes
    ----------
    approach : float
        [mm].
    force : ndarray, shape (pairs,)
        Line load of each pair [N/mm].
    roll_1, roll_2 : ndarray, shape (pairs,)
        Roll lengths of the centres of the contact pressures [mm].
    hat : tuple of ndarray
        Force of every hat, by pair [N/mm].
    arc : tuple of ndarray
        Arcs of their tops on the pinion from the base circle [mm].
    order : ndarray, shape (pairs,)
        As in `gearfe.geometry.pair.contacts.Contacts`.
    """

    approach: float
    force: np.ndarray
    roll_1: np.ndarray
    roll_2: np.ndarray
    hat: tuple
    arc: tuple
    order: np.ndarray


def full_contact(
    pair,
    line_load,
    phase,
    materials,
    *,
    state="plane strain",
    per_width=6,
    reach=3.0,
    refine=1.0,
    extended=True,
    flanks=None,
):
    """Solve the frictionless contact of all tooth pairs at one phase on the surface influence matrix.

    Parameters
    ----------
    pair : GearPair
    line_load : float
        Along the line of action, all pairs together [N/mm].
    phase : float
        Of the mean pose; `gearfe.stiffness.pose` says at which phase of the mean pose the gears of another pose stand.
    materials : tuple of Material
        Of pinion and wheel.
    per_width : int
        Hats per Hertz half width.
    reach : float
        The zone extends so many half widths to both sides of the expected contact, twice as far along a flank from a
        tip corner.
    refine : float
        Divides the edge lengths away from the zone.
    extended : bool
    flanks : (FlankForm, FlankForm), optional
        Modifications of pinion and wheel, `gearfe.geometry.pair.flanks.flank_forms`; the meshed teeth are the unmodified ones.

    Returns
    -------
    ContactZone
    """
    found = flank_contacts(pair, [phase], extended=extended, flanks=flanks)
    near = np.flatnonzero(found.gap[0] < 0.02 * pair.gear_1.m_n)
    order = found.order[near]
    first, second, gaps = [], [], []
    for k in near.tolist():
        arcs = _zone(pair, found, k, line_load, contact_modulus(materials, state), per_width, reach, flanks)
        first.append(arcs[0])
        second.append(arcs[1])
        gaps.append(arcs[2])
    total = 0.0
    teeth = (order - order.min(), order.max() - order)  # the loaded flank looks ahead on the pinion, back on the wheel
    for gear, material, zones, tooth in zip((pair.gear_1, pair.gear_2), materials, (first, second), teeth, strict=True):
        total = total + _influence(gear, material, state, dict(zip(tooth.tolist(), zones, strict=True)), refine)
    hat, approach = share((total + total.T) / 2, np.concatenate(gaps), line_load)
    hat = np.split(hat, np.cumsum([g.size for g in gaps])[:-1])
    means = [[h @ z / h.sum() if h.sum() > 0 else np.nan for h, z in zip(hat, zones, strict=True)] for zones in (first, second)]
    rolls = [roll_at_arc(g, mean) for g, mean in zip((pair.gear_1, pair.gear_2), means, strict=True)]
    return ContactZone(approach, np.array([h.sum() for h in hat]), *rolls, tuple(hat), tuple(first), order)


def _zone(pair, found, k, line_load, modulus, per_width, reach, flanks):
    """Arcs of the hat tops on both flanks [mm] and their gaps [mm], pinion arc rising."""
    roll_1, roll_2 = found.roll_1[0, k], found.roll_2[0, k]
    a = float(half_width(line_load, pair.relative_radius(roll_1, roll_2), modulus))
    driver = abs(roll_2 - pair.gear_2.roll_a) > 1e-9 * pair.gear_2.m_n
    gear, roll = (pair.gear_1, roll_1) if driver else (pair.gear_2, roll_2)
    middle, top = arc_at(gear, roll), arc_at(gear, gear.roll_a)
    arc = middle + a / per_width * np.arange(-round(2 * reach * per_width), round(reach * per_width) + 1)
    if top - middle > reach * a:
        arc = arc[arc >= middle - (reach + 1e-9) * a]
    else:
        arc = arc + max(top - middle - a / per_width * np.floor((top - middle) * per_width / a), 0.0)
    arc = arc[(arc <= top + 1e-9 * a) & (arc > arc_at(gear, gear.roll_f))]
    nominal = np.full(arc.shape, found.nominal[0, k])
    if flanks is None:
        gap, met = facing(pair, roll_at_arc(gear, arc), nominal, driver)(0.0)[:2]
    else:
        own = {"start": found.gap[0, k], "flanks": flanks, "order": found.order[k]}
        gap, met = approach(pair, roll_at_arc(gear, arc), nominal, driver=driver, **own)[:2]
    other = pair.gear_2 if driver else pair.gear_1
    faced = arc_at(other, np.nan_to_num(met, nan=-1.0))
    there = np.isfinite(met) & (faced <= arc_at(other, other.roll_a)) & (faced > arc_at(other, other.roll_f))
    arc, faced, gap = arc[there], faced[there], gap[there]
    return (arc, faced, gap) if driver else (faced[::-1], arc[::-1], gap[::-1])


def _influence(gear, material, state, zones, refine):
    """Influence matrix [mm per N/mm] between hats at arcs ``zones[tooth]`` on the loaded flanks."""
    m = gear.m_n / refine
    low, high = arc_at(gear, gear.roll_f), arc_at(gear, gear.roll_a)
    rolls, loads = {}, {}
    for tooth, tops in zones.items():
        rising = np.sort(tops)
        step = np.diff(rising)
        fine = np.sort(np.concatenate([rising, rising[:-1] + step / 2]))
        outside = stations(
            gear, EDGES["flank"] * m, tip=step[-1], low=EDGES["low"] * m, patches=[(fine[0], fine[-1], step.min() / 2)]
        )
        arc = arc_at(gear, outside)
        margin = step.min() / 3
        arc = arc[(arc < fine[0] - margin) | (arc > fine[-1] + margin)]
        arc = np.sort(np.concatenate([arc, fine]))
        arc[0], arc[-1] = low, high
        rolls[tooth] = roll_at_arc(gear, arc)
    mesh = section(gear, rolls, fillet_size=EDGES["fillet"] * m, size=EDGES["near"] * m, far_size=EDGES["far"] * m)
    for tooth, tops in zones.items():
        loads[tooth] = _hats_at(mesh, tooth, tops)
    load = hstack([loads[tooth] for tooth in zones]).tocsc()
    body = HeldSection(mesh.mesh, material, state=state)
    return load.T @ body.solve(load)


def _hats_at(mesh, tooth, tops):
    """Unit-resultant hats at arcs `tops` (any order, neighbours as knots; one-sided at a corner)."""
    gear = mesh.gear
    sort = np.argsort(tops)
    rising = tops[sort]
    step = np.diff(rising)
    top_arc = arc_at(gear, gear.roll_a)
    start = rising - np.concatenate([step[:1], step])
    stop = np.minimum(rising + np.concatenate([step, step[-1:]]), top_arc)
    area = (stop - start) / 2

    def height(s):
        low, mid, high, size = (v[:, None, None] for v in (start, rising, stop, area))
        rise = np.where(s <= mid, (s - low) / (mid - low), (high - s) / np.where(high > mid, high - mid, 1.0))
        return np.maximum(rise, 0.0) / size

    load = flank_load(mesh, tooth, height, np.zeros(tops.size, dtype=int), mesh.roll[tooth].size - 1)
    return load[:, np.argsort(sort)]

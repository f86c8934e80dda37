"""Nonlinear contact of one pair in CalculiX compared with `ritz`, for the page `truth`."""

import math
import tempfile
from pathlib import Path

import numpy as np

import gearfe as gf
from gearfe.core.units import in_newton_per_um

from ..shared.decks import calculix
from ..shared.places import TABLES

CONTACT = TABLES / "calculix.csv"
# line load [N/mm]; number of phases; distance from the ends of double contact [mesh cycles]
LINE_LOAD, PHASES, NEAR = 150.0, 12, 0.06
PENALTY = 500.0  # setting of `write_contact_inp`: pressure per overlap [E/mm]


def contact_pair():
    """Return the pair of the contact comparison, with profile shifts and unequal gears. No scene or other test uses it."""
    rack = {"m_n": 2.5, "alpha_n": math.radians(20), "b": 20.0}
    pair = gf.GearPair(gf.Gear(z=23, x=0.2, r_bore=12.0, **rack), gf.Gear(z=37, x=-0.05, r_bore=20.0, **rack))
    return pair, gf.Material(E=206e3, nu=0.3)


def away(pair, phase):
    """Distance of a phase from the nearest end of double tooth contact, in mesh cycles."""
    ends = np.array([0.0, pair.eps_alpha % 1.0])
    apart = np.abs((phase - ends + 0.5) % 1.0 - 0.5)
    return float(apart.min())


def contact_row(phase):
    """Return (phase, k of `ritz`, k of CalculiX by nonlinear contact at the same approach) [N/m]."""
    pair, steel = contact_pair()
    curve = gf.mesh_stiffness(pair, LINE_LOAD * pair.gear_1.b, steel, phases=[phase])
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        deck = gf.write_contact_inp(folder / "pair.inp", pair, phase, float(curve.deflection[0]) * 1e3, LINE_LOAD, (steel, steel))
        calculix(folder, "pair")
        force = deck.force(folder / "pair.dat")
    return phase, float(curve.k[0]), force * pair.gear_1.b / float(curve.deflection[0])


def springs(phases):
    """Return the relative increase of the approach by the contact springs of CalculiX, `PENALTY` E times the overlap.

    Under the Hertzian pressure, the springs overlap by ``8 p0 / (3 pi)`` over their stiffness, weighted with the work of the
    pressure. The pairs are weighted with their loads. The result is None where a corner carries load, because its pressure has
    no maximum.
    """
    pair, steel = contact_pair()
    curve = gf.mesh_stiffness(pair, LINE_LOAD * pair.gear_1.b, steel, method="ritz", phases=phases)
    overlap = 8 / (3 * math.pi) * curve.pressure / (PENALTY * steel.E * 1e6) * 1e-3  # m
    added = np.where(curve.force > 0, curve.share * overlap, 0.0).sum(axis=1) / curve.deflection
    return [None if math.isnan(one) else one for one in added.tolist()]


def read_contact():
    """Return stored phases, k of `ritz` and k of CalculiX [N/m] as columns."""
    return np.loadtxt(CONTACT, delimiter=",", skiprows=1, unpack=True)


def contact_worst():
    """Return the largest differences from CalculiX in contact [%], far from and near the ends of double contact."""
    pair, _ = contact_pair()
    phase, ours, theirs = read_contact()
    far = np.array([away(pair, one) >= NEAR for one in phase])
    worst = 100 * np.abs(ours / theirs - 1)
    return worst[far].max(), worst[~far].max() if (~far).any() else math.nan


def contact_text():
    """Return the section of the page on contact."""
    pair, _ = contact_pair()
    phase, ours, theirs = read_contact()
    lines = [
        f"""
        ## Nonlinear contact in CalculiX

        CalculiX has both gears of a pair {pair.gear_1.z}/{pair.gear_2.z} (m 2.5, x {pair.gear_1.x:g}/{pair.gear_2.x:g},
        bores 12/20 mm, {LINE_LOAD:g} N/mm). They are meshed for each phase with eight edges per Hertzian half-width. All flanks
        have surface-to-surface contact (`gearfe.write_contact_inp`). Each gear is rotated by half of the approach of `ritz`
        (mean pose). Double contact begins at phase 0 and ends at {pair.eps_alpha % 1:.4f}.

        | phase | gearfe, ritz [N/um] | CalculiX [N/um] | difference | less its springs | from double contact's ends [cycles] |
        |---|---|---|---|---|---|
        """
    ]
    soft = springs(phase)
    for one, a, b, added in zip(phase, ours, theirs, soft, strict=True):
        values = f"{in_newton_per_um(a, 5)} | {in_newton_per_um(b, 5)}"
        left = "" if added is None else f"{100 * (a / b - 1 - added):+.3f} %"
        lines.append(f"| {one:.4f} | {values} | {100 * (a / b - 1):+.3f} % | {left} | {away(pair, one):.3f} |")
    far, near = contact_worst()
    told = "" if math.isnan(near) else f", and {near:.3f} % nearer"
    lines += [
        "",
        f"The largest difference is {far:.3f} % at least {NEAR:g} cycles from an end of double contact (limit: 0.5 %){told}.",
    ]
    part = [100 * one for one in soft if one is not None]
    lines += [
        f"""
        CalculiX is softer at all phases because its contact consists of springs with {PENALTY:g} E per mm of overlap. The
        Hertzian pressure p0 compresses them by 8 p0 / (3 pi) over this stiffness, which is {min(part):.3f} to {max(part):.3f} %
        of the approach. The fifth column excludes this compression, and its differences have both signs. It is empty where a
        tip corner carries load, because the pressure has no finite peak there.
        """,
    ]
    return lines

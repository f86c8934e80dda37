"""Cases of the frozen page `three`, CalculiX on whole gears under line loads and in contact, and `ritz3d` in them.

A run depends only on its deck, whose digest is in its row. Gears in contact are rotated by the approach of `ritz3d` at the time
of the run, which is stored in the row. A change of `ritz3d` alone therefore requires no new run.
"""

import math
from dataclasses import dataclass, field

import numpy as np

import gearfe as gf
from gearfe.core.threads import own_warnings
from gearfe.flexibility import solid as flexibility3d
from gearfe.flexibility.energy.ritz import solid as ritz3d
from gearfe.flexibility.energy.ritz.join import join
from gearfe.flexibility.energy.ritz.panel3d import SolidModel

from . import kept_rows

TABLE, OURS = "outsider_three", "outsider_three_ritz3d"  # tables of CalculiX and of `ritz3d`
STEEL = gf.Material(E=207e3, nu=0.3)
LOAD = 300.0  # line load [N/mm]
PITTED = 600.0  # [N/mm] line load of pairs with pits; the wider contact requires fewer elements around the pits
PITS = {"cut": "cut out", "lost": "as lost contact", "filled": "filled"}  # by treatment of pits in the deck: label
STRIP = ({"per_width": 1.0}, {"per_width": 1.5})  # refinement along the contact lines only
# Meshes of pairs with pits, whose rims are refined in proportion. Contact springs are ten times softer than the default, which
# reduces k by less than 0.1 %.
RIMS = ({"per_width": 0.67, "penalty": 50}, {"per_width": 1.0, "refine": 1.4, "penalty": 50})
ALL_FINER = {"per_width": 1.0, "refine": 1.3}  # uniform refinement
RACK = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 6.0}


@dataclass(frozen=True, slots=True)
class OutsiderCase:
    """Pair for CalculiX: `damage` of `mesh_stiffness`, phase, load [N/mm], and meshes as options of `write_contact_inp`.

    `write_contact_inp` describes `pits`. A case with pits has two controls in the same mesh.
    """

    pair: gf.GearPair
    phase: float = 0.45
    damage: dict = field(default_factory=dict)
    pits: str = "cut"
    meshes: tuple = STRIP[1:]
    load: float = LOAD


def pinion(degrees=15.0):
    """Return the small gear of all cases."""
    return gf.Gear(z=13, x=0.3, r_bore=8.0, beta=math.radians(degrees), **RACK)


def pair_of(degrees):
    """Return the external pair 13/16."""
    return gf.GearPair(pinion(degrees), gf.Gear(z=16, x=0.2, r_bore=10.0, beta=-math.radians(degrees), **RACK))


def ring_pair():
    """Return a pinion in a ring of 36 teeth."""
    with own_warnings():  # The expected warning states that the tip of the ring is trimmed.
        ring = gf.Gear(z=36, r_rim=45.0, rack_tip_radius=0.2, addendum=0.8, beta=math.radians(15), **RACK)
        return gf.GearPair(pinion(), ring)


def pits():
    """Return two pits (circular and elliptic) with centres on the contact line of the pinion's tooth 0."""
    return [
        gf.Pit(radius=13.13, z=1.8, axes=(0.4, 0.4), depth=0.2),
        gf.Pit(radius=13.31, z=4.2, axes=(0.35, 0.7), depth=0.2),
    ]


def cases():
    """Return the contact cases by name, in order of importance."""
    crack, part = gf.Crack(level=0.5), gf.Crack(level=0.5, width=(0.0, 3.0))
    return {
        "helical, healthy": OutsiderCase(pair_of(15.0), meshes=(*STRIP, ALL_FINER)),
        "helical, crack 50 %": OutsiderCase(pair_of(15.0), damage={"pinion": [crack]}),
        "helical, crack 50 % over half the width": OutsiderCase(pair_of(15.0), damage={"pinion": [part]}),
        "spur, healthy": OutsiderCase(pair_of(0.0)),
        "ring, healthy": OutsiderCase(ring_pair()),
        **_with_control("helical, two pits", pits(), RIMS),
    }


def _with_control(name, damage, meshes):
    """Return a case with pits cut out, and controls on the same mesh: contact lost there, and no pits."""
    options = {"damage": {"pinion": damage}, "meshes": meshes, "load": PITTED}
    return {f"{name} {end}": OutsiderCase(pair_of(15.0), pits=kind, **options) for kind, end in PITS.items()}


def lines():
    """Return single gears under a line load by name: gear, cracks."""
    ring = ring_pair().gear_2
    return {
        "line load, spur": (pinion(0.0), ()),
        "line load, helical": (pinion(), ()),
        "line load, crack 50 %": (pinion(), (gf.Crack(level=0.5),)),
        "line load, ring": (ring, ()),
    }


LINE_MESHES = ({"refine": 0.6}, {"refine": 0.8})


def line_hat(gear):
    """Return the number of the hat function at which a line load acts, and its roll length [mm]."""
    knots = flexibility3d.hats(gear)
    whole = np.flatnonzero(np.isclose(np.diff(knots, axis=0), flexibility3d.HAT * gear.m_n, rtol=1e-9).all(axis=0))
    top = int(whole[len(whole) // 2])
    return top, math.sqrt(2 * gear.r_b * gear.outward * knots[1, top])


def line_deflection(name):
    """Return the deflection [nm/N] under a line load by `ritz3d`."""
    gear, cracks = lines()[name]
    axial = ritz3d.axial_degree(gear.b, gear.m_n)
    panels = [ritz3d.solid_sector(SolidModel(gear, STEEL, axial=axial), own) for own in (cracks, ())]
    found, _ = join(gear, {0: panels[0], 1: panels[1]}, panels[1])
    at = line_hat(gear)[0] * (axial + 1)
    return 1e6 * found[0, 0][at, at] / gear.b


def line_deck(folder, name, mesh):
    """Write the deck of a line load into a folder."""
    gear, cracks = lines()[name]
    radius, half = math.hypot(line_hat(gear)[1], gear.r_b), flexibility3d.HAT * gear.m_n
    return gf.write_line_inp(folder / "gear.inp", gear, radius, 100.0, STEEL, cracks=cracks, half_width=half, **mesh)


def contact_deck(folder, name, mesh, approach):
    """Write the deck of a pair in contact, closed by an approach [mm], into a folder."""
    case = cases()[name]
    face = "helical" if case.pair.gear_1.beta else "spur"
    options = {"face": face, "damage": case.damage, "pits": case.pits, **mesh}
    return gf.write_contact_inp(folder / "pair.inp", case.pair, case.phase, approach, case.load, (STEEL, STEEL), **options)


def ritz3d_row(name):
    """Return the result of `ritz3d` in a case: deflection [nm/N], or stiffness [N/um] and approach [mm]."""
    if name in lines():
        return {"value": line_deflection(name)}
    case = cases()[name]
    damage = case.damage
    if case.pits == "filled":
        damage = {side: [one for one in own if isinstance(one, gf.Crack)] for side, own in damage.items()}
    run = {"method": "ritz3d", "phases": [case.phase], "damage": damage}
    force = case.load * case.pair.gear_1.b
    curve = gf.mesh_stiffness(case.pair, force, STEEL, **run)
    return {"value": float(curve.k[0]) / 1e6, "approach": 1e3 * float(curve.deflection[0])}


def told(mesh):
    """Return the options of a mesh as text."""
    return ", ".join(f"{key} {value:g}" for key, value in mesh.items())


def stored():
    """Return the runs of CalculiX on file by (case, mesh), each with what `ritz3d` finds: `ours`."""
    theirs, ours = kept_rows.stored(TABLE), kept_rows.stored(OURS)
    runs = [(name, told(mesh)) for name in lines() for mesh in LINE_MESHES]
    runs += [(name, told(mesh)) for name, case in cases().items() for mesh in case.meshes]
    return {(name, mesh): {"ours": ours[name]["value"]} | theirs[f"{name}, {mesh}"] for name, mesh in runs}

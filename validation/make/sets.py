"""The page `sets`: a whole planetary set in one contact, planets and supports counted through, and beside CalculiX."""

import math
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

import gearfe as gf
from gearfe.flexibility.solved import SolvedGears
from gearfe.planetary_sets.standing import standing, tooth_angles

from ..shared import page
from ..shared.decks import calculix
from ..shared.kept_rows import kept, stored
from ..shared.places import PAGES
from . import sets_cracks

TABLE, PICTURE = "sets_calculix", PAGES / "sets_bent.png"
STEEL = gf.Material(E=207e3, nu=0.3)
RACK = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 20.0}
FORCE = 2000.0  # N a mesh of the sun
RIMS = (5.0, 8.0, 12.0)  # mm, from the root circle
SUPPORTS = (3, 4, 6, 12)
PLANETS = {1: (0,), 3: (0, 50, 100), 4: (0, 38, 75, 113), 5: (0, 30, 60, 90, 120)}  # in parts of a turn, z_s + z_r of them
PAD = 5.0  # mm
SAMPLES = 32  # positions over a pitch of the supports, their mesh phases spread evenly, too
GOLDEN = (math.sqrt(5) - 1) / 2
AT = 0.3  # position of the set that CalculiX has: two pairs in every mesh
STANDS = {"at a support": 0.0, "between two": math.pi / 6}  # of six pads of 4.8 mm: angle from planet 0 to the next
ERROR = 0.002  # mm by which planet 0 stands ahead
AWAY = 1.0  # mm beside a pad, from where on the ring's deflection is compared
HELD = "held all around"
INTRO = f"""
A pair is solved alone as if each gear were held at its bore or rim. In a set the planets twist one sun together, a planet passes
its torque on to the ring, so that its bore takes none, and a ring on a few supports bends between them.
`gearfe.planetary_stiffness` solves all meshes of a set in one contact problem, in plane strain.

## Planets and supports

A set of N planets, 45/30/105 teeth, m_n = 2 mm, width 20 mm; the mean force of a mesh is {FORCE:g} N, the axis of the sun is
held. The ring is held all around or on rigid, equally spaced pads of {PAD:g} mm, the supports; its rim is as thick as the table
says, outside of the root circle. Four planets do not fit equally spaced: they stand at 0, 91.2, 180 and 271.2 degrees. Columns:
stiffness k of both kinds of mesh, means of all planets over {SAMPLES} positions, spread over a pitch of the supports, and for
planet and ring the least and the largest value; mesh load factor K_gamma, the largest load of a planet over the mean; TE, the
transmission error under load, peak to peak; kind, see below. The line above the table has k of the isolated pairs.

Three kinds of behaviour appear, by the common divisor of N planets and n supports. **Together**: n is a multiple of N, all
planets pass supports at the same time (four only nearly); equally spaced ones carry the same, and the set gives way much as a
single planet does, in the rhythm of the supports. **In groups**: n and N have a common divisor, but n is no multiple of N.
**In turn**: they have none, planets pass supports one after the other, so that loads wander from planet to planet while the
transmission error feels the supports much less. An article with a two-dimensional model of finite elements (Adv. Mech. Eng., doi
10.1177/16878132221123469) also classifies sets into three by the behaviour of mesh forces and transmission error; only its
abstract was at hand, so that whether these are the same three is not known.
"""
OUTSIDE = f"""
## CalculiX

A set of 21/31/84 teeth, N = 3, six rigid pads of 4.8 mm on a rim of 9.4 mm, the pin of planet 0 ahead by {1e3 * ERROR:g} um so
that loads differ. The deck (`gearfe.write_set_inp`) has all gears with all teeth in second-order triangles (CPE6) and
frictionless surface-to-surface contact of all flanks that may touch. In it sun and planets are turned by what was found here, and
CalculiX gives the force of every mesh, from the reactions of sun, ring and pins; so forces differ by as many per cent as k does.
Both sides share the gears' outlines, where the gears stand, and small displacements. The last lines compare how the ring's outer
edge moves, {AWAY:g} mm and more away from the pads: the largest difference over the largest displacement. Closer to the pads
`gearfe` gives the edge's displacement only smoothed over some edges of its mesh.

"At a support" and "between two" say where planet 0 is.
"""
PROOF = """
## What else was checked

`tests/planetary_sets`, largest relative differences in brackets: meshes that do not feel each other are isolated pairs (1e-6, tip
corners included); forces on sun, planets and pads are in balance (1e-10); equal planets carry the same (1e-9); planets on elastic
pins with position errors are springs in series; very stiff springs are rigid; teeth touch at the places, and with the numbers,
that the set names; the ring on pads is that of finite elements of the whole ring (0.2 % of what the pads let it give way); how
far teeth move under loads on others is that of the energy method, elements of order 4; a machine that takes its meshes from a
set (`gf.with_set`) has at rest the set's turn of the sun and the set's mesh forces (1e-6), with the ring's motion in k and
with the ring as a body.

A cracked gear between its meshes, and a cracked ring on pads, are those of finite elements of the whole gear with its crack, its
faces free and in contact (0.2 and 0.3 % of the largest).

Left out: friction and changes along the width; the carrier is rigid. Where a mesh carries much less than others, its k says
little about its teeth: it is mostly how the loads of the others move its gears.
"""
HOW = "`python -m validation sets` makes this page. `... sets --reference` has CalculiX compute `tables/sets_calculix.jsonl`."
MACHINES = "What the set does to the machines of the articles: [sets_machines.md](sets_machines.md)."


def gears(planets=1, rim=8.0):
    """The set of the table."""
    sun, planet = gf.Gear(z=45, r_bore=20.0, **RACK), gf.Gear(z=30, r_bore=12.0, **RACK)
    ring = gf.Gear(z=105, r_rim=107.5 + rim, addendum=0.8, rack_tip_radius=0.3, **RACK)
    return gf.PlanetarySet(sun, planet, ring, planets)


def case(planets, rim, supports):
    """A case of the table; without supports the rim is held."""
    angles = 2 * math.pi / 150 * np.array(PLANETS[planets])
    ring = gf.RimSupports(supports, PAD) if supports else "held"
    return gf.PlanetaryCase(gears(rim=rim), FORCE, STEEL, planet_angles=angles, ring=ring)


def kind(planets, supports):
    """Which of the three kinds."""
    if not supports or planets == 1:
        return ""
    common = math.gcd(planets, supports)
    return "together" if common == planets else "in turn" if common == 1 else "in groups"


def positions(supports):
    """Turns of the sun [pitches] over a pitch of the supports (a mesh cycle of a ring that is held)."""
    at = np.arange(SAMPLES) / SAMPLES
    cycles = 105 / supports if supports else 1.0
    whole = np.floor(at * cycles)
    return whole + (np.arange(SAMPLES) * GOLDEN) % 1.0 if supports else at


def table():
    """Lines of the table; least and largest k of planet and ring on supports over that of the isolated pair, by means."""
    alone = gf.planetary_stiffness(case(1, RIMS[1], 0), SAMPLES).k_alone.mean(axis=(1, 2)) / 1e6
    lines = [
        f"""
        Isolated pairs: k of sun and planet {alone[0]:.0f}, of planet and ring {alone[1]:.0f} N/um.

        | N | rim [mm] | supports | k sun-planet [N/um] | k planet-ring | least | largest | K_gamma | TE [um] | kind |
        |---|---|---|---|---|---|---|---|---|---|
        """
    ]
    parts = []
    for planets in PLANETS:
        for rim in RIMS:
            for supports in (0, *SUPPORTS):
                found = gf.planetary_stiffness(case(planets, rim, supports), positions(supports))
                outer, inner = found.k / 1e6
                parts += [inner.mean() / alone[1]] if supports else []
                lines.append(
                    f"| {planets} | {rim:g} | {supports or HELD} | {outer.mean():.0f} | {inner.mean():.0f} | {inner.min():.0f} | "
                    f"{inner.max():.0f} | {found.K_gamma:.3f} | {1e6 * np.ptp(found.te):.2f} | {kind(planets, supports)} |"
                )
    return lines, min(parts), max(parts)


def small(first):
    """The set that CalculiX has, its first pad at an angle from planet 0 [rad]."""
    sun, planet = gf.Gear(z=21, r_bore=7.4, **RACK), gf.Gear(z=31, r_bore=11.4, **RACK)
    ring = gf.Gear(z=84, r_rim=95.0, x=-0.4617, addendum=0.85, rack_tip_radius=0.3, **RACK)
    made = gf.PlanetarySet(sun, planet, ring, 3)
    angles = 2 * math.pi / 3 * np.arange(3)
    support = gf.RimSupports(6, 4.8, first=first - tooth_angles(made, angles, standing(made, angles, [AT]))[2])
    return gf.PlanetaryCase(made, FORCE, STEEL, ring=support, errors=[(0, ERROR), (0, 0), (0, 0)])


def outside(first):
    """One run of CalculiX beside what was found here."""
    found = gf.planetary_stiffness(small(first), [AT])
    with tempfile.TemporaryDirectory() as folder:
        deck = gf.write_set_inp(Path(folder) / "set.inp", found, 0, per_width=3.0)
        seconds = calculix(Path(folder), "set")
        forces, (angle, moved) = deck.forces(Path(folder) / "set.dat"), deck.moved(Path(folder) / "set.dat")
    ours = 1e3 * np.array(
        [np.interp(angle, found.ring_angle % (2 * math.pi), values, period=2 * math.pi) for values in found.ring_moved[0].T]
    )
    ring, gear = found.meta["case"].ring, found.meta["case"].ring_gear
    away = np.abs((angle[:, None] - ring.middles + math.pi) % (2 * math.pi) - math.pi).min(axis=1) * gear.r_rim - ring.width / 2
    clear = away > AWAY
    return {
        "seconds": seconds,
        "forces": {name: (forces[name] * 20.0).tolist() for name in ("outer", "inner")},
        "ours": {name: found.force[k, 0].tolist() for k, name in enumerate(("outer", "inner"))},
        "ring": float(np.abs(moved).max()),
        "ring_ours": float(np.abs(ours).max()),
        "apart": float(np.abs(moved - ours.T)[clear].max() / np.abs(moved).max()),
    }


def outsider():
    """Lines on CalculiX, from the rows on file."""
    known = stored(TABLE)
    lines = [
        "| planet | mesh | force here [N] | CalculiX [N] | apart | force over the mean, here | CalculiX |",
        "|---|---|---|---|---|---|---|",
    ]
    rings = []
    for name in STANDS:
        if name not in known:
            continue
        row = known[name]
        for mesh in ("outer", "inner"):
            ours, theirs = (np.array(row[who][mesh]) for who in ("ours", "forces"))
            for planet in range(3):
                lines.append(
                    f"| {name}, planet {planet} | {'sun-planet' if mesh == 'outer' else 'planet-ring'} | {ours[planet]:.1f} | "
                    f"{theirs[planet]:.1f} | {100 * (ours[planet] / theirs[planet] - 1):+.2f} % | "
                    f"{ours[planet] / ours.mean():.4f} | {theirs[planet] / theirs.mean():.4f} |"
                )
        rings.append(
            f"Ring {name}: largest displacement {1e3 * row['ring_ours']:.3f} um here, {1e3 * row['ring']:.3f} um by CalculiX; "
            f"{100 * row['apart']:.2f} % apart at most."
        )
    return [OUTSIDE, "", *lines, "", *rings]


def worst():
    """Largest difference of a force from CalculiX."""
    rows = stored(TABLE).values()
    return max(
        abs(a / b - 1)
        for row in rows
        for mesh in ("outer", "inner")
        for a, b in zip(row["ours"][mesh], row["forces"][mesh], strict=True)
    )


def cost():
    """A line on CPU seconds: new gears, and a cycle of 32 positions."""
    made, started = SolvedGears(), time.process_time()
    one = small(0.0)
    gf.planetary_stiffness(one, [AT], error=False, cache=made)
    new, started = time.process_time() - started, time.process_time()
    gf.planetary_stiffness(one, 32, error=False, cache=made)
    return [
        f"""
        ## Cost

        CPU seconds of the set of 21/31/84 teeth on six pads, on the machine that made this page: all gears new and one
        position {new:.1f}, then 32 positions {time.process_time() - started:.1f}.
        """,
    ]


def reference():
    """Compute the runs of CalculiX."""
    for name, first in STANDS.items():
        kept(TABLE, name, lambda first=first: outside(first), again=True)


def run(again=True):
    """Write the page; `again`: compute its rows again."""
    shown = small(STANDS["between two"]).with_(gears=_thin(), errors=None)
    gf.plot_planetary_set(gf.planetary_stiffness(shown, [AT]), 0, PICTURE)
    lines, least, most = table()
    answer = (
        f"Forces of all meshes of a set of three planets on six supports are within {100 * worst():.2f} % of CalculiX's, in one "
        f"contact of the whole set; k of planet and ring on supports is {least:.2f} to {most:.2f} times the isolated pair's."
    )
    drawn = [
        f"""
        ![A set of 21/31/84 teeth on six pads, bent by its load]({PICTURE.name})

        21/31/84 teeth, rim of 5.4 mm, planets between the pads (triangles).
        """,
    ]
    page.write(
        "sets",
        answer,
        [INTRO, "", *lines, *drawn],
        [MACHINES],
        outsider(),
        sets_cracks.section(),
        PROOF,
        cost(),
        [HOW],
    )


def _thin():
    made = small(0.0).gears
    return replace(made, ring=replace(made.ring, r_rim=91.0))


def cheap():
    """Rows that `validation.check` computes again: forces of all meshes of the set that CalculiX has."""
    for name, first in STANDS.items():
        known = stored(TABLE)[name]["ours"]
        yield name, list(known.values()), lambda first=first: gf.planetary_stiffness(small(first), [AT]).force[:, 0].tolist()

"""Chips in three dimensions: CalculiX on whole gears in contact, its runs kept in a table.

The hexahedra with a chip of the whole width become those with a chip of a part. Beyond that part the nodes above the corner are
stretched from the cut to the whole flank. The wall at the end of the chip rises over a layer of elements of the height `WALL`.
`reference` computes ``chips_three.jsonl`` if ``ccx`` is installed: ``python -m tests.chips_three``.
"""

import math
from dataclasses import replace
from unittest.mock import patch

import numpy as np
from usual import PAIR_17_38 as PAIR

import gearfe as gf
from gearfe.decks import contact_solid
from gearfe.geometry.mesh import solid as mesh
from gearfe.geometry.mesh import tooth_pieces
from validation.shared import kept_rows
from validation.shared.decks import installed, pressed

TABLE = "chips_three"
STEEL, FORCE = gf.Material(E=206e3, nu=0.3), 1669.3
WALL = 0.5  # mm
CUT = 0.15  # edge length on the cut, which becomes flank beyond the part [mm]


def cases():
    """Chips of the pinion and phases, by name."""
    half = gf.Chip(depth=1.0, width=(0.0, 7.5))
    return {
        "rounded, corner in contact": (gf.Chip(depth=1.0, radius=2.0), 1.45, 0.5),
        "rounded, flank in contact": (gf.Chip(depth=1.0, radius=2.0), 1.3, 0.5),
        "half the width, beyond the corner": (half, 1.5, 0.5),
        "half the width, corner in contact": (half, 1.4, 0.55),
    }


def case_of(chip):
    """Return the pair with a chip of the pinion."""
    return gf.Case(PAIR, FORCE, STEEL, damage={"pinion": [chip]})


def ours(name):
    """Return the curve of `ritz3d` at the phase of a case, with its estimate."""
    chip, phase, _ = cases()[name]
    return gf.solve(case_of(chip), gf.Solve("ritz3d", np.array([phase]), error=True))


def deck_of(folder, name, approach):
    """Write the deck of a case closed by an approach [mm]."""
    chip, phase, refine = cases()[name]
    through = case_of(replace(chip, width=None))
    options = {"face": "spur", "refine": refine}
    if chip.through:
        return gf.write_contact_inp(folder / "pair.inp", through, phase, approach, **options)
    plain_tip = tooth_pieces._tip

    def tip(gear, edge, corner, cut):
        return plain_tip(gear, edge if cut is None else min(edge, CUT / refine), corner, cut)

    with (
        patch.object(tooth_pieces, "_tip", tip),
        patch.object(mesh, "quad_section", _with_cut(mesh.quad_section, chip)),
        patch.object(contact_solid, "solid", _stretched(contact_solid.solid, chip)),
        patch.object(contact_solid, "touching", _both(contact_solid.touching, chip)),
    ):
        return gf.write_contact_inp(folder / "pair.inp", through, phase, approach, **options)


def _cut_angle(chip, radius):
    """Angle [rad] of the cut at radii [mm]."""
    x, y = chip._face(PAIR.gear_1)[1](np.linspace(0, 1, 4001))
    return np.interp(radius, np.hypot(x, y), np.arctan2(x, y))


def _corner(chip):
    return math.hypot(chip.cut(PAIR.gear_1)[0], PAIR.gear_1.r_b)


def _with_cut(quad_section, chip):
    """Sections in which the edges of the cut are among those of the flank."""

    def made_with(gear, **options):
        made = quad_section(gear, **options)
        if not options["broken"]:
            return made
        ends = np.array([made.quads[:4], np.roll(made.quads[:4], -1, axis=0)]).reshape(2, -1)
        radius, angle = np.hypot(*made.points), np.arctan2(*made.points)
        on = (np.abs(angle - _cut_angle(chip, radius)) * radius < 2e-4) & (radius > _corner(chip) - 1e-6)
        edges = np.array([ends[0], made.quads[4:].ravel(), ends[1]])
        once = np.bincount(edges[1], minlength=radius.size)[edges[1]] == 1
        edges = edges[:, on[edges].all(axis=0) & once]
        edges = np.where(radius[edges[0]] > radius[edges[2]], edges[::-1], edges)
        edges = edges[:, np.argsort(radius[edges[1]])]
        return replace(made, flank=made.flank | {0: np.hstack([made.flank[0], edges])})

    return made_with


def _stretched(solid, chip):
    """Bodies whose tooth 0 is whole beyond the width of the chip."""
    plain = mesh.layers
    ends = [end for end in chip.width if 0 < end < PAIR.gear_1.b]

    def layers(b, size, breaks=(), fine=()):
        walls = [end + side * WALL / 2 for end in ends for side in (-1, 1)]
        return plain(b, size, breaks=[*breaks, *walls], fine=[*fine, *((end, end, WALL) for end in ends)])

    def made_with(gear, **options):
        if not options["broken"]:
            return solid(gear, **options)
        with patch.object(mesh, "layers", layers):
            made = solid(gear, **options)
        x, y, z = made.points
        radius, angle = np.hypot(x, y), np.arctan2(x, y)
        inside = [np.clip(sign * (z - end) / WALL + 0.5, 0, 1) for end, sign in zip(chip.width, (1, -1), strict=True)]
        inside = [part if 0 < end < gear.b else np.ones(z.size) for part, end in zip(inside, chip.width, strict=True)]
        tooth = np.flatnonzero((radius > _corner(chip) + 1e-9) & (np.abs(angle) < math.pi / gear.z))
        half = np.array([gear.half_thickness(r) for r in radius[tooth].tolist()])
        stretch = 2 * half / (_cut_angle(chip, radius[tooth]) + half) - 1
        turned = -half + (angle[tooth] + half) * (1 + (1 - np.minimum(*inside)[tooth]) * stretch)
        points = made.points.copy()
        points[:2, tooth] = radius[tooth] * np.array([np.sin(turned), np.cos(turned)])
        return replace(made, points=points)

    return made_with


def _both(touching, chip):
    """Contacts of the whole tooth, refined down to those at the corner too."""

    def found(case, phase, approach):
        whole, cut = touching(case.healthy, phase, approach), touching(case, phase, 2 * approach)
        k = whole.order.index(0)
        whole.rolls[0][k] = np.append(whole.rolls[0][k], chip.cut(PAIR.gear_1)[0])
        if 0 in cut.order:
            whole.rolls[1][k] = np.append(whole.rolls[1][k], cut.rolls[1][cut.order.index(0)])
        return whole

    return found


def row_of(name):
    """Run CalculiX at the approach that `ritz3d` has under the load, to four digits."""
    approach = float(f"{1e3 * float(ours(name).deflection[0]):.4g}")
    row, carried = pressed(lambda folder: deck_of(folder, name, approach))
    theirs = float(f"{row.pop('force') / 1e3 / approach:.6g}")
    return row | {"approach": approach, "theirs": theirs, "carried": {str(order): force for order, (force, _) in carried.items()}}


def reference():
    """Compute the runs that are not on file; without CalculiX print a message."""
    for name in cases() if installed() else ():
        kept_rows.kept(TABLE, name, lambda name=name: row_of(name))


if __name__ == "__main__":
    reference()

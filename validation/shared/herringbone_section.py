"""How much of the stiffness of S4's finite elements is their section being too coarse, by means of the energy model."""

from dataclasses import replace
from functools import partial

import numpy as np

from gearfe.flexibility.energy.ritz.solid import flexibility3d
from gearfe.flexibility.finite_elements.section_error import plane_hats
from gearfe.flexibility.solved import SolvedGears

from .solid_pair import solid_contact

FINEST = 2.0  # resolution of the section that is taken for exact
PHASES = 8


def rows(scene, resolutions):
    """Pair, resolution of its hexahedra, and by how much their section stiffens k of the healthy pair: mean, least, most."""
    out = []
    for name, resolution in resolutions.items():
        chosen, kept = scene.pairs[name], SolvedGears()
        case = chosen.pair, chosen.force, chosen.materials, np.arange(PHASES) / PHASES
        own, stiff = (
            solid_contact(*case, face=chosen.face, groove=chosen.groove, cache=kept, model=partial(_body, kept, one)).k
            for one in (None, resolution)
        )
        more = stiff / own - 1
        out.append([name, resolution, float(more.mean()), float(more.min()), float(more.max())])
    return out


def _body(kept, resolution, gear, material, cracks=(), **options):
    """The energy model's gear, less what a section of hexahedra lacks against the finest in plane strain."""
    found = flexibility3d(gear, material, cracks, cache=kept, **options)
    if resolution is None:
        return found

    def lacking():
        fine, coarse = (plane_hats(gear, material, (), each) for each in (FINEST, resolution))
        return fine - coarse

    less = np.kron(kept.get(("section", gear, material, resolution), lacking), np.eye(found.degree + 1))
    return replace(found, near={tooth: near - less for tooth, near in found.near.items()})


def said(rows):
    """The same in a sentence."""
    parts = (
        f"{row['pair'].replace('_', '-')} {100 * float(row['mean']):+.2f} % in the mean ({100 * float(row['least']):+.2f} to "
        f"{100 * float(row['most']):+.2f} %)"
        for row in rows
    )
    return "; ".join(parts)

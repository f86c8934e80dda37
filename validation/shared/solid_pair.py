"""Three-dimensional contact for tests in one call, with the inputs of a `Case` and the orders of both bodies."""

from dataclasses import replace

import gearfe as gf
from gearfe.contact.bodies import Bodies, energy_bodies
from gearfe.contact.wide_contact import pair_stiffness3d
from gearfe.stiffness.provenance import SIDES

STEPS = ("step", "extended", "error", "cache")  # numerical options of the contact solution
GIVEN = ("face", "groove", "flanks", "misalignment", "supports")  # options that define the case


def solid_contact(pair, force, material, phases=32, *, pits=((), ()), cracks=((), ()), model=None, **options):
    """Return the `Contact3D` of a pair. Pits and cracks are numbered in the frame of each gear."""
    both = [
        (name, [replace(one, tooth=sense * one.tooth) for one in (*own, *more)])
        for (name, sense), own, more in zip(SIDES, cracks, pits, strict=True)
    ]
    steps = {name: options.pop(name) for name in STEPS if name in options}
    given = {name: options.pop(name) for name in GIVEN if name in options}
    bodies = Bodies(model) if model else energy_bodies(**options, cache=steps.get("cache", True))
    case = gf.Case(pair, force, material, damage={name: own for name, own in both if own}, **given)
    return pair_stiffness3d(case, phases, bodies, **steps)

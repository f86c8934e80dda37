"""Random pairs within the estimate of whole bodies: rings, cracks by their starts, thinned teeth, extreme shifts.

The arbiter shares with gearfe the definitions of gears, flanks, cracks and phases, and gmsh's triangulation. Its outlines, gaps,
elements, contact and crack starts are its own.
"""

import math
import warnings

import numpy as np
import pytest

import gearfe as gf
from gearfe.geometry.damage.crack_form import STARTS
from validation.shared.arbiter.pressing import pressed

SIDES = "pinion", "wheel"


def drawn(seed):
    """Pair, flanks, line load [N/mm], phase, damage."""
    rng = np.random.default_rng(seed)
    m, ring = float(rng.choice([1.0, 2.0, 4.0])), rng.random() < 0.4
    rack = {"m_n": m, "alpha_n": math.radians(float(rng.choice([17.5, 20, 25]))), "b": 1.0, "rack_tip_radius": 0.2}
    z, x = (int(rng.integers(11, 40)), int(rng.integers(12, 70))), (float(rng.uniform(-0.5, 1.0)), float(rng.uniform(-0.5, 0.9)))
    bores = [0.5 * (teeth / 2 - 1.25 + shift) * m for teeth, shift in zip(z, x, strict=True)]
    held = {"z": z[0] + z[1], "r_rim": (sum(z) / 2 + 5) * m, "addendum": 0.8} if ring else {"z": z[1], "r_bore": bores[1]}
    pair = gf.GearPair(gf.Gear(z=z[0], x=x[0], r_bore=bores[0], **rack), gf.Gear(x=x[1], **held, **rack))
    flanks, damage = {}, None
    for name, gear in zip(SIDES, (pair.gear_1, pair.gear_2), strict=True):
        given, span = {}, gear.roll_a - gear.roll_f
        for end, most, last, sense in (("root", 0.05, gear.roll_f, 1), ("tip", 0.02, gear.roll_a, -1)):
            if rng.random() < 0.6:
                given[f"{end}_relief"] = float(rng.uniform(0, most)) * m
                given[f"{end}_start_roll"] = last + sense * float(rng.uniform(0.2, 0.6)) * span
                given[f"{end}_exponent"] = float(rng.choice([1.0, 2.0]))
        if given:
            flanks[name] = gf.Flank(both_sides=bool(rng.random() < 0.6), **given)
    if rng.random() < 0.4:
        angle, start = math.radians(rng.uniform(35, 65)), str(rng.choice(STARTS))
        damage = {str(rng.choice(SIDES)): [gf.Crack(level=float(rng.uniform(0.1, 0.6)), angle=angle, start=start)]}
    load = float(10 ** rng.uniform(1.5, 2.5)) * m / 2
    return pair, flanks, load, [float(rng.uniform(0, pair.eps_alpha))], damage


def off_and_estimated(seed, cracked=True):
    """Relative difference of k from that of whole bodies, and both estimates together; None if the seed gives no case."""
    try:
        pair, flanks, load, phase, damage = drawn(seed)
        damage = damage if cracked else None
        options = {"method": "ritz", "phases": phase, "flanks": flanks or None, "damage": damage, "error": True}
        curve = gf.mesh_stiffness(pair, load, gf.Material(E=207e3, nu=0.3), cache=False, **options)
        cracks = [(damage or {}).get(name, ()) for name in SIDES]
        truth = pressed(pair, [flanks.get(name) for name in SIDES], load, phase, (207e3, 0.3), cracks=cracks, refines=(0.7, 1.0))
    except ValueError:
        return None
    k = 1e3 * truth.k
    return float((abs(curve.k - k) / k)[0]), float((curve.error / k + truth.error / truth.k)[0])


@pytest.mark.slow
@pytest.mark.parametrize("cracked", [True, False])
def test_a_contact_at_the_start_of_a_steep_parabolic_relief(cracked):
    """38/66 with 49 um of root relief on a module of 1 mm: the relative radius falls from 4.8 to 2.1 mm within the contact.

    Hertz's law with one radius is 0.76 % too stiff, and 1.07 % with the crack, of which its thin tooth is 0.3 %.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        off, told = off_and_estimated(35, cracked)
    assert off < told < 2e-2
    assert off < (6e-3 if cracked else 2e-3)


@pytest.mark.slow
def test_random_pairs_are_within_their_estimates():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = [values for values in map(off_and_estimated, range(1000, 1012)) if values]
    assert len(found) >= 6
    assert [seed for seed, (off, told) in enumerate(found) if off > told] == []

"""Random gear pairs, with more undercut, close, trimmed, rounded and modified pairs than usual."""

import math

import numpy as np

import gearfe as gf
from gearfe.core.threads import own_warnings

FIRST, COUNT = 260_000, 1000  # first seed and number of pairs of the unloaded comparison; seeds without a valid pair are skipped
PHASES = np.arange(48) / 48


def random_pair(seed):
    """Return pair and flanks (two `gearfe.Flank`, or None) of a seed. Raises ValueError if no such gears exist."""
    rng = np.random.default_rng(seed)
    m = float(rng.choice([1.0, 2.0, 2.5, 5.0]))
    addendum, dedendum = ((1.0, 1.25), (0.8, 1.0))[int(rng.random() < 0.2)]
    alpha = float(rng.choice([20.0, 20.0, 20.0, 20.0, 17.5, 25.0]))
    rack = {"m_n": m, "alpha_n": math.radians(alpha), "b": 1.0, "addendum": addendum, "dedendum": dedendum}
    rack["rack_tip_radius"] = float(rng.choice([0.2, 0.3, 0.38]))
    if rng.random() < 0.2:
        rack["beta"] = math.radians(rng.uniform(5, 25))
    z_1 = int(8 * (80 / 8) ** rng.random() + 0.5)
    if rng.random() < 0.35:  # Undercut pinions are over-represented.
        z_1 = int(rng.integers(8, 17))
    x_1 = float(rng.uniform(-0.4, 0.8)) if rng.random() < 0.7 else 0.0
    if ring := bool(rng.random() < 0.3):
        z_2 = z_1 + int(rng.integers(6, 18) if rng.random() < 0.5 else rng.integers(18, 60))
        x_2 = x_1 if rng.random() < 0.5 else float(rng.uniform(-0.2, 0.6))
    else:
        z_2 = int(8 * (80 / 8) ** rng.random() + 0.5)
        x_2 = float(rng.uniform(-0.4, 0.8)) if rng.random() < 0.7 else 0.0
    with own_warnings():
        one = gf.Gear(z=z_1, x=x_1, r_bore=0.55 * (z_1 / 2 - 1.25 + x_1) * m, **rack)
        held = {"r_rim": ((z_2 / 2 / math.cos(rack.get("beta", 0.0))) + 1.25 + x_2 + 3.0) * m}
        if ring and z_2 < 30:
            held["z_cutter"] = max(10, z_2 // 2)
        if not ring:
            held = {"r_bore": 0.55 * (z_2 / 2 - 1.25 + x_2) * m}
        two = gf.Gear(z=z_2, x=x_2, **held, **rack)
        pair = gf.GearPair(one, two)
        if rng.random() < 0.15:
            pair = gf.GearPair(one, two, a=pair.a + pair.outward * float(rng.uniform(0.01, 0.08)) * m)
    flanks = tuple(random_flank(rng, gear) for gear in pair.gears) if rng.random() < 0.4 else None
    return pair, flanks


def random_flank(rng, gear):
    """Draw a rounded or chamfered tip, reliefs, crowning, slope and pitch deviations, each with some probability."""
    m, given = gear.m_n, {}
    kind = rng.random()
    if kind < 0.4:
        given["tip_rounding"] = float(rng.uniform(0.03, 0.15)) * m
    elif kind < 0.55:
        given["tip_chamfer"] = float(rng.uniform(0.03, 0.12)) * m
    span = gear.roll_a - gear.roll_f
    if rng.random() < 0.4:
        given |= {
            "tip_relief": 1e-3 * float(rng.uniform(3, 20)),
            "tip_start_roll": gear.roll_a - float(rng.uniform(0.2, 0.5)) * span,
        }
        given["tip_exponent"] = float(rng.choice([1.0, 2.0]))
    if rng.random() < 0.15:
        given |= {
            "root_relief": 1e-3 * float(rng.uniform(3, 12)),
            "root_start_roll": gear.roll_f + float(rng.uniform(0.1, 0.3)) * span,
        }
    if rng.random() < 0.25:
        given["profile_crowning"] = 1e-3 * float(rng.uniform(2, 8))
    if rng.random() < 0.25:
        given["profile_slope"] = 1e-3 * float(rng.uniform(-6, 6))
    if rng.random() < 0.25:
        given["pitch"] = (1e-3 * rng.normal(0, 4, gear.z)).tolist()
    return gf.Flank(**given)

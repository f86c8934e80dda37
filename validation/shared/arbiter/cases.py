"""Gear pairs drawn at random, undercut, close, trimmed, rounded and modified ones over-represented."""

import math
import warnings

import numpy as np

import gearfe as gf
from gearfe.geometry.pair.contacts import contacts

FIRST, COUNT = 260_000, 1000  # seeds of the unloaded comparison: pairs of these seeds, those refused left out, until so many
PHASES = np.arange(48) / 48


def random_pair(seed):
    """Pair and flanks (two `gearfe.Flank`, or None) of a seed; ValueError where no such gears exist."""
    rng = np.random.default_rng(seed)
    m = float(rng.choice([1.0, 2.0, 2.5, 5.0]))
    addendum, dedendum = ((1.0, 1.25), (0.8, 1.0))[int(rng.random() < 0.2)]
    alpha = float(rng.choice([20.0, 20.0, 20.0, 20.0, 17.5, 25.0]))
    rack = {"m_n": m, "alpha_n": math.radians(alpha), "b": 1.0, "addendum": addendum, "dedendum": dedendum}
    rack["tip_radius"] = float(rng.choice([0.2, 0.3, 0.38]))
    if rng.random() < 0.2:
        rack["beta"] = math.radians(rng.uniform(5, 25))
    z_1 = int(8 * (80 / 8) ** rng.random() + 0.5)
    if rng.random() < 0.35:  # undercut
        z_1 = int(rng.integers(8, 17))
    x_1 = float(rng.uniform(-0.4, 0.8)) if rng.random() < 0.7 else 0.0
    if ring := bool(rng.random() < 0.3):
        z_2 = z_1 + int(rng.integers(6, 18) if rng.random() < 0.5 else rng.integers(18, 60))
        x_2 = x_1 if rng.random() < 0.5 else float(rng.uniform(-0.2, 0.6))
    else:
        z_2 = int(8 * (80 / 8) ** rng.random() + 0.5)
        x_2 = float(rng.uniform(-0.4, 0.8)) if rng.random() < 0.7 else 0.0
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
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
    flanks = tuple(random_flank(rng, gear) for gear in (pair.gear_1, pair.gear_2)) if rng.random() < 0.4 else None
    return pair, flanks


def random_flank(rng, gear):
    """A rounded or chamfered tip, reliefs, crowning, slope, pitch deviations, each at times."""
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
        given["crowning"] = 1e-3 * float(rng.uniform(2, 8))
    if rng.random() < 0.25:
        given["slope"] = 1e-3 * float(rng.uniform(-6, 6))
    if rng.random() < 0.25:
        given["pitch"] = (1e-3 * rng.normal(0, 4, gear.z)).tolist()
    return gf.Flank(**given)


# Seed, what is special, load [N/mm], crack (gear, level, tooth) or None, phases in 48ths. Chosen before any of them was pressed:
# the first pairs from seed 270000 on, spur and below 96 teeth in sum, that filled a number of each kind (form: an undercut
# flank's corner within 3 um; fillet: contact on a fillet; trimmed: a ring's tip; rounded: rounded or chamfered tips; ring,
# modified, plain: none of these); up to five phases with an off-path tooth pair within 3 um, the others spread over the cycle.
LOADED = (
    (270000, "plain", 146.0, ("pinion", 0.2, 1), (0, 11, 16, 17, 24, 35, 46, 47)),  # 35/12 plain
    (270012, "rounded", 109.0, ("pinion", 0.48, 0), (0, 8, 9, 16, 24, 32, 39, 47)),  # 15/40 rounded
    (270013, "form", 16.2, None, (0, 11, 22, 33, 44, 45, 46, 47)),  # 8/68 form
    (270027, "trimmed", 107.0, None, (0, 1, 2, 11, 20, 29, 38, 47)),  # 14/47 ring trimmed+rounded
    (270038, "ring", 118.0, ("pinion", 0.5, 0), (0, 19, 20, 21, 24, 45, 46, 47)),  # 9/57 ring ring
    (270070, "modified", 878.0, None, (0, 2, 3, 4, 5, 25, 45, 47)),  # 49/36 modified
    (270165, "fillet", 22.9, None, (0, 3, 6, 10, 13, 29, 46, 47)),  # 11/63 fillet
    (270004, "plain", 140.0, None, (0, 9, 13, 19, 28, 37, 46, 47)),  # 9/16 plain
    (270021, "rounded", 200.0, None, (0, 19, 20, 22, 24, 26, 28, 47)),  # 52/20 rounded
    (270015, "form", 46.7, None, (0, 1, 2, 3, 4, 25, 46, 47)),  # 33/9 form+rounded
    (270032, "trimmed", 76.3, None, (0, 11, 12, 13, 24, 35, 46, 47)),  # 9/26 ring trimmed
    (270085, "ring", 293.0, None, (0, 7, 9, 22, 41, 43, 45, 47)),  # 13/48 ring ring
    (270083, "modified", 400.0, ("pinion", 0.44, 1), (0, 4, 8, 12, 27, 34, 38, 47)),  # 15/68 modified
    (270316, "fillet", 52.2, None, (0, 2, 4, 5, 6, 26, 46, 47)),  # 13/46 ring fillet+trimmed
    (270008, "plain", 413.0, None, (0, 9, 18, 19, 28, 37, 46, 47)),  # 73/21 plain
    (270023, "rounded", 25.0, None, (0, 3, 6, 9, 12, 13, 30, 47)),  # 13/16 rounded
    (270016, "form", 10.5, None, (0, 2, 6, 22, 37, 38, 43, 47)),  # 11/14 form
    (270037, "trimmed", 101.0, None, (0, 5, 6, 7, 24, 45, 46, 47)),  # 10/35 ring trimmed
    (270091, "ring", 900.0, None, (0, 20, 22, 24, 25, 44, 45, 47)),  # 31/48 ring ring
    (270159, "modified", 18.8, ("pinion", 0.18, 1), (0, 2, 4, 6, 8, 9, 28, 47)),  # 11/13 modified
    (270384, "fillet", 5.75, None, (0, 10, 16, 22, 39, 40, 44, 47)),  # 16/67 fillet+form
    (270010, "plain", 17.1, None, (0, 9, 18, 21, 28, 37, 46, 47)),  # 16/34 plain
    (270040, "rounded", 129.0, ("pinion", 0.14, 1), (0, 1, 2, 11, 20, 29, 38, 47)),  # 14/10 rounded
    (270017, "form", 12.0, None, (0, 18, 28, 33, 35, 38, 40, 47)),  # 12/17 form+rounded
    (270043, "trimmed", 158.0, ("pinion", 0.39, 1), (0, 19, 21, 22, 23, 25, 27, 47)),  # 21/61 ring trimmed+rounded
    (270096, "ring", 90.5, ("pinion", 0.37, 0), (0, 14, 21, 22, 23, 32, 46, 47)),  # 12/64 ring ring
    (270183, "modified", 20.0, None, (0, 4, 10, 16, 21, 27, 36, 47)),  # 31/23 modified
    (270416, "fillet", 37.2, None, (0, 2, 5, 8, 9, 28, 46, 47)),  # 13/45 fillet
    (270034, "plain", 14.2, ("pinion", 0.26, 0), (0, 6, 7, 8, 24, 45, 46, 47)),  # 27/13 plain
    (270052, "rounded", 33.1, None, (0, 6, 12, 19, 25, 26, 36, 47)),  # 13/51 rounded
    (270018, "form", 93.9, None, (0, 11, 18, 19, 24, 35, 46, 47)),  # 22/13 form
    (270112, "ring", 200.0, ("pinion", 0.2, 0), (0, 21, 26, 27, 28, 45, 46, 47)),  # 11/60 ring ring
    (270236, "modified", 359.0, ("pinion", 0.42, 0), (0, 4, 7, 10, 14, 15, 31, 47)),  # 16/10 modified
    (270562, "fillet", 90.3, None, (0, 7, 14, 20, 30, 39, 40, 47)),  # 37/52 ring fillet+trimmed+rounded
    (270039, "plain", 225.0, None, (0, 5, 6, 13, 24, 35, 46, 47)),  # 11/23 plain
    (270054, "rounded", 40.3, None, (0, 2, 3, 4, 5, 6, 26, 47)),  # 36/10 rounded
    (270028, "form", 200.0, None, (0, 4, 8, 12, 26, 41, 43, 47)),  # 14/13 form
    (270245, "modified", 6.11, None, (0, 7, 8, 9, 14, 25, 36, 47)),  # 62/27 modified
    (270568, "fillet", 98.7, None, (0, 9, 18, 29, 39, 40, 43, 47)),  # 11/42 fillet+form
    (270058, "plain", 6.12, None, (0, 9, 14, 19, 28, 37, 46, 47)),  # 14/13 plain
    (270030, "form", 23.6, ("wheel", 0.39, 0), (0, 18, 19, 21, 23, 26, 46, 47)),  # 38/13 form
    (270061, "plain", 28.8, None, (0, 7, 10, 19, 28, 37, 46, 47)),  # 14/18 plain
    (270048, "form", 5.41, ("wheel", 0.13, 1), (0, 13, 15, 30, 44, 45, 46, 47)),  # 9/18 form
    (270050, "form", 454.0, None, (0, 2, 20, 39, 41, 43, 45, 47)),  # 10/32 form
)


FRESH, FRESH_COUNT = 276_001, 14  # seeds of pairs on which nothing was tried: judged once, when all was done


def fresh():
    """Rows as of `LOADED` of the first spur pairs from `FRESH` on with fewer than 96 teeth, without cracks.

    Loads are drawn from 5 to 200 N/mm for each mm of module. Of four phases two are the first and last at which a tooth pair off
    the path is within 3 um, if there are any, the others 12/48 and 30/48.
    """
    rows, seed = [], FRESH - 1
    while len(rows) < FRESH_COUNT:
        seed += 1
        try:
            pair, _ = random_pair(seed)
        except ValueError:
            continue
        if pair.gear_1.beta or pair.gear_1.z + pair.gear_2.z >= 96:
            continue
        gap = contacts(pair, PHASES).gap
        off = np.flatnonzero(((gap > 1e-6) & (gap < 3e-3)).any(axis=1)).tolist()
        load = pair.gear_1.m_n * 5 * 40 ** np.random.default_rng(seed + 1_000_000).random()
        rows.append((seed, "fresh", float(f"{load:.3g}"), None, tuple(sorted({*off[:1], 12, 30, *off[-1:]}))))
    return rows


def loaded_case(row):
    """Pair, flanks, load [N/mm], cracks of pinion and wheel, phases of a row of `LOADED`."""
    seed, _, load, crack, phases = row
    pair, flanks = random_pair(seed)
    cracks = ([], [])
    if crack is not None:
        name, level, tooth = crack
        cracks[name == "wheel"].append(gf.Crack(level=level, tooth=tooth))
    return pair, flanks, load, cracks, np.array(phases) / 48

"""The page `random_search`: random pairs of hard kinds against whole outlines pressed together, and the estimates of both."""

import math
import time
import warnings

import numpy as np

import gearfe as gf
from gearfe.geometry.damage.crack import STARTS

from ..shared.arbiter.pressing import pressed
from ..shared.places import TABLES
from ..shared.table_rows import rows_of, write_table

TABLE = TABLES / "random_search.csv"
FIRST = 910_000  # seeds from here on
KINDS = ("closed", "rim", "deep", "bent", "several", "thin", "extreme", "ring")
SIDES = "pinion", "wheel"
STEEL = gf.Material(E=207e3, nu=0.3)
FIELDS = ("seed", "kind", "pair", "load_N_mm", "phase", "off_percent", "estimate_percent", "arbiter_percent", "cpu_s")


def random_case(seed):
    """Kind, pair, flanks, line load [N/mm], phases and damage of a seed; ValueError where no such gears exist."""
    rng = np.random.default_rng(seed)
    kind, m = KINDS[seed % len(KINDS)], float(rng.choice([1.0, 2.0, 4.0]))
    ring = kind == "ring" or rng.random() < 0.2
    rack = {"m_n": m, "alpha_n": math.radians(float(rng.choice([17.5, 20, 25]))), "b": 1.0, "rack_tip_radius": 0.2}
    z, wide = (int(rng.integers(11, 40)), int(rng.integers(14, 60))), kind == "extreme"
    x = tuple(float(rng.uniform(-0.6, 1.1) if wide else rng.uniform(-0.2, 0.5)) for _ in SIDES)
    thin = (0.8, 0.94) if kind == "rim" else (0.4, 0.7)
    bores = [float(rng.uniform(*thin)) * (teeth / 2 - 1.25 + shift) * m for teeth, shift in zip(z, x, strict=True)]
    rim = float(rng.uniform(2.5, 3.5) if kind == "rim" else rng.uniform(3.5, 7))
    held = {"z": z[1], "r_bore": bores[1]}
    if ring:
        held = {"z": z[0] + z[1], "r_rim": (sum(z) / 2 + x[1] + rim) * m, "addendum": 0.8}
    pair = gf.GearPair(gf.Gear(z=z[0], x=x[0], r_bore=bores[0], **rack), gf.Gear(x=x[1], **held, **rack))
    flanks = {}
    if kind == "thin" or rng.random() < 0.2:
        for name, gear in zip(SIDES, (pair.gear_1, pair.gear_2), strict=True):
            start = gear.roll_f + float(rng.uniform(0.2, 0.6)) * (gear.roll_a - gear.roll_f)
            relief = {"root_relief": float(rng.uniform(0, 0.05)) * m, "root_start_roll": start}
            flanks[name] = gf.Flank(**relief, root_exponent=float(rng.choice([1.0, 2.0])), both_sides=bool(rng.random() < 0.6))
    damage = {}
    if kind != "thin" or rng.random() < 0.4:
        gear = "wheel" if kind == "ring" else str(rng.choice(SIDES))
        for tooth in (0, int(rng.choice([-2, -1, 1, 2])))[: 2 if kind == "several" else 1]:
            damage.setdefault(gear if rng.random() < 0.7 else str(rng.choice(SIDES)), []).append(_crack(rng, kind, tooth))
    load = float(10 ** rng.uniform(1.3, 2.5)) * m / 2
    phases = sorted(float(rng.uniform(*ends)) for ends in ((-0.5, pair.eps_alpha + 0.5), (0, pair.eps_alpha)))
    return kind, pair, flanks, load, phases, damage


def _crack(rng, kind, tooth):
    """A crack of a kind on a tooth."""
    level = rng.uniform(0.6, 0.9) if kind == "deep" else rng.uniform(0.55, 0.92) if kind == "bent" else rng.uniform(0.1, 0.75)
    side = "unloaded" if kind == "closed" or rng.random() < 0.2 else "loaded"
    angle, start = math.radians(rng.uniform(30, 70)), str(rng.choice(STARTS))
    return gf.Crack(level=float(level), angle=angle, start=start, turning=kind == "bent", side=side, tooth=tooth)


def row(seed):
    """One row of the table by the worst phase, or None where the seed gives no gears, crack or estimate."""
    started = time.process_time()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            kind, pair, flanks, load, phases, damage = random_case(seed)
            options = {"method": "ritz", "phases": phases, "flanks": flanks or None, "damage": damage or None, "error": True}
            curve = gf.mesh_stiffness(pair, load, STEEL, cache=False, **options)
            cracks = [damage.get(name, ()) for name in SIDES]
            both = [flanks.get(name) for name in SIDES]
            truth = pressed(pair, both, load, phases, (STEEL.E, STEEL.nu), cracks=cracks, refines=(0.7, 1.0))
        except (ValueError, RuntimeError):
            return None
    off, own, theirs = 1e-3 * curve.k / truth.k - 1, curve.error / curve.k, truth.error / truth.k
    worst = int(np.argmax(np.abs(off) / (own + theirs)))
    name = f"{pair.gear_1.z}/{pair.gear_2.z}{' ring' if pair.gear_2.internal else ''} m {pair.gear_1.m_n:g}"
    percent = [f"{100 * float(value[worst]):.3f}" for value in (off, own, theirs)]
    values = [seed, kind, name, f"{load:.1f}", f"{phases[worst]:.3f}", *percent, f"{time.process_time() - started:.1f}"]
    return dict(zip(FIELDS, map(str, values), strict=True))


def reference(seconds=460.0):
    """Add rows for so many seconds of CPU, from the first seed after those of the table on."""
    rows, started = rows_of(TABLE) if TABLE.exists() else [], time.process_time()
    seed = max((int(one["seed"]) for one in rows), default=FIRST - 1)
    while time.process_time() - started < seconds:
        seed += 1
        if (found := row(seed)) is not None:
            rows.append(found)
            write_table(TABLE, FIELDS, [one.values() for one in rows])

"""Page `sample`: random pairs by finite elements and the energy model, and the coverage of both error estimates."""

import datetime
import math
import time

import numpy as np

import gearfe as gf
from gearfe.core.threads import own_warnings

from ..shared import kept_rows, page
from ..shared.places import TABLES
from ..shared.table_rows import rows_of, write_table

TABLE = TABLES / "sample.csv"
FIRST, COUNT = 86_000, 100  # first seed and number of pairs; no pair was used during development
FIELDS = ("seed", "date", "pair", "damage", "load_N_mm", "difference", "fe_error", "fe_estimate", "ritz_error", "ritz_estimate")
FIELDS += ("apart_covered", "fe_covered", "ritz_covered", "cpu_s")
FINE = {"refine": 2.0, "order": 5}  # refinement of `ritz`, the reference of both errors


def random_case(seed):
    """Return pair, line load [N/mm] and damage of a seed. Raises ValueError if no such gears exist."""
    rng = np.random.default_rng(seed)
    m, width = float(rng.choice([1.0, 2.0, 4.0])), 10.0
    rack = {"m_n": m, "alpha_n": math.radians(rng.choice([17.5, 20.0, 25.0])), "b": width, "rack_tip_radius": 0.2}
    z_1, ring = int(11 * (70 / 11) ** rng.random()), bool(rng.random() < 0.25)
    z_2 = z_1 + int(20 * (90 / 20) ** rng.random()) if ring else int(14 * (110 / 14) ** rng.random())
    x_1, x_2 = float(rng.uniform(-0.1, 0.5)), 0.0 if ring else float(rng.uniform(-0.3, 0.3))
    bore = [float(rng.uniform(0.3, 0.88)) * (z / 2 - 1.25 + x) * m for z, x in ((z_1, x_1), (z_2, x_2))]
    one = gf.Gear(z=z_1, x=x_1, r_bore=bore[0], **rack)
    held = {"r_rim": (z_2 / 2 + 1.25 + float(rng.uniform(2, 6))) * m} if ring else {"r_bore": bore[1]}
    two = gf.Gear(z=z_2, x=x_2, **held, **rack)
    load, cracked = float(10 ** rng.uniform(1.3, 2.7)), rng.random() < 0.6
    crack = gf.Crack(level=float(rng.uniform(0.05, 0.75)), angle=math.radians(rng.uniform(30, 65)))
    damage = {str(rng.choice(["pinion", "wheel"])): [crack]} if cracked else None
    return gf.GearPair(one, two), load, damage


def row(seed):
    """Return one row of the table, or None if gears, mesh or crack of the seed are impossible."""
    started = time.process_time()
    with own_warnings():
        try:
            pair, load, damage = random_case(seed)
            run = {"phases": 8, "span": "tooth" if damage else "cycle", "damage": damage}
            case = (pair, load * 10.0, gf.Material())
            energy = gf.mesh_stiffness(*case, method="ritz", error=True, **run)
            fine = gf.mesh_stiffness(*case, method="ritz", **FINE, **run).k
            finite = gf.mesh_stiffness(*case, method="fe", error=True, cache=False, **run)
        except ValueError:
            return None
    apart = np.abs(finite.k - energy.k)
    off = [np.abs(curve.k - fine) for curve in (finite, energy)]
    said = [curve.error - np.array(curve.meta["error_of_contact"]) for curve in (finite, energy)]
    covered = [(apart <= sum(said)).all(), (off[0] <= said[0]).all(), (off[1] <= said[1]).all()]
    values = [apart, off[0], said[0], off[1], said[1]]
    names = f"{pair.gear_1.z}/{pair.gear_2.z}{' ring' if pair.gear_2.internal else ''} m {pair.gear_1.m_n:g}"
    hurt = "" if not damage else "; ".join(f"{name} crack {100 * one[0].level:.0f} %" for name, one in damage.items())
    percent = [f"{100 * float((v / fine).max()):.4f}" for v in values]
    head = [seed, datetime.datetime.now(datetime.UTC).date().isoformat(), names, hurt, f"{load:.1f}"]
    tail = [*(str(bool(c)) for c in covered), f"{time.process_time() - started:.1f}"]
    return dict(zip(FIELDS, [*head, *percent, *tail], strict=True))


HOW = """
Two comparisons are made on pairs from unused random seeds. The difference of two methods must be below the sum of both estimates.
The error of each method, relative to a finer solution, must be below its own estimate. A pair is covered if all of its phases
are. A failed solution counts as not covered. `python -m validation sample` computes the rows.
[sample_three.md](sample_three.md) has pairs in three dimensions.
"""


def run(again=True):
    """Write the page. With `again`, its stored rows are computed again."""
    if again:
        kept_rows.begin(TABLE)
    rows = rows_of(TABLE)
    seed = max((int(r["seed"]) for r in rows), default=FIRST - 1) + 1
    while len(rows) < COUNT:
        found = row(seed)
        seed += 1
        if found is not None:
            rows.append(found)
            write_table(TABLE, FIELDS, [row.values() for row in rows])
    page.write("sample", answer(rows), HOW, coverage(rows), section(rows))


def largest(rows):
    """Return name and values of each row for `spread_table`."""
    names = (f"{row['pair']}{', ' if row['damage'] else ''}{row['damage']}, seed {row['seed']}" for row in rows)
    return [(name, {key: float(row[key]) for key in FIELDS[5:10]}) for name, row in zip(names, rows, strict=True)]


def coverage(rows):
    """Return the table with coverage and size of the error estimate of each method."""
    out = ["| method | pairs covered at every phase | median estimate over median error |", "|---|---|---|"]
    return out + [
        f"| `{name}` | {_count(rows, f'{name}_covered')} | {ratio(largest(rows), name):.1f} |" for name in ("fe", "ritz")
    ]


def answer(rows):
    """Return the first sentence of the page."""
    plane = " and ".join(f"{_count(rows, f'{name}_covered')} pairs for `{name}`" for name in ("ritz", "fe"))
    return f"The estimates cover the error in the section in {plane}."


def section(rows):
    """Return the lines of the page."""
    return [
        f"""
        ## In the section

        The {len(rows)} pairs (seeds {rows[0]["seed"]} to {rows[-1]["seed"]}; external and rings, 60 % cracked) were not used to
        develop the methods. The table gives the largest values over the phases of each pair, in percent of k. Errors refer to
        `ritz` with {FINE["refine"]:g} times the resolution and order {FINE["order"]}. Both methods share the profile, the held
        bore and the contact ([outlines.md](outlines.md)). Their estimates are therefore used without the part for the contact
        """,
        '(`meta["error_of_contact"]`).',
        "",
        *spread_table(largest(rows), "fe", "ritz"),
        "",
        "No pair was examined before the estimates were final. At every phase, the sum of both estimates covers the "
        "difference in "
        f"{_count(rows, 'apart_covered')} pairs, and the own estimate covers the error of `fe` in "
        f"{_count(rows, 'fe_covered')} and "
        f"of `ritz` in {_count(rows, 'ritz_covered')}.",
    ]


def spread_table(found, brute, energy):
    """Return the table of differences, errors and estimates of two methods. `found` has name and largest values of each pair."""
    texts = {"difference": f"`{brute}` against `{energy}`"}
    for name in (brute, energy):
        texts |= {f"{name}_error": f"error of `{name}`", f"{name}_estimate": "its estimate"}
    out = ["| in percent of k | median | 95th percentile | worst | of the pair |", "|---|---|---|---|---|"]
    for name, text in texts.items():
        values = np.array([row[name] for _, row in found])
        spread = f"{np.median(values):.3f} | {np.quantile(values, 0.95):.3f} | {values.max():.3f}"
        out.append(f"| {text} | {spread} | {found[int(values.argmax())][0]} |")
    return out


def ratio(found, name):
    """Median estimate over median error of a method."""
    said, off = (np.median([row[f"{name}_{what}"] for _, row in found]) for what in ("estimate", "error"))
    return float(said / off)


def _count(rows, name):
    return f"{sum(r[name] == 'True' for r in rows)} of {len(rows)}"


def cheap():
    """Yield the rows that `validation.check` computes again: differences and estimates over k."""
    for one in rows_of(TABLE):
        if float(one["cpu_s"]) < 3.0:
            yield one["seed"], _over_k(one), lambda seed=int(one["seed"]): _over_k(row(seed))


def _over_k(row):
    return [1 + float(row[name]) / 100 for name in FIELDS[5:10]]

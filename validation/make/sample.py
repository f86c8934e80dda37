"""Random pairs, cracked or not: `fe` against `ritz`, and how often the error estimates of both cover."""

import csv
import datetime
import io
import math
import time
import warnings
from pathlib import Path

import numpy as np

import gearfe as gf
from gearfe.files import written

from ..shared import code
from ..shared.places import PAGES, TABLES

PAGE, TABLE = PAGES / "sample.md", TABLES / "sample.csv"
FIRST, COUNT = 72_000, 200  # seeds from here on; none was looked at while the methods were made
FIELDS = ("seed", "date", "pair", "damage", "load_N_mm", "difference", "fe_error", "fe_estimate", "ritz_error", "ritz_estimate")
FIELDS += ("apart_covered", "fe_covered", "ritz_covered", "cpu_s", "code")
FINE = {"refine": 2.0, "order": 5}  # of `ritz`, the reference of both errors


def random_case(seed):
    """Pair, line load [N/mm] and damage of a seed; ValueError where no such gears exist."""
    rng = np.random.default_rng(seed)
    m, width = float(rng.choice([1.0, 2.0, 4.0])), 10.0
    rack = {"m_n": m, "alpha_n": math.radians(rng.choice([17.5, 20.0, 25.0])), "b": width, "tip_radius": 0.2}
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
    """One row of the table, or None where gears, mesh or crack of the seed cannot exist."""
    started = time.process_time()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
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
    covered = [(apart <= finite.error + energy.error).all(), (off[0] <= finite.error).all(), (off[1] <= energy.error).all()]
    values = [apart, off[0], finite.error, off[1], energy.error]
    names = f"{pair.gear_1.z}/{pair.gear_2.z}{' ring' if pair.gear_2.internal else ''} m {pair.gear_1.m_n:g}"
    hurt = "" if not damage else "; ".join(f"{name} crack {100 * one[0].level:.0f} %" for name, one in damage.items())
    percent = [f"{100 * float((v / fine).max()):.4f}" for v in values]
    head = [seed, datetime.datetime.now(datetime.UTC).date().isoformat(), names, hurt, f"{load:.1f}"]
    tail = [*(str(bool(c)) for c in covered), f"{time.process_time() - started:.1f}", code.fingerprint()]
    return dict(zip(FIELDS, [*head, *percent, *tail], strict=True))


def run():
    """Compute the rows that are missing, one by one into `sample.csv`, then write `sample.md` and print it."""
    rows = rows_on_file()
    seed = max((int(r["seed"]) for r in rows), default=FIRST - 1) + 1
    while len(rows) < COUNT:
        found = row(seed)
        seed += 1
        if found is not None:
            rows.append(found)
            text = io.StringIO()
            writer = csv.DictWriter(text, FIELDS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
            with written(TABLE) as name:
                Path(name).write_text(text.getvalue(), encoding="utf-8")
    page()


def rows_on_file():
    """Rows of `sample.csv` as dictionaries of strings."""
    if not TABLE.exists():
        return []
    with TABLE.open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def page():
    """Write `sample.md` from the rows on file and print it."""
    rows = rows_on_file()
    text = "\n".join([
        "# Random pairs: finite elements against the energy model",
        "",
        f"Made by `python -m validation sample`; rows of {min(r['date'] for r in rows)} to {max(r['date'] for r in rows)} in "
        f"`tables/sample.csv`, made with the code (hash of all sources) {_codes(rows)}.",
        f"{len(rows)} random pairs of {COUNT} wanted (seeds {rows[0]['seed']} to {rows[-1]['seed']}; external and rings, 60 %",
        "cracked), not used to develop the methods. Largest values over the phases of each pair, in percent of k; errors are",
        f"against `ritz` with {FINE['refine']:g} times the resolution and order {FINE['order']}.",
        "",
        "| | median | 95th percentile | worst | of the pair |",
        "|---|---|---|---|---|",
        *[_line(rows, name, text) for name, text in (
            ("difference", "`fe` against `ritz`"), ("fe_error", "error of `fe`"), ("fe_estimate", "its estimate"),
            ("ritz_error", "error of `ritz`"), ("ritz_estimate", "its estimate"),
        )],
        "",
        "Pairs in which the estimates cover at every phase: "
        f"the difference by the sum of both {_count(rows, 'apart_covered')}, the error of `fe` {_count(rows, 'fe_covered')}, the "
        f"error of `ritz` {_count(rows, 'ritz_covered')}.",
        "",
    ])  # fmt: skip
    with written(PAGE) as name:
        Path(name).write_text(text, encoding="utf-8")
    print(text)


def _codes(rows):
    """Fingerprints of the code and how many rows each made; the present one is named."""
    names = list(dict.fromkeys(r["code"] for r in rows))
    present = code.fingerprint()
    return ", ".join(
        f"{name}{' (the present one)' if name == present else ''}: {sum(r['code'] == name for r in rows)} rows" for name in names
    )


def _line(rows, name, text):
    values = np.array([float(r[name]) for r in rows])
    worst = rows[int(values.argmax())]
    spread = f"{np.median(values):.3f} | {np.quantile(values, 0.95):.3f} | {values.max():.3f}"
    return f"| {text} | {spread} | {worst['pair']}{', ' if worst['damage'] else ''}{worst['damage']}, seed {worst['seed']} |"


def _count(rows, name):
    return f"{sum(r[name] == 'True' for r in rows)} of {len(rows)}"

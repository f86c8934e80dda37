"""Page `random_search`: random pairs of difficult kinds, by the energy model, whole outlines and CalculiX."""

import math
import warnings
from itertools import groupby

import numpy as np

import gearfe as gf
from gearfe.geometry.damage.crack_form import STARTS

from ..shared import page
from ..shared.places import TABLES
from ..shared.table_rows import rows_of, write_table

TRUTH, LARGE, TABLE = (TABLES / f"random_search{part}.csv" for part in ("_outlines", "_calculix", ""))
COUNT = 330  # number of pairs, of seeds from 910000 on
KINDS = ("closed", "rim", "deep", "bent", "several", "thin", "extreme", "ring")
SIDES = "pinion", "wheel"
STEEL = gf.Material(E=207e3, nu=0.3)
FIELDS = ("seed", "kind", "pair", "load_N_mm", "phase", "deflection_um", "k_N_um_mm")
FIELDS += ("off_percent", "estimate_percent", "outlines_percent")


def random_case(seed):
    """Return kind, pair, flanks, line load [N/mm], phases and damage of a seed. ValueError if no such gears exist."""
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
        for name, gear in zip(SIDES, pair.gears, strict=True):
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
    """Return a crack of a kind on a tooth."""
    level = rng.uniform(0.6, 0.9) if kind == "deep" else rng.uniform(0.55, 0.92) if kind == "bent" else rng.uniform(0.1, 0.75)
    side = "unloaded" if kind == "closed" or rng.random() < 0.2 else "loaded"
    angle, start = math.radians(rng.uniform(30, 70)), str(rng.choice(STARTS))
    return gf.Crack(level=float(level), angle=angle, start=start, turning=kind == "bent", side=side, tooth=tooth)


def ours(seed):
    """Return the `ritz` curve with its estimate, and the case. ValueError if gears or cracks of the seed are impossible."""
    case = _, pair, flanks, load, phases, damage = random_case(seed)
    options = {"phases": phases, "flanks": flanks or None, "damage": damage or None}
    return gf.mesh_stiffness(pair, load, STEEL, method="ritz", error=True, cache=False, **options), case


def _ours(truth):
    """Return the rows of the table, one for each phase of the independent rows `truth`."""
    out = []
    for seed, rows in groupby(truth, key=lambda row: row["seed"]):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            curve, (kind, pair, _, load, phases, _) = ours(int(seed))
        name = f"{pair.gear_1.z}/{pair.gear_2.z}{' ring' if pair.gear_2.internal else ''} m {pair.gear_1.m_n:g}"
        values = zip(rows, phases, curve.k * 1e-6, curve.error / curve.k, curve.deflection, strict=True)
        for row, phase, k, error, deflection in values:
            numbers = [f"{100 * (k / float(row['k_N_um_mm']) - 1):.3f}", f"{100 * error:.3f}", row["error_percent"]]
            head = [seed, kind, name, f"{load:.1f}", f"{phase:.4f}", f"{1e6 * deflection:.2f}", f"{k:.6g}"]
            out.append(dict(zip(FIELDS, [*head, *numbers], strict=True)))
    return out


def beyond(rows):
    """Return the rows with a difference larger than the sum of both estimates."""
    off, said, mesh = FIELDS[-3:]
    return [row for row in rows if abs(float(row[off])) > float(row[said]) + float(row[mesh])]


HOW = """
Each kind stresses one assumption: "closed" has cracks on the unloaded side, "thin" has teeth thinned by root relief, and
"extreme" has extreme profile shifts. A seed determines the gears, the load and two phases. `ritz` has its defaults. The
independent reference shares with gearfe the definitions of gears, flanks, cracks and phases, and gmsh's triangulation. A phase is
covered if the difference is at most the estimate of `ritz` plus the mesh error of the reference.

The reference neglects large displacements. Where the difference is larger, CalculiX solves the same meshes with large
displacements. The values of the reference and of CalculiX are frozen. Commit 82252f23 contains the code that computed them.
"""


def run(again=True):
    """Write the page; `again`: compute the rows of `ritz` again."""
    if again:
        write_table(TABLE, FIELDS, [row.values() for row in _ours(rows_of(TRUTH))])
    rows = rows_of(TABLE)
    page.write("random_search", answer(rows), HOW, by_kind(rows), section(rows))


def settled(row, large):
    """Return the difference from CalculiX and its mesh error [%] for a row, or None if CalculiX did not compute it."""
    for one in large:
        if (one["seed"], one["phase"]) == (row["seed"], row["phase"]):
            return 100 * (float(row["k_N_um_mm"]) / float(one["k_N_um_mm"]) - 1), float(one["error_percent"])
    return None


def open_rows(rows):
    """Return the rows beyond the estimates, compared with CalculiX if available and otherwise with the outlines."""
    large, out = rows_of(LARGE), []
    for row in rows:
        told = settled(row, large)
        if beyond([row]) if told is None else abs(told[0]) > float(row["estimate_percent"]) + told[1]:
            out.append(row)
    return out


def answer(rows):
    """Return the first sentences of the page."""
    pairs, out, left = ({row["seed"] for row in some} for some in (rows, beyond(rows), open_rows(rows)))
    return (
        f"Of {len(pairs)} pairs, {len(pairs) - len(out)} are within the estimates at both phases. CalculiX confirms "
        f"{len(out) - len(left)} of the other {len(out)}, and {len(left)} remain outside. The median estimate is "
        f"{_ratio(rows):.1f} times the median difference."
    )


def _ratio(rows):
    said, off = (np.median([abs(float(row[f"{name}_percent"])) for row in rows]) for name in ("estimate", "off"))
    return float(said / off)


def by_kind(rows):
    """Return the table of coverage by kind."""
    out = [
        "| kind | phases | within the estimates | after CalculiX | median estimate over median difference |",
        "|---|---|---|---|---|",
    ]
    for kind in (*KINDS, "all"):
        own = [row for row in rows if kind in (row["kind"], "all")]
        counts = [len(own) - len(some(own)) for some in (beyond, open_rows)]
        out.append(f"| {kind} | {len(own)} | {counts[0]} | {counts[1]} | {_ratio(own):.1f} |")
    return out


def section(rows):
    """Return the lines of the page."""
    out, large = ["## Large displacements", ""], rows_of(LARGE)
    out += ["| seed | kind | pair | phase | deflection [um] | from the outlines | estimate | from CalculiX | mesh error |"]
    out += ["|---|---|---|---|---|---|---|---|---|"]
    for row in rows:
        if (told := settled(row, large)) is not None:
            head = " | ".join(row[name] for name in (*FIELDS[:3], *FIELDS[4:6]))
            numbers = float(row["off_percent"]), float(row["estimate_percent"]), *told
            out.append(f"| {head} | {' | '.join(f'{value:.2f} %' for value in numbers)} |")
    return [
        *out,
        "",
        "The deflection of these pairs is 0.7 to 2 % of the module. The effect of large displacements grows with the load. "
        "For seed 910186, CalculiX differs from the outlines by -2.6 %, and by -0.7 % at a quarter of the load.",
        "",
        "Twelve fresh seeds from 930001 on have deep open cracks. CalculiX found ten of them within the estimates. Seed 930043 "
        "differed by -6.8 %, and its estimate was 5.0 %, because its contact point slides more than the estimate assumed. The "
        "corrected estimate covers this seed. Seed 930059 was not judged, because its reference lacked the second tooth pair. "
        "Ten more fresh seeds (from 940001 and 930075 on) were drawn after this change. All are within "
        "the estimates. The largest difference is -0.71 %, and its estimate is 0.94 %.",
    ]


def cheap():
    """Yield the rows that `validation.check` computes again: differences and estimates over k at both phases."""
    for seed, group in groupby(rows_of(TABLE), key=lambda row: row["seed"]):
        rows = list(group)
        yield (
            seed,
            _over_k(rows),
            lambda rows=rows: _over_k(_ours([one for one in rows_of(TRUTH) if one["seed"] == rows[0]["seed"]])),
        )


def _over_k(rows):
    return [1 + float(row[name]) / 100 for row in rows for name in FIELDS[7:9]]

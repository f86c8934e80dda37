"""Rows of the independent solver, computed case by case and stored in a table."""

import numpy as np

from ..kept_rows import begin
from ..places import TABLES
from ..table_rows import rows_of, write_table
from .cases import LOADED, loaded_case
from .pressing import pressed

TABLE, FRESH = TABLES / "outlines.csv", TABLES / "outlines_fresh.csv"
STEEL = (206e3, 0.3)  # Young's modulus [MPa] and Poisson's ratio of all loaded cases
FIELDS = ("seed", "kind", "pair", "flanks", "crack", "load_N_mm", "phase_48", "k_N_um_mm", "mesh_error_percent", "approach_um")
FIELDS += ("least_gap_um", "shares", "places", "edge", "unknowns", "cpu_s")


def places_of(sides, answer, margin=0.3):
    """Return the corners, joints and fillets within the contact zones or `margin` of their widths, such as "-1: pinion form"."""
    out = []
    for zone, p, *_ in answer.pressed:
        on = np.flatnonzero(p > 1e-3 * p.max()) if p.max() > 1e-6 else []
        if not len(on):
            continue
        names = []
        for gear, s in ((zone.own, zone.s), (1 - zone.own, zone.met)):
            low, high = np.nanmin(s[on]), np.nanmax(s[on])
            more = margin * (high - low)
            side, name = sides[gear], ("pinion", "wheel")[gear]
            last = side.joints.size - 2
            kinds = ["form", *["joint"] * (last - 2), "tip"]
            names += [
                f"{name} {kind}" for kind, joint in zip(kinds, side.joints[1:-1], strict=True) if low - more < joint < high + more
            ]
            if low < side.joints[1] - 1e-6:
                names.append(f"{name} fillet")
        if names:
            out.append(f"{zone.order}: {' '.join(names)}")
    return "; ".join(out)


def case_rows(row):
    """Return the rows of one case of `LOADED`, one for each phase."""
    seed, kind, load, crack, phases = row
    pair, flanks, load, cracks, places = loaded_case(row)
    result = pressed(pair, flanks, load, places, STEEL, cracks=cracks)
    name = f"{pair.gear_1.z}/{pair.gear_2.z}{' ring' if pair.gear_2.internal else ''} m {pair.gear_1.m_n:g}"
    hurt = "" if crack is None else f"{crack[0]} {100 * crack[1]:.0f} % tooth {crack[2]}"
    head = [str(seed), kind, name, "modified" if flanks else "", hurt, f"{load:g}"]
    out = []
    for i, phase in enumerate(phases):
        shares = "; ".join(f"{order}: {part:.4f}" for order, part in sorted(result.force[i].items()))
        numbers = [result.k[i] / 1e3, 100 * result.error[i] / result.k[i], 1e3 * result.approach[i], 1e3 * result.least[i]]
        tail = [f"{value:.6g}" for value in numbers]
        tail += [
            shares,
            places_of(*result.zones[i]),
            "yes" if result.edge[i] else "",
            str(result.dofs),
            f"{result.cpu / len(phases):.2f}",
        ]
        out.append(dict(zip(FIELDS, [*head, str(phase), *tail], strict=True)))
    return out


def reference(rows=LOADED, table=TABLE):
    """Solve all of `rows`. An interrupted run loses at most one case."""
    begin(table)
    for row in rows:
        known = rows_of(table)
        if any(old["seed"] == str(row[0]) for old in known):
            continue
        try:
            new = case_rows(row)
        except RuntimeError as error:
            print(f"{row[0]}: {error}", flush=True)
            continue
        write_table(table, FIELDS, [row.values() for row in (*known, *new)])
        print(f"outlines: {row[0]} {new[0]['pair']}, {sum(float(one['cpu_s']) for one in new):.1f} s of CPU", flush=True)

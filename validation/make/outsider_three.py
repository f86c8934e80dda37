"""Part of the page `three`: `ritz3d` compared with CalculiX, from the tables of `validation.shared.outsider`."""

from ..shared.outsider import ASKED, LOAD, PITS, PITTED, apart, cases, lines, stored, told

COMPARED = f"""
CalculiX is an independent finite-element code. gearfe writes its decks (`gearfe.write_contact_inp` with `face`, and
`gearfe.write_line_inp`). They have both whole gears with all teeth and finite width, held at the bores (a ring outside).
The elements are 20-node hexahedra with reduced integration (C3D20R). Pairs with pits have second-order tets (C3D10) with
the pits cut out. Both codes share the shape and position of the gears. Stiffness, contact, load sharing, half-space and effect of
pits are CalculiX's own. `ritz3d` has pits as lost contact.

- In contact: 13/16 teeth (ring 13/36), m_n 2 mm, b 6 mm, 15 degrees unless spur. {LOAD:g} N/mm (pits {PITTED:g}), phase
  0.45, damage in tooth 0 of the pinion. The gears are rotated by the approach that `ritz3d` had when CalculiX was run.
  Flanks have frictionless surface-to-surface contact with large displacements. k is force divided by approach.
- Under a line load: mean deflection of the loaded strip.

A test compares the decks of the present code with those of the runs.

- `per_width`: element edges per Hertzian half-width along the contact lines, with 3 layers of elements along the width.
- `refine`: divisor of all edge lengths. Edges of tets along the width are twice as long as across it, and rims of pits
  have edges of 0.6 of those of the contact lines.
- `penalty`: stiffness of the contact springs over E, per mm, 500 unless stated.
- Forces apart: difference of `T1 / r_b1` and `T2 / r_b2`, which only tip corners off the line of action cause.

Displacement-based elements are too stiff on coarse meshes. With mesh refinement, k of CalculiX decreases and its deflection
increases, so the difference increases. The contact springs of CalculiX reduce its k by about 0.07 % ([truth.md](truth.md)).
"""
HOLES = f"""
### Pits: holes compared with lost contact

Two pits, a circular and an elliptic one, have their centres on the contact line of tooth 0, under {PITTED:g} N/mm. The contact is
1.4 times as wide as under {LOAD:g}, so fewer elements are sufficient around the pits. Both gears have tets, which differ from
hexahedra. Each case therefore has two controls on the same tets: pits filled with material but without contact, as `ritz3d` has
them, and pits filled and in contact. The effect of pits is k over k of the second control, in which most of the mesh error
cancels.
"""
SHARES = """
### Load sharing of the healthy helical pair

Force of each tooth pair, and position of its resultant along the width (z from the end that touches last):
"""


def section():
    """Return the lines of the page from its tables."""
    known = stored()
    moved = max(abs(row["now"] / row["approach"] - 1) for row in known.values() if "approach" in row)
    text = ["## CalculiX", "", *verdict(known), COMPARED, "", "### In contact", ""]
    text += [f"The present approaches differ from those of the runs by at most {100 * moved:.2f} %.", ""]
    text += [*_table("k [N/um]", known, cases())]
    text += [HOLES, "", *_against_control(known)]
    return [*text, "", "### Single gears under line loads", "", *_table("deflection [nm/N]", known, lines()), *_shared(known)]


def worst():
    """Return the largest difference of the finest meshes, for pairs in contact without pits and for single gears."""
    away = {name: abs(apart(row)) for name, row in finest(stored()).items()}
    whole = {name: value for name, value in away.items() if not name.endswith(tuple(PITS.values()))}
    return [max(value for name, value in whole.items() if name in group) for group in (cases(), lines())]


def finest(known):
    """Return the row with the most nodes of every case."""
    found = {row["case"]: row for row in sorted(known.values(), key=lambda row: row["nodes"])}
    return {name: found[name] for name in (*cases(), *lines())}


def pitted(known):
    """Return the effect of pits on k by case and mesh: in CalculiX by `PITS`, in ``ritz3d`` as lost contact."""
    out = {}
    for name, case in cases().items():
        if not name.endswith(PITS["filled"]):
            continue
        base = name.removesuffix(PITS["filled"])
        for mesh in map(told, case.meshes):
            rows = {kind: known[base + end, mesh] for kind, end in PITS.items() if (base + end, mesh) in known}
            if "filled" in rows and len(rows) > 1:
                k = {kind: row["theirs"] for kind, row in rows.items()}
                found = {kind: k[kind] / k["filled"] - 1 for kind in rows if kind != "filled"}
                ours = next(row["ours"] for kind, row in rows.items() if kind != "filled")
                out[base.strip(), mesh] = found | {"ritz3d": ours / rows["filled"]["ours"] - 1}
    return out


def pits_apart():
    """Return the largest difference in the effect of lost contact on k, on the finest mesh of each case with pits."""
    finer = {name: found for (name, _), found in pitted(stored()).items()}
    return max(abs((1 + found["ritz3d"]) / (1 + found["lost"]) - 1) for found in finer.values())


def verdict(known):
    """Return differences within and beyond the requested limit, for the first lines of the page."""
    away = {name: apart(row) for name, row in finest(known).items()}
    asked = f"{100 * ASKED:g} %"
    yield f"Differences of `ritz3d` from CalculiX on the finest mesh of each case. The required limit is {asked}."
    yield ""
    for what, names in (("In contact, no pits", cases()), ("Under line loads", lines())):
        own = {name: away[name] for name in names if name in away and not name.endswith(tuple(PITS.values()))}
        within = {name: value for name, value in own.items() if abs(value) <= ASKED}
        yield f"- {what}: {len(within)} of {len(own)} within {asked}: {_listed(within)}."
        if len(within) < len(own):
            yield f"  **Beyond {asked}**: {_listed({name: own[name] for name in own if name not in within})}."
    yield from _of_pits(known, away)


def _of_pits(known, away):
    meshes = {}
    for (name, mesh), found in pitted(known).items():
        meshes.setdefault(name, []).append((mesh, found))
    for name, own in meshes.items():
        ours = own[-1][1]["ritz3d"]
        yield f"- Pits, {name}, {PITTED:g} N/mm: `ritz3d` with lost contact changes k by {100 * ours:+.2f} %."
        for kind, said in (("lost", "with contact lost and the material left"), ("cut", "cut out")):
            runs = [(mesh, found[kind]) for mesh, found in own if kind in found]
            if runs:
                yield f"  In CalculiX {said}: {_settled(*zip(*runs, strict=True), ours)}."
        raw = [f"{end} {100 * away[f'{name} {end}']:+.2f} %" for end in PITS.values() if f"{name} {end}" in away]
        yield f"  Difference of k on the same tets: {'; '.join(raw)}."


def _settled(meshes, values, ours):
    """Return the effect of pits on successive meshes, its agreement with `ours`, and whether the meshes determine it."""
    listed = "; ".join(f"{100 * value:+.2f} % ({mesh})" for mesh, value in zip(meshes, values, strict=True))
    doubt = "; **not decided**: one mesh only"
    if len(values) > 1:
        moved = abs(values[-1] - values[-2])
        doubt = f"; {'**not decided**: ' if moved > ASKED else ''}{100 * moved:.2f} % between the two last meshes"
    return f"{listed}; the last {_judged((1 + ours) / (1 + values[-1]) - 1)}{doubt}"


def _judged(off):
    """Return a difference with its sign, and whether it is within the requested limit."""
    verb = "within" if abs(off) <= ASKED else "**beyond**"
    return f"{100 * off:+.2f} % apart, {verb} {100 * ASKED:g} %"


def _listed(away):
    return "; ".join(f"{name} {100 * value:+.2f} %" for name, value in away.items())


def _against_control(known):
    yield "| case | mesh | `ritz3d`, lost contact | CalculiX, lost contact | apart | CalculiX, cut out | apart |"
    yield "|---" * 7 + "|"
    for (name, mesh), found in pitted(known).items():
        cells = [name, mesh, f"{100 * found['ritz3d']:+.2f} %"]
        for kind in ("lost", "cut"):
            theirs = found.get(kind)
            off = None if theirs is None else (1 + found["ritz3d"]) / (1 + theirs) - 1
            cells += ["" if value is None else f"{100 * value:+.2f} %" for value in (theirs, off)]
        yield "| " + " | ".join(cells) + " |"


def _shared(known):
    yield SHARES
    yield ""
    yield "| mesh | pair | `ritz3d` [N] | CalculiX [N] | apart | `ritz3d`, z [mm] | CalculiX, z [mm] |"
    yield "|---" * 7 + "|"
    for row in known.values():
        for order, (theirs, height) in row.get("carried", {}).items():
            ours, own = row["shared"][order]
            off = f"{100 * (ours / theirs - 1):+.2f} %"
            yield f"| {row['mesh']} | {order} | {ours:.5g} | {theirs:.5g} | {off} | {own:.4f} | {height:.4f} |"


def _table(quantity, known, order):
    names = ("case", "mesh", "nodes", f"`ritz3d`, {quantity}", "CalculiX", "difference", "forces apart")
    yield "| " + " | ".join(names) + " |"
    yield "|---" * len(names) + "|"
    rows = [row for row in known.values() if row["case"] in order]
    for row in sorted(rows, key=lambda row: ([*order].index(row["case"]), row["nodes"])):
        cells = [row["case"], row["mesh"], f"{row['nodes']:,}", f"{row['ours']:.6g}", f"{row['theirs']:.6g}"]
        yield "| " + " | ".join([*cells, f"{100 * apart(row):+.2f} %", f"{100 * row['forces apart']:+.2f} %"]) + " |"

"""The page `assumptions`: the stiffness of each scene by its assumptions, one change at a time, and conventions of cracks."""

import math
from dataclasses import replace

import gearfe as gf
from gearfe.core.threads import own_warnings
from gearfe.core.units import in_newton_per_um
from gearfe.geometry.damage.crack import start_arc
from gearfe.geometry.pair.gear_pair import GearPair
from gearfe.geometry.tooth.profile import cartesian, root_curve
from gearfe.scene.load import scene_names

from ..shared import page, reference
from ..shared.kept_rows import kept
from ..shared.places import TABLES
from ..shared.table_rows import rows_of, write_table

BASE = "as assumed [N/m]"
CSV = TABLES / "assumptions.csv"
SCENES = [  # Scenes of articles. The bores of herringbone_contact_line are chosen, not assumed.
    name for name in scene_names() if name != "herringbone_contact_line" and gf.load_scene(name).references
]
WIDE = 8  # phases of three-dimensional curves
PITTED = {"planetary_pitting": "mild_rows", "helical_pitting": "severe"}  # by scene, the case whose pits are varied

CONVENTIONS = {
    "30-degree tangent, 45 degrees": {},
    "start: root circle": {"start": "root"},
    "start: middle of the fillet": {"start": "middle"},
    "angle 30 degrees": {"angle": math.radians(30)},
    "angle 60 degrees": {"angle": math.radians(60)},
    "length: level times the 30-degree chord": {"length": "chord"},
    "turning at the centre-line": {"turning": True},
    "on the unloaded side": {"side": "unloaded"},
}


def mean(one, changes=({}, {}), force=None):
    """Mean stiffness [N/m] with changed gears or force: of spur gears by `ritz`, of others by `ritz3d`.

    The transverse section of a helical gear neglects its ends. For `helical_pitting` it is 1.6 times too stiff, and the effect
    of its bore is half as large.
    """
    gears = (replace(gear, **change) for gear, change in zip(one.pair.gears, changes, strict=True))
    pair = GearPair(*gears, one.pair.a)
    run = {"method": "ritz"} if not pair.gear_1.beta else {"method": "ritz3d", "face": one.face, "phases": WIDE}
    return float(gf.mesh_stiffness(pair, force or one.force, one.materials, **run).k.mean())


def changed(one):
    """Yield the changes of unprinted inputs of a pair: description and arguments of `mean`."""
    gears = one.pair.gears
    for name, factor in (("bores halved", 0.5), ("bores 0.8 times", 0.8), ("bores 1.4 times", 1.4)):
        yield name, {"changes": [{} if g.internal else {"r_bore": factor * g.r_bore} for g in gears]}
    yield "force halved", {"force": one.force / 2}
    yield "force doubled", {"force": 2 * one.force}
    yield "rack tip radius 0.25", {"changes": [{} if g.internal else {"rack_tip_radius": 0.25} for g in gears]}
    ring = gears[1]
    if ring.internal:
        yield "rim one module thicker", {"changes": ({}, {"r_rim": ring.r_rim + ring.m_n})}
        yield "rim one module thinner", {"changes": ({}, {"r_rim": ring.r_rim - ring.m_n})}
        yield "ring cutter of 30 teeth", {"changes": ({}, {"z_cutter": 30})}
        yield "ring addendum 0.1 lower", {"changes": ({}, {"addendum": ring.addendum - 0.1})}


def gears(name):
    """Rows (scene, pair, change, mean stiffness or its change in percent) of a scene."""
    rows = []
    for label, one in gf.load_scene(name).pairs.items():
        base = mean(one)
        rows.append((name, label, BASE, base))
        rows += [(name, label, change, 100 * (mean(one, **run) / base - 1)) for change, run in changed(one)]
    return rows


def pits(name):
    """Return the same for the largest loss of stiffness [%] by the pits of a case, by `ritz3d`."""
    case, scene = PITTED[name], gf.load_scene(name)
    label, one = next(iter(scene.pairs.items()))
    run = {"span": "tooth", "phases": 96, "method": "ritz3d"}
    whole = gf.mesh_stiffness(one.case(), **run).k
    rows = []
    for change, edit in (
        ("as assumed", lambda pit: pit),
        ("half as large", lambda pit: replace(pit, axes=tuple(0.5 * x for x in pit.axes))),
        ("0.5 mm nearer the tip", lambda pit: replace(pit, radius=pit.radius + 0.5)),
        ("0.5 mm nearer the root", lambda pit: replace(pit, radius=pit.radius - 0.5)),
        ("twice as deep", lambda pit: replace(pit, depth=2 * pit.depth)),
    ):
        damage = {"pinion": [edit(pit) for pit in one.damage[case]["pinion"]]}
        k = gf.mesh_stiffness(one.case(), **run, damage=damage).k
        rows.append((name, label, f"pits {change}: largest loss of k, case {case} [%]", float(100 * (1 - k / whole).max())))
    return rows


def read():
    """Return the committed rows."""
    return [(r["scene"], r["pair"], r["change"], float(r["value"])) for r in rows_of(CSV)]


def _pit_lines(known):
    for scene, _, change, loss in known:
        if change.startswith("pits"):
            yield f"| {scene}, {PITTED[scene]} | {change.split(':')[0]} | {loss:.4g} |"


def text():
    """Arguments of `page.text`, from the tables."""
    known = read()
    pairs = list(dict.fromkeys(row[:2] for row in known))
    value = {row[:3]: row[3] for row in known}
    changes = [name for name in dict.fromkeys(row[2] for row in known) if "[" not in name]
    lines = [
        f"""
        ## Stiffness

        The table gives the mean mesh stiffness, by `ritz` for spur gears and by `ritz3d` for others. Further rows give its
        change in percent if one assumption changes:

        | change | {" | ".join(", ".join(pair) for pair in pairs)} |
        """,
        "|---" * (1 + len(pairs)) + "|",
        "| as assumed [N/um] | " + " | ".join(in_newton_per_um(value[*pair, BASE]) for pair in pairs) + " |",
    ]
    for name in changes:
        cells = (f"{value[*pair, name]:+.1f}" if (*pair, name) in value else "" for pair in pairs)
        lines.append(f"| {name} | {' | '.join(cells)} |")
    lines += [
        """
        ## Pits

        The table gives the largest loss of k by `ritz3d`, in percent:

        | scene, case | change | loss |
        |---|---|---|
        """,
        *_pit_lines(known),
    ]
    bores = [value[*pair, name] for pair in pairs for name in changes if name.startswith("bores")]
    rest = max(abs(value[*pair, name]) for pair in pairs for name in changes if (*pair, name) in value and "bores" not in name)
    answer = (
        "The bores have the largest effect: from half to 1.4 times their size, they change the mean stiffness by "
        f"{min(bores):+.0f} "
        f"to {max(bores):+.0f} %. The other changes have effects of at most {rest:.1f} %. Face width, to which k is nearly "
        "proportional, and centre distance were not varied. The stiffness loss by a crack depends on its length and angle."
    )
    how = """
    `python -m validation assumptions` computes these tables (`tables/assumptions*`). gearfe computes both sides of each
    comparison, so the page shows the effect of a choice and not which choice is correct.
    """
    return answer, how, lines, conventions()


def conventions(again=False):
    """Lines: effect of the conventions of a crack on the reduction of k."""
    rows = reference.load()["crack"]["rows"][:3]
    levels = " | ".join(f"{100 * row['level']:.0f} %" for row in rows)
    lines = [
        f"""
        ## Cracks

        The table gives the largest reduction of k by `ritz` over the engagement of a cracked pinion tooth, without extended
        contact, for the 18/27 pair of [truth.md](truth.md). Level 50 % is at the centre-line. The first convention is that of
        an earlier study, whose values gearfe reproduces.

        | convention | {levels} |
        |---|---|---|---|
        """,
    ]
    for name, crack in CONVENTIONS.items():
        row = kept("assumptions_cracks", name, lambda crack=crack: _reductions(rows, crack), again)
        lines.append(f"| {name} | " + " | ".join(f"{v:.2f} %" for v in row["percent"]) + " |")
    return lines


def _reductions(rows, crack):
    return {"percent": [100 * reference.crack_reduction(row, **_sized(row, crack)) for row in rows]}


def _sized(row, crack):
    """Crack options of a convention; a length by the chord of the tooth root at its 30-degree tangents."""
    if crack.get("length") != "chord":
        return crack
    entry = next(r for r in reference.load()["healthy"]["rows"] if r["z"] == row["z"])
    gear = reference.healthy_pair(entry)[0].gear_1
    chord = 2 * float(cartesian(*root_curve(gear, start_arc(gear, gf.Crack(level=0.5))))[0])
    return {"level": None, "length": row["level"] * chord}


def compute():
    """Compute the table."""
    rows = []
    with own_warnings():
        for name in SCENES:
            rows += gears(name)
            if name in PITTED:
                rows += pits(name)
            print(f"  {name}: {len(rows)} rows", flush=True)
    write_table(CSV, ("scene", "pair", "change", "value"), rows)


def run(again=True):
    """Write the page. With `again`, its stored rows are computed again."""
    if again:
        compute()
        conventions(again)
    page.write("assumptions", *text())


def cheap():
    """Rows that `validation.check` computes again: mean stiffnesses, with one change at a time."""
    known = {row[:3]: row[3] for row in read()}
    for scene in SCENES:
        for label, one in gf.load_scene(scene).pairs.items():
            base = known[scene, label, BASE]
            yield f"{scene}, {label}", base, lambda one=one: mean(one)
            for change, run in changed(one):
                value = base * (1 + known[scene, label, change] / 100)
                yield f"{scene}, {label}, {change}", value, lambda one=one, run=run: mean(one, **run)

"""Part of the page `flanks.md`: random modified flanks, the energy model against finite elements, in the section and askew."""

import math

import numpy as np

import gearfe as gf

from ..shared.kept_rows import kept, stored
from ..shared.solid_pair import solid_contact

WIDE, SECTIONS = "flanks_fe3d", "flanks_fe"  # tables
SEEDS, PHASES, REFINE = range(6), (0.1, 0.43, 0.76), 0.6
SECTION_SEEDS = range(100, 200)
STEEL = gf.Material(E=207e3, nu=0.3)


def seeded_pair(seed):
    """Narrow pair, spur or helical, with flanks modified in both directions and axes askew: pair, flanks, misalignment, force."""
    rng = np.random.default_rng(seed)
    beta = math.radians(float(rng.choice([0, 10, 18])))
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": float(rng.uniform(8, 14))}
    one, two = rng.integers(20, 34, 2).tolist()
    pair = gf.GearPair(gf.Gear(z=one, r_bore=0.5 * one, beta=-beta, **rack), gf.Gear(z=two, r_bore=0.5 * two, beta=beta, **rack))
    flanks = {
        name: gf.Flank(
            helix_crowning=rng.uniform(0, 0.008), helix_slope=rng.uniform(-0.004, 0.004), twist=rng.uniform(-0.002, 0.002),
            end_relief=rng.uniform(0, 0.006), end_length=2.0, tip_relief=rng.uniform(0.002, 0.015), tip_exponent=2.0,
            tip_start_roll=gear.roll_a - 0.35 * (gear.roll_a - gear.roll_f),
        )
        for name, gear in (("pinion", pair.gear_1), ("wheel", pair.gear_2))
    }  # fmt: skip
    return pair, flanks, gf.Misalignment(F_beta_x=rng.uniform(-0.01, 0.01)), rack["b"] * rng.uniform(60, 250)


def against_fe3d(seed):
    """Mean deflection by `fe3d` [m], and the largest difference of `ritz3d` in the transmission error over it."""
    pair, flanks, askew, force = seeded_pair(seed)
    options = {"phases": list(PHASES), "flanks": flanks, "misalignment": askew}
    found = gf.mesh_stiffness(pair, force, STEEL, method="ritz3d", **options)
    truth = gf.mesh_stiffness(pair, force, STEEL, method="fe3d", refine=REFINE, **options)
    return float(truth.deflection.mean()), float(np.abs(found.te - truth.te).max() / truth.deflection.mean())


def seeded_section(seed):
    """Spur pair with flanks modified along their profiles, the same along the width: pair, flanks, force."""
    rng = np.random.default_rng(seed)
    m = float(rng.choice([1.5, 2.0, 3.0]))
    rack = {"m_n": m, "alpha_n": math.radians(20), "b": 10.0 * m}
    pair = gf.GearPair(*(gf.Gear(z=int(z), r_bore=0.25 * z * m, **rack) for z in rng.integers(20, 50, 2)))
    flanks = {}
    for name, gear in (("pinion", pair.gear_1), ("wheel", pair.gear_2)):
        length = (gear.roll_a - gear.roll_f) * rng.uniform(0.15, 0.45)
        exponent = float(rng.choice([1, 1.5, 2]))
        flanks[name] = gf.Flank(
            tip_relief=m * rng.uniform(0.001, 0.012), tip_start_roll=gear.roll_a - length, tip_exponent=exponent,
            profile_crowning=m * rng.uniform(0, 0.002), profile_slope=m * rng.uniform(-0.001, 0.002),
        )  # fmt: skip
    return pair, flanks, 10.0 * m * m * rng.uniform(20, 100)


def against_fe(seed):
    """Largest difference of `ritz` and `fe` in the transmission error over the mean deflection, 24 phases."""
    pair, flanks, force = seeded_section(seed)
    ritz, fe = (gf.mesh_stiffness(pair, force, STEEL, method=name, flanks=flanks, phases=24) for name in ("ritz", "fe"))
    return float(np.abs(ritz.te - fe.te).max() / fe.deflection.mean())


def wide_row(seed):
    """Row of a narrow pair: what it is, its deflection [um] by `fe3d`, and how far `ritz3d` is from it."""
    pair, _, _, force = seeded_pair(seed)
    deflection, away = against_fe3d(seed)
    one = pair.gear_1
    known = {"z": [one.z, pair.gear_2.z], "beta": math.degrees(abs(one.beta)), "b": one.b, "force": force}
    return known | {"deflection": 1e6 * deflection, "difference": away}


def reference():
    """Compute the rows that are not on file."""
    for seed in SECTION_SEEDS:
        kept(SECTIONS, f"section, seed {seed}", lambda seed=seed: {"difference": against_fe(seed)}, again=True)
    for seed in SEEDS:
        kept(WIDE, f"askew, seed {seed}", lambda seed=seed: wide_row(seed), again=True)


def text():
    """Lines of the page."""
    sections, wide = stored(SECTIONS), stored(WIDE)
    away = {seed: 100 * sections[f"section, seed {seed}"]["difference"] for seed in SECTION_SEEDS}
    worst = max(away, key=lambda seed: away[seed])
    lines = [
        f"""
        ## Random sections

        `ritz` against `fe` on {len(away)} random pairs: tip relief (linear to parabolic), crowning and slope on both gears,
        24 phases each: largest difference of the transmission error over the mean deflection. Median
        {np.median(list(away.values())):.3f} %, largest {away[worst]:.3f} % (seed {worst}). Each is on file
        ([tables/flanks_fe.jsonl](tables/flanks_fe.jsonl)).

        ## Along the width

        Random narrow pairs of m 2 with tip relief, lead crowning, helix slope, twist and end relief on both gears and
        misaligned axes, `ritz3d` against hexahedra of whole gears (`fe3d`, refine {REFINE:g}) at three phases; both are asked
        the same gaps, so this judges the bodies, not the gaps ([tables/flanks_fe3d.jsonl](tables/flanks_fe3d.jsonl)).

        | seed | teeth | helix | width | force | deflection [um] | largest difference of the error |
        |---|---|---|---|---|---|---|
        """
    ]
    for seed in SEEDS:
        row = wide[f"askew, seed {seed}"]
        lines.append(
            f"| {seed} | {row['z'][0]}/{row['z'][1]} | {row['beta']:.0f} deg | {row['b']:.1f} mm | "
            f"{row['force']:.0f} N | {row['deflection']:.2f} | {100 * row['difference']:.2f} % |"
        )
    return [*lines, *_section(), *_kinks()]


def _section():
    """Spur gears with the same profile along the width: three dimensions beside the section."""
    pair = spur_pair(30.0)
    lines = [
        """
        Spur gears 24/36 of m 3, 30 mm wide, 150 N/mm, the same profile along the width, three dimensions beside the section
        (plane strain is the stiffer one): peak-to-peak over 16 phases, and the mean error.

        | relief on both gears | `ritz` [um] | `ritz3d` [um] | mean, `ritz3d` over `ritz` |
        |---|---|---|---|
        """,
    ]
    shapes = {"none": None, "linear, 10 um over 4.7 mm": (0.01, 4.7, 1.0), "parabolic, 30 um over 4 mm": (0.03, 4.0, 2.0)}
    for name, shape in shapes.items():
        flanks = relieved(pair, shape)
        plane, solid = (
            gf.mesh_stiffness(pair, 4500.0, STEEL, method=method, phases=16, flanks=flanks).te for method in ("ritz", "ritz3d")
        )
        spans = [1e6 * float(np.ptp(te)) for te in (plane, solid)]
        lines.append(f"| {name} | {spans[0]:.2f} | {spans[1]:.2f} | {100 * (solid.mean() / plane.mean() - 1):+.2f} % |")
    return lines


def _kinks():
    """The same pair 100 mm wide in the limit of plane strain, where three dimensions and section must agree at every phase."""
    pair = spur_pair(100.0)
    lines = [
        """
        Only even loads along the width (plane strain), 100 mm wide, 64 phases: three dimensions against the section. Where a
        kink of a linear relief lies in the contact, the section resolves it hat by hat; three dimensions take its local law
        from there (`gearfe.contact.kink_law`; without it linear reliefs are off by 0.7 to 6.0 % at those phases).

        | relief on both gears | load | largest difference of the error, of the deflection | median |
        |---|---|---|---|
        """,
    ]
    shapes = {"none": None, "parabolic, 10 um over 4.7 mm": (0.01, 4.7, 2.0), "linear, 10 um over 4.7 mm": (0.01, 4.7, 1.0),
              "linear, 30 um over 4 mm": (0.03, 4.0, 1.0)}  # fmt: skip
    for name, shape in shapes.items():
        flanks = relieved(pair, shape)
        for load in (40.0, 150.0, 400.0):
            run = {"phases": 64, "flanks": flanks}
            plane = gf.mesh_stiffness(pair, 100 * load, STEEL, method="ritz", **run)
            solid = solid_contact(pair, 100 * load, STEEL, plane.phase, face="spur", axial=0, step=20.0, flanks=flanks)
            away = 100 * np.abs(1e-3 * solid.approach - plane.te) / plane.deflection
            lines.append(f"| {name} | {load:g} N/mm | {away.max():.2f} % | {np.median(away):.2f} % |")
    return lines


def spur_pair(width):
    """Pair of 24/36 teeth of m 3, so wide [mm]."""
    rack = {"m_n": 3.0, "alpha_n": math.radians(20), "b": width}
    return gf.GearPair(gf.Gear(z=24, r_bore=15.0, **rack), gf.Gear(z=36, r_bore=20.0, **rack))


def relieved(pair, shape):
    """Flanks with tip relief (amount [mm], roll length [mm], exponent) on both gears, or None."""
    if shape is None:
        return None
    amount, length, exponent = shape
    return {
        key: gf.Flank(tip_relief=amount, tip_start_roll=gear.roll_a - length, tip_exponent=exponent)
        for key, gear in (("pinion", pair.gear_1), ("wheel", pair.gear_2))
    }

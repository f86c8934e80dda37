"""The page `rig`: the vibration of a single pair over the speed, up and down, as a test rig of the literature measures it."""

import math
import tomllib
from functools import cache

import numpy as np
from matplotlib.figure import Figure

import gearfe as gf
from gearfe.core.files import save_figure
from gearfe.dynamics.machine.member import disc
from gearfe.dynamics.machine.of_scene import with_flanks

from ..shared import page
from ..shared.kept_rows import kept, stored
from ..shared.places import PAGES, SOURCES

TABLE, PICTURE = "rig", PAGES / "rig.png"
STEEL = gf.Material(E=206e3, nu=0.3)
RACK = {"m_n": 3.0, "alpha_n": math.radians(20), "b": 20.0}
TORQUE, ZETA, PLAY = 340.0, 0.02, 2e-4  # N m, part of critical, m
PARTS = tuple(2.0 ** (i / 2) for i in range(-12, 5))  # loads of the laws, of that of the largest torque
SPEEDS = np.round(np.concatenate([np.arange(0.24, 0.70, 0.02), np.arange(0.70, 1.205, 0.01)]), 4)  # mesh over natural frequency
KEPT, SAMPLES, FORGOTTEN = 20, 64, 6.0  # cycles, samples in each, logarithm of what is left of a free vibration before them
APART = 0.05  # of the larger amplitude: two motions that differ by more are two
CASES = {  # torque [N m], damping ratio, tip relief [um] and where it starts, part of the way from single contact to the tip
    "340 N m": (340.0, ZETA, 0.0, 0.0),
    "170 N m": (170.0, ZETA, 0.0, 0.0),
    "85 N m": (85.0, ZETA, 0.0, 0.0),
    "340 N m, damping 1 %": (340.0, 0.01, 0.0, 0.0),
    "340 N m, damping 5 %": (340.0, 0.05, 0.0, 0.0),
    "340 N m, relief 10 um, long": (340.0, ZETA, 10.0, 0.0),
    "340 N m, relief 20 um, long": (340.0, ZETA, 20.0, 0.0),
    "340 N m, relief 10 um, short": (340.0, ZETA, 10.0, 0.5),
}
HEAVIER = 2.0  # times the mass, to see that it moves the curve along the axis alone
HOW = """
`python -m validation rig` makes this page from `tables/rig.jsonl` and computes them.
**No text, table or figure of the source could be had, and none of its numbers is on this page**: what is recalled of it stands
in `sources/rig.toml` and below, marked so, and nothing is judged by it. What is judged is whether the phenomena that made such
rigs known come out of the gears' own contact, without a stiffness or a kink put in by hand.
"""


@cache
def pair():
    """The gears of the rig."""
    gear = gf.Gear(z=50, r_bore=0.5 * (75.0 - 1.25 * RACK["m_n"]), **RACK)
    return gf.GearPair(gear, gear)


@cache
def law(relief, begins):
    """Law of force by `ritz`, with linear tip relief [um] on both gears."""
    gears, options = pair(), {}
    if relief:
        one = gears.gear_1
        tip = math.sqrt(one.r_a**2 - one.r_b**2)
        long = (gears.eps_alpha - 1) * math.pi * RACK["m_n"] * math.cos(RACK["alpha_n"])
        flank = gf.Flank(tip_relief=1e-3 * relief, tip_start_roll=tip - (1 - begins) * long)
        options = {"flanks": {"pinion": flank, "wheel": flank}}
    largest = 1e3 * TORQUE / gears.gear_1.r_b
    return gf.force_law(gears, [part * largest for part in PARTS], STEEL, force=largest, phases=64, **options)


def machine(case, frequency=1000.0, heavier=1.0):
    """The pair as one mass along its line of action; its mesh frequency [Hz]."""
    torque, zeta, *flank = CASES[case]
    radius = 1e-3 * pair().gear_1.r_b
    mass = heavier * disc(pair().gear_1, 7850.0, 0.0).inertia / (2 * radius**2)
    made = gf.single_mesh(mass, law(*flank), frequency, force=torque / radius, backlash=PLAY)
    k = made.linear(made.working())[2][0]
    return with_flanks(made.with_meshes(damping=2 * zeta * math.sqrt(k * mass)))


def swept(case, speeds, heavier=1.0):
    """Natural frequency [Hz]; at mesh frequencies over it in turn RMS of the error [m], time open, least compression [m]."""
    natural = float(gf.natural_frequencies(machine(case, heavier=heavier))[0][0])
    settle, initial, out = FORGOTTEN / (CASES[case][1] * 2 * math.pi * natural), None, []
    for speed in speeds:
        made, frequency = machine(case, speed * natural, heavier), speed * natural
        cycles, step = math.ceil(settle * frequency) + KEPT, min(1 / SAMPLES / frequency, 1 / SAMPLES / natural) / 2
        options = {"rate": SAMPLES * frequency, "step": step, "error": False, "filtered": False, "initial": initial}
        found = gf.simulate(made, cycles / frequency, **options)
        initial = found.q[-1], found.v[-1]
        last = slice(-SAMPLES * KEPT, None)
        pressed = found["compression mesh"][last]
        out.append((float(found["pair.x"][last].std()), float((pressed <= 0).mean()), float(pressed.min())))
    return natural, np.array(out)


def made(case):
    """A row: both sweeps."""
    natural, up = swept(case, SPEEDS)
    down = swept(case, SPEEDS[::-1])[1][::-1]
    still = machine(case).working()[0]
    told = {"natural": natural, "static": float(still)} | {"up": up[:, 0].tolist(), "down": down[:, 0].tolist()}
    whole = np.concatenate([up, down])
    return told | {"open": float(whole[:, 1].max()), "least": float(whole[:, 2].min())}


def checks():
    """A row: the same by shooting, at speeds off the folds, and of a heavier pair, whose curve is to lie on the other."""
    case, speeds = "340 N m", (0.4, 0.6, 1.2)
    natural, one = swept(case, speeds)
    steady = [gf.steady_state(machine(case, speed * natural)).response["pair.x"][:-1].std() for speed in speeds]
    other = swept(case, speeds, HEAVIER)
    shooting, heavier = (float(np.abs(two / one[:, 0] - 1).max()) for two in (np.array(steady), other[1][:, 0]))
    return {"shooting": shooting, "heavier": heavier, "natural": other[0] / natural}


def peaks(row):
    """Local maxima of the larger of both sweeps: (speed, RMS [m]), those a fifth of the largest at least."""
    most = np.maximum(row["up"], row["down"])
    inside = np.flatnonzero((most[1:-1] > most[:-2]) & (most[1:-1] >= most[2:])) + 1
    return [(float(SPEEDS[i]), float(most[i])) for i in inside if most[i] > 0.2 * most.max()]


def twofold(row):
    """Stretches of speeds at which the way up and the way down differ: (first, last)."""
    up, down = np.array(row["up"]), np.array(row["down"])
    apart = np.flatnonzero(np.abs(up - down) > APART * np.maximum(up, down))
    runs = np.split(apart, np.flatnonzero(np.diff(apart) > 1) + 1) if apart.size else []
    return [(float(SPEEDS[one[0]]), float(SPEEDS[one[-1]])) for one in runs]


def section(rows):
    """Lines: a row per case."""
    head = "| case (natural frequency) | resonances, over it | RMS there [um] | two motions at | contact open at most |"
    lines = [head, "|---|---|---|---|---|"]
    for name, row in rows.items():
        places, sizes = zip(*peaks(row), strict=True)
        both = twofold(row)
        cells = [", ".join(f"{one:.3g}" for one in places), ", ".join(f"{1e6 * one:.2f}" for one in sizes)]
        cells += [
            "; ".join(f"{low:.3g}" + (f" to {high:.3g}" if high > low else "") for low, high in both) or "none",
            f"{100 * row['open']:.0f} % of the time",
        ]
        lines.append(f"| {name} ({row['natural']:.0f} Hz) | {' | '.join(cells)} |")
    return lines


def inputs():
    """Lines: what is known of the rig and from where."""
    told = tomllib.loads((SOURCES / "rig.toml").read_text(encoding="utf-8"))
    lines = [f"- {one['cited']}. At hand: {one['at_hand']}." for one in told["source"]]
    lines += ["", "*Recalled*: from memory, confirmed by no document. *Missing*: not even that; the value is a choice.", ""]
    lines += ["| input | value | from |", "|---|---|---|"]
    lines += [f"| {one['what']} | {one['value']} | {one['from']} |" for one in told["input"]]
    return [*lines, "", *(f"Recalled: {one['what']} ({one['judged']})." for one in told["recalled"])]


def picture(rows):
    """Draw both sweeps of all cases."""
    figure = Figure(figsize=(10, 7.5), layout="constrained")
    groups = {"torque": list(CASES)[:3], "damping ratio, 340 N m": [list(CASES)[i] for i in (3, 0, 4)]}
    groups["tip relief, 340 N m"] = [list(CASES)[i] for i in (0, 5, 7, 6)]
    axes = figure.subplots(3, 1, sharex=True)
    for place, (title, names) in zip(axes, groups.items(), strict=True):
        for name in names:
            (line,) = place.plot(SPEEDS, 1e6 * np.array(rows[name]["down"]), label=name)
            place.plot(SPEEDS, 1e6 * np.array(rows[name]["up"]), "--", color=line.get_color())
        place.set_title(f"{title} (whole lines: down, broken: up)", loc="left", fontsize=10)
        place.set_ylabel("RMS [um]")
        place.legend(fontsize=8, loc="upper left")
    axes[-1].set_xlabel("mesh frequency over the natural frequency at the mean tangent stiffness")
    save_figure(figure, PICTURE, dpi=80)


def answer(rows):
    """The first line."""
    row, relieved = rows["340 N m"], rows["340 N m, relief 10 um, long"]
    place, size = max(peaks(row), key=lambda one: one[1])
    low, high = twofold(row)[-1]
    others = [max(peaks(rows[f"340 N m, relief {name}"]), key=lambda one: one[1])[1] for name in ("20 um, long", "10 um, short")]
    after, damped = max([*relieved["up"], *relieved["down"]]), twofold(rows["340 N m, damping 5 %"])
    return (
        f"The phenomena do: at 340 N m and 2 % of damping the primary resonance softens to {place:.2f} of the natural frequency, "
        f"between {low:.2f} and {high:.2f} of it two motions stand side by side"
        + ("" if damped else ", with 5 % of damping none do")
        + f", and 10 um of long tip relief take the largest RMS of the transmission error from {1e6 * size:.1f} to "
        f"{1e6 * after:.1f} um, while twice as much makes it {1e6 * others[0]:.1f} and as much of a short one "
        f"{1e6 * others[1]:.1f} um. The rig's printed numbers could not be had: none is compared."
    )


def run(again=True):
    """Write the page; `again`: compute its rows again."""
    rows = {name: kept(TABLE, name, lambda name=name: made(name), again) for name in CASES}
    own = kept(TABLE, "checks", checks, again)
    picture(rows)
    used = -1e6 * min(row["least"] for row in rows.values())
    third = [
        f"Against shooting (`gf.steady_state`) at three speeds off the folds: {100 * own['shooting']:.2g} %. A pair of "
        f"{HEAVIER:g} times the mass has {own['natural']:.4f} of the natural frequency and, over that, the same curve within "
        f"{100 * max(own['heavier'], 1e-8):.1g} %: the missing moments of inertia move the curve and do not change it. All of "
        "it shares the law of force, whose contact is judged in [outlines.md](outlines.md). "
        f"Of {1e6 * PLAY:g} um of play {used:.0f} are used at most."
    ]
    drawn = ["![RMS of the dynamic transmission error over the mesh frequency](rig.png)"]
    page.write("rig", answer(rows), HOW.strip().splitlines(), drawn, section(rows), third, ["## What is known", ""], inputs())


def cheap():
    """Rows that `validation.check` computes again: the begin of each way up, and the checks."""
    known = stored(TABLE)
    for name in CASES:
        yield name, known[name]["up"][:8], lambda name=name: swept(name, SPEEDS[:8])[1][:, 0].tolist()
    yield "checks", _over_one(known["checks"]), lambda: _over_one(checks())


def _over_one(row):
    return [1 + row[name] for name in ("shooting", "heavier", "natural")]

"""Page `growth_detection`: a growing root crack, its life, and the crack length at which two indicators detect it."""

import math

import numpy as np
from matplotlib.figure import Figure

import gearfe as gf
from gearfe.core.files import save_figure
from gearfe.geometry.damage.crack import crack_path
from gearfe.geometry.tooth.drawing import outline_points

from ..shared import kept_rows, page
from ..shared.places import PAGES
from .growth import CASE, GEAR

LAW = gf.ParisLaw(5.21e-13, 3.0, threshold=63.0, source="BS 7910:2013, steel in air, simplified law")
START, STEP = gf.Crack(length=0.3), 0.1
MESH, SHAFT, RATE, TIME, SETTLED = 1050.0, 50.0, 52500.0, 0.5, 0.1  # mesh and shaft frequency [Hz], rate [Hz], durations [s]
PITCH, NOISES, LOAD = 2e-6, (30.0, 300.0), 0.02  # standard deviations: pitch [m], sensor [m/s^2], load between two records
NAMES = [f"{way} (noise {noise:g})" for noise in NOISES for way in ("FM4 alone", "change since healthy")]
FALSE, GEARS, DRAWS = 0.01, 60, 2000  # false-alarm rate, simulated healthy gears, records drawn for each length
TURNS = int(SHAFT * (TIME - SETTLED))


def grown():
    """Return the growth of the crack up to the loss of the tooth."""
    return gf.grow_crack(CASE, START, step=STEP, law=LAW)


def averaged(curve, error=None, damage=()):
    """Return the synchronous average of the acceleration along the line of action, without noise [m/s^2]."""
    machine = gf.single_mesh(0.2, curve, MESH, force=CASE.force, zeta=0.07, teeth=(GEAR.z, 31), damage=damage)
    if error is not None:
        machine = gf.with_errors(machine, profile=error)
    response = gf.simulate(machine, TIME, rate=RATE)
    late = response["pair.x acceleration"][response.time >= SETTLED]
    return gf.synchronous_average(gf.Signal(late, RATE, "m/s^2", shaft_frequency=SHAFT))[0]


def pitch_error(rng):
    """Return random pitch deviations of the pinion over a revolution, varied linearly over double contact."""
    teeth, steps = rng.normal(0.0, PITCH, GEAR.z), 32
    place = np.arange(steps * GEAR.z) / steps
    tooth, part = place.astype(int), np.clip(place % 1 / (CASE.pair.eps_alpha - 1), 0.0, 1.0)
    return gf.Samples(place, (1 - part) * teeth[tooth - 1] + part * teeth[tooth])


def healthy_rows():
    """Return the residual signals of healthy gears ``(GEARS, n)`` [m/s^2]."""
    curve, rng = gf.solve(CASE), np.random.default_rng(55)
    return {"residual": [np.round(residual(averaged(curve, pitch_error(rng))), 2).tolist() for _ in range(GEARS)]}


def residual(average):
    """Return the average without mesh lines and shaft orders [m/s^2]."""
    return gf.residual_signal(average, GEAR.z)


def cracked_row(crack):
    """Return loss of mean stiffness, change of peak-to-peak transmission error, and the crack's part of the residual signal."""
    curve = gf.solve(CASE)
    case = gf.Case(CASE.pair, CASE.force, CASE.materials, damage={"pinion": [crack]})
    hurt = gf.solve(case, gf.Solve(span="tooth"))
    sound = gf.solve(CASE, gf.Solve(span="tooth", phases=hurt.phase))
    change = residual(averaged(curve, damage=(gf.ToothDamage(body=0, tooth=8, curve=hurt),))) - residual(averaged(curve))
    return {
        "k_percent": 100 * float(1 - (hurt.k / sound.k).min()),
        "te_um": 1e6 * float(np.ptp(hurt.deflection) - np.ptp(sound.deflection)),
        "residual": np.round(change, 3).tolist(),
    }


def detection(healthy, change, noise):
    """Return detection probabilities of FM4, and of the RMS change of the residual signal since a healthy record.

    Limits are the quantiles of healthy gears with the false-alarm rate. The noise of an average falls with the root of its
    revolutions, and a record of another load scales the residual signal.
    """
    rng, noise = np.random.default_rng(56), noise / math.sqrt(TURNS)
    found = {}
    for name, part in (("healthy", 0.0), ("cracked", 1.0)):
        gear = healthy[rng.integers(len(healthy), size=DRAWS)]
        shift = rng.integers(GEAR.z, size=DRAWS) * (healthy.shape[1] // GEAR.z)
        gear = np.array([np.roll(one, n) for one, n in zip(gear, shift, strict=True)])  # the crack is in any tooth
        loads = 1 + LOAD * rng.standard_normal((2, DRAWS, 1))
        before, now = (load * (gear + crack * change) + noise * rng.standard_normal(gear.shape)
                       for load, crack in zip(loads, (0.0, part), strict=True))  # fmt: skip
        centred = now - now.mean(axis=1, keepdims=True)
        found[name] = (centred**4).mean(axis=1) / (centred**2).mean(axis=1) ** 2, (now - before).std(axis=1)
    pairs = zip(found["healthy"], found["cracked"], strict=True)
    return [float((hurt > np.quantile(sound, 1 - FALSE)).mean()) for sound, hurt in pairs]


def run(again=True):
    """Compute the rows and write the page."""
    growth = grown()
    healthy = np.array(kept_rows.kept("growth_detection", "healthy", healthy_rows, again)["residual"])
    chosen = [n for n in range(len(growth.cracks)) if n < 9 or n % 6 == 0]
    rows = [kept_rows.kept("growth_detection", f"{n}", lambda n=n: cracked_row(growth.cracks[n]), again) for n in chosen]
    chance = np.array([[p for noise in NOISES for p in detection(healthy, np.array(row["residual"]), noise)] for row in rows])
    picture(growth, chosen, rows, chance)
    page.write("growth_detection", answer(growth, chosen, chance), table(growth, chosen, rows, chance), HOW)


def first(length, chance):
    """Return the length [mm] at which the detection probability reaches 90 %, interpolated linearly, or nan."""
    above = np.flatnonzero(chance >= 0.9)
    if not above.size:
        return math.nan
    n = int(above[0])
    return float(length[0] if n == 0 else np.interp(0.9, chance[n - 1 : n + 1], length[n - 1 : n + 1]))


def answer(growth, chosen, chance):
    """Return the first lines of the page."""
    lines = []
    for name, values in zip(NAMES, chance.T, strict=True):
        length, name = first(growth.length[chosen], values), name.replace("noise", "noise of").replace(")", " m/s^2)")
        if math.isnan(length):
            lines.append(f"- By {name}, the crack is not detected with 90 % probability at any of these lengths.")
            continue
        left = 1 - float(np.interp(length, growth.length, growth.cycles)) / growth.cycles[-1]
        lines.append(
            f"- By {name}, the crack is detected with 90 % probability from {length:.1f} mm on. "
            f"{100 * left:.0f} % of the life is left then."
        )
    lines.append(
        f"- The crack grows from {growth.length[0]:g} mm to {growth.length[-1]:.1f} mm in {growth.cycles[-1]:.3g} revolutions "
        f"({growth.outcome}). False alarms are {100 * FALSE:g} % of records of healthy gears."
    )
    return "\n".join(lines)


def table(growth, chosen, rows, chance):
    """Return the table by length."""
    lines = ["![growth and detection](growth_detection.png)", ""]
    lines += ["| length [mm] | revolutions | largest loss of k | TE peak to peak [um] | " + " | ".join(NAMES) + " |"]
    lines += ["|---" * (4 + len(NAMES)) + "|"]
    for n, row, values in zip(chosen, rows, chance, strict=True):
        cells = " | ".join(f"{100 * value:.0f} %" for value in values)
        head = f"| {growth.length[n]:.1f} | {growth.cycles[n]:.3g} | {row['k_percent']:.1f} % | {row['te_um']:+.2f} "
        lines.append(f"{head}| {cells} |")
    return lines


def picture(growth, chosen, rows, chance):
    """Draw path, probabilities of detection and loss of stiffness over the revolutions."""
    figure = Figure(figsize=(9.5, 3.2), layout="constrained")
    tooth, axes = figure.subplots(1, 2, width_ratios=(1, 2.2))
    tooth.plot(*outline_points(GEAR), color="0.3", linewidth=0.8)
    tooth.plot(*crack_path(GEAR, growth.cracks[-1]), marker=".", markersize=3)
    tooth.set(xlim=(-3.4, 3.4), ylim=(17, GEAR.r_a + 0.2), aspect="equal", title="path of the crack")
    tooth.axis("off")
    for name, values in zip(NAMES, chance.T, strict=True):
        axes.plot(growth.cycles[chosen], 100 * values, marker=".", label=name)
    axes.plot(growth.cycles[chosen], [row["k_percent"] for row in rows], color="0.5", linestyle="--", label="largest loss of k")
    axes.set(xlabel="revolutions of the pinion since 0.3 mm", ylabel="detected [%]", ylim=(0, 103), xlim=(0, None))
    axes.legend(fontsize=8)
    save_figure(figure, PAGES / "growth_detection.png", dpi=90)


HOW = f"""
`python -m validation growth_detection` computes the page. The pair has 21 and 31 teeth of module 2 mm, 20 mm width and a load
of 2000 N. The crack starts at the 30-degree tangent at 45 degrees. Each revolution is one cycle of Paris's law with
da/dN = 5.21e-13 dK^3 (mm, MPa sqrt(mm)) and a threshold of 63 (BS 7910:2013, steel in air). These constants are quoted, not
checked against a copy of the standard. The loads are those of the healthy pair. Vibration is that of one mass of 0.2 kg on the
mesh, at a shaft frequency of 50 Hz. The damping ratio is 0.07.

The {GEARS} healthy gears have pitch deviations with a standard deviation of {1e6 * PITCH:g} um. The sensor noise is
{NOISES[0]:g} or {NOISES[1]:g} m/s^2, averaged over {TURNS} revolutions. The load differs by {100 * LOAD:g} % between two
records. These values are assumed, and they decide the result. Noise lowers FM4 of healthy gears, and with it the limit of FM4.

The residual signal has neither mesh lines nor shaft orders. The part of the crack in it is added to that of a healthy gear, in
any tooth. {DRAWS} records are drawn for each length. The limits are the {100 - 100 * FALSE:g} % quantiles of healthy records. FM4
alone needs no history. The change since a healthy record is the RMS of the difference of two residual signals of one gear.
"""

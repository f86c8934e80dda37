"""The three sentences that open the page of a machine: what the article claims, what gearfe finds, what decides it."""

from gearfe.scene.verdicts import REPRODUCED
from gearfe.units import NEWTON_PER_UM

from .places import TABLES
from .table_rows import rows_of


def planetary_pitting(found):
    """Articles S0 and S1."""
    rms, peaks = found.all("rms"), found.all("amplitudes")
    away = [
        " to ".join(f"{100 * (f(x / y for x, y in zip(ours, found.printed(name), strict=True)) - 1):+.0f}" for f in (min, max))
        for name, ours in (("rms", rms), ("amplitudes", peaks))
    ]
    many = ", ".join(f"{x:.2g}" for x in rms)
    high = ", ".join(f"{x:.2g}" for x in peaks)
    return (
        "that the sideband centroid SC grows with the number of pits on a sun tooth, 285 to 350 Hz simulated and 290 to "
        "353 Hz measured, "
        "and hardly depends on impacts, while RMS (1.2, 1.3, 1.5 m/s^2), kurtosis and shape factor tell the levels less well",
        f"under the articles' own contact law RMS {many} and peaks {high} m/s^2, in the printed order, but {away[0]} and "
        f"{away[1]} % off the printed sizes, and an SC of "
        f"{', '.join(f'{x:.1f}' for x in found.all('sc_simulated'))} Hz, the same for all levels",
        "the definition of SC: it averages frequencies from 240 to 320 Hz, so that 349.8 and 352.9 Hz cannot come out "
        "whatever the "
        "machine, while levels hang on load, masses and the path to the sensor, which are not printed",
    )


def helical_pitting(found):
    """Article S3."""
    said = [row for row in found.rows.values() if row.id == "statements"]
    yes = sum(row.verdict == REPRODUCED for row in said)
    multi = found.ours("statements", "multi: 2 f_r is the largest low line")
    return (
        "that pits raise lines at multiples of the pinion's turning frequency f_r and sidebands about the mesh frequency "
        "which grow with "
        "the pit, and that several pits are known by 2 f_r, one large one by f_r",
        f"under the article's own law {yes} of its {len(said)} statements, beside what the places assumed for the pits set; "
        f"2 f_r is {'' if multi else 'not '}the largest low line of the three pits",
        "where the pits lie, which S3 does not print: pits on one tooth repeat once a turn and give most at f_r in the "
        "lost contact "
        "line, pits on two teeth nearly opposite give 2 f_r",
    )


def herringbone_machine(found):
    """Article S4, its dynamics."""
    span = found.all("displacement_span")
    kurtosis, crest = (max(found.all(f"{name}_most")) for name in ("kurtosis", "crest"))
    bare = [_grown(name) for name in ("its kurtosis", "sun's angular acceleration, crest factor")]
    return (
        "that a crack and pits in the sun of a herringbone stage widen the sun's motion from 3.56 to 6.66 um, bring lines "
        "80 Hz about the "
        "mesh line, and raise the kurtosis (up to 133 %) more than the crest factor (up to 83 %)",
        f"the lines and their order, but a range along x of {min(span):.3g} to {max(span):.3g} um that the errors make and "
        "damage hardly "
        f"moves, and increments of at most {kurtosis:.2g} % (kurtosis) and {crest:.2g} % (crest factor) of the sun's "
        f"angular acceleration with the errors assumed, {bare[0]:.2g} and {bare[1]:.2g} % without any "
        "(the stiffness tables are on [their own page](herringbone.md))",
        "sizes of errors, supports and damping, none of them printed: three planets in phase cancel in x, and printed "
        "inertias 6 to 107 "
        "times too large for such gears hold the sun's rotation still",
    )


def _grown(quantity):
    """Largest growth [%] of a quantity of the herringbone stage over the healthy one, in a machine without errors."""
    rows = [row for row in rows_of(TABLES / "herringbone_machine_laws.csv") if row["quantity"] == quantity]
    healthy, *others = (float(row["without errors"]) for row in rows)
    return 100 * (max(others) / healthy - 1)


def compound_planetary(found):
    """Article S2."""
    beams, true = (
        found.ours(name, "s2_sun_planet", "sun_planet") / NEWTON_PER_UM for name in ("mean_stiffness", "converged_stiffness")
    )
    rings = [found.ours("stiffness_ratio", f"{name}_ring_planet") for name in ("s1", "s2")]
    heard = found.all("kurtosis")
    return (
        "mean stiffnesses of five meshes near 1600 N/um, and sidebands 16.8 and 18.2 Hz about two mesh lines for cracked "
        "sun teeth, found in "
        "measured signals by kurtosis and kurtogram",
        f"the frequencies and sidebands, and with the article's beams {beams:.0f} N/um for sun and planet, but ring meshes "
        f"{rings[0]:.2f} and "
        f"{rings[1]:.2f} times as stiff instead of 1.00 and 0.94, a converged stiffness of the same gears of {true:.0f} N/um, "
        f"{beams / true:.1f} times less, and kurtoses of {min(heard):.3g} to {max(heard):.3g} instead of 3.01 to 5.24",
        "the foundation under the teeth, which the article leaves out, its lost table of parameters, and the resonances of "
        "a housing that is "
        "not modelled",
    )


OPENINGS = {one.__name__: one for one in (planetary_pitting, compound_planetary, helical_pitting, herringbone_machine)}

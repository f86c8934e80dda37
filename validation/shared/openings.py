"""The three sentences that open the page of a machine: what the article claims, what gearfe finds, what decides it."""

from gearfe import load_scene
from gearfe.core.units import NEWTON_PER_UM
from gearfe.scene.verdicts import REPRODUCED, TREND

from .places import TABLES
from .table_rows import rows_of


def planetary_pitting(found):
    """Articles S0 and S1."""
    sc = found.all("sc_simulated")
    same = ", all levels within 1 Hz" if max(sc) - min(sc) < 1 else ""
    mesh, fault = (found.ours(f"{name}_frequency", "simulated") for name in ("mesh", "fault"))
    low, high = mesh - fault, mesh + fault  # over which S0 averages
    ends = [f"{min(values):.0f} to {max(values):.0f}" for values in map(found.printed, ("sc_simulated", "sc_measured"))]
    beyond = [f"{x:g}" for x in (*found.printed("sc_simulated"), *found.printed("sc_measured")) if x > high]
    return (
        f"that the sideband centroid SC grows with the number of pits on a sun tooth, {ends[0]} Hz simulated and {ends[1]} Hz "
        f"measured, and hardly depends on impacts, while RMS ({_list(found.printed('rms'))} m/s^2), kurtosis and shape factor "
        "tell the levels less well",
        f"under the articles' own contact law, their N pits on one line, {_sizes(found, 'rms', 'RMS')} and "
        f"{_sizes(found, 'amplitudes', 'peaks')}, and an SC of {', '.join(f'{x:.1f}' for x in sc)} Hz{same}"
        f"; three repeats tell the levels apart by {', '.join(_telling(found)) or 'none of its indicators'}",
        f"the definition of SC: it averages frequencies from {low:g} to {high:g} Hz, so that "
        f"{' and '.join(beyond)} Hz cannot come out whatever the machine, while levels hang on load, masses and the path to the "
        "sensor, which are not printed",
    )


def _telling(found):
    """Indicators whose three repeats tell the levels apart, as the articles judge each."""
    rising, others = ("SC by S0's formula", "SC by S1's formula"), ("RMS", "kurtosis", "shape factor")
    yes = [word for word in rising if found.ours("further", f"three repeats: {word} tells{APART}")]
    return yes + [word for word in others if not found.ours("further", f"three repeats: {word} does not tell{APART}")]


APART = " the levels apart"


def _list(values):
    return ", ".join(f"{x:.2g}" for x in values)


def _sizes(found, name, called):
    """Our values of a reference, whether they have the printed order, and how far they are off."""
    ours, printed = found.all(name), found.printed(name)
    off = " to ".join(f"{100 * (f(x / y for x, y in zip(ours, printed, strict=True)) - 1):+.0f}" for f in (min, max))
    order = (
        "in the printed order" if {row.verdict for row in found.rows.values() if row.id == name} == {TREND} else "not in order"
    )
    return f"{called} {_list(ours)} m/s^2, {order}, {off} % off the printed sizes"


def helical_pitting(found):
    """Article S3."""
    placed = {row.case for one in load_scene("helical_pitting").references for row in one.rows if row.set_by}
    said = [row for row in found.rows.values() if row.id in ("statements", "further") and row.case not in placed]
    yes = sum(row.verdict == REPRODUCED for row in said)
    multi = found.ours("statements", "multi: 2 f_r is the largest low line")
    return (
        "that pits raise lines at multiples of the pinion's turning frequency f_r and sidebands about the mesh frequency "
        "which grow with "
        "the pit, and that several pits are known by 2 f_r, one large one by f_r",
        f"that under the article's own law {yes} of its {len(said)} statements hold, not counting what follows from the "
        "places assumed for the pits; "
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
    wide = found.printed("displacement_span")
    most = [max(found.printed(f"{name}_most")) for name in ("kurtosis", "crest")]
    heavy = [a / b for a, b in zip(found.printed("inertias"), found.all("inertias"), strict=True)]
    order = [row.verdict == REPRODUCED for row in found.rows.values() if row.id == "statements" and row.case.endswith(HIGHER)]
    return (
        f"that a crack and pits in the sun of a herringbone stage widen the sun's motion from {min(wide):g} to {max(wide):g} um, "
        f"bring lines {found.ours('fault_frequency', 'N f_m / z_s'):g} Hz about the mesh line, and raise the kurtosis (up to "
        f"{most[0]:.0f} %) more than the crest factor (up to {most[1]:.0f} %)",
        f"the lines, and {sum(order)} of {len(order)} statements on which are higher, but a range along x of {min(span):.3g} to "
        f"{max(span):.3g} um that the errors make and damage hardly moves, and increments of at most {kurtosis:.2g} % (kurtosis) "
        f"and {crest:.2g} % (crest factor) of the sun's angular acceleration with the errors assumed, {bare[0]:.2g} and "
        f"{bare[1]:.2g} % without any in the states below "
        "(the stiffness tables are on [their own page](herringbone.md))",
        "sizes of errors, supports and damping, none of them printed: three planets in phase cancel in x, and printed "
        f"inertias {min(heavy):.0f} to {max(heavy):.0f} "
        "times too large for such gears hold the sun's rotation still",
    )


HIGHER = ("sidebands lower than of the crack", "sidebands above crack or pits alone", "sidebands above case 2")


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
    heard, measured = found.all("kurtosis"), found.printed("kurtosis")
    means, lines = (found.printed(name) for name in ("mean_stiffness", "fault_frequencies"))
    low, high = (f(means) / NEWTON_PER_UM for f in (min, max))
    ratios = dict(zip(("b_c", "s1", "s2"), found.printed("stiffness_ratio"), strict=True))
    return (
        f"mean stiffnesses of five meshes from {low:.0f} to {high:.0f} N/um, and sidebands {lines[0]:g} and {lines[1]:g} Hz "
        "about two mesh lines for cracked sun teeth, found in measured signals by kurtosis and kurtogram",
        f"the frequencies and sidebands, and with the article's beams {beams:.0f} N/um for sun and planet, but ring meshes "
        f"{rings[0]:.2f} and {rings[1]:.2f} times as stiff instead of {ratios['s1']:.2f} and {ratios['s2']:.2f}, a converged "
        f"stiffness of the same gears of {true:.0f} N/um, {beams / true:.1f} times less, and kurtoses of {min(heard):.3g} to "
        f"{max(heard):.3g} instead of {min(measured):.3g} to {max(measured):.3g}",
        "the foundation under the teeth, which the article leaves out, its lost table of parameters, and whether a "
        "broken tooth is absent, as here, or a deep crack",
    )


OPENINGS = {one.__name__: one for one in (planetary_pitting, compound_planetary, helical_pitting, herringbone_machine)}

"""The three sentences that open the page of a machine: claim, result and cause."""

from gearfe import load_scene
from gearfe.core.units import NEWTON_PER_UM
from gearfe.scene.verdicts import REPRODUCED


def planetary_pitting(found):
    """Return the opening sentences for articles S0 and S1."""
    sc = found.all("sc_simulated")
    same = ", all levels within 1 Hz" if max(sc) - min(sc) < 1 else ""
    mesh, fault = (found.ours(f"{name}_frequency", "simulated") for name in ("mesh", "fault"))
    low, high = mesh - fault, mesh + fault  # Article S0 averages both sidebands.
    ends = [f"{min(values):.0f} to {max(values):.0f}" for values in map(found.printed, ("sc_simulated", "sc_measured"))]
    beyond = [f"{x:g}" for x in (*found.printed("sc_simulated"), *found.printed("sc_measured")) if x > high]
    return (
        f"the sideband centroid SC increases with the number of pits on a sun tooth. It is {ends[0]} Hz simulated and {ends[1]} "
        f"Hz measured. It hardly depends on impacts. RMS ({_list(found.printed('rms'))} m/s^2), kurtosis and shape factor "
        "separate the levels less well",
        f"SC is {', '.join(f'{x:.1f}' for x in sc)} Hz under the articles' own contact law{same}. "
        f"{_sizes(found, 'rms', 'RMS values')}. {_sizes(found, 'amplitudes', 'Peaks')}. "
        f"Three repeats separate the levels by {', '.join(_telling(found)) or 'none of its indicators'}",
        f"SC averages frequencies from {low:g} to {high:g} Hz by definition, so that "
        f"{' and '.join(beyond)} Hz are impossible. Load, masses and sensor path are not printed",
    )


def _telling(found):
    """Return the indicators whose three repeats separate the levels, as the articles judge each."""
    rising, others = ("SC by S0's formula", "SC by S1's formula"), ("RMS", "kurtosis", "shape factor")
    yes = [word for word in rising if found.ours("further", f"three repeats: {word} tells{APART}")]
    return yes + [word for word in others if not found.ours("further", f"three repeats: {word} does not tell{APART}")]


APART = " the levels apart"


def _list(values):
    return ", ".join(f"{x:.2g}" for x in values)


def _sizes(found, name, called):
    """Describe computed values of a reference: order compared with the printed one, growth, and deviation."""
    ours, printed = found.all(name), found.printed(name)
    off = " to ".join(f"{100 * (f(x / y for x, y in zip(ours, printed, strict=True)) - 1):+.0f}" for f in (min, max))
    grown = " instead of ".join(f"{100 * (values[-1] / values[0] - 1):.0f}" for values in (ours, printed))
    ordered = [y for _, y in sorted(zip(printed, ours, strict=True))] == sorted(ours)
    order = f"have the printed order, but grow by {grown} %" if ordered else "do not have the printed order"
    return f"{called} of {_list(ours)} m/s^2 {order}. They differ by {off} % from the printed sizes"


def helical_pitting(found):
    """Return the opening sentences for article S3."""
    placed = {row.case for one in load_scene("helical_pitting").references for row in one.rows if row.set_by}
    said = [row for row in found.rows.values() if row.id in ("statements", "further") and row.case not in placed]
    yes = sum(row.verdict == REPRODUCED for row in said)
    multi = found.ours("statements", "multi: 2 f_r is the largest low line")
    return (
        "pits raise lines at multiples of the pinion's shaft frequency f_r, and sidebands about the mesh frequency. The "
        "sidebands grow with the pit. Several pits are recognised by 2 f_r, and one large pit by f_r",
        f"under the article's own law {yes} of its {len(said)} statements hold. Statements that follow from the assumed "
        f"places of the pits are not counted. 2 f_r is {'' if multi else 'not '}the largest low line of the three pits",
        "S3 does not print the places of the pits. Pits on one tooth repeat once per revolution and contribute most at f_r in "
        "the lost contact line. Pits on two nearly opposite teeth contribute at 2 f_r",
    )


def herringbone_machine(found):
    """Return the opening sentences for the dynamics of article S4."""
    span = found.all("displacement_span")
    kurtosis, crest = (max(found.all(f"{name}_most")) for name in ("kurtosis", "crest"))
    wide = found.printed("displacement_span")
    most = [max(found.printed(f"{name}_most")) for name in ("kurtosis", "crest")]
    heavy = [a / b for a, b in zip(found.printed("inertias"), found.all("inertias"), strict=True)]
    order = [row.verdict == REPRODUCED for row in found.rows.values() if row.id == "statements" and row.case.endswith(HIGHER)]
    return (
        f"a crack and pits in the sun of a herringbone stage widen the sun's motion from {min(wide):g} to {max(wide):g} um. They "
        f"cause lines {found.ours('fault_frequency', 'N f_m / z_s'):g} Hz about the mesh line. The kurtosis increases (up to "
        f"{most[0]:.0f} %) more than the crest factor (up to {most[1]:.0f} %)",
        f"the lines appear, and {sum(order)} of {len(order)} statements on their order hold. The range along x is "
        f"{min(span):.3g} to {max(span):.3g} um, which the errors cause and damage hardly changes. The kurtosis increases by at "
        f"most {kurtosis:.2g} % and the crest factor by {crest:.2g} %. "
        "Stiffness tables: [herringbone.md](herringbone.md)",
        "the sizes of errors, supports and damping are not printed. Three planets in phase cancel in x. The printed inertias "
        f"are {min(heavy):.0f} to {max(heavy):.0f} times too large for such gears, so that the sun hardly rotates",
    )


HIGHER = ("sidebands lower than of the crack", "sidebands above crack or pits alone", "sidebands above case 2")


def compound_planetary(found):
    """Return the opening sentences for article S2."""
    beams, true = (
        found.ours(name, "s2_sun_planet", "sun_planet") / NEWTON_PER_UM for name in ("mean_stiffness", "converged_stiffness")
    )
    rings = [found.ours("stiffness_ratio", f"{name}_ring_planet") for name in ("s1", "s2")]
    heard, measured = found.all("kurtosis"), found.printed("kurtosis")
    means, lines = (found.printed(name) for name in ("mean_stiffness", "fault_frequencies"))
    low, high = (f(means) / NEWTON_PER_UM for f in (min, max))
    ratios = dict(zip(("b_c", "s1", "s2"), found.printed("stiffness_ratio"), strict=True))
    return (
        f"five mean stiffnesses are {low:.0f} to {high:.0f} N/um. Cracked sun teeth cause sidebands {lines[0]:g} and "
        f"{lines[1]:g} Hz about two mesh lines, found in measured signals by kurtosis and kurtogram",
        f"the frequencies and sidebands agree. The article's beams give {beams:.0f} N/um for sun and planet. Ring meshes are "
        f"{rings[0]:.2f} and {rings[1]:.2f} times as stiff instead of {ratios['s1']:.2f} and {ratios['s2']:.2f}. The converged "
        f"stiffness of the same gears is {true:.0f} N/um, {beams / true:.1f} times less. The kurtosis is {min(heard):.3g} to "
        f"{max(heard):.3g} instead of {min(measured):.3g} to {max(measured):.3g}",
        "the article omits the foundation under the teeth, and its table of parameters is lost. A broken tooth may be missing, "
        "as here, or a deep crack",
    )


OPENINGS = {one.__name__: one for one in (planetary_pitting, compound_planetary, helical_pitting, herringbone_machine)}

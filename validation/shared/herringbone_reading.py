# ruff: noqa: E501 lines of Markdown
"""The scene `herringbone_contact_line` compared with article S4's finite element column, and the opening of the page, from tables alone."""

import numpy as np

import gearfe as gf

from . import herringbone_contact_line as line
from .herringbone_contact_line import printed, reductions

PAGE = """
## The reading that gives its finite element column: scene `herringbone_contact_line`

- The list of 'maximum reduction rates' is `1 - k / k_healthy` of the *analytical* column, {rounding}.
- The finite element column has other reductions ({own}). Its values are therefore at one phase.
- S4 rotates the driving gear. At the same rotation, a damaged gear carries less than its share. This raises k / k_healthy to a power of {power}.
- The scene has bores of {sun:.2f} and {planet:.2f} of the root radius and a rim of 93 mm. A crack of p % has the level p / 2. Pits have a
  diameter of 1.26 mm.
- [herringbone_layouts.md](herringbone_layouts.md) describes the scan and observations that would falsify its result.
- The rotation is that of the healthy pair. The phase is that of the largest loss in case 4. Errors are relative to S4's finite element column.

| pair | case | S4 FE | `ritz3d` [N/um] | error | reduction, S4 FE | `ritz3d` | points | largest within 0.25 base pitches | `herringbone_article` | `herringbone_article`, k_h with summed widths | `fe3d`, error |
|---|---|---|---|---|---|---|---|---|---|---|---|
{ten}

The loss of case 4 exceeds nine tenths of its maximum over {plateau:.2f} base pitches. Losses by offset from the pitch point:

{spike}

Pits along the line cause such a plateau, and rows along the axis do not.

Finite elements of these ten rows: `python -m validation herringbone --reference`, {seconds:.0f} s of one processor.

{verdicts}
"""


def ten():
    """Rows of the table of the ten rows."""
    known, k, out = line.load(), line.ours("ritz3d")[0], []
    want, lost, own = printed(), reductions(k), reductions(printed())
    others = {name: line.ours(name)[0] for name in ("herringbone_article", "herringbone_article, summed")}
    solid = line.ours("fe3d")[0]
    places = iter(range(8))
    for i, (pair, case) in enumerate(line.rows()):
        cells = [f"{want[i]:.0f}", f"{k[i]:.0f}", f"{100 * (k[i] / want[i] - 1):+.1f} %"]
        if case == "healthy":
            cells += [""] * 4
        else:
            j = next(places)
            largest = 100 * (1 - known["ritz3d", pair, case] / known["ritz3d", pair, "healthy"]).max()
            cells += [f"{own[j]:.2f}", f"{lost[j]:.2f}", f"{lost[j] - own[j]:+.1f}", f"{largest:.2f}"]
        cells += [f"{100 * (one[i] / k[i] - 1):+.1f} %" for one in others.values()]
        cells.append(f"{100 * (solid[i] / want[i] - 1):+.1f} %")
        out.append(f"| {pair if case == 'healthy' else ''} | {case} | " + " | ".join(cells) + " |")
    return "\n".join(out)


def spike():
    """Case 4's loss by offset from the pitch point."""
    known = line.load()
    lost = 100 * (1 - known["ritz3d", "sun_planet", "case4"] / known["ritz3d", "sun_planet", "healthy"])
    rows = [["offset [base pitches]", *(f"{at:+g}" for at in line.OFFSETS)], ["loss [%]", *(f"{value:.1f}" for value in lost)]]
    head, body = (f"| {' | '.join(row)} |" for row in rows)
    return "\n".join([head, "|---" * len(rows[0]) + "|", body])


def plateau():
    """Over how many base pitches case 4 of sun and planet loses nine tenths of the most that it does."""
    known = line.load()
    lost = 1 - known["ritz3d", "sun_planet", "case4"] / known["ritz3d", "sun_planet", "healthy"]
    at = np.linspace(line.OFFSETS[0], line.OFFSETS[-1], 1001)
    above = at[np.interp(at, line.OFFSETS, lost) >= 0.9 * lost.max()]
    return float(np.ptp(above))


def rounding():
    """Count the reductions in S4's list that agree with its analytical column within rounding, in words."""
    k = np.array([row.target / 1e6 for row in _reference("stiffness_analytical").rows]).reshape(2, 5)
    half = 5.0  # N/um: S4 prints 0.01e9 N/m
    low, high = (100 * (1 - (k[:, 1:] + s * half) / (k[:, :1] - s * half)) for s in (1, -1))
    listed = np.array([row.value for row in _reference("stiffness_reduction").rows]).reshape(2, 4)
    beyond = np.maximum(low - listed, listed - high) - 0.005  # its list has two digits after the point
    outside = beyond[beyond > 0]
    return f"{beyond.size - outside.size} of {beyond.size} within rounding and {outside.size} up to {outside.max():.2f} points beyond it"


def _reference(name):
    return next(one for one in gf.load_scene("herringbone").references if one.id == name)


def worst(method):
    """Worst error [%] and worst reduction against its own column and against the list [points], of the scene by a method."""
    k, own = line.ours(method)[0], reductions(line.ours(method)[0])
    listed = np.array([row.value for row in _reference("stiffness_reduction").rows])
    apart = 100 * (k / printed() - 1), own - reductions(printed()), own - listed
    return [float(np.abs(one).max()) for one in apart]


def answer(bears, beyond):
    """Return the three sentences that the page opens with; `bears`: of the claim between formulas and finite elements."""
    (error, own, listed), (solid, points, beside) = worst("ritz3d"), worst("fe3d")
    return (
        "- S4's finite element column can be fitted with pits that touch each other along the contact line in both halves. "
        f"`fe3d` is then within {solid:.1f} % in all ten rows and {points:.1f} points of their reductions. `ritz3d` is within {error:.1f} % and "
        f"{own:.1f} points ({beside:.1f} and {listed:.1f} points for the list of the formulas).\n"
        "- This reading is a fit and no evidence. Five unprinted values and one of eight [layouts](herringbone_layouts.md) were chosen for ten numbers.\n"
        f"- {bears}\n"
        f"- In the scene with usual values, the article's formulas are beyond 3 % in {beyond} of ten rows."
    )


def section():
    """Lines of the page."""
    known, scene = line.stored(), gf.load_scene(line.SCENE).pairs["sun_planet"].pair
    powers = sorted(known["ritz3d", pair, "healthy"][1] for pair in ("sun_planet", "planet_ring"))
    own = reductions(printed())
    made = PAGE.format(
        own="; ".join(", ".join(f"{v:.2f}" for v in part) for part in (own[:4], own[4:])),
        power=" and ".join(f"{v:.2f}" for v in powers),
        sun=scene.gear_1.r_bore / scene.gear_1.r_f,
        planet=scene.gear_2.r_bore / scene.gear_2.r_f,
        ten=ten(),
        spike=spike(),
        plateau=plateau(),
        rounding=rounding(),
        seconds=sum(known[key][2] for key in known if key[0] == "fe3d"),
        verdicts="\n".join(line.verdicts("fe3d").splitlines()),
    )
    return made.strip().splitlines()

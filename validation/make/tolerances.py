"""A part of the page `detection`: how sure a crack is told from manufacturing scatter by stiffness and transmission error."""

import tempfile
from pathlib import Path

import numpy as np

import gearfe as gf

from ..shared.kept_rows import kept
from ..shared.places import PAGES
from ..shared.plots import plot_states

PICTURE = PAGES / "detection.png"
STATES = {"healthy": "healthy", "10 % crack": "ten", "30 % crack": "thirty"}
TOLERANCES = {
    "title": "cracks among manufacturing scatter",
    "scene": "planetary_pitting",
    "pair": "sun_planet",
    "seed": 3,
    "crack": [{"case": "ten", "gear": "sun", "level": 0.1}, {"case": "thirty", "gear": "sun", "level": 0.3}],
    "flank": {"sun": {"gear": "sun", "pair": "sun_planet"}, "planet": {"gear": "planet", "pair": "sun_planet"}},
    "options": {"method": "ritz", "phases": 32, "span": "tooth"},
    "vary": {"case": list(STATES.values())},
    "sample": {
        "method": "sobol",
        "count": 128,
        "of": {
            "gear.sun.x": {"normal": [-0.02, 0.005], "within": [-0.035, -0.005]},
            "gear.planet.x": {"normal": [-0.02, 0.005], "within": [-0.035, -0.005]},
            "flank.sun.slope_um": {"normal": [0.0, 3.0], "within": [-6.0, 6.0]},
            "flank.planet.slope_um": {"normal": [0.0, 3.0], "within": [-6.0, 6.0]},
            "gear.sun.r_bore_mm": {"uniform": [7.39, 7.41]},
            "gear.sun.b_mm": {"uniform": [19.9, 20.1]},
            "material.20CrMnTi.E_MPa": {"normal": [207e3, 2e3]},
            "pair.sun_planet.force_N": {"normal": [2000.0, 40.0]},
        },
    },
}
INDICES = TOLERANCES | {"case": "healthy", "vary": {}, "sample": TOLERANCES["sample"] | {"method": "saltelli", "count": 32}}


def scattered():
    """Bands and told-apart chances; draws the picture."""
    with tempfile.TemporaryDirectory() as name:
        runs = gf.sweep(TOLERANCES, Path(name) / "runs", workers=1)
        table = runs.table(where={"status": "done"})
        curves, means, out = {}, {}, {"cases": len(table), "states": {}}
        by_draw = {case: own.set_index("draw") for case, own in table.groupby("case")}
        # the same number of phases in all curves: the engagement's length varies little with the shifts
        for state, case in STATES.items():
            found = gf.curve_bands(runs, "k", where={"case": case})
            curves[state] = (found["phase"].to_numpy(), found["k"].to_numpy() / 1e6)
            means[state] = by_draw[case]["k_mean"].to_numpy() / 1e6
        rng = np.random.default_rng(1)
        healthy = by_draw["healthy"]
        for state, case in STATES.items():
            own = by_draw[case]
            loss = 1 - own["k_mean"] / healthy["k_mean"].reindex(own.index)
            row = {"mean": float(own["k_mean"].mean()), "spread": float(own["k_mean"].std() / own["k_mean"].mean())}
            row |= {"loss": float(loss.mean()), "loss_spread": float(loss.std())}
            row |= {name: gf.told_apart(healthy[name], own[name]) for name in ("k_mean", "k_min", "te_peak_to_peak")}
            for noise in (0.001, 0.003, 0.01):  # of each of two measurements of one machine
                quiet, hurt = (rng.normal(0, noise * 2**0.5, (200, len(own))) for _ in range(2))
                row[f"own {noise}"] = gf.told_apart(quiet.ravel(), (loss.to_numpy() + hurt).ravel())
            out["states"][state] = row
        plot_states(curves, means, PICTURE, labels=("mesh phase", "k [N/um]", "mean k [N/um]"))
        indices = gf.sweep(INDICES, Path(name) / "indices", workers=1)
        found = gf.sobol_indices(indices, "k_mean")
        out["indices"] = {key: [float(v) for v in row] for key, row in zip(found.index, found.to_numpy(), strict=True)}
        out["indices_cases"] = len(indices)
    return out


def section(again=False):
    """Lines of the page."""
    found = kept("detection", "tolerances", scattered, again)
    states = found["states"]
    noises = (0.001, 0.003, 0.01)
    lines = [
        "## By stiffness and transmission error, among manufacturing scatter",
        "",
        f"{found['cases']} cases: {found['cases'] // 3} draws of a sun-planet pair within tolerances, each healthy, with a",
        "crack of level",
        "0.1 and of 0.3 (of the tooth's thickness; 0.5 reaches the centre-line) in the sun. What is drawn, independently:",
        "profile",
        "shifts of both gears (standard deviation 0.005 modules, that is 10 um), profile slopes of both (3 um, cut at 6 um),",
        "bore",
        "and face width of the sun (+- 0.01 mm, +- 0.1 mm), the modulus of the sun's steel (1 %), the load (2 %). They are",
        "assumptions of a usual quality, not measured on a lot. `ritz`, 32 phases, the engagement of the damaged tooth.",
        "",
        f"![bands of stiffness and histograms of its mean]({PICTURE.name})",
        "",
        "*Bands hold nine of ten machines.* Chance that a cracked machine drawn at random has the lower stiffness (the larger",
        "transmission error) than a healthy one drawn at random; 50 % is a coin:",
        "",
        "| state | mean k | scatter | loss of mean k by the crack | by mean k | by least k | by te peak-to-peak |",
        "|---|---|---|---|---|---|---|",
    ]
    for state, row in states.items():
        loss = "" if state == "healthy" else f"{100 * row['loss']:.2f} +- {100 * row['loss_spread']:.2f} %"
        chances = (1 - row["k_mean"], 1 - row["k_min"], row["te_peak_to_peak"])
        told = " | ".join("" if state == "healthy" else f"{100 * one:.0f} %" for one in chances)
        lines.append(f"| {state} | {row['mean'] / 1e6:.1f} N/um | {100 * row['spread']:.1f} % | {loss} | {told} |")
    lines += [
        "",
        "With a record of the same machine when it was healthy, scatter of manufacture falls out, and what is left is that of",
        "two measurements, each with an independent normal error of mean k:",
        "",
        "| state | " + " | ".join(f"error {100 * noise:g} %" for noise in noises) + " |",
        "|---" * (1 + len(noises)) + "|",
        *(
            f"| {state} | " + " | ".join(f"{100 * row[f'own {noise}']:.1f} %" for noise in noises) + " |"
            for state, row in states.items()
            if state != "healthy"
        ),
        "",
        f"Where the scatter of the healthy pair's mean k comes from: Sobol indices of {found['indices_cases']} further cases",
        "(first",
        "order, 95 % interval by bootstrap; total). Indices of so small a sample are rough: intervals that reach below zero say",
        "no more than 'small'.",
        "",
        "| drawn | first order | 95 % | total | 95 % |",
        "|---|---|---|---|---|",
    ]
    for name, (first, low, high, total, bottom, top) in sorted(found["indices"].items(), key=lambda item: -item[1][3]):
        lines.append(f"| `{name}` | {first:.2f} | {low:.2f} to {high:.2f} | {total:.2f} | {bottom:.2f} to {top:.2f} |")
    return lines

"""Mesh stiffness in a planetary set in words and as a table, and the positions of the sun."""

import math

import numpy as np

from ..core.checks import whole
from ..core.table import Column, Table, stiffness_column
from ..core.units import NEWTON_PER_UM, in_newton_per_um
from ..geometry.aliases import Floats
from ..geometry.damage.kinds import told
from ..planetary_sets.added import added_compliance
from ..planetary_sets.case import PlanetaryCase
from ..planetary_sets.curves import SetCurves
from ..planetary_sets.faults import first_pass
from ..planetary_sets.rim_supports import RimBed, RimSupports
from ..planetary_sets.set_file import MESHES
from ..scene.load import Scene
from ..stiffness.curve import StiffnessCurve

COLUMNS = (
    "mesh",
    Column("planet", form="{}"),
    *(stiffness_column(name) for name in ("k mean", "least", "largest", "alone")),
    Column("error of k in the set", "%", "{:.1f}"),
    Column("difference", "%", "{:+.1f}"),
    *(Column(f"load, {name}", "N") for name in ("least", "largest")),
)

MOST = 10_000  # largest number of positions, and of cycles
ENGAGED = 2  # duration of the engagement of a tooth [mesh cycles]


def spread(case: PlanetaryCase, count: int, cycles: int | None = None) -> Floats:
    """Positions of the sun [pitches], evenly spread over `cycles` mesh cycles.

    More than `count` are used to avoid repeated phases. Default: one mesh cycle. Damaged sets have the two cycles in which the
    first damaged tooth passes a mesh. A ring on pads has one pad pitch.
    """
    for name, value in (("positions", count), ("cycles", 1 if cycles is None else cycles)):
        if whole(name, value, 1) > MOST:
            raise ValueError(f"{name} = {value}, but give at most {MOST}")
    pads = case.ring.count if isinstance(case.ring, RimSupports) else case.gears.ring.z
    span = cycles or (ENGAGED if case.damage else max(1, round(case.gears.ring.z / pads)))
    while math.gcd(count, span) > 1:
        count += 1
    return first_pass(case) + span * np.arange(count) / count


def set_numbers(curves: SetCurves) -> dict[str, float]:
    """Return mean stiffness of both kinds of mesh in the set and isolated [N/m], K_gamma, peak-to-peak transmission error [m].

    Means are over planets and positions. Those of k omit meshes without load.
    """
    out: dict[str, float] = {}
    for k, kind in enumerate(MESHES):
        name = kind.replace("-", "_")
        out |= {f"k_{name}": _mean(curves.k[k]), f"k_{name}_alone": float(curves.k_alone[k].mean())}
    return out | {"K_gamma": curves.K_gamma, "te_peak_to_peak": float(np.ptp(curves.te))}


def set_headline(curves: SetCurves, healthy: SetCurves | None = None) -> str:
    """State the result of a set in one sentence. A damaged set is compared with the `healthy` one at the same positions."""
    found, said = set_numbers(curves), []
    for kind in MESHES:
        inside, alone = found[f"k_{kind.replace('-', '_')}"], found[f"k_{kind.replace('-', '_')}_alone"]
        change = f"{100 * (inside / alone - 1):+.1f} %"
        said.append(
            f"k of {kind.replace('-', ' and ')} {in_newton_per_um(inside)} N/um, alone {in_newton_per_um(alone)} ({change})"
        )
    text = f"In the set {', '.join(said)}; K_gamma {found['K_gamma']:.3f}, transmission error {_um(curves)} um peak to peak"
    if "error" in curves.meta:
        text += f", its estimated error {100 * curves.meta['error']['te']:.1f} % of the mean"
    return text if healthy is None else f"{text}; {_taken(curves, healthy)}"


def set_table(curves: SetCurves) -> Table:
    """Return a `Table` of the meshes of a set: stiffness in the set and as isolated pair, estimated error, and load."""
    rows, error = [], curves.meta.get("error", {"k": np.full((2, curves.force.shape[2]), np.nan)})["k"]
    for k, kind in enumerate(MESHES):
        for planet in range(curves.force.shape[2]):
            inside, alone, load = (one[k, :, planet] for one in (curves.k, curves.k_alone, curves.force))
            numbers = [value / NEWTON_PER_UM for value in (_mean(inside), inside.min(), inside.max(), alone.mean())]
            change = 100 * error[k, planet], 100 * (numbers[0] / numbers[3] - 1)
            rows.append([kind, planet + 1, *numbers, *change, load.min(), load.max()])
    return Table(COLUMNS, rows)


def told_span(positions: Floats) -> str:
    """Describe the positions over which the values of a table are averaged."""
    cycles = round(positions.size * (positions[1] - positions[0])) if positions.size > 1 else 1
    start = f" from position {positions[0]:.4g} on" if positions[0] else ""
    return f"over {positions.size} positions in {'a mesh cycle' if cycles == 1 else f'{cycles} mesh cycles'}{start}"


def told_set(case: PlanetaryCase) -> str:
    """Return a description of a planetary set: planets, load, supports, and damage by tooth."""
    places = ", ".join(f"{one:.4g}" for one in np.degrees(case.planet_angles).tolist())
    pin = "" if np.isinf(case.pin) else f", pins of {case.pin / 1e3:g} N/um"
    off = sum(1 for one in case.errors if any(one))
    errors = f", {off} of {case.planets} off their places" if off else ""
    gear, hurt = case.gear_of, [(name, one) for name, own in case.damage.items() for one in own]
    sun = "floating" if case.floating else "held at its axis"
    return (
        f"{case.planets} planets at {places} degrees{pin}{errors}; {case.force:g} N a mesh on average, "
        f"{case.force * case.planets * case.gears.sun.r_b * 1e-3:.4g} N m on the sun; sun {sun}, ring {_ring(case.ring)}"
        + "".join(f"; tooth {one.tooth} of {name}: {told({name: gear(name)}, {name: [one]})}" for name, one in hurt)
    )


def told_in_set(scene: Scene, pair: str, curve: StiffnessCurve) -> str:
    """Return the mean stiffness of a pair in the set of its scene and as an isolated pair, in words.

    The result is empty without a set.
    """
    if scene.set is None or pair not in scene.set.pairs or (added := added_compliance(scene)) is None:
        return ""
    kind = scene.set.pairs.index(pair)
    inside, alone = curve.with_compliance(added.added[kind].mean()).k.mean(), curve.k.mean()
    return (
        f"in the whole set {in_newton_per_um(inside)} N/um on average, isolated pair {in_newton_per_um(alone)} N/um "
        f"({100 * (inside / alone - 1):+.1f} % in the set); `gearfe planetary` prints every mesh of the set"
    )


def _ring(support: "str | RimBed | RimSupports") -> str:
    if isinstance(support, RimBed):
        return f"on an elastic bed of {support.radial:g} (radial) and {support.tangential:g} MPa/mm (tangential)"
    if not isinstance(support, RimSupports):
        return "held all around"
    kind = "lugs, which only push," if support.pushes else "pads"
    soft = {way: getattr(support, way) / 1e3 for way in ("radial", "tangential") if np.isfinite(getattr(support, way))}
    springs = "".join(f", {way} {value:g} N/um" for way, value in soft.items() if value or not support.pushes)
    return f"on {support.count} {kind} of {support.width:g} mm{springs}"


def _taken(curves, healthy):
    """Return the largest loss of stiffness by damage, and the mesh and position of this loss, in words."""
    with np.errstate(divide="ignore", invalid="ignore"):
        loss = np.where((curves.k > 0) & (healthy.k > 0), 1 - curves.k / healthy.k, -np.inf)
    k, at, planet = np.unravel_index(int(loss.argmax()), loss.shape)
    most, kind = 100 * loss[k, at, planet], MESHES[int(k)].replace("-", " and ")
    idle = int(((curves.k == 0) & (healthy.k > 0)).any(axis=(0, 2)).sum())
    text = f"the damage reduces k by up to {most:z.1f} % in the mesh of {kind}, planet {planet + 1}"
    return f"{text}; at {idle} of {loss.shape[1]} positions a mesh carries no load" if idle else text


def _mean(k: Floats) -> float:
    """Return the mean stiffness over all meshes and positions that carry load."""
    return float(k[k > 0].mean()) if (k > 0).any() else 0.0


def _um(curves):
    return f"{np.ptp(curves.te) * 1e6:.3g}"

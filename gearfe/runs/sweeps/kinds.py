"""Types of study. Each is a row of `KINDS` with options, columns and a function that computes one case."""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache
from typing import Any, NamedTuple, cast

import numpy as np

from ...comparison.settled import recorded
from ...comparison.told_set import set_numbers, spread
from ...core.case import Case
from ...dynamics.machine.of_scene import build_machine
from ...dynamics.motion.step_control import default_step
from ...flexibility.solved import SolvedGears
from ...planetary_sets.of_scene import build_set
from ...planetary_sets.solve import planetary_stiffness
from ...scene.load import Scene
from ...signal.series import Signal
from ...stiffness.curve import StiffnessCurve
from ...stiffness.solve import Solve, solve
from ...strength.crack_model import CrackModel
from ...strength.growth import grow_crack, single_crack
from ...strength.paris import ParisLaw

KEPT = SolvedGears(64 * 2**20)  # solved gears of earlier cases in this process
HARMONICS = 3
INDICATORS = ("crest factor", "kurtosis", "shape factor", "impulse factor", "sideband index")


class Kind(NamedTuple):
    """A kind of study.

    `options` is their table in ``gearfe/runs/keys.toml``. `work` is called with a `Case` and the options, and gives a row for
    each of its loads, with the columns of ``gearfe/runs/columns.toml``. `block` is the number of cases in a shard. If `whole`
    is true, the study needs all pairs of the scene. Then `work` is called with the scene, its case of damage (None: healthy)
    and the options.
    """

    options: str
    work: Callable[..., list[dict[str, Any]]]
    block: int
    whole: bool = False


def curves_of(case: Case, options: dict[str, Any]) -> list[StiffnessCurve]:
    """Return stiffness curves of a case by load. Equal gears are solved once per process."""
    span = options["span"] or ("tooth" if case.damaged else "cycle")
    return cast(list[StiffnessCurve], solve(case, Solve(**options | {"span": span, "cache": KEPT})))


def stiffness(case: Case, options: dict[str, Any]) -> list[dict[str, Any]]:
    """Return rows of stiffness curves by load: zones, phase, k, and on request the largest relative error estimate."""
    return [_stiffness_row(curve) for curve in curves_of(case, options)]


def _stiffness_row(curve):
    zones, te = curve.zones(), curve.te
    row = {"k_mean": zones["mean"], "k_max": zones["max"], "k_min": float(curve.k.min())}
    row |= {f"k_{name}": zones.get(name) for name in ("single", "double")}
    row |= {"k_error": curve.zone_errors().get("mean"), "te_peak_to_peak": float(np.ptp(te))}
    return row | {"phase": curve.phase, "k": curve.k}


def transmission_error(case: Case, options: dict[str, Any]) -> list[dict[str, Any]]:
    """Return rows of loaded transmission errors by load: mean, peak-to-peak, mesh harmonics, phase and te."""
    whole = not case.damaged and options["span"] in (None, "cycle")
    return [_te_row(curve, whole) for curve in curves_of(case, options)]


def _te_row(curve, whole):
    te = curve.te
    row = {"te_mean": float(te.mean()), "te_peak_to_peak": float(np.ptp(te)), "k_mean": float(curve.k.mean())}
    if whole:
        lines = 2 / te.size * np.abs(np.fft.rfft(te))[1 : HARMONICS + 1]
        row |= {f"te_{i + 1}": float(value) for i, value in enumerate(lines)}
    return row | {"phase": curve.phase, "te": te}


def growth(case: Case, options: dict[str, Any]) -> list[dict[str, Any]]:
    """Return rows of crack growth by load: outcome, final length and revolutions. All growth laws share one path.

    Raises
    ------
    ValueError
        If the case has no single crack.
    """
    found = single_crack(case)
    if found is None:
        raise ValueError("crack growth starts from one crack: choose a case with a single crack")
    constants = {name: options[name] for name in ("C", "m", "threshold", "gamma")}
    law = ParisLaw(**constants, K_Ic=math.inf if options["K_Ic"] is None else options["K_Ic"])
    steps = tuple((name, options[key]) for name, key in (("step", "step_mm"), ("steps", "steps"), ("refine", "refine")))
    paths = [_path(replace(case, force=force), *found, CrackModel(options["method"]), steps) for force in case.forces]
    return [_growth_row(path.under(law)) for path in paths]


@lru_cache(maxsize=16)
def _path(case, side, crack, model, options):
    return grow_crack(case, crack, side, model=model, **dict(options))


def _growth_row(found):
    row = {"outcome": found.outcome, "revolutions": float(found.cycles[-1]), "length": float(found.length[-1])}
    return row | {"K_I_max": float(found.K_I.max())}


def vibration(scene: Scene, case: str | None, options: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the row of a machine's vibration: indicators of a channel (default: driven mesh force), on request the signal.

    Method and resolution of the curves are the same for all cases only if ``curves`` names a method: ``"auto"`` selects three
    dimensions for pits.
    """
    machine = build_machine(scene, case, phases=options["phases"], method=options["curves"])
    duration = options["duration_s"]
    rate = options["rate_Hz"] or math.ceil(duration / default_step(machine)) / duration
    response = recorded(machine, duration, rate, method=options["method"])
    stage, fault, _ = machine.fault_frequencies()
    mesh = next(candidate for candidate in machine.meshes if abs(abs(candidate.frequency) / stage.mesh - 1) < 1e-6)
    channel = options["channel"] or f"force {mesh.name}"
    signal = Signal(np.asarray(response[channel], dtype=float), rate, response.unit(channel), name=channel)
    seen = signal.indicators(*((stage.mesh, fault) if fault else (None, None)))
    row: dict[str, Any] = {name.replace(" ", "_"): seen.get(name) for name in INDICATORS}
    row |= {"rms": seen["rms"], "peak": seen["peak"], "mesh_line": seen.get("mesh line"), "unit": signal.unit}
    row |= {"mesh_Hz": stage.mesh, "fault_Hz": fault, "rate": rate, "free": response.stats["free"]}
    return [row | ({"signal": signal.values} if options["signal"] else {})]


def planetary_set(scene: Scene, case: str | None, options: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the row of a planetary set: mean stiffness of both meshes in the set and isolated, K_gamma, transmission error."""
    made = build_set(scene, case)
    at = spread(made, options["positions"], options["cycles"])
    return [set_numbers(planetary_stiffness(made, at, refine=options["refine"], error=False, cache=KEPT))]


KINDS = {
    "stiffness": Kind("stiffness", stiffness, 32),
    "transmission error": Kind("stiffness", transmission_error, 32),
    "growth": Kind("growth", growth, 32),
    "set": Kind("planetary_set", planetary_set, 4, whole=True),
    "vibration": Kind("vibration", vibration, 4, whole=True),
}

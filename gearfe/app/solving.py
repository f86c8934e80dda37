"""Tasks of a solver process: curves with and without damage, geometry, stress, spectrum, files for download."""

import base64
import json
import math
import os
import tempfile
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np

from ..comparison.compare import beside_health
from ..comparison.comparison import Comparison
from ..core.threads import own_warnings
from ..core.units import NEWTON_PER_UM
from ..figures.pair_plot import NEAR
from ..figures.stiffness_plots import closed
from ..flexibility.solved import PROCESS
from ..geometry.checks import shown
from ..geometry.tooth.drawing import outline_points
from ..geometry.tooth.profile import turned
from ..scene.assumed import of_stiffness
from ..scene.load import Scene, scene_names, scene_of
from ..scene.toml_file import toml
from ..stiffness.methods import fitted
from ..stiffness.solve import Solve
from .damage import CASE, first_rows, through
from .fields import START
from .grown import grown_tables
from .program import program
from .state import SeveralError, read, tables_of, title_of

QUICK, FINE, SOLID = 32, 64, 16  # phases per mesh cycle
KEPT = 128 * 2**20  # memory of solved gears in one process [bytes]
# quantities that a transverse section does not vary along the width
ALONG = {"lead_1": 0.0, "lead_2": 0.0, "F_beta_x": 0.0, "tilt_1": 0.0, "tilt_2": 0.0}
STRESS = (1000, 750)  # picture [px]
SECONDS = 0.5  # duration of the vibration record [s]
SHOWN = 1500  # most points of a plotted spectrum
UM = 1e6  # m to um


def scene_from(state: dict[str, Any]) -> Scene:
    """Return the scene of a checked state."""
    return scene_of("page", _tables(state))


def _tables(state):
    """Return the tables of the scene of a state, with the grown crack."""
    tables = tables_of(state)
    return grown_tables(tables, state["crack_grown"]) if state["crack_grown"] and state["damage"] else tables


def compared(scene: Scene, method: str, phases: int, *, error: bool) -> tuple[Comparison, tuple[str, ...]]:
    """Return the curves of a scene's pair with and without damage by one method, and the neglected parts of the case."""
    chosen = scene.pair()
    case, _, left_out = fitted(method, chosen.case(CASE if chosen.damage else None))
    return beside_health(case, Solve(method, phases, error=error)), left_out


def quick(state: dict[str, Any]) -> dict[str, Any]:
    """Return the result while a slider moves: the section, without error estimates."""
    return _answer(state, "ritz", QUICK, error=False)


def fine(state: dict[str, Any]) -> dict[str, Any]:
    """Return the result for a slider at rest, with estimated errors."""
    return _answer(state, "ritz", FINE, error=True)


def solid(state: dict[str, Any]) -> dict[str, Any]:
    """Return the three-dimensional result: helical teeth, pits, changes along the width."""
    return _answer(state, "ritz3d", SOLID, error=False)


def _answer(state, method, phases, *, error):
    with own_warnings() as caught:
        scene, left_out = scene_from(state), ()
        if method == "ritz" and _wide(state):
            scene = scene_from(state | ALONG | {"damage": list(filter(through, state["damage"]))})
            left_out = (
                "pits, spalls, cracks and chips of a part of the width, crowning along it, misalignment and tilting supports "
                "are not in this section: solve in three dimensions",
            )
        comparison, further = compared(scene, method, phases, error=error)
    curve, alone, cycle = comparison.reference, bool(left_out or further), comparison.first_tooth()[1]
    return {
        "headline": "Transverse section alone: " * alone + comparison.headline,
        "named": f"{title_of(state)}; {state['force']:g} N in the line of action, {state['b_1']:g} and {state['b_2']:g} mm wide",
        "definition": comparison.definition, "middle": 0.5 if cycle is None else float(cycle.mean()),
        "method": f"{method}: {phases} phases in a mesh cycle{_estimated(method, error)}",
        "section": alone,
        "tables": [[one.first_tooth()[0], (one.loss_table() or one.table()).cells()] for one in comparison.by_tooth()],
        "curves": [*(_curve("healthy", entry) for entry in comparison.healthy.values()),
                   _curve(comparison.kind or "healthy", curve)],
        "share": {"phase": _numbers(curve.phase), "order": [int(entry) for entry in curve.order],
                  "value": [_numbers(entry) for entry in np.where(curve.force > 0, curve.share, np.nan).T]},
        "picture": picture(whole := scene_from(state)), "first": first_rows(whole.pair().pair, state["force"]),
        "notes": [*left_out, *further, *dict.fromkeys(str(entry.message) for entry in caught), *scene.pair().pair.notes],
        "assumed": [entry["what"] for entry in of_stiffness(scene.assumptions)]
        + [f"changed: {entry}" for entry in scene.changed],
    }  # fmt: skip


def _estimated(method, error):
    """Return whether the errors of a curve are estimated, in words."""
    return ", with estimated errors" if error else ", a first picture without estimates" if method == "ritz" else ""


def _wide(state):
    """Return True if something changes along the width, so that a section is not sufficient."""
    return any(state[name] != plain for name, plain in ALONG.items()) or not all(map(through, state["damage"]))


def _numbers(values):
    """Return finite numbers unchanged, others as null."""
    return [value if math.isfinite(value) else None for value in np.asarray(values, dtype=float).tolist()]


def _curve(name, curve):
    phase, k = closed(curve)
    error = [] if curve.error is None else _numbers(curve.error / NEWTON_PER_UM)
    return {"name": name, "phase": _numbers(phase), "k": _numbers(k), "at": _numbers(curve.phase), "solved": _numbers(curve.k),
            "error": error, "te": _numbers(curve.te * UM)}  # fmt: skip


def picture(scene: Scene) -> dict[str, Any]:
    """Return the geometry of the teeth in mesh [mm, rad]: outlines, rotations at phase 0 and per phase, damage."""
    chosen = scene.pair()
    pair, gears = chosen.pair, []
    starts, later = (pair.turn(pair.path[0] + at * pair.p_bt) for at in (0.0, 0.01))
    for i, gear in enumerate(pair.gears):
        points = outline_points(gear, points=9)
        step = (float(later[i] - starts[i]) + math.pi) % (2 * math.pi) - math.pi
        damages = [one for case in chosen.damage.values() for one in case.get(("pinion", "wheel")[i], [])]
        ahead = (1, -1)[i] * 2 * math.pi / gear.z  # clockwise angle from a tooth to that of the next tooth pair [rad]
        lines = [turned(one.outline(gear), ahead * one.tooth).T.round(5).tolist() for one in damages]
        words = [f"{one._nouns[0]} (tooth {one.tooth})" for one in damages]
        hurt = [{"kind": kind, "line": line} for kind, line in zip(words, lines, strict=True)]
        gears.append({
            "z": gear.z, "tooth": points[:, : points.shape[1] // gear.z].T.round(5).tolist(), "held": gear.held,
            "mirror": (1, pair.outward)[i], "turn": float(starts[i]), "rate": step / 0.01, "damage": hurt,
            "centre": (0.0, pair.centre_2)[i],
        })  # fmt: skip
    return {
        "gears": gears, "pitch": pair.pitch_radius_1, "half": NEAR * pair.gear_1.m_n, "alpha": pair.alpha_wt,
        "path": [one - pair.gear_1.r_b * math.tan(pair.alpha_wt) for one in pair.path], "p_bt": pair.p_bt, "r_b": pair.gear_1.r_b,
        "told": f"centre distance {pair.a:.5g} mm, contact ratio {pair.eps_alpha:.3f}"
        + (f", overlap ratio {pair.eps_beta:.3f}" if pair.eps_beta else ""),
    }  # fmt: skip


def stress(state: dict[str, Any]) -> dict[str, Any]:
    """Return a picture of the von Mises stress (PNG)."""
    from ..strength.render import render_stress

    scene = scene_from(state)
    case = scene.case(case=CASE if scene.pair().damage else None)
    with own_warnings() as caught, tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "stress.png"
        facts = render_stress(case, file, size=STRESS, refine=0.7, title=scene.title)
        data = base64.b64encode(file.read_bytes()).decode()
    text = f"{facts['text']}; largest von Mises stress on the fillets {facts['root']:.0f} MPa"
    return {"png": data, "text": " ".join(text.splitlines()), "notes": [str(warning.message) for warning in caught]}


def spectrum(state: dict[str, Any]) -> dict[str, Any]:
    """Return the spectra of the mesh force, healthy and damaged, with the expected lines."""
    from ..comparison.machine_vibration import analysis
    from ..comparison.simulated import responses
    from ..comparison.vibration import in_words

    if not state["speed"]:
        raise ValueError("speed of the pinion = 0 rpm, but a vibration needs a speed: enter it under Load")
    with own_warnings() as caught:
        scene = scene_from(state)
        analysed = analysis(responses(scene, CASE if scene.pair().damage else None, duration=SECONDS))
    last = 1.15 * max(analysed.lines.values(), default=math.inf)
    spectra = []
    for name, one in analysed.spectra.items():
        rows = slice(1, min(int(np.searchsorted(one.frequency, last)) + 1, SHOWN))
        spectra.append({"name": name, "f": _numbers(one.frequency[rows]), "value": _numbers(one.values[rows])})
    lines = [{"name": name, "f": value} for name, value in analysed.lines.items() if name in analysed.standing()]
    named = ", ".join(f"{in_words(line['name'])} {line['f']:.1f} Hz" for line in lines)
    text = f"{SECONDS:g} s of vibration; lines that stand out: {named or 'none'}"
    title = f"{analysed.channel} [{analysed.unit}]"
    return {"title": title, "text": text, "spectra": spectra, "lines": lines, "notes": [str(one.message) for one in caught]}


def load(given: dict[str, Any]) -> dict[str, Any]:
    """State of the page for the text of a scene or the name of a built-in one. Several pairs or cases are returned as choices."""
    name, text = str(given.get("name")), given.get("text")
    if text is None and name in scene_names():
        text = (resources.files("gearfe.scene.scenes") / f"{name}.toml").read_text(encoding="utf-8")
    if not isinstance(text, str):
        raise ValueError(
            f"no scene {shown(name)}: give the text of a scene or the name of a built-in scene: {', '.join(scene_names())}"
        )
    chosen = {key: given.get(key) for key in ("pair", "case")}
    if not all(isinstance(choice, str | None) for choice in chosen.values()):
        raise ValueError(f"pair and case = {shown(chosen)}, but give the names of a pair and a case")
    try:
        state, notes = read(name, text, **chosen)
    except SeveralError as error:
        return {"refused": str(error), "choices": error.choices}
    return {"state": state, "notes": notes}


def as_toml(state: dict[str, Any]) -> dict[str, Any]:
    """Return the scene as a file."""
    return {"file": "scene.toml", "kind": "application/toml", "text": toml(_tables(state))}


def as_python(state: dict[str, Any]) -> dict[str, Any]:
    """Return the program that prints the numbers of the page."""
    return {"file": "gear.py", "kind": "text/x-python", "text": program(scene_from(state))}


def as_csv(state: dict[str, Any]) -> dict[str, Any]:
    """Return the curve, healthy or damaged, in the format of `StiffnessCurve.to_csv`."""
    scene = scene_from(state)
    method = "ritz3d" if _wide(state) or state["beta"] else "ritz"
    with own_warnings(), tempfile.TemporaryDirectory() as folder:
        comparison, _ = compared(scene, method, SOLID if method == "ritz3d" else FINE, error=method == "ritz")
        file = Path(folder) / "curve.csv"
        comparison.reference.to_csv(file)
        return {"file": "curve.csv", "kind": "text/csv", "text": file.read_text(encoding="utf-8")}


def report(state: dict[str, Any]) -> dict[str, Any]:
    """Return the page of `gearfe report`."""
    from ..reports.page import report as made

    with own_warnings(), tempfile.TemporaryDirectory() as folder:
        file = made(scene_from(state), Path(folder) / "report.html", phases=QUICK)
        return {"file": "report.html", "kind": "text/html", "text": file.read_text(encoding="utf-8")}


TASKS = {
    "quick": quick, "fine": fine, "solid": solid, "stress": stress, "spectrum": spectrum, "load": load, "toml": as_toml,
    "python": as_python, "csv": as_csv, "report": report,
}  # fmt: skip


def begin() -> None:
    """Prepare a new solver process: a small memory for solved gears and no disk cache.

    One pair is solved to import the modules that methods import only when they are used.
    """
    PROCESS.most = KEPT
    os.environ["GEARFE_CACHE"] = ""  # do not store the many intermediate gears of a moving slider
    answer("quick", START)


def answer(kind: str, given: dict[str, Any]) -> bytes:
    """Return the result of a task, or an error message, as JSON."""
    try:
        return json.dumps(TASKS[kind](given), allow_nan=False).encode()
    except (ValueError, RuntimeError) as error:
        return json.dumps({"refused": str(error).removeprefix("page ")}).encode()
    except MemoryError as error:
        return json.dumps({"refused": f"not enough memory{f': {error}' if str(error) else ''}; take a smaller case"}).encode()

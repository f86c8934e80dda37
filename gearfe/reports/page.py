"""`report`: a self-contained page of a scene."""

import itertools
import math
import time
from dataclasses import replace
from functools import partial
from importlib import resources
from pathlib import Path

from ..comparison.harris import harris
from ..comparison.pattern import render_pattern
from ..comparison.told_scene import told_details, told_load, told_supports
from ..core.steps import part
from ..core.table import Column, Table
from ..figures.error_plots import plot_transmission_error
from ..geometry.aliases import StrPath
from ..scene.load import Scene, scene_names
from ..stiffness.methods import METHODS
from ..stiffness.provenance import versions
from ..stiffness.solve import Solve
from ..strength.fields import rounded_up
from ..strength.holed import root_error
from ..strength.render import render_pressed, render_stress, shows_tooth
from ..strength.stress_parts import enlarged
from . import figures
from .crack_growth import growth_section
from .figures import part_of_page
from .findings import find
from .template import page_maker, picture_data
from .whole_set import set_section

MARK = 10.0  # Larger errors are emphasised [%].
PICTURE = (1120, 840)  # size of a picture of stress [px]
LOADS = (0.25, 0.5, 1.0, 1.5)  # loads of a Harris map relative to the load of the pair


def report(
    scene: Scene | StrPath,
    path: StrPath,
    case: str | None = None,
    *,
    duration: float | None = None,
    phases: int = 64,
) -> Path:
    """Write a self-contained HTML report: assumptions, errors, curves, load sharing, stress, vibration, methods.

    Parameters
    ----------
    scene : Scene, str or path
        Result of `gearfe.load_scene`, or a name or file of a scene.
    path : path
        A ``.html`` file.
    case : str, optional
        Case of damage, compared with healthy; default the first of the scene.
    duration : float, optional
        Record length of the vibration of the scene's machine [s]; 0 omits the machine. Default: 0.2, of gearboxes 1 to 5, which
        resolves the sidebands of the damage.
    phases : int
        Number of phases per mesh cycle of the stiffness curves.

    Raises
    ------
    ValueError
        If the page could not be written, or there is no such scene or case.
    RuntimeError
        If plotly or jinja2 is missing; the message has the command that installs them.
    """
    write = page_maker(path, "page.html")
    started = time.perf_counter()
    with part("", 0.0, 0.85):
        found = find(scene, case, duration=duration, phases=phases)
    with part("stress pictures", 0.85, 1.0):
        drawing = time.perf_counter()
        pictures, contacts = _pictures(found), _contacts(found)
        sets, growth = set_section(found.sets), growth_section(found)
        found.seconds["stress pictures"] = time.perf_counter() - drawing
    cost = [*found.seconds.items(), ("all", time.perf_counter() - started)]
    return write(
        found=found, scene=found.scene, case=found.case, command=_command(found), pictures=pictures, contacts=contacts,
        sets=sets, growth=growth, gears=_gears, tooth=_tooth(found), methods=_methods(found), assumed=_assumed(found.scene),
        version=versions()["gearfe"],
        cost=Table(("part", Column("time", "s", "{:.1f}")), cost, "What it cost"), total=cost[-1][1],
        libraries=Table(("library", "version"), list(versions().items()), "Versions"), mark=MARK,
        draw=_numbered(), figures=figures, told=lambda pair: [told_load(pair), *told_details(pair), *pair.pair.notes],
        supports=told_supports, turning=(resources.files("gearfe.reports") / "page.js").read_text(encoding="utf-8"),
    )  # fmt: skip


def _numbered():
    """Return a function that converts figures to HTML elements named ``figure-1``, ``figure-2``, ..."""
    numbers = itertools.count(1)
    return lambda figure: part_of_page(figure, f"figure-{next(numbers)}")


def _pictures(found):
    """Return pictures of stress, healthy and damaged, at one phase and scale. Without a renderer, return the missing package."""
    name = found.hurt_pair
    chosen, out, same = found.scene.pair(name), [], {}
    first = found.case if found.case in chosen.damage else None
    for case in dict.fromkeys([first, None]):
        title, own = f"{found.scene.name}, {name}, {case or 'healthy'}", chosen.case(case)
        draw = partial(render_stress, own, size=PICTURE, title=title, **same)
        if case == first and found.tooth is not None and shows_tooth(own):  # This tooth is solved.
            draw = partial(render_pressed, own, found.tooth[1], size=PICTURE, title=title)
        out.append(picture_data(draw, title))
        same = {key: out[-1]["told"][key] for key in ("phase", "top")} if "told" in out[-1] else {}
    return out[::-1]


def _contacts(found):
    """Return the Harris map and the contact pattern of the healthy pair as pictures."""
    case = found.scene.case(found.hurt_pair)
    title = f"{found.scene.name}, {found.hurt_pair}, healthy"

    def map_of_loads(path):
        error, plain = harris(replace(case, force=[share * case.forces[0] for share in LOADS]), Solve())
        plot_transmission_error(error, path, title, plain)

    return [
        picture_data(map_of_loads, f"Transmission error under several loads (Harris map): {title}"),
        picture_data(partial(render_pattern, case, title=title), f"Contact pattern over a mesh cycle: {title}"),
    ]


def _gears(pair):
    """Return the `Table` of both gears of a scene's pair, with a row per quantity."""
    shown = [
        {
            "teeth": gear.z, "normal module [mm]": gear.m_n, "normal pressure angle [degrees]": math.degrees(gear.alpha_n),
            "helix angle [degrees]": math.degrees(gear.beta), "profile shift coefficient": gear.x, "face width [mm]": gear.b,
            f"{'rim' if gear.internal else 'bore'} diameter [mm]": 2 * (gear.r_rim or gear.r_bore),
            "Young's modulus [MPa]": material.E, "Poisson's ratio": material.nu,
        }
        for gear, material in zip(pair.pair.gears, pair.materials, strict=True)
    ]  # fmt: skip
    columns = ["quantity", Column("pinion", form="{:.6g}"), Column("wheel", form="{:.6g}")]
    rows = [[name, one, shown[1].get(name)] for name, one in shown[0].items()]
    return Table(columns, rows + [[name, None, one] for name, one in shown[1].items() if name not in shown[0]], "gears")


def _tooth(found):
    """Return the loaded tooth in three dimensions, its stress and the magnification of its displacements, or None."""
    if found.tooth is None:
        return None
    name, pressed, field = found.tooth
    scale = enlarged(field.opening, pressed.sector.gear.m_n)
    drawn = part_of_page(figures.tooth_figure(pressed, field, scale, rounded_up(field.root)), "figure-0")
    error = root_error(pressed, found.scene.pair(name).materials[pressed.gear == "wheel"])
    return {"drawn": drawn, "pair": name, "pressed": pressed, "root": field.root, "error": error, "enlarged": scale}


def _methods(found):
    """Return the `Table` of the used methods with their descriptions and errors."""
    used = dict.fromkeys(name for comparison in found.comparisons.values() for name in comparison.curves)
    closed = "a closed form without estimate; the table has its error"
    error = {False: closed, True: "can be refined to the limit"}
    rows = [(row.name, row.about, error[row.converged] + "; estimated from coarser solves" * (row.converged and bool(row.error)))
            for name in used if (row := METHODS.get(name))]  # fmt: skip
    return Table(("method", "what it is", "its error"), rows, "methods")


def _assumed(scene):
    """Return the `Table` of a scene's assumptions."""
    rows = [(one["what"], one["why"], one["depends"] or "not stated") for one in scene.assumptions]
    return Table(("assumed", "why", "what depends on it"), rows, "assumptions")


def _command(found):
    """Return the command that creates the page. The file of a user's scene is named without its folder."""
    name = found.scene.name if found.scene.name in scene_names() else f"{found.scene.name}.toml"
    return f"gearfe report {name}{f' --case {found.case}' if found.case else ''} -o page.html"

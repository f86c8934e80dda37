"""One picture of stress for every damage case of every scene, and one of the contact lines for every scene with pits."""

import multiprocessing
import os
from concurrent.futures import ProcessPoolExecutor

import gearfe as gf
from gearfe.core.units import in_newton_per_um
from gearfe.scene.load import scene_names
from gearfe.strength.render import render_contact, render_stress

from ..shared import page
from ..shared.places import PAGES

FOLDER = PAGES / "pictures"
SIZE = (840, 630)
COLOURS = 256
REFINE = 0.7  # such small pictures show no more
LIMIT = 120_000  # bytes of a picture


def caption(case, damage, told):
    """What a picture of stress shows, in words."""
    found = [one for own in damage.values() for one in own]
    pits = [one for one in found if isinstance(one, gf.Pit)]
    what = []
    if pits:
        shape = "{:g} x {:g} mm, {:g} mm deep".format(*(2 * v for v in pits[0].axes), pits[0].depth)
        what.append(f"{len(pits)} pit{'s' if len(pits) > 1 else ''} of {shape}")
    what += [f"crack of {100 * one.level:g} %" for one in found if isinstance(one, gf.Crack)]
    opened = f"; displacements x {told['enlarged']}, which opens the crack" if told["enlarged"] else ""
    return f"`{case}`: {' and '.join(what)}; phase {told['phase']:.3g}, {told['load']:.0f} N {told['where']}{opened}."


def pressure(told):
    """The largest pressure in words: a tip corner that touches has none of Hertz's."""
    elsewhere = " away from the tip corner, which touches too" if told["corner"] else ""
    return f"largest pressure of Hertz {told['pressure']:.0f} MPa{elsewhere}"


ARTICLES = [name for name in scene_names() if gf.load_scene(name).references]  # the other scenes are of rigs
UNDRAWN = {
    ("herringbone_contact_line", "case4")
}  # the lowest pits reach 0.08 mm below the form circle: holes cannot be cut there


def tasks():
    """Scene, case and kind of every picture."""
    out = []
    for name in ARTICLES:
        damage = next(iter(gf.load_scene(name).pairs.values())).damage
        out += [(name, case, "stress") for case in damage if (name, case) not in UNDRAWN]
        last = [*damage][-1]
        if any(isinstance(one, gf.Pit) for own in damage[last].values() for one in own):
            out.append((name, last, "contact"))
    return out


def picture(task):
    """Draw one; its lines of the page."""
    name, case, kind = task
    pair_name, pair = next(iter(gf.load_scene(name).pairs.items()))
    if kind == "stress":
        path = FOLDER / f"{name}_{case}.png"
        told = render_stress(pair, path, case=case, size=SIZE, refine=REFINE, title=f"{name} {pair_name}, {case}")
        text = caption(case, pair.damage[case], told)
    else:
        path = FOLDER / f"{name}_{case}_contact.png"
        told = render_contact(pair.case(case), path, title=f"{name} {pair_name}, {case}")
        numbers = f"phase {told['phase']:.3g}, k {in_newton_per_um(told['k'])} N/um, {pressure(told)}."
        text = f"`{case}`: contact lines on the unrolled flank and load over the width; {numbers}"
    _small(path)
    return [f"![{name} {case}](pictures/{path.name})", "", text, ""]


def sections(parts):
    """Sections of the page from the lines of every task."""
    yield [
        """
        `python -m validation pictures` draws these anew; a larger one is drawn by `gearfe render SCENE --case CASE -o x.png`,
        mesh, displacement and stress are written by `-o x.vtu`.

        Pits: the damaged tooth in three dimensions, pits cut out as holes, under its share of the load along the contact
        lines, spread over 0.15 modules to either side; what is above the bar is the load's strip, rims of pits and fronts of
        cracks, where no mesh gives a finite value. Cracks of spur gears: the transverse section, in grey both gears unloaded.
        """,
    ]
    for name in ARTICLES:
        scene = gf.load_scene(name)
        lines = [f"## {scene.title}", "", f"Pair `{next(iter(scene.pairs))}` of scene `{name}`.", ""]
        yield lines + [line for task, part in parts.items() if task[0] == name for line in part]


def run(again=True):
    """Write the pictures, several at a time, and the page."""
    FOLDER.mkdir(exist_ok=True)
    with ProcessPoolExecutor(os.cpu_count(), multiprocessing.get_context("spawn")) as pool:
        parts = dict(zip(tasks(), pool.map(picture, tasks()), strict=True))
    answer = "Von Mises stress of the damage cases of the built-in scenes, and where some of the pitted teeth touch."
    page.write("pictures", answer, *sections(parts))


def _small(path):
    """Reduce a picture to a palette, and refuse one that is still large."""
    from PIL import Image

    with Image.open(path) as picture:
        reduced = picture.convert("RGB").quantize(COLOURS, method=Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
    reduced.save(path, optimize=True)
    size = path.stat().st_size
    print(f"{path.name}: {size / 1e3:.0f} kB", flush=True)
    if size > LIMIT:
        raise RuntimeError(f"{path} has {size} bytes, more than {LIMIT}: draw it smaller")

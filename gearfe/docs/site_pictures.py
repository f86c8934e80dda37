"""How pictures of scripts look, and how the site finds the pictures of a script."""

import shutil
from pathlib import Path

from matplotlib import cycler
from sphinx_gallery.scrapers import figure_rst

from gearfe.figures.look import COLOURS, DASHES

STYLE = {
    "axes.prop_cycle": cycler(color=COLOURS) + cycler(linestyle=DASHES),
    "axes.axisbelow": True,
    "axes.grid": True,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.titlesize": 10,
    "figure.dpi": 120,
    "figure.figsize": (7, 4.2),
    "grid.color": "0.9",
    "legend.fontsize": 9,
}


def pictures(block, block_vars, gallery_conf):
    """Move the png files written by a block of a script to the site and show them."""
    written = sorted(Path(block_vars["src_file"]).parent.glob("*.png"), key=lambda path: path.stat().st_mtime_ns)
    places = [next(block_vars["image_path_iterator"]) for _ in written]
    for path, place in zip(written, places, strict=True):
        shutil.move(path, place)
    return figure_rst(places, gallery_conf["src_dir"])

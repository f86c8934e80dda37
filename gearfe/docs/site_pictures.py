"""How the site finds what a script has drawn."""

import shutil
from pathlib import Path

from sphinx_gallery.scrapers import figure_rst


def pictures(block, block_vars, gallery_conf):
    """Move the png files that a block of a script has written beside itself to the site, and show them."""
    written = sorted(Path(block_vars["src_file"]).parent.glob("*.png"), key=lambda path: path.stat().st_mtime_ns)
    places = [next(block_vars["image_path_iterator"]) for _ in written]
    for path, place in zip(written, places, strict=True):
        shutil.move(path, place)
    return figure_rst(places, gallery_conf["src_dir"])

"""How the documentation is built: ``python -m sphinx gearfe/docs .site`` from the top of the repository."""

import logging
import os
import shutil
import sys
from pathlib import Path

HERE = Path(__file__).parent
TOP = HERE.parents[1]
MADE = HERE / "_made"  # files that the build writes among the sources
sys.path[:0] = [str(TOP), str(HERE)]
os.environ.setdefault("OMP_NUM_THREADS", "1")  # Small matrices gain nothing from threads.
os.environ.setdefault("MPLBACKEND", "Agg")

import matplotlib  # noqa: E402
from site_pictures import STYLE, pictures  # noqa: E402

matplotlib.rcParams.update(STYLE)

PAGES = MADE / "validation"
shutil.rmtree(PAGES, ignore_errors=True)
shutil.copytree(TOP / "validation" / "pages", PAGES)
GROUPS = {
    "Is the model solved correctly?": "outlines sample sample_three random_search growth truth three flanks holes hard sets",
    "How large are the errors of closed forms?": "map speed sweeps growth_conventions",
    "Are the articles reproduced?": "two_minutes printed joint assumptions planetary_pitting compound_planetary helical_pitting "
    "herringbone herringbone_machine herringbone_fit herringbone_readings herringbone_statements variants sideband_centroid",
    "Are vibration and diagnosis right?": "dynamics rig measured detection growth_detection",
}


def row(name):
    """Row of a page in the index: its title, and its first paragraph or list, which is the answer."""
    title, answer = (PAGES / f"{name}.md").read_text(encoding="utf-8").split("\n\n")[:2]
    words = " ".join(answer.removeprefix("- ").replace("\n- ", " ").split()).replace("](#", f"]({name}.md#")
    return f"| {{doc}}`{title.removeprefix('# ')} <{name}>` | {words} |"


def index():
    """Source of the index of the validation pages."""
    names = {path.stem for path in PAGES.glob("*.md")}
    groups = {title: [name for name in text.split() if name in names] for title, text in GROUPS.items()}
    rest = sorted(names - {name for found in groups.values() for name in found})
    groups |= {"Further pages": rest} if rest else {}
    parts = ["# Validation pages", "`python -m validation` computes these pages. The repository contains them."]
    for title, found in groups.items():
        parts += [f"## {title}", "\n".join(["| question | answer |", "|---|---|", *map(row, found)])]
        parts.append("\n".join(["```{toctree}", ":hidden:", "", *found, "```"]))
    return "\n\n".join(parts) + "\n"


(PAGES / "index.md").write_text(index(), encoding="utf-8")
logging.getLogger("skfem").setLevel(logging.WARNING)  # Sphinx sets all loggers to INFO.

project = "gearfe"
author = copyright = "The gearfe developers"
release = version = __import__("importlib.metadata").metadata.version("gearfe")
extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.napoleon",
    "sphinx_gallery.gen_gallery",
    "site_formulas",
    "site_search",
]
exclude_patterns = ["tutorials/*", "gallery/*", "_made/**/*.ipynb", "_made/**/*.py", "_made/**/sg_execution_times.rst"]
myst_enable_extensions = ["dollarmath", "deflist", "amsmath"]
myst_heading_anchors = 3
default_role = "py:obj"  # `name` in a docstring is a link where there is something of that name
napoleon_google_docstring = False
napoleon_use_rtype = False
autosummary_generate = True
autodoc_typehints = "none"  # The docstrings state types, shapes and units.
autodoc_member_order = "bysource"
suppress_warnings = ["config.cache", "myst.header", "autosummary.import_cycle"]
templates_path = ["templates"]

sphinx_gallery_conf = {
    "examples_dirs": [str(HERE / "tutorials"), str(HERE / "gallery")],
    "gallery_dirs": ["_made/tutorials", "_made/gallery"],
    "filename_pattern": r"\.py$",
    "within_subsection_order": "FileNameSortKey",
    "image_scrapers": (pictures,),
    "capture_repr": (),
    "reset_modules": (),
    "abort_on_example_error": True,
    "download_all_examples": False,
    "min_reported_time": 0,
    "show_signature": False,
    "write_computation_times": False,
}

html_theme = "furo"
html_math_renderer = "mathml"
html_title = "gearfe"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_show_sourcelink = False
html_copy_source = False

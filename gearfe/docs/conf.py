"""How the documentation is built: ``python -m sphinx gearfe/docs .site`` from the top of the repository."""

import os
import shutil
import sys
from pathlib import Path

HERE = Path(__file__).parent
TOP = HERE.parents[1]
MADE = HERE / "_made"  # all that the build writes among the sources
sys.path[:0] = [str(TOP), str(HERE)]
os.environ.setdefault("OMP_NUM_THREADS", "1")  # small matrices
os.environ.setdefault("MPLBACKEND", "Agg")

import matplotlib  # noqa: E402
from site_pictures import STYLE, pictures  # noqa: E402

matplotlib.rcParams.update(STYLE)

PAGES = MADE / "validation"
shutil.rmtree(PAGES, ignore_errors=True)
shutil.copytree(TOP / "validation" / "pages", PAGES)
(PAGES / "index.md").write_text(
    "# All pages of the validation\n\nThese pages are made by `python -m validation`, and kept in the repository.\n\n"
    "```{toctree}\n:glob:\n\n*\n```\n",
    encoding="utf-8",
)


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
autodoc_typehints = "none"  # the docstrings say types, shapes and units
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

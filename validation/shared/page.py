"""A page: the question of a reader as its title, the answer in a sentence, then sections of Markdown."""

import re
import textwrap
from itertools import groupby

from .places import PAGES
from .state import replace

WRAP = {"break_long_words": False, "break_on_hyphens": False}

QUESTIONS = {  # by page, as they stand in the list of pages
    "truth": "Does gearfe find what others published or computed?",
    "outlines": "Is the contact of teeth right, beside whole outlines pressed together?",
    "sample": "Do the error estimates cover, on pairs that nobody chose?",
    "three": "Is the stiffness in three dimensions right?",
    "sets": "What does a whole planetary set do to the stiffness of its meshes?",
    "flanks": "Are modified flanks right?",
    "holes": "What do pits change beyond the contact they take away?",
    "hard": "What happens in extreme cases?",
    "map": "How wrong are closed forms, and where may they be used?",
    "assumptions": "What do values that articles leave out do to the stiffness?",
    "speed": "What does each method cost, and how wrong is it?",
    "sweeps": "Can I run thousands of cases, in processes and in threads?",
    "detection": "How small a crack can be told from the scatter of machines?",
    "dynamics": "Are simulated vibrations integrated correctly?",
    "herringbone": "Does the claim of article S4 hold, formulas within 3 % of finite elements?",
    "printed": "What became of every number that the articles print?",
    "machines": "Which printed numbers of four machines are reproduced?",
    "joint": "Which statements of the articles hold whatever the inputs that they do not print?",
    "measured": "Does gearfe find what others measured?",
    "rig": "Do resonances and jumps of a single pair on a test rig come out?",
    "pictures": "What do the damaged teeth of the scenes look like under load?",
}


def text(name, answer, *sections):
    """A page as Markdown; sections are lines."""
    lines = [f"# {QUESTIONS[name]}", "", answer]
    for section in sections:
        lines += ["", *filled(section)]
    return re.sub(r"\n{3,}", "\n\n", "\n".join(lines).rstrip()) + "\n"


def filled(lines):
    """Lines with their paragraphs, which are neither tables, lists, headings nor pictures, broken anew."""
    for prose, group in groupby(lines, lambda line: re.match(r"(?!\d+\. |- )[^|#!\s]", line) is not None):
        own = list(group)
        yield from textwrap.wrap(" ".join(own), 120, **WRAP) if prose else own


def write(name, *parts):
    """Write ``pages/NAME.md`` of the arguments of `text`."""
    replace(PAGES / f"{name}.md", text(name, *parts))
    print(f"wrote {name}.md")


def anew(parts):
    """Beginnings of rows to compute anew, as of `kept_rows.kept`, of the words of the command line: ``all`` is every row."""
    return ("",) if "all" in parts else tuple(parts)

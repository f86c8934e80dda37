"""A page: its title is a question, followed by the answer in a sentence and sections of Markdown.

Its last line, the foot, states the version, the date and the digest of the sources that computed it.
"""

import re
import textwrap
from datetime import date
from itertools import groupby
from pathlib import Path

from gearfe.core.files import written
from gearfe.core.version import VERSION

from .places import PAGES, digest

WRAP = {"break_long_words": False, "break_on_hyphens": False}

QUESTIONS = {  # by page: question, in the order of the list of pages
    "truth": "Does gearfe reproduce published and independently computed values?",
    "sample": "Do the error estimates cover the errors of random pairs?",
    "random_search": "Do the error estimates cover the errors of intentionally difficult pairs?",
    "herringbone": "Does the claim of article S4 hold, formulas within 3 % of finite elements?",
    "two_minutes": "Summary of the five articles: claims and results",
    "printed": "Use and verdict of every number that the articles print",
    "joint": "Which statements of the articles hold for all values of their unprinted inputs?",
}

MACHINES = {
    "planetary_pitting": "Which printed numbers of articles S0 and S1 are reproduced?",
    "compound_planetary": "Which printed numbers of article S2 are reproduced?",
    "helical_pitting": "Which printed numbers of article S3 are reproduced?",
    "herringbone_machine": "Which printed numbers of article S4 are reproduced?",
}


def text(name, answer, *sections):
    """Return a page as Markdown. A section is a text or a list of lines."""
    lines = [f"# {QUESTIONS[name]}", "", answer]
    for section in sections:
        lines += ["", *filled([section] if isinstance(section, str) else section)]
    return re.sub(r"\n{3,}", "\n\n", "\n".join(lines).rstrip()) + "\n"


def filled(parts):
    """Return the lines of `parts`. Paragraphs are wrapped again, but not tables, lists, headings and pictures."""
    lines = (line for part in parts for line in (textwrap.dedent(part).rstrip().splitlines() if "\n" in part else [part]))
    for prose, group in groupby(lines, lambda line: re.match(r"(?!\d+\. |- )[^|#!\s]", line) is not None):
        own = list(group)
        joined = " ".join(own).replace(" %", "\u00a0%")  # Markdown omits a line that begins with %.
        yield from (line.replace("\u00a0", " ") for line in textwrap.wrap(joined, 120, **WRAP)) if prose else own


def write(name, *parts):
    """Write ``pages/NAME.md`` from the arguments of `text`."""
    put(name, text(name, *parts))
    print(f"wrote {name}.md")


def put(name, lines):
    """Write a page of these lines, and keep its foot."""
    foot = read(name)[1]
    replace(PAGES / f"{name}.md", lines + (f"\n{foot}\n" if foot else ""))


def read(name):
    """Return the Markdown of a page and its foot. Both are empty if the page does not exist."""
    path = PAGES / f"{name}.md"
    whole = path.read_text(encoding="utf-8") if path.is_file() else ""
    head, _, last = whole.rstrip("\n").rpartition("\n\n")
    return (f"{head}\n", last) if last.startswith("Computed ") else (whole, "")


def sign(name, seconds, *, reference=False):
    """State at the foot of a page the version that computed it (or its independent values).

    Parameters
    ----------
    name : str
        The page; nothing happens if there is no such file.
    seconds : float
        CPU seconds.
    reference : bool
        Whether the independent values were computed.
    """
    lines, foot = read(name)
    own, _, other = foot.partition(REFERENCES)
    now = f"on {date.today()} in {seconds:.0f} CPU s by gearfe {VERSION}, sources {digest()}."
    own, other = (own, now) if reference else (f"Computed {now}", other)
    if lines:
        replace(PAGES / f"{name}.md", f"{lines}\n{own}{REFERENCES + other if other else ''}\n")


REFERENCES = " Independent values computed "


def replace(path, lines):
    """Write a text file atomically."""
    with written(path) as name:
        Path(name).write_text(lines, encoding="utf-8")

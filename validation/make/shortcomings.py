"""What gearfe falls short of: the expected failures of its tests, read from their marks."""

import ast
from pathlib import Path
from typing import NamedTuple

from gearfe.files import written

from ..shared.places import PAGES, ROOT

PAGE = PAGES / "shortcomings.md"
HEAD = """# Shortcomings

What gearfe should do and does not: the expected failures of its tests, each with its reason (`python -m validation
shortcomings`). They are strict: a test that no longer fails has to lose its mark. A number of somebody else that gearfe does not
find is no shortcoming but a verdict, on the pages of the sources; what a closed form cannot do is on
[hard.md](hard.md) and [formulations.md](formulations.md).

"""
TABLE = "| test | what it asks | why it fails |\n|---|---|---|\n"
NONE = "At present no test is expected to fail.\n"


class Shortcoming(NamedTuple):
    """A test that is expected to fail."""

    file: str
    test: str
    asks: str
    reason: str
    strict: bool


def found():
    """Tests with a mark, by file."""
    return [one for file in sorted((ROOT / "tests").rglob("test_*.py")) for one in _of_file(file)]


def _of_file(file):
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        for mark in getattr(node, "decorator_list", []):
            if isinstance(mark, ast.Call) and ast.unparse(mark.func) == "pytest.mark.xfail":
                words = {word.arg: ast.literal_eval(word.value) for word in mark.keywords}
                asks = (ast.get_docstring(node) or "").partition("\n")[0]
                yield Shortcoming(
                    str(file.relative_to(ROOT)), node.name, asks, words.get("reason", ""), words.get("strict", False)
                )


def mentions():
    """How often the tests say xfail; each must be a mark that `found` lists."""
    return sum(file.read_text(encoding="utf-8").count("xfail") for file in (ROOT / "tests").rglob("*.py"))


def page():
    """The page."""
    rows = "".join(f"| `{one.file}`: `{one.test}` | {one.asks} | {one.reason} |\n" for one in found())
    return HEAD + (TABLE + rows if rows else NONE)


def run():
    """Write the page."""
    with written(PAGE) as name:
        Path(name).write_text(page(), encoding="utf-8")
    print(f"wrote {PAGE.name}: {len(found())} expected failures")

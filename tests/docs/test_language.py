"""Texts that users read: no phrase that readers stumbled over, and no sentence of more than `MOST` words."""

import ast
import contextlib
import io
import re
from pathlib import Path

import pytest

from gearfe.app.cli import main

pytestmark = pytest.mark.quick
ROOT = Path(__file__).parents[2]
SITE = ROOT / "gearfe" / "docs"
MOST = 25
BANNED = re.compile(
    r"\b(as of [`A-Z]|g[ia]ves? way|giving way|told apart|anew\b|beside\b|turns? in a second|turns of (the|its|a) (gear|shaft)"
    r"|stand-?in\b|one's own\b|of (your|their|its) own\b|held against|in the mean (?!pose)|cannot be(?= ?[.,;:)]|$)"
    r"|(says?|tells?|told|knows?|asks?|sees?) (what|whether|how|which|nothing|no|so|it)\b)"
)
FRAGMENT = re.compile(r"(What|Of|How much|How far|How many|Where|As) ")


def sentences(text):
    plain = re.sub(r"`[^`]*`|\[[^\]]*\]\([^)]*\)|\$[^$]*\$", "X", text).replace("**", "")
    return re.split(r"(?<=[.!?:;])\s+", plain)


def faults(text):
    """Banned phrases and long sentences of a text."""
    yield from (found[0] for found in BANNED.finditer(re.sub(r"``[^`]*``|`[a-z_]+`", "X", text)))
    yield from (f"{len(one.split())} words: {one[:60]}" for one in sentences(text) if len(one.split()) > MOST)


def prose(path):
    """Paragraphs and list items of a Markdown file, without code, tables and headings."""
    block = []
    text = re.sub(r"(?ms)^(```|:::|[$][$]).*?\1", "", path.read_text(encoding="utf-8"))
    for line in [*text.splitlines(), ""]:
        plain = line.strip()
        if (
            not plain
            or plain.startswith(("|", "#", "<", "!", "- ", "* "))
            or line.startswith("    ")
            or re.match(r"\d+\. ", plain)
        ):
            yield " ".join(block)
            block = [] if not plain or plain[0] in "|#<!" or line.startswith("    ") else [re.sub(r"^([-*]|\d+\.) ", "", plain)]
        else:
            block.append(plain)


def summaries():
    for folder in (ROOT / "gearfe", ROOT / "geometry"):
        for path in sorted(folder.rglob("*.py")):
            if SITE in path.parents or "geometry" in path.relative_to(ROOT / path.relative_to(ROOT).parts[0]).parts[:1]:
                continue
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef)) and (doc := ast.get_docstring(node)):
                    yield f"{path.relative_to(ROOT)}:{node.body[0].lineno}", doc.split("\n\n")[0]


PAGES = [ROOT / "README.md", *(page for page in sorted(SITE.glob("**/*.md")) if "_made" not in page.parts)]


@pytest.mark.parametrize("page", PAGES, ids=lambda path: "/".join(path.parts[-2:]))
def test_pages_have_short_sentences_and_no_banned_phrase(page):
    assert not [fault for block in prose(page) for fault in faults(block)]


def test_no_line_of_a_page_is_a_comment_of_markdown():
    pages = [*PAGES, *(ROOT / "validation" / "pages").glob("*.md")]
    assert not [page for page in pages if re.search(r"^ *%", page.read_text(encoding="utf-8"), re.M)]


def test_summaries_state_what_is_returned_in_short_sentences():
    found = [(place, fault) for place, text in summaries() for fault in faults(text)]
    found += [(place, text) for place, text in summaries() if FRAGMENT.match(text)]
    assert not found


def test_help_has_short_sentences_and_no_banned_phrase():
    texts = io.StringIO()
    with contextlib.redirect_stdout(texts), contextlib.suppress(SystemExit):
        main(["--help"])
    verbs = re.findall(r"^    (\w+)", texts.getvalue(), re.M)
    assert len(verbs) > 15
    for verb in verbs:
        with contextlib.redirect_stdout(texts), contextlib.suppress(SystemExit):
            main([verb, "--help"])
    blocks = re.split(r"\n(?=\s*\n| {2}\S|usage)|(?<=\S) {2,}(?=\S)", texts.getvalue())
    blocks = (" ".join(block.split()) for block in blocks if not re.match(r"(usage: )?gearfe \w+ \[", block.strip()))
    assert not [fault for block in blocks for fault in faults(block)]


@pytest.mark.parametrize(
    ("page", "most"),
    [
        ("herringbone", 2500),
        ("herringbone_machine", 2000),
        ("planetary_pitting", 2000),
        ("compound_planetary", 2000),
        ("helical_pitting", 2000),
    ],
)
def test_pages_of_articles_stay_short(page, most):
    assert len((ROOT / "validation" / "pages" / f"{page}.md").read_text(encoding="utf-8").split()) <= most


def test_all_markdown_has_at_most_65000_words():
    """Words as `wc -w` counts them, without the generated page of keys. A new page takes the place of an old one."""
    pages = {
        *PAGES,
        *(ROOT / "validation" / "pages").glob("*.md"),
        ROOT / "gearfe" / "CHANGES.md",
        *(ROOT / ".github").rglob("*.md"),
    }
    pages |= set((ROOT / "gearfe" / "runs").rglob("*.md"))
    assert sum(len(page.read_text(encoding="utf-8").split()) for page in pages if page.name != "keys.md") <= 65_000

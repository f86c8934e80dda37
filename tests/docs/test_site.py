"""The site: every public name is in its reference, sources name only pages and files that exist, and Sphinx builds it."""

import re
from pathlib import Path

import pytest

import gearfe as gf

pytestmark = pytest.mark.quick

ROOT = Path(__file__).parents[2]
SITE = ROOT / "gearfe" / "docs"
PAGES = sorted(path for path in SITE.glob("**/*.md") if "_made" not in path.parts)


def test_reference_has_every_public_name():
    named = re.findall(r"^   (\w+)$", (SITE / "reference" / "index.md").read_text(encoding="utf-8"), re.M)
    assert sorted(named) == sorted(gf.__all__)


@pytest.mark.parametrize("page", PAGES, ids=lambda path: str(path.relative_to(SITE)))
def test_pages_name_what_exists(page):
    for place in re.findall(r"\{doc\}`(?:[^`<]*<)?([^`>]+)>?`", page.read_text(encoding="utf-8")):
        target = SITE / place.lstrip("/") if place.startswith("/") else page.parent / place
        name = target.resolve().relative_to(SITE.resolve()).as_posix()
        if name.startswith("_made/validation/"):
            source = ROOT / "validation" / "pages" / f"{target.name}.md"
        elif name.startswith("_made/"):
            folder, stem = name.split("/")[1:]
            source = SITE / folder / ("GALLERY_HEADER.rst" if stem == "index" else f"{stem}.py")
        else:
            source = target.with_name(f"{target.name}.md")
        assert source.exists(), f"{page.name} names {place}"


@pytest.mark.parametrize(
    "page", [SITE / "where.md", SITE / "life_of_a_number.md", ROOT / "README.md"], ids=lambda path: path.name
)
def test_map_names_files_that_exist(page):
    for name in re.findall(r"`((?:gearfe|geometry|tests|validation)/[\w/.]*)`", page.read_text(encoding="utf-8")):
        assert (ROOT / name).exists(), name


def test_page_of_clear_answers_adds_up():
    text = (SITE / "invalid_input.md").read_text(encoding="utf-8")
    rows = [int(number) for number in re.findall(r"^\| (\d+) \D", text, re.M)]
    assert len(rows) == 6  # each counted by `tests/hostile/test_hostile.py`
    assert int(re.search(r"tries (\d+) invalid inputs", text)[1]) == sum(rows)


def test_search_finds_the_texts_of_sections_by_their_anchors(monkeypatch):
    core = pytest.importorskip("docutils.core")
    monkeypatch.syspath_prepend(SITE)
    from site_search import text_page

    text = "Top\n===\n\na < b\n\nOne\n---\n\nwords\n\nTwo\n---\n\n.. raw:: html\n\n   <b>\n\nmore\n"
    found = text_page(core.publish_doctree(text, settings_overrides={"doctitle_xform": False}))
    parts = {"top": "Top a &lt; b", "one": "One words", "two": "Two more"}
    assert found == '<div role="main">' + "".join(f'<div id="{name}">{own} </div>' for name, own in parts.items()) + "</div>"

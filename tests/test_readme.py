"""The README shows what the program prints; numbers may differ in the last digit shown (another gmsh, another mesh)."""

import re

from numpy.testing import assert_allclose
from remake import FIVE, OUTPUT, README, ROOT, TABLE, five_rows, outputs

import gearfe as gf

TEXT = README.read_text(encoding="utf-8")
NUMBER = re.compile(r"[-+]?\d+\.?\d*(?:e[-+]\d+)?")


def same(printed, shown):
    assert NUMBER.sub("#", printed) == NUMBER.sub("#", shown)
    found = [[float(x) for x in NUMBER.findall(text)] for text in (printed, shown)]
    assert_allclose(*found, rtol=2e-3, atol=0.1)


def test_programs_print_what_is_shown():
    shown = [match[1] for match in OUTPUT.findall(TEXT)]
    printed = outputs(TEXT)
    assert len(shown) == len(printed) == 1
    for ours, theirs in zip(printed, shown, strict=True):
        same(ours, theirs)


def test_table_is_what_compare_gives():
    table = gf.compare(gf.load_scene("planetary_pitting")).table().markdown()
    same(table.rpartition("\n")[0], TABLE.search(TEXT)[0].rpartition("\n")[0])


def test_five_rows_are_those_of_the_page():
    assert FIVE.search(TEXT)[0] == five_rows()
    assert len(five_rows().splitlines()) == 2 + 5


def test_is_read_in_two_minutes():
    assert TEXT.count("\n") <= 105


def test_files_it_names_exist():
    for link in re.findall(r"\]\(([^)#]+)\)", TEXT):
        assert (ROOT / link).exists(), link

"""The page of the test rig: it says what its table says, the table what the code gives, and it compares nothing with memory."""

import tomllib

import numpy as np
from numpy.testing import assert_allclose

from validation.make import rig
from validation.shared.kept_rows import stored
from validation.shared.places import PAGES, SOURCES

TEXT, ROWS = (PAGES / "rig.md").read_text(encoding="utf-8"), stored(rig.TABLE)


def test_the_page_says_what_its_table_says():
    rows = {name: ROWS[name] for name in rig.CASES}
    assert [line for line in (*rig.section(rows), *rig.inputs()) if line.startswith("|") and line not in TEXT] == []
    assert rig.answer(rows) in TEXT


def test_amplitudes_on_file_are_those_of_the_code():
    """Where one motion alone is stable, so that no way led there."""
    name, speeds = "340 N m, damping 5 %", (0.6, 1.0, 1.2)
    got, row = rig.swept(name, speeds)[1][:, 0], ROWS[name]
    want = [row["up"][int(np.argmin(np.abs(rig.SPEEDS - speed)))] for speed in speeds]
    assert_allclose(got, want, rtol=1e-3)
    assert ROWS["checks"]["shooting"] < 1e-3
    assert ROWS["checks"]["heavier"] < 1e-9
    assert_allclose(ROWS["checks"]["natural"], rig.HEAVIER**-0.5, rtol=1e-9)


def test_the_resonance_softens_more_under_less_load_and_less_damping():
    """Jumps need loss of contact: none with 5 % of damping; the lighter the load, the longer the flights."""
    ends = [rig.twofold(ROWS[f"{torque} N m"])[-1][0] for torque in (340, 170, 85)]
    assert ends[0] > ends[1] > ends[2]
    assert rig.twofold(ROWS["340 N m, damping 1 %"])[-1][0] < ends[0]
    assert (rig.twofold(ROWS["340 N m, damping 5 %"]), ROWS["340 N m, damping 5 %"]["open"]) == ([], 0.0)
    assert min(ROWS[name]["least"] for name in rig.CASES) > -rig.PLAY


def test_what_is_recalled_is_marked_and_not_judged():
    told = tomllib.loads((SOURCES / "rig.toml").read_text(encoding="utf-8"))
    assert {one["from"].split(",")[0].split(":")[0].split(";")[0] for one in told["input"]} <= {"recalled", "assumed", "missing"}
    assert all(one["judged"].startswith("not judged") for one in told["recalled"])
    assert "none is compared" in TEXT

"""Which rows are of the present code, and how they are computed again."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from trial_project import KEPT, MAKE, MODULE, first_line, old, told, trial

from validation.shared import decks, places, renew, state


@pytest.fixture
def project(tmp_path):
    return trial(tmp_path)


@pytest.fixture(scope="module")
def once(tmp_path_factory):
    """A project whose page was computed."""
    project = trial(tmp_path_factory.mktemp("computed"))
    told(project, "cracks")
    assert old(project) == 0
    assert first_line(project) == "2 of 2 rows on the present code"
    return project


@pytest.fixture
def computed(once, tmp_path):
    return shutil.copytree(once, tmp_path / "project")


REWORDED = (
    (" that is one", " still one"),
    ("Give 1.", "Give one, and say so."),
    ("\n\n\n", "\n\n\n\n"),
    ("    return", "\n    return"),
)


@pytest.mark.parametrize(
    ("file", "changes", "rows"),
    [
        pytest.param("gearfe/used.py", REWORDED, 0, id="comment, docstring and form of a module"),
        pytest.param("gearfe/used.py", [("return 1", "return True")], 2, id="line of a module imported in a function"),
        pytest.param("gearfe/idle.py", [("return 1", "return 2")], 0, id="line of a module not imported"),
        pytest.param("gearfe/data.csv", [("0", "0.001")], 2, id="data that was read"),
        pytest.param("validation/make/cracks.py", [("second,2", "second,3")], 2, id="module of the page"),
        pytest.param("validation/shared/renew.py", [("import os", "import math, os")], 0, id="what only keeps and writes"),
    ],
)
def test_rows_are_old_when_what_they_used_means_something_else(computed, file, changes, rows):
    for was, now in changes:
        text = (computed / file).read_text()
        assert was in text
        (computed / file).write_text(text.replace(was, now))
    assert old(computed) == rows
    assert first_line(computed) == f"{2 - rows} of 2 rows on the present code"


def test_a_module_that_changes_while_a_job_runs_makes_it_fail(project):
    (project / "validation/make/cracks.py").write_text(MAKE + '    (ROOT / "gearfe" / "used.py").touch()\n')
    assert "gearfe/used.py changed while cracks was computed" in told(project, "cracks", code=1)
    assert old(project) == 1


def test_a_page_that_was_never_computed_is_old(project):
    assert old(project) == 1
    told(project, "cracks")
    assert "dynamics " in told(project, "--stale")
    assert "dynamics" in told(project, "--stale", "--age", "30", code=1).partition("old for more than")[2]


def test_rows_that_are_kept_are_recorded_one_by_one(project):
    told(project, "dynamics")
    told(project, "dynamics", "--reference")
    (project / "validation/make/dynamics.py").write_text(KEPT.replace("'value': 1", "'value': 2"))
    assert "4 of     4 rows old" in told(project, "--stale")
    told(project, "dynamics", "two")
    told(project, "dynamics", "--reference", "four")
    assert "2 of     4 rows old" in told(project, "--stale")
    told(project, "renew", "dynamics", "--minutes", "1")
    assert "dynamics" not in told(project, "--stale")
    for name in ("rows", "far"):
        lines = (project / f"validation/pages/tables/dynamics_{name}.jsonl").read_text().splitlines()
        assert [json.loads(line)["value"] for line in lines] == [2, 2]


def test_age_counts_only_what_is_old(project):
    for words in (["cracks"], ["dynamics"], ["dynamics", "--reference"]):
        told(project, *words)
    path = project / "validation/pages/tables/state.jsonl"
    path.write_text(path.read_text().replace(time.strftime("%Y-%m-%d", time.gmtime()), "2020-01-01"))
    told(project, "--stale", "--age", "30")
    (project / "gearfe/used.py").write_text(MODULE.replace("1", "2"))
    late = told(project, "--stale", "--age", "30", code=1).partition("old for more than")[2]
    assert "cracks" in late
    assert "--stale" in late  # the page still says that its rows are of the present code
    assert first_line(project) == "2 of 2 rows on the present code"  # asked for an age it changes nothing


@pytest.mark.parametrize("killed", [None, signal.SIGTERM, signal.SIGKILL], ids=["time is over", "stopped", "killed"])
def test_renewing_that_is_stopped_leaves_whole_files(computed, killed):
    folder = computed / "validation" / "pages"
    kept = {path: path.read_text() for path in folder.rglob("*") if path.is_file()}
    (computed / "gearfe/data.csv").write_text("30\n")  # seconds that it waits with half a table written
    command = [sys.executable, "-m", "validation", "renew", "--minutes", "5" if killed else "0.05"]
    started = time.monotonic()
    with subprocess.Popen(
        command, cwd=computed, env=os.environ | {"PYTHONPATH": ""}, stdout=subprocess.PIPE, text=True
    ) as process:
        if killed:
            while not [path for path in half_written(computed) if path.read_text().endswith("first,")]:
                assert time.monotonic() - started < 200
                time.sleep(0.05)
            process.send_signal(killed)
        said = process.communicate()[0]
    assert process.returncode == {None: 0, signal.SIGTERM: 1, signal.SIGKILL: -signal.SIGKILL}[killed]
    assert killed or "cracks: stopped" in said
    if not killed:
        kept[folder / "cracks.md"] = kept[folder / "cracks.md"].replace("2 of 2", "0 of 2")
    assert {path: path.read_text() for path in kept} == kept
    assert killed == signal.SIGKILL or not half_written(computed)


def half_written(project):
    return list(Path(project, "validation").glob(".pages.*/pages/tables/cracks.csv"))


def test_renew_with_several_processes_computes_all_that_is_old(project):
    told(project, "cracks")
    told(project, "dynamics")
    told(project, "dynamics", "--reference")
    (project / "gearfe/used.py").write_text(MODULE.replace("return 1", "return 5"))
    (project / "validation/make/dynamics.py").write_text(KEPT.replace("'value': 1", "'value': 2"))
    said = told(project, "renew", "--minutes", "1", "--processes", "2")
    assert "cracks: computed again" in said
    assert "FAILED" not in said
    assert "first,5" in (project / "validation/pages/tables/cracks.csv").read_text()
    for name in ("rows", "far"):
        lines = (project / f"validation/pages/tables/dynamics_{name}.jsonl").read_text().splitlines()
        assert [json.loads(line)["value"] for line in lines] == [2, 2]
    assert "0 of 6 rows are old" in told(project, "--stale")


def test_jobs_of_a_page_wait_for_each_other_and_those_that_time_for_all():
    jobs = [renew.Job((page, part), 1, True, "", 1.0) for page, part in (("speed", ""), ("map", "1"), ("map", "2"), ("hard", ""))]
    assert renew._next(jobs, [], ("speed",)) is jobs[0]
    assert renew._next(jobs, ["speed"], ("speed",)) is None
    assert renew._next(jobs, ["map"], ("speed",)) is jobs[3]
    assert renew._next(jobs, ["map", "hard"], ("speed",)) is None


def test_renew_computes_what_is_old(computed):
    (computed / "gearfe/used.py").write_text(MODULE.replace("return 1", "return 5"))
    assert "cracks: computed again" in told(computed, "renew", "--minutes", "1")
    assert "first,5" in (computed / "validation/pages/tables/cracks.csv").read_text()
    assert old(computed) == 0


def test_slow_tests_that_are_skipped_are_neither_done_nor_failed(project, monkeypatch):
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    file = project / "tests/test_one.py"
    marked = "import pytest\n\n\n@pytest.mark" + ".slow\ndef test_one():\n    "
    file.write_text(marked + "pytest.skip('no such tool')\n")
    said = told(project, "renew", "slow", "--minutes", "1")
    assert "slow tests/test_one.py: not computed, something is missing here: 1 skipped" in said
    assert "slow tests" not in (project / "validation/pages/tables/state.jsonl").read_text()
    file.write_text(marked + "assert False\n")
    assert "that did not pass: {'failed': 1}" in told(project, "slow", "tests/test_one.py", code=1)
    file.write_text(marked + "assert True\n")
    told(project, "slow", "tests/test_one.py")
    assert "slow tests/test_one.py" in (project / "validation/pages/tables/state.jsonl").read_text()


@pytest.mark.parametrize(
    ("code", "by", "deck", "present"),
    [
        pytest.param("old", "now", "d1", True, id="the present code writes the same deck"),
        pytest.param("old", "now", "d2", False, id="it writes another deck"),
        pytest.param("old", "old", "d1", False, id="other code wrote the decks"),
        pytest.param("now", "old", "d2", True, id="the run itself is of the present code"),
    ],
)
def test_a_run_of_another_program_is_judged_by_its_deck(monkeypatch, tmp_path, code, by, deck, present):
    monkeypatch.setattr(places, "TABLES", tmp_path)
    codes = {"now": state.digest(["validation/shared/decks.py"]), "old": "0123456789"}
    told = {"files": "f", "date": "2026-11-01", "rows": 1}
    lines = [
        told | {"job": "three --reference one", "table": "runs.jsonl", "code": codes[code], "deck": "d1"},
        told | {"job": state.DECKS, "table": "", "code": codes[by]},
        {"key": "f", "files": {"validation/shared": "decks"}},
    ]
    (tmp_path / "state.jsonl").write_text("".join(json.dumps(line) + "\n" for line in lines))
    (tmp_path / "runs.jsonl").touch()
    (tmp_path / "decks.csv").write_text(f"job,deck\nthree --reference one,{deck}\n")
    jobs, told = state.read()
    assert state.present(jobs["three --reference one", "runs.jsonl"], told) is present


def test_a_deck_is_the_same_with_other_last_digits_and_another_with_another_node(tmp_path):
    path, found = tmp_path / "gear.inp", []
    for text in ("*NODE\n1, 1.000000000000e+00, -0.0\n", "*NODE\n1, 9.99999999998e-01, 0.0\n", "*NODE\n1, 1.00001, 0.0\n"):
        path.write_text(text)
        found.append(decks.digest(path))
    assert found[0] == found[1] != found[2]


def test_of_two_lines_of_a_job_the_later_counts(monkeypatch, tmp_path):
    monkeypatch.setattr(places, "TABLES", tmp_path)
    lines = [{"job": "cracks", "table": "", "date": f"2026-11-0{day}", "rows": day} for day in (2, 3, 1)]
    (tmp_path / "state.jsonl").write_text("".join(json.dumps(line) + "\n" for line in lines))
    assert state.read()[0]["cracks", ""]["rows"] == 3


def test_a_line_whose_key_a_merge_dropped_is_old():
    code = state.digest(["validation/shared/decks.py"])
    line, told = {"files": "f", "code": code}, {"f": {"called": {"validation/shared": "k"}}, "k": {"calls": {"decks": "*"}}}
    assert state.present(line, told)
    assert not state.present(line, {"f": told["f"], "decks": {"by": {}}})
    assert not state.present(line, {"decks": {"by": {}}})


def test_first_lines_of_pages_agree_with_the_state():
    assert state.stamp(write=False) == [], "run python -m validation --stale"


def test_every_row_that_is_kept_has_its_line_in_the_state():
    """A line of a row that is gone is deleted by hand; a row without one is computed anew."""
    jobs, _ = state.read()
    lines = {(table, job.partition(" ")[2].removeprefix("--reference ")) for job, table in jobs if table.endswith(".jsonl")}
    kept = {path.name: path.read_text().splitlines() for path in places.TABLES.glob("*.jsonl") if path.stem != "state"}
    assert lines == {(name, json.loads(row)["row"]) for name, rows in kept.items() for row in rows}

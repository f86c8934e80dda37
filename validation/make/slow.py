"""Run the slow tests that have no result on this code, and write what is known of all of them."""

import json
import subprocess
import sys
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path

from gearfe.files import written

from ..shared import code
from ..shared.places import PAGES, ROOT, TABLES

PAGE, RECORD = PAGES / "slow.md", TABLES / "slow.jsonl"
NOT_RUN, EARLIER = "never run", " on earlier code"
DONE = ("passed", "expected failure")
FAILED = ("failed", "unexpected pass", "skipped")
WORKERS = 2
HEAD = """# Slow tests: the record

Made by `python -m validation slow` from [tables/slow.jsonl](tables/slow.jsonl), one line per test, written as each ends. A result
counts for the code it ran on: both packages with their scenes, the libraries and the file of the test; when any of them has
changed since, it is the result *on earlier code*, of the commit named below. `python -m validation slow` runs all that have
no result on the present code, `python -m validation slow tests/FILE ...` those of some files.

{total}.

| file | tests | {columns} | seconds |
|---|---|{rule}---|
"""


def run(files=()):
    """Run the tests without a result on this code, of all files or of some; write the page; raise RuntimeError if one failed."""
    tests, known = collected(), latest(read())
    wrong = [one for one in files if not any(file_of(test) == one for test in tests)]
    if wrong:
        there = ", ".join(sorted({file_of(test) for test in tests}))
        raise ValueError(f"no slow test in {', '.join(wrong)}: give files among {there}")
    waiting = [test for test in tests if (not files or file_of(test) in files) and not current(known.get(test), DONE)]
    try:
        execute(waiting, {test: row["seconds"] for test, row in known.items()})
    finally:
        keep(tests)
    bad = [row["test"] for row in judged() if row["outcome"] in FAILED]
    if bad:
        raise RuntimeError(f"slow tests that did not pass: {', '.join(bad)}")


def collected():
    """All slow tests, as pytest names them."""
    command = [sys.executable, "-m", "pytest", "-m", "slow", "--collect-only", "-q", "tests"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"pytest could not collect the slow tests:\n{done.stdout[-2000:]}")
    return [line for line in done.stdout.splitlines() if "::" in line]


def execute(tests, seconds):
    """Run tests file by file, two files at a time, and tell how far it is; `seconds` of earlier runs by test."""
    files, started, done = Counter(map(file_of, tests)), time.perf_counter(), 0
    longest = sorted(files, key=lambda one: -sum(seconds.get(test, 60.0) for test in tests if file_of(test) == one))
    left = sum(seconds.get(test, 60.0) for test in tests)
    with ThreadPoolExecutor(WORKERS) as pool:
        jobs = {pool.submit(_of_file, [test for test in tests if file_of(test) == one]): one for one in longest}
        for job in as_completed(jobs):
            done += 1
            left -= sum(seconds.get(test, 60.0) for test in tests if file_of(test) == jobs[job])
            at = time.perf_counter() - started
            print(f"[{done}/{len(files)}, {at:.0f} s, about {left / WORKERS:.0f} s left] {jobs[job]}: {job.result()}", flush=True)


def _of_file(tests):
    """Run the tests of one file; the last line of pytest."""
    plugin = ["-p", "validation.shared.recorder", "--record", str(RECORD)]
    command = [sys.executable, "-m", "pytest", "-q", "-m", "slow", *plugin, *tests]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False).stdout.rstrip().splitlines()[-1]


def file_of(test):
    """File of a test."""
    return test.partition("::")[0]


def read():
    """Rows on file, in the order they were written."""
    return [json.loads(line) for line in RECORD.read_text(encoding="utf-8").splitlines()] if RECORD.is_file() else []


def latest(rows):
    """The last row of each test."""
    return {row["test"]: row for row in rows}


def current(row, outcomes):
    """Whether a row is one of the outcomes, on this code."""
    return row is not None and row["outcome"] in outcomes and row["code"] == code.fingerprint(file_of(row["test"]))


def keep(tests):
    """Leave one row per test that exists, and write the page; a test without a result on this code says so."""
    known, rows = latest(read()), []
    for test in tests:
        row = known.get(test, {"test": test, "outcome": NOT_RUN, "seconds": 0.0, "printed": []})
        rows.append(row | {"on": "this code" if current(row, (row["outcome"],)) else ""} if "code" in row else row)
    with written(RECORD) as name:
        Path(name).write_text("".join(json.dumps(row) + "\n" for row in rows), encoding="utf-8")
    with written(PAGE) as name:
        Path(name).write_text(page(), encoding="utf-8")
    print(f"wrote {PAGE.name}: {total(judged())}")


def judged():
    """Rows on file; an outcome that is not of the code of the page says so."""
    return [row if row.get("on") or "code" not in row else row | {"outcome": row["outcome"] + EARLIER} for row in read()]


def total(rows):
    """How many have which outcome."""
    count = Counter(row["outcome"] for row in rows)
    return f"{len(rows)} slow tests: " + ", ".join(f"{many} {word}" for word, many in sorted(count.items(), key=_rank))


def _rank(item):
    now = (*DONE, *FAILED)
    return (*now, *(word + EARLIER for word in now), NOT_RUN).index(item[0])


def page():
    """The page, from the table alone."""
    rows = judged()
    words = [word for word, _ in sorted(Counter(row["outcome"] for row in rows).items(), key=_rank)]
    head = HEAD.format(total=total(rows), columns=" | ".join(words), rule="---|" * len(words))
    lines = [head.rstrip("\n")]
    for file in dict.fromkeys(file_of(row["test"]) for row in rows):
        own = [row for row in rows if file_of(row["test"]) == file]
        counts = [str(sum(row["outcome"] == word for row in own) or "") for word in words]
        seconds = sum(row["seconds"] for row in own if row["outcome"] != NOT_RUN)
        lines.append(f"| `{file}` | {len(own)} | {' | '.join(counts)} | {seconds:.0f} |")
    lines += ["", "## Which code", "", *_codes(rows), "", "## What they printed", ""]
    for row in rows:
        if row["outcome"] != NOT_RUN:
            printed = ["", "```text", *row["printed"], "```", ""] if row["printed"] else [""]
            lines += [f"`{row['test']}`: {row['outcome']}, {row['seconds']:.0f} s", *printed]
    return "\n".join(lines).rstrip() + "\n"


def _codes(rows):
    """Commit, date and machine of the results that count."""
    found = Counter((row["commit"] or "no commit", row["date"], row["machine"]) for row in rows if row["outcome"] != NOT_RUN)
    return [f"- commit {commit}, {date}, on {on}: {many} tests" for (commit, date, on), many in found.items()] or ["- none yet"]

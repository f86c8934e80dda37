"""What is old, how long it takes, and computing it again within a given time."""

import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from contextlib import suppress
from datetime import date
from functools import cache
from pathlib import Path
from typing import NamedTuple

from . import places, slow, state


class Job(NamedTuple):
    """What `python -m validation` computes at once."""

    words: tuple[str, ...]  # page and part
    rows: int
    old: bool
    date: str  # empty: never computed
    seconds: float | None  # of the processor; None: unknown
    days: int | None = None  # since when it is old


def jobs(pages):
    """All jobs: those of the state, and the pages and files of slow tests that are not in it.

    Parameters
    ----------
    pages : iterable of str
        Pages and, with a space between, parts of pages that are computed by themselves.
    """
    lines, told = state.read()
    out = {}
    for (name, _), line in lines.items():
        words = tuple(name.split(" ", 1))
        if not _known(words, pages):
            continue
        old = not state.present(line, told)
        one = Job(words, line["rows"], old, line["date"], line.get("cpu"), days_old(line, told) if old else 0)
        out[words] = _both(out[words], one) if words in out else one
    there = {name.split(" ", 1)[0] for name, _ in lines} | {name for name, _ in lines}
    wanted = [*pages, *(f"slow {file}" for file in slow.files())]
    missing = [tuple(name.split(" ", 1)) for name in wanted if name not in there]
    return [*out.values(), *(Job(words, 1, True, "", None) for words in missing)]


def _known(words, pages):
    """Whether a job of the state still exists: its page, or its part, or its file of slow tests."""
    if words[0] == "slow":
        return words[1] in slow.files()
    return words[0] in pages or " ".join(words) in pages


def _both(one, two):
    """Rows of the same name in two tables of a page are computed together."""
    days = None if None in (one.days, two.days) else max(one.days, two.days)
    seconds = None if None in (one.seconds, two.seconds) else one.seconds + two.seconds
    return Job(one.words, one.rows + two.rows, one.old or two.old, min(one.date, two.date), seconds, days)


def days_old(line, told):
    """Days between the first commit after that of a line that touched one of its files and the present one.

    Counted between commits, not by the clock, so that the same commit always gets the same answer. Without files or history: since
    the day of the line itself.
    """
    since = _touched(line["commit"].rstrip("+"), line["files"], tuple(state.files_of(line, told))) if "files" in line else ""
    return (date.fromisoformat(_head()) - date.fromisoformat(since or line["date"])).days


@cache
def _touched(commit, _, files):
    return state.git("log", "--reverse", "--format=%cs", f"{commit}..HEAD", "--", *files).partition("\n")[0] if commit else ""


@cache
def _head():
    return state.git("log", "-1", "--format=%cs") or date.today().isoformat()


def report(found):
    """Lines that say what is old, page by page, and how long it takes to compute it again."""
    lines, old = [], [one for one in found if one.old]
    for page in sorted({one.words[0] for one in old}):
        own = [one for one in old if one.words[0] == page]
        rows = sum(one.rows for one in found if one.words[0] == page)
        dates = sorted(one.date for one in own if one.date)
        never = sum(not one.date for one in own)
        text = f"{page:24s} {sum(one.rows for one in own):5d} of {rows:5d} rows old, {cost(own)}"
        text += f", of {dates[0]}{f' to {dates[-1]}' if dates[-1] != dates[0] else ''}" if dates else ""
        lines.append(text + (f", {never} never computed" if never else ""))
    total = f"{sum(one.rows for one in old)} of {sum(one.rows for one in found)} rows are old: {cost(old)} to compute again"
    return [*lines, f"{total}; everything takes {cost(found)}"]


def cost(found):
    """CPU seconds of jobs, as far as they are known."""
    known = [one.seconds for one in found if one.seconds is not None]
    text = f"{sum(known):.0f} CPU s"
    return text if len(known) == len(found) else f"{text} and {len(found) - len(known)} jobs of unknown cost"


def too_old(found, most):
    """What is old for longer than `most` days, or was never computed."""
    return [one for one in found if one.old and (one.days is None or one.days > most)]


def renew(pages, minutes):
    """Compute the oldest jobs again, those of earlier code first, as many as fit; the names of those that failed.

    A job whose cost is known begins only if that fits into what is left, and all are stopped when the time is over. What is stopped
    or fails leaves nothing behind: a job writes beside the pages, and its files are moved there, each whole, the state last.
    """
    end, failed = time.monotonic() + 60 * minutes, []
    for job in sorted(jobs(pages), key=lambda one: (not one.old, one.seconds is None, one.date, one.words)):
        left = end - time.monotonic()
        if left <= 0 or (job.seconds or 0.0) > left:
            continue
        code, told = alone(job.words, left)
        outcome = {0: "computed again", None: "stopped: the time is over"}.get(code, "FAILED")
        print(f"{' '.join(job.words)}: {outcome}", flush=True)
        if code:
            print("\n".join(told[-15:]), flush=True)
            failed.append(" ".join(job.words))
    state.stamp()
    return failed


def alone(words, seconds):
    """Exit code (None: stopped) and printed lines of a job in a process of its own; what it wrote is kept if it ended well."""
    with tempfile.TemporaryDirectory(prefix=".pages.", dir=places.HOME) as folder:
        beside = Path(folder) / "pages"
        shutil.copytree(places.PAGES, beside)
        own = os.environ | {"GEARFE_PAGES": str(beside)}
        command = [sys.executable, "-m", "validation", *words]
        out = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True, "start_new_session": True}
        with subprocess.Popen(command, cwd=places.ROOT, env=own, **out) as process:
            try:
                told = process.communicate(timeout=seconds)[0]
            except BaseException as error:
                with suppress(ProcessLookupError):
                    os.killpg(process.pid, signal.SIGKILL)
                process.wait()
                if isinstance(error, subprocess.TimeoutExpired):
                    return None, []
                raise
        if process.returncode == 0:
            move(beside, places.PAGES)
        return process.returncode, told.splitlines()


def move(source, target):
    """Replace each file that differs, whole, and last the lines of the state that do."""
    for path in source.rglob("*"):
        place = target / path.relative_to(source)
        if path.is_file() and path.name != "state.jsonl" and (not place.is_file() or path.read_bytes() != place.read_bytes()):
            place.parent.mkdir(parents=True, exist_ok=True)
            os.replace(path, place)
    lines, told = state.read(source / "tables")
    with state.changed() as (known, known_told):
        known_told |= told
        known |= {job: line for job, line in lines.items() if line["date"] >= known.get(job, line)["date"]}

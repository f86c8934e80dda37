"""What is old, how long it takes, and computing it again within a given time."""

import json
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

STATE = Path("tables/state.jsonl")
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
SLACK = 1.5  # of the clock, for each second of the processor that a job took elsewhere: machines differ, and do other work
AT_ONCE, A_ROW = 60.0, 5.0  # CPU seconds of rows that one process computes, so that a stop loses little; of one of unknown cost


class Job(NamedTuple):
    """What `python -m validation` computes at once."""

    words: tuple[str, ...]  # page and part
    rows: int
    old: bool
    date: str  # empty: never computed
    seconds: float | None  # of the processor; None: unknown
    days: int | None = None  # since when it is old; None: unknown, and longer than any age
    row: bool = False  # whether it is one of the rows that a page computes by their names


def jobs(wanted, rows):
    """All jobs: those of the state that are still wanted, and what is wanted and not in it.

    Parameters
    ----------
    wanted : iterable of str
        Pages, and parts of pages that are computed by themselves, with a space between.
    rows : iterable of str
        Pages that compute some of their rows by their names.
    """
    (lines, told), out = state.read(), {}
    wanted = [*wanted, *(f"slow {file}" for file in slow.files())]
    pages = {name.partition(" ")[0] for name in wanted} - {"slow"}
    for (name, _), line in lines.items():
        page, _, part = name.partition(" ")
        if name not in wanted and page not in pages:
            continue
        words = (page, part) if part and (name in wanted or page in rows) else (page,)
        if part.startswith("--reference "):
            words = (page, *part.split(" ", 1))
        old = not state.present(line, told)
        one = Job(
            words,
            line["rows"],
            old,
            line["date"],
            line.get("cpu"),
            days_old(line, told) if old else 0,
            len(words) > 1 and name not in wanted,
        )
        out[words] = _both(out[words], one) if words in out else one
    there = {" ".join(words) for words in out} | {" ".join(words[:-1]) for words in out if words[0] in rows}
    never = [tuple(name.split(" ", 1)) for name in wanted if name not in there]
    return [*out.values(), *(Job(words, 1, True, "", None, _days_there(*words)) for words in never)]


def _both(one, two):
    """Rows of the same name in two tables of a page are computed together."""
    days = None if None in (one.days, two.days) else max(one.days, two.days)
    seconds = None if None in (one.seconds, two.seconds) else one.seconds + two.seconds
    return Job(one.words, one.rows + two.rows, one.old or two.old, min(one.date, two.date), seconds, days, one.row)


def days_old(line, told):
    """Days between the first commit after that of a line that touched one of its files and the present one.

    Counted between commits, not by the clock, so that the same commit always gets the same answer. Without files or history:
    since the day of the line itself.
    """
    since = _touched(line["commit"].rstrip("+"), line["files"], tuple(state.files_of(line, told))) if "files" in line else ""
    return (date.fromisoformat(_head()) - date.fromisoformat(since or line["date"][:10])).days


def _days_there(page, part=""):
    """Days since a page or a file of slow tests was added; None if that is not known."""
    added = state.git("log", "--diff-filter=A", "--format=%cs", "--", part if page == "slow" else f"validation/make/{page}.py")
    return (date.fromisoformat(_head()) - date.fromisoformat(added.split()[-1])).days if added else None


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
        dates = sorted(one.date[:10] for one in own if one.date)
        never = sum(not one.date for one in own)
        text = f"{page:24s} {sum(one.rows for one in own):5d} of {rows:5d} rows old, {cost(own)}"
        text += f", of {dates[0]}{f' to {dates[-1]}' if dates[-1] != dates[0] else ''}" if dates else ""
        lines.append(text + (f", {never} never computed" if never else ""))
    total = f"{sum(one.rows for one in old)} of {sum(one.rows for one in found)} rows are old: {cost(old)} to compute again"
    hours = sum(one.seconds or 0.0 for one in found) / 3600
    return [*lines, f"{total}; everything takes {cost(found)}, {hours:.1f} hours of one processor"]


def cost(found):
    """CPU seconds of jobs, as far as they are known."""
    known = [one.seconds for one in found if one.seconds is not None]
    text = f"{sum(known):.0f} CPU s"
    return text if len(known) == len(found) else f"{text} and {len(found) - len(known)} jobs of unknown cost"


def too_old(found, most):
    """What is old for longer than `most` days; what was never computed is as old as it is there."""
    return [one for one in found if one.old and (one.days is None or one.days > most)]


def renew(found, minutes, continued, *, processes=1, alone=()):
    """Compute jobs again, those of earlier code first, then the oldest, as many as fit; the names of those that failed.

    A job whose cost is known begins only if `SLACK` times that fits into what is left, and all are stopped when the time is
    over. What is stopped or fails leaves nothing behind: a job writes beside the pages; its files are moved there, each whole,
    the state last.

    Parameters
    ----------
    found : list of Job
    minutes : float
        Of the clock.
    continued : dict of str to tuple of str
        By job: tables that it would continue where they lie; it is given none of them. One that lies elsewhere than other
        tables is left alone: delete it by hand to compute it again.
    processes : int
        Jobs at a time, each of one thread if there are several; never two of a page, whose tables they would both write.
    alone : tuple of str
        Pages that record times or use all processors: nothing runs beside their jobs.
    """
    signal.signal(signal.SIGTERM, lambda *_: sys.exit("stopped"))  # so that it ends its jobs, too
    end, failed, running = time.monotonic() + 60 * minutes, [], []
    waiting = sorted(found, key=lambda one: (not one.old, one.seconds is None, one.date, one.words))
    longer = [one for one in waiting if any(Path(name).is_absolute() for name in continued.get(" ".join(one.words), ()))]
    waiting = [one for one in waiting if one not in longer]
    try:
        while waiting or running:
            left = end - time.monotonic()
            longer += [one for one in waiting if left <= 0 or SLACK * (one.seconds or 0.0) > left]
            waiting = [one for one in waiting if left > 0 and SLACK * (one.seconds or 0.0) <= left]
            while len(running) < processes and (job := _next(waiting, [one.page for one in running], alone)):
                words = _taken(waiting, job, left)
                running.append(Running(words, len(job.words), continued.get(" ".join(words), ()), processes > 1))
            for one in [one for one in running if one.process.poll() is not None or left <= 0]:
                running.remove(one)
                if one.ended():
                    failed.append(one.name)
            if running:
                time.sleep(0.05)
    finally:
        for one in running:
            one.stop()
    if any(job.old for job in longer):
        print(f"old, and left for another time: {cost([job for job in longer if job.old])}")
    state.stamp()
    return failed


def _next(waiting, busy, alone):
    """First job that may run beside those of the pages that are busy; None if none may."""
    if any(page in alone for page in busy):
        return None
    return next((job for job in waiting if not busy or job.words[0] not in (*busy, *alone)), None)


def _taken(waiting, job, left):
    """Take a job from those that wait, with rows of its page that one process computes along; their words."""
    waiting.remove(job)
    words, load = list(job.words), job.seconds or A_ROW
    for other in [other for other in waiting if job.row and other.row and other.words[:-1] == job.words[:-1]]:
        load += other.seconds or A_ROW
        if load > min(left, AT_ONCE):
            break
        waiting.remove(other)
        words.append(other.words[-1])
    return words


class Running:
    """A job in a process of its own, which writes beside the pages; what it wrote is kept if it ends well.

    Parameters
    ----------
    words : list of str
        Page and part, or parts.
    first : int
        How many of them are the first job's.
    without : tuple of str
        Tables that it is given none of.
    single : bool
        Whether it computes in one thread.
    """

    def __init__(self, words, first, without=(), single=False):
        self.page, more = words[0], len(words) - first
        self.name = f"{' '.join(words[: first - 1])}, {more + 1} rows" if more else " ".join(words)
        self.folder = tempfile.TemporaryDirectory(prefix=".pages.", dir=places.HOME)
        self.beside, self.told = Path(self.folder.name) / "pages", Path(self.folder.name) / "told"
        shutil.copytree(places.PAGES, self.beside)
        self.before = {path.relative_to(self.beside): path.read_bytes() for path in self.beside.rglob("*") if path.is_file()}
        for name in without:
            (self.beside / "tables" / name).unlink(missing_ok=True)
        env = os.environ | {"GEARFE_PAGES": str(self.beside)} | (dict.fromkeys(THREADS, "1") if single else {})
        command = [sys.executable, "-m", "validation", *words]
        with self.told.open("w") as file:
            own = {"cwd": places.ROOT, "env": env, "start_new_session": True}
            self.process = subprocess.Popen(command, **own, stdout=file, stderr=subprocess.STDOUT)

    def ended(self):
        """Keep what an ended job wrote, or stop it; say which, and return its exit code, None if it was stopped."""
        code, told = self.process.poll(), self.told.read_text().splitlines()
        done = next((line for line in told if line.startswith(slow.MISSING)), "computed again")
        if code == 0:
            move(self.beside, places.PAGES, self.before)
            state.stamp()
        print(f"{self.name}: { {0: done, None: 'stopped: the time is over'}.get(code, 'FAILED') }", flush=True)
        if code:
            print("\n".join(told[-15:]), flush=True)
        self.stop()
        return code

    def stop(self):
        """Kill what still runs, and leave nothing behind."""
        with suppress(ProcessLookupError):
            os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()
        self.folder.cleanup()


def move(source, target, before):
    """Move each file that a job changed since `before`, whole, and last the lines of the state that it did."""
    jobs, told = state.read(source / "tables")
    lines = [json.loads(line) for line in before.get(STATE, b"").splitlines()]
    was = {(line["job"], line["table"]): line for line in lines if "job" in line}
    for path in source.rglob("*"):
        name = path.relative_to(source)
        if path.is_file() and name != STATE and path.read_bytes() != before.get(name):
            (target / name).parent.mkdir(parents=True, exist_ok=True)
            os.replace(path, target / name)
    with state.changed() as (known, known_told):
        known_told |= told
        known |= {job: line for job, line in jobs.items() if line != was.get(job)}
        for job in was.keys() - jobs.keys():
            known.pop(job, None)

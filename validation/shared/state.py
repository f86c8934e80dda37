"""What every row was computed with: `pages/tables/state.jsonl`, one line of JSON for each job.

A job is what is computed together: a page, a part of one, a row that is kept by itself, the slow tests of a file. Its line says
the commit, the day, the CPU seconds, the number of rows and, by their keys, the machine with its libraries and the files: all
modules below `CODE` that the process had imported when the job ended, with the functions that it had called (`calls`), and the
data files there that it had opened. `code` is their digest, without comments and docstrings, so that rewording makes no row old.
What made a row on file counts as called once the row is looked into. Modules count whole (`*`) where calls cannot be seen: in a
job that read another table than one of such rows, or times itself (`__main__.ALONE`); and one that started a program that may be
Python is held to have used all modules of both packages. Versions of the libraries are told; a newer one makes no row old.

A run of another program depends on its input alone: its line also says the digest of that `deck`, and it is of the present code
as long as the job `DECKS`, of the present code itself, finds the same one.
"""

import csv
import fcntl
import hashlib
import json
import math
import os
import resource
import subprocess
import sys
import time
from contextlib import contextmanager
from importlib.metadata import version
from pathlib import Path
from types import SimpleNamespace

from . import calls, machine, places
from .calls import WHOLE

CODE = ("geometry", "gearfe", "validation", "tests")
LIBRARIES = ("numpy", "scipy", "gmsh", "scikit-fem", "vtk")
DATA = (".toml", ".csv", ".npz")
MADE = (".csv", ".json", ".npz")  # tables of pages; those of rows kept one by one say what made each row
STARTS = ("subprocess.Popen", "os.fork", "os.posix_spawn", "os.system")
OTHERS = ("git", "ccx", "uname", "chromium", "chromium-browser", "google-chrome")  # programs that start no Python
KEEPERS = ("__init__", "calls", "kept_rows", "machine", "page", "places", "renew", "slow", "state", "table_rows")
ASIDE = {  # they name, find, keep and write: no number depends on them
    *("geometry/__init__.py", "gearfe/__init__.py", "validation/__init__.py", "validation/__main__.py"),
    *(f"validation/shared/{name}.py" for name in KEEPERS),
}
SITE = "gearfe/docs/"  # its scripts are no part of the package: no row depends on them, and a test looks at what they print
DECKS = "three decks"  # writes `decks.csv`
run = SimpleNamespace(  # what this process computes
    job="",  # page and part; empty in tests, where nothing is recorded
    started=math.inf,  # when `watch` was called; since then:
    opened=set(),  # files opened, and "program" if one was started that may be Python
    wrote=set(),  # files written
    tables=set(),  # tables of rows that are kept one by one
    looked=set(),  # rows on file that were looked into: table and key
    brought={},  # what made them: by path, as in `used`
    whole=False,  # whether all modules count whole
    seconds=0.0,  # of the processor for such rows
)


def watch(*, finely=True):
    """Note from now on what this process opens, starts and, if `finely`, calls: loads modules so that they tell."""

    def note(event, words):
        if event == "open":
            path, writes = str(words[0]), bool(set(words[1] or "") & set("wax+"))
            (run.wrote if writes else run.opened).add(path)
            if not writes and path not in run.wrote and path.startswith(str(places.PAGES)) and path.endswith(MADE):
                run.whole |= not path.endswith("decks.csv") and os.path.exists(path)
        elif event == "os.rename":
            run.wrote.add(str(words[1]))
        elif event in STARTS and Path(str(words[0] if words else "")).name not in OTHERS:
            run.opened.add("program")

    run.started = time.time()
    sys.addaudithook(note)
    if finely:
        calls.begin(CODE)


def cpu():
    """CPU seconds of this process and of those it waited for."""
    return sum(sum(resource.getrusage(who)[:2]) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))


def used():
    """What decides what this process has computed, by path below the root: names of the functions called, or that all counts."""
    loaded = {getattr(module, "__file__", None) or "" for module in list(sys.modules.values())}
    loaded |= {path for path in run.opened if path.endswith(DATA)}
    started = "program" in run.opened or any(name.startswith("multiprocessing.popen_") for name in sys.modules)
    if started:
        loaded |= {path for top in CODE[:2] for path in (places.ROOT / top).rglob("*.py")}
    loaded = {calls.below(path) for path in loaded - run.wrote if Path(path).is_file()}
    here = {} if started or run.whole else calls.here()
    own, made = tuple(f"{top}/" for top in CODE), ("validation/pages/", "validation/.pages.", SITE)
    out = {}
    for name in sorted((loaded | here.keys() | run.brought.keys()) - ASIDE):
        if name.startswith(own) and not name.startswith(made):
            words = [run.brought[name]] if name in run.brought else []
            words += [here.get(name, WHOLE)] if name in here or name in loaded else []
            out[name] = WHOLE if run.whole else calls.both(words)
    return out


def bring(table, key):
    """Count what made a row on file as called here: what this process computes from now on may depend on it."""
    if not run.job or (table, key) in run.looked:
        return
    run.looked.add((table, key))
    jobs, told = read()
    rows = {
        job.partition(" ")[2].removeprefix("--reference "): line for (job, name), line in jobs.items() if name == f"{table}.jsonl"
    }
    found = files_of(rows.get(key, {}), told)
    run.whole |= not found  # nobody knows what made it
    for name, words in found.items():
        run.brought[name] = calls.both([words, run.brought.get(name, "")])


def digest(names):
    """Ten hexadecimal digits of what files mean: names of functions by path, as `used` gives them; paths alone count whole."""
    names = names if isinstance(names, dict) else dict.fromkeys(names, WHOLE)
    text = "\n".join(f"{name} {calls.meaning(places.ROOT / name, names[name])}" for name in sorted(names))
    return hashlib.sha256(text.encode()).hexdigest()[:10]


def git(*words):
    """What git prints; nothing outside a repository or where it knows no answer."""
    try:
        return subprocess.run(["git", *words], cwd=places.ROOT, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return ""


def commit():
    """Short name of the commit, with a plus if modules differ from it; empty outside a repository."""
    head = git("rev-parse", "--short=7", "HEAD")
    return head + ("+" if head and git("status", "--porcelain", "--", *CODE, ":!validation/pages") else "")


def read(folder=None):
    """Lines of jobs by job and table, and what their keys stand for; `folder`: other than the tables.

    A merge may leave two lines of a job: the later counts. A line whose table is no longer there says nothing.
    """
    jobs, told = {}, {}
    folder = folder or places.TABLES
    path = folder / "state.jsonl"
    for line in path.read_text(encoding="utf-8").splitlines() if path.is_file() else ():
        one = json.loads(line)
        if "key" in one:
            told[one.pop("key")] = one
        elif one["table"] and not (folder / one["table"]).is_file():
            continue
        elif one["date"] >= jobs.get((one["job"], one["table"]), one)["date"]:
            jobs[one["job"], one["table"]] = one
    path = folder / "decks.csv"
    rows = csv.reader(path.read_text(encoding="utf-8").splitlines() if path.is_file() else ())
    told["decks"] = dict(rows) | {"by": jobs.get((DECKS, ""), {})}
    return jobs, told


def replace(path, text):
    """Write a file so that it is whole at every moment; `gearfe.core.files.written` would load numpy for it."""
    beside = path.with_name(f".{path.name}.{os.getpid()}")
    beside.write_text(text, encoding="utf-8")
    os.replace(beside, path)


@contextmanager
def changed():
    """Jobs and keys, to be changed: written when the block ends, whole; processes wait for each other."""
    places.TABLES.mkdir(exist_ok=True)
    lock = os.open(places.TABLES, os.O_RDONLY)
    try:
        fcntl.flock(lock, fcntl.LOCK_EX)
        jobs, told = read()
        yield jobs, told
        asked = {one[name] for one in jobs.values() for name in ("files", "on") if name in one}
        asked |= {key for name in asked for key in told[name].get("called", {}).values()}
        lines = [json.dumps(jobs[job]) for job in sorted(jobs)]
        lines += [json.dumps({"key": key} | told[key]) for key in sorted(asked)]
        replace(places.TABLES / "state.jsonl", "\n".join([*lines, ""]))
    finally:
        os.close(lock)


def record(job, seconds, rows, page, table="", **more):
    """Write the line of a job that has just ended in this process.

    Parameters
    ----------
    job : str
        The page and its part: what `python -m validation` is given to compute it again.
    seconds : float
        Of the processor.
    rows : int
        How many it computed.
    page : str
        Stem of the Markdown that shows them; empty if none does.
    table : str
        Where rows are kept one by one: of two tables of a page with the same row, each has its line.
    **more
        Anything else to be told.
    """
    names, known = used(), {name: version(name) for name in LIBRARIES}
    late = [name for name in names if (places.ROOT / name).is_file() and (places.ROOT / name).stat().st_mtime > run.started]
    if late:
        raise RuntimeError(f"{', '.join(late)} changed while {job} was computed: compute it again")
    facts = {"files": calls.folded(names), "on": {"machine": machine.describe(), "libraries": known}}
    by_folder = {_key(one): {"calls": one} for one in facts["files"].values()}
    facts["files"] = {"called": {folder: _key(one) for folder, one in facts["files"].items()}}
    keys = {name: _key(fact) for name, fact in facts.items()}
    line = {"job": job, "table": table, "page": page, "rows": rows, "cpu": round(seconds, 1)}
    line["date"] = time.strftime("%Y-%m-%d %H:%M", time.gmtime())
    with changed() as (jobs, told):
        jobs[job, table] = line | {"commit": commit(), "code": digest(names)} | keys | more
        told.update(by_folder | {keys[name]: fact for name, fact in facts.items()})


def files_of(line, told):
    """What was behind a line, as `used` gave it; nothing if unknown. A line of before functions were noted counts files whole.

    A merge of two branches drops a key that one of them no longer needed: then it is unknown.
    """
    fact = told.get(line.get("files"), {})
    if not told.keys() >= set(fact.get("called", {}).values()):
        return {}
    folders = {folder: dict.fromkeys(stems.split(), WHOLE) for folder, stems in fact.get("files", {}).items()}
    folders |= {folder: told[key]["calls"] for folder, key in fact.get("called", {}).items()}
    return {
        f"{folder}/{stem}{'' if '.' in stem else '.py'}": words
        for folder, stems in folders.items()
        for stem, words in stems.items()
    }


def _key(fact):
    return hashlib.sha256(json.dumps(fact).encode()).hexdigest()[:10]


def present(line, told):
    """Whether a line is of the code as it is now, or of a deck that this code writes; not if it does not say of which it is."""
    if "code" in line and line["code"] == digest(files_of(line, told)):
        return True
    return "deck" in line and line["deck"] == told["decks"].get(line["job"]) and present(told["decks"]["by"], told)


def kept(table, key, seconds, **more):
    """Record a row of a table of rows that are kept one by one, if this process computes a page; `more` as of `record`."""
    page, _, part = run.job.partition(" ")
    if page:
        job = f"{run.job} {key}" if part == "--reference" else f"{page} {key}"
        record(job, seconds, 1, page, f"{table}.jsonl", **more)
    run.seconds += seconds


def ended(seconds, tables=()):
    """Record what this process computed as a whole.

    Its rows are those of `tables`, else those of the tables that it wrote, but for rows kept one by one, else of its Markdown.
    """
    page, _, part = run.job.partition(" ")
    there = tables or {path for path in map(Path, run.wrote) if path.parent == places.TABLES and path.is_file()}
    whole = [path for path in there if path.suffix in (".csv", ".jsonl") and path.stem not in (*run.tables, "state")]
    rows = sum(len(path.read_text(encoding="utf-8").splitlines()) - (path.suffix == ".csv") for path in whole)
    shown = part if (places.PAGES / f"{part}.md").is_file() else page
    text = places.PAGES / f"{shown}.md"
    if not rows and not run.tables and text.is_file():
        lines = text.read_text(encoding="utf-8").splitlines()
        rows = sum(line.startswith("|") for line in lines) - 2 * sum(line.startswith("|---") for line in lines)
    if rows or not run.tables:
        record(run.job, seconds - run.seconds, max(rows, 1), shown if text.is_file() else "")
    with changed() as (jobs, _):  # lines of single tables that this one replaces
        for name in [path.name for path in whole] if rows or not run.tables else [""]:  # all of it is kept row by row
            jobs.pop((run.job, name), None)


def first_line(page, jobs, told):
    """How many rows of a page are of the present code."""
    own = [line for line in jobs.values() if line["page"] == page]
    now = sum(line["rows"] for line in own if present(line, told))
    return f"{now} of {sum(line['rows'] for line in own)} rows on the present code"


def without_first_line(page):
    """A page as its maker wrote it."""
    text = (places.PAGES / f"{page}.md").read_text(encoding="utf-8")
    return text.partition("\n\n")[2] if "rows on the present code" in text.partition("\n")[0] else text


def stamp(*, write=True):
    """Bring the first lines of all pages up to date; the names of those that said something else."""
    jobs, told = read()
    out = []
    for page in sorted({line["page"] for line in jobs.values() if (places.PAGES / f"{line['page']}.md").is_file()}):
        path, line = places.PAGES / f"{page}.md", first_line(page, jobs, told)
        if path.read_text(encoding="utf-8").partition("\n")[0] != line:
            out.append(page)
            if write:
                replace(path, f"{line}\n\n{without_first_line(page)}")
    return out

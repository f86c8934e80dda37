"""What every row was computed with: `pages/tables/state.jsonl`, one line of JSON for each job.

A job is what is computed together: a page, a part of one, a row that is kept by itself, the slow tests of a file. Its line says
the commit, the day, the CPU seconds, the number of rows and, by their keys, the machine with its libraries and the files: all
modules below `CODE` that the process had imported when the job ended, and the data files there that it had opened. `code` is
their digest, without comments and docstrings, so that rewording makes no row old. A job that started Python processes of its own
is held to have used all modules of both packages. Versions of the libraries are told; a newer one makes no row old.

A run of another program depends on its input alone: its line also says the digest of that `deck`, and it is of the present code
as long as the job `DECKS`, of the present code itself, finds the same one.
"""

import ast
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
import tomllib
from contextlib import contextmanager
from functools import cache
from importlib.metadata import version
from pathlib import Path
from types import SimpleNamespace

from . import machine, places

CODE = ("geometry", "gearfe", "validation", "tests")
LIBRARIES = ("numpy", "scipy", "gmsh", "scikit-fem", "vtk")
DATA = (".toml", ".csv", ".npz")
KEEPERS = ("__init__", "kept_rows", "machine", "page", "places", "renew", "slow", "state", "table_rows")
ASIDE = {  # they name, find, keep and write: no number depends on them
    *("geometry/__init__.py", "gearfe/__init__.py", "validation/__init__.py", "validation/__main__.py"),
    *(f"validation/shared/{name}.py" for name in KEEPERS),
}
SITE = "gearfe/docs/"  # its scripts are no part of the package: no row depends on them, and a test looks at what they print
DECKS = "three decks"  # writes `decks.csv`
SILENT = {"ctx", "kind", "type_comment"}  # fields of a syntax tree that follow from the rest
run = SimpleNamespace(  # what this process computes
    job="",  # page and part; empty in tests, where nothing is recorded
    started=math.inf,  # when `watch` was called; since then:
    opened=set(),  # files opened, and "python" if one was started
    wrote=set(),  # files written
    tables=set(),  # tables of rows that are kept one by one
    seconds=0.0,  # of the processor for such rows
)


def watch():
    """Note from now on what this process opens and whether it starts Python."""

    def note(event, words):
        if event == "open":
            (run.wrote if set(words[1] or "") & set("wax+") else run.opened).add(str(words[0]))
        elif event == "os.rename":
            run.wrote.add(str(words[1]))
        elif event == "subprocess.Popen" and "python" in Path(str(words[0])).name:
            run.opened.add("python")

    run.started = time.time()
    sys.addaudithook(note)


def cpu():
    """CPU seconds of this process and of those it waited for."""
    return sum(sum(resource.getrusage(who)[:2]) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))


def used():
    """Files that decide what this process has computed, as paths below the root."""
    paths = {getattr(module, "__file__", None) or "" for module in list(sys.modules.values())}
    paths |= {path for path in run.opened if path.endswith(DATA)}
    if "python" in run.opened or any(name.startswith("multiprocessing.popen_") for name in sys.modules):
        paths |= {path for top in CODE[:2] for path in (places.ROOT / top).rglob("*.py")}
    below = {Path(path).resolve() for path in paths - run.wrote if Path(path).is_file()}
    names = {path.relative_to(places.ROOT).as_posix() for path in below if path.is_relative_to(places.ROOT)}
    own, made = tuple(f"{top}/" for top in CODE), ("validation/pages/", "validation/.pages.", SITE)
    return sorted(name for name in names - ASIDE if name.startswith(own) and not name.startswith(made))


def digest(names):
    """Ten hexadecimal digits of what the files mean."""
    return hashlib.sha256("\n".join(f"{name} {meaning(places.ROOT / name)}" for name in sorted(names)).encode()).hexdigest()[:10]


@cache
def meaning(path):
    """Digest of a file: of the syntax tree of a module without docstrings, of the values of a TOML file, else of its bytes."""
    if not path.is_file():
        return "missing"
    text = path.read_bytes()
    if path.suffix == ".py":
        words = []
        _spell(ast.parse(text), words)
        text = " ".join(words).encode()
    elif path.suffix == ".toml":
        text = repr(tomllib.loads(text.decode())).encode()
    return hashlib.sha256(text).hexdigest()


def _spell(node, words):
    """Append a syntax tree without docstrings, unlike `ast.dump` the same in all versions of Python."""
    words.append(type(node).__name__)
    for name in node._fields:
        value = getattr(node, name, None)
        if value is None or value == [] or name in SILENT:
            continue
        words.append(name)
        for one in value if isinstance(value, list) else [value]:
            if not isinstance(one, ast.AST):
                words.append(repr(one))
            elif not _says_nothing(node, one):
                _spell(one, words)
    words.append(")")


def _says_nothing(node, part):
    """Whether a part is a constant that stands alone, as docstrings do, or nothing in an f-string, which Python 3.12.1 adds."""
    if isinstance(part, ast.Expr):
        return isinstance(part.value, ast.Constant)
    return isinstance(node, ast.JoinedStr) and isinstance(part, ast.Constant) and part.value == ""


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
    """Write a file so that it is whole at every moment; `gearfe.files.written` would load numpy for it."""
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
    late = [name for name in names if (places.ROOT / name).stat().st_mtime > run.started]
    if late:
        raise RuntimeError(f"{', '.join(late)} changed while {job} was computed: compute it again")
    folded = {}
    for name in names:
        folder, _, stem = name.rpartition("/")
        folded[folder] = f"{folded.get(folder, '')} {stem.removesuffix('.py')}".strip()
    facts = {"files": {"files": folded}, "on": {"machine": machine.describe(), "libraries": known}}
    keys = {name: hashlib.sha256(json.dumps(fact).encode()).hexdigest()[:8] for name, fact in facts.items()}
    line = {"job": job, "table": table, "page": page, "rows": rows, "cpu": round(seconds, 1)}
    line["date"] = time.strftime("%Y-%m-%d %H:%M", time.gmtime())
    with changed() as (jobs, told):
        jobs[job, table] = line | {"commit": commit(), "code": digest(names)} | keys | more
        told.update({keys[name]: fact for name, fact in facts.items()})


def files_of(line, told):
    """Paths below the root of the files behind a line, none if unknown."""
    folded = told[line["files"]]["files"] if "files" in line else {}
    return [f"{folder}/{stem}{'' if '.' in stem else '.py'}" for folder, stems in folded.items() for stem in stems.split()]


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

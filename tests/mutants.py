"""Mutation score: every listed one-line mutant of the code dies by the ordinary test named for it.

`tests/mutants.toml` lists, for each file, the fragment of a line, what a slip makes of it, and the test that must fail then::

    python -m tests.mutants                        # all of them; exit code 1 if one survives
    python -m tests.mutants gearfe/contact         # those of files whose names start so
    python -m tests.mutants --find gearfe/contact  # run whole files or folders of tests and write down the first test that fails

All work is done in a copy of the repository; files here stay as they are. Each mutant runs in a process of its own.
"""

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path
from queue import SimpleQueue

ROOT = Path(__file__).parents[1]
LIST = Path(__file__).with_suffix(".toml")
COPIED = ("gearfe", "geometry", "tests", "validation", "pyproject.toml", "README.md")
LIMIT = 900.0  # seconds that tests may take
PASSED, FAILED = 0, 1  # exit codes of pytest; any other says that the tests could not be run


@dataclass(frozen=True, slots=True)
class Mutant:
    """A slip in one line.

    Parameters
    ----------
    file : str
        File of the repository.
    was, becomes : str
        Part of a line that occurs once in the file, and what stands there instead.
    test : str
        Test that must fail then, as pytest names it; before `--find` files or folders of tests, or "" for those of the room.
    """

    file: str
    was: str
    becomes: str
    test: str = ""

    def text(self):
        """Text of the mutated file.

        Raises
        ------
        ValueError
            When the line to change is not found, or found more than once.
        """
        text = (ROOT / self.file).read_text(encoding="utf-8")
        if "\n" in self.was or (count := text.count(self.was)) != 1:
            found = "spans lines" if "\n" in self.was else f"occurs {count} times"
            raise ValueError(f"{self.file}: {self.was!r} {found}, but one place is to be changed: write the mutant anew")
        if self.becomes == self.was:
            raise ValueError(f"{self.file}: {self.was!r} becomes itself: write the mutant anew")
        return text.replace(self.was, self.becomes)

    def tests(self):
        """The test named, or the files and folders of tests; those of the file's room when none are."""
        if self.test:
            return re.split(r" (?=(?:tests|gearfe|geometry)/)", self.test)
        top, *_ = Path(self.file).with_suffix("").parts
        inside = self.file.removeprefix(f"{top}/").split("/")
        folder = f"tests/geometry/{inside[0]}" if top == "geometry" else f"tests/{inside[0]}"
        return [folder if (ROOT / folder).is_dir() else "tests"]


def listed(starts=()):
    """Mutants of the list, of files whose names start so."""
    files = tomllib.loads(LIST.read_text(encoding="utf-8"))
    every = [Mutant(file, *row) for file, table in files.items() for row in table["mutants"]]
    return [mutant for mutant in every if mutant.file.startswith(tuple(starts) or "")]


def write(mutants):
    """Write the list."""
    files = {}
    for mutant in mutants:
        row = (mutant.was, mutant.becomes, mutant.test)
        files.setdefault(mutant.file, []).append("  [\n" + "".join(f"    {_quoted(part)},\n" for part in row) + "  ],\n")
    tables = [f'["{file}"]\nmutants = [\n{"".join(rows)}]\n' for file, rows in sorted(files.items())]
    LIST.write_text("\n".join(tables), encoding="utf-8", newline="\n")


def _quoted(text):
    return json.dumps(text, ensure_ascii=False) if "'" in text else f"'{text}'"


def run(tree, tests, *options, **variables):
    """Exit code and output of tests in a copy of the repository, with variables of the environment."""
    command = [sys.executable, "-m", "pytest", "-q", "--tb=no", "-rfE", "-p", "no:cacheprovider", "-p", "no:xdist", *options]
    environment = {**os.environ, "PYTHONPATH": str(tree), "PYTHONDONTWRITEBYTECODE": "1"}  # mutants leave no bytecode
    environment |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "COLUMNS": "1000"} | variables
    try:
        done = subprocess.run([*command, *tests], cwd=tree, env=environment, capture_output=True, text=True, timeout=LIMIT)
    except subprocess.TimeoutExpired:
        return None, f"not done after {LIMIT:g} s"
    return done.returncode, done.stdout + done.stderr


def copy(folder):
    """Copy of the repository in a folder, with the times of its files, for which its bytecode holds."""
    for name in COPIED:
        there = Path(folder) / name
        shutil.copytree(ROOT / name, there, symlinks=True) if (ROOT / name).is_dir() else shutil.copy2(ROOT / name, there)
    return Path(folder)


def judged(mutant, tree):
    """Verdict on a mutant, "killed", "survives" or what hindered its tests, and the first test that fails."""
    place = tree / mutant.file
    place.write_text(mutant.text(), encoding="utf-8", newline="\n")
    code, said = run(tree, mutant.tests(), "-x")
    shutil.copy2(ROOT / mutant.file, place)
    failed = [line.removeprefix("FAILED ").split(" - ")[0] for line in said.splitlines() if line.startswith("FAILED ")]
    if code == FAILED and failed:
        return "killed", failed[0]
    last = said.strip().splitlines()[-1] if said.strip() else ""
    return ("survives" if code == PASSED else f"not run: {last}"), ""


def main():
    """Judge the mutants named; exit code 1 if one survives, or its tests could not be run."""
    parser = argparse.ArgumentParser(prog="python -m tests.mutants", description=__doc__.splitlines()[0])
    parser.add_argument("starts", nargs="*", metavar="FILE", help="files, or how their names start (default: all)")
    parser.add_argument("--find", action="store_true", help="write down the first test that fails, in place of a file or folder")
    parser.add_argument("-n", type=int, default=1, help="mutants judged at a time (default: 1)")
    asked = parser.parse_args()
    mutants = listed(asked.starts)
    if not mutants:
        parser.error(f"no mutant of a file that starts with {' or '.join(asked.starts)}: {LIST.name} lists the files")
    for mutant in mutants:
        mutant.text()
    start = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        trees = SimpleQueue()
        for number in range(asked.n):
            trees.put(copy(Path(folder) / str(number)))
        verdicts = _verdicts(mutants, trees, asked)
    killed = sum(verdict == "killed" for verdict, _ in verdicts)
    used = os.times()
    seconds = used.children_user + used.children_system + used.user + used.system
    print(f"{killed} of {len(mutants)} killed; {seconds:.0f} s of processor, {time.perf_counter() - start:.0f} s")
    if asked.find:
        found = {mutant: test for mutant, (_, test) in zip(mutants, verdicts, strict=True) if test}
        write([replace(mutant, test=found.get(mutant, mutant.test)) for mutant in listed()])
    return int(killed < len(mutants))


def _verdicts(mutants, trees, asked):
    """Verdicts on mutants, told one by one; their tests must pass before."""
    if not asked.find:
        tree = trees.get()
        code, said = run(tree, sorted({test for mutant in mutants for test in mutant.tests()}))
        trees.put(tree)
        if code != PASSED:
            sys.exit(f"{said}\nThe tests named must pass on the code as it is before they can kill a mutant of it.")

    def one(mutant):
        tree, start = trees.get(), time.perf_counter()
        verdict, test = judged(mutant, tree)
        trees.put(tree)
        print(f"{verdict:9}{time.perf_counter() - start:6.1f} s  {mutant.file}: {mutant.was} -> {mutant.becomes}", flush=True)
        print(f"{'':20}{test or ' '.join(mutant.tests())}", flush=True)
        return verdict, test

    with ThreadPoolExecutor(asked.n) as pool:
        return list(pool.map(one, mutants))


if __name__ == "__main__":
    sys.exit(main())

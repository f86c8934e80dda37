"""The list of mutants keeps up with the code: each still changes one line, and the test that must fail then is there.

That they die is judged by `python -m tests.mutants`, which takes minutes.
"""

import subprocess
import sys

import mutants
from conftest import ROOT

LIST = mutants.listed()


def test_every_mutant_changes_one_line():
    """A line that was rewritten asks for another mutant."""
    for mutant in LIST:
        before, after = (ROOT / mutant.file).read_text(encoding="utf-8").splitlines(), mutant.text().splitlines()
        assert sum(one != other for one, other in zip(before, after, strict=True)) == 1, mutant


def test_every_mutant_has_a_test_of_the_ordinary_run():
    names = sorted({name for mutant in LIST for name in mutant.tests()})
    assert all("::" in name for name in names)
    options = ["--collect-only", "-q", "-p", "no:cacheprovider"]
    found = subprocess.run([sys.executable, "-m", "pytest", *options, *names], cwd=ROOT, capture_output=True, text=True)
    assert found.returncode == 0, found.stdout + found.stderr
    assert "deselected" not in found.stdout, "a slow test does not run in the ordinary run"


def test_every_room_has_mutants():
    rooms = {path.parent for top in ("gearfe", "geometry") for path in (ROOT / top).glob("**/__init__.py")}
    rooms -= {ROOT / "gearfe", ROOT / "geometry", ROOT / "gearfe" / "scenes", ROOT / "gearfe" / "energy"}
    bare = rooms - {(ROOT / mutant.file).parent for mutant in LIST}
    assert not bare, bare
    assert len(LIST) == 120
    assert len({(mutant.file, mutant.was, mutant.becomes) for mutant in LIST}) == 120

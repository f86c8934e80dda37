"""The list of mutants keeps up with the code: each still changes one line, and the test that must fail then is there.

That they die is judged by `python -m tests.mutants`, which takes minutes.
"""

import ast
from functools import cache

import mutants
from conftest import ROOT

LIST = mutants.listed()


def test_every_mutant_changes_one_line():
    """A line that was rewritten asks for another mutant."""
    for mutant in LIST:
        before, after = (ROOT / mutant.file).read_text(encoding="utf-8").splitlines(), mutant.text().splitlines()
        assert sum(one != other for one, other in zip(before, after, strict=True)) == 1, mutant


def test_every_mutant_has_a_test_of_the_ordinary_run():
    """Its function is there and no slow one; whether its parameters are, the command says, which runs it."""
    for name in sorted({name for mutant in LIST for name in mutant.tests()}):
        file, _, test = name.partition("::")
        own = functions(file).get(test.partition("[")[0].rpartition(".")[2])
        assert own is not None, f"{name} is not there: find another test that kills the mutant"
        assert "mark.slow" not in "".join(map(ast.unparse, own.decorator_list)), f"{name} does not run in the ordinary run"


@cache
def functions(file):
    """Functions of a file by name."""
    tree = ast.parse((ROOT / file).read_text(encoding="utf-8"))
    return {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}


def test_every_room_has_mutants():
    rooms = {path.parent for top in ("gearfe", "geometry") for path in (ROOT / top).glob("**/__init__.py")}
    rooms -= {
        ROOT / "gearfe",
        ROOT / "geometry",
        *(ROOT / "gearfe" / name for name in ("scene/scenes", "flexibility/energy", "runs", "core", "dynamics")),
    }
    bare = rooms - {(ROOT / mutant.file).parent for mutant in LIST}
    assert not bare, bare
    assert len(LIST) >= 162  # none goes without another in its place
    assert len({(mutant.file, mutant.was, mutant.becomes) for mutant in LIST}) == len(LIST)

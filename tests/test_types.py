"""The public surface is fully typed: every name of `gearfe`, and every class that these take or give."""

import ast
import inspect
import subprocess
import sys
from collections.abc import Callable
from dataclasses import fields, is_dataclass
from functools import cache, cached_property
from typing import get_args, get_type_hints

import numpy as np
import pytest
from conftest import ROOT

import gearfe
from gearfe.core.case import NAMES
from gearfe.stiffness.mesh_stiffness import StiffnessOptions
from gearfe.stiffness.solve import OPTIONS

pytestmark = pytest.mark.quick

OURS = ("geometry.", "gearfe.")
BARE = (np.ndarray, tuple, list, dict)  # without what is in them they say too little
SPECIAL = ("__init__", "__call__", "__getitem__", "__iter__", "__len__")


@cache
def only_for_checkers(module):
    """Names that a module imports under ``if TYPE_CHECKING:``, so that they cost nothing at run time."""
    found = {}
    for node in ast.parse(inspect.getsource(sys.modules[module])).body:
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
            package = {"__package__": sys.modules[module].__package__, "__name__": module}
            exec(compile(ast.Module(node.body, []), module, "exec"), package, found)
    return found


def hints_of(one):
    """Annotations of a function or class, every name in them resolved."""
    return get_type_hints(one, localns=only_for_checkers(inspect.unwrap(one).__module__))


def parts(hint):
    """A hint and everything inside it."""
    yield hint
    for arg in get_args(hint):
        for inner in arg if isinstance(arg, list) else (arg,):
            yield from parts(inner)


def lacking(function):
    """Parameters of a function without a type, or with one that says too little."""
    hints = hints_of(function)
    names = [name for name in inspect.signature(function).parameters if name not in ("self", "cls")]
    wanted = [*names, "return"]
    return [name for name in wanted if name not in hints or any(part in BARE for part in parts(hints[name]))]


def functions_of(cls):
    """Public methods and properties that a class defines itself, by name."""
    for name, value in vars(cls).items():
        if name.startswith("_") and (name not in SPECIAL or (name == "__init__" and is_dataclass(cls))):
            continue
        inner = {property: "fget", classmethod: "__func__", staticmethod: "__func__", cached_property: "func"}.get(type(value))
        function = getattr(value, inner) if inner else value
        if inspect.isfunction(function) and function.__module__ == cls.__module__:
            yield name, function


def untyped(public):
    """What a function or class leaves open, as text; empty if nothing."""
    if not inspect.isclass(public):
        return [f"{public.__name__}: {name}" for name in lacking(public)]
    out = [f"{public.__name__}.{name}: {one}" for name, function in functions_of(public) for one in lacking(function)]
    if is_dataclass(public):
        hints = hints_of(public)
        names = [one.name for one in fields(public)]
        out += [f"{public.__name__}.{name}" for name in names if any(part in BARE for part in parts(hints[name]))]
    return out


def classes_in(public):
    """Classes of ours in the types of a function, or of the fields and methods of a class."""
    functions = [public] if not inspect.isclass(public) else [function for _, function in functions_of(public)]
    hints = [hint for one in (*functions, *([public] if inspect.isclass(public) else [])) for hint in hints_of(one).values()]
    found = (part for hint in hints for part in parts(hint))
    return {part for part in found if inspect.isclass(part) and part.__module__.startswith(OURS)}


@pytest.mark.parametrize("name", gearfe.__all__)
def test_public_name_is_typed(name):
    assert untyped(getattr(gearfe, name)) == []


def test_what_public_names_take_and_give_is_typed():
    named = {getattr(gearfe, name) for name in gearfe.__all__}
    known, waiting = set(named), list(named)
    while waiting:
        new = classes_in(waiting.pop()) - known
        known |= new
        waiting += new
    assert {"Spectrum", "Contact3D", "Intensity", "Steady", "Scene"} <= {one.__name__ for one in known}
    assert [text for one in known - named for text in untyped(one)] == []


def test_an_untyped_function_is_found():
    def half(width, height: float, *, sides: tuple = (), done: Callable[[dict], int] = len) -> np.ndarray:
        return width, height, sides, done

    assert lacking(half) == ["width", "sides", "done", "return"]


def test_packages_say_that_they_are_typed():
    assert all((ROOT / package / "py.typed").is_file() for package in ("gearfe", "geometry"))


WRONG = {  # lines of a user's program, and what mypy must say of each
    "gf.mesh_stiffness(pair, 2000.0, phases=16, span='tooth', error=True, damage={'pinion': [gf.Crack(level=0.3)]})": "",
    "gf.mesh_stiffness(pair, 2000.0, phase=16)": 'keyword argument "phase"',
    "gf.mesh_stiffness(pair, 2000.0, refine='fine')": 'No overload variant of "mesh_stiffness"',
    "gf.transmission_error(pair, [1.0], pose='pinion', misalignment=gf.Misalignment())": "",
    "gf.transmission_error(pair, [1.0], posed='pinion')": 'keyword argument "posed"',
    "gf.force_law(pair, [1.0, 2.0], flanks={'wheel': gf.Flank()}, refine=2.0)": "",
    "gf.force_law(pair, [1.0, 2.0], flank={})": 'keyword argument "flank"',
    "gf.converged_force_law(pair, 1.0, 2.0, groove='4 mm')": 'expected "float"',
    "gf.contact_pattern(pair, 1.0, face='spur', phases=[0.5])": "",
    "gf.contact_pattern(pair, 1.0, method='ritz3d')": 'keyword argument "method"',
    "gf.compare(pair, force=1.0, material=gf.Material())": "",
    "gf.compare(pair, forces=1.0)": 'keyword argument "forces"',
    "gf.write_contact_inp('a.inp', pair, 0.5, 0.01, 100.0, penalty=50.0, pits='cut')": "",
    "gf.write_contact_inp('a.inp', pair, 0.5, 0.01, 100.0, penalties=50.0)": 'keyword argument "penalties"',
    "gf.indicator_table({}, harmonics=2)": "",
    "gf.indicator_table({}, harmonic=2)": 'keyword argument "harmonic"',
}


@pytest.mark.slow
def test_type_checkers_know_every_option(tmp_path):
    """An editor completes the options, and mypy rejects a misspelt one."""
    program = tmp_path / "program.py"
    program.write_text("import gearfe as gf\n\npair: gf.GearPair\n" + "\n".join(WRONG) + "\n", encoding="utf-8")
    command = [
        sys.executable,
        "-m",
        "mypy",
        "--config-file",
        str(ROOT / "pyproject.toml"),
        "--cache-dir",
        str(ROOT / ".mypy_cache"),
    ]
    out = subprocess.run([*command, str(program)], cwd=ROOT, capture_output=True, text=True).stdout
    for line, (text, message) in enumerate(WRONG.items(), 4):
        said = [row for row in out.splitlines() if row.startswith(f"{program}:{line}:")]
        assert bool(said) == bool(message), (text, said or out)
        assert message in "".join(said), text


def test_options_are_those_of_case_and_solve():
    """Names and types of the options of functions are those of the fields of `Case` and `Solve`."""
    whole = hints_of(gearfe.Case) | hints_of(gearfe.Solve)
    options = hints_of(StiffnessOptions)
    assert set(options) == {*NAMES, *OPTIONS} - {"pair", "force", "material", "torque"}
    assert {name: whole[name] for name in options} == options

"""Rules for argument types: permitted values, and conversion to plain values."""

import dataclasses
import functools
import inspect
import os
import types
import typing
from collections.abc import Callable, Collection, Iterable, Mapping
from typing import Any, NamedTuple

import numpy as np

from ..geometry.checks import WrongTypeError, shown
from .checks import has_truth, number, truth, whole


def _number(name, value):
    """Return a number as a float, or unchanged if it is an int."""
    out = number(name, value)
    return value if type(value) is int else out


PLAIN = {float: _number, int: whole, bool: truth}
WORDS = {float: "a number", int: "a whole number", bool: "True or False", str: "a text", type(None): "None"}
WORDS[os.PathLike] = "a path"
MADE = {  # functions that return these records; not all are public names
    "Machine": "gf.build_machine(scene), gf.single_mesh(...), gf.planetary(...)", "Scene": "gf.load_scene(name)",
    "StiffnessCurve": "gf.mesh_stiffness(pair, force, material)", "Response": "gf.simulate(machine, duration)",
    "SetCurves": "gf.planetary_stiffness(case)", "Runs": "gf.open_runs(folder)", "Dataset": "gf.open_dataset(folder)",
    "ForceLaw": "gf.force_law(pair, forces, material)", "Contact3D": "gf.contact_pattern(pair, force, material)",
    "Spectrum": "gf.spectrum(signal)", "Spectrogram": "gf.spectrogram(signal)", "Kurtogram": "gf.fast_kurtogram(signal)",
    "Campbell": "gf.campbell(machine, speeds)",
}  # fmt: skip
NUMERIC = {"f": "iuf", "i": "iu"}  # kinds of arrays accepted for arrays of floats and of integers


class Rule(NamedTuple):
    """Name of a type in words, and a function that converts a value to this type or raises ValueError."""

    words: str
    settled: Callable[[str, Any], Any]


class NamedClass(type):
    """A class given by its name, because its module is loaded only by users of an instance."""

    def __instancecheck__(cls, value):
        return any(base.__name__ == cls.__name__ for base in type(value).__mro__)


def rule_of(hint):
    """Return the rule of a type, or None if any value is permitted."""
    origin, inner = typing.get_origin(hint), typing.get_args(hint)
    if hint is Any:
        return None
    if hint in PLAIN:
        return Rule(WORDS[hint], PLAIN[hint])
    if origin in (typing.Union, types.UnionType):
        return _union(inner)
    if origin is np.ndarray:
        return Rule("an array of real numbers", functools.partial(_array, "i" if "int" in str(inner[1]) else "f"))
    if not isinstance(origin, type):
        plain = isinstance(hint, type) and not getattr(hint, "_is_protocol", False)
        return _instance(hint) if plain else None
    if origin is Callable:
        return Rule("a function", functools.partial(_is_a, Callable, "a function"))
    if issubclass(origin, Iterable):
        return _row_of(origin, inner)
    return _instance(origin)


def _row_of(origin, inner):
    """Return the rule of a mapping, of a row of fixed length, or of a sequence."""
    if issubclass(origin, Mapping):
        return _mapping(inner)
    if origin is tuple and inner[-1:] != (...,):
        return _row([rule_of(one) for one in inner])
    return _sequence(rule_of(inner[0]), Iterable if origin is Iterable else Collection, tuple if origin is tuple else None)


def _union(inner):
    """Return the rule of a union. A union with a type of numpy accepts everything that can be an array."""
    numpy_types = ("numpy._typing", "<class 'numpy._typing")
    if any(str(one).startswith(numpy_types) for one in inner):
        return Rule("numbers", _even)
    return _any_of([rule_of(one) for one in inner])


def _any_of(rules):
    if None in rules:
        return None

    *first, last = dict.fromkeys(rule.words for rule in rules)
    words = f"{', '.join(first)} or {last}" if first else last
    # Classes come first, because some of them are also sequences of numbers.
    classes_first = sorted(rules, key=lambda rule: "number" in rule.words)

    def settled(name, value):
        misfit = None
        for rule in classes_first:
            try:
                return rule.settled(name, value)
            except ValueError as error:  # An error about an element, or about a value of the right type, is more specific.
                general = isinstance(error, WrongTypeError) and str(error).startswith(f"{name} = ")
                misfit = misfit if general else error
        raise misfit or _wrong(name, value, words)

    return Rule(words, settled)


def _instance(kind):
    """Return the rule of a class. Its message states how an instance is created."""
    words = WORDS.get(kind, f"{'an' if kind.__name__[0] in 'AEIOU' else 'a'} {kind.__name__}")
    made = inspect.signature(kind).parameters.values() if dataclasses.is_dataclass(kind) else ()
    needs = ", ".join(one.name for one in made if one.default is one.empty)
    how = MADE.get(kind.__name__, f"gf.{kind.__name__}({needs})" if needs else "")
    return Rule(words, functools.partial(_is_a, kind, f"{words}: {how}" if how else words))


def _is_a(kind, words, name, value):
    if not isinstance(value, kind):
        raise _wrong(name, value, words)
    if kind is str and "\0" in value:
        raise ValueError(f"{name} = {shown(value)}, but give a text without zero bytes")
    return value


def _array(kind, name, value):
    try:
        out = np.asarray(value)
        if not out.ndim or has_truth(value) or out.dtype.kind not in NUMERIC[kind]:
            raise ValueError
    except ValueError:
        raise _wrong(name, value, "an array of real numbers") from None
    return out.astype(float, copy=False) if kind == "f" else out


def _even(name, value):
    """Return a value that can be converted to an array. The functions convert it themselves."""
    try:
        np.ndim(value)
    except ValueError:
        raise ValueError(f"{name} = {shown(value)}, but give rows of one length") from None
    return value


def _sequence(rule, kind, made):
    words = f"a list, each entry {rule.words}" if rule else "a list"

    def settled(name, value):
        if (
            not isinstance(value, kind)
            or isinstance(value, (str, bytes, Mapping, set, frozenset))
            or not getattr(value, "ndim", 1)
        ):
            raise _wrong(name, value, words)
        if rule and type(value) in (list, tuple):
            return (made or type(value))([rule.settled(name, one) for one in value])
        if (
            rule
            and isinstance(value, np.ndarray)
            and (value.ndim > 1 or value.dtype.kind not in "iuf" or "number" not in rule.words)
        ):
            raise _wrong(name, value, words)
        return value

    return Rule(words, settled)


def _row(rules):
    words = f"a list of {len(rules)}"

    def settled(name, value):
        if (
            isinstance(value, (str, bytes, Mapping, set, frozenset))
            or not isinstance(value, Collection)
            or not _is_row(value, len(rules))
        ):
            raise _wrong(name, value, words)
        return tuple(rule.settled(name, one) if rule else one for rule, one in zip(rules, value, strict=True))

    return Rule(words, settled)


def _is_row(value, size):
    return getattr(value, "ndim", 1) == 1 and len(value) == size


def _mapping(inner):
    rule = rule_of(inner[1])
    words = f"a dict, each value {rule.words}" if rule else "a dict"
    words = "a dict by gear: {'pinion': [gf.Crack(level=0.3)]}" if "Crack" in words else words

    def settled(name, value):
        if not isinstance(value, Mapping):
            raise _wrong(name, value, words)
        for key, one in value.items() if rule else ():
            if one is not None:  # None means missing. A single record counts as a list of one.
                alone = rule.words.startswith("a list") and dataclasses.is_dataclass(one)
                rule.settled(f"{name}[{key!r}]", [one] if alone else one)
        return value

    return Rule(words, settled)


def _wrong(name, value, words):
    return WrongTypeError(f"{name} = {shown(value)}, but give {words}")

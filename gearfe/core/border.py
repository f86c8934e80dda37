"""Argument checks of public functions and records. Arguments are compared with their annotations and converted to plain numbers.

Numbers of any type become floats, lists become arrays where arrays are expected. Masked values, truth values as numbers, nan,
and in functions infinity without an infinite default are rejected. The function itself checks the meaning of a value.
"""

import dataclasses
import functools
import inspect
import math
import sys
import types
import typing
from typing import Any

import numpy as np

from .checks import checked_refine
from .stated_shapes import check_stated
from .type_rules import MADE, NamedClass, Rule, rule_of

# arguments with the same meaning in all functions
BY_NAME = {"refine": Rule("a number", lambda _, value: checked_refine(value))}


class _Public(dict[str, Any]):
    """Namespace that resolves public names of gearfe in annotations."""

    def __missing__(self, name):
        package = sys.modules[__name__.partition(".")[0]]
        if name in package.__all__:
            return getattr(package, name)
        if name in MADE:
            return NamedClass(name, (), {})
        raise KeyError(name)


@functools.cache
def bordered(public: Any, name: str) -> Any:
    """Return a public function that checks its arguments first.

    Records are checked when they are built, and passed on unchanged.
    """
    if inspect.isfunction(public):
        out = _checked(public, name)
        out.__module__, out.__qualname__ = "gearfe", name  # Other processes import the class from that module.
        return out
    if "__init__" in vars(public) and not issubclass(public, BaseException):
        public.__init__ = _checked(public.__init__, name, record=True)
    return public


def _checked(function, called, record=False):
    rules: list[Any] = []

    @functools.wraps(function)
    def checked(*args, **options):
        if not rules:
            rules.append(_rules(function, called))  # Two threads may append at the same time; their rules are equal.
        places, named = rules[0]
        try:
            given = [_settled(*rule, value, record) for rule, value in zip(places, args, strict=False)]
            stated = {key: _settled(*named[key], value, record) if key in named else value for key, value in options.items()}
        except ValueError as misfit:
            if record:  # The message of the record states unit and range.
                _own_message(function, args, options, type(misfit))
            raise
        out = function(*given, *args[len(places) :], **stated)
        if record and dataclasses.is_dataclass(args[0]):
            check_stated(args[0])
        elif not record:
            _guard(type(out))
        return out

    return checked


@functools.cache
def _guard(kind):
    """Load the public name of the type of a result, so that copies with changed values are checked (`dataclasses.replace`)."""
    package = sys.modules[__name__.partition(".")[0]]
    if dataclasses.is_dataclass(kind) and kind.__name__ in package.__all__:
        getattr(package, kind.__name__)


def _own_message(function, args, options, kind):
    """Run the record's own check of its arguments, and raise the error of this check as an exception of this `kind`."""
    try:
        function(*args, **options)
    except ValueError as error:
        raise kind(error) from None
    except (TypeError, AttributeError, LookupError, ArithmeticError):
        pass


def _settled(name, rule, default, value, infinite):
    """Check an argument, and return the value to be passed on.

    The default is accepted whatever its annotation. Infinite numbers are rejected unless `infinite` is true or the default is
    infinite.
    """
    if value is default:
        return value
    if isinstance(value, np.ma.MaskedArray) and np.ma.is_masked(value):
        raise ValueError(f"{name} has masked values: give numbers without masked entries")
    if rule is None:
        return value
    out = rule.settled(name, value)
    if type(out) is float and not math.isfinite(out) and not infinite and default != math.inf:
        raise ValueError(f"{name} = {out}, but give a finite number")
    return out


def _rules(function, called):
    """Return name, rule and default of all parameters, once by position and once by name."""
    places, named = [], {}
    for parameter in inspect.signature(function).parameters.values():
        hint = _hint(function, parameter.annotation)
        row = (f"{called}: {parameter.name}", _named(parameter.name, hint), parameter.default)
        if parameter.kind in (parameter.POSITIONAL_ONLY, parameter.POSITIONAL_OR_KEYWORD):
            places.append(row)
        if parameter.kind in (parameter.KEYWORD_ONLY, parameter.POSITIONAL_OR_KEYWORD):
            named[parameter.name] = row
        if parameter.kind is parameter.VAR_KEYWORD and hint is not None:
            table = next(iter(typing.get_args(hint)), hint)
            hints = typing.get_type_hints(table) if hasattr(table, "__total__") else {}
            named |= {key: (f"{called}: {key}", _named(key, value), parameter.empty) for key, value in hints.items()}
    return places, named


def _hint(function, annotation):
    """Return an annotation as a type, or None if it is missing or contains names that are not public."""
    if annotation is inspect.Parameter.empty:
        return None
    holder = types.SimpleNamespace(__annotations__={"it": annotation})
    try:
        return typing.get_type_hints(holder, function.__globals__, _Public())["it"]
    except NameError:
        return None


def _named(name, hint):
    """Return the rule of a parameter. A single number has the rule of its name, other parameters that of their type."""
    if name in BY_NAME and hint in (None, float):
        return BY_NAME[name]
    return None if hint is None else rule_of(hint)

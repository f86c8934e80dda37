"""Former names of public classes, functions, arguments and attributes, with a DeprecationWarning that gives the new name."""

import functools
import warnings
from collections.abc import Callable
from typing import Any, TypeVar

T = TypeVar("T")


def warn_renamed(old: str, new: str, kind: type[Warning] = DeprecationWarning, stacklevel: int = 3) -> None:
    """Warn that a name was replaced, and give the new name."""
    warnings.warn(f"{old} is now {new}: the old name will be removed in the next version", kind, stacklevel=stacklevel)


def renamed(**names: str) -> Callable[[T], T]:
    """Return a decorator that accepts former names of arguments, and of attributes of a class.

    Parameters
    ----------
    **names : str
        New name by former name.
    """

    def decorated(target: Any) -> Any:
        if not isinstance(target, type):
            return _with_arguments(target, names)
        target.__init__ = _with_arguments(target.__init__, names)  # type: ignore[misc]
        for old, new in names.items():
            setattr(target, old, _attribute(target.__name__, old, new))
        return target

    return decorated


def _with_arguments(function: Any, names: dict[str, str]) -> Any:
    @functools.wraps(function)
    def called(*args: Any, **kwargs: Any) -> Any:
        for old in names.keys() & kwargs.keys():
            warn_renamed(old, names[old])
            kwargs[names[old]] = kwargs.pop(old)
        return function(*args, **kwargs)

    return called


def _attribute(owner: str, old: str, new: str) -> property:
    def read(self: Any) -> Any:
        warn_renamed(f"{owner}.{old}", new)
        return getattr(self, new)

    return property(read, doc=f"Former name of `{new}`.")

"""Cache of function results by their arguments. Arrays in the results are read-only."""

from collections.abc import Callable
from functools import lru_cache, wraps
from types import SimpleNamespace
from typing import Any, ParamSpec, TypeVar

import numpy as np

P = ParamSpec("P")
R = TypeVar("R")


def keeping(most: int) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Decorate a function to store its last `most` results. Their arrays are set read-only.

    Two threads that request the same result at the same time can both compute it. The numbers are identical.
    """

    def decorate(function: Callable[P, R]) -> Callable[P, R]:
        @wraps(function)
        def sealed(*args: P.args, **kwargs: P.kwargs) -> R:
            out = function(*args, **kwargs)
            seal(out)
            return out

        return lru_cache(maxsize=most)(sealed)  # type: ignore[return-value]

    return decorate


def seal(value: Any) -> None:
    """Set arrays read-only, also those in tuples, lists and namespaces."""
    if isinstance(value, np.ndarray):
        value.flags.writeable = False
    elif isinstance(value, (tuple, list)):
        for part in value:
            seal(part)
    elif isinstance(value, SimpleNamespace):
        seal(list(vars(value).values()))

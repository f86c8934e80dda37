"""Progress of long computations for listeners such as the progress bar of the command line.

Progress within a part is scaled to that part, so that one bar runs once from start to end.
"""

import contextlib
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextvars import ContextVar
from typing import NamedTuple, TypeVar

from .time_limit import Clock

T = TypeVar("T")


class _Range(NamedTuple):
    """Listener of progress, and the part of the whole work, from `low` to `high`, that is being computed."""

    listener: Callable[[str, float], object]
    low: float
    high: float


_range: ContextVar[_Range | None] = ContextVar("range", default=None)


@contextlib.contextmanager
def listening(listener: Callable[[str, float], object]) -> Iterator[None]:
    """Within the block, call `listener` before each part with a text and the completed part of the work, 0 to 1."""
    token = _range.set(_Range(listener, 0.0, 1.0))
    try:
        yield
    finally:
        _range.reset(token)


def is_heard() -> bool:
    """Return whether a listener receives the progress of the present work."""
    return _range.get() is not None


@contextlib.contextmanager
def part(text: str, low: float, high: float) -> Iterator[None]:
    """Declare the block as the part of the work from `low` to `high`, both 0 to 1. An empty text keeps the former text."""
    whole = _range.get()
    if whole is None:
        yield
        return
    low, high = (whole.low + (whole.high - whole.low) * share for share in (low, high))
    whole.listener(text, low)
    inner = _Range(whole.listener, low, high)
    _range.set(inner)
    try:
        yield
    finally:
        if _range.get() is inner:  # An abandoned iterator ends late, when the listener may have left already.
            _range.set(whole)


def reached(text: str, share: float) -> None:
    """Report that this share of the work, 0 to 1, is done. Use it for work that is not a list of items."""
    whole = _range.get()
    if whole is not None:
        whole.listener(text, whole.low + (whole.high - whole.low) * share)


def steps(items: Iterable[T], text: str | Callable[[T], str] = "", weights: Sequence[float] | None = None) -> Iterator[T]:
    """Yield the items one after the other, each as a part of the work.

    Parameters
    ----------
    items : iterable
    text : str or callable
        What is said before each item, or ``text(item)``.
    weights : sequence of float, optional
        What each item costs, in any unit; default: all the same.

    Yields
    ------
    item

    Raises
    ------
    ValueError
        If the first items show that all of them would exceed the limit of `gearfe.core.time_limit`.

    Examples
    --------
    >>> said = []
    >>> with listening(lambda text, done: said.append((text, round(done, 3)))):
    ...     for gear in steps(["pinion", "wheel"], lambda gear: gear, weights=[3, 1]):
    ...         for _ in steps([1, 2]):
    ...             pass
    >>> said
    [('pinion', 0.0), ('', 0.0), ('', 0.375), ('wheel', 0.75), ('', 0.75), ('', 0.875)]
    """
    items = list(items)
    cost = [1.0] * len(items) if weights is None else list(weights)
    done, clock = 0.0, Clock()
    for item, weight in zip(items, cost, strict=True):
        with part(text(item) if callable(text) else text, done / sum(cost), (done + weight) / sum(cost)):
            yield item
        done += weight
        clock.check(f"{len(items)} steps of this work", done / sum(cost), "give fewer or coarser ones")

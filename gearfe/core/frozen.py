"""Read-only, hashable copies of the arguments of a `Case` or a `Solve`."""

from collections.abc import Iterator, Mapping
from typing import Any


class Frozen(Mapping[Any, Any]):
    """Immutable mapping. It equals a dict with the same entries, and is hashable if its values are hashable.

    Parameters
    ----------
    entries : Mapping
        Is copied.
    """

    __slots__ = ("_entries",)

    def __init__(self, entries: Mapping[Any, Any]) -> None:
        self._entries = dict(entries)

    def __getitem__(self, name: Any) -> Any:
        return self._entries[name]

    def __iter__(self) -> Iterator[Any]:
        return iter(self._entries)

    def __len__(self) -> int:
        return len(self._entries)

    def __or__(self, more: Mapping[Any, Any]) -> dict[Any, Any]:
        return self._entries | dict(more)

    def __hash__(self) -> int:
        return hash(frozenset(self._entries.items()))

    def __repr__(self) -> str:
        return repr(self._entries)


def frozen(value: Any) -> Any:
    """Return an immutable copy: lists and arrays as tuples, dicts as `Frozen`."""
    if isinstance(value, Mapping):
        return Frozen({name: frozen(entry) for name, entry in value.items()})
    if isinstance(value, (list, tuple)):
        return tuple(map(frozen, value))
    return frozen(value.tolist()) if hasattr(value, "tolist") else value

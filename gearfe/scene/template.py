"""Scene file from tables and the schema, in which all unused keys are comment lines.

A commented key or table begins with # and no space. It becomes valid without the #. Text begins with # and a space.
"""

from collections.abc import Iterator, Mapping
from typing import Any

from .schema import Key, KeyTable, scene_schema
from .toml_file import toml_value

Tables = Mapping[str, Any]


def template(stated: Tables, asleep: Tables, numbers: Mapping[str, float], notes: Mapping[str, str]) -> str:
    """Return the text of a scene file.

    Parameters
    ----------
    stated : dict
        Tables of the scene.
    asleep : dict
        Tables that are written as comments, with the values in which they differ from the examples of the schema.
    numbers : dict
        Numbers that suit the scene, for the examples of the schema.
    notes : dict
        Further comments by key.
    """
    lines: list[str] = []
    for key in scene_schema()["scene"].keys.values():
        if not key.of:
            lines += [f"{key.name} = {toml_value(stated[key.name])}  # {key.text}"] if key.name in stated else []
        elif key.name in stated or key.name in asleep:
            table = scene_schema()[key.of]
            lines += ["", *(f"# {line}".rstrip() for line in table.about.splitlines())]
            rows = [(heading, row, "") for heading, row in _rows(key, stated)] + [(h, row, "#") for h, row in _rows(key, asleep)]
            full = next((i for i, (*_, mark) in enumerate(rows) if mark), 0)
            for i, (heading, row, mark) in enumerate(rows):
                lines += [
                    f"{mark}{heading}",
                    *_lines(table, row, mark, notes, numbers if i == full else None),
                    *([""] if not mark else []),
                ]
        elif key.other:
            lines += ["", f"# {key.heading()}: {key.text}, with {', '.join(scene_schema()[key.of].keys)}"]
    return "\n".join(lines).replace("\n\n\n", "\n\n").strip() + "\n"


def _rows(key: Key, tables: Tables) -> Iterator[tuple[str, Tables]]:
    """Return heading and values of each table of a kind."""
    found = tables.get(key.name)
    if found is None:
        return
    if key.type == "named":
        yield from ((f"[{key.name}.{name}]", row) for name, row in found.items())
    else:
        yield from ((key.heading(), row) for row in (found if key.type == "listed" else [found]))


def _lines(
    table: KeyTable, row: Tables, mark: str, notes: Mapping[str, str], numbers: Mapping[str, float] | None
) -> Iterator[str]:
    """Return the lines of a table: keys of its `row`, and with `numbers` all other keys as comments with examples."""
    for key in table.keys.values():
        if key.name in row:
            note = f"; {notes[key.name]}" if key.name in notes and not mark else ""
            yield f"{mark}{key.name} = {toml_value(row[key.name])}" + (f"  # {key.text}{note}" if numbers or note else "")
        elif numbers and not key.of:
            value = (
                key.example.format(**numbers) if key.example else "..." if key.default in (None, []) else toml_value(key.default)
            )
            without = f"; left out: {key.optional}" if key.optional else ""
            yield f"#{' ' if key.other else ''}{key.name} = {value}  # {key.text}{without}"
        elif numbers:
            inner = scene_schema()[key.of]
            if key.other:
                yield f"# {key.heading(table.name)}: {key.text}, with {', '.join(inner.keys)}"
            else:
                yield f"#{key.heading(table.name)}  # {key.text}"
                yield from _lines(inner, {}, "#", {}, numbers)

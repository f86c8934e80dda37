"""Description of a schema: a Markdown page of all keys, and a JSON schema for editors."""

import json
from collections.abc import Mapping
from typing import Any

from .schema import LISTS, REQUIRED, Key, KeyTable
from .toml_file import toml_value

JSON_TYPES = {"number": "number", "integer": "integer", "boolean": "boolean", "values": "object"}
HEAD = """\
# Keys of scenes, studies and data sets

A scene is checked key by key against this list, which `gearfe schema --page` prints. The unit of a key is the end of its name.
`gearfe schema > scene.schema.json` writes the same as a JSON schema. An editor with a TOML language server (taplo; VS Code with
Even Better TOML) completes and checks keys by it, if the first line of a scene is `#:schema scene.schema.json`.
"""


def keys_page(*schemas: Mapping[str, KeyTable]) -> str:
    """Return the page of all tables and keys of some schemas."""
    parts = [HEAD]
    for schema in schemas:
        places = _places(schema)
        for name, table in schema.items():
            about = table.about.strip().splitlines()[0]
            rows = [f"| `{key.name}` | {_kind(key)} | {_default(key)} | {key.text} |" for key in table.keys.values()]
            heading = f"`{places[name]}`" if name in places else name.capitalize().replace("_", " ")
            parts.append(
                f"\n## {heading}\n\n{about}\n\n| key | type and range | left out | description |\n|---|---|---|---|\n"
                + "\n".join(rows)
                + "\n"
            )
    return "".join(parts).rstrip("\n")


def _places(schema: Mapping[str, KeyTable]) -> dict[str, str]:
    """Return the positions in a file of the nested tables of a schema, by table name."""
    out: dict[str, str] = {}
    for name, table in schema.items():
        out |= {key.of: key.heading(out.get(name, "").strip("[]")) for key in table.keys.values() if key.of}
    return out


def _kind(key: Key) -> str:
    kinds = f"; of kind {', '.join(key.kinds)}" if key.kinds else ""
    return "table" if key.of else f"{key.expected}{f'; must {key.permitted}' if key.permitted else ''}{kinds}"


def _default(key: Key) -> str:
    return key.optional or ("**required**" if key.default is REQUIRED else f"`{toml_value(key.default)}`")


def json_schema(schema: Mapping[str, KeyTable]) -> str:
    """Return the JSON schema (text) of files whose top level is the first table of a schema."""
    tables = {name: _json_table(table) for name, table in schema.items()}
    first = next(iter(schema))
    return json.dumps(
        {"$schema": "http://json-schema.org/draft-07/schema#", **tables.pop(first), "definitions": tables}, indent=1
    )


def _json_table(table: KeyTable) -> dict[str, Any]:
    out: dict[str, Any] = {"type": "object", "description": table.about, "additionalProperties": False}
    out["properties"] = {key.name: _json_key(key) for key in table.keys.values()}
    out["required"] = [key.name for key in table.keys.values() if key.default is REQUIRED]
    if table.one_of:
        out["oneOf"] = [{"required": [name]} for name in table.one_of]
    never = [pair for pair in table.exclude if all(table.keys[name].default is None for name in pair)]
    if never:
        out["not"] = {"anyOf": [{"required": pair} for pair in never]}
    if table.together:
        out["dependencies"] = {one: [two] for pair in table.together for one, two in (pair, pair[::-1])}
    return out


def _json_key(key: Key) -> dict[str, Any]:
    about = {
        "description": f"{key.text}{f' [{key.unit}]' if key.unit else ''}{f'; left out: {key.optional}' if key.optional else ''}"
    }
    if key.of:
        inner = {"$ref": f"#/definitions/{key.of}"}
        if key.type == "named":
            return about | {"type": "object", "additionalProperties": inner}
        return about | {"type": "array", "items": inner} if key.type == "listed" else inner
    kind: dict[str, Any] = {"type": JSON_TYPES.get(LISTS.get(key.type, key.type), "string")}
    bounds = {"minimum": key.min, "maximum": key.max, "exclusiveMinimum": key.above, "exclusiveMaximum": key.below}
    kind |= {name: bound for name, bound in bounds.items() if bound is not None}
    kind |= {"enum": list(key.choices)} if key.choices else {}
    if key.type in LISTS:
        kind = {"type": "array", "items": kind} | ({"minItems": key.count, "maxItems": key.count} if key.count else {})
    return about | kind | ({} if key.default in (REQUIRED, None) else {"default": key.default})

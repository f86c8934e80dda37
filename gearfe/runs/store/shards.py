"""Shards: Parquet files of rows in a folder. They require pyarrow.

Each file is complete or absent. Nothing is appended to a file.
"""

import filecmp
import hashlib
import json
import os
import tomllib
from collections.abc import Mapping, Sequence
from functools import cache
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from ...core.extras import needing
from ...geometry.aliases import StrPath
from ...geometry.checks import shown
from .folder import durable

if TYPE_CHECKING:
    import pandas
    import pyarrow
    from pyarrow import dataset

SUFFIX = ".parquet"


class ShardColumn(NamedTuple):
    """Column of a shard: its `kind` (one of `KINDS`) and unit (``"-"``: none)."""

    kind: str
    unit: str = "-"


KINDS = {  # types of columns; list: any length, json: stored as JSON text
    "number": "numbers", "whole": "whole numbers of 64 bits", "truth": "True and False", "text": "texts",
    "list": "lists of numbers", "json": "values of JSON",
}  # fmt: skip


@cache
def columns(name: str) -> dict[str, tuple[ShardColumn, str]]:
    """Return result columns from a table of ``gearfe/runs/columns.toml``, with descriptions."""
    text = (resources.files("gearfe.runs") / "columns.toml").read_text(encoding="utf-8")
    rows = tomllib.loads(text)[name].items()
    return {key: (ShardColumn(row.get("kind", "number"), row.get("unit", "-")), row.get("text", "")) for key, row in rows}


def fields(name: str) -> dict[str, ShardColumn]:
    """Return result columns without descriptions."""
    return {key: field for key, (field, _) in columns(name).items()}


def arrow() -> Any:
    """Return the package ``pyarrow`` with its modules for Parquet.

    RuntimeError if it is not installed; the message names what to install.
    """
    with needing("pyarrow"):
        import pyarrow
        import pyarrow.dataset
        import pyarrow.parquet
    return pyarrow


def where_of(where: Any, names: Sequence[str]) -> Any:
    """Return a pyarrow expression that selects rows: all if None, an expression as it is, or by values of columns `names`.

    ``{"status": "done", "level": (0.1, 0.3), "case": ["a", "b"]}``: a value, a range as a tuple of two, or a list of values.
    ValueError if there is no such column, or it holds no such values.
    """
    if where is None or isinstance(where, arrow().dataset.Expression):
        return where
    if not isinstance(where, Mapping):
        raise ValueError(f"where = {shown(where)}, but give a dict by column, or an expression of pyarrow")
    field, out = arrow().dataset.field, None
    for name, value in where.items():
        if name not in names:
            raise ValueError(f"where: no column {name!r}; there is {', '.join(names)}")
        try:
            if isinstance(value, tuple):
                low, high = value
                rows = (field(name) >= low) & (field(name) <= high)
            else:
                rows = field(name).isin(value) if isinstance(value, list) else field(name) == value
        except (TypeError, ValueError) as error:
            raise ValueError(
                f"where: {name} = {value!r}; give a value, a range as a tuple of two, or a list of values"
            ) from error
        out = rows if out is None else out & rows
    return out


def table(rows: Sequence[Mapping[str, Any]], fields: Mapping[str, ShardColumn]) -> "pyarrow.Table":
    """Return rows as a table with exactly the columns `fields`. Missing values are null.

    ValueError if a row has a value that `fields` does not name, or of a wrong type: text among numbers, 1.5 among whole numbers.
    """
    pa = arrow()
    extra = sorted({name for row in rows for name in row} - set(fields))
    if extra:
        raise ValueError(f"rows have {', '.join(extra)}, but the columns are {', '.join(fields)}")
    schema = schema_of(fields)
    columns = [_column(name, kind, [row.get(name) for row in rows], schema) for name, (kind, _) in fields.items()]
    return pa.Table.from_arrays(columns, schema=schema)


def _column(name, kind, values, schema):
    """Return an array of pyarrow. Raises ValueError that names a value of the wrong kind."""
    pa = arrow()
    try:
        if kind == "whole" and any(int(value) != value for value in values if value is not None):
            raise ValueError("a fraction")  # pyarrow would truncate fractions.
        plain = [json.dumps(value) if kind == "json" and value is not None else value for value in values]
        return pa.array(plain, schema.field(name).type)
    except (pa.ArrowException, TypeError, ValueError, OverflowError) as error:
        for value in values if len(values) > 1 else ():
            _column(name, kind, [value], schema)
        raise ValueError(f"{name} = {shown(values[0])}, but the column holds {KINDS[kind]}") from error


def schema_of(fields: Mapping[str, ShardColumn]) -> "pyarrow.Schema":
    """Return the schema of `table`. Its metadata contain kind and unit of each column."""
    pa = arrow()
    types = {"number": pa.float64(), "whole": pa.int64(), "truth": pa.bool_(), "text": pa.string(), "json": pa.string()}
    types["list"] = pa.list_(pa.float64())
    return pa.schema([pa.field(n, types[f.kind], metadata={"kind": f.kind, "unit": f.unit}) for n, f in fields.items()])


def fields_of(schema: "pyarrow.Schema") -> dict[str, ShardColumn]:
    """Return columns by name from a schema made by `schema_of`."""
    metadata = {field.name: {k.decode(): v.decode() for k, v in (field.metadata or {}).items()} for field in schema}
    return {name: ShardColumn(about.get("kind", "text"), about.get("unit", "-")) for name, about in metadata.items()}


def encoded(table: "pyarrow.Table") -> bytes:
    """Return a table as the bytes of a compressed Parquet file with checksums. Equal tables give equal bytes."""
    pa = arrow()
    out = pa.BufferOutputStream()
    pa.parquet.write_table(table, out, compression="zstd", write_page_checksum=True)
    return out.getvalue().to_pybytes()


def write_shard(folder: StrPath, name: str, content: bytes) -> None:
    """Write an `encoded` table into a folder. A shard of the same name is replaced.

    ValueError if it cannot be written. All other shards are unchanged in this case.
    """
    durable(Path(folder) / f"{name}{SUFFIX}", content)


def shard_names(folder: StrPath) -> list[str]:
    """Names of the shards in a folder, sorted."""
    return sorted(path.name.removesuffix(SUFFIX) for path in Path(folder).glob(f"[!.]*{SUFFIX}") if path.is_file())


def _files(folder):
    return [Path(folder) / f"{name}{SUFFIX}" for name in shard_names(folder)]


def check_shards(folder: StrPath) -> None:
    """Raise ValueError if a shard is damaged, a copy, or has other columns. Only metadata are read.

    The rows of a copy would count twice.
    """
    pa = arrow()
    first: dict[Any, Path] = {}
    words: dict[bytes, Path] = {}
    for file in _files(folder):
        size, end = _end(file)
        other = first.setdefault((size, hashlib.sha256(end).digest()), file)
        if other is not file and filecmp.cmp(other, file, shallow=False):
            raise ValueError(f"{folder} holds {other.name} and {file.name} with the same rows: one is a copy; remove it")
        words.setdefault(end[end.rfind(b"ARROW:schema") :], file)
    schema = None
    for file in words.values():
        try:
            found = pa.parquet.read_schema(file)
        except (OSError, pa.ArrowException) as error:
            raise _damaged(file, error) from error
        schema = schema or found
        if found != schema:
            raise ValueError(f"{file} has other columns than the previous shards and does not belong to this folder: remove it")


def unfinished(folder: StrPath, names: Sequence[str], what: str, failed: Sequence[str] = ()) -> list[str]:
    """Return the expected names that are neither shards of the folder nor among the `failed` ones.

    ValueError if a shard is damaged, or one does not belong to this `what`.
    """
    check_shards(folder)
    present = {*shard_names(folder), *failed}
    unknown = sorted(present - set(names))
    if unknown:
        name = unknown[0] if unknown[0] in failed else f"{unknown[0]}{SUFFIX}"
        raise ValueError(f"{folder} holds {name}, which does not belong to this {what}: remove it")
    return [name for name in names if name not in present]


def _end(file):
    """Return the size of a shard and its footer (columns, positions and extremes of its parts)."""
    with open(file, "rb") as data:
        size = data.seek(0, os.SEEK_END)
        data.seek(max(size - 8, 0))
        length = int.from_bytes(data.read(4), "little")
        data.seek(max(size - 8 - length, 0))
        return size, data.read()


def opened(folder: StrPath) -> "dataset.Dataset":
    """Return all shards as one pyarrow dataset, which reads only requested columns and rows.

    ValueError if there is no shard, one is damaged, has other columns than the first, or is a copy of another.
    """
    pa = arrow()
    files = [str(file) for file in _files(folder)]
    if not files:
        raise ValueError(f"{folder} holds no results yet")
    check_shards(folder)
    try:
        checked = pa.dataset.ParquetFragmentScanOptions(page_checksum_verification=True)
        form = pa.dataset.ParquetFileFormat(default_fragment_scan_options=checked)
        return pa.dataset.dataset(files, format=form, schema=pa.parquet.read_schema(files[0]))
    except (OSError, pa.ArrowException) as error:
        raise _damaged(_first_damaged(folder), error) from error


def row_count(folder: StrPath) -> int:
    """Return the number of rows of all shards. ValueError if one is damaged."""
    if not shard_names(folder):
        return 0
    shards = opened(folder)
    try:
        return int(shards.count_rows())
    except (OSError, arrow().ArrowException) as error:
        raise _damaged(_first_damaged(folder), error) from error


def read(folder: StrPath, columns: Sequence[str] | None = None, where: Any = None) -> "pyarrow.Table":
    """Return columns (None: all) of the rows of all shards that satisfy `where`, see `where_of`.

    ValueError if a shard is damaged or a copy, a column does not exist, or `where` compares numbers with text or requests a text
    that no row has.
    """
    pa = arrow()
    shards = opened(folder)
    unknown = [name for name in columns or () if name not in shards.schema.names]
    if unknown:
        raise ValueError(f"no column {unknown[0]!r} in {folder}; it has {', '.join(shards.schema.names)}")
    condition = where_of(where, shards.schema.names)
    try:
        found = shards.to_table(columns=list(columns) if columns is not None else None, filter=condition)
    except (pa.ArrowNotImplementedError, pa.ArrowTypeError) as error:
        raise ValueError(f"where = {condition}: {_line(error)}; compare a column with values of its type") from error
    except (OSError, pa.ArrowInvalid) as error:
        raise _damaged(_first_damaged(folder), error) from error
    for name, value in where.items() if isinstance(where, Mapping) and not found.num_rows else ():
        there = shards.to_table(columns=[name])[name].unique().to_pylist()
        if isinstance(value, str) and value not in there:
            raise ValueError(f"where: {name} = {value!r}, but no row has that; there is {', '.join(map(str, there))}")
    return found


def frame(found: "pyarrow.Table", fields: Mapping[str, ShardColumn], index: str | None = None) -> "pandas.DataFrame":
    """Return a table as a pandas table with index `index`. ``attrs["units"]`` contains units by column. Requires pandas."""
    with needing("pandas"):
        data = found.to_pandas()
    data = data if index is None else data.set_index(index).sort_index()
    data.attrs["units"] = {name: fields[name].unit for name in data}
    return data


def _line(error):
    """Return the message of a pyarrow error in one line."""
    return " ".join(str(error).split())


def _damaged(file, error):
    return ValueError(f"{file} is damaged: {_line(error)}; delete it, and its contents are computed again")


def _first_damaged(folder):
    """Return the first unreadable shard in a folder."""
    pa = arrow()
    for file in _files(folder):
        try:
            pa.parquet.read_table(file, page_checksum_verification=True)
        except (OSError, pa.ArrowInvalid):
            return file
    return f"a shard in {folder}"

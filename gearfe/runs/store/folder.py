"""Folder with a note on its contents. Files are complete or absent, and only one process writes at a time.

A folder holds ``_about.json`` (what made its files), the files, and ``.lock``. The underscore hides it from readers of Parquet.
A file is written under another name, flushed to the disk and then renamed, so that a process that is killed, or a disk that runs
full, leaves either the whole file or none.
"""

import contextlib
import json
import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from ...core.checks import whole
from ...core.file_readers import check_path
from ...core.files import PART, written
from ...geometry.aliases import StrPath

COUNT = object()  # marker for an integer of at least 1 in the schema of a note
ABOUT, LOCK = "_about.json", ".lock"


def durable(path: StrPath, content: bytes) -> None:
    """Write a file, and return when it is on the disk.

    ValueError if it cannot be written: no such folder, no permission, no space left. An existing file at `path` is unchanged.
    """
    with written(path) as name, open(name, "wb") as file:
        file.write(content)
        file.flush()
        os.fsync(file.fileno())
    folder = os.open(Path(path).parent, os.O_RDONLY)
    try:
        os.fsync(folder)  # The directory entry is also written to disk.
    finally:
        os.close(folder)


@contextlib.contextmanager
def locked(folder: StrPath) -> Iterator[None]:
    """Lock a folder for writing until the end of the block or of the process.

    Temporary files of killed processes are removed.

    ValueError if another process writes into it, or the folder cannot be written. RuntimeError on a system without ``fcntl``.
    """
    try:
        import fcntl
    except ImportError as error:
        raise RuntimeError(f"{folder} is locked by fcntl, which this system lacks: write it on Linux or macOS") from error
    with contextlib.ExitStack() as stack:
        try:
            file = stack.enter_context(open(Path(folder) / LOCK, "ab"))
        except OSError as error:
            raise ValueError(f"cannot write into {folder}: {error.strerror or error}; give a writable folder") from error
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            raise ValueError(f"another process is writing into {folder}: wait for it, or give another folder") from error
        for left in Path(folder).glob(f"{PART}*"):
            left.unlink(missing_ok=True)
        yield


def begin(folder: StrPath, about: Mapping[str, Any], shape: Mapping[str, Any]) -> dict[str, Any]:
    """Return the note of an existing folder for comparison with `about`. A new or empty folder gets `about` as its note.

    `about` is JSON, and its ``"format"`` a name such as ``"gearfe sweep 1"``. `read_about` describes `shape`. ValueError if
    making or writing the folder fails, or if it contains anything else.
    """
    check_path("folder", folder)
    if not os.fspath(folder):
        raise ValueError("the name of the folder is empty: give a name")
    try:
        os.fspath(folder).encode()
    except UnicodeEncodeError as error:
        raise ValueError(f"folder = {os.fspath(folder)!r}, but give a name in Unicode: the Parquet files are in it") from error
    try:
        Path(folder).mkdir(parents=True, exist_ok=True)
        empty = not _inside(folder)
    except OSError as error:
        raise ValueError(f"cannot make the folder {folder}: {error.strerror or error}") from error
    if empty:
        durable(Path(folder) / ABOUT, json.dumps(about, indent=1).encode())
    return read_about(folder, str(about["format"]), shape)


def _inside(folder):
    return sorted(path.name for path in Path(folder).iterdir() if path.name != LOCK and not path.name.startswith(PART))


def read_about(folder: StrPath, form: str, shape: Mapping[str, Any]) -> dict[str, Any]:
    """Return the note of a folder of shards with the format `form`.

    `shape` has by key the type of its value, its permitted texts as a tuple, or the shape of a table in it. ValueError if it is
    no such folder, or its note lacks a key or has one of another type; nothing in it is touched.
    """
    check_path("folder", folder)
    file = Path(folder) / ABOUT
    if not Path(folder).is_dir():
        raise ValueError(f"no folder {folder}")
    if not file.is_file():
        inside = _inside(folder)
        content = f"holds other files ({', '.join(inside[:3])}{', ...' if len(inside) > 3 else ''})" if inside else "is empty"
        raise ValueError(f"{folder} {content} and no {ABOUT}, so it is no {form}: give a new or empty folder, or one of these")
    try:
        about = json.loads(file.read_text(encoding="utf-8"))
        _check_shape(about, {"format": str, **shape})
    except (OSError, ValueError, RecursionError) as error:
        raise ValueError(f"{file} is damaged: {error}; no file was changed") from error
    if about["format"] != form:
        stated = about["format"]
        raise ValueError(
            f"{file} has format = {stated!r}, not {form!r}: the folder is of another program or version; give a new one"
        )
    return about


def _check_shape(note, shape, place=""):
    if not isinstance(note, dict):
        raise ValueError(f"{place or 'it'} is no table")
    for name, kind in shape.items():
        if isinstance(kind, Mapping):
            _check_shape(note.get(name), kind, f"{place}{name}.")
        elif kind is COUNT:
            whole(f"{place}{name}", note.get(name), 1)
        elif isinstance(kind, tuple):  # permitted texts
            if note.get(name) not in kind:
                raise ValueError(f"{place}{name} = {_short(note.get(name))}, but expected one of {', '.join(kind)}")
        elif isinstance(kind, list):  # list of tables
            for row in note[name] if isinstance(note.get(name), list) else [None]:
                _check_shape(row, {}, f"{place}{name}.")
        elif type(note.get(name)) is not kind:
            raise ValueError(f"{place}{name} = {_short(note.get(name))}, but expected {kind.__name__}")


def check_same(folder: Any, stored: Mapping[str, Any], about: Mapping[str, Any], what: str, *, mixed: bool | None = None) -> None:
    """Raise ValueError for a folder that was begun with other inputs or (unless `mixed`) by another program version.

    `stored` is the note in the folder, and `about` the note of this call. Their entries ``[what]``, such as ``["study"]``, are
    the inputs, and ``["made"]`` the versions. `mixed` is None if it is not an option. ValueError with the values that differ.
    """
    changed = list(_differences(stored[what], about[what]))
    if changed:
        more = f" and {len(changed) - 1} more" if len(changed) > 1 else ""
        raise ValueError(
            f"{folder} holds another {what}, begun with {changed[0]}{more}: give a new folder, or the {what} as it was "
            f"({folder}/{ABOUT} has all of it)"
        )
    versions = list(_differences(stored["made"], about["made"]))
    if versions and not mixed:
        hint = "" if mixed is None else ", or continue with mixed = True (--mixed): each row states its version"
        raise ValueError(
            f"{folder} was begun by another program, with {'; '.join(versions)}: finish it with that, or give a new folder{hint}"
        )


def _differences(there, here, path=""):
    """Return texts that describe the values that differ."""
    if isinstance(there, list) and isinstance(here, list) and len(there) == len(here):
        there, here = dict(enumerate(there)), dict(enumerate(here))
    if isinstance(there, dict) and isinstance(here, dict):
        for name in dict.fromkeys((*there, *here)):
            yield from _differences(there.get(name), here.get(name), f"{path}.{name}" if path else name)
    elif there != here and not (there != there and here != here):  # Here nan equals nan.
        yield f"{path} = {_short(there)}, not {_short(here)}"


def _short(value):
    text = repr(value)
    return text if len(text) < 60 else f"{text[:50]}...{text[-5:]}"

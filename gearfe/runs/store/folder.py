"""A folder with a note of what is in it: files that are whole or not there, one writer at a time.

A folder holds ``about.json`` (what made its files), the files, and ``.lock``. A file is written under another name, flushed to
the disk and then renamed, so that a process that is killed, or a disk that runs full, leaves either the whole file or none.
"""

import contextlib
import json
import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import IO, Any

from ...core.files import new_file

ABOUT, LOCK, PART = "about.json", ".lock", ".part-"


@contextlib.contextmanager
def durable(path: str | os.PathLike[str]) -> Iterator[IO[bytes]]:
    """File to write into that becomes `path` when the block ends without an error, and is on the disk then.

    ValueError if it cannot be written: no such folder, no permission, no space left. What stood at `path` is untouched.
    """
    path = Path(path)
    name = None
    try:
        handle, name = new_file(path.parent, PART)
        with os.fdopen(handle, "wb") as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        os.replace(name, path)
        folder = os.open(path.parent, os.O_RDONLY)
        try:
            os.fsync(folder)  # its list of names
        finally:
            os.close(folder)
    except OSError as error:
        raise ValueError(f"cannot write {path}: {error.strerror or error}; nothing written before is lost") from error
    finally:
        if name is not None:
            with contextlib.suppress(OSError):
                os.unlink(name)


@contextlib.contextmanager
def locked(folder: str | os.PathLike[str]) -> Iterator[None]:
    """Be the only one who writes into a folder, until the block ends or the process does; leftovers of killed ones are removed.

    ValueError if another process writes into it, or the folder cannot be written.
    """
    folder = Path(folder)
    try:
        handle = os.open(folder / LOCK, os.O_RDWR | os.O_CREAT, 0o666)
    except OSError as error:
        raise ValueError(f"cannot write into {folder}: {error.strerror or error}; give a writable folder") from error
    try:
        _take(handle, folder)
        for left in folder.glob(f"{PART}*"):
            left.unlink(missing_ok=True)
        yield
    finally:
        os.close(handle)


def _take(handle, folder):
    """Lock an open file, or say that it is taken."""
    try:
        import fcntl
    except ImportError as error:
        raise RuntimeError(
            "a folder of shards is locked by fcntl, which this system has not: write it on Linux or macOS"
        ) from error
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        raise ValueError(f"another process is writing into {folder}: wait for it, or give another folder") from error


def begin(folder: str | os.PathLike[str], about: Mapping[str, Any]) -> dict[str, Any]:
    """The note of an existing folder, to be compared with `about`; a new or empty folder is made and gets `about` as its note.

    `about` is JSON, and its ``"format"`` a name such as ``"gearfe sweep 1"``. ValueError if the folder cannot be made or written,
    or holds anything else.
    """
    if not os.fspath(folder):
        raise ValueError("an empty name of a folder: give one")
    folder = Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        inside = sorted(path.name for path in folder.iterdir() if path.name != LOCK and not path.name.startswith(PART))
    except OSError as error:
        raise ValueError(f"cannot make the folder {folder}: {error.strerror or error}") from error
    if inside:
        return read_about(folder, str(about["format"]))
    with durable(folder / ABOUT) as file:
        file.write(json.dumps(about, indent=1).encode())
    return json.loads(json.dumps(about))


def read_about(folder: str | os.PathLike[str], form: str) -> dict[str, Any]:
    """The note of a folder of shards, of the format `form`.

    ValueError if it is no such folder; nothing in it is touched.
    """
    file = Path(folder) / ABOUT
    if not Path(folder).is_dir():
        raise ValueError(f"no folder {folder}")
    if not file.is_file():
        inside = sorted(path.name for path in Path(folder).iterdir() if path.name != LOCK)
        content = f"holds other files ({', '.join(inside[:3])}{', ...' if len(inside) > 3 else ''})" if inside else "is empty"
        raise ValueError(f"{folder} {content} and no {ABOUT}, so it is no {form}: give a new or empty folder, or one of these")
    try:
        about = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise ValueError(f"{file} is damaged: {error}; nothing in the folder was touched") from error
    if not isinstance(about, dict) or about.get("format") != form:
        stated = about.get("format") if isinstance(about, dict) else about
        raise ValueError(f"{file} says format = {stated!r}, not {form!r}: another program's or version's folder; give a new one")
    return about


def check_same(folder: Any, stored: Mapping[str, Any], about: Mapping[str, Any], what: str, *, mixed: bool | None = None) -> None:
    """Refuse to go on with a folder that was begun with other inputs, or by another version of the program (unless `mixed`).

    `stored` stands in the folder, `about` would be written now; ``[what]``, such as ``["study"]``, are their inputs, ``["made"]``
    their versions. `mixed` is None where it cannot be asked for. ValueError with the values that differ.
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
        hint = "" if mixed is None else ", or go on with mixed = True (--mixed): each row says which made it"
        raise ValueError(
            f"{folder} was begun by another program, with {'; '.join(versions)}: finish it with that, or give a new folder{hint}"
        )


def _differences(there, here, path=""):
    """Texts that say which values differ."""
    if isinstance(there, dict) and isinstance(here, dict):
        for name in dict.fromkeys((*there, *here)):
            yield from _differences(there.get(name), here.get(name), f"{path}.{name}" if path else name)
    elif isinstance(there, list) and isinstance(here, list) and len(there) == len(here):
        for i, (old, new) in enumerate(zip(there, here, strict=True)):
            yield from _differences(old, new, f"{path}.{i}")
    elif there != here and not (there != there and here != here):  # nan is equal to nan
        yield f"{path} = {_short(there)}, not {_short(here)}"


def _short(value):
    text = repr(value)
    return text if len(text) < 60 else f"{text[:50]}...{text[-5:]}"

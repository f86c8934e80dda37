"""Files: `FORMATS` lists the formats and their contents. A file is either complete or absent.

A curve or a response becomes a `Content`, which every format of numbers can hold. Pictures and fields are drawn by their
libraries into the path from `written`. Readers return lines of text or arrays by name.
"""

import contextlib
import json
import os
import secrets
import signal
import sys
import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

import numpy as np

from .checks import whole
from .file_readers import check_regular, read_mat, read_npz, read_text

_drawing = threading.Lock()
LEAST_DPI, MOST_DPI = 10, 2400  # limits of the picture resolution [dpi]; fonts need at least one pixel
PART = ".part-"  # prefix of temporary files


@dataclass(frozen=True, slots=True)
class Content:
    """Numbers to be written."""

    title: str  # first line of a text table, "gearfe stiffness curve, version 1"
    columns: dict  # columns of a text table, arrays ``(n,)`` by "name [unit]"
    arrays: dict  # the same for all other formats, by name
    meta: dict  # all data required to repeat the computation, as JSON
    # units of the arrays: a table in JSON files, JSON text ``units_json`` in the others
    units: dict = field(default_factory=dict)


@contextlib.contextmanager
def written(path):
    """Context manager that returns the path of a temporary file, which replaces `path` when it is complete.

    When the block ends without an error, the file replaces `path` or the target of the link. ValueError if the folder does not
    exist or cannot be written, or `path` is a pipe or a device.
    """
    with _exit_by_exception():
        target, name = _placed(path)
        try:
            yield name
            os.replace(name, target)
        except OSError as error:
            raise ValueError(f"cannot write {path}: {error.strerror or error}") from error
        finally:
            with contextlib.suppress(FileNotFoundError):
                os.unlink(name)


@contextlib.contextmanager
def _exit_by_exception():
    """Context in which SIGTERM raises SystemExit, so that temporary files are removed. A handler of the user stays."""
    alone = threading.current_thread() is threading.main_thread() and signal.getsignal(signal.SIGTERM) is signal.SIG_DFL
    if alone:
        signal.signal(signal.SIGTERM, lambda number, _: sys.exit(128 + number))
    try:
        yield
    finally:
        if alone:
            signal.signal(signal.SIGTERM, signal.SIG_DFL)


def _placed(path):
    """Return the file to be written, which is the target of a link, and the name of a temporary file in its folder."""
    target = Path(os.path.realpath(path)) if os.path.exists(path) else Path(path)
    if os.path.exists(target) and not (os.path.isfile(target) or os.path.isdir(target)):
        raise ValueError(f"cannot write {path}: it is a pipe or a device; give the name of a file")
    return target, new_file(target.with_name(Path(path).name) if target.name else target)


def new_file(path):
    """Create an empty file in the folder of `path`, and return its name. Some libraries require its lower-case suffix.

    It has the access rights of any new file of this process. `tempfile.mkstemp` gives fewer rights. The usual rights can be read
    only by changing them for all threads.
    """
    path = Path(path)
    try:
        while True:
            name = path.parent / f"{PART}{secrets.token_hex(6)}-{path.stem}{path.suffix.lower()}"
            with contextlib.suppress(FileExistsError), open(name, "xb"):
                return str(name)
    except (OSError, ValueError) as error:  # ValueError: a zero byte in the name
        reason = getattr(error, "strerror", None) or error
        raise ValueError(f"cannot write {path}: {reason}; give an existing, writable folder") from error


def check_output(path, kind):
    """Raise ValueError if `path` is not writable. Call it before work begins.

    A new file is created in the folder and removed again. An existing file at `path` is not changed. `kind` is the content, by
    its name in `FORMATS` (``curve``, ``picture``...). ValueError if the name is empty or a folder, if its suffix is not one
    for this content, or if the folder is missing or not writable.
    """
    if isinstance(path, (str, os.PathLike)) and not str(path):
        raise ValueError(f"an empty file name for a {kind}: give one that ends in {', '.join(suffixes(kind))}")
    suffix_of(path, kind)
    if os.path.isdir(path):  # Unlike pathlib, `os.path.isdir` returns False for invalid names.
        raise ValueError(f"cannot write {path}: it is a folder; give the name of a file")
    os.unlink(_placed(path)[1])


def suffixes(kind, *, reading=False):
    """Return the suffixes of files that can hold `kind`."""
    known = [suffix for suffix, row in FORMATS.items() if kind in (row.reads if reading else row.writes)]
    if not known:
        raise ValueError(f"kind = {kind!r}, which no file format supports; see gearfe.core.files.FORMATS")
    return known


def suffix_of(path, kind, *, reading=False):
    """Suffix of `path` in small letters.

    ValueError if files of this suffix do not hold content of this `kind`. The message lists the permitted suffixes.
    """
    known = suffixes(kind, reading=reading)
    if not isinstance(path, (str, os.PathLike)):
        raise ValueError(f"path = {path!r}, but give the name of a file that ends in {', '.join(known)}")
    suffix = Path(path).suffix.lower()
    if suffix not in known:
        raise ValueError(f"{path}: no format for {suffix or 'a file without a suffix'!r}; use one of {', '.join(known)}")
    if reading:
        check_regular(path)
    return suffix


def save(path, kind, content):
    """Write a `Content` in the format of the suffix of `path`."""
    save_as(suffix_of(path, kind), path, content)


def save_as(suffix, path, content):
    """Write a `Content` in the format of a given suffix, independent of that of `path`."""
    with written(path) as name:
        FORMATS[suffix].write(name, content)


def checked_dpi(dpi):
    """Return the resolution of a picture if it is a whole number within limits."""
    return whole("dpi", dpi, LEAST_DPI, MOST_DPI)


def save_figure(figure, path, dpi):
    """Draw a matplotlib figure into a file, unless `path` is None. Return the figure."""
    if path is not None:
        suffix_of(path, "picture")
        checked_dpi(dpi)
        for text in figure.findobj(lambda artist: hasattr(artist, "set_parse_math")):
            words = text.get_text().encode(errors="replace").decode()  # The name of a file may not be valid UTF-8.
            if words != text.get_text():
                text.set_text(words)
            if "$" in words:
                # File names are not interpreted as formulas. Axis numbers may be formulas.
                text.set_parse_math("\\mathdefault" in words)
        import matplotlib

        embedded = {"pdf.fonttype": 42, "ps.fonttype": 42}  # Publishers reject fonts of type 3.
        with _drawing, matplotlib.rc_context(embedded), written(path) as name:  # The lock protects fonts.
            figure.savefig(name, dpi=dpi)
    return figure


def read(path, kind):
    """Read the contents of a file: its lines if it is text, else its arrays by name.

    ValueError if its suffix does not hold such content, or it is not readable or has another format.
    """
    return FORMATS[suffix_of(path, kind, reading=True)].read(path)


def write_csv(name, content):
    """Write a table of repr-exact numbers under comment lines with title and meta data (JSON)."""
    columns = [np.asarray(values, dtype=float).tolist() for values in content.columns.values()]
    with open(name, "w", encoding="utf-8") as file:
        file.write(f"# {content.title}\n# meta: {json.dumps(content.meta)}\n{','.join(content.columns)}\n")
        for row in zip(*columns, strict=True):
            file.write(",".join(map(repr, row)) + "\n")


def write_npz(name, content):
    """Write a numpy archive. ``meta`` and ``units_json`` are JSON strings."""
    with open(name, "wb") as file:
        np.savez(file, **content.arrays, **_told(content))


def write_mat(name, content):
    """Write a MATLAB 5 file. ``meta`` and ``units_json`` are JSON (``jsondecode``), rows of text are cell arrays."""
    from scipy.io import savemat

    arrays = {key: value.astype(object) if value.dtype.kind == "U" else value for key, value in content.arrays.items()}
    savemat(name, arrays | _told(content), appendmat=False, oned_as="column")


def _told(content):
    """Return meta data and units of all arrays as JSON text."""
    units = {key: content.units.get(key, "-") for key in content.arrays}
    return {"meta": json.dumps(content.meta), "units_json": json.dumps(units)}


def write_json(name, content):
    """Write JSON: arrays as lists (nan as null), with units."""
    data = {key: json.loads(json.dumps(value.tolist()).replace("NaN", "null")) for key, value in content.arrays.items()}
    with open(name, "w", encoding="utf-8") as file:
        json.dump({"units": {key: content.units[key] for key in data}, **data, "meta": content.meta}, file)


class Format(NamedTuple):
    """Format of files with one suffix: contents, writer (None if a drawing library writes the file) and reader."""

    writes: tuple = ()
    reads: tuple = ()
    write: Callable | None = None
    read: Callable | None = None


FORMATS = {
    ".csv": Format(("curve", "response", "table"), ("curve", "signal"), write_csv, read_text),
    ".txt": Format((), ("signal",), None, read_text),
    ".npz": Format(("curve", "response", "surrogate"), ("signal", "surrogate"), write_npz, read_npz),
    ".mat": Format(("curve", "response"), ("signal",), write_mat, read_mat),
    **{suffix: Format((), ("signal",)) for suffix in (".h5", ".hdf5", ".wav", ".uff", ".unv", ".uf", ".tdms", ".parquet")},
    ".lvm": Format((), ("signal",), None, read_text),
    ".json": Format(("curve",), (), write_json, None),
    ".png": Format(("picture", "stress")),
    **{suffix: Format(("picture",)) for suffix in (".svg", ".pdf", ".jpg", ".jpeg", ".tif", ".tiff", ".webp", ".eps")},
    ".vtu": Format(("stress", "mesh")),
    ".msh": Format(("mesh",)),
    **{suffix: Format(("table",)) for suffix in (".md", ".tex")},
    ".html": Format(("page",)),
    ".inp": Format(("deck", "mesh")),
}

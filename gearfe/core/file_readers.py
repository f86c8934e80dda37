"""Readers of text and of archives of arrays (numpy, MATLAB), which raise errors for damaged files."""

import codecs
import contextlib
import math
import os
import re
import struct
import warnings
import zipfile
import zlib
from pathlib import Path
from tokenize import TokenError

import numpy as np
from numpy.lib import format as npy

from .matlab_file import MOST_PACKED, variables

# Errors of files that are not an archive of arrays, or have an unknown type.
NO_ARCHIVE: tuple[type[Exception], ...] = (zipfile.BadZipFile, zlib.error, struct.error, EOFError, RuntimeError)
NO_ARCHIVE += (MemoryError, KeyError, ValueError, TypeError, OverflowError, SyntaxError, TokenError)
CONTROLS = re.compile("[\x00-\x08\x0e-\x19\x1b-\x1f]")  # control characters that no text table contains


def check_path(name, path):
    """Raise TypeError unless `path` names a file or a folder. A number would be an open file descriptor."""
    if not isinstance(path, (str, os.PathLike)):
        raise TypeError(f"{name} = {path!r}, but give the name of a file or a folder")


def check_regular(path):
    """Raise ValueError if `path` exists and is not a regular file. Reading from a pipe or a device may never end."""
    check_path("path", path)
    if "\0" in os.fsdecode(path) or (os.path.exists(path) and not os.path.isfile(path)):
        raise ValueError(f"cannot read {path}: it is no regular file")


def read_text(path):
    """Lines of a text file in UTF-8, UTF-16 or (with a warning) Windows-1252, which includes Latin-1."""
    check_regular(path)
    try:
        content = Path(path).read_bytes()
    except (OSError, ValueError) as error:  # ValueError: a zero byte in the name
        raise ValueError(f"cannot read {path}: {getattr(error, 'strerror', None) or error}") from error
    text = _decoded(content)
    if text is None:
        raise ValueError(f"{path} is not text in UTF-8, UTF-16 or Windows-1252: export it as CSV in UTF-8")
    if text[1] == "cp1252":
        warnings.warn(f"{path} is not UTF-8: read as Windows-1252 (Latin-1)", stacklevel=4)
    return text[0].splitlines()


def _decoded(content):
    """Decode bytes, and return the text and its encoding. The result is None if no usual encoding of tables fits."""
    marks = {codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16", codecs.BOM_UTF8: "utf-8-sig"}
    marked = next((name for mark, name in marks.items() if content.startswith(mark)), None)
    # In UTF-16 text of Latin letters every second byte is zero.
    wide = {"utf-16-le": content[1:400:2], "utf-16-be": content[:400:2]}
    guessed = [name for name, high in wide.items() if len(high) > 1 and high.count(0) > 0.9 * len(high)]
    for name in [marked] if marked else [*guessed, "utf-8", "cp1252"]:
        with contextlib.suppress(UnicodeDecodeError):
            text = content.decode(name)
            if name == "utf-8" or not CONTROLS.search(text):
                return text, name
    return None


def read_npz(path):
    """Read the arrays of a numpy archive by name, without unpickling and without more memory than the file's bytes allow."""
    with _opened(path) as file:
        try:
            with zipfile.ZipFile(file) as archive:
                for member in archive.infolist():
                    _check_member(archive, member)
            file.seek(0)
            with np.load(file, allow_pickle=False) as archive:
                return {name: archive[name] for name in archive.files}
        except NO_ARCHIVE as error:
            raise ValueError(f"{path} is not a numpy archive of plain arrays: {error}") from error


def _check_member(archive, member):
    """Raise ValueError if a member of a numpy archive states a larger size than its bytes allow."""
    if member.file_size > MOST_PACKED * (member.compress_size + 1):
        raise ValueError(
            f"{member.filename} holds {member.compress_size} compressed bytes, which cannot expand to the stated "
            f"{member.file_size}"
        )
    if not member.filename.endswith(".npy"):
        return
    with archive.open(member) as file:
        version = npy.read_magic(file)
        shape, _, dtype = (npy.read_array_header_1_0 if version == (1, 0) else npy.read_array_header_2_0)(file)
        if not dtype.hasobject and math.prod(shape) * dtype.itemsize > member.file_size - file.tell():
            raise ValueError(f"{member.filename} states {dtype} {list(shape)}, more than its {member.file_size} bytes")


def read_mat(path):
    """Return the variables of a MATLAB file of version 7 or older by name: arrays, or `gearfe.core.matlab_file.Unread`."""
    with _opened(path) as file:
        try:
            return variables(file.read())
        except (ValueError, MemoryError) as error:
            raise ValueError(f"{path} is not a MATLAB file, or a damaged one: {error}") from error


@contextlib.contextmanager
def _opened(path):
    check_regular(path)
    try:
        with open(path, "rb") as file:
            yield file
    except OSError as error:
        raise ValueError(f"cannot read {path}: {error.strerror or error}") from error

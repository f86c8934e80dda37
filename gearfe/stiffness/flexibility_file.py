"""One flexibility in one file: arrays of numbers beside the whole key they were made for, and nothing that could be executed.

The file is what `numpy.savez` writes: an archive, not compressed, of arrays of floats, whole numbers and bytes (the key).
"""

import os
import struct
import zipfile
from collections.abc import Callable
from pathlib import Path
from tokenize import TokenError
from typing import Any

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from ..core.files import written

KEY = "key"
LARGEST = 2**30  # [bytes]; gears of 3-D finite elements take some megabytes
DTYPES = ("float64", "int64", "uint8")
# what a file that is no such archive can raise: not there, no archive, of a kind not known, other names, other arrays
UNREADABLE = (
    *(OSError, EOFError, zipfile.BadZipFile, struct.error, RuntimeError, MemoryError),
    *(KeyError, ValueError, TypeError, OverflowError, SyntaxError, TokenError),
)


def write_flexibility(path: Path, key: str, arrays: dict[str, NDArray]) -> None:
    """Write arrays and the key they belong to; the file is in place when it is complete, or not at all (ValueError)."""
    with written(path) as name:
        np.savez(name, **dict[str, Any](arrays | {KEY: np.frombuffer(key.encode(), dtype=np.uint8)}))


def read_flexibility(path: Path, key: str, made_from: Callable[[dict[str, NDArray]], object]) -> object | None:
    """What `made_from` makes of the arrays of a file, None if it is not there, damaged, or made for another key.

    Whatever the file holds, nothing in it is executed, and no more memory is asked for than the file is long.
    """
    try:
        if not path.is_file() or path.stat().st_size > LARGEST:
            return None
        with zipfile.ZipFile(path) as archive:
            members = _members(archive, os.path.getsize(path))
            if _array(archive, members.pop(KEY)).tobytes() != key.encode():
                return None
            return made_from({name: _array(archive, member) for name, member in members.items()})
    except UNREADABLE:
        return None


def _members(archive, size):
    """Members of an archive by array; ValueError if one is compressed, encrypted, there twice, or longer than the file."""
    members = {member.filename.removesuffix(".npy"): member for member in archive.infolist()}
    plain = all(m.compress_type == zipfile.ZIP_STORED and not m.flag_bits & 1 for m in members.values())
    if not plain or len(members) < len(archive.infolist()) or sum(m.file_size for m in members.values()) > size:
        raise ValueError("not an archive of plain arrays")
    return members


def _array(archive, member):
    """One array of numbers; reading all of it lets the archive compare its checksum."""
    with archive.open(member) as file:
        if npy.read_magic(file) != (1, 0):
            raise ValueError(f"{member.filename} has another version")
        shape, by_columns, dtype = npy.read_array_header_1_0(file)
        if dtype not in DTYPES:
            raise ValueError(f"{member.filename} holds {dtype}")
        values = np.frombuffer(file.read(), dtype=dtype).copy()
    return values.reshape(shape[::-1]).T if by_columns else values.reshape(shape)

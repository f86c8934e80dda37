"""Reader of MATLAB files of version 7 and older (MAT 5 and MAT 4). A damaged file only raises an error.

Compiled readers rely on the lengths and indices in a file, and some damaged files crash the process. Here every length is
compared with the available bytes first: no array is larger than the file can hold.

References
----------
The MathWorks, MAT-File Format, R2024a, ch. 1.
"""

import io
import math
import struct
import zlib
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

MATRIX, COMPRESSED = 14, 15
CELL, STRUCT, CHAR, SPARSE = 1, 2, 4, 5
OPAQUE = 17  # type of objects of newer MATLAB classes; their name precedes the data, and they have no shape
CLASSES = dict(zip(range(6, 16), ("f8", "f4", "i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8"), strict=True))
STORED = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8"}
# encodings of characters by storage type
TEXTS = {1: "latin-1", 2: "latin-1", 4: "utf-16", 16: "utf-8", 17: "utf-16", 18: "utf-32"}
COMPLEX = 0x08  # bit in the flags of an array
DEEPEST = 50  # limit of nested structs and cells
MOST_PACKED = 1032  # largest expansion of deflate [bytes per byte]


class Unread(NamedTuple):
    """Variable with a type that is not read. `why` states the type and the remedy."""

    why: str


SPARSE_TOLD = Unread("a sparse matrix: save its full one")
OBJECT_TOLD = Unread("a MATLAB object: save its numbers, for instance by table2array")


class _Bytes:
    """Bytes of a file, read from the beginning, with a check of the remaining number."""

    def __init__(self, data: Any, order: str) -> None:
        self.data, self.order, self.at = memoryview(data), order, 0

    def left(self) -> int:
        return len(self.data) - self.at

    def take(self, count: int) -> memoryview:
        if not 0 <= count <= self.left():
            raise ValueError(f"{count} bytes are stated, but only {self.left()} remain")
        self.at += count
        return self.data[self.at - count : self.at]

    def numbers(self, count: int) -> tuple[int, ...]:
        return struct.unpack(f"{self.order}{count}i", self.take(4 * count))

    def element(self) -> "tuple[int, _Bytes]":
        """Return type and content of the next element. The content of a small element is part of its tag."""
        (word,) = struct.unpack(f"{self.order}I", self.take(4))
        if word >> 16:
            held = self.take(4)
            return word & 0xFFFF, _Bytes(held[: _fits(word >> 16, 4)], self.order)
        (count,) = struct.unpack(f"{self.order}I", self.take(4))
        held = self.take(count)
        if word != COMPRESSED:
            self.take(min(-count % 8, self.left()))
        return word, _Bytes(held, self.order)


def _fits(count, most):
    if count > most:
        raise ValueError(f"{count} bytes are stated, but at most {most} fit")
    return count


def variables(data: bytes) -> dict[str, Any]:
    """Return the variables of a file by name. Raises ValueError if the bytes are no MATLAB file, or damaged.

    Numbers are arrays of MATLAB's class (truth is uint8), texts arrays of str without their last axis, cells arrays of objects,
    structs structured arrays of objects; anything else is `Unread`.
    """
    if 0 in data[:4]:
        return _old(data)
    mark = data[126:128]
    if mark not in (b"IM", b"MI"):
        raise ValueError("it has no header of MATLAB")
    file = _Bytes(data, "<" if mark == b"IM" else ">")
    version = struct.unpack(f"{file.order}H", file.take(126)[124:126])[0]
    file.take(2)
    if version >> 8 != 1:
        version_text = "7.3, but holds no HDF5" if version >> 8 == 2 else f"{version >> 8} of the format, but 1 is known"
        raise ValueError(f"its version is {version_text}: it is damaged")
    out = {}
    while file.left():
        kind, content = file.element()
        if kind == COMPRESSED:
            kind, content = _unpacked(content)
        if kind == MATRIX:
            name, value = _matrix(content, 0)
            if name and not name.startswith("__"):
                out[name] = value
    return out


def _unpacked(packed):
    """Return the element inside a compressed element."""
    worker = zlib.decompressobj()
    try:
        head = worker.decompress(packed.data, 8)
        if len(head) < 8:
            raise ValueError("a compressed variable is empty")
        kind, count = struct.unpack(f"{packed.order}2I", head)
        held = worker.decompress(worker.unconsumed_tail, _fits(count, MOST_PACKED * packed.left()) + 1)
    except zlib.error as error:
        raise ValueError(f"a compressed variable is damaged: {error}") from error
    if len(held) != count or not worker.eof:
        raise ValueError("a compressed variable has another length than stated")
    return kind, _Bytes(held, packed.order)


def _matrix(file, depth):
    """Name and value of a variable, an entry of a cell, or a field."""
    if not file.left():
        return "", np.empty((0, 0))
    if depth > DEEPEST:
        raise ValueError(f"structs and cells are nested more than {DEEPEST} deep")
    flags = _Bytes(file.element()[1].take(8), file.order).numbers(2)[0]
    kind = flags & 0xFF
    if kind not in (CELL, STRUCT, CHAR, *CLASSES):
        if kind != OPAQUE:
            file.element()  # The next element is the shape.
        return _text(file.element()), SPARSE_TOLD if kind == SPARSE else OBJECT_TOLD
    dims = file.element()[1]
    shape = dims.numbers(dims.left() // 4)
    name = _text(file.element())
    if min(shape, default=-1) < 0:
        raise ValueError(f"{name!r} has the shape {shape}")
    if kind == CHAR:
        return name, _characters(*file.element(), shape)
    if kind in CLASSES:
        value = _numbers(*file.element(), shape, CLASSES[kind])
        return name, _joined(value, _numbers(*file.element(), shape, CLASSES[kind])) if flags >> 8 & COMPLEX else value
    names = _fields(file) if kind == STRUCT else ()
    count = math.prod(shape)
    if count * (len(names) if kind == STRUCT else 1) * 8 > file.left():
        raise ValueError(f"{name!r} has {count} entries, more than the file can hold")
    out = np.empty(count, dtype=[(field, object) for field in names] if kind == STRUCT else object)
    for i in range(count):
        if kind == CELL:
            out[i] = _entry(file, depth)
        for field in names:
            out[field][i] = _entry(file, depth)
    return name, out.reshape(shape, order="F")


def _entry(file, depth):
    kind, content = file.element()
    if kind != MATRIX:
        raise ValueError(f"an element of kind {kind} is in the place of an array")
    return _matrix(content, depth + 1)[1]


def _text(element):
    return bytes(element[1].data).rstrip(b"\0").decode("utf-8", "replace")


def _fields(file):
    """Names of the fields of a struct. Repeated names get a number."""
    size = file.element()[1].numbers(1)[0]
    text = bytes(file.element()[1].data)
    if size < 1 or len(text) % size:
        raise ValueError(f"field names have {size} characters each, but {len(text)} characters in total")
    out: list[str] = []
    for start in range(0, len(text), size):
        name = text[start : start + size].split(b"\0")[0].decode("utf-8", "replace") or "field"
        out.append(name if name not in out else f"{name} ({start // size + 1})")
    return out


def _numbers(kind, content, shape, dtype) -> NDArray[Any]:
    """Return an array of MATLAB's class. The file may store the numbers in a smaller type."""
    if kind not in STORED or content.left() % int(STORED[kind][1]):
        raise ValueError(f"{content.left()} bytes of kind {kind} are no numbers")
    values = np.frombuffer(content.data, dtype=content.order + STORED[kind])
    if values.size != math.prod(shape):
        raise ValueError(f"{values.size} numbers do not fill an array of shape {list(shape)}")
    with np.errstate(invalid="ignore"):
        return values.astype(dtype).reshape(shape, order="F")


def _joined(real, imaginary):
    """Combine real and imaginary parts to complex numbers."""
    out = real.astype(complex)
    out.imag = imaginary
    return out


def _characters(kind, content, shape) -> NDArray[Any]:
    if kind not in TEXTS:
        raise ValueError(f"{content.left()} bytes of kind {kind} are no text")
    wide = {"<": "-le", ">": "-be"}[content.order] if TEXTS[kind] in ("utf-16", "utf-32") else ""
    return _rows(bytes(content.data).decode(TEXTS[kind] + wide, "replace"), shape)


def _rows(text, shape):
    """Return the rows of a character matrix, which is stored by columns, as an array of texts.

    Trailing blanks are removed, as in numpy.
    """
    count = math.prod(shape)
    if not count:
        return np.empty(0, dtype="U1")
    rows = math.prod(shape[:-1])
    if rows == 1:  # The shape counts a character outside the basic plane as two.
        return np.array([text]).reshape(shape[:-1])
    if len(text) != count:
        raise ValueError(f"{len(text)} characters do not fill a text of shape {list(shape)}")
    letters = np.array(list(text)).reshape(shape, order="F")
    return np.array(["".join(row) for row in letters.reshape(rows, shape[-1])]).reshape(shape[:-1])


def _old(data):
    """Read the variables of a MAT 4 file by scipy. Its reader for this version is not compiled and therefore safe."""
    from scipy.io import loadmat

    try:
        found = loadmat(io.BytesIO(data))
    except Exception as error:  # scipy does not check the file, so that a damaged file can raise any exception.
        raise ValueError(f"it has neither a header of MATLAB nor one of MAT 4 ({error})") from error
    return {key: value if isinstance(value, np.ndarray) else SPARSE_TOLD for key, value in found.items() if key[:2] != "__"}

"""File of one flexibility: a digest of key and content, then arrays in the format of `numpy.savez`.

A file is read only if the digest agrees with the requested key and with the content. Nothing in it is executed.
"""

import hashlib
import io
import json
from pathlib import Path
from typing import Any

import numpy as np

from ..core.files import written
from ..flexibility.arrays import described, restored
from ..geometry.tooth.gear import Gear

SIZE = hashlib.sha256().digest_size


def _digest(key, content):
    return hashlib.sha256(key.encode() + content).digest()


def write_flexibility(path: Path, key: str, found: Any) -> None:
    """Write a flexibility with the key that identifies it.

    The file is in place when it is complete, or not at all (ValueError).
    """
    arrays: list[Any] = []
    about = json.dumps(described(found, arrays)).encode()
    out = io.BytesIO()
    np.savez(out, np.frombuffer(about, dtype=np.uint8), *arrays)
    with written(path) as name:
        Path(name).write_bytes(_digest(key, out.getvalue()) + out.getvalue())


def read_flexibility(path: Path, key: str, gear: Gear) -> Any:
    """Return the flexibility of `gear` in a file, or None if the file is missing, damaged, or has another key."""
    try:
        content = path.read_bytes() if path.is_file() else b""
    except OSError:
        return None
    if content[:SIZE] != _digest(key, content[SIZE:]):
        return None
    with np.load(io.BytesIO(content[SIZE:]), allow_pickle=False) as archive:
        about, *arrays = (archive[name] for name in archive.files)
    return restored(json.loads(about.tobytes()), iter(arrays), gear)

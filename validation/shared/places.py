"""Paths of generated pages and tables, independent values and the README, and digest of the sources."""

import hashlib
from functools import cache
from pathlib import Path

from gearfe.stiffness.disk import sources

HOME = Path(__file__).parents[1]
PAGES = HOME / "pages"
TABLES = PAGES / "tables"
SOURCES = HOME / "sources"
ROOT = HOME.parent


@cache
def digest():
    """Return the digest of the sources of the library and of the validation, as twelve hexadecimal digits."""
    text = b"".join(path.read_bytes() for path in [*sources(), *sorted(HOME.rglob("*.py"))])
    return hashlib.sha256(text).hexdigest()[:12]

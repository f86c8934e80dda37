"""Where generated pages and tables, independent values and the README lie."""

from pathlib import Path

HOME = Path(__file__).parents[1]
PAGES = HOME / "pages"
TABLES = PAGES / "tables"
SOURCES = HOME / "sources"
ROOT = HOME.parent

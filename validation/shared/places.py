"""Where generated pages and tables, independent values and the README lie."""

import os
from pathlib import Path

HOME = Path(__file__).parents[1]
PAGES = Path(os.environ.get("GEARFE_PAGES") or HOME / "pages")  # `renew` lets a job write beside them until it has ended
TABLES = PAGES / "tables"
SOURCES = HOME / "sources"
ROOT = HOME.parent

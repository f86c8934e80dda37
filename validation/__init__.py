"""Comparison of gearfe with the literature and with independent solvers.

`make` contains one module for each page, `shared` common parts, `sources` printed values, and `pages` the generated Markdown,
pictures and tables. All runs use one thread, so that their times can be compared::

    python -m validation --list                 # pages, and the CPU seconds of each
    python -m validation truth sample           # computes these pages; all: every page
    python -m validation herringbone --reference  # computes the independent values of a page first
    python -m validation herringbone --text       # writes a page from its tables
    python -m validation check                  # computes some cheap rows again and compares them with the tables
"""

import os

# The variables have no effect after numpy is loaded.
for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(variable, "1")

"""Comparison of gearfe with the literature and with independent solvers.

`make` computes one page each, `shared` is what several pages use, `sources` are printed values, `pages` is what was generated:
Markdown, pictures, tables. Everything runs on one thread, because seconds and errors are compared::

    python -m validation --list                 # pages, and the CPU seconds of each
    python -m validation truth map              # computes these pages; all: every page
    python -m validation three --reference      # computes the independent values of a page first
    python -m validation three --text           # writes a page from its tables
    python -m validation check                  # computes some cheap rows again and compares them with the tables
"""

import os

# The variables have no effect after numpy is loaded.
for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(variable, "1")

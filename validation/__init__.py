"""What the literature and independent solvers report, and how close gearfe is.

`make` computes one page each, `shared` is what several of them use, `sources` are values of others as written, `pages` is what
was generated: Markdown, pictures, tables. Everything runs on one thread: seconds stand beside errors.

`pages/tables/state.jsonl` says of every row which commit and which code computed it, where and in how many seconds; the first
line of a page counts those of the present code. After a change of code::

    python -m validation --stale               # what is old, how long it takes; brings the first lines of pages up to date
    python -m validation renew --minutes 60    # computes the oldest again, slow tests too; whole files, at any stop
    python -m validation renew three slow      # the same of some pages
    python -m validation slow tests/FILE       # the slow tests of a file

Old is what called a function, imported a module or read a data file that says something else now; a function that was not called
counts with its signature only (`shared/state.py`, `shared/calls.py`). CI fails when something is old for more than 30 days.
"""

import os

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):  # before numpy loads
    os.environ.setdefault(variable, "1")

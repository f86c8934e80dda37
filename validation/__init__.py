"""What the literature and independent solvers report, and how close gearfe is.

`make` computes one page each, `shared` is what several of them use, `sources` are values of others as written, `pages` is what
was generated: Markdown, pictures, tables. Everything runs on one thread: seconds stand beside errors.
"""

import os

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):  # before numpy loads
    os.environ.setdefault(variable, "1")

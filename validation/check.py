"""Repeat of page rows that cost at most `MOST` CPU s, and comparison with the stored numbers.

A module of a page that has such rows names them by a function ``cheap()``, which yields for each row its name, the numbers on
file and a function that computes them. Times, memory and frozen pages have none. Pages without ``cheap`` have slow tests.
"""

import datetime
import importlib
import random
import time

import numpy as np

from gearfe.core.threads import own_warnings

from .shared.page import MACHINES

PAGES = (
    *("truth", "sample", "random_search", "herringbone", "joint"),
    *MACHINES,
)
DAYS = 10  # period in which every page is checked once [days]
LIMIT = 1e-4  # largest relative difference
MOST = 5.0  # limit per check [CPU s]
SECONDS = 75.0  # limit of all checks [s of clock time]


def pages_of(day):
    """Return the pages that are checked on a day, which is a whole number."""
    return [name for number, name in enumerate(PAGES) if number % DAYS == day % DAYS]


def check(day=None, seconds=SECONDS, pages=None):
    """Compute rows of the pages of a day again, in random order until the time is over, and print the comparisons.

    Parameters
    ----------
    day : int, optional
        Number of the day; default: today.
    seconds : float
        Of the clock, after which no row begins.
    pages : sequence of str, optional
        Pages; default: those of the day.

    Returns
    -------
    str or None
        The rows that differ by more than `LIMIT`, None if there are none.
    """
    day = datetime.date.today().toordinal() if day is None else day
    pages, end, wrong = pages or pages_of(day), time.monotonic() + seconds, []
    for number, page in enumerate(pages):
        until = time.monotonic() + (end - time.monotonic()) / (len(pages) - number)
        rows = list(cheap_rows(page))
        random.Random(day).shuffle(rows)
        done = 0
        while rows and time.monotonic() < until:
            name, known, compute = rows.pop()
            wrong += compared(f"{page}, {name}", known, compute)
            done += 1
        print(f"{page}: {done} of {done + len(rows)} cheap rows computed again", flush=True)
    return "\n".join(["differ from what is on file, see python -m validation PAGE:", *wrong]) if wrong else None


def cheap_rows(page):
    """Return the rows of a page that take little time: (name, stored numbers, function that computes them)."""
    home = importlib.import_module(f"validation.make.{'machines' if page in MACHINES else page}")
    return home.cheap(page) if page in MACHINES else home.cheap()


def compared(name, known, compute):
    """Compare a row with a new computation. Return a line with the largest relative difference, or None if both agree."""
    started = time.process_time()
    with own_warnings():
        found = compute()
    if (spent := time.process_time() - started) > MOST:
        print(f"  {name} took {spent:.1f} CPU s, more than {MOST:g}", flush=True)
    off = difference(known, found)
    return [f"  {name}: {off:.2g}"] if off > LIMIT else []


def difference(known, found):
    """Return the largest relative difference between two nestings of dicts, lists and numbers, or inf for other differences.

    Dicts are compared in the names that both have.
    """
    if isinstance(known, dict):
        return max((difference(known[name], found[name]) for name in known if name in found), default=np.inf)
    if isinstance(known, list | tuple):
        pairs = list(zip(known, found, strict=False))
        return max((difference(*pair) for pair in pairs), default=0.0) if len(known) == len(found) else np.inf
    if isinstance(known, str) or isinstance(found, str):
        return 0.0 if known == found else np.inf
    known, found = np.asarray(known, dtype=float), np.asarray(found, dtype=float)
    if known.shape != found.shape or (np.isnan(known) != np.isnan(found)).any():
        return np.inf
    with np.errstate(divide="ignore", invalid="ignore"):
        return float(np.nanmax(np.where(known == found, 0.0, np.abs(found / known - 1)), initial=0.0))

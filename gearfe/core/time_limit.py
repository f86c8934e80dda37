"""Limit of computing time: work whose estimate exceeds it is rejected before it begins.

The limit is two hours, or the number of hours in the environment variable ``GEARFE_MAX_HOURS``. Sweeps and data sets have none:
they are resumed, and `gearfe.plan_sweep` and ``--dry-run`` print their estimate.
"""

import math
import os

VARIABLE, HOURS = "GEARFE_MAX_HOURS", 2.0


def check_time(what: str, seconds: float, remedy: str) -> None:
    """Raise ValueError if the estimate [s] of `what` exceeds the limit; the message has both, and the `remedy`."""
    stated = os.environ.get(VARIABLE) or str(HOURS)
    try:
        limit = float(stated)
    except ValueError:
        limit = math.nan
    if not limit > 0:
        raise ValueError(f"{VARIABLE} = {stated!r}, but give a number of hours above 0")
    if not seconds <= 3600 * limit:
        raise ValueError(
            f"{what}: about {seconds / 3600:.2g} hours of computing, but the limit is {limit:g}: {remedy}, or raise the limit "
            f"(environment variable {VARIABLE})"
        )

"""Limit of computing time. Work whose estimated time exceeds the limit is rejected.

The limit is two hours, or the number of hours in the environment variable ``GEARFE_MAX_HOURS``. Single solves and runs are
estimated before they begin. Work in equal parts (positions, phases, cases of a sweep) is estimated by its first parts.
"""

import math
import os
import time

VARIABLE, HOURS = "GEARFE_MAX_HOURS", 2.0
SURE = 10.0  # elapsed time after which the finished parts predict the remaining cost [s]


def hours_allowed() -> float:
    """Return the limit [h]. Raises ValueError if the environment variable is no positive number."""
    stated = os.environ.get(VARIABLE) or str(HOURS)
    try:
        limit = float(stated)
    except ValueError:
        limit = math.nan
    if not limit > 0:
        raise ValueError(f"{VARIABLE} = {stated!r}, but give a number of hours above 0")
    return limit


def check_time(what: str, seconds: float, remedy: str) -> None:
    """Raise ValueError if the estimate [s] of `what` exceeds the limit. The message states both times and the `remedy`."""
    limit = hours_allowed()
    if not seconds <= 3600 * limit:
        raise ValueError(
            f"{what}: about {seconds / 3600:.2g} hours of computing, but the limit is {limit:g}: {remedy}, or raise the limit "
            f"(environment variable {VARIABLE})"
        )


class Clock:
    """Estimate of the total time of work in parts, from the completed parts.

    The first parts are ignored, because they include loading and compilation.
    """

    def __init__(self, idle: int = 1) -> None:
        self.idle, self.started, self.before = idle, 0.0, 0.0

    def check(self, what: str, share: float, remedy: str) -> None:
        """Raise ValueError if the whole work would exceed the limit. A `share` of it, 0 to 1, is done."""
        now = time.perf_counter()
        if self.idle:
            self.idle, self.started, self.before = self.idle - 1, now, share
        elapsed = now - self.started
        if share < 1 and elapsed > SURE:
            check_time(what, elapsed * (1 - self.before) / (share - self.before), remedy)

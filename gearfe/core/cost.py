"""Expected computing time and memory of one piece of work: rejected above the limits, announced if slow."""

import warnings
from typing import NamedTuple

from .memory import check_memory
from .time_limit import check_time

LITTLE = 1e8  # memory that is always free [bytes]
SLOW = 30.0  # Work with a longer expected time is announced before it begins [s].


class Cost(NamedTuple):
    """Expected processor time [s] and memory [bytes]."""

    seconds: float
    memory: float

    def __str__(self) -> str:
        """Time and memory with two digits."""
        return f"about {float(f'{self.seconds:.2g}'):g} s and {float(f'{self.memory / 1e9:.2g}'):g} GB"


def check_cost(what, cost: Cost, remedy: str, tell=None) -> None:
    """Reject work above the limits of time and memory, and announce slow work to `tell`, by default as a warning.

    Raises
    ------
    ValueError
        If the expected time or memory exceeds the limit; the message has the numbers and the `remedy`.

    Warns
    -----
    UserWarning
        If the expected time is above `SLOW` and there is no `tell`.
    """
    check_time(what, cost.seconds, remedy)
    if cost.memory > LITTLE:  # To read the free memory takes longer than quick work.
        check_memory(what, cost.memory, remedy)
    if cost.seconds > SLOW:
        told = f"{what} takes {cost}"
        tell(told) if tell else warnings.warn(told, stacklevel=5)

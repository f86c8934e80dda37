"""Expected computing time and memory of a planetary set, and their limits."""

from ..core.memory import check_memory
from ..core.time_limit import check_time

# memory [bytes] and time [s] of the first position by powers of refine, measured at refine 1, 2 and 4
BYTES, SECONDS, POWERS = 1.4e8, 0.65, (1.8, 2.3)
EACH = 0.005  # time of a further position [s], measured at refine 1


def set_seconds(positions: int, refine: float = 1.0) -> float:
    """Return the expected time of the positions of a set [s]."""
    return SECONDS * refine ** POWERS[1] + EACH * positions


def check_refine(refine: float) -> None:
    """Raise ValueError if the first position alone exceeds the limit of computing time, or the free memory."""
    what, remedy = f"refine = {refine:g}: one position of a set", "give a smaller refine"
    check_memory(what, BYTES * refine ** POWERS[0], remedy)
    check_time(what, set_seconds(0, refine), remedy)


def check_positions(count: int) -> None:
    """Raise ValueError if so many positions exceed the limit of computing time."""
    check_time(f"{count} positions of a set", EACH * count, "give fewer positions or cycles")

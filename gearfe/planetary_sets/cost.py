"""Expected computing time and memory of a planetary set, and their limits."""

from ..core.cost import Cost, check_cost
from ..core.time_limit import check_time

# memory [bytes] and time [s] of the first position by powers of refine, measured at refine 1, 2 and 4
BYTES, SECONDS, POWERS = 1.4e8, 0.65, (1.8, 2.3)
EACH = 0.005  # time of a further position [s], measured at refine 1


def set_cost(positions: int, refine: float = 1.0) -> Cost:
    """Return the expected `Cost` of the positions of a set."""
    return Cost(SECONDS * refine ** POWERS[1] + EACH * positions, BYTES * refine ** POWERS[0])


def check_refine(refine: float) -> None:
    """Raise ValueError if the first position alone exceeds the limit of computing time, or the free memory."""
    check_cost(f"refine = {refine:g}: one position of a set", set_cost(0, refine), "give a smaller refine")


def check_positions(count: int) -> None:
    """Raise ValueError if so many positions exceed the limit of computing time."""
    check_time(f"{count} positions of a set", EACH * count, "give fewer positions or cycles")

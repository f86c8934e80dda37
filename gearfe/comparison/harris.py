"""Harris map of a pair (S. L. Harris): transmission error under several loads, with modified and with unmodified flanks."""

from dataclasses import replace

from ..core.case import Case
from ..geometry.aliases import Floats
from ..stiffness.solve import Solve
from ..stiffness.transmission_error import TransmissionError, errors_of, errors_under_loads
from .losses import within


def harris(case: Case, how: Solve) -> tuple[TransmissionError, TransmissionError | None]:
    """Compute the transmission error of a case under its loads. For modified flanks, compute that of plain involutes too."""
    error = errors_under_loads(case, how)
    if not case.flanks:
        return error, None
    return error, errors_under_loads(replace(case, flanks=None), replace(how, method=error.curves[0].meta["method"]))


def over(error: TransmissionError | None, phases: Floats) -> TransmissionError | None:
    """Return the part of a transmission error at some of its phases."""
    if error is None:
        return None
    return errors_of(within(curve, phases) for curve in error.curves)

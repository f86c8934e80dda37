"""S. L. Harris's map of a scene's pair: transmission error under a row of loads, with its flanks and beside plain involutes."""

from typing import Any

from ..core.case import Case
from ..stiffness.transmission_error import TransmissionError, transmission_error


def harris(case: Case, **options: Any) -> tuple[TransmissionError, TransmissionError | None]:
    """Transmission error of a pair as it is and, if its flanks are modified, by the same method of the pair without `flanks`.

    Of a case under several loads; `options` as of `gearfe.Solve`.
    """
    error = transmission_error(case, **options)
    if not case.flanks:
        return error, None
    options["method"] = error.curves[0].meta["method"]
    return error, transmission_error(case, flanks=None, **options)

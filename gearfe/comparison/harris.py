"""S. L. Harris's map of a scene's pair: transmission error under a row of loads, with its flanks and beside plain involutes."""

from typing import Any

import numpy as np

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


def harris_table(found: TransmissionError, plain: TransmissionError | None, r_b: float) -> str:
    """Peak-to-peak, beside that of plain involutes if given, mean and first harmonics by load, as text [um].

    `found` and `plain` as of `harris`; `r_b` is the base radius of the pinion [mm], for its torque.
    """
    beside = found.peak_to_peak if plain is None else plain.peak_to_peak
    head = "" if plain is None else "  of involutes"
    lines = [f"   force [N]  torque [N m]  peak-to-peak{head}      mean  harmonics 1 to 3 [um]"]
    for i, parts in enumerate(found.harmonics(3)):
        other = "" if plain is None else f"  {1e6 * beside[i]:12.3f}"
        load = f"{found.force[i]:12.6g}  {1e-3 * found.force[i] * r_b:12.4g}"
        amplitudes = "  ".join(f"{1e6 * part:7.3f}" for part in parts)
        lines.append(f"{load}  {1e6 * found.peak_to_peak[i]:12.3f}{other}  {1e6 * found.te[i].mean():8.3f}  {amplitudes}")
    other = "" if plain is None else f"  {1e6 * np.ptp(plain.unloaded):12.3f}"
    mean = round(1e6 * float(found.unloaded.mean()), 3) + 0.0  # no -0.000
    return "\n".join([*lines, f"    unloaded  {'':12}  {1e6 * np.ptp(found.unloaded):12.3f}{other}  {mean:8.3f}"])

"""Fault frequencies of rolling bearings: FTF, BPFO, BPFI and BSF."""

import math

from ..core.checks import number, whole
from .given import hertz


def bearing_lines(
    turns: float, rollers: int, roller: float, pitch: float, contact_angle: float = 0.0, *, outer: float = 0.0, count: int = 1
) -> dict[str, float]:
    """Return fault frequencies of a rolling bearing without slip, for `gearfe.find_lines` and `gearfe.demodulate`.

    ::

        c = d cos(a) / D,  f = f_inner - f_outer
        cage     FTF  = f_inner (1 - c) / 2 + f_outer (1 + c) / 2
        outer    BPFO = rollers |f| (1 - c) / 2
        inner    BPFI = rollers |f| (1 + c) / 2
        roller   BSF  = |f| (1 - c**2) D / (2 d), its spin; a pit of a roller strikes twice per rotation

    Real rollers slip by 0.1 to some percent. Give `gearfe.find_lines` a tolerance.

    Parameters
    ----------
    turns : float
        Turns of the inner ring per second [Hz], 0 if only the outer ring turns.
    rollers : int
        Number of balls or rollers.
    roller, pitch : float
        Diameter d of a roller and of the circle of their centres D, in one unit.
    contact_angle : float
        [rad]
    outer : float
        Turns of the outer ring per second [Hz]; negative if it turns the other way.
    count : int
        Number of harmonics.

    Returns
    -------
    dict of str to float
        ``cage``, ``outer``, ``inner``, ``roller``, ``2 outer``, ... [Hz]

    Raises
    ------
    ValueError
        If sizes or angles are impossible for a bearing, or both rings turn at the same speed.

    References
    ----------
    R. B. Randall, J. Antoni, Mech. Syst. Signal Process. 25(2) (2011) 485-520, eqs. 1-4.

    Examples
    --------
    SKF 6205, 9 balls of 0.3126 on a circle of 1.537 inches, as the bearing data of Case Western Reserve University states
    them per turn: outer 3.5848, inner 5.4152, cage 0.39828; roller 4.7135 are its strikes, two a turn of it.

    >>> {name: round(value, 4) for name, value in bearing_lines(1.0, 9, 0.3126, 1.537).items()}
    {'cage': 0.3983, 'outer': 3.5848, 'inner': 5.4152, 'roller': 2.3567}
    """
    turns = number("turns", turns) and hertz("turns", turns)
    roller, pitch, contact_angle = number("roller", roller), number("pitch", pitch), number("contact_angle", contact_angle)
    if not math.isfinite(number("outer", outer)) or outer == turns:
        raise ValueError(f"outer = {outer!r} Hz with an inner ring of {turns} Hz: give a finite number other than that")
    largest = pitch * math.sin(math.pi / whole("rollers", rollers, 3))
    if not 0 < roller < largest * (1 + 1e-9):
        raise ValueError(
            f"roller = {roller}, but {rollers} rollers fit on the pitch diameter pitch = {pitch} only below {largest:.4g}: give "
            "both diameters in the same unit"
        )
    if not 0 <= contact_angle < math.pi / 2:
        raise ValueError(f"contact_angle = {contact_angle} rad, but it lies from 0 to below pi / 2")
    c, apart = roller * math.cos(contact_angle) / pitch, abs(turns - outer)
    fundamental = {
        "cage": abs(turns * (1 - c) + outer * (1 + c)) / 2,
        "outer": rollers * apart * (1 - c) / 2,
        "inner": rollers * apart * (1 + c) / 2,
        "roller": apart * (1 - c**2) * pitch / (2 * roller),
    }
    many = range(1, whole("count", count, 1, 1000) + 1)
    return {name if k == 1 else f"{k} {name}": k * value for k in many for name, value in fundamental.items()}

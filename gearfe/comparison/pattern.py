"""Contact pattern of a pair: largest pressure over a mesh cycle and load distribution along the width."""

import math
from dataclasses import dataclass

import numpy as np

from ..contact.wide_contact import Contact3D
from ..core.case import Case
from ..figures.contact_plot import plot_contact
from ..geometry.aliases import Floats, StrPath
from ..stiffness.pattern import contact_pattern
from .losses import damage_phases

PLACES = 400  # points along the width


@dataclass(frozen=True, slots=True)
class Pattern:
    """Contact over a mesh cycle. The damaged tooth of a pair is in the middle of its engagement.

    `contact` is the result of `gearfe.contact_pattern`. `pressure` is the largest Hertzian pressure [MPa], at `phase`, at
    `radius` on the pinion and height `z` [mm]. `factor` is the largest over the mean load per width (`face_load_distribution`).
    `corners` is the number of phases at which a tip corner carries load. Pressure is unbounded there, and the largest is that of
    the other phases.
    """

    contact: Contact3D
    pressure: float
    phase: float
    radius: float
    z: float
    factor: float
    corners: int

    def told(self) -> str:
        """Return the pattern in words."""
        count = self.contact.phase.size
        lines = [
            f"largest pressure {self.pressure:.0f} MPa at phase {self.phase:.3g}, radius {self.radius:.5g} mm of the pinion, "
            f"height {self.z:.3g} mm",
            f"face load factor {self.factor:.2f}: largest over mean load per width, all pairs together, mean of {count} phases",
        ]
        if self.corners:
            lines.append(
                f"a tip corner carries at {self.corners} of {count} phases: its pressure is beyond Hertz's theory and not printed"
            )
        return "\n".join(lines)


def pattern_of(case: Case, phases: int = 24) -> Pattern:
    """Contact pattern of a case, with its damaged tooth in the middle of its engagement if it has one."""
    contact = contact_pattern(case, phases=damage_phases(case, phases) if case.damaged else phases)
    pressures = [np.where(np.isnan(cells.pressure), -math.inf, cells.pressure) for cells in contact.cells]
    most = int(np.argmax([of_phase.max() for of_phase in pressures]))
    cells, at = contact.cells[most], int(np.argmax(pressures[most]))
    corners = sum(bool(((cell.corner > 0) & (cell.load > 0)).any()) for cell in contact.cells)
    load = face_load_distribution(contact)[1]
    return Pattern(
        contact, float(pressures[most][at]), float(contact.phase[most]), math.hypot(case.pair.gear_1.r_b, cells.roll_1[at]),
        float(cells.z[at]), float(load.max() / load.mean()), corners,
    )  # fmt: skip


def render_pattern(case: Case, path: StrPath, *, title: str = "") -> Pattern:
    """Draw the contact pattern of a case (`gearfe.plot_contact`), and return the result of `pattern_of`."""
    pattern = pattern_of(case)
    plot_contact(case.pair, pattern.contact, None, path, case.pits[0], title)
    return pattern


def face_load_distribution(contact: Contact3D) -> tuple[Floats, Floats]:
    """Load per width along the face, summed over all tooth pairs and averaged over the phases.

    Its largest value over its mean is the face load factor. Over a whole mesh cycle the contact lines of helical teeth pass all
    heights equally. Remaining variations are caused by flanks, axes and bodies.

    Parameters
    ----------
    contact : Contact3D
        See `gearfe.contact_pattern`.

    Returns
    -------
    z, load : ndarray, shape (n,)
        Heights [mm], and the normal force per width there [N/mm].

    Examples
    --------
    >>> import math, gearfe as gf
    >>> rack = dict(m_n=3.0, alpha_n=math.radians(20), b=12.0)
    >>> pair = gf.GearPair(gf.Gear(z=24, r_bore=15.0, **rack), gf.Gear(z=30, r_bore=18.0, **rack))
    >>> for askew in (0.0, 0.02):  # mm, wider open at z = b than at z = 0
    ...     shape = gf.Misalignment(F_beta_x=askew)
    ...     contact = gf.contact_pattern(pair, 2000.0, gf.Material(E=207e3, nu=0.3), misalignment=shape, phases=4)
    ...     z, load = gf.face_load_distribution(contact)
    ...     print(f"{load.mean():.0f} N/mm, face load factor {load.max() / load.mean():.2f}")
    167 N/mm, face load factor 1.02
    167 N/mm, face load factor 3.04
    """
    ends = [(cells.z - cells.width / 2, cells.z + cells.width / 2, cells.load / cells.width) for cells in contact.cells]
    low, high, line = (np.concatenate(part) for part in zip(*ends, strict=True))
    edge = np.linspace(low.min(), high.max(), PLACES + 1)
    z = (edge[1:] + edge[:-1]) / 2
    over = [(low <= at) & (high > at) for at in z]
    covered = np.array([mask.any() for mask in over])  # The relief groove of a herringbone pair is excluded.
    load = np.array([float(line[mask].sum()) for mask in over]) / len(contact.cells)
    return z[covered], load[covered]

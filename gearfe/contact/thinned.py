"""Additional bending of teeth that are thinner because of their flank modifications.

The flexibility of a gear is that of unmodified teeth. Material removed from one or both flanks takes w from the half thickness h
of a section, so that a beam of varying section bends more, between loads at s and s' by::

    dS(s, s') = int 3/2 M(s) M(s') / E' D(h**-3) + N(s) N(s') / (2 E') D(h**-1) + 3/5 V(s) V(s') / G D(h**-1) dy

up to the lower load, with M, N, V of unit loads and ``D(f) = f(h - w) - f(h)``. The rotation of the
tooth root increases by the change of ``16.67 M / (pi E' (2 h)**2)``, with h at the 30-degree tangents. The fillet is thinned like
the form point. Beam theory is used for this difference only: about 1 % of the deflection for a few hundredths of a module.

References
----------
W. J. O'Donnell, J. Appl. Mech. 27 (1960) 461-464.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.material import Material
from ..geometry.aliases import Floats
from ..geometry.tooth.flank_form import FlankForm
from ..geometry.tooth.profile import fillet, flank, tangent_point
from ..geometry.tooth.side import place

FOOT = 16.67 / math.pi  # rotation of a root section of unit thickness under a unit moment, times E'
POINTS = 200  # cross-sections between root and tip circle
# relative error of the flexibility change, from finite elements of thinned teeth (``tests/contact/test_thinned_flexibility.py``)
UNSURE = 1 / 4


class Thinning:
    """Additional flexibility of the teeth of a gear with modified flanks, per width [mm per N/mm]."""

    def __init__(self, form: FlankForm, material: Material, state: str):
        self.form, self.gear = form, form.gear
        self.stretch, self.shear = material.plane_modulus(state), material.shear_modulus
        self._tables: dict[int, tuple[NDArray, NDArray]] = {}

    def between(self, roll: Floats, tooth: int) -> Floats:
        """Return the additional flexibility ``(n, n)`` between loads at roll lengths ``(n,)`` [mm] on one tooth."""
        loads = self._loads(roll)
        return self._bent([values[:, None] for values in loads], loads, tooth)

    def alone(self, roll: ArrayLike, teeth: ArrayLike) -> Floats:
        """Return the additional flexibility ``(..., n)`` of single loads at roll lengths ``(..., n)`` on `teeth` ``(n,)``."""
        rolls, out = np.asarray(roll, dtype=float), np.zeros(np.shape(roll))
        for column, tooth in enumerate(np.asarray(teeth).tolist()):
            loads = self._loads(rolls[..., column])
            out[..., column] = self._bent(loads, loads, tooth)
        return out

    def _bent(self, one, two, tooth):
        """Return the additional displacement of the loads `one` of a tooth under the loads `two`, see `_loads`."""
        (height_1, moment_1, lever_1, along_1), (height_2, moment_2, lever_2, along_2) = one, two
        (heights, integrals), sense = self._table(tooth), self.gear.outward
        at = np.minimum(sense * height_1, sense * height_2)
        plain, first, second, thin = (np.interp(at, sense * heights, row) for row in integrals)
        bending = moment_1 * moment_2 * plain - (moment_1 * lever_2 + lever_1 * moment_2) * first + lever_1 * lever_2 * second
        straight = along_1 * along_2 / (2 * self.stretch) + 0.6 * lever_1 * lever_2 / self.shear
        return 1.5 * bending / self.stretch + straight * thin

    def _loads(self, roll):
        """Return heights of unit loads, and the terms of their section forces: M = moment - lever y, V = lever, and N.

        Loads in the fillet are placed at the form point.
        """
        at = np.clip(roll, *sorted((self.form.low, self.form.high)))
        radius, angle = flank(self.gear, at)
        turn = self.gear.base_half_angle - self.gear.outward * at / self.gear.r_b
        x, y, lever, along = radius * np.sin(angle), radius * np.cos(angle), np.cos(turn), np.sin(turn)
        return y, lever * y + along * x, lever, along

    def lost(self, tooth: int) -> float:
        """Part of the half thickness that is removed at the foot of a tooth."""
        _, half, left = self._sections(tooth)
        return float(1 - left[0] / half[0])

    def _sections(self, tooth):
        """Return heights, half thicknesses and remaining half thicknesses [mm], at the foot, then from root to tip circle."""
        foot = float(fillet(self.gear, tangent_point(self.gear))[0])
        radius = np.append(foot, np.linspace(self.gear.r_f, self.gear.r_a, POINTS + 1))
        angle = place(self.gear, radius).angle
        half = radius * np.sin(angle)
        removed = self.form.thinned(np.sqrt(np.maximum(radius**2 - self.gear.r_b**2, 0.0)), tooth)
        share = 1.0 if self.form.flank.both_sides else 0.5
        return radius * np.cos(angle), half, np.maximum(half - share * radius * removed / self.gear.r_b, 0.1 * half)

    def _table(self, tooth):
        """Return heights y from root to tip, and the integrals up to them of D(h**-3) times 1, y and y**2, and of D(h**-1)."""
        key = tooth % self.gear.z if self.form.differs else 0
        if key not in self._tables:
            y, half, left = self._sections(tooth)
            cubed, plain, squared = (left**-power - half**-power for power in (3.0, 1.0, 2.0))
            base = FOOT / 1.5 / 4 * squared[0] * np.array([1.0, y[0], y[0] ** 2, 0.0])
            parts = np.array([cubed, y * cubed, y**2 * cubed, plain])[:, 1:]
            steps = np.diff(np.abs(y[1:] - y[1])) * (parts[:, 1:] + parts[:, :-1]) / 2
            self._tables[key] = y[1:], np.cumsum(np.column_stack([base, steps]), axis=1)
        return self._tables[key]


def thinned_teeth(flanks: Any, materials: Any, state: str, points: Any) -> tuple[list[Thinning], Floats]:
    """Return the `Thinning` of both gears (None without flanks), and the flexibility added to pairs at `points` [mm per N/mm]."""
    gears = [Thinning(form, material, state) for form, material in zip(flanks or (), materials, strict=False)]
    rolls = points.rolls
    return gears, sum(
        (one.alone(roll, points.order) for one, roll in zip(gears, rolls, strict=False)), np.zeros(points.gap.shape)
    )


def unmodelled(case: Any, found: Any) -> Floats:
    """Excess of k ``(phases,)`` [N/m] in a `Contact3D` because its teeth are modelled with their full thickness.

    By virtual work the approach increases by ``sum q**2 dS dz / F``, with the line loads q and the flexibility dS of the section.
    """
    out = np.zeros(found.k.size)
    for which, form in enumerate(case.forms or ()):
        thin = Thinning(form, case.materials[which], "plane strain")
        for i, cells in enumerate(found.cells):
            roll = cells.rolls[which]
            for order in np.unique(cells.order).tolist():
                on = cells.order == order
                yields = thin.alone(roll[on, None], [order])[:, 0]
                out[i] += (cells.load[on] ** 2 / cells.width[on] * np.abs(yields)).sum() / cells.load.sum()
    closing = found.approach - (0.0 if found.unloaded is None else found.unloaded)
    return found.k * out / closing

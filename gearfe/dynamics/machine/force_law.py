"""`ForceLaw`: the force of a gear mesh over its deflection and its phase, from the contact solved under several loads.

A larger load flattens the contact and brings tooth pairs into contact earlier. A stiffness over the phase is therefore valid
for one load only. A force law is ``F(depth, phase)``. Depth is the approach of the flanks after first contact. Small vibrations
about a load have the tangent stiffness ``dF/d depth``.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Unpack

import numpy as np
import scipy
from numpy.typing import ArrayLike, NDArray

from ...core.case import Case
from ...core.checks import number
from ...core.material import Material
from ...core.record import settle
from ...geometry.aliases import Floats
from ...geometry.pair.gear_pair import GearPair
from ...stiffness.curve import StiffnessCurve, joined
from ...stiffness.mesh_stiffness import PairOptions, split_arguments
from ...stiffness.solve import Solve, solve
from .secant import Secant

ROWS, COLUMNS = 1024, 64  # table size of a force law: phases per mesh cycle, deflections
BETWEEN = 7  # additional phases solved between two phases if the number of pairs in contact changes between them at any load


@dataclass(frozen=True, slots=True)
class ForceLaw:
    """Force of a mesh over depth and phase, which `gearfe.dynamics.machine.gear_mesh.GearMesh` takes instead of a stiffness.

    Between two solved loads the force is a cubic through their values and tangents. If a tooth pair comes into contact between
    them, the force follows the two tangents up to their intersection. Below the smallest load the secant stiffness is
    constant. Above the largest load the force continues with its tangent.

    Attributes
    ----------
    phase : ndarray, shape (n,)
        Increasing mesh phases of one cycle, or of the whole engagement of a damaged tooth.
    load : ndarray, shape (m,)
        Solved loads [N], increasing. The law is valid between the first and the last.
    depth, tangent : ndarray, shape (n, m)
        Deflection of the mesh under the loads [m] and its tangent stiffness [N/m].
    pairs : ndarray of int, shape (n, m)
        Number of tooth pairs under load, 0 if a model does not state it.
    force : float
        Load [N] whose secant stiffness is used where a single stiffness over the phase is needed: damping by `zeta` or
        `damping_per_stiffness`, and the first step of an integration.
    unloaded : ndarray, shape (n,), optional
        Transmission error without load [m], of modified flanks.
    secant : Secant
        The law as the table that integrators look up.
    """

    phase: Floats
    load: Floats
    depth: Floats
    tangent: Floats
    pairs: NDArray[np.int64]
    force: float
    unloaded: Floats | None = None
    secant: Secant = field(init=False)

    def __post_init__(self) -> None:
        """Compute the table. Raises ValueError if loads, phases or depths do not increase."""
        if not self.depth.shape == self.tangent.shape == self.pairs.shape == (*self.phase.shape, *self.load.shape):
            raise ValueError("a force law needs depth, tangent stiffness and pairs of the shape (phases, loads)")
        if self.load.size < 2 or not (np.diff(self.load) > 0).all() or not self.load[0] > 0:
            raise ValueError(f"loads {self.load} N: a force law needs two or more, all different and above 0")
        if self.phase.size < 2 or not (np.diff(self.phase) > 0).all():
            raise ValueError("a force law needs two or more increasing phases")
        if not self.force > 0:
            raise ValueError(f"force = {self.force:g} N, but a mesh is pressed together: give a force > 0")
        closing = np.diff(self.depth, axis=1, prepend=0.0)
        if not (np.isfinite(closing).all() and (closing > 0).all() and (self.tangent > 0).all()):
            i, j = np.argwhere(~((closing > 0) & (self.tangent > 0)))[0]
            raise ValueError(
                f"at phase {self.phase[i]:g}, the deflection under {self.load[j]:g} N is not larger than under the smaller load: "
                "give curves of one pair, solved in the same way"
            )
        settle(self, secant=_table(self))

    def __repr__(self):
        """Return one line with the numbers of phases and loads."""
        loads = f"{self.load.size} loads from {self.load[0]:g} to {self.load[-1]:g} N"
        return f"<ForceLaw: {self.phase.size} phases from {self.phase[0]:.3g} to {self.phase[-1]:.3g}, {loads}>"

    def with_compliance(self, added: Floats) -> "ForceLaw":
        """Return the law in series with a further compliance at its phases ``(n,)`` [m/N]."""
        depth, tangent = self.depth + added[:, None] * self.load, 1 / (1 / self.tangent + added[:, None])
        return replace(self, depth=depth, tangent=tangent)

    @classmethod
    def of(cls, curves: Sequence[StiffnessCurve], force: float | None = None) -> "ForceLaw":
        """Return the force law of curves of one pair under several loads, at the same phases.

        Parameters
        ----------
        curves : sequence of StiffnessCurve
            As `mesh_stiffness` gives them for a list of loads.
        force : float, optional
            See the class; default: the load in the middle of the list, by size.

        Raises
        ------
        ValueError
            If they do not belong together: other phases, a load twice, a deflection that falls as the load rises.
        """
        if not all(isinstance(curve, StiffnessCurve) and "force_N" in curve.meta for curve in curves):
            raise ValueError(
                "a force law needs a list of StiffnessCurve, each with its load: mesh_stiffness(pair, [F1, F2, ...])"
            )
        curves = sorted(curves, key=lambda loaded: float(loaded.meta["force_N"]))
        if any(curve.phase.shape != curves[0].phase.shape or not np.allclose(curve.phase, curves[0].phase) for curve in curves):
            raise ValueError("the curves of a force law must have the same phases: solve all loads in one call")
        order = np.argsort(curves[0].phase, kind="stable")
        load = np.array([curve.meta["force_N"] for curve in curves], dtype=float)
        depth, tangent, pairs = (
            np.array(rows).T[order]
            for rows in zip(
                *((curve.deflection, curve.k_tangent, (curve.force > 0).sum(axis=1)) for curve in curves), strict=True
            )
        )
        unloaded = curves[0].unloaded
        return cls(
            curves[0].phase[order],
            load,
            depth,
            tangent,
            pairs,
            float(load[load.size // 2]) if force is None else number("force", force),
            None if unloaded is None else unloaded[order],
        )

    def __call__(self, depth: ArrayLike, phase: ArrayLike) -> Floats:
        """Return the force [N] at depths [m] and phases: 0 for separated flanks (depth below 0), periodic over a cycle."""
        phase = np.asarray(phase, dtype=float)
        return self.secant(phase % 1.0 if self.periodic else phase, depth)[0] * np.maximum(depth, 0.0)

    @property
    def periodic(self) -> bool:
        """True if the law covers one whole mesh cycle."""
        ends = self.phase[0] + 1 - self.phase[-1]
        return bool(0 < ends <= 1.5 * np.diff(self.phase).max() and self.phase[0] >= 0)

    def at(self, force: float) -> tuple[Floats, Floats]:
        """Return the phases of the table, and the secant stiffness [N/m] at them under a constant `force` [N]."""
        k, depths = self.secant.k, self.secant.depths
        depth = np.array([np.interp(force, row * depths, depths) for row in k])
        phase = np.asarray(self.secant.start + self.secant.width * np.arange(len(k)), dtype=np.float64)
        secant = self.secant(phase, depth)[0]
        return (phase[1:-2], secant[1:-2]) if self.periodic else (phase, secant)


def _table(law):
    """Return the `Secant` of a law: over depth at each phase, then over phase by monotone cubics.

    See F. N. Fritsch, J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300-304.
    """
    deepest = float(law.depth.max())
    depth = deepest * np.linspace(0.0, 1.0, COLUMNS) ** 2
    k = np.array([_secant(*row, law.load, depth) for row in zip(law.depth, law.tangent, law.pairs, strict=True)])
    phase = law.phase
    if not law.periodic:
        rows = max(3, round((phase[-1] - phase[0]) * ROWS) + 1)
        at = np.linspace(phase[0], phase[-1], rows)
        return Secant(float(phase[0]), float(at[1] - at[0]), deepest, scipy.interpolate.PchipInterpolator(phase, k, axis=0)(at))
    near = min(3, phase.size)
    phase = np.concatenate([phase[-near:] - 1, phase, phase[:near] + 1])
    k = np.concatenate([k[-near:], k, k[:near]])
    return Secant(
        -1 / ROWS, 1 / ROWS, deepest, scipy.interpolate.PchipInterpolator(phase, k, axis=0)(np.arange(-1, ROWS + 2) / ROWS)
    )


def _secant(deep, tangent, pairs, load, depth):
    """Return the secant stiffness over `depth` at one phase, from the loads, their deflections and the tangents there."""
    i = np.clip(np.searchsorted(deep, depth, side="right") - 1, 0, load.size - 2)
    wide, on = deep[i + 1] - deep[i], depth - deep[i]
    u = on / wide
    cubic = load[i] * (1 + 2 * u) * (1 - u) ** 2 + load[i + 1] * u * u * (3 - 2 * u)
    cubic = cubic + wide * u * (1 - u) * ((1 - u) * tangent[i] - u * tangent[i + 1])
    bent = np.maximum(load[i] + tangent[i] * on, load[i + 1] - tangent[i + 1] * (deep[i + 1] - depth))
    force = np.where(pairs[i] == pairs[i + 1], cubic, bent)
    force = np.where(depth > deep[-1], load[-1] + tangent[-1] * (depth - deep[-1]), force)
    return np.where(depth < deep[0], load[0] / deep[0], force / np.maximum(depth, deep[0]))


def force_law(
    pair: GearPair | Case,
    forces: Sequence[float] | Floats,
    material: Material | tuple[Material, Material] | None = None,
    *,
    force: float | None = None,
    phases: int = 128,
    span: str = "cycle",
    **options: Unpack[PairOptions],
) -> ForceLaw:
    """Compute the load-dependent force law of a gear pair for dynamic models: its contact solved under several loads.

    Parameters
    ----------
    pair : GearPair or Case
    forces : sequence of float
        Increasing loads along the line of action [N], up to the largest mesh force. With a ratio of 1.4 between successive
        loads, the error of accelerations is about 1 %; with a ratio of 2 it is 3 %.
    material : Material or (Material, Material)
    force : float, optional
        The load at which the mesh works on average, see `ForceLaw`; default: that in the middle.
    phases : int
        Per mesh cycle; between two of them `BETWEEN` more are solved where the number of pairs that carry changes, which
        depends on the load.
    span : {"cycle", "tooth"}
        ``tooth`` for the law of a damaged tooth (`gearfe.dynamics.machine.tooth_damage.ToothDamage`).
    **options
        Options of `mesh_stiffness`: ``method``, ``damage``, ``flanks`` and so on.

    Returns
    -------
    ForceLaw

    Raises
    ------
    ValueError
        If an input is impossible; the message states which.

    Examples
    --------
    >>> import math, gearfe as gf
    >>> rack = dict(m_n=2.0, alpha_n=math.radians(20), b=20.0)
    >>> pair = gf.GearPair(gf.Gear(z=21, r_bore=7.4, **rack), gf.Gear(z=31, r_bore=11.4, **rack))
    >>> law = gf.force_law(pair, [100.0 * 2**i for i in range(6)], gf.Material(E=207e3, nu=0.25))
    >>> [round(float(law(depth, 0.25))) for depth in (-1e-6, 0.0, 5e-6)]
    [0, 0, 1748]
    """
    own = {**options, "phases": phases, "span": span}
    return law_of(*split_arguments("force_law", pair, list(forces), material, None, own), force)


def law_of(case: Case, how: Solve, force: float | None = None) -> ForceLaw:
    """Return the `ForceLaw` of a case under its loads, with extra phases where the number of pairs in contact changes."""
    if how.span not in ("cycle", "tooth"):
        raise ValueError(
            f"span = {how.span!r}, but it must be 'cycle' (a mesh cycle) or 'tooth' (the engagement of a damaged tooth)"
        )
    curves = solve(case, how)
    law = ForceLaw.of([curve.without_supports() for curve in curves], force)
    counts = np.concatenate([law.pairs, law.pairs[:1]]) if how.span == "cycle" else law.pairs
    ends = np.append(law.phase, law.phase[0] + 1) if how.span == "cycle" else law.phase
    changing = (np.maximum(counts[:-1], counts[1:]).max(axis=1) != np.minimum(counts[:-1], counts[1:]).min(axis=1)).nonzero()[0]
    if not changing.size:
        return law
    parts = np.arange(1, BETWEEN + 1) / (BETWEEN + 1)
    extra = (ends[changing, None] + np.diff(ends)[changing, None] * parts).ravel()
    finer = solve(case, replace(how, phases=extra))
    return ForceLaw.of([joined(both).without_supports() for both in zip(curves, finer, strict=True)], force)

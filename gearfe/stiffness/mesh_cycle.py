"""`MeshCycle`: stiffness and unloaded transmission error of a pair with unequal teeth, until they repeat.

Two teeth k of pinion and wheel form pair k, which enters at phase -k. A tooth that differs from the others (damage, pitch, scale,
eccentricity) returns after the z cycles of its gear. Two teeth of both gears meet again after the hunting period. Each distinct
tooth is solved once, over all phases at which it or a neighbour is in mesh.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import scipy

from ..core.case import Case
from ..geometry.aliases import Floats
from ..geometry.checks import WrongTypeError, shown
from .curve import StiffnessCurve, joined
from .deviating_teeth import like_all, meetings, windows
from .finer import finer, repeated
from .limits import check_count
from .solve import Solve, solve

AT_ONCE = 16  # mesh cycles per call, because the memory grows with their square
LONGEST = 64_000  # largest number of phases of a part to which further ones are added, because tables of machines grow with them
ON = 1e-9  # tolerance of equal phases [mesh cycles]


class Part(NamedTuple):
    """Stiffness over the mesh cycles in which some teeth differ from the others.

    Attributes
    ----------
    gears : tuple of int
        0: pinion, 1: wheel. Of both, the teeth that differ are in mesh with each other, or next to each other.
    teeth : tuple of int
        Numbers of the teeth, of a part of one gear.
    position : int
        Mesh cycle at which the first of these teeth enters; phase 0 of the curve.
    period : int
        Mesh cycles after which the same teeth return.
    curve : StiffnessCurve
        Stiffness and unloaded transmission error over the phases at which they differ from those of a healthy cycle.
    """

    gears: tuple[int, ...]
    teeth: tuple[int, ...]
    position: int
    period: int
    curve: Any


@dataclass(frozen=True, slots=True)
class MeshCycle:
    """Pair with individual teeth: one healthy mesh cycle, and a curve for each distinct deviating tooth.

    Attributes
    ----------
    case : Case
    phases : int
        Samples per mesh cycle. A fine cycle has further phases between them.
    healthy : StiffnessCurve
        One mesh cycle of teeth without damage and deviations from tooth to tooth.
    parts : tuple of Part
        Of pinion, of wheel, then of both where their teeth that differ meet.
    """

    case: Case
    phases: int
    healthy: Any
    parts: tuple[Part, ...]

    def __post_init__(self) -> None:
        """Raise ValueError unless the cycle has phases and a curve."""
        check_count(self.phases)
        _checked(self.healthy)

    @property
    def cycles(self) -> int:
        """Mesh cycles after which the pair repeats: 1, the teeth of a gear, or the hunting period."""
        return math.lcm(1, *(part.period for part in self.parts))

    def sampled(self, name: str = "k", phase: Floats | None = None) -> Floats:
        """Return ``k`` [N/m], ``deflection`` [m] or ``unloaded`` [m] at phases, by monotone cubics between solved phases.

        By default the phases are the equally spaced samples of all `cycles`, ``(cycles phases,)``.
        """
        phase = np.arange(self.cycles * self.phases) / self.phases if phase is None else phase
        usual = scipy.interpolate.PchipInterpolator(*repeated(self.healthy.phase, _values(self.healthy, name), 1.0))
        healthy = usual(phase % 1.0)
        out = healthy.copy()
        for part in self.parts:
            own, change = part.curve.phase, _values(part.curve, name) - usual(part.curve.phase % 1.0)
            at = own[0] + (phase - part.position - own[0] + ON) % part.period - ON
            if own[0] + part.period - own[-1] < 1.5 * np.diff(own).max():
                own, change = repeated(own, change, part.period)
            on = at < own[-1] + ON
            out[on] = (healthy if len(part.gears) == 2 else out)[on] + scipy.interpolate.PchipInterpolator(own, change)(at[on])
        return out

    @property
    def solved(self) -> Floats:
        """Rising phases of all `cycles` at which the contact was solved ``(n,)``."""
        spans = [(self.healthy.phase, 0, 1), *((part.curve.phase, part.position, part.period) for part in self.parts)]
        every = [own + position + np.arange(0, self.cycles, period)[:, None] for own, position, period in spans]
        phase = np.sort(np.concatenate([one.ravel() % self.cycles for one in every]))
        return phase[np.diff(phase, prepend=-1.0) > ON]


def mesh_cycle(
    case: Case, how: Solve | None = None, *, fine: bool = False, curve: Callable[[Case, Solve], Any] = solve
) -> MeshCycle:
    """Compute the `MeshCycle` of a `Case`. Each distinct deviating tooth is solved once.

    Parameters
    ----------
    case : Case
        Damage and flanks number the teeth of each gear; tooth k of both is in pair k, which enters at phase -k.
    how : Solve, optional
        Its `phases` are a number per mesh cycle.
    fine : bool
        True: the curves have further phases where pairs enter or leave. Machines and exported tables use such curves.
    curve : callable, optional
        ``curve(case, how)`` is solved instead of `solve`, for example for a force law.

    Returns
    -------
    MeshCycle

    Raises
    ------
    ValueError
        If the phases are spelled out, or every cycle of a hunting period of more than `MOST` phases differs; as `solve`.

    Examples
    --------
    A crack in tooth 5 of the pinion returns after 21 cycles:

    >>> import math, gearfe as gf
    >>> rack = dict(m_n=2.0, alpha_n=math.radians(20), b=20.0)
    >>> pair = gf.GearPair(gf.Gear(z=21, r_bore=7.4, **rack), gf.Gear(z=31, r_bore=11.4, **rack))
    >>> case = gf.Case(pair, 2000.0, gf.Material(E=207e3, nu=0.25), damage={"pinion": [gf.Crack(level=0.3, tooth=5)]})
    >>> cycle = gf.mesh_cycle(case, gf.Solve(phases=16))
    >>> cycle.cycles, cycle.parts[0].teeth, cycle.parts[0].position
    (21, (5,), 16)
    """
    how = how or Solve()
    n = check_count(how.phases)
    if how.method == "auto":  # One method must be used for all compared cases.
        how = replace(how, method=how.chosen(case)[0].name)
    how = replace(how, span="cycle")
    both = [windows(case, side, n) for side in (0, 1)]
    spans = meetings(case, both, n)
    like = like_all(case, (0, 1))
    healthy = _checked(curve(like, how))
    if fine := fine and isinstance(healthy, StiffnessCurve):
        healthy = finer(healthy, lambda at: curve(like, replace(how, phases=at)), 1.0)

    def solved(one, start, stop, position, period):
        at = partial(_in_parts, curve, one, how, stop - start > AT_ONCE * n)
        found = at(np.arange(start, stop) / n)
        if fine and stop - start <= LONGEST:
            found = finer(found, at, period if stop - start == period * n else None, healthy)
        return replace(found, phase=found.phase - position)

    parts = []
    for side, groups in enumerate(both):
        alone, z = like_all(case, (1 - side,)), case.pair.gears[side].z
        for window in groups:
            found = solved(alone, window.start, window.stop, window.position, z)
            parts.append(Part((side,), window.teeth, window.position, z, found))
    hunting = math.lcm(*(gear.z for gear in case.pair.gears))
    for start, stop in spans:
        position = 0 if stop - start == hunting * n else -(-start // n)
        parts.append(Part((0, 1), (), position, hunting, solved(case, start, stop, position, hunting)))
    return MeshCycle(case, n, healthy, tuple(parts))


def _in_parts(curve, case, how, bare, phases):
    """Return the curve at rising phases, solved for `AT_ONCE` mesh cycles at a time. A `bare` curve has no forces by pair."""
    parts = np.split(phases, np.searchsorted(phases, np.arange(phases[0] + AT_ONCE - ON, phases[-1] + ON, AT_ONCE)))
    found = [_checked(curve(case, replace(how, phases=part, span="tooth"))) for part in parts if part.size]
    if len(found) > 1 and not all(isinstance(one, StiffnessCurve) for one in found):
        raise ValueError(
            "a force law over several loads allows single deviating teeth, but here all teeth of a gear deviate: give one load"
        )
    if bare and isinstance(found[0], StiffnessCurve):
        found = [replace(one, order=one.order[:0], force=one.force[:, :0], pressure=one.pressure[:, :0]) for one in found]
    return joined(found) if len(found) > 1 else found[0]


def _checked(curve):
    """Return a curve. Raises ValueError for anything else."""
    if not hasattr(curve, "phase"):
        raise WrongTypeError(f"mesh cycle: curve = {shown(curve)}, but give a StiffnessCurve or a ForceLaw")
    return curve


def _values(curve, name):
    values = getattr(curve, name)
    return np.zeros(curve.phase.size) if values is None else values

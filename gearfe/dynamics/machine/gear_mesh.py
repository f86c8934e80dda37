"""Gear mesh of a machine: row, stiffness over the mesh phase with damaged teeth, errors and contact law.

The phase of a mesh, ``phase + frequency t``, is not reduced to one cycle. The pair that enters at the whole number n is formed
by tooth ``first[0] + n`` of body 1 and ``first[1] + n`` of body 2, modulo their tooth numbers and numbered in the order of
engagement. A damaged tooth therefore returns after z cycles in *each* mesh of its body. Two damaged teeth meet once per hunting
period.
"""

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.checks import truth, whole
from ...core.record import settle, settle_numbers, settle_row
from ...geometry.aliases import Floats
from ...geometry.checks import is_finite, shown
from ...geometry.renamed import renamed
from ...stiffness.curve import StiffnessCurve
from .contact_law import LAWS, Law, law_of
from .force_law import ForceLaw
from .mesh_curves import ALIKE, Change, Stiffness, changed, cycle_table, tooth_phase_of
from .phase_table import PhaseTable, table
from .secant import Secant
from .tooth_damage import ToothDamage

NOWHERE = 1e-12  # Smaller shifts of a tooth are rounding errors [m].


@renamed(beta="damping_per_stiffness")
@dataclass(frozen=True, slots=True)
class GearMesh:
    """Gear mesh: its force F (`gearfe.dynamics.machine.contact_law.force`) acts on the degrees of freedom as ``-row F``.

    Parameters
    ----------
    name : str
    row : ndarray, shape (n,)
        ``row @ q`` is the compression along the transverse line of action [m].
    stiffness : float, ndarray, StiffnessCurve, ForceLaw or Table
        Stiffness over one mesh cycle from phase 0 [N/m^power]; samples are equally spaced. With a `ForceLaw`, k is the secant
        stiffness at the current deflection, for drive and coast flanks. Functions that need a single stiffness curve use the one
        at `law.force`.
    frequency : float
        Mesh frequency [Hz]. It is negative if gear 2 drives on the flanks that are loaded when gear 1 drives: the contacts then
        run backwards.
    phase : float
        Phase at t = 0; whole cycles count, because they number the teeth.
    teeth, first : (int, int)
        Tooth numbers of the bodies, and the teeth of the pair that enters at phase 0.
    damage : tuple of ToothDamage
    error : tuple of (float, float, float)
        Mesh error ``e(t)`` as sinusoids: amplitude [m], frequency [Hz], phase [rad] of a sine; it opens the mesh.
    damping, damping_per_stiffness, zeta : float
        The damping is ``c = damping + damping_per_stiffness k(t)`` [N s/m], with `damping_per_stiffness` in s.
        `gearfe.dynamics.machine.tables.Machine` converts a `zeta` to ``damping = 2 zeta sqrt(mean k / sum(row**2 / m))``, with
        the sum over all degrees of freedom of the row.
    power, depth, push : float, float, bool
        Parameters of the impact law: the exponent, the depth from which the damping is full [m] (0: always), and whether contact
        is unilateral (no tension).
    backlash : float
        Backlash along the line of action [m]. With 0 the mesh never opens, with inf there is no back flank.
    film : float
        Part of the damping that acts in an open mesh (1: all of it, as A. Kahraman, R. Singh, J. Sound Vib. 142 (1990)).
    friction : tuple of (ndarray, Table)
        Rows and their weights over the phase: friction acts with ``-row weight(phase) F``.
    gap : float
        Distance between the flanks where ``row @ q - e`` is 0 [m]: the backlash before separate back flanks touch.
    law : Law, optional
        Contact law to replace that of `power` and `depth`, with its parameters (`gearfe.dynamics.machine.contact_law`).
    """

    name: str
    row: Floats
    stiffness: Stiffness
    frequency: float = 0.0
    phase: float = 0.0
    teeth: tuple[int, int] = (1, 1)
    first: tuple[int, int] = (0, 0)
    damage: tuple[ToothDamage, ...] = ()
    error: tuple[tuple[float, float, float], ...] = ()
    damping: float = 0.0
    damping_per_stiffness: float = 0.0
    zeta: float = 0.0
    power: float = 1.0
    depth: float = 0.0
    push: bool = False
    backlash: float = 0.0
    film: float = 1.0
    friction: tuple[tuple[Floats, PhaseTable], ...] = ()
    gap: float = 0.0
    law: Law | None = None
    contact: Law = field(init=False)
    cycle: PhaseTable = field(init=False)
    changes: tuple[Change, ...] = field(init=False)
    shifts: tuple[Change, ...] = field(init=False)
    secants: tuple[Secant, ...] = field(init=False)
    average: Secant | None = field(init=False)

    def __post_init__(self) -> None:
        """Compute the tables. Raise ValueError for values that are out of range or contradict each other."""
        settle_row(self, "mesh")
        what = f"mesh {self.name}"
        settle_numbers(self, what, "frequency", " Hz")
        settle_numbers(self, what, "phase")
        settle_numbers(self, what, "damping", " N s/m", least=0.0)
        settle_numbers(self, what, "damping_per_stiffness", " s", least=0.0)
        settle_numbers(self, what, "zeta film", least=0.0)
        settle_numbers(self, what, "depth gap", " m", least=0.0)
        settle_numbers(self, what, "power", least=1.0)
        settle_numbers(self, what, "backlash", " m", least=0.0, finite=False)
        settle(
            self, push=truth(f"{what}: push", self.push), contact=law_of(self.power, self.depth) if self.law is None else self.law
        )
        if not callable(getattr(self.contact, "force", None)):
            raise ValueError(
                f"{what}: law = {shown(self.law)}, but give one of the laws in gearfe.dynamics.machine.contact_law.LAWS"
            )
        self._check_teeth()
        self._check_contact()
        settle(self, cycle=cycle_table(self.stiffness))
        settle(self, changes=self._changes(self.cycle))
        settle(self, shifts=self._shifts())
        secants = self._secants()
        settle(self, secants=secants, average=secants[0].mean if secants else None)

    def _check_teeth(self) -> None:
        for name, least in (("teeth", 1), ("first", -math.inf)):
            numbers = getattr(self, name)
            if not isinstance(numbers, (tuple, list)) or len(numbers) != 2:
                raise ValueError(f"mesh {self.name}: {name} = {numbers!r}, but give two whole numbers, one for each body")
            settle(self, **{name: tuple(whole(f"mesh {self.name}: {name}", number, least) for number in numbers)})
        if not all(isinstance(hurt, ToothDamage) for hurt in self.damage):
            raise ValueError(f"mesh {self.name}: damage = {self.damage!r}, but give a tuple of ToothDamage")
        if self.film > 1:
            raise ValueError(f"mesh {self.name}: film = {self.film:g}, but it is a part of the damping, 0 to 1")
        for sinusoid in self.error:
            if len(sinusoid) != 3 or not all(map(is_finite, sinusoid)):
                raise ValueError(
                    f"mesh {self.name}: error {sinusoid}, but give (amplitude [m], frequency [Hz], phase [rad]), finite"
                )

    def _check_contact(self) -> None:
        law, power = self.contact, self.contact.power
        if type(law) not in LAWS:
            raise ValueError(
                f"mesh {self.name}: law = {law!r} is not in LAWS of gearfe.dynamics.machine.contact_law: add its row there"
            )
        if self.law and (self.power != 1 or self.depth):
            raise ValueError(f"mesh {self.name}: leave out power and depth, because law = {law!r} has its own parameters")
        if power != 1 and self.backlash == 0:
            raise ValueError(f"mesh {self.name}: power = {power} needs a backlash > 0 (inf: no back flank)")
        if power != 1 and isinstance(self.stiffness, ForceLaw):
            raise ValueError(f"mesh {self.name}: power = {power}, but a force law defines the force itself: leave out power")

    def _changes(self, healthy: PhaseTable, name: str = "k") -> tuple[Change, ...]:
        """Return the change of the quantity `name` by each damaged tooth, relative to the `healthy` mesh cycle.

        With `every`, a change is relative to the cycle with the damaged teeth before it.
        """
        out: list[Change] = []
        for hurt in self.damage:
            z = hurt.every or self.teeth[hurt.body]
            first = float((hurt.tooth - self.first[hurt.body]) % z)
            change = hurt.change([(1.0, 0.0, healthy), *(out if hurt.every else ())], first, z, name)
            if change.end - change.start > z + ALIKE:
                raise ValueError(
                    f"mesh {self.name}: the curve of a damaged tooth is longer than the {z} mesh cycles after which that tooth "
                    "meshes again"
                )
            out.append((float(z), first, change))
        return tuple(out)

    def _shifts(self) -> tuple[Change, ...]:
        """Return the changes of the unloaded transmission error by tooth position errors [m], empty without errors."""
        curves = [hurt.curve for hurt in self.damage]
        if all(getattr(curve, "unloaded", None) is None for curve in curves):
            return ()
        given: Any = self.stiffness
        own = given.unloaded if isinstance(given, (StiffnessCurve, ForceLaw)) else None
        grid = np.arange(len(self.cycle.cells)) / len(self.cycle.cells)
        values = np.zeros(grid.size) if own is None else np.interp(grid, given.phase % 1.0, own, period=1.0)
        found = self._changes(table(values, 0.0, 1 / grid.size, periodic=True), "unloaded")
        return tuple(shift for shift in found if np.abs(shift[2].cells[:, 0]).max() > NOWHERE)

    def _secants(self) -> tuple[Secant, ...]:
        """Return the `Secant` of the healthy cycle, then the change by each damage. The result is empty without a `ForceLaw`."""
        lawful = [isinstance(stiffness, ForceLaw) for stiffness in (self.stiffness, *(hurt.curve for hurt in self.damage))]
        if any(lawful) != all(lawful):
            raise ValueError(f"mesh {self.name}: give force laws for the healthy mesh and for all its damage, or for none")
        if not isinstance(self.stiffness, ForceLaw):
            return ()
        if not self.stiffness.periodic:
            raise ValueError(f"mesh {self.name}: its force law does not cover one mesh cycle: compute it with span='cycle'")
        out = [self.stiffness.secant]
        for hurt, (_, first, _) in zip(self.damage, self.changes, strict=True):
            others = [(z, begin, less) for (z, begin, _), less in zip(self.changes, out[1:], strict=False)] if hurt.every else []
            law: Any = hurt.curve
            out.append(law.secant.less(out[0], [(z, begin - first, less) for z, begin, less in others]))
        return tuple(out)

    @property
    def openings(self) -> tuple[tuple[float, float, float], ...]:
        """Return the mesh errors and gaps as sinusoids. A constant gap is a sinusoid of frequency 0."""
        return (*self.error, (self.gap, 0.0, math.pi / 2)) if self.gap else self.error

    def k(self, t: ArrayLike) -> Floats:
        """Stiffness at times `t` [N/m^power], never below zero."""
        return self.at_phase(self.phase + self.frequency * np.asarray(t, dtype=float))

    def at_phase(self, phase: Floats) -> Floats:
        """Return the stiffness at unwrapped phases. Whole cycles count, because they number the teeth."""
        out = self.cycle(phase - np.floor(phase)) + changed(self.changes, phase)
        return np.maximum(out, 0.0) if self.changes else out

    def pressed(self, phase: NDArray, deep: NDArray) -> tuple[NDArray, ArrayLike]:
        """Return stiffness at unwrapped phases and depths [m], and its derivative by depth [N/m2] (0 without a `ForceLaw`)."""
        if not self.secants:
            return self.at_phase(phase), 0.0
        k, bend = self.secants[0](phase % 1.0, deep)
        for (z, first, _), change in zip(self.changes, self.secants[1:], strict=True):
            tooth_phase = tooth_phase_of(phase, z, first, change.start + change.width)
            inside = tooth_phase < change.end - change.width
            more, rise = change(tooth_phase, deep)
            k, bend = k + np.where(inside, more, 0.0), bend + np.where(inside, rise, 0.0)
        return np.maximum(k, 0.0), np.where(k > 0, bend, 0.0)

    def e(self, t: ArrayLike) -> tuple[Floats, Floats]:
        """Return the mesh error including the gap [m], and its rate [m/s], at times `t`."""
        t = np.asarray(t, dtype=float)
        phase, out, rate = self.phase + self.frequency * t, np.zeros(t.shape), np.zeros(t.shape)
        for amplitude, frequency, angle in self.openings:
            omega = 2 * math.pi * frequency
            turn = omega * t + angle
            out, rate = out + amplitude * np.sin(turn), rate + amplitude * omega * np.cos(turn)
        if self.shifts:
            out = out + changed(self.shifts, phase)
            rate = rate + self.frequency * changed(self.shifts, phase, PhaseTable.slope)
        return out, rate

    def cycles(self) -> int:
        """Mesh cycles after which the stiffness repeats: 1, or the common multiple of the damaged bodies' tooth numbers."""
        return math.lcm(1, *(int(z) for z, _, _ in self.changes))

    def entries(self, duration: float) -> list[Floats]:
        """Return by damage the times [s] up to `duration` at which each damaged tooth is at phase 0 of this mesh."""
        out = []
        for z, first, _ in self.changes:
            low, high = sorted((self.phase, self.phase + self.frequency * duration))
            turns = np.arange(math.ceil((low - first) / z), math.floor((high - first) / z) + 1)
            out.append(np.sort((first + z * turns - self.phase) / self.frequency))
        return out

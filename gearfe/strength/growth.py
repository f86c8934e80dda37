"""Growth of a root crack: its path by a criterion of direction, and its life by Paris's law."""

import math
from dataclasses import dataclass, field, replace

import numpy as np

from ..core.case import Case
from ..core.case_parts import SIDES
from ..core.checks import number, one_of, whole
from ..core.cost import Cost, check_cost
from ..core.material import Material
from ..core.table import Column, Table
from ..core.threads import single
from ..geometry.aliases import Floats
from ..geometry.damage.crack import Crack, crack_path, sampled
from ..geometry.tooth.gear import Gear
from ..geometry.tooth.profile import lengths
from ..geometry.tooth.slot import Slot, check_slots
from ..stiffness.cost import gear_seconds
from ..stiffness.solve import Solve, solve
from .crack_model import CrackModel
from .growth_end import reached, stopped
from .kink import turn_angle
from .paris import ParisLaw, cycles_along
from .tip_response import fe_response, ritz_response

NEIGHBOURS = 1  # number of teeth on either side whose loads count
PHASES = 97  # positions of the pair between first contact of one neighbour and last contact of the other
SHORTEST = 1e-3  # least crack extension per step [m_n]
SECTORS = 3  # time of a step relative to that of a healthy gear of `ritz`


@dataclass(frozen=True, slots=True)
class Growth:
    """Result of crack growth.

    Attributes
    ----------
    cracks : tuple of Crack, shape (n,)
        At each step, the first as it was given.
    length : ndarray, shape (n,)
        Of the crack [mm].
    K_I, K_II : ndarray, shape (n,)
        Stress intensity [MPa sqrt(mm)] at the phase of the largest K_I, with closed faces in contact.
    K_min : ndarray, shape (n,)
        Least K_I over the engagement of the tooth and its neighbours [MPa sqrt(mm)], faces free to overlap. It is negative where
        the crack is pressed shut.
    cycles : ndarray, shape (n,) or None
        Revolutions of the gear until this length; None without a law.
    outcome : str
        ``"tooth lost"``, ``"rim cut"``, ``"arrested"``, ``"fracture"`` or ``"unfinished"``.
    why : str
        What ended the growth, in words.
    methods : tuple of str
        Method of each step, ``"ritz"`` or ``"fe"``.
    slots : tuple of Slot
        Those of the `CrackModel`.
    """

    cracks: tuple[Crack, ...]
    length: Floats
    K_I: Floats
    K_II: Floats
    K_min: Floats
    cycles: Floats | None
    outcome: str
    why: str
    methods: tuple[str, ...] = ()
    slots: tuple[Slot, ...] = ()

    def under(self, law: ParisLaw) -> "Growth":
        """Return the same path with the revolutions by another law, up to its threshold or toughness.

        Parameters
        ----------
        law : ParisLaw

        Returns
        -------
        Growth
        """
        ends = (stopped(values, law) for values in zip(self.K_I, self.K_II, self.K_min, strict=True))
        last, ended = next(((i, end) for i, end in enumerate(ends) if end), (self.length.size - 1, None))
        outcome, why = ended or (self.outcome, self.why)
        kept = {name: getattr(self, name)[: last + 1] for name in ("cracks", "length", "K_I", "K_II", "K_min", "methods")}
        cycles = cycles_along(law, kept["length"], kept["K_I"], kept["K_min"])
        return replace(self, **kept, cycles=cycles, outcome=outcome, why=why)

    def table(self) -> Table:
        """One row for each step, with the tip of the crack in the frame of its tooth, as a crack's `path` has it."""
        columns = [Column("length", "mm", "{:.3f}"), Column("x", "mm", "{:.3f}"), Column("y", "mm", "{:.3f}")]
        columns += [Column(name, "MPa sqrt(mm)", "{:.1f}") for name in ("K_I", "K_II", "K_min")]
        start = next((crack.path[0] for crack in self.cracks if crack.path), (math.nan, math.nan))  # The tip of a straight start.
        tips = [crack.path[-1] if crack.path else start for crack in self.cracks]
        rows = [[a, *tip, *values] for a, tip, *values in zip(self.length, tips, self.K_I, self.K_II, self.K_min, strict=True)]
        if self.cycles is not None:
            columns.append(Column("revolutions", "", "{:.4g}"))
            rows = [[*row, cycles] for row, cycles in zip(rows, self.cycles, strict=True)]
        return Table(columns, rows)

    def __repr__(self) -> str:
        """Return outcome, methods and table as text."""
        used = " then ".join(dict.fromkeys(self.methods))
        return f"{self.outcome}: {self.why}\nmethod: {used}\n\n{self.table()}"


def single_crack(case: Case) -> tuple[str, Crack] | None:
    """Return side and crack of a case with a single crack as only damage, or None."""
    found = [(side, one) for side, damage in (case.damage or {}).items() for one in damage]
    cracks = [(side, one) for side, one in found if isinstance(one, Crack)]
    return cracks[0] if len(found) == len(cracks) == 1 else None


def _step(gear, step):
    """Return the step of the growth [mm]."""
    step = 0.1 * gear.m_n if step is None else number("step", step)
    if not SHORTEST * gear.m_n <= step <= gear.m_n:
        raise ValueError(f"step = {step} mm, but give {SHORTEST * gear.m_n:g} to {gear.m_n:g} mm, one module at most")
    return step


def _check_body(gear, crack, slots):
    """Raise ValueError for a body or a crack that no section represents, and for slots that meet an edge or the crack."""
    if gear.beta or not crack.through:
        raise ValueError("grow_crack is for spur gears and cracks through the whole width, because it solves a section")
    check_slots(gear, slots)
    if any(slot.distance(sampled(crack_path(gear, crack))).min() < 0.02 * gear.m_n for slot in slots):
        raise ValueError(f"the crack reaches a slot, or {0.02 * gear.m_n:g} mm of it: make it shorter, or move the slot")


@single
def grow_crack(
    case: Case,
    crack: Crack,
    side: str = "pinion",
    *,
    step: float | None = None,
    steps: int = 60,
    law: ParisLaw | None = None,
    model: CrackModel | None = None,
    refine: float = 1.0,
) -> Growth:
    """Grow a root crack through the section of a gear, under the contact of its tooth and of the neighbours.

    At each step the section is solved with the crack. K_I and K_II at the tip follow for every phase. The crack turns by the
    criterion at the phase of the largest K_I. Half of the last turn is added, because the path goes on turning within the step.
    Faces that overlap at that phase are kept in contact without friction. Cycles count a crack as closed where K_I is negative.

    Parameters
    ----------
    case : Case
        Spur pair with its load; damage in it is left out.
    crack : Crack
        Where the crack starts: of any size that can be meshed, through the whole width.
    side : {"pinion", "wheel"}
        Gear with the crack.
    step : float, optional
        Growth in each step [mm]; default: 0.1 modules.
    steps : int
        At most so many steps.
    law : ParisLaw, optional
        For the number of revolutions.
    model : CrackModel, optional
        Method, loads, support and criterion.
    refine : float
        Divides the edge lengths.

    Returns
    -------
    Growth

    Raises
    ------
    ValueError
        If the pair is not a spur pair, the crack is not through the width, a number is out of range, or the crack leaves its
        sector with ``method="ritz"``.
    """
    one_of("side", side, [name for name, _ in SIDES])
    steps, model = whole("steps", steps, 1, 1000), model or CrackModel()
    index = [name for name, _ in SIDES].index(side)
    gear = case.pair.gears[index]
    step = _step(gear, step)
    _check_body(gear, crack, model.slots)
    loads = _loads(case, index) if model.loading == "engagement" else _single(case, index)
    seconds = SECTORS * (steps + 1) * gear_seconds(case, refine, "ritz")
    check_cost(f"refine = {refine:g}: {steps} steps of growth", Cost(seconds, 0.0), "give a smaller refine, or fewer steps")
    tip = _Tip(gear, case.materials[index], model, loads, refine)
    crack = replace(crack, tooth=0)
    sense = {"loaded": 1, "unloaded": -1}[crack.side]
    corners = crack_path(gear, crack).T * [sense, 1]
    cracks, found, turn = [crack], [], 0.0
    for i in range(steps + 1):
        found.append(tip.intensity(cracks[-1]))
        ended = stopped(found[-1], law)
        if ended or i == steps:
            break
        angle = sense * turn_angle(found[-1][0], found[-1][1], model.criterion)
        heading = np.arctan2(*(corners[-1] - corners[-2])[::-1]) + angle + 0.5 * turn
        turn = angle if i else 0.0
        ahead = corners[-1] + step * np.array([math.cos(heading), math.sin(heading)])
        if ended := reached(gear, ahead, step, model.slots):
            break
        corners = np.vstack([corners, ahead])
        path = tuple(map(tuple, corners[1:].tolist()))
        cracks.append(replace(crack, level=None, length=None, turning=False, path=path))
    outcome, why = ended or ("unfinished", f"{steps} steps of {step:g} mm")
    k_1, k_2, k_min = np.array(found).T
    length = np.array([lengths(crack_path(gear, one))[-1] for one in cracks])
    growth = Growth(tuple(cracks), length, k_1, k_2, k_min, None, outcome, why, tuple(tip.methods), model.slots)
    return growth if law is None else growth.under(law)


@dataclass
class _Tip:
    """Solver for the tip of a growing crack. It changes from `ritz` to `fe` at the first crack that `ritz` does not support."""

    gear: Gear
    material: Material
    model: CrackModel
    loads: dict
    refine: float
    methods: list = field(default_factory=list)

    def intensity(self, crack):
        """Return K_I and K_II at the phase of the largest K_I, and the least K_I [MPa sqrt(mm)]."""
        response = self._response(crack)
        free = response.free(self.loads)
        top = int(np.argmax(free[:, -2]))
        return (*map(float, response.in_contact(free[top])), float(min(free[:, -2].min(), 0.0)))

    def _response(self, crack):
        if self.model.method != "fe" and "fe" not in self.methods:
            try:
                found = ritz_response(self.gear, self.material, crack, self.loads, self.refine, self.model.held, self.model.slots)
            except (ValueError, RuntimeError):  # The crack leaves its sector or cannot be meshed coarsely.
                if self.model.method == "ritz":
                    raise
            else:
                self.methods.append("ritz")
                return found
        self.methods.append("fe")
        rolls = np.concatenate([rolls[load > 0] for rolls, load in self.loads.values()])
        carried = float(rolls.min()), float(rolls.max())
        return fe_response(self.gear, self.material, crack, self.loads, self.refine, carried, self.model.held, self.model.slots)


def _single(case, index):
    """Return the whole line load [N/mm] on tooth 0 at the highest point of single contact, in the form of `_loads`."""
    pair = case.pair
    low, high = pair.path
    roll = low + pair.p_bt if index == 0 else pair.mate_roll(high - pair.p_bt)
    line = case.force / pair.b_w
    return {0: (np.array([roll]), np.array([line]))}


def _loads(case, index):
    """Return positions of the cracked tooth [base pitches], and by tooth k roll lengths [mm] and line loads [N/mm]."""
    pair, healthy = case.pair, replace(case, damage=None)
    curve = solve(healthy, Solve(method="ritz", phases=32))
    low, high = pair.path
    share = {}
    for column, order in enumerate(curve.order.tolist()):
        for phase, force in zip(curve.phase, curve.force[:, column], strict=True):
            if force > 0 and low <= (roll := low + (phase + order) * pair.p_bt) <= high:
                share[roll] = force / pair.b_w
    rolls = np.array(sorted(share))
    line = np.array([share[roll] for roll in rolls])
    at = np.linspace(low - pair.p_bt, high + pair.p_bt, PHASES)
    out = {}
    for k in range(-NEIGHBOURS, NEIGHBOURS + 1):
        roll = at + k * pair.p_bt
        load = np.where((roll >= low) & (roll <= high), np.interp(roll, rolls, line), 0.0)
        out[k] = (roll if index == 0 else pair.mate_roll(roll)), load
    return out

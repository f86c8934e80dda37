"""Growth of a root crack: its path by the largest tangential stress, and its life by Paris's law."""

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import hstack

from ..core.case import SIDES, Case
from ..core.checks import number, one_of, whole
from ..core.table import Column, Table
from ..core.threads import single
from ..flexibility.finite_elements.elasticity import HeldSection
from ..flexibility.finite_elements.fe import EDGES
from ..flexibility.finite_elements.one_tooth import edge_lengths, narrow_load
from ..geometry.aliases import Floats
from ..geometry.damage.crack import Crack, crack_path
from ..geometry.mesh.outline import stations
from ..geometry.mesh.section_mesh import section
from ..geometry.tooth.gear import Gear
from ..geometry.tooth.profile import arc_at, cartesian, fillet_length, lengths, root_curve
from ..stiffness.solve import Solve, solve
from .fracture import growth_angle, tip_intensity

PLACES = 9  # of a load on a flank, between which the intensity is a cubic
WIDE = 0.12  # half width of a load [m_n]
NEIGHBOURS = 1  # teeth to either side whose loads count
END = 0.25  # of a step: a tip closer to a boundary than this has reached it
SMOOTH = 40  # parts of a step over which cycles are summed


@dataclass(frozen=True, slots=True)
class ParisLaw:
    """Growth of a crack in each cycle, ``da/dN = C dK_eff^m``.

    ``dK_eff = K_max (1 - R)^gamma`` with ``R = max(K_min, 0) / K_max`` (K. Walker, ASTM STP 462 (1970) 1-14): a crack that is
    pressed shut is closed at K = 0. One revolution of the gear is one cycle.

    Parameters
    ----------
    C : float
        [mm / (MPa sqrt(mm))^m].
    m : float
    threshold : float
        Least dK_eff that grows a crack [MPa sqrt(mm)].
    K_Ic : float
        Fracture toughness [MPa sqrt(mm)].
    gamma : float
        Walker's exponent; 1: no effect of the load ratio beyond closure.
    source : str
        Where the constants come from.

    Raises
    ------
    ValueError
        If C or m is not positive, the threshold is negative, K_Ic is not above it, or gamma is not between 0 and 1.
    """

    C: float
    m: float
    threshold: float = 0.0
    K_Ic: float = math.inf
    gamma: float = 1.0
    source: str = ""

    def __post_init__(self) -> None:
        """Check the constants."""
        for name in ("C", "m", "threshold", "K_Ic", "gamma"):
            object.__setattr__(self, name, number(name, getattr(self, name)))
        if not (self.C > 0 and self.m > 0):
            raise ValueError(f"C = {self.C}, m = {self.m}, but both are positive")
        if not 0 <= self.threshold < self.K_Ic:
            raise ValueError(f"threshold = {self.threshold}, K_Ic = {self.K_Ic} MPa sqrt(mm), but 0 <= threshold < K_Ic")
        if not 0 <= self.gamma <= 1:
            raise ValueError(f"gamma = {self.gamma}, but it lies between 0 and 1")

    def range(self, largest: Floats, least: Floats) -> Floats:
        """Effective range of K [MPa sqrt(mm)] of cycles between `least` and `largest`."""
        top = np.maximum(largest, 0.0)
        ratio = np.clip(np.maximum(least, 0.0) / np.where(top > 0, top, 1.0), 0.0, 1.0)
        return top * (1 - ratio) ** self.gamma


@dataclass(frozen=True, slots=True)
class Growth:
    """A crack that has grown.

    Attributes
    ----------
    cracks : tuple of Crack
        At each step, the first as it was given.
    length : ndarray, shape (n,)
        Of the crack [mm].
    K_I, K_II : ndarray, shape (n,)
        Stress intensity [MPa sqrt(mm)] at the phase of the largest K_I.
    K_min : ndarray, shape (n,)
        Least K_I over the engagement of the tooth and its neighbours [MPa sqrt(mm)]; negative where the crack is pressed shut.
    cycles : ndarray, shape (n,) or None
        Revolutions of the gear until this length; None without a law.
    outcome : str
        ``"tooth lost"``, ``"rim cut"``, ``"arrested"``, ``"fracture"`` or ``"unfinished"``.
    why : str
        What ended the growth, in words.
    """

    cracks: tuple[Crack, ...]
    length: Floats
    K_I: Floats
    K_II: Floats
    K_min: Floats
    cycles: Floats | None
    outcome: str
    why: str

    def table(self) -> Table:
        """One row for each step."""
        columns = [Column("length", "mm", "{:.3f}"), Column("x", "mm", "{:.3f}"), Column("y", "mm", "{:.3f}")]
        columns += [Column(name, "MPa sqrt(mm)", "{:.1f}") for name in ("K_I", "K_II", "K_min")]
        tips = [crack.path[-1] if crack.path else (math.nan, math.nan) for crack in self.cracks]
        rows = [[a, *tip, *values] for a, tip, *values in zip(self.length, tips, self.K_I, self.K_II, self.K_min, strict=True)]
        if self.cycles is not None:
            columns.append(Column("revolutions", "", "{:.4g}"))
            rows = [[*row, cycles] for row, cycles in zip(rows, self.cycles, strict=True)]
        return Table(columns, rows)

    def __str__(self) -> str:
        """Outcome and table."""
        return f"{self.outcome}: {self.why}\n\n{self.table()}"


@single
def grow_crack(
    case: Case,
    crack: Crack,
    side: str = "pinion",
    *,
    step: float | None = None,
    steps: int = 60,
    law: ParisLaw | None = None,
    refine: float = 1.0,
) -> Growth:
    """Grow a root crack through the section of a gear, under the contact of its tooth and of the neighbours.

    At each step the section is meshed with the crack. The loads of the healthy pair pass over three teeth. K_I and K_II at the
    tip follow for every phase. The crack turns by the direction of the largest tangential stress at the phase of the largest K_I
    (F. Erdogan, G. C. Sih, J. Basic Eng. 85 (1963) 519-527). Half of the last turn is added, because the path goes on turning
    within the step. The bore is held all around. Faces do not carry pressure: where K_I is negative the crack counts as closed.

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
    refine : float
        Divides the edge lengths.

    Returns
    -------
    Growth

    Raises
    ------
    ValueError
        If the pair is not a spur pair, the crack is not through the width, or a number is out of range.
    """
    one_of("side", side, [name for name, _ in SIDES])
    steps = whole("steps", steps, 1, 1000)
    index = [name for name, _ in SIDES].index(side)
    gear, material = (case.pair.gear_1, case.pair.gear_2)[index], case.materials[index]
    step = 0.1 * gear.m_n if step is None else number("step", step)
    if not 0 < step <= gear.m_n:
        raise ValueError(f"step = {step} mm, but it is positive and at most a module, {gear.m_n:g} mm")
    if gear.beta or not crack.through:
        raise ValueError("grow_crack is for spur gears and cracks through the whole width, because it solves a section")
    loads = _loads(case, index)
    crack = replace(crack, tooth=0)
    corners = crack_path(gear, crack).T * [1 if crack.side == "loaded" else -1, 1]
    cracks, found, turn, outcome = [crack], [], 0.0, ("unfinished", f"{steps} steps of {step:g} mm")
    for i in range(steps + 1):
        values = _over_the_mesh(gear, material, cracks[-1], loads, refine)
        found.append(values)
        if ended := _ended(values, law):
            outcome = ended
            break
        if i == steps:
            break
        angle = growth_angle(*values[:2])
        heading = np.arctan2(*(corners[-1] - corners[-2])[::-1]) + (angle if crack.side == "loaded" else -angle)
        heading += 0.5 * turn
        turn = (angle if crack.side == "loaded" else -angle) if i else 0.0
        ahead = corners[-1] + step * np.array([math.cos(heading), math.sin(heading)])
        if ended := _reached(gear, corners[-1], ahead, step):
            outcome = ended
            break
        corners = np.vstack([corners, ahead])
        path = tuple(map(tuple, corners[1:].tolist()))
        cracks.append(replace(crack, level=None, length=None, turning=False, path=path))
    k_1, k_2, k_min = np.array(found).T
    length = np.array([lengths(crack_path(gear, one))[-1] for one in cracks])
    cycles = None if law is None else _cycles(law, length, k_1, k_min)
    return Growth(tuple(cracks), length, k_1, k_2, k_min, cycles, *outcome)


def _loads(case, index):
    """Places of the cracked tooth in base pitches, and by tooth k its roll lengths there [mm] and its line loads [N/mm]."""
    pair, healthy = case.pair, replace(case, damage=None)
    curve = solve(healthy, Solve(method="ritz", phases=32))
    low, high = pair.path
    share = {}
    for column, order in enumerate(curve.order.tolist()):
        for phase, force in zip(curve.phase, curve.force[:, column], strict=True):
            if force > 0 and low <= (roll := low + (phase + order) * pair.p_bt) <= high:
                share[roll] = force / min(pair.gear_1.b, pair.gear_2.b)
    rolls = np.array(sorted(share))
    line = np.array([share[roll] for roll in rolls])
    at = np.linspace(low - pair.p_bt, high + pair.p_bt, 97)
    out = {}
    for k in range(-NEIGHBOURS, NEIGHBOURS + 1):
        roll = at + k * pair.p_bt
        load = np.where((roll >= low) & (roll <= high), np.interp(roll, rolls, line), 0.0)
        out[k] = (roll if index == 0 else pair.mate_roll(roll)), load
    return out


def _over_the_mesh(gear, material, crack, loads, refine):
    """K_I and K_II at the phase of the largest K_I, and the least K_I [MPa sqrt(mm)]."""
    edge = edge_lengths(gear, EDGES, refine)
    edge["fillet"] /= 2
    roll = stations(gear, edge["flank"])
    mesh = section(
        gear, dict.fromkeys(loads, roll), fillet_size=edge["fillet"], size=edge["near"], far_size=edge["far"], cracks=[crack]
    )
    body = HeldSection(mesh.mesh, material)
    carried = np.concatenate([rolls[load > 0] for rolls, load in loads.values()])
    places = np.linspace(carried.min(), carried.max(), PLACES)
    units = [narrow_load(mesh, k, float(arc_at(gear, place)), WIDE * gear.m_n) for k in loads for place in places]
    moved = body.solve(hstack(units))
    tips = [tip_intensity(body, column, mesh.seams[0].faces) for column in moved.T]
    unit = np.array([[tip.K_I, tip.K_II] for tip in tips]).reshape(len(loads), PLACES, 2)
    total = np.zeros((next(iter(loads.values()))[1].size, 2))
    for (rolls, load), values in zip(loads.values(), unit, strict=True):
        curves = np.polynomial.Polynomial.fit(places, values[:, 0], 4), np.polynomial.Polynomial.fit(places, values[:, 1], 4)
        within = np.clip(rolls, places[0], places[-1])
        total += load[:, None] * np.column_stack([curve(within) for curve in curves])
    top = int(np.argmax(total[:, 0]))
    return float(total[top, 0]), float(total[top, 1]), float(min(total[:, 0].min(), 0.0))


def _ended(values, law):
    """Outcome and reason if the crack does not grow from here; None if it does."""
    largest, _, least = values
    if largest <= 0:
        return "arrested", f"the crack is pressed shut: the largest K_I is {largest:.3g} MPa sqrt(mm)"
    if law is None:
        return None
    if largest >= law.K_Ic:
        return "fracture", f"K_I = {largest:.4g} reaches K_Ic = {law.K_Ic:.4g} MPa sqrt(mm)"
    swing = float(law.range(np.array(largest), np.array(least)))
    if swing <= law.threshold:
        return "arrested", f"dK = {swing:.4g} is below the threshold {law.threshold:.4g} MPa sqrt(mm)"
    return None


def _reached(gear: Gear, tip, ahead, step):
    """Outcome and reason if the next step reaches a boundary; None if it does not."""
    if gear.outward * (np.hypot(*ahead) - gear.held) < END * step + 0.02 * gear.m_n:
        return "rim cut", f"the crack reaches the held edge at {math.degrees(math.atan2(*ahead)):.3g} degrees from its tooth"
    arcs = np.linspace(0.0, fillet_length(gear), 200)
    right = cartesian(*root_curve(gear, arcs))
    for k in (-1, 0, 1):
        turn = 2 * math.pi * k / gear.z
        cos, sin = math.cos(turn), math.sin(turn)
        for sign, name in ((1, "loaded"), (-1, "unloaded")):
            if k == 0 and sign == 1:
                continue  # its own fillet
            x, y = right * [[sign], [1]]
            apart = np.hypot(cos * x + sin * y - ahead[0], cos * y - sin * x - ahead[1]).min()
            if apart < END * step + 0.03 * gear.m_n or (k == 0 and ahead[0] < -np.interp(ahead[1], right[1], right[0])):
                whose = "its tooth" if k == 0 else f"tooth {k}"
                return "tooth lost", f"the crack reaches the {name} fillet of {whose}"
    return None


def _cycles(law, length, largest, least):
    """Revolutions until each length, with K linear between two steps."""
    out = [0.0]
    for i in range(length.size - 1):
        part = np.linspace(0.0, 1.0, SMOOTH + 1)
        swing = law.range(*(values[i] + part * (values[i + 1] - values[i]) for values in (largest, least)))
        slow = 1 / (law.C * np.maximum(swing, 1e-300) ** law.m)
        out.append(out[-1] + float(np.trapezoid(slow, dx=(length[i + 1] - length[i]) / SMOOTH)))
    return np.array(out)

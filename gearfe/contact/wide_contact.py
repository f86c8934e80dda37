"""Contact of two gears of finite width along their true contact lines: spur, helical or herringbone, with pits and cracks.

Every contact line is divided into short cells. Pits are cut out exactly, so that the result is continuous in their position and
in the phase. The flexibility between cells is the sum of the flexibilities of both bodies (by default `energy.ritz.solid`) and
of a half-space along the line. The pressure of each cell across the line is Hertzian, as in the plane.
"""

import math
from dataclasses import dataclass, replace
from functools import lru_cache, partial

import numpy as np
from numpy.typing import NDArray

from ..core.steps import part, steps
from ..flexibility.solved import solved_gears
from ..geometry.aliases import Floats
from ..geometry.damage.hollow import check_hollows
from .bodies import bodies_of, energy_bodies
from .cells import Cells
from .corner import in_fillet
from .missing_material import missing_material
from .phase_contact import PhaseContact
from .thinned import unmodelled
from .unloaded import least_gap

STEP = 0.2  # longest cell along the width [m_n]
LONGER = 2  # number of cells merged into one in the coarser solution for the error estimate


@dataclass(frozen=True, slots=True)
class Contact3D:
    """Contact of a pair at some phases.

    Attributes
    ----------
    phase : ndarray, shape (phases,)
        Phase of the end that touches first.
    k, k_tangent : ndarray, shape (phases,)
        ``force / (approach - unloaded)``, and ``d force / d approach`` of the loaded contacts [N/m].
    approach, unloaded : ndarray, shape (phases,)
        Approach along the transverse line of action under load, and at first touch without load [mm]. The latter is 0 for
        involutes on the path whose tips do not cut into their mate's fillets.
    order : ndarray, shape (pairs,)
        Numbers of the tooth pairs.
    load : ndarray, shape (phases, pairs)
        Transverse force of each tooth pair [N].
    cells : tuple of Cells
        Load distribution along the contact lines, by phase.
    dofs : (int, int)
        Number of unknowns of pinion and wheel.
    seconds : float
        Time in which the bodies were solved, possibly earlier [s].
    closed, fillet : sequence
        Phases at which faces of cracks are in contact, and at which a tip is in its mate's fillet.
    error : ndarray, shape (phases,), or None
        Differences of k from those of longer cells and of coarser bodies [N/m], with the `unsure` part of `Carried`.
    off_path : ndarray, shape (phases,)
        Uncertainty of k if no contact on the path carries load [N/m]; it is not part of `error`.
    supports : ndarray, shape (phases,), or None
        Deflection of the supports of the hubs, its mean weighted with the loads [mm].
    """

    phase: Floats
    k: Floats
    approach: Floats
    order: NDArray[np.int64]
    load: Floats
    cells: tuple[Cells, ...]
    dofs: tuple[int, int]
    seconds: float = 0.0
    closed: tuple[int, ...] = ()
    fillet: tuple[int, ...] = ()
    error: Floats | None = None
    unloaded: Floats | None = None
    k_tangent: Floats | None = None
    supports: Floats | None = None
    off_path: Floats | None = None


def pair_stiffness3d(case, phases=32, bodies=None, *, step=None, extended=True, error=False, cache=True):
    """Return the contact of a `Case` of finite width.

    The stiffness is ``k = F / delta``. F is the force along the line of action in the transverse section and delta the approach
    along that line. For modified flanks delta is the loaded minus the unloaded approach. The total normal force is ``F /
    cos(beta_b)``, and the normal approach is ``delta cos(beta_b)``. Therefore k is ``cos(beta_b)**2`` times the normal force per
    normal approach.

    Parameters
    ----------
    case : Case
        Faces of different width lie centred on each other. Pits on loaded flanks remove contact and no material. Faces of cracks
        cannot pass through each other if the bodies give their opening, as the energy model does. The end z = 0 of a helical pair
        touches first if the pinion's beta is negative, z = b otherwise. The outer ends of ``herringbone`` halves touch first; the
        halves are mirrored, and their bodies are not coupled. Several forces share the gears; each has separate cells.
    phases : int or ndarray
        Number of equidistant phases in 0...1, or the phases: of the end that touches first, pair 0 enters there at phase 0.
    bodies : Bodies, optional
        Solver of the bodies; default `gearfe.contact.bodies.energy_bodies`.
    step : float, optional
        Longest cell along the width [mm]; default 0.2 normal modules.
    extended : bool
        If True, tip corners touch before the start and after the end of the path of contact, with their gap and the local law of
        corners of the plane section (`gearfe.contact.corner`).
    error : bool
        If True, estimate the discretisation error at each phase. It is the difference of k from that of cells `LONGER` times as
        long, plus the difference from that of coarser bodies. An error of the energy model that falls with the power 2.4 of the
        degree and the power 1 of the cells, or faster, is below the estimate. The effect
        of the material that pits, spalls and chips of a part of the width lack is added (`gearfe.contact.missing_material`).
    cache : bool or SolvedGears
        Where to look for what was solved before, see `gearfe.flexibility.solved.solved_gears`.

    Returns
    -------
    Contact3D, or a list of them if the case has several forces

    Raises
    ------
    ValueError
        If an input is impossible.
    RuntimeError
        If pits leave no contact at some phase, or the contact was not found.
    """
    pair, cache = case.pair, solved_gears(cache)
    step = STEP * pair.gear_1.m_n if step is None else step
    if not (math.isfinite(step) and step > 0):
        raise ValueError(f"step = {step} mm, but the largest length of a contact cell must be positive")
    phase = np.arange(phases) / phases if np.ndim(phases) == 0 else np.asarray(phases, dtype=float)
    for gear, pits in zip(pair.gears, case.pits, strict=True):
        check_hollows(gear, pits)
    bodies = bodies or energy_bodies(cache=cache)

    def contacts_of(longer):
        return [PhaseContact(case, force, longer=longer, step=step, extended=extended, cache=cache) for force in case.forces]

    contacts = contacts_of(1)
    least = max(contact.neighbours for contact in contacts)

    def bodies_by(flexible, ahead=None):
        @lru_cache(maxsize=8)
        def made(neighbours):
            given = (one and partial(one, neighbours=neighbours) for one in (flexible, ahead))
            return bodies_of(case, contacts[0].bands, *given)

        def within(orders):  # Large deflections bring more teeth into contact than the initial estimate.
            return made(max(orders, least))

        with part("", 0.0, 0.5):
            within(0)
        return within

    def solve(contacts, within):
        with part("", 0.5, 1.0):
            return [_solved(contact, phase, within) for contact in steps(contacts)]

    with part("", 0.0, 0.6 if error else 1.0):
        finest = bodies_by(bodies.flexible, bodies.ahead)
        solved = solve(contacts, finest)
    if error:
        with part("", 0.6, 1.0):
            others = [solve(contacts_of(LONGER), finest)]
            if bodies.coarser:
                others.append(solve(contacts, bodies_by(bodies.coarser)))
        away = [sum(np.abs(less.k - one.k) for less in rest) for one, *rest in zip(solved, *others, strict=True)]
        left_out = [unmodelled(case, one) + missing_material(case, one) for one in solved]
        parts = zip(solved, away, left_out, strict=True)
        solved = [replace(one, error=one.error + doubt + less) for one, doubt, less in parts]
    else:
        solved = [replace(one, error=None) for one in solved]
    return solved if case.several else solved[0]


def _solved(contact, phase, bodies):
    """Return the `Contact3D` of one force."""
    used = bodies(0)
    dofs = tuple(body.unknowns for body, _ in used[0])
    seconds = sum({body.seconds for gears in used for body, _ in gears})  # Mirrored bodies were solved once.
    carried = contact.solve(phase.tolist(), bodies)
    cells = tuple(loaded.cells for loaded in carried)
    approach, tangent, unsure, off = np.array([(one.approach, one.tangent, one.unsure, one.off_path) for one in carried]).T
    orders = np.array(sorted({order for cell in cells for order in cell.order.tolist()}))
    load = np.zeros((phase.size, orders.size))
    for i, loaded in enumerate(cells):
        np.add.at(load[i], np.searchsorted(orders, loaded.order), loaded.load * math.cos(contact.beta_b))
    closed = tuple(i for i, loaded in enumerate(carried) if loaded.closed)
    fillet = tuple(i for i, loaded in enumerate(cells) if (in_fillet(contact.pair, *loaded.rolls) & (loaded.load > 0)).any())
    unloaded = least_gap(contact, cells)
    k = 1e3 * contact.force / (approach - unloaded)
    supports = None if contact.hubs is None else np.array([loaded.given for loaded in carried])
    details = {"closed": closed, "fillet": fillet, "unloaded": unloaded, "k_tangent": 1e3 * tangent, "supports": supports}
    details |= {"error": k * unsure, "off_path": k * off}
    return Contact3D(phase, k, approach, orders, load, cells, dofs, seconds, **details)

"""`solve`: stiffness curve of a `Case` with the options of a `Solve`. `mesh_stiffness` combines both."""

import contextlib
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from typing import Any

from numpy.typing import ArrayLike

from ..core.case import Case
from ..core.case_parts import SIDES
from ..core.checks import checked_refine, is_number, one_of, truth
from ..core.frozen import frozen
from ..core.material import Material, check_state
from ..core.threads import in_turn, one_thread
from ..flexibility.solved import SolvedGears, solved_gears
from ..geometry.aliases import Floats
from .cost import announce
from .methods import METHODS, Method, current
from .methods import NAMES as METHOD_NAMES
from .own_flexibility import OwnFlexibility
from .phases import LONG, SPANS, check_phases, phase_array
from .plausible import check_plausible
from .pose import SHIFT, in_pose
from .turns import over_turns

Loads = list[float] | tuple[float, ...] | Floats
Materials = Material | tuple[Material, Material] | None


@dataclass(frozen=True, slots=True)
class Solve:
    """Options of a solution: method, phases and resolution.

    Parameters
    ----------
    method : {"auto", "ritz", "ritz3d", "fe", "fe3d", "coupled", "textbook", "herringbone_article"} or OwnFlexibility
        ``ritz``: the converged energy model of the transverse section, milliseconds (`energy.ritz.plane`). ``ritz3d``: the same
        in three dimensions, seconds: spur, helical and herringbone gears of finite width, pits as lost contact
        (`gearfe.contact.wide_contact`). ``auto``: ``fe3d`` for shafts in one piece with their gear; ``ritz3d`` for helical gears
        and changes along the width (pits, spalls, cracks of part of the width, lead, misalignment, hubs that tilt); otherwise
        ``ritz``. ``meta["why"]`` states the reason. To compare a damaged and a healthy curve, use the same method for both.
        ``fe``: finite elements of whole sections, the independent reference (`gearfe.flexibility.finite_elements.fe`). ``fe3d``:
        hexahedra of whole gears of finite width, the reference for ``ritz3d``, minutes (`finite_elements.fe_gear3d`).
        ``coupled``: closed forms with known corrections, external healthy gears (`energy.closed.coupled`). All these have line
        contact, neighbour coupling and load sharing. ``textbook`` (potential energy method), ``herringbone_article``: beam
        energies and a plain sum of the pairs (`energy.closed.plain_sum`). An `OwnFlexibility`: a user-defined flexibility of a
        gear. `gearfe.stiffness.methods.ROWS` is the table of their abilities.

        Cracks: all but ``coupled``; of part of the width or of a depth that changes along it: ``ritz3d`` and ``fe3d``. Pits and
        spalls: ``ritz3d``, ``fe3d`` and the plain sums. Flanks: all methods; what changes along the width, misalignment too,
        needs ``ritz3d``, ``fe3d`` or a plain sum. Hubs that tilt: ``ritz3d`` or ``fe3d``.
    phases : int or array
        Number of equidistant phases per mesh cycle, or the phases themselves. With pitch deviations, phases over as many teeth as
        are of interest.
    span : {"cycle", "tooth", "revolution", "hunting"}
        Range of a number of phases. ``cycle``: from 0 to 1. ``tooth``: the whole engagements of the tooth pairs with damage
        (without damage, of pair 0), and a quarter cycle before and after each. ``revolution``: every cycle of one revolution of
        the pinion. ``hunting``: every cycle of the hunting period after which the same teeth meet again (for pitch deviations;
        equal cycles are solved once). Pair k, of the teeth k of both gears, enters at phase -k, in three dimensions at one end.
    extended : bool
        If True, corners touch before the start and after the end of the path of contact (all but the closed forms, which have no
        contact there).
    state : {"plane strain", "plane stress"}
        For ``ritz`` and ``fe``; the beams of the closed forms use E like their sources.
    refine : float
        Resolution of ``ritz`` and ``fe``, also in three dimensions: divides the edge lengths; 0.2 to 64.
    order : int, optional
        Polynomial order of ``ritz`` (default 4) and ``ritz3d`` (in the section; default 3), 2 to 8.
    teeth : int, optional
        For ``fe``: number of teeth that are modelled, on a plain rim; default: all.
    variants : dict, optional
        For ``textbook`` and ``herringbone_article``: options of `gearfe.flexibility.energy.closed.plain_sum.plain_sum` and of the
        formulas' ``components`` (``root``, ``foot``, ``foundation``, ``lever``, ``theta_f``, ``crack_model``, ``contact``,
        ``lost``).
    error : bool
        For ``ritz`` and ``fe``, also in three dimensions: estimate the discretisation error of every k from coarser solves (see
        `gearfe.stiffness.estimate.estimate` and `gearfe.stiffness.wide_curves.solid_curves`).
    cache : bool
        Reuse earlier solutions of this process; for ``ritz3d``, ``fe`` and ``fe3d`` also of earlier processes (see
        `gearfe.stiffness.disk`). False: solve everything again and store nothing.
    tell : callable, optional
        For ``fe3d``: gets a line of text before the first of several gears, with the expected seconds of all (with `error`,
        coarser gears included), and one before each, with its unknowns, seconds and memory. A gear that does not fit into memory
        raises before the first solve.
    pose : {"mean", "pinion", "wheel"}
        Gear that the approach rotates: each by half of it (as a length on the line of action), or one gear with the other fixed.
        Near the ends of double contact k differs by 1 to 2 % (`geometry.pair.contacts`). The last two solve the contact about
        four times.

    Raises
    ------
    ValueError
        If an option is impossible; the message states which.
    """

    method: str | OwnFlexibility = "auto"
    phases: int | ArrayLike = 64
    span: str = "cycle"
    extended: bool = True
    state: str = "plane strain"
    refine: float = 1.0
    order: int | None = None
    teeth: int | None = None
    variants: Mapping[str, Any] | None = None
    error: bool = False
    cache: bool | SolvedGears = True
    tell: Callable[[str], object] | None = None
    pose: str = "mean"

    def __post_init__(self) -> None:
        """Check all options that do not depend on a case."""
        object.__setattr__(self, "method", current(self.method))
        self._check_method()
        for name in ("error", "extended"):
            object.__setattr__(self, name, truth(name, getattr(self, name)))
        object.__setattr__(self, "refine", checked_refine(self.refine))
        if not isinstance(self.cache, SolvedGears):
            truth("cache", self.cache)
        check_state(self.state)
        one_of("pose", self.pose, SHIFT)
        one_of("span", self.span, SPANS)
        order = self.order
        if order is not None and (not is_number(order) or not 2 <= order <= 8 or order != int(order)):
            raise ValueError(f"order = {order!r}, but give a whole number from 2 to 8, or None for that of the method")
        if self.variants is not None and not isinstance(self.variants, Mapping):
            raise ValueError(f"variants = {self.variants!r}, but give a dict: {{'foundation': 'none'}}")
        check_phases(self.phases)
        for name in ("phases", "variants"):
            object.__setattr__(self, name, frozen(getattr(self, name)))

    def _check_method(self):
        named = isinstance(self.method, str)
        if isinstance(self.method, OwnFlexibility) or (named and self.method in METHOD_NAMES):
            return
        from difflib import get_close_matches

        near = get_close_matches(self.method.lower(), METHOD_NAMES, 1) if named else ()
        more = f"; nearest: {near[0]}" if near else "" if named else ", or an OwnFlexibility"
        raise ValueError(f"method = {self.method!r}, but it must be one of {', '.join(METHOD_NAMES)}{more}")

    def chosen(self, case: Case) -> tuple[Method, str]:
        """Return the row of the method, and the reason for the choice. ``auto`` selects the method that fits the case."""
        if isinstance(self.method, OwnFlexibility):
            model = self.method
            row = Method(
                str(model.name), "a user-defined model", "section", "", "", extended=model.extended, flanks=True, own=model
            )
            return row, "asked for"
        if self.method != "auto":
            return METHODS[self.method], "asked for"
        if self.teeth is not None:
            return METHODS["fe"], "teeth are left out"
        if any(held.integral for held in case.held or () if held):
            return METHODS["fe3d"], "a gear is one piece with its shaft"
        why = case.why_wide
        return METHODS["ritz3d" if why else "ritz"], why or "spur gears, nothing changes along the width: plane strain"


OPTIONS = tuple(own.name for own in fields(Solve))


def solve(case: Case, how: Solve | None = None) -> Any:
    """Compute the stiffness curve of a `Case` with the options of a `Solve`.

    The stiffness is ``k = F / delta``. F is the force along the line of action. Delta is the loaded minus the unloaded
    transmission error as a length on it. Bores are held or on elastic supports.

    Parameters
    ----------
    case : Case
        Pair, load, materials, damage, flanks and supports.
    how : Solve, optional
        Method, phases and resolution; default: ``Solve()``.

    Returns
    -------
    StiffnessCurve, or a list of them if the case has several loads
        k [N/m] over the mesh phase, with its data.

    Raises
    ------
    ValueError
        If the method does not model the case or does not have an option; the message states which. Also if the approach is so
        large that strains are not small (`gearfe.stiffness.plausible`).
    RuntimeError
        If a system of ``fe`` or ``fe3d`` does not fit into memory, before it is solved; the message has the numbers.

    Warns
    -----
    UserWarning
        If deflection or pressure exceed the strength of teeth, see `gearfe.stiffness.plausible`.
    """
    how = how or Solve()
    row, why = how.chosen(case)
    row.refuses(case, how)
    how = replace(how, cache=solved_gears(how.cache))
    announce(case, how, row)
    short = in_turn() if row.cost == "milliseconds" else contextlib.nullcontext()
    with short, contextlib.nullcontext() if row.brute else one_thread():
        curves = _curves(row, case, how)
    curves = [replace(curve, meta=curve.meta | {"why": why, "pose": how.pose}) for curve in curves]
    return curves if case.several else curves[0]


def _curves(row, case, how):
    """Return a curve for each load, over the span and in the pose of the options."""
    pair = case.pair

    def of_loads(at, loads=case):
        curves = row.curves(loads, how, at)
        for curve in curves:
            check_plausible(curve, pair, case.materials)
        if how.span == "cycle":
            _warn_if_unseen(case, at, pair.eps_alpha + overlap)
        return curves

    def posed(at):
        if how.pose == "mean":
            return of_loads(at)
        alone = [replace(case, force=force) for force in case.forces]
        return [
            in_pose(lambda phase, single=single: of_loads(phase, single)[0], at, pair, how.pose, case.forms) for single in alone
        ]

    overlap = case.overlap(case.runs if row.kind == "solid" else case.face or "spur")
    phase = phase_array(how.phases, how.span, pair, overlap, case.damaged_pairs or (0,))
    if how.span not in LONG:
        return posed(phase)
    differs = [
        bool(case.cracks[i] or case.pits[i] or case.broken[i]) or (case.forms is not None and case.forms[i].differs)
        for i in (0, 1)
    ]
    return over_turns(posed, phase, pair, how.span, differs)


def _warn_if_unseen(case, phase, span):
    """Warn if no tooth with damage or deviations is in contact at any of the phases. Engagements last `span` mesh cycles."""
    sides = zip(SIDES, case.pair.gears, case.forms or (None, None), strict=True)
    teeth = {
        (tooth, gear.z)
        for (name, _), gear, form in sides
        for tooth in {hurt.tooth for hurt in (case.damage or {}).get(name, ())} | (form.unlike if form else set())
    }
    if teeth and not any(((phase + tooth) % z <= span).any() for tooth, z in teeth):
        longer = "tooth" if case.damaged else "revolution"
        warnings.warn(
            "no tooth with damage or deviations is in contact at these phases: tooth k is at phases from -k; give "
            f"span='{longer}'",
            stacklevel=5,
        )

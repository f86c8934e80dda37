"""`mesh_stiffness`: from a gear pair to its stiffness curve, by finite elements or by an energy method."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, replace
from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geometry.damage.kinds import Damage
from geometry.pair.flanks import Misalignment, flank_forms
from geometry.pair.gear_pair import GearPair
from geometry.tooth.modified import Flank

from ..elements.asked import checked_refine
from ..flexibility.solved import SolvedGears, solved_gears
from ..material import Material, check_state
from ..steps import part
from ..supports.shaft import Shaft
from ..supports.support import Support
from ..threads import single
from .curve import StiffnessCurve
from .inputs import (
    by_gear,
    check_method,
    choose,
    forces_of,
    overlap,
    phase_array,
    refuse,
    refuse_numeric,
    row_of,
    said_of_face,
    two_materials,
)
from .limits import check_section, check_teeth, truth
from .own_flexibility import OwnFlexibility
from .plane import curve, section_solver, sum_solver, with_error
from .plausible import answered, as_asked, check_load
from .pose import check_pose, in_pose
from .provenance import damage_of, provenance
from .solid import wide_curves
from .supported import at_middle, supports_of
from .turns import over_turns


@overload
def mesh_stiffness(
    pair: GearPair,
    force: float | None = ...,
    material: Material | tuple[Material, Material] | None = ...,
    *,
    torque: float | None = ...,
    method: str | OwnFlexibility = ...,
    phases: int | ArrayLike = ...,
    span: str = ...,
    damage: Mapping[str, Sequence[Damage]] | None = ...,
    flanks: Mapping[str, Flank] | None = ...,
    misalignment: Misalignment | None = ...,
    supports: Mapping[str, Support | Shaft] | None = ...,
    extended: bool = ...,
    state: str = ...,
    refine: float = ...,
    order: int | None = ...,
    teeth: int | None = ...,
    variants: Mapping[str, Any] | None = ...,
    face: str | None = ...,
    groove: float = ...,
    error: bool = ...,
    cache: bool = ...,
    tell: Callable[[str], object] | None = ...,
    pose: str = ...,
) -> StiffnessCurve: ...


@overload
def mesh_stiffness(
    pair: GearPair,
    force: Sequence[float] | NDArray[np.float64] | None = ...,
    material: Material | tuple[Material, Material] | None = ...,
    *,
    torque: Sequence[float] | NDArray[np.float64] | None = ...,
    method: str | OwnFlexibility = ...,
    phases: int | ArrayLike = ...,
    span: str = ...,
    damage: Mapping[str, Sequence[Damage]] | None = ...,
    flanks: Mapping[str, Flank] | None = ...,
    misalignment: Misalignment | None = ...,
    supports: Mapping[str, Support | Shaft] | None = ...,
    extended: bool = ...,
    state: str = ...,
    refine: float = ...,
    order: int | None = ...,
    teeth: int | None = ...,
    variants: Mapping[str, Any] | None = ...,
    face: str | None = ...,
    groove: float = ...,
    error: bool = ...,
    cache: bool = ...,
    tell: Callable[[str], object] | None = ...,
    pose: str = ...,
) -> list[StiffnessCurve]: ...


@single
def mesh_stiffness(
    pair: GearPair,
    force: float | Sequence[float] | NDArray[np.float64] | None = None,
    material: Material | tuple[Material, Material] | None = None,
    *,
    torque: float | Sequence[float] | NDArray[np.float64] | None = None,
    method: str | OwnFlexibility = "auto",
    phases: int | ArrayLike = 64,
    span: str = "cycle",
    damage: Mapping[str, Sequence[Damage]] | None = None,
    flanks: Mapping[str, Flank] | None = None,
    misalignment: Misalignment | None = None,
    supports: Mapping[str, Support | Shaft] | None = None,
    extended: bool = True,
    state: str = "plane strain",
    refine: float = 1.0,
    order: int | None = None,
    teeth: int | None = None,
    variants: Mapping[str, Any] | None = None,
    face: str | None = None,
    groove: float = 0.0,
    error: bool = False,
    cache: bool = True,
    tell: Callable[[str], object] | None = None,
    pose: str = "mean",
) -> StiffnessCurve | list[StiffnessCurve]:
    """Mesh stiffness of a gear pair over one mesh cycle.

    ``k = F / delta``: F the force along the line of action, delta the loaded minus the unloaded transmission error as a
    length on it, bores held, or on `supports` that give way.

    Parameters
    ----------
    pair : GearPair
    force : float or sequence of float
        Force along the line of action over the whole width [N]. Several loads share one flexibility and give a list, of the same
        k as a call for each.
    material : Material or (Material, Material)
        Of both gears, or of pinion and wheel.
    torque : float or sequence of float, optional
        Instead of `force`: torque on the pinion [N m], ``force = torque / r_b`` with the pinion's base radius.
    method : {"auto", "ritz", "ritz3d", "fe", "fe3d", "coupled", "textbook", "published"} or OwnFlexibility
        What each takes is written in one table, `gearfe.stiffness.methods.ROWS`; in words:
        ``ritz``: the converged energy model of the transverse section, milliseconds (`gearfe.energy.ritz.plane`). ``ritz3d``: the
        same in three dimensions, seconds: spur, helical and herringbone gears of finite width, pits as lost contact
        (`gearfe.contact.solid`). ``auto``: ``ritz3d`` for helical gears and pits, otherwise ``ritz``; ``meta["why"]`` says why.
        To compare a damaged curve with the healthy one ask for both by the same method. ``fe``: finite elements of whole
        sections, the independent reference (`gearfe.elements.fe`).
        ``fe3d``: hexahedra of whole gears of finite width, the same for ``ritz3d``, minutes (`gearfe.elements.fe_gear3d`).
        ``coupled``: closed forms repaired by known means, external healthy gears (`gearfe.energy.closed.coupled`). All with line
        contact, neighbour coupling and load sharing. ``textbook``, ``published``: beam energies and a plain sum of the pairs
        (`gearfe.energy.closed.plain_sum`). An `OwnFlexibility`: your own model of how one gear gives, where ``ritz`` and ``fe``
        stand otherwise.
    phases : int or array
        Number of equidistant phases per mesh cycle, or the phases themselves.
    span : {"cycle", "tooth", "revolution", "hunting"}
        Which phases a number stands for: from 0 to 1; or the whole engagement of pair 0 and a quarter cycle before and
        after it (where the damaged tooth is); or every cycle of one revolution of the pinion, or of the hunting period after
        which the same teeth meet again (for pitch deviations; cycles that are alike are solved once). In three dimensions pair 0
        enters at one end at phase 0.
    damage : dict, optional
        Cracks and pits by gear: ``{"pinion": [Crack(...), Pit(...)], "wheel": [...]}``. Cracks: all but ``coupled``; of part of
        the width or of a depth that changes along it: ``ritz3d`` and ``fe3d``. Pits: ``ritz3d``, ``fe3d`` and the plain sums.
        Crack faces that the load presses together are kept apart; ``meta["crack_closed_phases"]`` says where. (Likewise
        ``meta["tip_in_fillet_phases"]`` says where a tip presses into its mate's fillet, if any does.)
    flanks : dict, optional
        Modifications and deviations of the loaded flanks: ``{"pinion": Flank(...), "wheel": Flank(...)}``, for all methods; what
        changes along the width needs ``ritz3d``, ``fe3d`` or a plain sum. The curve's `te` then is the transmission error under
        load and `unloaded` that without; with pitch deviations give phases of as many teeth as are to be seen.
    misalignment : Misalignment, optional
        Axes that are not parallel, for the same. (A centre distance that is not the nominal one: the pair's `a`.)
    supports : dict, optional
        Springs or shafts under the hubs: ``{"pinion": Shaft(...), "wheel": Support(...)}``; default: rigid bores. Hubs that
        tilt need ``ritz3d`` or ``fe3d``. The curve's `lte_supports` is their part of the deflection.
    extended : bool
        Let corners touch before the start and after the end of the path of contact (all but the closed
        forms, which know no contact there).
    state : {"plane strain", "plane stress"}
        For ``ritz`` and ``fe``; the beams of the closed forms use E as their sources do.
    refine : float
        Resolution of ``ritz`` and ``fe``, also in three dimensions: divides the edge lengths; 0.2 to 64.
    order : int, optional
        Polynomial order of ``ritz`` (default 4) and ``ritz3d`` (in the section; default 3), 2 to 8.
    teeth : int, optional
        For ``fe``: number of teeth that are modelled, on a plain rim; default: all.
    variants : dict, optional
        For ``textbook`` and ``published``: options of `gearfe.energy.closed.plain_sum.plain_sum` and of the formulas'
        ``components`` (``root``, ``foot``, ``foundation``, ``lever``, ``theta_f``, ``crack_model``, ``contact``, ``lost``).
    face : {"spur", "helical", "herringbone"}, optional
        For ``ritz3d``, ``fe3d`` and the plain sums: how the teeth run. Default: ``helical`` for gears with a helix angle in
        ``ritz3d`` and ``fe3d``, otherwise ``spur`` (of helical gears the transverse section, as a spur gear of the same width).
    groove : float
        Width of a herringbone pair's relief groove [mm], part of b.
    error : bool
        For ``ritz`` and ``fe``, also in three dimensions: estimate the discretisation error of every k from coarser solves (see
        `gearfe.stiffness.estimate.estimate` and `gearfe.stiffness.solid.wide_curves`).
    cache : bool
        Reuse what was solved before in this process; for ``fe`` and ``fe3d`` also in an earlier one (see
        `gearfe.stiffness.cache`). False: solve everything anew, keep and displace nothing.
    tell : callable, optional
        For ``fe3d``: gets a line of text before the first of several gears, with the expected seconds of all (with `error` those
        of its coarser gears, too), and one before each, with its unknowns, seconds and memory. What does not fit into memory is
        refused before the first.
    pose : {"mean", "pinion", "wheel"}
        Which gear the approach turns from where the phase has both: each by half of it (as a length on the line of action), or
        one against the held other. Near the ends of double contact k differs by 1 to 2 % (`geometry.pair.contacts`); the last two
        solve the contact about four times.

    Returns
    -------
    StiffnessCurve, or a list of them if `force` is a sequence

    Raises
    ------
    ValueError
        If an input is impossible, or given to a method that has no such thing; the message says which. If the gears approach so
        far that strains are no longer small (`gearfe.stiffness.plausible`).
    RuntimeError
        If a system of ``fe`` or ``fe3d`` does not fit into memory, before it is solved; the message has the numbers.

    Warns
    -----
    UserWarning
        If deflection or pressure are beyond what teeth bear, see `gearfe.stiffness.plausible`.
    """
    if not isinstance(pair, GearPair):
        raise ValueError(f"pair = {pair!r}, but give a GearPair")
    check_method(method)
    forces = forces_of(pair, force, torque)
    check_teeth(teeth, max(pair.gear_1.z, pair.gear_2.z))
    refine, error, extended = checked_refine(refine), truth("error", error), truth("extended", extended)
    solved = cache if isinstance(cache, SolvedGears) else solved_gears(truth("cache", cache))
    materials = two_materials(material)
    for value in forces:
        check_load(pair, value, materials)
    check_state(state)
    check_pose(pose)
    cracks, pits = by_gear(pair, damage)
    forms = flank_forms(pair, flanks, misalignment)
    held = supports_of(pair, supports, forces, face)
    method, why = choose(method, pair, cracks, pits, face, teeth, forms, held)
    row, own = row_of(method)
    refuse(row, pair, cracks, pits, teeth, variants, face, groove, forms)
    refuse_numeric(row, refine=refine, order=order, error=error, state=state)
    said_of_face(pair, face)
    if row.name == "fe":
        check_section(refine)
    if row.kind == "solid" and face is None:
        face = "helical" if pair.gear_1.beta else "spur"
    yields = at_middle(pair, held, row, face)
    phase = phase_array(phases, span, pair, overlap(pair, face, groove))
    same: dict[str, Any] = {"method": own or row.name, "damage": damage, "flanks": flanks, "misalignment": misalignment}
    same |= {"supports": supports, "extended": extended, "state": state, "refine": refine, "teeth": teeth, "variants": variants}
    same |= {"face": face, "groove": groove, "order": order, "error": error, "cache": cache, "tell": tell}
    if span in ("revolution", "hunting"):
        more = same | {"pose": pose, "cache": solved}
        differs = [bool(cracks[i] or pits[i]) or (forms is not None and forms[i].differs) for i in (0, 1)]
        turned = over_turns(
            lambda at: mesh_stiffness(pair, np.array(forces), materials, phases=at, **more), phase, pair, span, differs
        )
        return as_asked([replace(one, meta=one.meta | {"why": why}) for one in turned], force, torque)
    if pose != "mean":
        curves = [
            in_pose(lambda at, value=value: mesh_stiffness(pair, value, materials, phases=at, **same), phase, pair, pose, forms)
            for value in forces
        ]
        curves = [replace(one, meta=one.meta | {"why": why}) for one in curves]
        return as_asked(curves, force, torque)
    numeric = {"refine": refine, "order": row.order if order is None else order}
    said = ({"damage": damage_of(cracks, pits)} if any(cracks) or any(pits) else {}) | {"why": why, "pose": pose}
    said |= {"flanks": {name: asdict(one) for name, one in flanks.items() if one}} if forms and flanks else {}
    said |= {"misalignment": asdict(misalignment)} if misalignment is not None else {}
    said |= {"supports": {name: asdict(one) for name, one in supports.items() if one}} if held and supports else {}
    if row.kind == "solid":
        options = {"face": face, "groove": groove, "extended": extended, **numeric}
        case = (pair, materials, phase, cracks, pits)
        written = {name: value for name, value in options.items() if name != "order" or row.order}
        meta = provenance(pair, materials, row.name, written | said)
        options |= {"brute": row.kept == "disk", "error": error, "cache": solved, "tell": tell}
        options |= {"flanks": forms, "supports": held}
        with part(row.name, 0.0, 1.0):
            curves = wide_curves(forces, case, meta, **options)
        return answered(curves, pair, materials, force, torque)
    if row.kind == "sum":
        sliced = {"variants": variants or {}, "face": face or "spur", "groove": groove, "flanks": forms, "yields": yields}
        solve, details = sum_solver(row, pair, materials, phase, cracks=cracks, pits=pits, **sliced)
    else:
        numeric |= {"cracks": cracks, "flanks": forms, "extended": extended, "state": state, "cache": solved, "teeth": teeth}
        numeric["yields"] = yields
        with part(row.name, 0.0, 0.4 if error else 1.0):
            solve, details = section_solver(row, own, pair, materials, phase, **numeric)
    meta = provenance(pair, materials, row.name, details | said)
    hurt = tuple((*cracks[i], *pits[i]) for i in (0, 1)) if any(cracks) or any(pits) else None
    curves = [curve(pair, phase, value, solve, meta, hurt) for value in forces]
    if error and row.error:
        with part("estimate of the error", 0.4, 1.0):
            curves = with_error(row, curves, (pair, materials, phase), numeric)
    return answered(curves, pair, materials, force, torque)

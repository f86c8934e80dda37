"""`mesh_stiffness`: a `Case` and a `Solve` in one call, and the options that functions of a pair accept."""

from collections.abc import Callable, Mapping
from typing import Any, Unpack, overload

from numpy.typing import ArrayLike

from ..core.case import NAMES, Case, CaseOptions, case_of
from ..flexibility.solved import SolvedGears
from ..geometry.pair.gear_pair import GearPair
from .curve import StiffnessCurve
from .own_flexibility import OwnFlexibility
from .solve import OPTIONS, Loads, Materials, Solve, solve


class PairOptions(CaseOptions, total=False):
    """Options of a `Case` and of a `Solve`, except phases, span and error."""

    method: str | OwnFlexibility
    extended: bool
    state: str
    refine: float
    order: int | None
    teeth: int | None
    variants: Mapping[str, Any] | None
    cache: bool | SolvedGears
    tell: Callable[[str], object] | None
    pose: str


class StiffnessOptions(PairOptions, total=False):
    """Options of `mesh_stiffness`."""

    phases: int | ArrayLike
    span: str
    error: bool


@overload
def mesh_stiffness(
    pair: GearPair | Case,
    force: float | None = ...,
    material: Materials = ...,
    *,
    torque: float | None = ...,
    **options: Unpack[StiffnessOptions],
) -> StiffnessCurve: ...


@overload
def mesh_stiffness(
    pair: GearPair | Case,
    force: Loads | None = ...,
    material: Materials = ...,
    *,
    torque: Loads | None = ...,
    **options: Unpack[StiffnessOptions],
) -> list[StiffnessCurve]: ...


def mesh_stiffness(
    pair: GearPair | Case,
    force: Any = None,
    material: Materials = None,
    *,
    torque: Any = None,
    **options: Unpack[StiffnessOptions],
) -> Any:
    """Compute the time-varying mesh stiffness (TVMS) of a gear pair: a `Case` and a `Solve` in one call.

    The stiffness is ``k = F / delta``. F is the force along the line of action. Delta is the loaded minus the unloaded
    transmission error as a length on it. Bores are held or on elastic `supports`.

    Parameters
    ----------
    pair : GearPair or Case
    force : float or sequence of float
        Force along the line of action over the whole width [N]. Several loads share one flexibility and give a list, of the same
        k as a call for each.
    material : Material or (Material, Material)
        Of both gears, or of pinion and wheel.
    torque : float or sequence of float, optional
        Instead of `force`: torque on the pinion [N m].
    **options
        ``damage``, ``flanks``, ``misalignment``, ``supports``, ``face``, ``groove``: see `Case`. ``method``, ``phases``,
        ``span``, ``extended``, ``state``, ``refine``, ``order``, ``teeth``, ``variants``, ``error``, ``cache``, ``tell``,
        ``pose``: see `Solve`. With ``flanks``, the result also has the loaded (`te`) and unloaded (`unloaded`) transmission
        error. With ``supports``, `support_deflection` is the deflection of the supports. ``meta["crack_closed_phases"]`` are
        phases at which crack faces are in contact, ``meta["tip_in_fillet_phases"]`` phases at which a tip touches its mate's
        fillet.

    Returns
    -------
    StiffnessCurve, or a list of them if `force` is a sequence

    Raises
    ------
    ValueError, RuntimeError
        See `Case`, `Solve` and `solve`.

    Examples
    --------
    >>> import math, gearfe as gf
    >>> rack = dict(m_n=2.0, alpha_n=math.radians(20), b=20.0)
    >>> pair = gf.GearPair(gf.Gear(z=21, r_bore=7.4, **rack), gf.Gear(z=31, r_bore=11.4, **rack))
    >>> curve = gf.mesh_stiffness(pair, force=2000.0, material=gf.Material(E=207e3, nu=0.25), method="ritz", phases=32)
    >>> print(f"{1e-6 * curve.k.mean():.0f} N/um on average, from {1e-6 * curve.k.min():.0f} to {1e-6 * curve.k.max():.0f}")
    314 N/um on average, from 244 to 351
    """
    return solve(*split_arguments("mesh_stiffness", pair, force, material, torque, options))


def split_arguments(
    function: str, pair: GearPair | Case, force: Any, material: Materials, torque: Any, options: Mapping[str, Any]
) -> tuple[Case, Solve]:
    """Return the `Case` and the `Solve` of the arguments of a function that takes both.

    Raises TypeError for an unknown option.
    """
    unknown = sorted(set(options) - {*NAMES, *OPTIONS})
    if unknown:
        from difflib import get_close_matches

        near = get_close_matches(unknown[0], known := (*NAMES, *OPTIONS), 1)
        there = f"nearest: {near[0]!r}" if near else f"it has {', '.join(known)}"
        raise TypeError(f"{function}() has no argument {unknown[0]!r}; {there}")
    of_case = {name: value for name, value in options.items() if name in NAMES}
    how = Solve(**{name: value for name, value in options.items() if name in OPTIONS})
    return case_of(pair, force, material, torque=torque, **of_case), how

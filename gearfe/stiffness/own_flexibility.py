"""`OwnFlexibility`: a user-defined flexibility of one gear, in place of `ritz` or `fe`."""

from collections.abc import Callable
from dataclasses import dataclass
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.checks import one_of
from ..core.material import Material
from ..flexibility.energy.closed import coupled
from ..flexibility.energy.closed.beam import Components
from ..flexibility.plane import singly
from ..geometry.aliases import Floats
from ..geometry.tooth.gear import Gear
from .methods import METHODS, SUMS, having

GIVEN = ("bulk", "smooth")
SAME = 1e-8  # relative tolerance of symmetry
NO_FLEXIBILITY = (
    "a formula that adds the stiffnesses of independent tooth pairs: it has no flexibility matrix of a gear; use it as "
    "method = '{0}', or give one of {1}, a function f(gear, material, radius, tooth) -> (n, n), or a Flexibility"
)


@dataclass(frozen=True, slots=True)
class OwnFlexibility:
    """User-defined flexibility of a gear between its contacts: ``mesh_stiffness(..., method=OwnFlexibility(f))``.

    The model describes the gear under unit loads, with all teeth in contact at the same time. It returns the displacement of
    contact i, along the line of action and into the gear, under a unit line load at contact j. The bore (of a ring: the rim) is
    held. The diagonal is the flexibility of each tooth. The other entries are the coupling of teeth by their body; zeros mean no
    coupling.

    gearfe adds the rest: contacts of the teeth, the other gear, the local contact under the load of each pair, and load sharing.
    With P the line load and ``c = 2 (1 - nu**2) / (pi E)``, the contact adds to each gear ``c P (ln(2 / a) + 1/2)``, lengths in
    mm and a Hertz's half width (`gearfe.contact.sharing.line_contact`). `given` states which part of the local contact deflection
    the model contains:

    - ``bulk``: the values contain beam, shear, compression and body, without contact deflection, like closed forms. gearfe adds
      Weber's whole local deflection down to the tooth's centre-line (`gearfe.flexibility.energy.closed.coupled.local_remainder`).
    - ``smooth``: the values contain everything but the half-plane's logarithm: the displacement u(r) at a distance r from a unit
      line load, plus ``c ln r`` (r in mm), for r to 0. This holds for `ritz` and finite elements.

    There is no contact at tip corners off the path of contact, like for closed forms (``extended`` of the curve's ``meta`` is
    False), unless both gears are `Flexibility` objects or methods that model it. A function must include the damage itself, since
    it receives the number of the tooth; ``damage`` of `mesh_stiffness` is rejected.

    Parameters
    ----------
    pinion : callable, Flexibility or str
        ``f(gear, material, radius, tooth) -> (n, n)`` [mm per N/mm]. `radius` (n,) are the radii of the contacts [mm], ndarray,
        between form and tip circle. `tooth` (n,) are their teeth, whole numbers counted from tooth 0 towards the gear's loaded
        side (the wheel's tooth in pair k is -k), so that teeth i and j are ``(j - i) 2 pi / z`` apart. It is called once for each
        phase. Or an object with ``matrix(roll, teeth)`` like `gearfe.flexibility.plane.Flexibility`, for this gear and ``smooth``
        by definition. Or the name of a method that has a flexibility: ``"ritz"``, ``"fe"``, ``"coupled"``.
    wheel : callable, Flexibility or str, optional
        Model of the wheel; default: that of the pinion.
    given : {"bulk", "smooth"}
        Content of the functions' values.
    name : str, optional
        Name of the method in ``meta`` and tables; default: the function's.

    Raises
    ------
    ValueError
        If a model is none of these, such as a plain sum of tooth pairs (``"textbook"``, ``"herringbone_article"``).
        `mesh_stiffness` raises one if a function fails, or its matrix has another shape, is not real, finite and symmetric, or
        (``bulk``) is not positive definite.

    Examples
    --------
    Teeth as bars of constant thickness on rigid bodies, compared with the converged energy model, in N/(mm um):

    >>> import math, numpy as np, gearfe as gf
    >>> rack = dict(m_n=2.0, alpha_n=math.radians(20), b=20.0)
    >>> pair = gf.GearPair(gf.Gear(z=21, r_bore=7.4, **rack), gf.Gear(z=31, r_bore=11.4, **rack))
    >>> def bar(gear, material, radius, tooth):
    ...     arm, thickness = radius - gear.r_f, 2 * gear.m_n
    ...     bending = 4 * arm**3 / (material.E * thickness**3)
    ...     return np.diag(bending + 1.2 * arm / (material.shear_modulus * thickness))
    >>> run = dict(pair=pair, force=2000.0, material=gf.Material(E=207e3, nu=0.3), phases=16, extended=False)
    >>> bars, mixed, ritz = (
    ...     gf.mesh_stiffness(**run, method=method).k.mean() / 20e6
    ...     for method in (gf.OwnFlexibility(bar), gf.OwnFlexibility(bar, "ritz"), "ritz")
    ... )
    >>> print(f"bars {bars:.1f}, a pinion of bars on a real wheel {mixed:.1f}, two real gears {ritz:.1f}")
    bars 28.9, a pinion of bars on a real wheel 20.3, two real gears 15.6
    """

    pinion: Any
    wheel: Any = None
    given: str = "bulk"
    name: str | None = None

    def __post_init__(self) -> None:
        """Check that the models of both gears have a flexibility, and name the model."""
        one_of("given", self.given, GIVEN)
        if self.wheel is None:
            object.__setattr__(self, "wheel", self.pinion)
        for side in ("pinion", "wheel"):
            _check(side, getattr(self, side))
        if self.name is None:
            object.__setattr__(self, "name", getattr(self.pinion, "__name__", "own flexibility"))
        if self.name in METHODS:
            raise ValueError(f"name = {self.name!r} is a method of gearfe: give another name")

    @property
    def extended(self) -> bool:
        """True if both gears model tip-corner contact."""
        return all(METHODS[gear].extended if isinstance(gear, str) else bool(getattr(gear, "own", None)) for gear in self.gears)

    @property
    def gears(self) -> tuple[Any, Any]:
        """Models of pinion and wheel."""
        return self.pinion, self.wheel

    def told(self) -> dict[str, Any]:
        """Return entries of `meta`: names of both gears' models, and the contents of their flexibilities."""
        names = [gear if isinstance(gear, str) else getattr(gear, "__name__", type(gear).__name__) for gear in self.gears]
        return {"flexibility": names, "given": self.given}


def _check(side: str, one: object) -> None:
    """Raise ValueError unless `one` is a function, a Flexibility, or the name of a method that has a flexibility."""
    sections = having("name", "section")
    home = getattr(one, "__name__", None) if isinstance(one, ModuleType) else getattr(one, "__module__", None)
    for name in SUMS:
        if (isinstance(one, str) and one == name) or home == METHODS[name].home:
            raise ValueError(f"{side} = {one!r}: {name} is " + NO_FLEXIBILITY.format(name, sections))
    named = isinstance(one, str) and one in METHODS and METHODS[one].kind == "section"
    if not (named or callable(one) or callable(getattr(one, "matrix", None))):
        raise ValueError(
            f"{side} = {one!r}, but give a function f(gear, material, radius, tooth) -> (n, n), a Flexibility, or {sections}"
        )


def _unknown(gear: Any, roll: NDArray, tooth: int) -> None:
    """Return None, because the flexibility in tangential direction is unknown."""


@dataclass(frozen=True, slots=True)
class OwnGear:
    """User's function of `OwnFlexibility`, with the interface that `gearfe.contact.pair_contact.PairContact` needs."""

    function: Callable
    gear: Gear
    material: Material
    state: str
    given: str
    seam = None
    dofs = 0
    fine = 1.0
    within = singly
    yields_across = _unknown

    def matrix(self, roll: NDArray, teeth: NDArray) -> NDArray:
        """Smooth flexibility ``(..., n, n)`` [mm per N/mm] between contacts at `roll` ``(..., n)`` on `teeth` ``(n,)``.

        The function is called for contacts on the flank only. Other contacts get zeros and never touch.
        """
        (roll, on), teeth = _on_flank(self.gear, roll), np.asarray(teeth)
        out = np.zeros((*roll.shape, teeth.size))
        for place in np.ndindex(roll.shape[:-1]):
            contacts = np.flatnonzero(on[place])
            if contacts.size:
                out[(*place, contacts[:, None], contacts)] = self._among(roll[place][contacts], teeth[contacts])
        return out

    def _among(self, roll, teeth):
        """Return the smooth flexibility between contacts of one phase, with checked values of the function."""
        radius = np.hypot(self.gear.r_b, roll)
        name, n = getattr(self.function, "__name__", "own flexibility"), radius.size
        where = f"{name} of z = {self.gear.z} at radius = {np.array2string(radius, precision=6)} mm, tooth = {teeth.tolist()}"
        values = _checked(where, (n, n), lambda: self.function(self.gear, self.material, radius, teeth))
        if self.given == "smooth":
            return values
        if np.linalg.eigvalsh(values).min() < -SAME * np.abs(values).max():
            raise ValueError(
                f"{where}: its matrix is not positive (semi)definite, so the gear would release energy under some loads"
            )
        dent = coupled.local_remainder(self.gear, self.material, roll, state=self.state)
        return values + np.diag(dent)


@dataclass(frozen=True, slots=True)
class OwnMatrix:
    """User's object with ``matrix(roll, teeth)``, adapted to the contact solver. Its values are checked."""

    made: Any
    gear: Gear
    seam = None
    dofs = 0
    fine = 1.0
    within = singly
    yields_across = _unknown

    def matrix(self, roll: NDArray, teeth: NDArray) -> NDArray:
        """Return the smooth flexibility ``(..., n, n)`` [mm per N/mm] of the object, with zeros for contacts off the flank."""
        roll, on = _on_flank(self.gear, roll)
        shape = (*roll.shape, np.size(teeth))
        where = f"{type(self.made).__name__}.matrix of z = {self.gear.z}, roll of shape {roll.shape}, {np.size(teeth)} teeth"
        values = _checked(where, shape, lambda: self.made.matrix(roll, teeth))
        return np.where(on[..., :, None] & on[..., None, :], values, 0.0)


def _on_flank(gear: Gear, roll: NDArray) -> tuple[Floats, NDArray[np.bool_]]:
    """Return roll lengths limited to the flank, and a mask of those that were on the flank."""
    roll = np.asarray(roll, dtype=float)
    low, high = gear.flank_rolls
    slack = 1e-6 * gear.m_n
    return np.clip(np.nan_to_num(roll, nan=low), low, high), (roll > low - slack) & (roll < high + slack)


def _checked(where: str, shape: tuple[int, ...], work: Callable[[], Any]) -> Floats:
    """Return the result of a user's function. Raises ValueError unless it is real, finite, symmetric and of this `shape`."""
    try:
        returned = work()
    except Exception as error:  # A user's function may raise any exception.
        raise ValueError(f"{where}: it failed with {type(error).__name__}: {error}") from error
    if isinstance(returned, Components):
        raise ValueError(
            f"{where}: it returned Components of a single tooth, but give a matrix; for uncoupled teeth it is numpy.diag "
            "of their `total`"
        )
    try:
        values = np.asarray(returned)
    except ValueError as error:  # The rows have different lengths.
        raise ValueError(f"{where}: its rows have different lengths; give a matrix of numbers [mm per N/mm]") from error
    if values.dtype.kind not in "fiu":
        raise ValueError(f"{where}: it returned values of type {values.dtype}, but give a matrix of real numbers [mm per N/mm]")
    if values.shape != shape:
        raise ValueError(
            f"{where}: it returned an array of shape {values.shape}, but give {shape}: displacement of contact i under a "
            "unit load at contact j (numpy.diag is that of uncoupled teeth)"
        )
    values = values.astype(float)
    if not np.isfinite(values).all():
        raise ValueError(f"{where}: it returned values that are not finite")
    if np.abs(values - values.mT).max() > SAME * np.abs(values).max():
        raise ValueError(f"{where}: its matrix is not symmetric, but contact i moves j as j moves i (Maxwell, Betti)")
    return values


def flexibility_of(own: OwnFlexibility, side: int, gear: Gear, material: Material, state: str, named: Callable) -> Any:
    """Return the flexibility of one gear (side 0: pinion, 1: wheel).

    ``named(row, gear, material)`` is that of a method.
    """
    model = own.gears[side]
    if isinstance(model, str):
        return named(METHODS[model], gear, material)
    if callable(getattr(model, "matrix", None)):
        if getattr(model, "gear", gear) != gear:
            raise ValueError(
                f"a Flexibility of z = {model.gear.z} was given for z = {gear.z}: it is valid for its own gear only; "
                "give those of pinion and wheel"
            )
        return model if hasattr(model, "seam") else OwnMatrix(model, gear)
    return OwnGear(model, gear, material, state, own.given)

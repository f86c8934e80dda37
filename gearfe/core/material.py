"""`Material`: linear isotropic elasticity, and its plane constants."""

import math
import warnings
from dataclasses import dataclass

from .checks import is_number

STIFFEST = 1.3e6  # upper limit of E [MPa], above diamond
SOFT = 500.0  # warning limit of E [MPa], below nearly all gear materials; 207 is probably a value in GPa


@dataclass(frozen=True, slots=True)
class Material:
    """Young's modulus `E` [MPa] and Poisson's ratio `nu`.

    Raises
    ------
    ValueError
        If E is not positive or larger than that of any material, or nu is outside ``0 <= nu < 0.5``.

    Warns
    -----
    UserWarning
        If E is so small that GPa instead of MPa is likely.

    >>> Material(E=207e3, nu=0.25).shear_modulus
    82800.0
    """

    E: float = 206e3
    nu: float = 0.3

    def __post_init__(self) -> None:
        """Raise ValueError for constants of an unstable material."""
        for name in ("E", "nu"):
            value = getattr(self, name)
            if not is_number(value):
                raise ValueError(f"{name} = {value!r}, but this value of a material must be a number")
            object.__setattr__(self, name, float(value))
        if not (math.isfinite(self.E) and self.E > 0):
            raise ValueError(f"E = {self.E} MPa, but Young's modulus must be positive and finite")
        if self.E > STIFFEST:
            raise ValueError(
                f"E = {self.E:g} MPa, but no material is so stiff (diamond: 1.2e6 MPa): give E in MPa, not Pa; steel has 207e3"
            )
        if self.E < SOFT:
            warnings.warn(f"E = {self.E:g} MPa is softer than any gear: give E in MPa, not GPa; steel has 207e3", stacklevel=4)
        if not 0 <= self.nu < 0.5:
            raise ValueError(f"nu = {self.nu}, but plane strain needs 0 <= nu < 0.5; use 0.4999 for rubber")

    @property
    def shear_modulus(self) -> float:
        """Shear modulus [MPa]."""
        return self.E / (2 * (1 + self.nu))

    def lame(self, state: str) -> tuple[float, float]:
        """Plane Lame constants (lambda, mu) [MPa]. `state` is "plane strain" or "plane stress"."""
        mu = self.shear_modulus
        if check_state(state) == "plane stress":
            return self.E * self.nu / (1 - self.nu**2), mu
        return self.E * self.nu / ((1 + self.nu) * (1 - 2 * self.nu)), mu

    def plane_modulus(self, state: str) -> float:
        """``E / (1 - nu**2)`` in plane strain, ``E`` in plane stress [MPa]."""
        return self.E if check_state(state) == "plane stress" else self.E / (1 - self.nu**2)


def check_state(state: str) -> str:
    """Return `state`, or raise ValueError if it is not a plane state."""
    if not isinstance(state, str) or state not in ("plane strain", "plane stress"):
        raise ValueError(f"state = {state!r}, but it must be 'plane strain' or 'plane stress'")
    return state

"""Limits of linear elasticity, checked once for each stiffness curve at the end of `mesh_stiffness`.

The limits hold for every material, because they are strains. A force F on a tooth of width b causes a root stress of about ``4
F / (b m)``, and the mesh deflects by ``F / (b c')`` with ``c' = E / 14`` approximately. A deflection of 1 % of the module
therefore means root strains of 0.3 %, at which hardened steel begins to yield.

- `WARN`: 5 % of the module. Root strains are 1.4 %, beyond the strength of gear steels. A warning is given.
- `REFUSE`: 25 % of the module. Strains are 7 %. The neglected displacements change k by a similar part. An error is raised.
- `DENTED`: pressure of 0.035 E*, which is 4 GPa for steel, the static limit of hardened rollers (ISO 76:2006, 5.1: a permanent
  deformation of 1e-4 of the roller diameter). A warning is given, because a local peak hardly changes k.
"""

import warnings

import numpy as np

from ..core.material import Material
from ..core.supports.held import REFUSE
from ..flexibility.hertz import contact_modulus
from ..geometry.pair.gear_pair import GearPair
from .curve import StiffnessCurve

WARN = 0.05  # approach above which a warning is issued [m_n]
DENTED = 0.035  # largest pressure above which a warning is issued [contact modulus E*]


def check_plausible(curve: StiffnessCurve, pair: GearPair, materials: tuple[Material, Material]) -> None:
    """Raise ValueError for invalid stiffness or very large strains, and warn of large strains.

    ValueError if the gears approach by more than `REFUSE` modules, or k is not positive and finite. UserWarning if they approach
    by more than `WARN` modules at the median phase, or the pressure is larger than `DENTED` E* there.
    """
    force, module = curve.meta["force_N"], pair.gear_1.m_n
    if not (np.isfinite(curve.k).all() and (curve.k > 0).all()):
        bad = curve.phase[~(np.isfinite(curve.k) & (curve.k > 0))][0]
        raise ValueError(f"k at phase {bad:.6g} is not positive and finite: no model holds for these gears at {force:g} N")
    deflection = (
        curve.deflection if curve.support_deflection is None else curve.deflection - curve.support_deflection
    )  # deflection of the teeth alone, without their shafts
    ratio = float(np.median(deflection)) * 1e3 / module
    message = f"under {force:g} N the gears approach by {1e3 * ratio * module:.3g} um, {100 * ratio:.3g} % of the module"
    if ratio > REFUSE:
        raise ValueError(
            f"force = {force:g} N: {message}, but the limit is {100 * REFUSE:g} %, where teeth break: give a smaller "
            "force, a wider face or a larger module; units are N, mm and MPa (E)"
        )
    if ratio > WARN:
        warnings.warn(f"{message}: more than teeth withstand ({100 * WARN:g} %); k is that of linear elasticity", stacklevel=4)
    most, limit = _pressure(curve), DENTED * contact_modulus(materials)
    if most > limit:
        warnings.warn(
            f"under {force:g} N the contact pressure of {most:.4g} MPa exceeds about {limit:.3g} MPa, at which the flanks yield; "
            "k is that of linear elasticity",
            stacklevel=4,
        )


def _pressure(curve):
    """Return the largest pressure of the pairs [MPa] at the median phase, or 0 if there is none."""
    known = np.where(np.isfinite(curve.pressure), curve.pressure, 0.0)
    return float(np.median(known.max(axis=1, initial=0.0))) / 1e6

"""`contact_pattern`: contact lines of a pair over the mesh cycle with loads and pressures."""

from typing import Unpack

from numpy.typing import ArrayLike

from ..contact.wide_contact import Contact3D, pair_stiffness3d
from ..core.case import Case, CaseOptions, case_of
from ..core.threads import single
from ..geometry.pair.gear_pair import GearPair
from .phases import phase_array
from .solve import Materials
from .supported import check_integral


@single
def contact_pattern(
    pair: GearPair | Case,
    force: float | None = None,
    material: Materials = None,
    *,
    torque: float | None = None,
    phases: int | ArrayLike = 24,
    **given: Unpack[CaseOptions],
) -> Contact3D:
    """Compute the contact pattern of a pair over the mesh cycle by ``ritz3d``: loads and pressures of every contact line.

    `gearfe.plot_contact` draws it; ``phase=None`` draws all phases. If a tip corner or an end face has the largest load, it is
    marked as edge contact.

    Parameters
    ----------
    pair : GearPair or Case
    force : float
        Force along the line of action [N].
    material : Material or (Material, Material)
    torque : float, optional
        Instead of `force`: torque on the pinion [N m].
    phases : int or array
        See `Solve`.
    **given
        Options of `Case`: ``flanks``, ``misalignment``, ``supports``, ``damage``, ``face``, ``groove``.

    Returns
    -------
    Contact3D
        `cells` holds for each phase the pieces of the contact lines: positions, loads [N] and pressures [MPa].

    Raises
    ------
    ValueError
        If an input is impossible; the message states which.

    Examples
    --------
    >>> import math, gearfe as gf
    >>> rack = dict(m_n=3.0, alpha_n=math.radians(20), b=12.0)
    >>> pair = gf.GearPair(gf.Gear(z=24, r_bore=15.0, **rack), gf.Gear(z=30, r_bore=18.0, **rack))
    >>> askew = gf.Misalignment(F_beta_x=0.02)
    >>> contact = gf.contact_pattern(pair, 2000.0, gf.Material(E=207e3, nu=0.3), misalignment=askew, phases=[0.75])
    >>> [round(z, 6) for z, _ in contact.cells[0].at_ends(pair)]
    [0.0]
    """
    case = case_of(pair, force, material, torque=torque, **given)
    if case.several:
        raise ValueError(f"force = {case.force!r}, but a contact pattern needs a single force")
    check_integral(case, "ritz3d")
    phase = phase_array(phases, "cycle", case.pair, case.overlap())
    return pair_stiffness3d(case, phase)

"""Two gears on elastic shafts."""

import math
from collections.abc import Mapping
from typing import Any

from ...geometry.pair.gear_pair import GearPair
from .gear_mesh import GearMesh
from .layout import Body, Layout
from .loads import History, Load
from .mesh_curves import Stiffness
from .stages import Stage
from .tables import Machine
from .tooth_damage import ToothDamage


def gear_pair_machine(
    pair: GearPair,
    bodies: tuple[Body, Body],
    stiffness: Stiffness,
    *,
    speed: float,
    torque: History,
    support: Mapping[str, float],
    torsion: tuple[float, float] = (0.0, 0.0),
    zeta: float = 0.02,
    helix: float | None = None,
    damage: tuple[ToothDamage, ...] = (),
    **mesh: Any,
) -> Machine:
    """Build two gears on elastic shafts: 6 degrees of freedom (x, y, theta each), more if the bodies have more.

    Gear 1 drives counter-clockwise. The centre of gear 2 is on the x axis.

    Parameters
    ----------
    pair : GearPair
    bodies : (Body, Body)
        The bodies of the two gears, with their names and directions.
    stiffness
        Mesh stiffness along the transverse line of action [N/m^power], anything that `GearMesh` takes.
    speed : float
        Speed of gear 1 [rad/s].
    torque : float, (ndarray, ndarray) or callable
        Torque on gear 1 [N m]; gear 2 carries it times the ratio of the base radii.
    support : dict
        Stiffness of both bearings by direction, ``{"x": k, "y": k, ...}`` [N/m, N m/rad].
    torsion : (float, float)
        Torsional stiffness of the shafts to drive and to load [N m/rad]; 0: free.
    zeta : float
        Damping ratio of the supports.
    helix : float, optional
        ``tan(beta_b)`` with the sign of the axial force on gear 2; default: from the gears, pushing it along +z.
    damage : tuple of ToothDamage
    **mesh
        Further fields of `GearMesh`.

    Returns
    -------
    Machine
        In SI units and a frame at rest: x [m] from gear 1 to gear 2, z along the axes, rotations [rad] counter-clockwise; the
        directions of body 1, then those of body 2.

    Raises
    ------
    ValueError
        If there are not two bodies and two torsional stiffnesses; if a mass or a moment of inertia is not positive, the mesh
        stiffness or `zeta` is negative or not finite, `speed` or `torque` is not finite, or the times of a history fall; if the
        phases of a damaged tooth's curve do not rise, or it is longer than the cycles until the tooth returns; if a field of
        `GearMesh` is out of range.
    """
    layout, (body_1, body_2) = Layout(bodies), bodies
    gears = pair.gears
    helix = math.tan(abs(gears[0].beta_b)) if helix is None else helix
    row = layout.pair_mesh(body_1.name, body_2.name, pair, helix=helix)
    frequency, springs = abs(speed) * gears[0].z / (2 * math.pi), []
    for body, k in zip(bodies, torsion, strict=True):
        springs += layout.springs(body.name, None, support, zeta) + layout.springs(body.name, None, {"theta": k}, zeta)
    gear_mesh = GearMesh("mesh", row, stiffness, frequency, teeth=(gears[0].z, gears[1].z), damage=damage, **mesh)
    ratio = row[layout.place[f"{body_2.name}.theta"]] / (1e-3 * gears[0].r_b)
    loads = (
        Load("drive", layout.unit(body_1.name, "theta"), torque),
        Load("load", ratio * layout.unit(body_2.name, "theta"), torque),
    )
    returns = {body.name: frequency / gear.z for body, gear in zip(bodies, gears, strict=True)}
    notes = {"mesh frequency [Hz]": frequency, "turning frequencies [Hz]": tuple(returns.values())}
    stage = Stage("pair", (body_1.name,), (body_2.name,), frequency, frequency / gears[0].z, returns=returns)
    return Machine(layout.dofs, layout.mass, tuple(springs), (gear_mesh,), loads, notes, (stage,))

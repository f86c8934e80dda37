"""Back flanks with their own stiffness, modelled as a second mesh that acts when the backlash is closed.

The back flanks of symmetrical teeth are the mirror images of the front flanks. Their contact moves from tip to root of the
pinion, that of the front flanks from root to tip. The stiffness of the back flanks is therefore that of the front flanks in
reverse, from another phase (`back_phase`). Damage of the front half of a tooth does not affect its back half.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

from ...geometry.pair.gear_pair import GearPair
from .gear_mesh import GearMesh
from .mesh_curves import Stiffness, cycle_table
from .tables import Machine
from .tooth_damage import ToothDamage


@dataclass(frozen=True, slots=True)
class BackFlanks:
    """The back flanks of a mesh.

    Attributes
    ----------
    start : float
        Phase of the mesh at which the phase of its back flanks is 0, see `back_phase`.
    stiffness : float, ndarray, StiffnessCurve, ForceLaw or Table, optional
        Stiffness of the back flanks over their mesh cycle, as if they drove. Default: that of the front flanks, which is valid
        for symmetrical teeth.
    damage : tuple of ToothDamage
        Damaged teeth with their curves for load on the back flanks, numbered as those of the mesh.
    """

    start: float
    stiffness: Stiffness | None = None
    damage: tuple[ToothDamage, ...] = ()

    def __post_init__(self) -> None:
        """Raise ValueError unless the stiffness is finite and not negative."""
        if self.stiffness is not None:
            cycle_table(self.stiffness)


def back_phase(pair: GearPair) -> float:
    """Return the phase of a mesh at which the phase of the back flanks is 0.

    On the pitch circle, front and back flank of a pinion tooth are apart by the tooth thickness s. With the pitch p and the
    phase c of the pitch point, ``start = 2 c + s / p``. Backlash is neglected. It would change the phase by half of the ratio
    of backlash to base pitch.

    Raises
    ------
    ValueError
        If the teeth are helical.

    Examples
    --------
    Two equal standard gears: the thickness is half a pitch.

    >>> import math, gearfe as gf
    >>> gear = gf.Gear(z=25, m_n=2.0, alpha_n=math.radians(20), b=20.0, r_bore=10.0)
    >>> pair = gf.GearPair(gear, gear)
    >>> round(back_phase(pair) - 2 * pair.pitch_phase, 6)
    0.5
    """
    if pair.eps_beta:
        raise ValueError(
            "back_phase is available for spur pairs only: on helical teeth, contact of front and back flanks "
            "starts at different ends"
        )
    part = pair.gear_1.half_thickness(pair.pitch_radius_1) * pair.gear_1.z / math.pi
    return float(2 * pair.pitch_phase + part)


def with_back_flanks(machine: Machine, back: Mapping[str, BackFlanks]) -> Machine:
    """Return the machine with separate back flanks in the named meshes. The second mesh is called ``NAME back``.

    Each of the two meshes has front flanks only. The second has the backlash as its gap, and the errors of the first: an error
    that opens the front flanks closes the back flanks. Call `with_errors` first. The damping of a `film` between the flanks
    remains a single damper.

    Parameters
    ----------
    machine : Machine
    back : dict of str to BackFlanks
        By the mesh's name.

    Raises
    ------
    ValueError
        If there is no such mesh, it has no back flanks (`backlash` 0 or inf), it has friction, or its teeth are off their places.

    Examples
    --------
    >>> import gearfe as gf
    >>> made = gf.single_mesh(1.0, 1e8, 500.0, force=1000.0, backlash=1e-4)
    >>> made = gf.with_back_flanks(made, {"mesh": gf.BackFlanks(0.5, stiffness=0.9e8)})
    >>> [mesh.name for mesh in made.meshes]
    ['mesh', 'mesh back']
    """
    known = {mesh.name: mesh for mesh in machine.meshes}
    for name in back:
        if name not in known:
            raise ValueError(f"no mesh {name!r}; there are {', '.join(known)}")
        if not 0 < known[name].backlash < math.inf:
            raise ValueError(f"mesh {name}: backlash = {known[name].backlash} m, but back flanks require a finite backlash > 0")
        if known[name].friction:
            raise ValueError(f"mesh {name}: separate back flanks are frictionless, but this mesh has friction")
        if known[name].shifts:
            raise ValueError(
                f"mesh {name}: it has pitch deviations or an eccentricity, which separate back flanks neglect: leave out the "
                "back flanks or these deviations"
            )
    damping = dict(zip(known, machine.law["damping"], strict=True))
    front = tuple(
        replace(mesh, backlash=math.inf, zeta=0.0, damping=float(damping[mesh.name])) if mesh.name in back else mesh
        for mesh in machine.meshes
    )
    behind = tuple(_behind(known[name], own, float(damping[name])) for name, own in back.items())
    return replace(machine, meshes=(*front, *behind))


def _behind(mesh: GearMesh, own: BackFlanks, damping: float) -> GearMesh:
    """Return the back flanks of a mesh as a separate mesh. Time, tooth order and errors are reversed."""
    rest = 1.0 if mesh.push else 1 - mesh.film  # The oil film damping remains when the drive flanks are open.
    return replace(
        mesh,
        name=f"{mesh.name} back",
        row=-mesh.row,
        stiffness=mesh.stiffness if own.stiffness is None else own.stiffness,
        frequency=-mesh.frequency,
        phase=own.start - mesh.phase,
        first=(-mesh.first[0], -mesh.first[1] - 1),
        damage=tuple(replace(hurt, tooth=-hurt.tooth) for hurt in own.damage),
        error=tuple((-size, hertz, angle) for size, hertz, angle in mesh.error),
        gap=mesh.backlash,
        damping=rest * damping,
        damping_per_stiffness=rest * mesh.damping_per_stiffness,
        zeta=0.0,
        film=0.0,
        backlash=math.inf,
    )

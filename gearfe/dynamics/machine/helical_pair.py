"""The helical pair on elastic shafts, with 8 degrees of freedom: linear contact, or the impact law with pitted pinion teeth."""

import math
from collections.abc import Callable, Mapping, Sequence

from numpy.typing import NDArray

from ...core.material import Material
from ...geometry.pair.gear_pair import GearPair
from .contact_cycle import line_cycle
from .contact_law import hertz_coefficient
from .gear_pair import gear_pair_machine
from .layout import Body
from .member import gear_member
from .scene_curves import Meshed, scene_machine
from .tables import Machine
from .tooth_damage import ToothDamage

BODIES = ("pinion", "wheel")
DENSITY = 7850.0  # density [kg/m3]
BEARING = {"x": 1e8, "y": 1e8, "z": 1e8}  # assumed bearing stiffness [N/m]
SHAFT = 1e4  # assumed torsional stiffness of the motor shaft [N m/rad]


def scene_pair(scene, case, **options):
    """Build the machine of a scene with linear contact, with the stiffness curves of its pair."""
    name, pair = next(iter(scene.pairs)), scene.pair().pair

    def build(healthy, damage, **drive):
        ends = {"support": BEARING, "torsion": (SHAFT, 0.0), "damage": damage["mesh"]}
        return gear_pair_machine(pair, _bodies(pair, DENSITY), healthy[name], **ends, **drive)

    return scene_machine(scene, case, options, {"mesh": Meshed(name, BODIES)}, {name: BODIES}, build)


def _bodies(pair, density):
    discs = {name: gear_member(gear, density, 0.0) for name, gear in zip(BODIES, pair.gears, strict=True)}
    return [Body(name, member.mass, member.inertia, "x y z theta") for name, member in discs.items()]


def pitted_helical(
    pair: GearPair,
    materials: tuple[Material, Material],
    *,
    pits: Sequence[tuple[int, Callable[[NDArray], NDArray]]] = (),
    speed: float = 2500 * math.pi / 30,
    torque: float = 250.0,
    damping: float = 1e3,
    depth: float = 1e-4,
    support: Mapping[str, float] | None = None,
    drive: float = 1e4,
    density: float = 7840.0,
    zeta: float = 0.02,
    backlash: float = 1e-4,
) -> Machine:
    """Build the helical pair with pitted pinion teeth: impact law, load shared by the lengths of the contact lines.

    It has 8 degrees of freedom: x, y, z and theta of both gears.

    Parameters
    ----------
    pair : GearPair
        The article has 17/60, m_n 2.1 mm, 17.5 and 29 degrees, widths 19.8 and 16.9 mm.
    materials : (Material, Material)
        Materials of both gears, for the coefficient of the impact law at the pitch point.
    pits : sequence of (int, function)
        Pinion teeth, and the length of the contact line that their pits remove [mm] as a function of the phase
        (`gearfe.dynamics.machine.impact.pits_loss`). The article does not state the positions of pits.
    speed, torque : float
        Speed [rad/s] and torque [N m] of the pinion: 2500 rpm; that 250 N m act on the pinion is assumed.
    damping, depth : float
        Largest damping of the impact law [N s/m], assumed 1e3, and the penetration from which it is full [m], 0.1 mm.
    support : dict, optional
        Bearings of both gears by direction, assumed 1e8 N/m in x, y and z.
    drive : float
        Torsional stiffness of the shafts to motor and brake [N m/rad], assumed 1e4 at the pinion, none at the wheel.
    density, zeta, backlash : float
        Density [kg/m3]; damping ratio of supports, assumed 0.02; backlash along the line of action [m], assumed 0.1 mm.

    Returns
    -------
    Machine
        Machine of `gear_pair_machine` with bodies ``pinion`` and ``wheel``, in SI units and a frame at rest.

    Raises
    ------
    ValueError
        If the gears are spur gears, `density` or `backlash` is not positive, `damping`, `depth`
        or `zeta` is negative or not finite, or `speed` or `torque` is not finite.
    """
    if not pair.gear_1.beta:
        raise ValueError("the impact law of a helical pair needs a helix angle, but beta = 0: use contact = 'linear'")
    width = pair.b_w
    radii = pair.curvature_radii(pair.pitch_phase)
    helix = math.cos(pair.gear_1.beta_b)  # The helix angle converts radii of curvature to the plane across the contact line.
    coefficient = hertz_coefficient(float(radii[0]) / helix, float(radii[1]) / helix, materials) / helix**2.5
    damage = tuple(ToothDamage(0, tooth, line_cycle(pair, coefficient, lost=lost, width=width)) for tooth, lost in pits)
    return gear_pair_machine(
        pair,
        _bodies(pair, density),
        line_cycle(pair, coefficient, width=width),
        speed=speed,
        torque=torque,
        support=BEARING if support is None else support,
        torsion=(drive, 0.0),
        zeta=zeta,
        damage=damage,
        power=1.5,
        push=True,
        damping=damping,
        depth=depth,
        backlash=backlash,
    )

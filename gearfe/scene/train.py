"""Gearbox: shafts and their connections, with speeds, torques and mesh forces.

Angles, speeds and torques are counter-clockwise about the common direction z of all shafts, seen against z.
"""

import math
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from ..core.material import Material
from ..core.supports.beam import ShaftPiece
from ..geometry.tooth.gear import Gear
from .power_flow import Link

Row = dict[str, Any]


class TrainStage(NamedTuple):
    """Planetary stage of a gearbox with a fixed ring.

    `gears` are sun, planet and ring, `pairs` those of sun and planet, and of planet and ring. The `carrier` is at `at` [mm] of
    its shaft; its `mass` [kg] and `inertia` [kg m2] are without planets (None: not given). `bearing` is the row of the planets'
    bearings. `pin`, `pin_axial` [N/m] and `pin_tilt` [N m/rad] are the stiffnesses of the pin of a planet (None: not given).
    """

    gears: tuple[str, str, str]
    pairs: tuple[str, str]
    n_planets: int
    carrier: str
    at: float
    inertia: float | None
    bearing: Row | None
    mass: float | None = None
    pin: float | None = None
    pin_axial: float | None = None
    pin_tilt: float | None = None


@dataclass(frozen=True, slots=True)
class TrainShaft:
    """A shaft of a gearbox.

    Attributes
    ----------
    sections : tuple of Section
        [mm]
    material : Material
    gears, turned : dict of str to float
        Position of each gear [mm], and angle of its tooth 0 on the shaft [rad].
    bearings : tuple of float
        Positions [mm].
    radial, axial, damping : tuple of float
        By bearing [N/m], [N/m], [N s/m]; empty: not given.
    kinds : dict of str to dict
        Rows of the tables ``[bearing.NAME]`` of its bearings.
    """

    sections: tuple[ShaftPiece, ...]
    material: Material
    gears: dict[str, float]
    turned: dict[str, float]
    bearings: tuple[float, ...] = ()
    radial: tuple[float, ...] = ()
    axial: tuple[float, ...] = ()
    damping: tuple[float, ...] = ()
    kinds: dict[str, Row] = field(default_factory=dict)

    @property
    def length(self) -> float:
        """Length [mm]."""
        return sum(section.length for section in self.sections)


@dataclass(frozen=True, slots=True)
class Train:
    """Gearbox: shafts and their connections, with speeds, torques and static mesh forces.

    Attributes
    ----------
    shafts : dict of str to TrainShaft
    ends : dict of str to dict
        Checked rows of the motor, ``"motor"``, and of the loads by name.
    couplings : dict of str to dict
        Checked rows.
    stages : dict of str to TrainStage
    pairs : dict of str to tuple
        By pair between shafts ``(gear_1, gear_2, direction [rad])``.
    homes : dict of str to str
        Shaft of each gear.
    links : tuple of Link
        Pairs, couplings and stages (sun to carrier), in the order of their distance from the motor.
    speeds : dict of str to float
        Of each shaft [rad/s].
    torques : dict of str to float
        By link, on its second shaft; by motor and load, on their shaft [N m].
    forces : dict of str to float
        By pair, along the transverse line of action [N].
    """

    shafts: dict[str, TrainShaft]
    ends: dict[str, Row]
    couplings: dict[str, Row]
    stages: dict[str, TrainStage]
    pairs: dict[str, tuple[str, str, float]]
    homes: dict[str, str]
    links: tuple[Link, ...]
    speeds: dict[str, float]
    torques: dict[str, float] = field(default_factory=dict)
    forces: dict[str, float] = field(default_factory=dict)

    def balance(self) -> dict[str, float]:
        """Sum of all torques on each shaft [N m]."""
        out = dict.fromkeys(self.shafts, 0.0)
        for name, end in self.ends.items():
            out[end["shaft"]] += self.torques[name]
        for link in self.links:
            out[link.two] += self.torques[link.name]
            out[link.one] -= link.ratio * self.torques[link.name]
        return out


def thrusts_of(train: Train, gears: dict[str, Gear]) -> dict[str, float]:
    """Axial force on each gear of a shaft [N], along z.

    A positive helix angle is a right-hand helix (ISO 21771): a driver of it that rotates counter-clockwise is pushed along z.
    """
    out: dict[str, float] = {}
    for link in train.links:
        if link.name in train.pairs:
            one, two, _ = train.pairs[link.name]
            push = math.copysign(train.forces[link.name] * math.tan(gears[one].beta_b), train.speeds[link.one] * gears[one].beta)
            out[one], out[two] = out.get(one, 0.0) + push, out.get(two, 0.0) - push
        elif link.name in train.stages:
            stage = train.stages[link.name]
            force = stage.n_planets * train.forces[stage.pairs[0]] * math.tan(gears[stage.gears[0]].beta_b)
            out[stage.gears[0]] = out.get(stage.gears[0], 0.0) + math.copysign(1.0, train.torques[link.name]) * force
    return out

"""Checks of `gearfe check`. Every case, set and machine of a scene is built, but nothing is solved."""

from ..dynamics.machine.of_scene import flat_machine
from ..geometry.damage.hollow import check_hollows
from ..planetary_sets.of_scene import build_set
from ..scene.load import Scene
from ..scene.reading import located
from ..stiffness.solve import Solve
from .simulated import channel_unit


def check_scene(scene: Scene) -> list[str]:
    """Build every case, set and machine of a scene.

    Returns
    -------
    list of str
        Cases of damage that the machine or the set of the scene neglects, with the reason.

    Raises
    ------
    ValueError
        If another verb refuses a case of a pair, or the healthy machine or set.
    """
    for name, pair in scene.pairs.items():
        for case in (None, *pair.damage):
            with located(f"{scene.name}.toml", f"pair.{name}, {case or 'healthy'}"):
                built = pair.case(case)
                Solve().chosen(built)[0].refuses(built, Solve())
                for gear, hollows in zip(pair.pair.gears, built.pits, strict=True):
                    check_hollows(gear, hollows)
    for name in scene.sensors if scene.machine else ():
        with located(f"{scene.name}.toml", f"sensor.{name}"):
            channel_unit(flat_machine(scene), f"sensor {name}")
    out = []
    for noun, there, build in (("machine", scene.machine, flat_machine), ("set", scene.set, build_set)):
        for case in (None, *scene.cases) if there else ():
            try:
                build(scene, case)
            except ValueError as error:
                if case is None:
                    raise
                out.append(f"case {case} is not in the {noun}: {error}")
    return out

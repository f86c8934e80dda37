"""Engagement frequencies of the damaged teeth of a pair, if the scene has a machine and thus a speed."""

from ..geometry.damage.kinds import told
from ..scene.load import Scene
from ..stiffness.deviating_teeth import NAMES as SIDES


def returns_of(scene: Scene, pair: str, case: str | None) -> dict[tuple[str, int], str]:
    """Fault frequency and body of each damaged tooth as text, by pinion or wheel and its number.

    The result is empty without a machine.

    Examples
    --------
    >>> import gearfe as gf
    >>> returns_of(gf.load_scene("compound_planetary"), "sun_planet", "crack30")
    {('pinion', 0): '18.2 Hz, sun2'}
    """
    found = scene.pairs[pair]
    out: dict[tuple[str, int], str] = {}
    if case not in found.damage:
        return {}
    from ..dynamics.machine.of_scene import damaged_teeth  # imported here, because only damaged teeth need it and it takes 0.1 s

    faults = damaged_teeth(scene, case)
    for side, gear in zip(SIDES, found.pair.gears, strict=True):
        hurt = found.damage[case].get(side, ()) if faults else ()
        for tooth in dict.fromkeys(one.tooth for one in hurt):
            what = told({side: gear}, {side: [one for one in hurt if one.tooth == tooth]})
            alike = (one for one in faults if (one.tooth - tooth) % gear.z == 0 and one.what == what)
            for one in list(alike)[:1]:
                out[side, tooth] = f"{one.frequency:.3g} Hz, {one.gear}"
    return out

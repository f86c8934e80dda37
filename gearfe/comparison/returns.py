"""How often the damaged teeth of a scene's pair mesh, where the scene has a machine and so a speed."""

from ..geometry.damage.kinds import told
from ..scene.load import Scene
from ..stiffness.deviating_teeth import NAMES as SIDES


def returns_of(scene: Scene, pair: str, case: str | None) -> dict[int, str]:
    """Fault frequency and body of each damaged tooth as text, by the number of its tooth pair.

    The result is empty without a machine.

    Examples
    --------
    >>> import gearfe as gf
    >>> returns_of(gf.load_scene("compound_planetary"), "sun_planet", "crack30")
    {0: '18.2 Hz, sun2'}
    """
    found = scene.pairs[pair]
    out: dict[int, list[str]] = {}
    if case not in found.damage:
        return {}
    from ..dynamics.machine.of_scene import damaged_teeth  # imported here, because only damaged teeth need it and it takes 0.1 s

    faults = damaged_teeth(scene, case)
    for side, gear in zip(SIDES, found.pair.gears, strict=True):
        hurt = found.damage[case].get(side, ()) if faults else ()
        for tooth in dict.fromkeys(one.tooth for one in hurt):
            what = told({side: gear}, {side: [one for one in hurt if one.tooth == tooth]})
            alike = (one for one in faults if (one.tooth - tooth) % gear.z == 0 and one.what == what)
            out.setdefault(tooth, []).extend(f"{one.frequency:.3g} Hz, {one.gear}" for one in list(alike)[:1])
    return {tooth: "; ".join(words) for tooth, words in out.items() if words}

"""Planetary set of a scene, from the tables ``[set]``, ``[ring.support]`` and ``[pin.NAME]``."""

from itertools import chain
from typing import Any

from ..scene.load import Scene
from ..scene.reading import located
from ..scene.scene_pair import ScenePair
from ..scene.schema import arguments
from ..scene.set_table import SceneSet
from .case import KINDS, PlanetaryCase, planet_name
from .faults import turned
from .rim_supports import RimBed, RimSupports


def build_set(scene: Scene, case: str | None = None) -> PlanetaryCase:
    """Return the planetary set of a scene for `gearfe.planetary_stiffness`, with its flanks and a case of damage.

    Damage of the planet's gear is in the planet of its ``body``, by default the first, on the flank that the sun loads.
    Damage that the scene states in the pair of planet and ring only is on the other flank.

    Parameters
    ----------
    scene : Scene
        With a ``[set]`` table.
    case : str, optional
        Case of damage; None: healthy.

    Returns
    -------
    PlanetaryCase

    Raises
    ------
    ValueError
        If the scene has no set, no such case in its gears, pits or spalls, pairs whose misalignment, shafts or springs
        are not modelled in a set, or if the set is impossible.
    """
    given = scene.set
    if given is None:
        raise ValueError(f"scene {scene.name} has no [set] table: add one with n_planets or planet_angles_deg")
    if why := unlike_set(scene, given):
        raise ValueError(f"{scene.name} [set]: {why}")
    outer, inner = (scene.pairs[name] for name in given.pairs)
    file = f"{scene.name}.toml"
    with located(file, "ring.support"):
        ring = _support(given.support)
    flanks, damage = _flanks(given, outer, inner), _damage(scene, case, given, outer, inner)
    materials = (*outer.materials, inner.materials[1])
    with located(file, "set"):
        return PlanetaryCase(
            given.gears, given.force, materials, planet_angles=given.planet_angles, ring=ring,
            floating=given.floating, pin=given.pin,
            errors=given.errors, flanks=flanks, damage=damage,
        )  # fmt: skip


def unlike_set(scene: Scene, given: SceneSet) -> str:
    """Return the reason why a set cannot model the pairs of a scene, although isolated pairs can, or an empty text."""
    pairs = {name: scene.pairs[name] for name in given.pairs}
    for name, pair in pairs.items():
        if pair.supports or pair.misalignment:
            return (
                f"pair {name!r} has shafts, springs or misalignment, which a set does not support: its gears are held by "
                "pin_N_per_um, floating and [ring.support]; leave those out"
            )
        if pair.pair.gear_1.beta:
            return f"the gears of pair {name!r} are helical, but the section of a set models spur gears only: give beta_deg = 0"
        if any(flank.wide for flank in pair.flanks.values()):
            return f"flanks of pair {name!r} change along the width, but a set is a section: leave those keys out"
    outer, inner = pairs.values()
    of_sun, of_ring = ((one.flanks.get(side), one.owned_flanks.get(side)) for one, side in ((outer, "wheel"), (inner, "pinion")))
    if of_sun != of_ring:
        return (
            "the planet has another flank with the sun than with the ring, but a set gives it the same: give it one "
            "[flank.NAME] table without pair"
        )
    return ""


def _support(row: dict[str, Any]) -> "str | RimBed | RimSupports":
    """Return the support of the ring from a checked table ``[ring.support]``."""
    if row["kind"] == "held":
        return "held"
    given = arguments("ring_support", row | {"kind": None})
    if row["kind"] == "bed":
        return RimBed(**given)
    pushes = row["kind"] == "lugs"
    return RimSupports(**given | {"radial": 0.0} if pushes else given, pushes=pushes)


def _flanks(given: SceneSet, outer: ScenePair, inner: ScenePair) -> dict[str, Any]:
    """Return flanks by gear. A planet has the same flanks on both sides of its teeth."""
    places = {"sun": (outer, "pinion"), "planet": (outer, "wheel"), "ring": (inner, "wheel")}
    out = {}
    for gear, (pair, side) in places.items():
        plain = {None: pair.flanks[side]} if side in pair.flanks else {}
        for body, flank in pair.owned_flanks.get(side, plain).items():
            out[gear if body is None else _gear_name(body, gear, "[flank]", given)] = flank
    return out


def _damage(scene: Scene, case: str | None, given: SceneSet, outer: ScenePair, inner: ScenePair) -> dict[Any, Any]:
    """Return cracks, missing teeth and chips of a case by gear."""
    if case is None:
        return {}
    known = dict.fromkeys((*outer.damage, *inner.damage))
    if case not in known:
        raise ValueError(f"no case {case!r} in the set of scene {scene.name}; it has {', '.join(known) or 'none'}")
    one, two = outer.owned.get(case, {}), inner.owned.get(case, {})
    hurt = [own for found in (*one.values(), *two.values()) for own in chain(*found.values())]
    other = sorted({own._nouns[0] for own in hurt if not isinstance(own, KINDS)})
    if other:
        raise ValueError(
            f"case {case!r} has a {' and a '.join(other)}, but the section of a set has no pits or spalls: choose another case"
        )
    out: dict[Any, Any] = {}
    for found, side, gear, mirrored in (
        (one, "pinion", "sun", False),
        (one, "wheel", "planet", False),
        (two, "pinion", "planet", True),
        (two, "wheel", "ring", False),
    ):
        for owner, damage in found.get(side, {}).items():
            own = out.setdefault(_gear_name(owner.body, gear, case, given), [])
            seen = [turned(one, one.tooth) if mirrored else one for one in damage]
            own += [one for one in seen if one not in own]
    return out


def _gear_name(body, gear, case, given):
    """Return the name of a gear in the set. A planet without a stated body is the first planet."""
    known = [planet_name(i) for i in range(len(given.errors))] if gear == "planet" else [gear]
    if body is not None and body not in known:
        what = f"{case} body = {body!r}" if case == "[flank]" else f"case {case!r} damages body {body!r}"
        raise ValueError(f"{what}, but the {gear} of the set is {', '.join(known)}")
    return known[0] if body is None else body

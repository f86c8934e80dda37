"""All types of damage and their common functions. A new type requires a class and an entry in `Damage`.

Damage has one of two effects (`split`). A crack weakens the gear body. Pits and spalls remove contact, and also a little
material, which plain sums and meshes with holes contain. Missing teeth and chipped tips (`BROKEN`) have both effects and are in
neither part. Each kind has `tooth`, `through` (equal in every transverse section), `_removes_contact`, `_nouns` (singular,
plural), `_adjective` (of its tooth: cracked), ``outline(gear)`` (a line that shows it in the section), ``_description(gear)``
and ``_warning(gear)`` (empty if there is none). `hollow` states the attributes of pits and spalls.
"""

from collections.abc import Iterable, Mapping, Sequence
from types import UnionType
from typing import Any, get_args

from ..checks import by_gear
from ..tooth.gear import Gear
from .chip import Chip
from .crack import Crack, check_apart
from .missing import MissingTooth
from .pit import Pit
from .spall import Spall

Damage = Crack | Pit | Spall | MissingTooth | Chip
BROKEN = (MissingTooth, Chip)
NAMES = [kind.__name__ for kind in get_args(Damage)]


def are(given: object, kind: type | UnionType = Damage) -> bool:
    """Return whether the argument is a list or tuple of damage, or of one `kind` of damage."""
    return isinstance(given, (list, tuple)) and all(isinstance(defect, kind) for defect in given)


def check_crack(crack: object) -> None:
    """Raise ValueError unless it is a `Crack`."""
    if not are((crack,), Crack):
        raise ValueError(f"crack = {crack!r}, but give a Crack")


def by_side(damage: Mapping[str, Damage | Sequence[Damage] | None] | None) -> tuple[list[Damage], list[Damage]]:
    """Return the damage of pinion and wheel. Each may be a single damage, a list, a tuple or missing.

    ValueError if it is not given by gear, or something is no damage.
    """
    pinion, wheel = by_gear("damage", damage, "{'pinion': [Crack(...), Pit(...)], 'wheel': [...]}")
    return _listed(pinion, "pinion"), _listed(wheel, "wheel")


def _listed(damage, side):
    if isinstance(damage, Damage):
        return [damage]
    if damage and not isinstance(damage, (list, tuple)):
        raise ValueError(f"damage of the {side}: {damage!r}, but give a {', a '.join(NAMES)} or a list of them")
    for defect in damage or ():
        if not isinstance(defect, Damage):
            raise ValueError(f"damage of the {side}: {defect!r} is neither a {' nor a '.join(NAMES)}")
    return list(damage or ())


def parts_of(gear: Gear, damage: Iterable[Damage]) -> list[Damage]:
    """Return damage in which chips over a part of the width are replaced by recesses (`Chip.recesses`)."""
    return [part for one in damage for part in (one.recesses(gear) if isinstance(one, Chip) else (one,))]


def split(damage: Iterable[Damage]) -> tuple[tuple[Any, ...], tuple[Any, ...]]:
    """Split damage into two tuples: damage that weakens the body, and damage that removes contact."""
    damage = tuple(damage)
    weakens, removes = (tuple(defect for defect in damage if defect._removes_contact is removing) for removing in (False, True))
    return weakens, removes


def check_damage(gear: Gear, defects: Iterable[Damage]) -> None:
    """Raise ValueError for cracks and broken teeth that do not fit the gear, or that meet. See `check_hollows` for pits."""
    parts = parts_of(gear, defects)
    check_apart(gear, split(parts)[0])
    check_broken(gear, parts)


def check_broken(gear, defects):
    """Raise ValueError for further damage of a broken tooth, invalid chips, and two adjacent missing teeth."""
    broken = [defect for defect in defects if isinstance(defect, BROKEN)]
    gone = sorted({one.tooth % gear.z for one in broken if isinstance(one, MissingTooth)})
    for one in broken:
        if isinstance(one, Chip):
            one.outline(gear)
        for defect in defects:
            if defect != one and (defect.tooth - one.tooth) % gear.z == 0:
                said = "is missing" if isinstance(one, MissingTooth) else "has a chip"
                raise ValueError(f"tooth {one.tooth} of z = {gear.z} {said} and has a {defect._nouns[0]}: give one of them")
    for tooth in gone:
        if (tooth + 1) % gear.z in gone:
            raise ValueError(
                f"teeth {tooth} and {tooth + 1} of z = {gear.z} are missing: only one of two adjacent teeth may be missing"
            )


def told(gears: Mapping[str, Gear], damage: Mapping[str, Iterable[Damage]]) -> str:
    """Describe the damage of gears: the size of a single damage of a type, the number of several."""
    by_noun: dict[str, list[str]] = {}
    for side, gear_damage in damage.items():
        for defect in gear_damage:
            by_noun.setdefault(defect._nouns[1], []).append(defect._description(gears[side]))
    order = [kind._nouns[1] for kind in get_args(Damage) if kind._nouns[1] in by_noun]
    *others, last = [by_noun[noun][0] if len(by_noun[noun]) == 1 else f"{len(by_noun[noun])} {noun}" for noun in order] or [""]
    return f"{', '.join(others)} and {last}" if others else last


def called(damage: Iterable[Damage]) -> str:
    """Return the adjective of a tooth: cracked, pitted, spalled, or damaged for several types."""
    names = {defect._adjective for defect in damage}
    return names.pop() if len(names) == 1 else "damaged"


def why_wide(damage: Sequence[Damage]) -> str:
    """Describe the damage that changes along the width and is not modelled in a transverse section.

    The result is empty if none does.
    """
    nouns = {defect._nouns[1] for defect in damage if not defect.through}
    return next((f"{kind._nouns[1]} change along the width" for kind in get_args(Damage) if kind._nouns[1] in nouns), "")

"""Tables ``[set]``, ``[ring.support]`` and ``[pin.NAME]`` of a scene: a whole planetary set of its gears.

``[set]``

- ``n_planets``: equally spaced; or ``angles_deg``: where the planets stand, clockwise.
- ``sun, planet, ring``: names of its gears; left out where only one set can be made of the scene's pairs.
- ``force_N``: mean force of a mesh along the line of action; or ``torque_Nm`` of the sun. Neither: that of the pair of sun and
  planet.
- ``floating``: whether the sun's axis may move. ``pin_N_per_um``: radial stiffness of each planet's pin and bearing together;
  default rigid.
- ``damaged_planet``: which planet has the damage of the planet's gear.

``[ring.support]``, what holds the ring's rim; without the table it is held all around

- ``kind``: ``"held"``, ``"bed"``, ``"pads"`` or ``"lugs"``, which only push; its other keys are those of `KINDS`.

``[pin.NAME]``: how far the pin of a ``planet`` stands off its place, outwards and clockwise.
"""

import math
from dataclasses import dataclass
from typing import Any

from ..geometry.pair.planetary import PlanetarySet
from .strict import NUMBER, NUMBERS, REQUIRED, TEXT, TRUTH, WHOLE, checked, known, named_tables, placed, shown

SET = {
    "n_planets": (WHOLE, None),
    "angles_deg": (NUMBERS, None),
    "sun": (TEXT, None),
    "planet": (TEXT, None),
    "ring": (TEXT, None),
    "force_N": (NUMBER, None),
    "torque_Nm": (NUMBER, None),
    "floating": (TRUTH, False),
    "pin_N_per_um": (NUMBER, None),
    "damaged_planet": (WHOLE, 0),
}
SUPPORT = {
    "kind": (TEXT, REQUIRED),
    "count": (WHOLE, None),
    "width_mm": (NUMBER, None),
    "first_deg": (NUMBER, None),
    "radial_N_per_um": (NUMBER, None),
    "tangential_N_per_um": (NUMBER, None),
    "radial_MPa_per_mm": (NUMBER, None),
    "tangential_MPa_per_mm": (NUMBER, None),
}
PIN = {"planet": (WHOLE, REQUIRED), "radial_um": (NUMBER, 0.0), "tangential_um": (NUMBER, 0.0)}
KINDS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {  # of supports: keys that must be given, keys that may be
    "held": ((), ()),
    "bed": (("radial_MPa_per_mm", "tangential_MPa_per_mm"), ()),
    "pads": (("count", "width_mm"), ("first_deg", "radial_N_per_um", "tangential_N_per_um")),
    "lugs": (("count", "width_mm"), ("first_deg", "tangential_N_per_um")),
}
NAMES = ("set", "ring", "pin")


@dataclass(frozen=True, slots=True)
class SceneSet:
    """A planetary set of a scene: `pairs` names those of sun and planet, and of planet and ring.

    `force` is the mean of a mesh along the line of action [N], `angles` where planets stand [rad] (None: equally spaced), `pin`
    the stiffness of each pin [N/mm], `errors` by planet how far its pin stands off, outwards and clockwise [mm], `support` the
    checked table ``[ring.support]``.
    """

    gears: PlanetarySet
    pairs: tuple[str, str]
    force: float
    angles: tuple[float, ...] | None
    floating: bool
    pin: float
    errors: tuple[tuple[float, float], ...]
    damaged_planet: int
    support: dict[str, Any]


def checked_set(file: str, tables: dict[str, Any]) -> dict[str, Any]:
    """Checked tables by name, as the scene has them; empty without ``[set]``.

    ValueError, with the place, if a table is not as its keys say, or there is one of a set but no ``[set]``.
    """
    if "set" not in tables:
        for name in tables:
            raise ValueError(f"{file}: [{name}] belongs to a planetary set: add a table [set] with n_planets or angles_deg")
        return {}
    ring, pins = tables.get("ring", {}), tables.get("pin", {})
    if not isinstance(ring, dict) or set(ring) - {"support"}:
        raise ValueError(f"{file} [ring] = {shown(ring)}: what holds the ring of a set stands in [ring.support]")
    named_tables(file, "pin", pins)
    return {
        "set": checked(file, "set", tables["set"], SET),
        "ring": {"support": _support(file, ring.get("support", {"kind": "held"}))},
        "pin": {name: checked(file, f"pin.{name}", one, PIN) for name, one in pins.items()},
    }


def _support(file, table):
    row, where = checked(file, "ring.support", table, SUPPORT), "ring.support"
    known(file, where, "kind", row["kind"], KINDS, "kind of support")
    must, may = KINDS[row["kind"]]
    for key in must:
        if row[key] is None:
            why = ", the stiffness depends on it" if key == "width_mm" else ""
            raise ValueError(f"{file} [{where}]: kind = {row['kind']!r} needs {key}{why}")
    for key in row:
        if row[key] is not None and key not in ("kind", *must, *may):
            expected = ", ".join((*must, *may)) or "no other key"
            raise ValueError(f"{file} [{where}]: kind = {row['kind']!r} has no {key}; expected {expected}")
    return row


def set_of(file: str, tables: dict[str, Any], pairs: dict[str, Any], rows: dict[str, Any]) -> SceneSet | None:
    """`SceneSet` of the `tables` that `checked_set` gives, None of none.

    `pairs` are the scene's, `rows` their checked tables. ValueError, with the place, if the set cannot be.
    """
    if not tables:
        return None
    row = tables["set"]
    names = _pairs(file, row, pairs, rows)
    outer, inner = (pairs[name].pair for name in names)
    angles, n = row["angles_deg"], row["n_planets"]
    if (angles is None) == (n is None) or angles == []:
        raise ValueError(f"{file} [set]: give n_planets, equally spaced, or angles_deg, one of them")
    count = n if angles is None else len(angles)
    gears = placed(file, "set", lambda: PlanetarySet(outer.gear_1, outer.gear_2, inner.gear_2, 1 if n is None else n, outer.a))
    return SceneSet(
        gears,
        names,
        _force(file, row, count * outer.gear_1.r_b, pairs[names[0]].force),
        angles=None if angles is None else tuple(math.radians(one) for one in angles),
        floating=row["floating"],
        pin=math.inf if row["pin_N_per_um"] is None else row["pin_N_per_um"] * 1e3,
        errors=_errors(file, tables["pin"], count),
        damaged_planet=_planet(file, "set", "damaged_planet", row["damaged_planet"], count),
        support=tables["ring"]["support"],
    )


def _pairs(file, row, pairs, rows):
    """Names of the pairs of sun and planet and of planet and ring: those named, or the only ones that make a set."""
    there, found = {one[key]: None for one in rows.values() for key in ("gear_1", "gear_2")}, []
    for key in ("sun", "planet", "ring"):
        if row[key] is not None:
            known(file, "set", key, row[key], there, "gear in a pair")
    for one, outer in rows.items():
        for two, inner in rows.items():
            gears = outer["gear_1"], outer["gear_2"], inner["gear_2"]
            fits = all(row[key] in (None, name) for key, name in zip(("sun", "planet", "ring"), gears, strict=True))
            rings = pairs[two].pair.gear_2.internal and not pairs[one].pair.gear_2.internal
            if fits and rings and inner["gear_1"] == outer["gear_2"]:
                found.append(((one, two), gears))
    if not found:
        raise ValueError(
            f"{file} [set]: no two pairs make it: give one with the sun as gear_1 and the planet as gear_2, and one of that "
            "planet and a ring"
        )
    if len(found) > 1:
        told = "; ".join(", ".join(gears) for _, gears in found)
        raise ValueError(f"{file} [set]: {len(found)} sets are in the pairs of this scene: name sun, planet, ring: {told}")
    return found[0][0]


def _force(file, row, radii, force):
    """Mean force of a mesh [N], `radii` the number of planets times the sun's base radius [mm], `force` that of the pair."""
    if row["force_N"] is not None and row["torque_Nm"] is not None:
        raise ValueError(f"{file} [set]: force_N and torque_Nm say the same twice: give one")
    for key in ("force_N", "torque_Nm", "pin_N_per_um"):
        if row[key] is not None and not row[key] > 0:
            raise ValueError(f"{file} [set] {key} = {row[key]:g}, but give a number > 0, or leave it out")
    if row["torque_Nm"] is not None:
        return 1e3 * row["torque_Nm"] / radii
    return float(force if row["force_N"] is None else row["force_N"])


def _errors(file, pins, count):
    """By planet how far its pin stands off, outwards and clockwise [mm]."""
    out, said = [(0.0, 0.0)] * count, {}
    for name, row in pins.items():
        planet = _planet(file, f"pin.{name}", "planet", row["planet"], count)
        if planet in said:
            raise ValueError(f"{file} [pin.{name}]: the pin of planet {planet} is [pin.{said[planet]}] already; give one of both")
        said[planet] = name
        out[planet] = row["radial_um"] * 1e-3, row["tangential_um"] * 1e-3
    return tuple(out)


def _planet(file, where, key, planet, count):
    if not 0 <= planet < count:
        raise ValueError(f"{file} [{where}] {key} = {planet}, but the set has {count} planets: give 0 to {count - 1}")
    return planet

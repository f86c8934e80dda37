"""Tables ``[set]``, ``[ring.support]`` and ``[pin.NAME]`` of a scene, which describe a planetary set."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..geometry.pair.planetary import PlanetarySet
from .reading import check_known, checked, located
from .schema import arguments


@dataclass(frozen=True, slots=True)
class SceneSet:
    """A planetary set of a scene: `pairs` names those of sun and planet, and of planet and ring.

    `force` is the mean force of a mesh along the line of action [N]. `planet_angles` are the angles of the planets [rad]
    (None: equally spaced). `pin` is the stiffness of each pin [N/mm]. `errors` are the pin position errors by planet, outwards
    and clockwise [mm]. `support` is the checked table ``[ring.support]``.
    """

    gears: PlanetarySet
    pairs: tuple[str, str]
    force: float
    planet_angles: tuple[float, ...] | None
    floating: bool
    pin: float
    errors: tuple[tuple[float, float], ...]
    support: dict[str, Any]


def set_of(file: str, rows: dict[str, Any], pairs: dict[str, Any]) -> SceneSet | None:
    """Return the `SceneSet` of the checked `rows` of a scene, or None without a set. `pairs` are the scene's pairs.

    ValueError, with the place, if the set is impossible, or there is a table of a set but no ``[set]``.
    """
    row = rows["set"]
    if row is None:
        for name in ("ring", "pin"):
            if rows[name]:
                raise ValueError(
                    f"{file}: [{name}] belongs to a planetary set: add a table [set] with n_planets or planet_angles_deg"
                )
        return None
    ring = rows["ring"] or checked("gearfe.scene", "ring", file, "ring", {})
    names = _pairs(file, row, pairs, rows["pair"])
    outer, inner = (pairs[name].pair for name in names)
    angles, n = row["planet_angles_deg"], row["n_planets"]
    if angles == []:
        raise ValueError(f"{file} [set] planet_angles_deg = []: give the angle of each planet, or n_planets")
    count = n if angles is None else len(angles)
    _check_machine(file, rows["machine"], count, angles)
    with located(file, "set", row):
        gears = PlanetarySet(outer.gear_1, outer.gear_2, inner.gear_2, n or 1, outer.a)
    return SceneSet(
        gears,
        names,
        _force(row, count * outer.gear_1.r_b, pairs[names[0]].force),
        floating=row["floating"],
        errors=_errors(file, rows["pin"], count),
        support=ring["support"],
        **{"planet_angles": None, "pin": math.inf} | arguments("set", row, "planet_angles_deg", "pin_N_per_um"),
    )


def _check_machine(file, machine, count, angles):
    """Raise ValueError if a planetary machine has other planets than the set (number or spacing)."""
    if machine is None or machine["model"] not in ("planetary", "herringbone_planetary"):
        return
    apart = np.diff(np.sort(np.mod(angles or (), 360.0)))
    even = angles is None or np.allclose(apart, 360.0 / count, rtol=0, atol=1e-3)
    if machine["n_planets"] != count or not even:
        raise ValueError(
            f"{file} [set]: {count} planets{'' if even else ' at unequal angles'}, but [machine] has n_planets = "
            f"{machine['n_planets']}, equally spaced: give the same planets in both tables"
        )


def _pairs(file, row, pairs, rows):
    """Return the names of the sun-planet pair and planet-ring pair: those in `[set]`, or the only possible two."""
    there, found = {one[key]: None for one in rows.values() for key in ("gear_1", "gear_2")}, []
    for key in ("sun", "planet", "ring"):
        if row[key] is not None:
            check_known(file, "set", key, row[key], there, "gear in a pair")
    for one, outer in rows.items():
        for two, inner in rows.items():
            gears = outer["gear_1"], outer["gear_2"], inner["gear_2"]
            fits = all(row[key] in (None, name) for key, name in zip(("sun", "planet", "ring"), gears, strict=True))
            rings = pairs[two].pair.gear_2.internal and not pairs[one].pair.gear_2.internal
            if fits and rings and inner["gear_1"] == outer["gear_2"]:
                found.append(((one, two), gears))
    if not found:
        raise ValueError(
            f"{file} [set]: two pairs are needed: give one with the sun as gear_1 and the planet as gear_2, and one of that "
            "planet and a ring"
        )
    if len(found) > 1:
        told = "; ".join(", ".join(gears) for _, gears in found)
        raise ValueError(f"{file} [set]: {len(found)} sets are in the pairs of this scene: name sun, planet, ring: {told}")
    return found[0][0]


def _force(row, radii, force):
    """Return the mean force of a mesh [N]: stated for the set, from its torque and base `radii` [mm], or `force` of the pair."""
    if row["torque_Nm"] is not None:
        return 1e3 * row["torque_Nm"] / radii
    return float(force if row["force_N"] is None else row["force_N"])


def _errors(file, pins, count):
    """Return pin position errors by planet, outwards and clockwise [mm]."""
    out, said = dict.fromkeys((f"planet{i + 1}" for i in range(count)), (0.0, 0.0)), {}
    for name, row in pins.items():
        body = row["body"]
        check_known(file, f"pin.{name}", "body", body, out, "planet of the set")
        if body in said:
            raise ValueError(f"{file} [pin.{name}]: the pin of {body} is [pin.{said[body]}] already; give only one of them")
        said[body] = name
        out[body] = tuple(arguments("pin", row, "radial_um", "tangential_um").values())
    return tuple(out.values())

"""`new_scene`: a commented scene file as a starting point for user-defined gears."""

import contextlib
import math
from pathlib import Path
from typing import Any

from ..core.checks import is_number, number
from ..core.files import written
from ..geometry.damage.crack import Crack, path_length
from ..geometry.pair.gear_pair import GearPair
from .load import scene_of
from .parts import DAMAGE
from .template import template

HEAD = """\
# A gear pair of your own. Lengths in mm, forces in N, angles in degrees: the unit is the end of each name.
# Try it:  gearfe check {name}        gearfe compare {name}        gearfe compare {name} --case cracked
# Lines that begin with # and no space are further keys with values that suit the pair: remove the # to use them.
# Lines that begin with # and a space are alternatives: give a value, remove "# " and the key that they replace.

"""
# The addendum is reduced, because a full one may reach into the pinion's fillet.
RING = {"addendum": 0.8, "dedendum": 1.25, "rack_tip_radius": 0.2}
RACK = {"addendum": 1.0, "dedendum": 1.25, "rack_tip_radius": 0.38}


def new_scene(
    path: str | Path,
    *,
    teeth: tuple[int, int] | None = None,
    module: float = 2.0,
    helix_deg: float = 0.0,
    width: float = 20.0,
    ring: bool = False,
    torque_Nm: float | None = None,
    crack: tuple[float, float] | None = None,
    tip_relief_um: float | None = None,
    tip_length_mm: float | None = None,
    x: tuple[float, float] = (0.0, 0.0),
    alpha_deg: float = 20.0,
    bore_mm: tuple[float, float] | None = None,
) -> Path:
    """Write a scene file with comments: a gear pair with a case of damage, ready to run and to be changed.

    All other keys of a scene are included as commented lines (`gearfe.scene.template`).

    Parameters
    ----------
    path : path
        Of the new file, ``.toml``. An existing file is not overwritten.
    teeth : (int, int), optional
        Of pinion and wheel; default 21 and 31, of a ring 21 and 63.
    module : float
        Normal module [mm].
    helix_deg : float
        Helix angle of the pinion [degrees].
    width : float
        Face width [mm].
    ring : bool
        The wheel is an internal gear.
    torque_Nm : float, optional
        On the pinion [N m]; default: that of 100 N along the line of action for each mm of width.
    crack : (float, float), optional
        Length [mm] and angle to the centre-line [degrees] of the pinion's root crack; default: level 0.3 at 45 degrees.
    tip_relief_um, tip_length_mm : float, optional
        Linear tip relief of both gears [um], and the length of roll below the tip over which it runs [mm]: give both.
    x : (float, float)
        Profile shift coefficients of pinion and wheel.
    alpha_deg : float
        Normal pressure angle [degrees].
    bore_mm : (float, float), optional
        Bore diameters of pinion and wheel, of a ring its rim diameter [mm]; default: half of the root diameter, an assumption.

    Returns
    -------
    Path
        Of the file.

    Raises
    ------
    ValueError
        If the file exists or cannot be written, or if such a pair is impossible.
    """
    path = Path(path)
    teeth = teeth or ((21, 63) if ring else (21, 31))
    pairs = {"teeth": teeth, "crack": crack or (1.0, 1.0), "x": x, "bore_mm": bore_mm or (1.0, 1.0)}
    _check_inputs(path, pairs)
    module, helix_deg, width = number("module", module), number("helix_deg", helix_deg), number("width", width)
    torque_Nm = None if torque_Nm is None else number("torque", torque_Nm)
    rack = {"m_n_mm": float(module), "alpha_n_deg": number("alpha_deg", alpha_deg), "b_mm": float(width)}
    pinion, wheel = _gears(rack, teeth, x, helix_deg, ring, bore_mm)
    stated: dict[str, Any] = {
        "title": f"Pair {teeth[0]}/{teeth[1]}, module {module:g} mm", "source": "own gear pair",
        "material": {"steel": {"E_MPa": 206000.0, "nu": 0.3}}, "gear": {"pinion": pinion, "wheel": wheel},
        "pair": {"stage": {"gear_1": "pinion", "gear_2": "wheel", "force_N": 1.0} | ({"face": "helical"} if helix_deg else {})},
    }  # fmt: skip
    pair = scene_of(path.name, stated).pair().pair
    force, told_force = _force(pair.gear_1, width, torque_Nm)
    stated["pair"]["stage"]["force_N"] = force
    if not bore_mm:
        stated["assumption"] = [_assumed(pinion, wheel, "rim" if ring else "bore")]
    size = dict(zip(("length_mm", "angle_deg"), crack, strict=True)) if crack else {"level": 0.3, "angle_deg": 45.0}
    stated["crack"] = [{"case": "cracked", "gear": "pinion", **size}]
    numbers = example_numbers(pair, force)
    amount, length = _relief(tip_relief_um, tip_length_mm, numbers)
    flanks = {side: {"gear": side, "tip_relief_um": amount, "tip_start_length_mm": length} for side in ("pinion", "wheel")}
    stated |= {} if tip_relief_um is None else {"flank": flanks}
    with _of_torque(torque_Nm):
        scene_of(path.name, stated).case(case="cracked")
    asleep: dict[str, Any] = {kind: [{}] for kind in DAMAGE} | {"support": {"output": {}}, "shaft": {"drive": {}}}
    asleep |= ({} if "flank" in stated else {"flank": flanks}) | ({} if ring else {"machine": {}})
    as_length = f"or as a length: length_mm = {path_length(pair.gear_1, Crack(level=0.3)):.2f}"
    text = template(stated, asleep, numbers, {"force_N": told_force, "level": as_length})
    with written(path) as name:
        Path(name).write_text(HEAD.format(name=path.name) + text, encoding="utf-8")
    return path


def _check_inputs(path, pairs):
    if path.suffix != ".toml":
        raise ValueError(f"{path}: a scene is a .toml file; give a name such as my.toml")
    if path.exists():
        raise ValueError(f"{path} exists and is not overwritten: give another name, or remove it")
    if not path.name.isprintable():
        raise ValueError(f"{path.name!r}: give the scene a name of printable characters")
    for name, pair_of in pairs.items():
        if not isinstance(pair_of, (tuple, list)) or len(pair_of) != 2 or not all(map(is_number, pair_of)):
            raise ValueError(f"{name} = {pair_of!r}, but give two numbers")


def _gears(rack, teeth, x, helix_deg, ring, bore_mm):
    """Return the tables of pinion and wheel."""
    module, helix = rack["m_n_mm"], (float(helix_deg), (helix_deg if ring else -helix_deg) + 0.0)
    transverse = module / math.cos(math.radians(helix_deg))  # The root circle of an external gear is 1.25 modules inside.
    held = [("r_bore_mm", round(0.5 * (0.5 * transverse * z - 1.25 * module), 1)) for z in teeth]
    if ring:
        held[1] = "r_rim_mm", round(0.5 * transverse * teeth[1] + 5 * module, 1)
    if bore_mm:
        held = [(name, 0.5 * bore) for (name, _), bore in zip(held, bore_mm, strict=True)]
    return (
        {"z": z, **rack, "x": float(shift), "beta_deg": beta, **form, name: radius, "material": "steel"}
        for z, shift, beta, form, (name, radius) in zip(teeth, x, helix, (RACK, RING if ring else RACK), held, strict=True)
    )


def _relief(amount, length, usual):
    """Return amount [um] and length [mm] of the tip relief."""
    if (amount is None) != (length is None) or (amount or 1.0) < 0:
        raise ValueError(f"tip relief of {amount} um over {length} mm: give both, the amount positive")
    return amount or round(usual["amount"], 1), length or round(usual["length"], 3)


def _assumed(pinion, wheel, held):
    bore, wide = pinion["r_bore_mm"], wheel[f"r_{held}_mm"]
    what = f"bore radius {bore} mm (pinion) and {held} radius {wide} mm (wheel), held"
    values = {"gear.pinion.r_bore_mm": bore, f"gear.wheel.r_{held}_mm": wide}
    return {"what": what, "why": "a start: give the true ones", "holds": values}


def example_numbers(pair: GearPair, force: float) -> dict[str, float]:
    """Return numbers for the examples of the schema that suit a pair under a force [N]."""
    gear, b = pair.gear_1, pair.b_w
    length = 0.25 * (gear.roll_a - gear.roll_f)
    roll = gear.roll_a - length
    axis = min(0.25 * gear.m_n, 0.04 * b)
    pitch = pair.a * gear.z / abs(pair.gear_2.z - gear.z if pair.gear_2.internal else pair.gear_2.z + gear.z)
    return {
        "crack": gear.m_n, "half": 0.5 * b, "pitch": pitch, "first": 0.2 * b, "last": 0.8 * b, "axis": axis, "apart": 2 * axis,
        "depth": 0.1 * gear.m_n, "amount": 10 * gear.m_n, "length": length, "roll": roll,
        "diameter": 2 * math.hypot(gear.r_b, roll), "angle": math.degrees(roll / gear.r_b), "reach": 2 * b,
        "whole": 4 * b, "thick": 2 * (gear.r_bore or 0.0), "torque": force * gear.r_b * 1e-3, "a": pair.a, "span": 3 * b,
    }  # fmt: skip


@contextlib.contextmanager
def _of_torque(torque):
    """Context in which messages about the force begin with the torque that the user gave."""
    try:
        yield
    except ValueError as error:
        if torque is None or "force_N = " not in str(error):
            raise
        raise ValueError(f"torque = {torque:g} N m: {error}") from error


def _force(pinion, width, torque):
    """Return the force along the line of action [N], from the pinion torque [N m] if given, and the torque as text."""
    if torque is not None and not 0 < torque < math.inf:
        raise ValueError(f"torque = {torque} N m, but the torque on the pinion must be positive")
    force = round(100.0 * width, 1) if torque is None else round(1e3 * torque / pinion.r_b, 3)
    torque_text = f"{force * pinion.r_b * 1e-3:.4g} N m over the base radius, {pinion.r_b:.5g} mm"
    return force, torque_text

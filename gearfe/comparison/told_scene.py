"""Description of a scene in words, as read from its file, before any computation."""

import math
from collections.abc import Iterator

from ..core.supports.shaft import Shaft
from ..core.supports.support import Support
from ..core.units import in_newton_per_um
from ..geometry.tooth.gear import Gear
from ..geometry.tooth.modified import Flank
from ..scene.load import Scene
from ..scene.scene_pair import ScenePair
from ..scene.schema import in_words, scene_schema
from ..scene.train import thrusts_of
from ..stiffness.curve import StiffnessCurve
from ..stiffness.solve import Solve
from .losses import told_damage

SIDES = ("pinion", "wheel")
AMOUNTS = [
    key.name for key in scene_schema()["flank"].keys.values() if key.unit and key.default == 0.0 and "relief" not in key.name
]
OTHERS = {"table": "a measured profile", "topography": "a measured flank", "pitch": "pitch deviations", "wear": "wear",
          "tooth_scale": "teeth that differ"}  # fmt: skip


def told(scene: Scene) -> list[str]:
    """Return the description of a scene line by line: gears, pairs with flanks, axes, supports, damage, machine, assumptions."""
    lines = [scene.title]
    for name, gear in scene.gears.items():
        lines += ["", f"gear {name}: {told_gear(gear)}"]
    for name, chosen in scene.pairs.items():
        lines += ["", *_pair(name, chosen)]
    lines += ["", _machine(scene), *_train(scene), *_set(scene)]
    lines += [f"assumed: {note['what']}" for note in scene.assumptions]
    return lines + [f"changed: {text}" for text in scene.changed]


def told_gear(gear: Gear) -> str:
    """Return a description of a gear.

    >>> told_gear(Gear(z=21, m_n=2.0, alpha_n=math.radians(20), b=20.0, r_bore=7.4))
    '21 teeth, module 2 mm, 20 degrees, spur, 20 mm wide; tip diameter 46 mm, root 37 mm; held in its bore of 14.8 mm diameter'
    """
    helix = f"helix {math.degrees(gear.beta):.4g} degrees" if gear.beta else "spur"
    shift = f", profile shift {gear.x:g}" if gear.x else ""
    shift += f", tooth thickness allowance {1e3 * gear.E_sn:g} um (cut with x_E = {gear.x_E:.4g})" if gear.E_sn else ""
    held = f"{'rim' if gear.internal else 'bore'} of {2 * (gear.r_rim or gear.r_bore or 0.0):.4g}"
    return (
        f"{gear.z} teeth{' (ring)' if gear.internal else ''}, module {gear.m_n:g} mm, {math.degrees(gear.alpha_n):.4g} degrees, "
        f"{helix}, {gear.b:g} mm wide{shift}; tip diameter {2 * gear.r_a:.4g} mm, root {2 * gear.r_f:.4g} mm; "
        f"held in its {held} mm diameter"
    )


def _pair(name: str, chosen: ScenePair) -> Iterator[str]:
    pair, case = chosen.pair, chosen.case()
    across = f", overlap ratio {case.overlap():.3f}" if case.runs != "spur" else ""
    play = f", backlash {1e3 * pair.backlash:.4g} um along the line of action" if pair.backlash > 1e-6 * pair.gear_1.m_n else ""
    yield (
        f"pair {name}: {pair.gear_1.z} and {pair.gear_2.z} teeth, {pair.a:.5g} mm apart, "
        f"contact ratio {pair.eps_alpha:.3f}{across}{play}; {told_load(chosen)}"
    )
    if case.runs == "herringbone":
        groove = f" with a groove of {chosen.groove:g} mm" if chosen.groove else ""
        yield f"  herringbone teeth{groove}; the overlap ratio is that of one half"
    yield from (f"  {text}" for text in told_details(chosen))
    for which in (None, *chosen.damage):
        heading = "healthy" if which is None else f"case {which}: {', '.join(_where(chosen, chosen.damage[which]))}"
        row, why = Solve().chosen(chosen.case(which))
        yield f"  {heading}; solved by {row.name}: {why}"
    yield from (f"  {note}" for note in pair.notes)


def told_load(chosen: ScenePair) -> str:
    """Describe the force of a pair, and the equivalent torques on both gears."""
    torques = [chosen.force * gear.r_b * 1e-3 for gear in chosen.pair.gears]
    return f"{chosen.force:g} N along the line of action, {torques[0]:.4g} N m on the pinion, {torques[1]:.4g} N m on the wheel"


def told_details(chosen: ScenePair) -> Iterator[str]:
    """Return one line each for flanks, misalignment and supports. The result is empty for a plain pair held at its bores."""
    pair, bent = chosen.pair, chosen.flanks
    for side, gear in zip(SIDES, pair.gears, strict=True):
        if side in bent:
            yield f"flank of the {side}: {told_flank(bent[side], gear)}"
    if not pair.gear_1.beta and 1 < pair.eps_alpha < 2 and any(flank.tip_relief or flank.root_relief for flank in bent.values()):
        shared = (pair.eps_alpha - 1) * pair.p_bt
        yield f"two pairs of teeth share the load over the first and the last {shared:.3g} mm of roll, one pair in between"
    if chosen.misalignment:
        yield f"axes: {in_words('pair', chosen.misalignment)}"
    for side, held in chosen.supports.items():
        yield f"{side} held by {_held(held)}"


def told_flank(flank: Flank, gear: Gear) -> str:
    """Describe the flank of a gear, with the diameters at which its reliefs start."""
    parts = []
    for end, roll in (("tip", gear.roll_a), ("root", gear.roll_f)):
        relief = 1e3 * getattr(flank, f"{end}_relief")
        if relief:
            start = _start(flank, end, gear)
            shape = {1.0: "linear", 2.0: "parabolic"}.get(exponent := getattr(flank, f"{end}_exponent"), f"power {exponent:g}")
            at = f"from a diameter of {2 * math.hypot(gear.r_b, start):.5g} mm on, over {abs(roll - start):.3g} mm of roll"
            parts.append(f"{end} relief {relief:.4g} um, {shape}, {at}")
    parts += [amounts] if (amounts := in_words("flank", flank, *AMOUNTS)) else []
    if any(flank.end_relief if isinstance(flank.end_relief, tuple) else (flank.end_relief,)):
        parts.append("end relief")
    parts += [word for name, word in OTHERS.items() if (value := getattr(flank, name)) is not None and len(value)]
    return "; ".join(parts) or "involute"


def _start(flank: Flank, end: str, gear: Gear) -> float:
    """Roll length at which a relief starts [mm]."""
    diameter, roll, angle = (getattr(flank, f"{end}_start_{how}") for how in ("diameter", "roll", "angle"))
    if diameter is not None:
        return math.sqrt((diameter / 2) ** 2 - gear.r_b**2)
    return float(roll) if roll is not None else float(angle or 0.0) * gear.r_b


def _held(held: Support | Shaft) -> str:
    if isinstance(held, Shaft):
        parts = ", ".join(f"{segment.length:g} mm of {segment.diameter:g} mm" for segment in held.segments)
        places = " and ".join(f"{at:g}" for at in held.bearings)
        stiff = " and ".join(
            "rigid" if math.isinf(stiffness) else f"{1e-3 * stiffness:g} N/um" for stiffness in held.bearing_stiffness
        )
        whole = ", one piece" if held.integral else ""
        return f"a shaft of {parts}, bearings at {places} mm ({stiff}), gear at {held.gear:g} mm{whole}"
    springs = in_words("support", held)
    return f"springs: {springs}; else rigid" if springs else "rigid springs"


def _where(chosen: ScenePair, damage: dict) -> Iterator[str]:
    for side, damages in damage.items():
        teeth = sorted({hurt.tooth for hurt in damages})
        yield f"{told_damage(chosen.pair, {side: damages})} in the {side}'s tooth {' and '.join(map(str, teeth))}"


def _machine(scene: Scene) -> str:
    if not scene.machine:
        return "no machine: gearfe dynamics needs a [machine] table"
    run = scene.machine
    law = "Hertz's impact law" if run["contact"] == "impact" else "stiffness curves"
    return f"machine: {run['model']}, {run['speed_rpm']:g} rpm, {run['torque_Nm']:g} N m, contact by {law}"


def _train(scene: Scene) -> Iterator[str]:
    """Describe the shafts of a gearbox: speeds, axial forces on gears (positive along z), and external torques."""
    if scene.train is None:
        return
    train, thrusts = scene.train, dict.fromkeys(scene.train.shafts, 0.0)
    for name, pushes in thrusts_of(train, scene.gears).items():
        thrusts[train.homes[name]] += pushes
    for name, shaft in train.shafts.items():
        gears = ", ".join(f"{gear} at {at:g} mm" for gear, at in shaft.gears.items()) or "no gear"
        thrust = f"; axial force of its gears {thrusts[name]:.4g} N" if abs(thrusts[name]) > 1e-9 else ""
        yield f"  shaft {name}: {train.speeds[name] * 30 / math.pi:.6g} rpm; {gears}{thrust}"
    ends = (f"{name} {train.torques[name]:.5g} N m at {end['shaft']}" for name, end in train.ends.items())
    yield f"  torques on shafts: {', '.join(ends)}"


def _set(scene: Scene) -> Iterator[str]:
    """Return a description of the planetary set of a scene."""
    if scene.set is not None:
        from ..planetary_sets.of_scene import build_set  # imported here, because only sets need it and it takes 0.1 s
        from .told_set import told_set

        yield f"set: {told_set(build_set(scene))}"


def told_supports(curve: StiffnessCurve) -> str:
    """Return the share of shafts and springs in the deflection, in words.

    The result is empty if the hubs are held rigidly.
    """
    if curve.support_deflection is None:
        return ""
    part, k_teeth = float(curve.support_deflection.mean() / curve.deflection.mean()), curve.without_supports().k.mean()
    return (
        f"shafts and springs cause {100 * part:.0f} % of the deflection, which k contains; "
        f"teeth and gear bodies alone have {in_newton_per_um(k_teeth)} N/um on average"
    )

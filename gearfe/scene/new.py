"""`new_scene`: a commented scene file of one's own to start from."""

import math
from pathlib import Path
from typing import Any

from ..core.files import written
from ..geometry.damage.crack import Crack, crack_path, path_length
from ..geometry.pair.gear_pair import GearPair
from ..geometry.tooth.gear import Gear
from .vocabulary import vocabulary

TEXT = """\
# A gear pair of your own. Lengths in mm, forces in N, angles in degrees: the unit stands in each name.
# Try it:  gearfe check {name}        gearfe compare {name}        gearfe compare {name} --case cracked
# Lines that begin with # and no space are what else it can say: take the # away, and they hold.

title = "{title}"
source = "own gear pair"  # where its numbers come from

[material.steel]
E_MPa = 206000.0
nu = 0.3

[gear.pinion]
z = {z_1}
m_n_mm = {m_n}
alpha_n_deg = 20.0
beta_deg = {beta}  # helix angle; the mate of an external pair has the opposite hand
b_mm = {width}
x = 0.0  # profile shift
addendum = 1.0  # of the tooth, in modules; with dedendum and tip_radius the basic rack of ISO 53, profile A
dedendum = 1.25
tip_radius = 0.38
r_bore_mm = {bore}  # held here: the bore changes k by tens of percent, so give the true one
material = "steel"

[gear.wheel]
z = {z_2}
m_n_mm = {m_n}
alpha_n_deg = 20.0
beta_deg = {mate_beta}
b_mm = {width}
x = 0.0
{wheel_rack}{wheel_support}
material = "steel"

[pair.stage]
gear_1 = "pinion"
gear_2 = "wheel"
{load}
{face}{pair_words}
# What you had to assume; it is printed with every result, until you change the values it holds for.
[[assumption]]
what = "{bores}"
why = "a start: give the true ones"
holds = {{ "gear.pinion.r_bore_mm" = {bore}, {held} }}

# Damage, by case: a root crack.
[[crack]]
case = "cracked"
gear = "pinion"
{crack}

{words}"""
FACE = 'face = "helical"  # or "herringbone" with groove_mm, the relief groove as part of b_mm\n'
RING_RACK = "addendum = 0.8  # a full one may reach into the pinion's fillet\ndedendum = 1.25\ntip_radius = 0.2\n"
RACK = "addendum = 1.0\ndedendum = 1.25\ntip_radius = 0.38\n"


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
) -> Path:
    """Write a scene file with comments: a gear pair with a case of damage, ready to run and to be changed.

    All else that a scene can say stands in it as commented lines (`gearfe.scene.vocabulary`).

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
    if path.suffix != ".toml":
        raise ValueError(f"{path}: a scene is a .toml file; give a name such as my.toml")
    if path.exists():
        raise ValueError(f"{path} exists and is not overwritten: give another name, or remove it")
    teeth = teeth or ((21, 63) if ring else (21, 31))
    rack: dict[str, Any] = {"m_n": module, "alpha_n": math.radians(20), "b": width}
    blank = [Gear(z=z, beta=math.radians(helix_deg), r_bore=0.1 * module, **rack) for z in teeth]
    bores = [round(0.5 * gear.r_f, 1) for gear in blank]
    beta = math.radians(helix_deg)
    pinion = Gear(z=teeth[0], beta=beta, r_bore=bores[0], **rack)
    if ring:
        rim = round(0.5 * module * teeth[1] / math.cos(beta) + 5 * module, 1)
        wheel = Gear(z=teeth[1], beta=beta, r_rim=rim, addendum=0.8, tip_radius=0.2, **rack)
        support, held = f"r_rim_mm = {rim}  # outer radius of the rim, held there", f'"gear.wheel.r_rim_mm" = {rim}'
    else:
        wheel = Gear(z=teeth[1], beta=-beta, r_bore=bores[1], **rack)
        support, held = f"r_bore_mm = {bores[1]}", f'"gear.wheel.r_bore_mm" = {bores[1]}'
    pair = GearPair(pinion, wheel)
    force, load = _force(pinion, width, torque_Nm)
    pair_words, words = vocabulary(pair, force, _relief(pair, tip_relief_um, tip_length_mm))
    text = TEXT.format(
        name=path.name, title=f"Pair {teeth[0]}/{teeth[1]}, module {module:g} mm", z_1=teeth[0], z_2=teeth[1], m_n=float(module),
        beta=float(helix_deg), mate_beta=math.degrees(wheel.beta) + 0.0, width=float(width), bore=bores[0],
        wheel_rack=RING_RACK if ring else RACK, wheel_support=support, load=load,
        pair_words=pair_words, words=words, crack=_crack(pinion, crack),
        face=FACE if helix_deg else "", held=held,
        bores=f"bore {bores[0]} mm (pinion) and {'rim ' + str(rim) if ring else 'bore ' + str(bores[1])} mm (wheel), held",
    )  # fmt: skip
    with written(path) as name:
        Path(name).write_text(text, encoding="utf-8")
    return path


def _force(pinion, width, torque):
    """Force along the line of action [N], of a torque on the pinion [N m] if given, and the line of the file that says it."""
    if torque is not None and not 0 < torque < math.inf:
        raise ValueError(f"torque = {torque} N m: a mesh is pressed together; give a positive torque on the pinion")
    force = round(100.0 * width, 1) if torque is None else round(1e3 * torque / pinion.r_b, 3)
    torque_text = f"{force * pinion.r_b * 1e-3:.4g} N m over the base radius, {pinion.r_b:.5g} mm"
    return force, f"force_N = {force}  # along the transverse line of action: {torque_text}"


def _crack(pinion, given):
    """Keys of the crack: its level, or the length [mm] and angle [degrees] that are given; the length is checked on its gear."""
    if given is None:
        length = path_length(pinion, Crack(level=0.3))
        return f"level = 0.3  # at 0.5 it reaches the centre-line; or as a length: length_mm = {length:.2f}\nangle_deg = 45.0"
    length, angle = given
    if not 5 <= angle <= 90:
        raise ValueError(f"a crack of {length:g} mm at {angle:g} degrees: the angle to the centre-line is from 5 to 90 degrees")
    crack_path(pinion, Crack(length=length, angle=math.radians(angle)))
    return f"length_mm = {length}\nangle_deg = {angle}  # to the centre-line"


def _relief(pair, amount, length):
    """Amount [um] and length [mm] of a tip relief, None without."""
    if amount is None and length is None:
        return None
    if amount is None or length is None or not (0 < amount < math.inf):
        raise ValueError(f"tip relief of {amount} um over {length} mm: give both, the amount positive")
    for gear in (pair.gear_1, pair.gear_2):
        whole = abs(gear.roll_a - gear.roll_f)
        if not 0 < length < whole:
            raise ValueError(f"tip relief over {length:g} mm, but the flank of z = {gear.z} is {whole:.4g} mm of roll long")
    return amount, length

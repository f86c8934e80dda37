"""All that a scene can say besides its gears and load, as commented lines of a new one: take the # away, and they hold.

Lines that are keys or tables begin with # and no space; text begins with # and a space.
"""

import math
import re

from ..geometry.pair.gear_pair import GearPair
from .damage_tables import TABLES
from .flank_table import MATE_WORDS, WORDS

PAIR = """\
#a_mm = {a:.4f}  # centre distance; left out: the one without backlash
# Misalignment, as deviations over the face width, um along the line of action: positive lets z = b come apart, z = 0 is pressed.
#F_beta_um = 10.0  # in the plane of action; or the axes' own errors, over bearing_span_mm (left out: over the width):
#f_sigma_delta_um = 0.0  # inclination, in the plane of the axes
#f_sigma_beta_um = 0.0  # skew, out of that plane
#bearing_span_mm = {span:.1f}
"""
HELD = """\
# What holds the hubs; without, the bores are rigid. Springs:
#[support.output]
#gear = "wheel"
#pair = "stage"
#radial_N_per_um = 200.0  # of axis and housing together; each key left out: rigid
#tilt_Nm_per_mrad = 40.0
#torsion_Nm_per_mrad = 300.0
#axial_N_per_um = 200.0
#coupling_urad_per_kN = 0.0  # slope under a force, of a gear that is not in the middle of its bearings

# or a shaft on two bearings, positions from its left end:
#[shaft.drive]
#gear = "pinion"
#pair = "stage"
#material = "steel"
#lengths_mm = [{reach:.1f}, {reach:.1f}]  # of its parts, from left to right
#diameters_mm = [{thick:.1f}, {thick:.1f}]
#bores_mm = [0.0, 0.0]
#bearings_at_mm = [0.0, {whole:.1f}]
#bearings_N_per_um = [200.0, 200.0]  # left out: rigid
#gear_at_mm = {reach:.1f}  # the middle of the gear
#torque_at_mm = 0.0  # where the torque enters; left out: no twist
#integral = false  # true: the gear is one piece with it (fe3d)
"""
MACHINE = """\
# The machine, for `gearfe dynamics` and `gearfe dataset`: both gears on elastic bearings. Planetary sets: see `gearfe scenes`.
#[machine]
#model = "helical_pair"  # spur pairs too; or planetary, compound_planetary, herringbone_planetary with their gears
#speed_rpm = 1500.0  # of the pinion
#torque_Nm = {torque:.2f}  # on the pinion
#n_planets = 3  # of planetary sets
#contact = "linear"  # or "impact": Hertz's law with damping, its keys in [machine.impact] below
#backlash_um = 0.0
#profile_error_um = 0.0  # at mesh frequency
#runout_um = 0.0  # of the pinion
#misplaced_um = 0.0  # of the wheel, away from the pinion
#misplaced_y_um = 0.0  # and across
#
#[machine.impact]  # read where contact = "impact"
#damping_Ns_per_mm = 300.0  # largest damping; left out: as a number a thousandth of Hertz's K [N/mm**1.5]
#depth_mm = 0.1  # penetration from which the damping is full
# Of the model "planetary" only: friction = [0.08, 0.05], static and dynamic, at slips of friction_speeds_mm_per_s = [0.1, 10.0];
# pulses of the load on the carrier: pulse_Nm = 250.0, pulse_period_s = 0.5, pulse_width_s = 0.05.
# Of "herringbone_planetary": [machine.bodies.sun], planet, ring, carrier with mass_kg and inertia_kgm2; else from the gears.

# A whole planetary set, for `gearfe set`, needs pairs of sun and planet and of planet and ring; then: [set], [ring.support],
# [pin.NAME]. See the how-to page on planetary sets.
"""


def vocabulary(pair: GearPair, force: float, relief: tuple[float, float] | None = None) -> tuple[str, str]:
    """Commented lines for the table of the pair, and for the end of a scene, with numbers that suit a pair under a force [N].

    The lines of a tip `relief` of both gears ([um], and over which length [mm]) are not comments.
    """
    gear, b = pair.gear_1, min(pair.gear_1.b, pair.gear_2.b)
    length = 0.25 * (gear.roll_a - gear.roll_f)
    roll = gear.roll_a - length
    axis = min(0.25 * gear.m_n, 0.04 * b)
    pitch = pair.a * gear.z / abs(pair.gear_2.z - gear.z if pair.gear_2.internal else pair.gear_2.z + gear.z)
    numbers = {
        "crack": gear.m_n, "half": 0.5 * b, "pitch": pitch, "first": 0.2 * b, "last": 0.8 * b, "axis": axis, "apart": 2 * axis,
        "depth": 0.1 * gear.m_n, "amount": 10 * gear.m_n, "length": length, "roll": roll,
        "diameter": 2 * math.hypot(gear.r_b, roll), "angle": math.degrees(roll / gear.r_b), "reach": 2 * b,
        "whole": 4 * b, "thick": 2 * (gear.r_bore or 0.0), "torque": force * gear.r_b * 1e-3,
    }  # fmt: skip
    mate = MATE_WORDS.format(**numbers)
    parts = (*(table.words for table in TABLES.values()), WORDS, HELD, *([] if pair.gear_2.internal else [MACHINE]))
    words = "\n".join(part.format(mate=mate, **numbers) for part in parts)
    return PAIR.format(a=pair.a, span=3 * b), _relieved(words, *relief) if relief else words


def _relieved(words, amount, length):
    """The commented lines with those of a tip relief in force, of both gears."""
    keys = f"tip_relief_um = {amount:g}", f"tip_start_length_mm = {length:g}"
    words = re.sub(r"^#(\[flank\.\w+\].*)\n#(gear = )", r"\1\n\2", words, flags=re.M)
    for line in keys:
        words = re.sub(rf"^#{line.split(' ')[0]} = [\d.]+", line, words, flags=re.M)
    return words

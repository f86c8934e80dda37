"""Keys of a scene's ``[machine]`` and ``[machine.impact]`` tables beyond those every machine needs: kind and default.

``[machine]``

- ``contact``: ``"linear"`` (stiffness curves of the pairs) or ``"impact"`` (``F = K delta**1.5`` with K from Hertz's theory and
  STEP damping, pits as lost contact line; planetary and helical_pair).
- ``backlash_um``: play along the line of action; default: none, the mesh never opens (impact law: 100).
- ``profile_error_um``: amplitude of a profile error at mesh frequency in all meshes.
- ``runout_um``: eccentricity of the driving gear. ``misplaced_um``: shift of planet 1 (or the wheel) along x, away from the sun,
  which a planet takes up by turning; ``misplaced_y_um``: along the circle of the planets, which makes their loads unequal.

``[machine.bodies.NAME]``, of sun, planet, ring and carrier of a herringbone stage; default: from the gears

- ``mass_kg, inertia_kgm2``: of a whole body, the inertia about its axis.

``[machine.impact]``, read where contact is ``"impact"``

- ``damping_Ns_per_mm``: largest damping of the law; default: 0.1 % of K as a number (S0), K in N/mm**1.5.
- ``depth_mm``: penetration from which the damping is full.
- ``friction``: static and dynamic coefficients of Coulomb friction in the sun's meshes; default: no friction. Planetary only.
- ``friction_speeds_mm_per_s``: slip at which they hold.
- ``pulse_Nm, pulse_period_s, pulse_width_s``: what the load on the carrier rises by, how often and how long. Planetary only.
"""

from .strict import NUMBER, REQUIRED, TEXT, TWO, checked

MACHINE = {
    "contact": (TEXT, "linear"),
    "backlash_um": (NUMBER, None),
    "profile_error_um": (NUMBER, 0.0),
    "runout_um": (NUMBER, 0.0),
    "misplaced_um": (NUMBER, 0.0),
    "misplaced_y_um": (NUMBER, 0.0),
}
IMPACT = {
    "damping_Ns_per_mm": (NUMBER, None),
    "depth_mm": (NUMBER, 0.1),
    "friction": (TWO, None),
    "friction_speeds_mm_per_s": (TWO, [0.1, 10.0]),
    "pulse_Nm": (NUMBER, 0.0),
    "pulse_period_s": (NUMBER, 0.5),
    "pulse_width_s": (NUMBER, 0.05),
}
BODY = {"mass_kg": (NUMBER, REQUIRED), "inertia_kgm2": (NUMBER, REQUIRED)}
BODIES = ("sun", "planet", "ring", "carrier")


def checked_bodies(file, tables):
    """Masses [kg] and inertias [kg m2] by body, of none or of all."""
    if tables and (not isinstance(tables, dict) or set(tables) != set(BODIES)):
        raise ValueError(f"{file} [machine.bodies]: give a table for each of {', '.join(BODIES)}, or none")
    rows = {name: checked(file, f"machine.bodies.{name}", table, BODY) for name, table in tables.items()}
    for name, row in rows.items():
        if not min(row.values()) > 0:
            raise ValueError(f"{file} [machine.bodies.{name}]: mass_kg and inertia_kgm2 must be positive")
    return {name: (float(row["mass_kg"]), float(row["inertia_kgm2"])) for name, row in rows.items()}

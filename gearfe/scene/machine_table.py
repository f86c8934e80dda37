"""Keys of a scene's ``[machine]``, ``[machine.impact]`` and ``[machine.bodies.NAME]`` tables: kind and default.

``[machine]``

- ``model, speed_rpm, torque_Nm, n_planets``: see `gearfe.dynamics.machine.of_scene`.
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

from .strict import NUMBER, REQUIRED, TEXT, TWO, WHOLE, checked, shown

MACHINE = {
    "model": (TEXT, REQUIRED),
    "speed_rpm": (NUMBER, REQUIRED),
    "torque_Nm": (NUMBER, REQUIRED),
    "n_planets": (WHOLE, 3),
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
LIMITS = {  # smallest and largest value that a machine may have; a length in um reaches 100 mm
    "speed_rpm": (1e-3, 1e6),
    "torque_Nm": (0.0, 1e9),
    "n_planets": (1, 100),
    "backlash_um": (0.0, 1e5),
    **dict.fromkeys(("profile_error_um", "runout_um", "misplaced_um", "misplaced_y_um"), (-1e5, 1e5)),
}
BODIES = ("sun", "planet", "ring", "carrier")


def checked_machine(file, table):
    """Check a [machine] table, its [machine.impact] and its [machine.bodies.NAME]."""
    flat = {key: value for key, value in table.items() if key not in ("impact", "bodies")} if isinstance(table, dict) else table
    out = checked(file, "machine", flat, MACHINE, extra=("impact", "bodies"))
    for key, (low, high) in LIMITS.items():
        if out[key] is not None and not low <= out[key] <= high:
            raise ValueError(f"{file} [machine] {key} = {out[key]}, but give a number from {low:g} to {high:g}")
    bodies = checked_bodies(file, table.get("bodies", {}))
    return out | {"impact": checked(file, "machine.impact", table.get("impact", {}), IMPACT), "bodies": bodies}


def checked_bodies(file, tables):
    """Masses [kg] and inertias [kg m2] by body, of none or of all."""
    if not isinstance(tables, dict) or (tables and set(tables) != set(BODIES)):
        names = f"{', '.join(tables)}" if isinstance(tables, dict) else shown(tables)
        raise ValueError(f"{file} [machine.bodies]: {names}, but give a table for each of {', '.join(BODIES)}, or none")
    rows = {name: checked(file, f"machine.bodies.{name}", table, BODY) for name, table in tables.items()}
    for name, row in rows.items():
        if not min(row.values()) > 0:
            raise ValueError(f"{file} [machine.bodies.{name}]: mass_kg and inertia_kgm2 must be positive")
    return {name: (float(row["mass_kg"]), float(row["inertia_kgm2"])) for name, row in rows.items()}

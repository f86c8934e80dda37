"""Tables of gearboxes that several tests share."""

STEEL = {"steel": {"E_MPa": 2.06e5, "nu": 0.3}}
SHAFT = {"material": "steel", "bearings_N_per_um": [150.0, 90.0], "bearings_Ns_per_mm": [0.3, 0.2]}


def gear(z, m_n, b, beta=0.0, **more):
    return {
        "z": z,
        "m_n_mm": m_n,
        "alpha_n_deg": 20.0,
        "b_mm": b,
        "beta_deg": beta,
        "r_bore_mm": 10.0,
        "material": "steel",
    } | more


def scene(gears, pairs, shafts, **tables):
    return {"title": "gearbox", "source": "own", "material": STEEL, "gear": gears, "pair": pairs, "shaft": shafts} | tables


def end(shaft, **more):
    return {"shaft": shaft, "inertia_kgm2": 0.02, "torsion_Nm_per_mrad": 3.0, "damping_Nms_per_rad": 0.3} | more


TWO_STAGE = scene(
    {"a": gear(23, 2.0, 20.0, 15.0), "b": gear(61, 2.0, 20.0, -15.0),
     "c": gear(19, 2.5, 25.0, -12.0), "d": gear(47, 2.5, 25.0, 12.0)},
    {"fast": {"gear_1": "a", "gear_2": "b"}, "slow": {"gear_1": "c", "gear_2": "d", "angle_deg": 70.0}},
    {
        "one": SHAFT | {"gears": ["a"], "gears_at_mm": [60.0], "lengths_mm": [100.0, 80.0], "diameters_mm": [25.0, 30.0],
                        "bearings_at_mm": [15.0, 165.0]},
        "two": SHAFT | {"gears": ["b", "c"], "gears_at_mm": [60.0, 120.0], "gears_turned_deg": [0.0, 5.0], "lengths_mm": [180.0],
                        "diameters_mm": [32.0], "bores_mm": [8.0], "bearings_at_mm": [15.0, 165.0, 90.0],
                        "bearings_N_per_um": [150.0, 90.0, 40.0], "bearings_Ns_per_mm": [0.3, 0.2, 0.1]},
        "three": SHAFT | {"gears": ["d"], "gears_at_mm": [120.0], "lengths_mm": [200.0], "diameters_mm": [40.0],
                          "bearings_at_mm": [15.0, 165.0], "bearings_axial_N_per_um": [0.0, 120.0]},
    },
    motor=end("one", slope_Nms_per_rad=0.05),
    load={"brake": end("three", inertia_kgm2=0.3, slope_Nms_per_rad=0.4)},
    machine={"model": "gearbox", "speed_rpm": 1500.0, "torque_Nm": 30.0, "dofs": "six", "damping_per_stiffness_s": 3e-6},
)  # fmt: skip
RING = gear(84, 2.0, 22.0, x=-0.4617, addendum=0.859, rack_tip_radius=0.2, r_rim_mm=95.0)
RING.pop("r_bore_mm")
PLANETARY = scene(
    {"a": gear(25, 2.0, 20.0), "b": gear(50, 2.0, 20.0), "sun": gear(21, 2.0, 22.0), "planet": gear(31, 2.0, 22.0), "ring": RING},
    {"fast": {"gear_1": "a", "gear_2": "b", "angle_deg": -30.0}, "outer": {"gear_1": "sun", "gear_2": "planet", "a_mm": 52.0},
     "inner": {"gear_1": "planet", "gear_2": "ring", "a_mm": 52.0}},
    {
        "one": {"material": "steel", "gears": ["a"], "gears_at_mm": [50.0], "lengths_mm": [90.0], "diameters_mm": [22.0]},
        "two": {"material": "steel", "gears": ["b"], "gears_at_mm": [20.0], "lengths_mm": [60.0, 40.0],
                "diameters_mm": [26.0, 24.0]},
        "three": {"material": "steel", "gears": ["sun"], "gears_at_mm": [70.0], "lengths_mm": [90.0], "diameters_mm": [24.0]},
        "out": {"material": "steel", "gears": [], "gears_at_mm": [], "lengths_mm": [120.0], "diameters_mm": [45.0]},
    },
    coupling={"middle": {"shaft_1": "two", "shaft_2": "three", "torsion_Nm_per_mrad": 4.0, "damping_Nms_per_rad": 0.4}},
    stage={"set": {"sun_planet": "outer", "planet_ring": "inner", "n_planets": 3, "carrier": "out", "carrier_at_mm": 20.0,
                   "carrier_inertia_kgm2": 0.02, "planet_bearing": "needle"}},
    bearing={"needle": {"rollers": 17, "roller_mm": 3.0, "pitch_mm": 22.0, "contact_deg": 0.0}},
    motor=end("one", slope_Nms_per_rad=0.02),
    load={"brake": end("out", inertia_kgm2=0.5)},
    machine={"model": "gearbox", "speed_rpm": 1200.0, "torque_Nm": 25.0},
)  # fmt: skip
SPACE = scene(  # the same train with helical gears, four planets on pins, and stations that move in six directions
    {"a": gear(25, 2.0, 20.0, 12.0), "b": gear(50, 2.0, 20.0, -12.0), "sun": gear(21, 2.0, 22.0, 8.0),
     "planet": gear(31, 2.0, 22.0, -8.0), "ring": RING | {"z": 83, "x": 0.0, "beta_deg": -8.0}},
    {name: {key: value for key, value in row.items() if key != "a_mm"} for name, row in PLANETARY["pair"].items()},
    {
        name: SHAFT | row | {"bearings_at_mm": at}
        for (name, row), at in zip(
            PLANETARY["shaft"].items(), ([5.0, 85.0], [10.0, 95.0], [5.0, 45.0], [50.0, 110.0]), strict=True
        )
    },
    stage={"set": PLANETARY["stage"]["set"] | {
        "n_planets": 4, "pin_N_per_um": 120.0, "pin_axial_N_per_um": 30.0, "pin_tilt_Nm_per_mrad": 4.0, "carrier_mass_kg": 2.5}},
    machine=PLANETARY["machine"] | {"dofs": "six"},
    **{key: PLANETARY[key] for key in ("coupling", "bearing", "motor", "load")},
)  # fmt: skip
BRANCHING = scene(
    {"a": gear(20, 2.0, 20.0), "b": gear(41, 2.0, 20.0), "c": gear(53, 2.0, 20.0)},
    {"left": {"gear_1": "a", "gear_2": "b", "angle_deg": 20.0}, "right": {"gear_1": "a", "gear_2": "c", "angle_deg": 205.0}},
    {
        name: SHAFT | {"gears": [one], "gears_at_mm": [at], "lengths_mm": [150.0], "diameters_mm": [thick],
                       "bearings_at_mm": [10.0, 140.0]}
        for name, one, at, thick in (("in", "a", 70.0, 24.0), ("up", "b", 70.0, 28.0), ("down", "c", 65.0, 26.0))
    },
    motor={"shaft": "in", "inertia_kgm2": 0.01, "slope_Nms_per_rad": 0.02},
    load={"pump": end("up", torque_Nm=20.0, at_mm=120.0), "fan": end("down", inertia_kgm2=0.1)},
    machine={"model": "gearbox", "speed_rpm": 1500.0, "torque_Nm": 18.0, "dofs": "six"},
)  # fmt: skip

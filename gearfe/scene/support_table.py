"""The [support.NAME] and [shaft.NAME] tables of a scene: what holds the hubs of gears, units in the key names."""

import math

from ..core.supports.shaft import Shaft
from ..core.supports.support import Support
from .strict import NUMBER, NUMBERS, REQUIRED, TEXT, TRUTH, TWO, known, placed, sides

SUPPORTS = {
    "support": {
        "gear": (TEXT, REQUIRED),
        "pair": (TEXT, None),
        "radial_N_per_um": (NUMBER, None),
        "tilt_Nm_per_mrad": (NUMBER, None),
        "torsion_Nm_per_mrad": (NUMBER, None),
        "axial_N_per_um": (NUMBER, None),
        "coupling_urad_per_kN": (NUMBER, 0.0),
    },
    "shaft": {
        "gear": (TEXT, REQUIRED),
        "pair": (TEXT, None),
        "material": (TEXT, REQUIRED),
        "lengths_mm": (NUMBERS, REQUIRED),
        "diameters_mm": (NUMBERS, REQUIRED),
        "bores_mm": (NUMBERS, None),
        "bearings_at_mm": (TWO, REQUIRED),
        "gear_at_mm": (NUMBER, REQUIRED),
        "torque_at_mm": (NUMBER, None),
        "bearings_N_per_um": (TWO, None),
        "integral": (TRUTH, False),
    },
}
PER_UM, PER_MRAD, KN = 1e3, 1e6, 1e9  # N/um to N/mm, Nm/mrad to N mm/rad, urad/kN to rad/N (by which is divided)


def supports_of(file, rows, name, pairs, materials):
    """Supports of the pair `name` as `gearfe.mesh_stiffness` takes them, from the checked rows of a scene, by kind and name.

    That of a gear holds it in all its pairs, or only in its `pair`.
    """
    out = {}
    gears = [row[side] for row in pairs.values() for side in ("gear_1", "gear_2")]
    for kind in SUPPORTS:
        for key, row in rows[kind].items():
            where = f"{kind}.{key}"
            stands = sides(file, where, row, name, pairs, dict.fromkeys(gears), "gear in a pair")
            if kind == "shaft":
                known(file, where, "material", row["material"], materials, "material")
            make = {"support": _support, "shaft": _shaft}[kind]
            support = placed(file, where, lambda r=row, make=make: make(r, materials))
            for side in stands:
                if side in out:
                    raise ValueError(f"{file} [{where}]: gear {row['gear']!r} is held in pair {name!r} already; give one of both")
                out[side] = support
    return {side: out[side] for side in ("pinion", "wheel") if side in out}


def _support(row, materials):
    springs = {"radial_N_per_um": PER_UM, "tilt_Nm_per_mrad": PER_MRAD, "torsion_Nm_per_mrad": PER_MRAD, "axial_N_per_um": PER_UM}
    stiffnesses = {key.partition("_")[0]: math.inf if row[key] is None else row[key] * unit for key, unit in springs.items()}
    return Support(**stiffnesses, coupling=row["coupling_urad_per_kN"] / KN)


def _shaft(row, materials):
    columns = [row["lengths_mm"], row["diameters_mm"], *([row["bores_mm"]] if row["bores_mm"] is not None else [])]
    if len({len(column) for column in columns}) > 1:
        raise ValueError(
            f"shaft of {len(columns[0])} lengths: give as many diameters_mm, and bores_mm (0: none) if there are any"
        )
    stiff = row["bearings_N_per_um"]
    return Shaft(
        segments=list(zip(*columns, strict=True)),
        bearings=row["bearings_at_mm"],
        gear=row["gear_at_mm"],
        material=materials[row["material"]],
        torque=row["torque_at_mm"],
        integral=row["integral"],
        bearing_stiffness=math.inf if stiff is None else tuple(value * PER_UM for value in stiff),
    )

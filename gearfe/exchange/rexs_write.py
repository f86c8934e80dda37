"""`write_rexs`: gears of a scene as a REXS file, with their mesh stiffness."""

import math
from collections.abc import Mapping
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from ..core.files import written
from ..geometry.aliases import StrPath
from ..scene.load import Scene
from ..stiffness.curve import StiffnessCurve
from .rexs_file import Component, Relation
from .xml_template import filled


def write_rexs(path: StrPath, scene: Scene, curves: Mapping[str, StiffnessCurve] | None = None) -> None:
    """Write the gears of a scene as a REXS 1.7 file: gears, flanks, tools, materials, stages, torques, and stiffness curves.

    Each pair becomes a cylindrical stage. Damage, flank modifications, supports and the planets of a set beyond the first are not
    written. The stiffness is that along the transverse line of action.

    Parameters
    ----------
    path : path
        File ``.rexs``.
    scene : Scene
    curves : dict of str to StiffnessCurve, optional
        Curve of a mesh cycle by the name of its pair, for ``meshing_stiffness_characteristic``.

    Raises
    ------
    ValueError
        If the path has another suffix or cannot be written, or a curve is of no pair of the scene.
    """
    if Path(path).suffix.lower() != ".rexs":
        raise ValueError(f"{path}: REXS is written as .rexs")
    for name in curves or ():
        scene.pair(name)
    unit, date = _UnitWriter(scene, curves or {}), datetime.now(UTC).isoformat(timespec="seconds")
    with written(path) as name:
        Path(name).write_text(filled("rexs.xml", unit=unit, date=date), encoding="utf-8")


class _UnitWriter:
    """Components and relations of a scene."""

    def __init__(self, scene, curves):
        self.components, self.relations, self.gears = [], [], {}
        self.materials = {}
        self.unit = self._add("gear_unit", scene.title, number_of_gears=(1, "none"), gear_shift_index=(1, "none"))
        for name, chosen in scene.pairs.items():
            self._stage(name, chosen, curves.get(name), scene)

    def _add(self, kind, name="", **values):
        self.components.append(Component(len(self.components) + 1, kind, name, values))
        return len(self.components)

    def _relate(self, kind, order=0, **refs):
        self.relations.append(Relation(kind, order, refs))

    def _stage(self, name, chosen, curve, scene):
        pair = chosen.pair
        values = {"center_distance": (pair.a, "mm"), "radial_contact_ratio": (float(pair.eps_alpha), "none")}
        if curve is not None:
            values["meshing_stiffness_characteristic"] = ((1e-3 * curve.k).tolist(), "N / mm")
        stage = self._add("cylindrical_stage", name, **values)
        gears = []
        for i, gear in enumerate(pair.gears):
            own = next((key for key, one in scene.gears.items() if one == gear), f"{name}_gear_{i + 1}")
            gears.append(self._gear(own, gear, chosen.materials[i]))
            torque = chosen.force * gear.r_b * 1e-3
            data = {"is_driving_gear": (i == 0, "none"), "torque": (torque, "N m")}
            if curve is not None:
                turn = np.degrees(2 * math.pi * curve.phase / gear.z)
                data["rotational_meshing_position"] = (turn.tolist(), "deg")
            inside = self._add("cylindrical_stage_gear_data", f"{own} in {name}", **data)
            self._relate("stage_gear_data", stage=stage, gear=gears[-1], stage_gear_data=inside)
        self._relate("stage", stage=stage, gear_1=gears[0], gear_2=gears[1])
        self._relate("assembly", assembly=self.unit, part=stage)

    def _gear(self, name, gear, material):
        if (name, gear) in self.gears:
            return self.gears[name, gear]
        shaft = self._add("shaft", f"shaft of {name}")
        edge = {
            "outer": 2 * gear.held if not gear.internal else 2.1 * gear.held,
            "inner": 0.0 if not gear.internal else 2 * gear.held,
        }
        ends = {f"{side}_diameter_{end}": (value, "mm") for side, value in edge.items() for end in ("begin", "end")}
        section = self._add("shaft_section", "", u_coordinate_on_shaft=(0.0, "mm"), length=(gear.b, "mm"), **ends)
        body = {"inner_diameter": (2 * gear.held, "mm")} if not gear.internal else {}
        own = self._add(
            "ring_gear" if gear.internal else "cylindrical_gear", name, number_of_teeth=(gear.z, "none"),
            normal_module=(gear.m_n, "mm"),
            helix_angle_reference_diameter=(math.degrees(gear.beta), "deg"), face_width=(gear.b, "mm"),
            tip_diameter=(2 * gear.r_a, "mm"), root_diameter=(2 * gear.r_f, "mm"),
            u_coordinate_on_shaft=(gear.b / 2, "mm"), **body,
        )  # fmt: skip
        self._relate("assembly", assembly=self.unit, part=shaft)
        self._relate("assembly", assembly=shaft, part=section)
        self._relate("assembly", assembly=shaft, part=own)
        if gear.internal:
            rim = self._add("gear_body", f"body of {name}", outer_diameter=(2 * gear.held, "mm"), length=(gear.b, "mm"))
            self._relate("assembly", assembly=own, part=rim)
        self._flanks(own, gear)
        if material not in self.materials:
            self.materials[material] = self._add(
                "material", "", elastic_modulus=(material.E, "N / mm^2"), poisson_ratio=(material.nu, "none")
            )
        self._relate("reference", origin=own, referenced=self.materials[material])
        self.gears[name, gear] = own
        return own

    def _flanks(self, own, gear):
        shape = {
            "addendum_coefficient_reference_profile": (gear.dedendum, "none"),
            "tip_radius_factor": (gear.rack_tip_radius, "none"),
            "dedendum_coefficient_reference_profile": (gear.addendum, "none"),
        }  # fmt: skip
        teeth = {"number_of_teeth": (gear.z_cutter, "none")} if gear.internal else {"normal_module": (gear.m_n, "mm")}
        tool = self._add("cutter_wheel_tool" if gear.internal else "rack_shaped_tool", "", **shape, **teeth)
        cut = (
            {"generated_addendum_modification_coefficient": (gear.x_E, "none")}
            if gear.E_sn
            else {"machining_allowance": (0.0, "mm")}
        )
        settings = self._add("cylindrical_gear_manufacturing_settings", "", **cut)
        sides = {}
        for side in ("left", "right"):
            sides[side] = self._add(
                "cylindrical_gear_flank", side, normal_pressure_angle=(math.degrees(gear.alpha_n), "deg"),
                addendum_modification_coefficient=(gear.x, "none"),
            )  # fmt: skip
            self._relate("manufacturing_step", 1, workpiece=sides[side], tool=tool, manufacturing_settings=settings)
        self._relate("flank", gear=own, **sides)

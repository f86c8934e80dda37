"""A gear of a REXS model as a row of a scene: teeth, basic rack, bore, material, tooth thickness allowance."""

import math
from typing import Any

from .rexs_file import Component, Model

GEARS = ("cylindrical_gear", "ring_gear")
STEEL = {"E_MPa": 206_000.0, "nu": 0.3}
NEAR = 0.02  # rounding tolerance of radii [m_n]


def outward(gear: Component) -> int:
    """Return the radial direction of the teeth: 1 for an external gear, -1 for a ring."""
    return -1 if gear.type == "ring_gear" else 1


def pitch_radius(row: dict[str, Any]) -> float:
    """Radius of the pitch circle [mm]."""
    return row["z"] * row["m_n_mm"] / math.cos(math.radians(row["beta_deg"])) / 2


def root_radius(gear: Component, row: dict[str, Any]) -> float:
    """Radius of the root circle of a nominal gear [mm]."""
    return pitch_radius(row) - (outward(gear) * row["dedendum"] - row["x"]) * row["m_n_mm"]


class GearReader:
    """Reader of the gears of a model. Missing values become assumptions, stored in `assumed` as ``(what, why)``."""

    def __init__(self, model: Model):
        self.model = model
        self.assumed: list[tuple[str, str]] = []
        self.materials: dict[str, dict[str, float]] = {}

    def assume(self, what: str, why: str) -> None:
        """Record an assumption once."""
        if (what, why) not in self.assumed:
            self.assumed.append((what, why))

    def flanks(self, gear: Component) -> dict[str, Component]:
        """Flanks of a gear by side, ``left`` and ``right``."""
        sides = ("left", "right")
        return {side: found[0] for side in sides if (found := self.model.related("flank", "gear", gear.id, side))}

    def basic(self, gear: Component, name: str) -> dict[str, Any]:
        """Teeth, module, angles and face width. ValueError that names the gear and the attribute if one is missing."""
        row: dict[str, Any] = {}
        wanted = {"z": ("number_of_teeth",), "m_n_mm": ("normal_module", "mm"), "b_mm": ("face_width", "mm")}
        for key, (attribute, *units) in wanted.items():
            row[key] = self._needed(gear, name, gear.number(attribute, *units), attribute)
        if row["z"] != int(row["z"]):
            raise ValueError(f"gear {name!r}: number_of_teeth = {row['z']:g}, but it must be a whole number")
        row["z"] = int(row["z"])
        angles = [flank.number("normal_pressure_angle", "deg") for flank in self.flanks(gear).values()]
        angles = [angle for angle in angles if angle is not None]
        if len(set(angles)) > 1:
            raise ValueError(f"gear {name!r}: its flanks have {angles} degrees, but gearfe has symmetric teeth only")
        tools = [tool.number("normal_pressure_angle", "deg") for tool in self.tools(gear)]
        given = next((angle for angle in (*angles, *tools) if angle is not None), None)
        row["alpha_n_deg"] = self._needed(gear, name, given, "normal_pressure_angle")
        beta = gear.number("helix_angle_reference_diameter", "deg")
        if beta is None:
            beta = 0.0
            self.assume(f"gear {name}: spur", "the file states no helix angle")
        row["beta_deg"] = beta + 0.0  # Adding 0.0 changes -0.0 to 0.0.
        return row

    def _needed(self, gear, name, value, attribute):
        if value is None:
            raise ValueError(
                f"gear {name!r} (component {gear.id}): {attribute} is missing, or in a unit that REXS does not define"
            )
        return value

    def tools(self, gear: Component) -> list[Component]:
        """Tools of a gear. The last step produces the final flank."""
        steps = [self.model.related("manufacturing_step", "workpiece", flank.id, "tool") for flank in self.flanks(gear).values()]
        return next(filter(None, steps), []) or self.model.related("ordered_reference", "origin", gear.id, "referenced")

    def shift(self, gear: Component, m_n: float) -> float | None:
        """Nominal profile shift coefficient, None if the file does not state it."""
        found = []
        for flank in self.flanks(gear).values():
            x, length = flank.number("addendum_modification_coefficient"), flank.number("addendum_modification", "mm")
            found += [value for value in (x, None if length is None else length / m_n) if value is not None]
        return found[0] if found else None

    def allowance(self, gear: Component, row: dict[str, Any], name: str) -> float:
        """Mean normal tooth thickness allowance E_sn [um] from span, chordal thickness or generating profile shift, else 0."""
        alpha, m_n = math.radians(row["alpha_n_deg"]), row["m_n_mm"]
        limits = ("upper_backlash_allowance_referenced_to_span", "lower_backlash_allowance_referenced_to_span")
        found = [(what := "span measurement", [gear.number(one, "mum") for one in limits], 1 / math.cos(alpha))]
        chord = ("chordal_tooth_thickness_upper_deviation", "chordal_tooth_thickness_lower_deviation")
        found.append(("tooth thickness", [gear.number(one, "mm") for one in chord], 1e3))
        for what, pair, factor in found:
            given = [value for value in pair if value is not None]
            if given:
                value = factor * sum(given) / len(given)
                self.assume(f"gear {name}: E_sn = {value:.4g} um", f"mean of the allowances of the {what}")
                return value
        cut = self._generating_shift(gear)
        if cut is not None and abs(cut - row["x"]) > 1e-9:
            value = 2e3 * m_n * math.tan(alpha) * (cut - row["x"]) * outward(gear)
            self.assume(f"gear {name}: E_sn = {value:.4g} um", f"generating profile shift coefficient x_E = {cut:g}")
            return value
        series = gear.value("tooth_thickness_deviation_tolerance_series_din_3967_1978")
        if series is not None:
            self.assume(f"gear {name}: no tooth thickness allowance", f"the file states only the series {series} of DIN 3967")
        return 0.0

    def _generating_shift(self, gear):
        names = ("generated_addendum_modification_coefficient",)
        names += tuple(f"{names[0]}_{end}_deviation" for end in ("upper", "lower"))
        for flank in self.flanks(gear).values():
            for settings in self.model.related("manufacturing_step", "workpiece", flank.id, "manufacturing_settings")[::-1]:
                stated, *limits = (settings.number(name) for name in names)
                given = [value for value in limits if value is not None]
                if stated is not None or given:
                    return stated if stated is not None else sum(given) / len(given)
        return None

    def rack(self, gear: Component, row: dict[str, Any], name: str) -> None:
        """Set the basic rack and profile shift of a row from tip and root diameters, from the tool, or from ISO 53."""
        m_n, r, sign = row["m_n_mm"], pitch_radius(row), outward(gear)
        cut = row["x"] + sign * row["E_sn_um"] / (2e3 * m_n * math.tan(math.radians(row["alpha_n_deg"])))
        tool = next(iter(self.tools(gear)[::-1]), None)
        scale = ((tool and tool.number("normal_module", "mm")) or m_n) / m_n
        self._tool(gear, tool, row, name, scale)
        tip, root = (gear.number(f"{end}_diameter", "mm") for end in ("tip", "root"))
        if tip is not None and (addendum := sign * ((tip / 2 - r) / m_n - row["x"])) > -1:
            row["addendum"] = addendum
        # The stated root diameter is a nominal one.
        if root is not None and not ("dedendum" in row and abs(root_radius(gear, row) - root / 2) < NEAR * m_n):
            dedendum = sign * ((r - root / 2) / m_n + cut)
            if 0.5 < dedendum < 2:
                row["dedendum"] = dedendum
            else:
                self.assume(f"gear {name}: root by its tool", f"root_diameter = {root:g} mm of the file is not plausible")
        if "dedendum" not in row:
            row["dedendum"] = 1.25
            self.assume(f"gear {name}: dedendum 1.25", "the file states neither root diameter nor tool; ISO 53, profile A")

    def _tool(self, gear, tool, row, name, scale):
        if tool:
            radius = tool.number("tip_corner_radius_reference_profile", "mm") or tool.number("tip_corner_radius_cutter", "mm")
            for key, factor, length in (
                ("dedendum", "addendum_coefficient", tool.number("addendum_reference_profile", "mm")),
                ("rack_tip_radius", "tip_corner_radius_factor", radius),
            ):
                if (stated := tool.number(f"{factor}_reference_profile")) is not None:
                    row[key] = stated * scale
                elif length is not None:
                    row[key] = length / row["m_n_mm"]
        if "rack_tip_radius" not in row:
            row["rack_tip_radius"], source = (0.2, "usual for rings") if gear.type == "ring_gear" else (0.38, "ISO 53, profile A")
            self.assume(f"gear {name}: tip radius {row['rack_tip_radius']} of the tool", f"the file states no tool; {source}")
        if tool is not None and tool.type == "cutter_wheel_tool":
            teeth = tool.number("number_of_teeth")
            row |= {"z_cutter": int(teeth)} if teeth else {}
            if tool.number("addendum_modification_coefficient"):
                self.assume(f"gear {name}: cutter without profile shift", "gearfe has no shift of the cutter")

    def body(self, gear: Component, row: dict[str, Any], name: str) -> None:
        """Set the bore or rim of a row, as stated for the gear, its body or its shaft section."""
        inside = gear.type != "ring_gear"
        bodies = self.model.related("assembly", "assembly", gear.id, "part")
        own = [gear, *(one for one in bodies if one.type == "gear_body")]
        wanted = "inner_diameter" if inside else "outer_diameter"
        held = next((value for one in own if (value := one.number(wanted, "mm"))), None) or self._section(gear)
        root = 2 * root_radius(gear, row)
        if held is not None and (held < 0.97 * root if inside else held > 1.01 * root):
            row["r_bore_mm" if inside else "r_rim_mm"] = held / 2
            return
        guess = round(0.5 * root, 2) if inside else round(root + 7 * row["m_n_mm"], 2)
        row["r_bore_mm" if inside else "r_rim_mm"] = guess / 2
        why = "the file states none" if held is None else f"{held:g} mm of its shaft do not leave a rim"
        self.assume(f"gear {name}: held at a diameter of {guess:g} mm", f"{why}; the bore changes k by tens of percent")

    def _section(self, gear):
        """Outer diameter of the shaft at the middle of a gear [mm], or None if unknown."""
        at, begin = gear.number("u_coordinate_on_shaft", "mm"), 0.0
        for shaft in self.model.related("assembly", "part", gear.id, "assembly"):
            for part in self.model.related("assembly", "assembly", shaft.id, "part"):
                length = part.number("length", "mm")
                if part.type != "shaft_section" or length is None:
                    continue
                start = part.number("u_coordinate_on_shaft", "mm")
                begin = begin if start is None else start
                if at is not None and begin <= at <= begin + length:
                    return part.number("outer_diameter_begin", "mm")
                begin += length
        return None

    def material(self, gear: Component, name: str) -> str:
        """Return the name of the material of a gear, and add it to `materials`. The default is steel."""
        for one in self.model.related("reference", "origin", gear.id, "referenced"):
            elastic, poisson = one.number("elastic_modulus", "MPa"), one.number("poisson_ratio")
            if one.type == "material" and elastic is not None and poisson is not None:
                key = f"material_{one.id}"
                self.materials[key] = {"E_MPa": elastic, "nu": poisson}
                return key
        self.assume(f"gear {name}: steel, E = 206 GPa, nu = 0.3", "the file states no elastic constants")
        self.materials["steel"] = STEEL
        return "steel"

"""Stages of a REXS model as the tables of a scene."""

import math
import re
from typing import Any, NamedTuple

from .rexs_file import Component
from .rexs_flank import flank_row
from .rexs_gear import GEARS, GearReader, outward, pitch_radius
from .rexs_power import Power, PowerMesh
from .rexs_shifts import Shifts

PER_WIDTH = 100.0  # default force along the line of action per mm of face width [N]
POSITION = {
    "reference_component_for_position",
    "support_vector",
    "u_axis_vector",
    "w_axis_vector",
    "rotating_angle_around_neg_u_axis",
}


class PlanetSet(NamedTuple):
    """Gears of a planetary stage by scene name, its first planet, and the angles of all planets [degrees]."""

    sun: str
    planet: str
    ring: str
    first: Component
    angles: tuple[float, ...]


class GearUnit:
    """Stages of a REXS model and their tables of a scene."""

    def __init__(self, reader: GearReader, power: Power):
        self.reader, self.model, self.power = reader, reader.model, power
        self.rows: dict[str, dict[str, Any]] = {}
        self.gears: dict[str, Component] = {}
        self.pairs: dict[str, tuple[str, str, Component]] = {}
        self.meshes: list[PowerMesh] = []
        self.sets: list[PlanetSet] = []
        self.copies: set[int] = set()
        inside = set()
        for planetary in self.model.of_type("planetary_stage"):
            inside |= self._planetary(planetary)
        for number, stage in enumerate((one for one in self.model.of_type("cylindrical_stage") if one.id not in inside), 1):
            gears = [self._gear_of(stage, role) for role in ("gear_1", "gear_2")]
            if None not in gears:
                self._add_pair(f"stage_{number}", self._driver_first(stage, gears), stage)

    def _gear_of(self, stage, role):
        found = self.model.related("stage", "stage", stage.id, role)
        return found[0] if found and found[0].type in GEARS else None

    def _driver_first(self, stage, gears):
        """Order the gears of a stage with the pinion first: the driving gear, or the gear that is no ring."""
        for data in self.model.related("stage_gear_data", "stage", stage.id, "stage_gear_data"):
            if data.value("is_driving_gear") is True:
                driving = self.model.related("stage_gear_data", "stage_gear_data", data.id, "gear")
                gears = sorted(gears, key=lambda one: one.id not in [gear.id for gear in driving])
        return sorted(gears, key=lambda one: one.type == "ring_gear")

    def _planetary(self, planetary):
        """Return the pairs of the first planet of a planetary stage, and the ids of all its stages. Other planets are equal."""
        parts = self.model.related("assembly", "assembly", planetary.id, "part")
        stages = {one.id: one for one in parts if one.type == "cylindrical_stage"}
        carriers = [one.id for one in parts if one.type == "planet_carrier"]
        shafts = {one.id for one in self.model.related("planet_shaft", "planetary_stage", planetary.id, "shaft")}
        planets = len(shafts), carriers[0] if carriers else None
        tail = f"_{len(self.sets) + 1}" if len(self.model.of_type("planetary_stage")) > 1 else ""
        found: dict[str, list[tuple[Component, ...]]] = {"sun": [], "ring": []}
        for *gears, kind in self._planet_meshes(stages.values(), shafts):
            found[kind].append(tuple(gears))
        suns, rings = found.values()
        names = {one: f"{one}{tail}" for one in ("sun", "planet", "ring")}
        for stage, planet, sun in suns[:1]:
            self._add_pair(f"sun_planet{tail}", (sun, planet), stage, (names["sun"], names["planet"]), planets)
        for stage, planet, ring in rings[:1]:
            self._add_pair(f"planet_ring{tail}", (planet, ring), stage, (names["planet"], names["ring"]), planets)
        for _, planet, _ in suns[1:]:
            self._copy(planet, suns[0][1])
        self.copies |= stages.keys() - {stage.id for *_, stage in self.pairs.values()}
        if suns and rings:
            angles = [(stage.number("rotating_angle_around_neg_u_axis", "deg") or 0.0) % 360 for stage, *_ in suns]
            self.sets.append(PlanetSet(*names.values(), suns[0][1], tuple(sorted(angles))))
        return stages.keys()

    def _planet_meshes(self, stages, shafts):
        """Yield stage, planet, its mate, and whether the mate is the sun or the ring."""
        for stage in stages:
            gears = [gear for role in ("gear_1", "gear_2") if (gear := self._gear_of(stage, role)) is not None]
            planet = next((one for one in gears if self._shaft(one) in shafts), None)
            if planet is not None and len(gears) == 2:
                other = next(one for one in gears if one is not planet)
                yield stage, planet, other, "ring" if other.type == "ring_gear" else "sun"

    def _copy(self, planet, first):
        """Record that a planet is assumed equal to the first one."""
        flanks = [self.reader.flanks(gear) for gear in (planet, first)]
        self.copies |= {planet.id, *(flank.id for flank in flanks[0].values())}
        alike = [{key: value for key, value in gear.values.items() if key not in POSITION} for gear in (planet, first)]
        alike += [{side: flank.values for side, flank in each.items()} for each in flanks]
        if alike[0] != alike[1] or alike[2] != alike[3]:
            self.reader.assume(f"planet {planet.name or planet.id} equals {first.name or first.id}", "a scene has equal planets")

    def _shaft(self, gear):
        return next((one.id for one in self.model.related("assembly", "part", gear.id, "assembly") if one.type == "shaft"), None)

    def _add_pair(self, name, gears, stage, names=(None, None), planets=(1, None)):
        names = [self._named(gear, stated) for gear, stated in zip(gears, names, strict=True)]
        self.pairs[name] = (*names, stage)
        radii = []
        for gear, key in zip(gears, names, strict=True):
            row = self.rows[key]
            alpha_n, beta = (math.radians(row[key]) for key in ("alpha_n_deg", "beta_deg"))
            alpha_t = math.atan(math.tan(alpha_n) / math.cos(beta))
            radii.append(outward(gear) * pitch_radius(row) * math.cos(alpha_t))
        self.meshes.append(PowerMesh(name, tuple(gear.id for gear in gears), tuple(radii), *planets))

    def _named(self, gear, stated):
        """Return the name of a gear in the scene. At the first call its row is made."""
        for name, known in self.gears.items():
            if known is gear:
                return name
        own = re.sub(r"\W+", "_", re.sub(r"\[\d+\]", "", gear.name), flags=re.ASCII).strip("_").lower()
        name = stated or own or f"gear_{gear.id}"
        if name in self.gears and stated is None:
            name = f"{name}_{gear.id}"
        if name not in self.gears:
            self.gears[name] = gear
            self.rows[name] = self.reader.basic(gear, name)
        return name

    def tables(self) -> dict[str, Any]:
        """Tables of the scene: materials, gears, pairs, flanks, and a set and a machine if the model has one of each."""
        shifts = Shifts(self.reader, self.rows, self.gears, self.pairs)
        shifts.settle()
        for name, row in self.rows.items():
            gear = self.gears[name]
            row["E_sn_um"] = round(self.reader.allowance(gear, row, name), 6)
            self.reader.rack(gear, row, name)
        shifts.tips()
        for name, row in self.rows.items():
            self.reader.body(self.gears[name], row, name)
            row["material"] = self.reader.material(self.gears[name], name)
        forces = self.power.forces(self.meshes)
        pairs = {name: self._pair_row(name, forces, shifts.distance(stage, name)) for name, (*_, stage) in self.pairs.items()}
        flanks = {f"{name}_flank": {"gear": name} | row for name in self.rows if (row := self._flank(name))}
        rows = {
            name: {key: value for key, value in row.items() if not (key == "E_sn_um" and value == 0)}
            for name, row in self.rows.items()
        }
        out = {"material": self.reader.materials, "gear": rows, "pair": pairs, "flank": flanks}
        return {key: value for key, value in out.items() if value} | self._set() | self._machine(forces)

    def _pair_row(self, name, forces, a):
        one, two = self.pairs[name][:2]
        row: dict[str, Any] = {"gear_1": one, "gear_2": two}
        if a is not None:
            row["a_mm"] = a
        else:
            self.reader.assume(
                f"pair {name}: the centre distance without backlash", "the file states neither distance nor positions"
            )
        if name not in forces and (torque := self._stage_torque(name)):
            forces[name] = 1e3 * torque / self.meshes[list(self.pairs).index(name)].radii[0]
        if name in forces:
            row["force_N"] = round(forces[name], 6)
        else:
            width = min(self.rows[one]["b_mm"], self.rows[two]["b_mm"])
            row["force_N"] = PER_WIDTH * width
            self.reader.assume(
                f"pair {name}: {PER_WIDTH:g} N for each mm of width", "the loads of the file do not give its force"
            )
        return row

    def _stage_torque(self, name):
        """Return the torque of the driving gear that the file states for a stage [N m], or None if it states none."""
        one, _, stage = self.pairs[name]
        for data in self.model.related("stage_gear_data", "stage", stage.id, "stage_gear_data"):
            if self.gears[one] in self.model.related("stage_gear_data", "stage_gear_data", data.id, "gear"):
                return abs(data.number("torque", "N m") or 0.0)
        return None

    def _flank(self, name):
        side = None
        for data in self.model.related("stage_gear_data", "gear", self.gears[name].id, "stage_gear_data"):
            side = side or data.value("loaded_tooth_flank")
        return flank_row(self.reader, self.gears[name], self.rows[name], name, side)

    def _set(self):
        if len(self.sets) != 1:
            return {}
        one = self.sets[0]
        count = len(one.angles)
        even = all(abs(angle - 360 * i / count) < 1e-6 for i, angle in enumerate(one.angles))
        row: dict[str, Any] = {"n_planets": count} if even else {"planet_angles_deg": list(one.angles)}
        stiffness = self._pin(one.first)
        row |= {"sun": one.sun, "planet": one.planet, "ring": one.ring} | ({"pin_N_per_um": stiffness} if stiffness else {})
        return {"set": row}

    def _pin(self, planet):
        """Radial stiffness of the bearings of a planet [N/um], None if they are rigid or not stated."""
        total, shaft = 0.0, self._shaft(planet)
        for role in ("inner_part", "outer_part"):
            for bearing in self.model.related("side", role, shaft, "assembly"):
                total += bearing.number("radial_stiffness", "N / m") or 0.0
        return total * 1e-6 if 0 < total < 1e15 else None

    def _machine(self, forces):
        """Return a machine for a single pair or a single planetary stage, the cases that have a model."""
        name = next(iter(self.pairs))
        one = self.pairs[name][0]
        speed = self.power.speed_of(self.gears[one].id, self.meshes)
        if not speed or name not in forces or len(self.pairs) - len(self.sets) != 1:
            return {}
        if "planet_angles_deg" in self._set().get("set", {}):
            self.reader.assume("no [machine]", "the machine of a scene has equally spaced planets, and these are not")
            return {}
        mesh = self.meshes[0]
        row = {"model": "planetary" if self.sets else "helical_pair", "speed_rpm": abs(speed)}
        row["torque_Nm"] = round(1e-3 * forces[name] * mesh.radii[0] * mesh.planets, 9)
        return {"machine": row | ({"n_planets": mesh.planets} if self.sets else {})}

"""Torques and speeds of a REXS model: stated loads distributed over shafts, meshes and planetary stages."""

import math
from collections import Counter
from typing import NamedTuple

import numpy as np

from .rexs_file import Component, Model

COUPLED = ("coupling", "switchable_coupling")
KNOWN = 1e-9  # tolerance of the torque balance and of undetermined values


class PowerMesh(NamedTuple):
    """Mesh: both gears, their base radii [mm] (negative for a ring), and the number of equal meshes that share the force."""

    name: str
    gears: tuple[int, int]
    radii: tuple[float, float]
    planets: int = 1
    carrier: int | None = None  # component that carries the planets of this mesh


class Power:
    """Bodies of a model that rotate together, and the balance of their torques."""

    def __init__(self, model: Model, load_case: int):
        self.model = model
        case = model.cases[load_case - 1] if model.cases else {}
        self.values = {one.id: one.values | case.get(one.id, {}) for one in model.components.values()}
        self.body = {one.id: one.id for one in model.components.values()}
        for relation in model.relations:
            refs = relation.refs
            if relation.type == "assembly" and {"assembly", "part"} <= refs.keys():
                whole, part = model.components[refs["assembly"]], model.components[refs["part"]]
                if whole.type == "shaft" or (whole.type == "planet_carrier" and part.type == "side_plate"):
                    self._join(whole.id, part.id)
            elif relation.type == "side" and model.components.get(refs.get("assembly", -1), Component(0, "", "")).type in COUPLED:
                if {"inner_part", "outer_part"} <= refs.keys():
                    self._join(refs["inner_part"], refs["outer_part"])
            elif relation.type in ("planet_carrier_shaft", "planet_pin") and {"planetary_stage", "shaft"} <= refs.keys():
                self._join_carrier(relation)

    def _join_carrier(self, relation):
        for part in self.model.related("assembly", "assembly", relation.refs["planetary_stage"], "part"):
            if part.type == "planet_carrier":
                self._join(part.id, relation.refs["shaft"])

    def _root(self, one):
        while self.body[one] != one:
            one = self.body[one]
        return one

    def _join(self, one, other):
        self.body[self._root(one)] = self._root(other)

    def _number(self, component, name, unit):
        value, given = self.values[component].get(name, (None, "none"))
        right = isinstance(value, (int, float)) and not isinstance(value, bool) and given in (unit, "none")
        return float(value) if right and math.isfinite(value) else None

    def speeds(self) -> dict[int, float]:
        """Speeds that the file states, by body [rpm]."""
        out = {}
        for shaft in self.model.of_type("shaft"):
            value = self._number(shaft.id, "rotational_speed", "1 / min")
            if value is not None:
                out[self._root(shaft.id)] = value
        return out

    def speed_of(self, gear: int, meshes: list[PowerMesh]) -> float | None:
        """Return the speed of a gear [rpm] from meshes with fixed axes, or None if it is not determined."""
        known = self.speeds()
        for _ in meshes:
            for mesh in (mesh for mesh in meshes if mesh.carrier is None):
                roots, radii = [self._root(one) for one in mesh.gears], mesh.radii
                for here, there in ((0, 1), (1, 0)):
                    if roots[here] in known and roots[there] not in known:
                        known[roots[there]] = -known[roots[here]] * radii[here] / radii[there]
        return known.get(self._root(gear))

    def forces(self, meshes: list[PowerMesh]) -> dict[str, float]:
        """Force of each mesh along its transverse line of action [N], if it follows from the loads of the file."""
        stages = [mesh for mesh in meshes if mesh.carrier is not None]
        carriers = {self._root(mesh.carrier) for mesh in stages}
        busy = Counter(self._bodies(meshes))
        rows = {body: i for i, body in enumerate(sorted(carriers | busy.keys()))}
        right, free, loaded = self._loads(rows)
        ends = {body for body, count in busy.items() if count == 1}.difference(self._bodies(stages))
        free |= (ends | carriers) - loaded
        columns = [self._column(mesh, rows) for mesh in meshes]
        matrix = np.array([*columns, *(np.eye(len(rows))[rows[body]] for body in sorted(free))]).T
        if not right.any():
            return {}
        solution, _, rank, _ = np.linalg.lstsq(matrix, right, rcond=1e-12)
        if np.abs(matrix @ solution - right).max() > KNOWN * np.abs(right).max():
            return {}  # The stated torques are not in balance.
        unknown = (np.abs(np.linalg.svd(matrix)[2][rank:]) > KNOWN).any(axis=0)
        forces = dict(zip((mesh.name for mesh in meshes), np.where(unknown, 0.0, np.abs(solution)).tolist(), strict=False))
        return {name: force for name, force in forces.items() if force}

    def _bodies(self, meshes):
        return [self._root(gear) for mesh in meshes for gear in mesh.gears]

    def _column(self, mesh, rows):
        """Return the torques on the bodies per force of 1 N in a mesh [N mm]."""
        column = np.zeros(len(rows))
        for gear, radius in zip(mesh.gears, mesh.radii, strict=True):
            column[rows[self._root(gear)]] += mesh.planets * radius
        if mesh.carrier is not None:
            column[rows[self._root(mesh.carrier)]] -= mesh.planets * sum(mesh.radii)
        return column

    def _loads(self, rows):
        """Return the external loads [N mm] in the torque balance, bodies with unknown torque, and loaded bodies."""
        right, free = np.zeros(len(rows)), {body for body in rows if self._held(body)}
        loads = [(load.id, body) for load in self.model.of_type("external_load") if (body := self._root(load.id)) in rows]
        for load, body in loads:
            torque = self._torque(load, body)
            if torque is None:
                free.add(body)
            else:
                right[rows[body]] -= 1e3 * torque
        return right, free, {body for _, body in loads}

    def _held(self, body):
        return any(self._root(casing.id) == body for casing in self.model.of_type("gear_casing"))

    def _torque(self, load, body):
        """Torque of an external load [N m], or None if the file does not state it."""
        torque, power = self._number(load, "torque_around_u_axis", "N m"), self._number(load, "power", "kW")
        if torque is None and power is not None and (speed := self.speeds().get(body)):
            torque = 1e3 * power / (2 * math.pi * speed / 60)
        return torque

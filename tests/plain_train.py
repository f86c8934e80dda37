"""Matrices of the trains of `gearboxes` in plain numpy, written without the program's own assembly."""

import math

import numpy as np

Z, DENSITY, NU, E = np.array([0.0, 0.0, 1.0]), 7850.0, 0.3, 2.06e11


class Plain:
    """Matrices of a gearbox, six numbers per node (x, y, z, rotations about x, y, z), or one.

    `ahead` is the angle of the carrier.
    """

    def __init__(self, tables, ahead=0.0):
        self.t, self.six, self.ahead = tables, tables["machine"].get("dofs") == "six", ahead
        self.nodes, self.at, self.lone = {}, {}, {}
        for name, shaft in tables["shaft"].items():
            self.at[name] = sorted(set(self.places(name, shaft)))
            for x in self.at[name]:
                self.nodes[name, x] = len(self.nodes)
        planets = [f"planet{i + 1}" for stage in tables.get("stage", {}).values() for i in range(stage["n_planets"])]
        rotors = [name for name, end in self.ends() if "torsion_Nm_per_mrad" in end]
        size = 6 if self.six else 1
        n = len(self.nodes) * size
        for name in rotors + planets:
            self.lone[name], n = n, n + (size if name in planets else 1)
        self.K, self.C, self.G, self.M, self.f = (np.zeros((n, n)), np.zeros((n, n)), np.zeros((n, n)), np.zeros(n), np.zeros(n))
        self.meshes, self.pins = [], []
        self.speeds()

    def ends(self):
        return [("motor", self.t["motor"]), *self.t["load"].items()]

    def end_at(self, name, end):
        return end.get("at_mm", 0.0 if name == "motor" else sum(self.t["shaft"][end["shaft"]]["lengths_mm"]))

    def places(self, name, shaft):
        yield from (0.0, *np.cumsum(shaft["lengths_mm"]).tolist(), *shaft["gears_at_mm"], *shaft.get("bearings_at_mm", ()))
        yield from (self.end_at(key, end) for key, end in self.ends() if end["shaft"] == name)
        yield from (stage["carrier_at_mm"] for stage in self.t.get("stage", {}).values() if stage["carrier"] == name)

    def speeds(self):
        self.w = {"one": 1.0, "in": 1.0}
        z = {name: gear["z"] for name, gear in self.t["gear"].items()}
        if "fast" in self.t["pair"]:
            self.w["two"] = -z["a"] / z["b"]
        if "slow" in self.t["pair"]:
            self.w["three"] = -self.w["two"] * z["c"] / z["d"]
        if "stage" in self.t:
            self.w["three"] = self.w["two"]
            self.w["out"] = self.w["three"] * z["sun"] / (z["sun"] + z["ring"])
        if "left" in self.t["pair"]:
            self.w |= {"up": -z["a"] / z["b"], "down": -z["a"] / z["c"]}
        self.w = {name: ratio * self.t["machine"]["speed_rpm"] * math.pi / 30 for name, ratio in self.w.items()}

    def block(self, shaft, x):
        """Numbers of the unknowns of a node."""
        size = 6 if self.six else 1
        return np.arange(size) + size * self.nodes[shaft, x]

    def turn(self, shaft, x):
        return self.block(shaft, x)[-1]

    def disc(self, gear):
        """Mass, polar and diametral moment of inertia of a ring from bore to reference circle."""
        row = self.t["gear"][gear]
        outer, inner = 1e-3 * row["z"] * row["m_n_mm"] / math.cos(math.radians(row["beta_deg"])) / 2, 1e-3 * row["r_bore_mm"]
        mass = DENSITY * math.pi * (outer**2 - inner**2) * 1e-3 * row["b_mm"]
        polar = mass * (outer**2 + inner**2) / 2
        return mass, polar, polar / 2 + mass * (1e-3 * row["b_mm"]) ** 2 / 12

    def base(self, gear):
        row = self.t["gear"][gear]
        beta, alpha = math.radians(row["beta_deg"]), math.radians(20.0)
        alpha_t = math.atan(math.tan(alpha) / math.cos(beta))
        return 1e-3 * row["z"] * row["m_n_mm"] / math.cos(beta) / 2 * math.cos(alpha_t), alpha_t

    def put_mass(self, shaft, x, mass, polar, across):
        i = self.block(shaft, x)
        if not self.six:
            self.M[i] += polar
            return
        self.M[i] += [mass, mass, mass, across, across, polar]
        self.spin(i, polar * self.w[shaft])

    def spin(self, i, momentum):
        """A rotor with angular momentum H about z: its tilts (a, b) feel H b' and -H a'."""
        self.G[i[3], i[4]] += momentum
        self.G[i[4], i[3]] -= momentum

    def shafts(self):
        beta = self.t["machine"].get("damping_per_stiffness_s", 2e-6)
        for name, shaft in self.t["shaft"].items():
            ends = np.cumsum([0.0, *shaft["lengths_mm"]])
            bores = shaft.get("bores_mm", [0.0] * len(shaft["lengths_mm"]))
            for x, y in zip(self.at[name], self.at[name][1:], strict=False):
                if y - x < 1e-9:
                    continue
                part = int(np.searchsorted(ends, (x + y) / 2)) - 1
                d, bore, span = 1e-3 * shaft["diameters_mm"][part], 1e-3 * bores[part], 1e-3 * (y - x)
                K = element(d, bore, span, self.six)
                i = np.concatenate([self.block(name, x), self.block(name, y)])
                self.K[np.ix_(i, i)] += K
                self.C[np.ix_(i, i)] += beta * K
                area, second = math.pi / 4 * (d**2 - bore**2), math.pi / 64 * (d**4 - bore**4)
                half = DENSITY * area * span / 2
                for place in (x, y):
                    across = DENSITY * second * span / 2 + half * (span / 2) ** 2 / 3
                    self.put_mass(name, place, half, DENSITY * 2 * second * span / 2, across)
            for gear, x in zip(shaft["gears"], shaft["gears_at_mm"], strict=True):
                self.put_mass(name, x, *self.disc(gear))
            if self.six:
                axial = shaft.get("bearings_axial_N_per_um", [shaft["bearings_N_per_um"][0], 0.0, 0.0])
                for j, x in enumerate(shaft["bearings_at_mm"]):
                    i = self.block(name, x)[:3]
                    held = np.array([shaft["bearings_N_per_um"][j]] * 2 + [axial[j]])
                    self.K[i, i] += 1e6 * held
                    self.C[i, i] += np.where(held > 0, 1e3 * shaft["bearings_Ns_per_mm"][j], 0.0)

    def between(self, i, j, k, c):
        for matrix, value in ((self.K, k), (self.C, c)):
            matrix[[i, j], [i, j]] += value
            matrix[[i, j], [j, i]] -= value

    def joints(self):
        for row in self.t.get("coupling", {}).values():
            one, two = self.at[row["shaft_1"]][-1], self.at[row["shaft_2"]][0]
            self.between(
                self.turn(row["shaft_1"], one),
                self.turn(row["shaft_2"], two),
                1e3 * row["torsion_Nm_per_mrad"],
                row["damping_Nms_per_rad"],
            )
        for name, end in self.ends():
            held = self.turn(end["shaft"], self.end_at(name, end))
            free = self.lone.get(name, held)
            self.M[free] += end["inertia_kgm2"]
            if self.six and free == held:
                self.spin(self.block(end["shaft"], self.end_at(name, end)), end["inertia_kgm2"] * self.w[end["shaft"]])
            if free != held:
                self.between(free, held, 1e3 * end["torsion_Nm_per_mrad"], end["damping_Nms_per_rad"])
            self.C[free, free] += end.get("slope_Nms_per_rad", 0.0)
            self.f[free] += self.torque(name)

    def torque(self, name):
        """By hand: power of the motor goes to the loads."""
        run, end = self.t["machine"], dict(self.ends())[name]
        if name == "motor":
            return run["torque_Nm"]
        if "torque_Nm" in end:
            return -math.copysign(end["torque_Nm"], self.w[end["shaft"]])
        others = sum(abs(e["torque_Nm"] * self.w[e["shaft"]]) for key, e in self.t["load"].items() if "torque_Nm" in e)
        power = run["torque_Nm"] * run["speed_rpm"] * math.pi / 30 - others
        return -power / self.w[end["shaft"]]

    def home(self, gear):
        return next((name, s["gears_at_mm"][s["gears"].index(gear)]) for name, s in self.t["shaft"].items() if gear in s["gears"])

    def moved(self, shaft, x, n, arm):
        """Row of the displacement along n of the point at `arm` from the axis."""
        row = np.zeros(self.M.size)
        both = np.concatenate([n, np.cross(arm, n)])
        row[self.block(shaft, x)] = both if self.six else both[-1:]
        return row

    def tilted(self, shaft, x, n):
        row = np.zeros(self.M.size)
        row[self.block(shaft, x)[3:]] = n
        return row

    def parallel(self):
        inner = {stage[key] for stage in self.t.get("stage", {}).values() for key in ("sun_planet", "planet_ring")}
        for name, pair in self.t["pair"].items():
            if name in inner:
                continue
            (one, x), (two, y) = self.home(pair["gear_1"]), self.home(pair["gear_2"])
            (r1, alpha), (r2, _) = self.base(pair["gear_1"]), self.base(pair["gear_2"])
            phi, sense = math.radians(pair.get("angle_deg", 0.0)), math.copysign(1.0, self.w[one])
            e = np.array([math.cos(phi), math.sin(phi), 0.0])
            beta = math.radians(self.t["gear"][pair["gear_1"]]["beta_deg"])
            beta_b = math.asin(math.sin(beta) * math.cos(math.radians(20.0)))
            # the flanks of a right-hand driver that turns counter-clockwise push their mates backwards
            n = sense * math.cos(alpha) * np.cross(Z, e) + math.sin(alpha) * e - sense * math.tan(beta_b) * Z
            g = self.moved(one, x, n, r1 / math.cos(alpha) * e) - self.moved(two, y, n, -r2 / math.cos(alpha) * e)
            rate = abs(self.w[one]) / (2 * math.pi) * self.t["gear"][pair["gear_1"]]["z"]
            self.meshes.append((name, name, g, rate))

    def planets(self):
        for stage in () if self.six else self.t.get("stage", {}).values():
            a, (sun, x) = 52e-3, self.home("sun")
            carrier = self.turn(stage["carrier"], stage["carrier_at_mm"])
            mass, polar, _ = self.disc("planet")
            self.M[carrier] += stage["carrier_inertia_kgm2"] + stage["n_planets"] * mass * a**2
            r = {gear: self.base(gear)[0] for gear in ("sun", "planet", "ring")}
            sense = math.copysign(1.0, self.w[sun])  # the sun drives
            rate = abs(self.w[sun] - self.w[stage["carrier"]]) / (2 * math.pi) * self.t["gear"]["sun"]["z"]
            for i in range(stage["n_planets"]):
                own = self.lone[f"planet{i + 1}"]
                self.M[own] += polar
                psi = 2 * math.pi * i / stage["n_planets"]
                e = np.array([math.cos(psi), math.sin(psi), 0.0])
                t = np.cross(Z, e)
                for kind, alpha, way in (
                    ("outer", math.acos((r["sun"] + r["planet"]) / a), sense),
                    ("inner", math.acos((r["ring"] - r["planet"]) / a), -sense),
                ):
                    n = way * math.cos(alpha) * t + math.sin(alpha) * e
                    g, lever = np.zeros(self.M.size), r["planet"] / math.cos(alpha)
                    to_planet = np.cross(-lever * e if kind == "outer" else lever * e, n)[2]
                    push = -1.0 if kind == "outer" else 1.0  # the planet is gear 2 of the sun, gear 1 of the ring
                    g[carrier] += push * a * (t @ n)
                    g[own] += push * to_planet
                    if kind == "outer":
                        g[self.turn(sun, x)] += np.cross((a - lever) * e, n)[2]
                    self.meshes.append((f"{kind}{i + 1}", kind, g, rate))

    def planets_in_space(self):
        for stage in self.t.get("stage", {}).values() if self.six else ():
            z, (sun, x) = {name: gear["z"] for name, gear in self.t["gear"].items()}, self.home("sun")
            r, alpha = {gear: self.base(gear)[0] for gear in ("sun", "planet", "ring")}, self.base("sun")[1]
            a, c, at = (r["sun"] + r["planet"]) / math.cos(alpha), stage["carrier"], stage["carrier_at_mm"]
            mass, polar, across = self.disc("planet")
            self.put_mass(c, at, stage["carrier_mass_kg"], stage["carrier_inertia_kgm2"], stage["carrier_inertia_kgm2"] / 2)
            sense, turning = math.copysign(1.0, self.w[sun]), self.w[sun] - self.w[c]
            beta_b = math.asin(math.sin(math.radians(self.t["gear"]["sun"]["beta_deg"])) * math.cos(math.radians(20.0)))
            for i in range(stage["n_planets"]):
                own = self.lone[f"planet{i + 1}"] + np.arange(6)
                self.M[own] += [mass, mass, mass, across, across, polar]
                self.spin(own, polar * (self.w[c] - turning * z["sun"] / z["planet"]))
                psi = sense * 2 * math.pi * i / stage["n_planets"] + self.ahead
                e = np.array([math.cos(psi), math.sin(psi), 0.0])
                along = np.array([e, np.cross(Z, e), Z])  # a pin turns with the carrier
                pins = [1e6 * stage["pin_N_per_um"]] * 2 + [1e6 * stage["pin_axial_N_per_um"]]
                pins += [1e3 * stage["pin_tilt_Nm_per_mrad"]] * 2
                for j, k in enumerate(pins):
                    n, row = along[j % 3], np.zeros(self.M.size)
                    row[own[3 * (j // 3) :][:3]] = n
                    row -= self.moved(c, at, n, a * e) if j < 3 else self.tilted(c, at, n)
                    self.pins.append((row, k, 0.04 * math.sqrt(k * self.M[own[j]])))
                for kind, way, tip in (("outer", sense, -1), ("inner", -sense, 1)):
                    # the planet has the other hand than the sun, and it pushes where the sun is pushed
                    n = way * math.cos(alpha) * np.cross(Z, e) + math.sin(alpha) * e - sense * math.tan(beta_b) * Z
                    g, arm = np.zeros(self.M.size), tip * r["planet"] / math.cos(alpha) * e
                    g[own] += tip * np.concatenate([n, np.cross(arm, n)])
                    if kind == "outer":
                        g += self.moved(sun, x, n, r["sun"] / math.cos(alpha) * e)
                    rate = abs(turning) / (2 * math.pi) * z["sun"]
                    self.meshes.append((f"{kind}{i + 1}", kind, g, rate))

    def build(self):
        self.shafts(), self.joints(), self.parallel(), self.planets(), self.planets_in_space()
        self.K += sum(k * np.outer(row, row) for row, k, _ in self.pins)
        self.C += sum(c * np.outer(row, row) for row, _, c in self.pins)
        return self


def element(d, bore, span, six):
    """Timoshenko beam of two nodes, J. S. Przemieniecki (1968), eq. 5.116, with Cowper's factor; torsion alone if not `six`."""
    area, second = math.pi / 4 * (d**2 - bore**2), math.pi / 64 * (d**4 - bore**4)
    G = E / (2 * (1 + NU))
    twist = G * 2 * second / span
    if not six:
        return twist * np.array([[1.0, -1.0], [-1.0, 1.0]])
    m = (bore / d) ** 2
    factor = 6 * (1 + NU) * (1 + m) ** 2 / ((7 + 6 * NU) * (1 + m) ** 2 + (20 + 12 * NU) * m)
    phi = 12 * E * second / (factor * G * area * span**2)
    b, c = E * second / (span**3 * (1 + phi)), span
    plane = b * np.array([
        [12, 6 * c, -12, 6 * c], [6 * c, (4 + phi) * c**2, -6 * c, (2 - phi) * c**2],
        [-12, -6 * c, 12, -6 * c], [6 * c, (2 - phi) * c**2, -6 * c, (4 + phi) * c**2],
    ])  # fmt: skip
    K = np.zeros((12, 12))
    for at, sign in (([0, 4, 6, 10], 1.0), ([1, 3, 7, 9], -1.0)):  # the slope dy/dz is minus the rotation about x
        S = np.diag([1.0, sign, 1.0, sign])
        K[np.ix_(at, at)] += S @ plane @ S
    for at, k in (([2, 8], E * area / span), ([5, 11], twist)):
        K[np.ix_(at, at)] += k * np.array([[1.0, -1.0], [-1.0, 1.0]])
    return K

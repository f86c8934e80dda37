"""Profile shifts and addenda of the gears of a REXS model that the file does not state, or states with another sign."""

import math
from typing import Any

from .rexs_file import Component
from .rexs_gear import GearReader, outward, pitch_radius, root_radius

CLEARANCE = 0.25  # bottom clearance [m_n], ISO 53, profile A


class Shifts:
    """Rows of gears by name, to be completed with shifts and addenda, and pairs as ``(gear, gear, stage)``."""

    def __init__(self, reader: GearReader, rows: dict[str, dict[str, Any]], gears: dict[str, Component], pairs: dict[str, tuple]):
        self.reader, self.rows, self.gears, self.pairs = reader, rows, gears, pairs

    def _outward(self, name):
        return outward(self.gears[name])

    def distance(self, stage, name):
        """Centre distance of a stage [mm], as stated or from the positions of both gears, or None if unknown."""
        stated = stage.number("center_distance", "mm")
        if stated is not None:
            return stated
        places = [gear.value("support_vector", "mm") for gear in (self.gears[one] for one in self.pairs[name][:2])]
        if all(isinstance(place, list) and len(place) == 3 for place in places):
            return math.dist(places[0][1:], places[1][1:])
        return None

    def settle(self):
        """Complete the profile shifts: stated values, or values without backlash at the centre distance."""
        stated = {name: self.reader.shift(self.gears[name], row["m_n_mm"]) for name, row in self.rows.items()}
        for name, row in self.rows.items():
            if stated[name] is not None:
                row["x"] = stated[name]
        for _ in range(2):
            for name, (one, two, _stage) in self.pairs.items():
                sum_x, sign = self._sum(name), self._outward(two)
                if sum_x is None:
                    continue
                if "x" in self.rows[one] and "x" not in self.rows[two]:
                    self.rows[two]["x"] = round(sign * (sum_x - self.rows[one]["x"]), 9)
                elif "x" in self.rows[two] and "x" not in self.rows[one]:
                    self.rows[one]["x"] = round(sum_x - sign * self.rows[two]["x"], 9)
                else:
                    continue
                self.reader.assume(
                    f"pair {name}: profile shift from the centre distance", "the file states that of one gear only"
                )
        for name, row in self.rows.items():
            if "x" not in row:
                row["x"] = 0.0
                self.reader.assume(
                    f"gear {name}: no profile shift", "the file states none, and no centre distance from which it follows"
                )
        self._ring_signs(stated)

    def _ring_signs(self, stated):
        """Choose the sign of a ring's profile shift that matches the stated centre distance, because files use either sign."""
        for name, (one, two, _stage) in self.pairs.items():
            x, sum_x = self.rows[two]["x"], self._sum(name)
            if self._outward(two) > 0 or not stated.get(two) or sum_x is None:
                continue
            wanted = self.rows[one]["x"] - sum_x
            self.rows[two]["x"] = min((x, -x), key=lambda value: abs(value - wanted))
            self.reader.assume(f"gear {two}: x = {self.rows[two]['x']:g}", "the sign with which the centre distance closes")

    def _sum(self, name):
        """Sum of the profile shifts that follows from the centre distance of a pair, or None if unknown."""
        one, two, stage = self.pairs[name]
        a = self.distance(stage, name)
        first, second, sign = self.rows[one], self.rows[two], self._outward(two)
        beta, alpha = (math.radians(first[key]) for key in ("beta_deg", "alpha_n_deg"))
        alpha_t = math.atan(math.tan(alpha) / math.cos(beta))
        teeth = first["z"] + sign * second["z"]
        cosine = abs(teeth) * first["m_n_mm"] / math.cos(beta) / 2 * math.cos(alpha_t) / a if a else 2.0
        if cosine >= 1:
            return None
        alpha_w = math.acos(cosine)
        return (math.tan(alpha_w) - alpha_w - math.tan(alpha_t) + alpha_t) * teeth / (2 * math.tan(alpha))

    def tips(self):
        """Set the addenda of gears without tip diameter to 1, or less for a tip clearance of `CLEARANCE`."""
        for name, row in self.rows.items():
            if "addendum" in row:
                continue
            row["addendum"] = 1.0
            for pair, (one, two, stage) in self.pairs.items():
                if name in (one, two):
                    mate, a = two if name == one else one, self.distance(stage, pair)
                    row["addendum"] = min(row["addendum"], self._room(name, mate, a) if a else 1.0)
            row["addendum"] = round(row["addendum"], 6)
            self.reader.assume(
                f"gear {name}: addendum {row['addendum']:g}",
                f"the file states no tip diameter; ISO 53, profile A, with clearance {CLEARANCE}",
            )

    def _room(self, name, mate, a):
        """Return the addendum for which the tip clearance to the root of the mate is `CLEARANCE`."""
        row, own, other = self.rows[name], self._outward(name), self._outward(mate)
        mate_root = root_radius(self.gears[mate], self.rows[mate])
        tip = other * a - own * other * mate_root - own * CLEARANCE * row["m_n_mm"]
        return own * ((tip - pitch_radius(row)) / row["m_n_mm"] - row["x"])

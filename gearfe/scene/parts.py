"""Damage, flanks, misalignment and supports of a gear pair, from the checked rows of a scene."""

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any, NamedTuple

from ..core.supports.shaft import Shaft
from ..core.supports.support import Support
from ..geometry.damage.chip import Chip
from ..geometry.damage.crack import Crack
from ..geometry.damage.kinds import Damage, check_damage
from ..geometry.damage.missing import MissingTooth
from ..geometry.damage.pit import pit_row
from ..geometry.damage.spall import Spall
from ..geometry.pair.flanks import Misalignment, tilt_of
from ..geometry.pair.gear_pair import GearPair
from ..geometry.pair.pit_lines import in_both_halves, pit_line
from ..geometry.tooth.modified import Flank
from .reading import check_known, located
from .schema import arguments

Row = dict[str, Any]
SIDES = ("pinion", "wheel")
HELD = ("support", "shaft")


def sides(file: str, where: str, row: Row, name: str, pairs: dict[str, Row]) -> list[str]:
    """Return the sides of the pair `name` that have the gear of a row. A row with a `pair` applies to this pair only.

    A planet meets the sun with one flank, the ring with the other.
    """
    keys = ("gear_1", "gear_2")
    only = row.get("pair")
    if only is not None and row["gear"] not in (pairs[only][key] for key in keys):
        raise ValueError(f"{file} [{where}] pair = {only!r} has no gear {row['gear']!r}")
    return [side for side, key in zip(SIDES, keys, strict=True) if pairs[name][key] == row["gear"] and only in (None, name)]


class Owner(NamedTuple):
    """Owner of the damaged tooth: a `body` of the machine, or by default the one on `side` of the pair `home`."""

    body: str | None
    home: str
    side: str


Owned = dict[Owner, list[Damage]]


def damage_of(file: str, rows: Row, name: str, pair: GearPair) -> dict[str, dict[str, Owned]]:
    """Return the damage of the pair `name` by case, side and owner.

    The damage is on the flank that is loaded in its `pair`, by default the first pair of its gear. In a pair that loads the
    other flank, a crack or a chip is on the unloaded side, and pits and spalls have no contact. A missing tooth is missing in
    both.
    """
    out: dict[str, dict[str, Owned]] = {}
    for kind, make in DAMAGE.items():
        for i, row in enumerate(rows[kind]):
            where = f"{kind} {i + 1}"
            home, first = next(
                (other, found[0]) for other in rows["pair"] if (found := sides(file, where, row, other, rows["pair"]))
            )
            for side in sides(file, where, row, name, rows["pair"]):
                with located(file, where, row):
                    made = make(row, pair, SIDES.index(side), rows["pair"][name])
                    check_damage(pair.gears[SIDES.index(side)], made)
                if side != first:
                    turned = [replace(one, side="unloaded") for one in made if isinstance(one, (Crack, Chip))]
                    made = [*turned, *(one for one in made if isinstance(one, MissingTooth))]
                if made and not (name == home and side != first):
                    owner = Owner(row.get("body"), home, first)
                    out.setdefault(row["case"], {}).setdefault(side, {}).setdefault(owner, []).extend(made)
    return out


def crack_of(row: Row, made: GearPair, which: int, pair: Row) -> list[Damage]:
    """Return the crack of a row."""
    given = arguments("crack", row)
    if path := given.get("path"):
        if len(path) % 2:
            raise ValueError(f"path_mm = {list(path)}, but corners have two numbers each: x, y [mm]")
        given["path"] = tuple(zip(path[::2], path[1::2], strict=True))
    return [Crack(**given)]


def pits_of(row: Row, made: GearPair, which: int, pair: Row) -> list[Damage]:
    """Return the pits of a row on pinion (`which` 0) or wheel (1) of the pair `made`, which the row `pair` describes.

    A row along the axis may be given by the heights of its first and last pit, and may then extend over both halves of a
    herringbone gear. Any row may be given by the height of its middle, with the pitch of the pits or the span of the row.
    """
    first, last, middle, pitch, span = (row[f"{key}_mm"] for key in ("first", "last", "middle", "pitch", "span"))
    numbers = arguments("pits", row, "radius_mm", "axes_mm", "depth_mm", "tooth", "angle_deg")
    if first is not None:
        if row["along"] != "axis":
            raise ValueError("first_mm and last_mm apply to pits along the axis only: for others give middle_mm")
        pits = pit_row(row["count"], first, first if last is None else last, **numbers)
        return [*pits, *_other_half(row, pits, made, which, pair)]
    if row["count"] > 1 and pitch is None and span is None:
        raise ValueError(
            f"{row['count']} pits about middle_mm: give pitch_mm, from one to the next, or span_mm, from first to last"
        )
    pitch = pitch if span is None else span / max(row["count"] - 1, 1)
    options = {"face": _face(made, pair), "groove": pair["groove_mm"], "both": row["both_halves"], "mirrored": row["mirrored"]}
    pits = pit_line(made, which, row["along"], row["count"], pitch, middle=middle, **options, **numbers)
    heights, width = [pit.z for pit in pits], made.gears[which].b
    if min(heights) < 0 or max(heights) > width:
        raise ValueError(
            f"count = {row['count']}, middle_mm = {middle:g}, pitch_mm = {pitch or 0:g}, span_mm = {span or 0:g}: centres of the "
            f"pits lie from {min(heights):.4g} to {max(heights):.4g} mm of a face of {width:g} mm; give a smaller pitch or fewer"
        )
    return pits


def spall_of(row: Row, made: GearPair, which: int, pair: Row) -> list[Damage]:
    """Return the spall of a row and, on request, its mirror image in the other half of a herringbone gear."""
    spall = Spall(**arguments("spall", row, "radius_mm", "z_mm", "sides_mm", "depth_mm", "corner_mm", "tooth"))
    return [spall, *_other_half(row, [spall], made, which, pair)]


def missing_of(row: Row, made: GearPair, which: int, pair: Row) -> list[Damage]:
    """Return the missing tooth of a row."""
    return [MissingTooth(tooth=row["tooth"])]


def chip_of(row: Row, made: GearPair, which: int, pair: Row) -> list[Damage]:
    """Return the chip of a row."""
    return [Chip(**arguments("chip", row))]


def _other_half(row, damage, made, which, pair):
    return in_both_halves(made.gears[which], damage, _face(made, pair)) if row["both_halves"] else []


def _face(made, pair):
    return pair["face"] or ("helical" if made.gear_1.beta else "spur")


HEALTHY = "healthy"  # name of the case without damage
DAMAGE: dict[str, Callable[[Row, GearPair, int, Row], list[Damage]]] = {
    "crack": crack_of, "pits": pits_of, "spall": spall_of, "missing_tooth": missing_of, "chip": chip_of,
}  # fmt: skip


def with_backlash(pair: GearPair, wanted: float) -> GearPair:
    """Return the pair with a backlash along the line of action [mm]: both gears are thinner by the same normal thickness."""
    more = wanted - pair.backlash
    if more < -1e-6 * pair.gear_1.m_n:
        raise ValueError(
            f"backlash_um = {1e3 * wanted:g}, but these gears have {1e3 * pair.backlash:.4g} um at a_mm = {pair.a:.6g}: give "
            "more, or leave it out"
        )
    if more > pair.gear_1.m_n:
        raise ValueError(
            f"backlash_um = {1e3 * wanted:g}, but teeth of m_n_mm = {pair.gear_1.m_n:g} have less: give a smaller one"
        )
    thinner = more * math.cos(pair.gear_1.beta) / (2 * math.cos(pair.gear_1.alpha_t))
    one, two = (replace(gear, E_sn=gear.E_sn - thinner) for gear in pair.gears)
    return GearPair(one, two, pair.a)


def flanks_of(file: str, rows: Row, name: str, gears: dict[str, Any]) -> dict[str, dict[str | None, Flank]]:
    """Return the flanks of the pair `name` by side and body. The key None means each body that no flank names."""
    out: dict[str, dict[str | None, Flank]] = {}
    for body in dict.fromkeys(row["body"] for row in rows["flank"].values()):
        own: dict[str, Flank] = {}
        mine = rows | {"flank": {key: row for key, row in rows["flank"].items() if row["body"] == body}}
        for where, row, side in _placed(file, mine, name, ("flank",), own):
            with located(file, where, row):
                own[side] = _flank(row, gears[row["gear"]])
        for side, flank in own.items():
            out.setdefault(side, {})[body] = flank
    return out


def misalignment_of(pair: GearPair, row: Row) -> Misalignment | None:
    """Return the misalignment of a pair from its row, or None if the row has none."""
    amounts = ("F_beta_x_um", "f_sigma_beta_um", "f_sigma_delta_um")
    if not any(row[amount] for amount in amounts):
        return None
    misalignment = Misalignment(**arguments("pair", row, *amounts, "bearing_span_mm"))
    tilt_of(pair, misalignment)
    return misalignment


def supports_of(file: str, rows: Row, name: str, materials: dict[str, Any]) -> dict[str, Support | Shaft]:
    """Return the supports of the pair `name` by side."""
    out: dict[str, Support | Shaft] = {}
    there = dict.fromkeys(row[side] for row in rows["pair"].values() for side in ("gear_1", "gear_2"))
    for where, row in ((f"{kind}.{key}", row) for kind in HELD for key, row in rows[kind].items() if row["gear"]):
        check_known(file, where, "gear", row["gear"], there, "gear in a pair")
    for where, row, side in _placed(file, rows, name, HELD, out):
        with located(file, where, row):
            out[side] = _shaft(row, materials) if where.startswith("shaft") else Support(**arguments("support", row))
    return {side: out[side] for side in SIDES if side in out}


def _placed(file: str, rows: Row, name: str, kinds: tuple[str, ...], out: dict[str, Any]) -> Iterator[tuple[str, Row, str]]:
    """Return place, row and side of all tables of these kinds in the pair `name`. Each side may have only one."""
    for where, row in ((f"{kind}.{key}", row) for kind in kinds for key, row in rows[kind].items()):
        for side in sides(file, where, row, name, rows["pair"]):
            if side in out:
                raise ValueError(
                    f"{file} [{where}]: gear {row['gear']!r} has two tables ({' or '.join(kinds)}) in pair {name!r}; "
                    "give each of them the key pair"
                )
            yield where, row, side


def _shaft(row, materials):
    columns = [row[key] for key in ("lengths_mm", "diameters_mm", "bores_mm") if row[key] is not None]
    if len({len(column) for column in columns}) > 1:
        raise ValueError(
            f"shaft of {len(columns[0])} lengths: give as many diameters_mm, and bores_mm (0: none) if there are any"
        )
    if row["bearings_at_mm"] is None:
        raise ValueError("missing key 'bearings_at_mm'; expected two numbers in mm")
    names = ("bearings_at_mm", "gear_at_mm", "torque_at_mm", "integral", "bearings_N_per_um")
    return Shaft(
        segments=list(zip(*columns, strict=True)), material=materials[row["material"]], **arguments("shaft", row, *names)
    )


def _flank(row, gear):
    fields, whole = arguments("flank", row), abs(gear.roll_a - gear.roll_f)
    for end, roll, sense in (("tip", gear.roll_a, -1), ("root", gear.roll_f, 1)):
        length = fields.pop(f"{end}_start_length", None)
        if length is None:
            continue
        if not length < whole:
            raise ValueError(
                f"{end}_start_length_mm = {length}, but the flank is {whole:.4g} mm long in roll length: give a smaller value"
            )
        fields[f"{end}_start_roll"] = roll + sense * gear.outward * length
    for name, amounts in (("table", "table_removed"), ("wear", "wear")):
        if f"{name}_roll" in fields:
            fields[name] = fields.pop(f"{name}_roll"), fields.pop(amounts)
    flank = Flank(**fields)
    flank.on(gear)
    return flank


def of_one_body(by_side: dict[str, Owned]) -> dict[str, list[Damage]]:
    """Return the damage by side of the first named body. The other bodies are left out, since a pair has one per side.

    In a pair of two equal planets, damage without a body belongs to the first of them alone.
    """
    out: dict[str, list[Damage]] = {}
    taken: set[Owner] = set()
    for side, owned in by_side.items():
        found = {owner: damage for owner, damage in owned.items() if owner not in taken}
        taken |= found.keys()
        first = next(iter(found), None)
        if mine := [one for owner, damage in found.items() if first and owner.body == first.body for one in damage]:
            out[side] = mine
    return out


def other_bodies(by_side: dict[str, Owned]) -> list[str]:
    """Return the names of the bodies whose damage `of_one_body` leaves out."""
    kept = {next(iter(owned)).body for owned in by_side.values()}
    every = dict.fromkeys(owner.body for owned in by_side.values() for owner in owned)
    return [body or "the first planet" for body in every if body not in kept]


def cases_of(file, rows):
    """Return the rows of damage by kind and case. ValueError for a case that is named like healthy gears."""
    cases: dict[str, dict[str, list[Row]]] = {kind: {} for kind in DAMAGE}
    for kind, by_case in cases.items():
        for row in rows[kind]:
            if row["case"] in ("", HEALTHY):
                raise ValueError(f"{file} [{kind}] case = {row['case']!r}: this names gears without damage; give another name")
            by_case.setdefault(row["case"], []).append(row)
    return cases

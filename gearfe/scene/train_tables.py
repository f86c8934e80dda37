"""Reader of the tables of a gearbox: ``[shaft.NAME]``, ``[motor]``, ``[load.NAME]``, ``[coupling.NAME]``, ``[stage.NAME]``."""

import math
from dataclasses import replace

import numpy as np

from ..core.material import Material
from ..core.supports.beam import ShaftPiece
from ..geometry.tooth.gear import Gear
from .power_flow import Link, speeds_of, torques_of
from .reading import check_known
from .train import Row, Train, TrainShaft, TrainStage

ALONE = ("bearing", "motor", "load", "coupling", "stage")  # tables that only gearbox scenes have
HOLDING = ("bearings_N_per_um", "bearings_axial_N_per_um", "bearings_Ns_per_mm", "bearings")  # entries of each bearing
PART = 1e-9  # Smaller lengths, relative to the whole, count as zero.


def train_of(file: str, rows: Row, gears: dict[str, Gear], materials: dict[str, Material]) -> Train | None:
    """Return the `Train` of the checked `rows` of a scene, or None if its machine is not a gearbox.

    Raises
    ------
    ValueError
        If tables of a gearbox stand in another scene, or the train is incomplete, contradictory, closed to a loop, or driven
        against the order of the gears in a pair.
    """
    shafts = {name: row for name, row in rows["shaft"].items() if row["gears"] is not None}
    if not _is_gearbox(file, rows, shafts):
        return None
    made = {name: _shaft(file, name, row, rows, materials) for name, row in shafts.items()}
    homes = _homes(file, made)
    ends = {"motor": rows["motor"]} | rows["load"]
    for name, row in ends.items():
        _on(file, name if name == "motor" else f"load.{name}", "shaft", row["shaft"], row["at_mm"], made)
    stages = {name: _stage(file, name, rows, gears, homes, made) for name in rows["stage"]}
    inner = {pair for stage in stages.values() for pair in stage.pairs}
    pairs = {
        name: (row["gear_1"], row["gear_2"], math.radians(row["angle_deg"]))
        for name, row in rows["pair"].items()
        if name not in inner
    }
    links = _links(file, rows, gears, (made, homes, stages, pairs))
    speeds, links = speeds_of(file, links, rows["motor"]["shaft"], rows["machine"]["speed_rpm"] * math.pi / 30)
    if lost := [name for name in made if name not in speeds]:
        raise ValueError(f"{file} [shaft.{lost[0]}]: no pair, coupling or stage connects it with the motor")
    torques = torques_of(file, links, ends, speeds, rows["machine"]["torque_Nm"])
    out = Train(made, ends, rows["coupling"], stages, pairs, homes, links, speeds, torques)
    out.forces.update(_forces(file, out, rows, gears))
    return out


def _is_gearbox(file, rows, shafts):
    if (rows["machine"] or {}).get("model") != "gearbox":
        for kind in [*(kind for kind in ALONE if rows[kind]), *(["shaft"] if shafts else [])]:
            raise ValueError(f"{file} [{kind}]: this belongs to a gearbox: give [machine] model = 'gearbox'")
        return False
    for kind, there in {"shaft.NAME": shafts, "motor": rows["motor"], "load.NAME": rows["load"]}.items():
        if not there:
            raise ValueError(f"{file}: no table [{kind}], but a gearbox needs shafts with gears, a motor and a load")
    if "motor" in rows["load"]:
        raise ValueError(f"{file} [load.motor]: this name is the motor's; give the load another")
    return True


def _homes(file, shafts):
    """Return the shaft of each gear."""
    homes: dict[str, str] = {}
    for name, shaft in shafts.items():
        for gear in shaft.gears:
            if gear in homes:
                raise ValueError(
                    f"{file} [shaft.{name}] gears: {gear!r} is on [shaft.{homes[gear]}] already; give only one of them"
                )
            homes[gear] = name
    return homes


def _shaft(file, name, row, rows, materials):
    where, columns = f"shaft.{name}", [row[key] for key in ("lengths_mm", "diameters_mm", "bores_mm") if row[key] is not None]
    counts = {"diameters_mm": len(columns[0]), "bores_mm": len(columns[0])}
    counts |= {"gears_at_mm": len(row["gears"]), "gears_turned_deg": len(row["gears"])}
    counts |= dict.fromkeys(HOLDING, len(row["bearings_at_mm"] or ()))
    for key, count in counts.items():
        if row[key] is not None and len(row[key]) != count:
            raise ValueError(f"{file} [{where}] {key} = {row[key]}: give {count} entries, one for each section, gear or bearing")
    made = TrainShaft(
        tuple(ShaftPiece(*section) for section in zip(*columns, strict=True)),
        materials[row["material"]],
        dict(zip(row["gears"], row["gears_at_mm"], strict=True)),
        dict(zip(row["gears"], map(math.radians, row["gears_turned_deg"] or [0.0] * len(row["gears"])), strict=True)),
    )
    for section in made.sections:
        if not section.bore < section.diameter:
            raise ValueError(f"{file} [{where}] bores_mm = {row['bores_mm']}: give bores smaller than the diameters")
    places = sorted(row["gears_at_mm"])
    if min(np.diff(places), default=1.0) <= PART * made.length:
        raise ValueError(
            f"{file} [{where}] gears_at_mm = {row['gears_at_mm']}, lengths_mm = {row['lengths_mm']}: give each gear a different "
            "position"
        )
    for at in places:
        _along(file, where, "gears_at_mm", at, made)
    return _held(file, where, row, rows, made) if row["bearings_at_mm"] is not None else made


def _held(file, where, row, rows, made):
    """Return the shaft `made` with the bearings of its row."""
    for at in row["bearings_at_mm"]:
        _along(file, where, "bearings_at_mm", at, made)
    radial = tuple(1e6 * k for k in row["bearings_N_per_um"] or ())
    axial = tuple(1e6 * k for k in row["bearings_axial_N_per_um"] or ()) or (*radial[:1], *(0.0 for _ in radial[1:]))
    damping = tuple(1e3 * c for c in row["bearings_Ns_per_mm"] or ())
    kinds = {kind: rows["bearing"][kind] for kind in row["bearings"] or ()}
    return replace(made, bearings=tuple(row["bearings_at_mm"]), radial=radial, axial=axial, damping=damping, kinds=kinds)


def _on(file, where, key, name, at, shafts):
    """Raise ValueError unless a key names a shaft of the gearbox, and a position [mm] lies on this shaft."""
    check_known(file, where, key, name, shafts, "shaft of the gearbox")
    _along(file, where, "carrier_at_mm" if key == "carrier" else "at_mm", at, shafts[name])


def _along(file, where, key, at, shaft):
    if at is not None and not 0 <= at <= shaft.length * (1 + PART):
        raise ValueError(f"{file} [{where}] {key} = {at:g}, but by lengths_mm the shaft reaches from 0 to {shaft.length:g} mm")


def _stage(file, name, rows, gears, homes, shafts):
    """Return the `TrainStage` of a row."""
    where, row = f"stage.{name}", rows["stage"][name]
    outer, ring = (rows["pair"][row[kind]] for kind in ("sun_planet", "planet_ring"))
    _on(file, where, "carrier", row["carrier"], row["carrier_at_mm"], shafts)
    sun, planet, rim = outer["gear_1"], outer["gear_2"], ring["gear_2"]
    if ring["gear_1"] != planet or not gears[rim].internal or {planet, rim} & set(homes):
        raise ValueError(
            f"{file} [{where}]: give pairs sun-planet and planet-ring of one planet; planet and ring are on no shaft"
        )
    check_known(file, where, "sun_planet: sun", sun, homes, "gear on a shaft")
    if (gears[sun].z + gears[rim].z) % row["n_planets"]:
        raise ValueError(
            f"{file} [{where}] n_planets = {row['n_planets']}: equally spaced planets need a whole number "
            f"({gears[sun].z} + {gears[rim].z}) / n_planets; change n_planets or a tooth number"
        )
    bearing = None if row["planet_bearing"] is None else rows["bearing"][row["planet_bearing"]]
    at = row["carrier_at_mm"] or 0.0
    pairs = row["sun_planet"], row["planet_ring"]
    units = {"pin_N_per_um": 1e6, "pin_axial_N_per_um": 1e6, "pin_tilt_Nm_per_mrad": 1e3}
    pins = (None if row[key] is None else unit * row[key] for key, unit in units.items())
    inertia, mass = row["carrier_inertia_kgm2"], row["carrier_mass_kg"]
    return TrainStage((sun, planet, rim), pairs, row["n_planets"], row["carrier"], at, inertia, bearing, mass, *pins)


def _links(file, rows, gears, train):
    """Return the `Link` of each stage, coupling and pair between shafts."""
    shafts, homes, stages, pairs = train
    out = []
    for name, stage in stages.items():
        sun, _, ring = (gears[gear].z for gear in stage.gears)
        out.append(Link(name, homes[stage.gears[0]], stage.carrier, sun / (sun + ring)))
    for name, row in rows["coupling"].items():
        for key in ("shaft_1", "shaft_2"):
            _on(file, f"coupling.{name}", key, row[key], None, shafts)
        out.append(Link(name, row["shaft_1"], row["shaft_2"], 1.0))
    for name, (one, two, _) in pairs.items():
        for key, gear in (("gear_1", one), ("gear_2", two)):
            check_known(file, f"pair.{name}", key, gear, homes, "gear on a shaft")
        hands = [math.degrees(gears[gear].beta) for gear in (one, two)]
        if abs(hands[0] + gears[two].outward * hands[1]) > PART:
            kind = "an internal pair has the same hand" if gears[two].internal else "an external pair has opposite hands"
            raise ValueError(
                f"{file} [pair.{name}]: beta_deg of {one!r} and {two!r} are {hands[0]:g} and {hands[1]:g}, but {kind}: "
                "the axial forces on the shafts depend on them"
            )
        out.append(Link(name, homes[one], homes[two], -gears[two].outward * gears[one].z / gears[two].z))
    names = [*(link.name for link in out), "motor", *rows["load"]]
    if twice := [name for i, name in enumerate(names) if name in names[:i]]:
        raise ValueError(f"{file}: {twice[0]!r} names two of the pairs, couplings, stages and loads; give each a different name")
    return out


def _forces(file, train, rows, gears):
    """Return the force of each pair along the line of action [N]."""
    out = {}
    for link in train.links:
        torque = train.torques[link.name]
        if link.name in train.pairs:
            gear_1, gear_2, _ = train.pairs[link.name]
            if not torque * train.speeds[link.two] > 0:
                raise ValueError(
                    f"{file} [pair.{link.name}]: gear_1 must drive, but power flows from {gear_2!r} to {gear_1!r}: exchange them"
                )
            out[link.name] = abs(torque) / gears[gear_2].r_b * 1e3
        elif link.name in train.stages:
            stage = train.stages[link.name]
            force = abs(link.ratio * torque) / (stage.n_planets * gears[stage.gears[0]].r_b) * 1e3
            out |= dict.fromkeys(stage.pairs, force)
    for name, force in out.items():
        if rows["pair"][name]["force_N"] is not None or rows["pair"][name]["torque_Nm"] is not None:
            raise ValueError(f"{file} [pair.{name}] force_N or torque_Nm: the gearbox gives {force:.6g} N; leave both out")
    return out

"""Table of the frequencies of a scene's machine: meshes, shafts, teeth, carriers, bearings, with their origins."""

import math
from collections.abc import Iterator
from fractions import Fraction
from typing import NamedTuple

from ...core.record import check_named
from ...core.table import Column, Table
from ...scene.load import Scene
from ...signal.bearing_lines import bearing_lines
from .of_scene import flat_machine
from .tables import Machine

DEEPEST = 10_000  # largest denominator of the ratio of a frequency to the mesh frequency
DIGITS = "0123456789"
SAME = 1e-9  # relative tolerance of equal frequencies
BEARING = {"cage": "FTF, cage", "outer": "BPFO, outer race", "inner": "BPFI, inner race", "roller": "BSF, rotation of a roller"}


class Line(NamedTuple):
    """Spectral line: frequency [Hz], machine part, name, and origin."""

    frequency: float
    part: str
    name: str
    origin: str


def scene_lines(scene: Scene) -> list[Line]:
    """Return all spectral lines of a scene's machine by increasing frequency, without a solution.

    Parameters
    ----------
    scene : Scene
        With a ``[machine]`` table.

    Returns
    -------
    list of Line
        Mesh frequencies, rotation of shafts and gears, passes of planets and teeth, hunting tooth frequencies, and fault
        frequencies of bearings that the scene states.

    Raises
    ------
    ValueError
        If the scene has no machine.
    """
    machine = flat_machine(scene)
    found = [*_shafts(scene), *_stages(machine, scene.train is None), *_hunting(machine), *_bearings(scene)]
    out: dict[tuple[str, str], Line] = {}
    for line in found:
        out.setdefault((line.part, line.name), line)
    return sorted(out.values())


class GearLines(NamedTuple):
    """Frequencies of one gear [Hz]: mesh, engagement of one tooth, rotation relative to the carrier, carrier."""

    teeth: int
    mesh: float
    fault: float
    turning: float
    carrier: float | None
    body: str


def gear_lines(scene: Scene, gear: str) -> GearLines:
    """Return the `GearLines` of a gear of a scene's machine, or of one of its bodies, such as "planet2" or "sun1".

    Of several bodies without a number it is the first one of the driven stage, as for damage.

    Raises
    ------
    ValueError
        If the scene has no machine, or its machine no such gear.
    """
    name = gear if gear in scene.gears else gear.rstrip(DIGITS)
    check_named("gear", name if name in scene.gears else gear, scene.gears)
    machine, z = flat_machine(scene), scene.gears[name].z
    moving = dict.fromkeys(dof.split(".")[0] for dof in machine.dofs)
    for stage in reversed(machine.stages):
        for body, returns in stage.returns.items():
            alike = gear in (body.rstrip(DIGITS), f"{body}_{gear[-1]}") if name == gear else body == name and gear in moving
            if (alike or body == gear) and abs(returns * z / stage.mesh % 1.0 - 0.5) > 0.5 - SAME:
                return GearLines(z, stage.mesh, returns, stage.mesh / z, stage.carrier, body if name == gear else gear)
    bodies = ", ".join(moving | dict.fromkeys(body for stage in machine.stages for body in stage.returns))
    raise ValueError(
        f"gear {gear!r} is no single body of the machine of scene {scene.name}, which has {bodies}: give the frequencies of one "
        "of them, which `gearfe lines` prints, as --mesh, --fault and --carrier"
    )


def lines_table(scene: Scene) -> Table:
    """`scene_lines` as a table, with orders of the driving shaft."""
    found = scene_lines(scene)
    driving = scene.machine["speed_rpm"] / 60
    columns = ["part", "line", Column("frequency", "Hz", "{:.6g}"), Column("order", "", "{:.6g}"), "origin"]
    rows = [[line.part, line.name, line.frequency, line.frequency / driving, line.origin] for line in found]
    return Table(columns, rows, "frequencies; orders of the driving shaft")


def _shafts(scene):
    if scene.train is None:
        if "pair" not in scene.machine["model"]:
            yield Line(scene.machine["speed_rpm"] / 60, "driving gear", "shaft frequency", "[machine] speed_rpm / 60")
        return
    motor, speeds = scene.train.ends["motor"]["shaft"], scene.train.speeds
    for name, speed in speeds.items():
        ratio = speed / speeds[motor]
        origin = "[machine] speed_rpm / 60" if name == motor else f"{motor} x {abs(ratio):.6g}{'' if ratio > 0 else ', reversed'}"
        yield Line(abs(speed) / (2 * math.pi), f"shaft {name}", "shaft frequency", origin)


def _stages(machine: Machine, alone: bool) -> Iterator[Line]:
    """Return the lines of the stages.

    If `alone`, the machine has no shafts. The lines of pairs then include the shaft frequencies of their gears.
    """
    for stage in machine.stages:
        part, z = f"stage {stage.name}", round(stage.mesh / stage.turning)
        driver = stage.driver[0] if len(stage.driver) == 1 else stage.driver[0].rstrip("LR")
        planets = stage.carrier is not None
        yield Line(
            stage.mesh, part, "mesh frequency", f"{z} teeth of {driver} x its rotation{' relative to the carrier' * planets}"
        )
        if stage.carrier is None:
            for body, value in stage.returns.items() if alone else ():
                yield Line(value, body, "shaft frequency", f"mesh frequency / {round(stage.mesh / value)}")
            continue
        yield Line(stage.turning, driver, "rotation relative to the carrier", f"mesh frequency / {z}")
        yield Line(abs(stage.carrier), part, "carrier frequency", "rotation of the carrier")
        n = round((stage.fault or stage.turning) / stage.turning)
        yield Line(n * abs(stage.carrier), part, "planet-pass frequency", f"{n} planets x carrier frequency")
        bodies = {round(value, 9): (body, value) for body, value in reversed(tuple(stage.returns.items()))}
        for body, value in bodies.values():
            times = Fraction(value / stage.mesh).limit_denominator(DEEPEST)
            yield Line(value, body, "a tooth meshes with the same flank", f"mesh frequency x {times}")
            if "planet" in body or body == stage.follower[0]:
                yield Line(2 * value, body, "a tooth meshes with either flank", "each of its meshes once in a rotation")


def _of_stage(machine, stage):
    return [mesh for mesh in machine.meshes if abs(abs(mesh.frequency) - stage.mesh) <= SAME * stage.mesh]


def _hunting(machine):
    for stage in machine.stages:
        for one, two in sorted({mesh.teeth for mesh in _of_stage(machine, stage)}):
            common = math.lcm(one, two)
            origin = f"mesh frequency / {common}, the least common multiple of {one} and {two} teeth"
            yield Line(stage.mesh / common, f"teeth {one} and {two}", "hunting tooth frequency", origin)


def _bearings(scene):
    if scene.train is None:
        return
    turns = 1 / (2 * math.pi)
    for name, shaft in scene.train.shafts.items():
        for kind, row in shaft.kinds.items():
            yield from _bearing(f"{kind} of shaft {name}", row, abs(scene.train.speeds[name]) * turns, "shaft frequency")
    for stage in scene.train.stages.values():
        if stage.bearing is not None:
            _, planet, ring = (scene.gears[gear].z for gear in stage.gears)
            relative = abs(scene.train.speeds[stage.carrier]) * turns * ring / planet
            part, what = f"bearing of each {stage.gears[1]}", "rotation relative to the carrier"
            yield from _bearing(part, stage.bearing, 0.0, what, relative)


def _bearing(part, row, inner, what, outer=0.0):
    angle = math.radians(row["contact_deg"])
    found = bearing_lines(inner, row["rollers"], row["roller_mm"], row["pitch_mm"], angle, outer=outer)
    for name, value in found.items():
        yield Line(value, part, BEARING[name], f"{value / (inner or outer):.5g} x {what}")

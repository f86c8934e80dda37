"""Gear units of REXS files as scenes: values, what is missing, and files that are damaged or foreign.

The files are written here by hand, so that reader and test share the list of attributes in REXS only.
"""

import base64
import json
import math
import struct
import zipfile
from xml.etree import ElementTree

import pytest

import gearfe as gf
from gearfe.app.cli.arguments import main
from gearfe.exchange.rexs import import_rexs

pytestmark = pytest.mark.quick

HEAD = {"version": "1.6", "applicationId": "a test", "applicationVersion": "2", "date": "2026-01-01T00:00:00+01:00"}


class Unit:
    """A model that is written as XML or JSON."""

    def __init__(self, version="1.6"):
        self.components, self.relations, self.cases, self.version = {}, [], [], version

    def add(self, type_, name="", **values):
        """A component; a value is a number, a text, a list, or one of them with its unit."""
        number = len(self.components) + 1
        self.components[number] = (type_, name, values)
        return number

    def relate(self, kind, order=None, **roles):
        """A relation of components by their roles."""
        self.relations.append((kind, order, roles))

    def gear(self, z, m_n, x, *, ring=False, shaft=None, alpha=20.0, beta=0.0, b=30.0, tool=None, **values):
        """A gear on a shaft of its own, with two equal flanks."""
        shaft = shaft or self.add("shaft")
        gear = self.add(
            "ring_gear" if ring else "cylindrical_gear", "", number_of_teeth=(z, "none"), normal_module=(m_n, "mm"),
            face_width=(b, "mm"),
            helix_angle_reference_diameter=(beta, "deg"), u_coordinate_on_shaft=(10.0, "mm"), **values,
        )  # fmt: skip
        shift = {} if x is None else {"addendum_modification_coefficient": (x, "none")}
        sides = {
            side: self.add("cylindrical_gear_flank", normal_pressure_angle=(alpha, "deg"), **shift) for side in ("left", "right")
        }
        self.relate("assembly", assembly=shaft, part=gear)
        self.relate("flank", gear=gear, **sides)
        for flank in sides.values() if tool else ():
            self.relate("manufacturing_step", 1, workpiece=flank, tool=tool)
        return shaft, gear, sides

    def mesh(self, one, two, a=None, **values):
        """A stage of two gears."""
        stage = self.add("cylindrical_stage", **({} if a is None else {"center_distance": (a, "mm")}), **values)
        self.relate("stage", stage=stage, gear_1=one, gear_2=two)
        return stage

    def load(self, shaft, **values):
        """A load on a shaft."""
        self.relate("assembly", assembly=shaft, part=self.add("external_load", **values))

    def xml(self):
        """Text of the model as XML."""
        root = ElementTree.Element("model", HEAD | {"version": self.version})
        relations, components = (ElementTree.SubElement(root, name) for name in ("relations", "components"))
        for number, (kind, order, roles) in enumerate(self.relations, 1):
            one = ElementTree.SubElement(
                relations, "relation", id=str(number), type=kind, **({"order": str(order)} if order else {})
            )
            for role, other in roles.items():
                ElementTree.SubElement(one, "ref", id=str(other), role=role)
        for number, (type_, name, values) in self.components.items():
            one = ElementTree.SubElement(components, "component", id=str(number), type=type_, name=name)
            self._attributes(one, values)
        if self.cases:
            spectrum = ElementTree.SubElement(root, "load_spectrum", id="1")
            for number, case in enumerate(self.cases, 1):
                inside = ElementTree.SubElement(spectrum, "load_case", id=str(number))
                for other, values in case.items():
                    self._attributes(ElementTree.SubElement(inside, "component", id=str(other)), values)
        return ElementTree.tostring(root, encoding="unicode")

    @staticmethod
    def _attributes(one, values):
        for key, (value, unit) in values.items():
            attribute = ElementTree.SubElement(one, "attribute", id=key, unit=unit)
            if isinstance(value, list):
                array = ElementTree.SubElement(attribute, "array")
                for each in value:
                    ElementTree.SubElement(array, "c").text = str(each)
            else:
                attribute.text = str(value).lower() if isinstance(value, bool) else str(value)

    def json(self):
        """Text of the model as JSON; an array is coded."""
        keys = {bool: "boolean", int: "integer", float: "floating_point", str: "string"}

        def stated(value):
            if isinstance(value, list):
                coded = base64.b64encode(struct.pack(f"<{len(value)}d", *value)).decode()
                return {"floating_point_array_coded": {"code": "float64", "value": coded}}
            return {keys[type(value)]: value}

        components = [
            {"id": number, "type": type_, "name": name,
             "attributes": [{"id": key, "unit": unit} | stated(value) for key, (value, unit) in values.items()]}
            for number, (type_, name, values) in self.components.items()
        ]  # fmt: skip
        relations = [
            {"id": i, "type": kind, "refs": [{"id": other, "role": role} for role, other in roles.items()]}
            | ({"order": order} if order else {})
            for i, (kind, order, roles) in enumerate(self.relations, 1)
        ]  # fmt: skip
        return json.dumps({"model": HEAD | {"version": self.version, "relations": relations, "components": components}})

    def write(self, path):
        """Write the model as the suffix says; the path."""
        text = "\ufeff" + (self.json() if path.suffix in (".rexsj", ".zip") else self.xml())
        if path.suffix == ".zip":
            with zipfile.ZipFile(path, "w") as archive:
                archive.writestr("__MACOSX/a.rexs", "x")
                archive.writestr("inside/model.rexs.json", text)
        else:
            path.write_text(text, encoding="utf-8")
        return path


def helical(version="1.6"):
    """A helical pair with tool, reliefs, allowances, material and two load cases."""
    unit = Unit(version)
    hob = unit.add(
        "rack_shaped_tool",
        addendum_coefficient_reference_profile=(1.3, "none"),
        tip_corner_radius_factor_reference_profile=(0.25, "none"),
    )
    steel = unit.add("material", elastic_modulus=(208e3, "MPa" if version >= "2" else "N / mm^2"), poisson_ratio=(0.28, "none"))
    span = {
        f"{end}_backlash_allowance_referenced_to_span": (value, "mum") for end, value in {"upper": -40.0, "lower": -60.0}.items()
    }
    one, pinion, flanks = unit.gear(
        23, 3.0, 0.3, beta=12.0, tool=hob, tip_diameter=(80.0, "mm"), inner_diameter=(30.0, "mm"), **span
    )
    two, wheel, _ = unit.gear(47, 3.0, 0.1, beta=-12.0, tool=hob, inner_diameter=(50.0, "mm"))
    for gear in (pinion, wheel):
        unit.relate("reference", origin=gear, referenced=steel)
    relief = unit.add(
        "tip_relief", tip_relief_depth=(0.02, "mm"), tip_relief_datum_diameter=(77.0, "mm"), shape_of_relief=("linear", "none")
    )
    unit.relate("reference", origin=flanks["left"], referenced=relief)
    stage = unit.mesh(wheel, pinion, 108.5)
    for gear, drives in ((pinion, True), (wheel, False)):
        unit.relate(
            "stage_gear_data",
            stage=stage,
            gear=gear,
            stage_gear_data=unit.add("stage_gear_data", is_driving_gear=(drives, "none")),
        )
    unit.load(one, torque_around_u_axis=(250.0, "N m"))
    unit.load(two)
    unit.components[one][2]["rotational_speed"] = (1200.0, "1 / min")
    unit.add("lubricant", name=("oil", "none"))
    return unit


def planetary():
    """A planetary stage: the ring's shift has the sign that gearfe has not; the sun's shift is missing."""
    unit = Unit("2.0.0")
    casing, ring_shaft, stage = unit.add("gear_casing"), unit.add("shaft"), unit.add("planetary_stage", "Stage")
    carrier = unit.add("planet_carrier")
    sun_shaft, sun, _ = unit.gear(20, 2.0, None)
    _, ring, _ = unit.gear(70, 2.0, -0.20651052467175202, ring=True, shaft=ring_shaft, tip_diameter=(137.6, "mm"))
    unit.relate("assembly", assembly=stage, part=carrier)
    unit.relate("side", assembly=unit.add("coupling"), inner_part=ring_shaft, outer_part=casing)
    for i in range(3):
        shaft, planet, _ = unit.gear(25, 2.0, 0.0)
        unit.relate("planet_shaft", planetary_stage=stage, shaft=shaft)
        for one, two, turn in ((sun, planet, 0), (planet, ring, 180)):
            mesh = unit.mesh(one, two, 45.4, rotating_angle_around_neg_u_axis=(120.0 * i + turn, "deg"))
            unit.relate("assembly", assembly=stage, part=mesh)
    unit.load(sun_shaft, power=(9.42477796076938, "kW"))
    unit.components[sun_shaft][2]["rotational_speed"] = (900.0, "1 / min")
    return unit


@pytest.mark.parametrize("suffix", [".rexs", ".rexsj", ".zip"])
def test_a_helical_pair_is_read(tmp_path, suffix):
    unit = import_rexs(helical().write(tmp_path / f"box{suffix}"))
    chosen = unit.scene.pair()
    pinion, wheel = chosen.pair.gear_1, chosen.pair.gear_2
    assert (pinion.z, wheel.z, chosen.pair.a) == (23, 47, 108.5)  # the driving gear first
    assert math.isclose(pinion.r_a, 40.0)
    assert pinion.r_bore == 15.0
    assert pinion.dedendum == 1.3
    assert pinion.rack_tip_radius == 0.25
    assert math.isclose(pinion.E_sn, -0.05 / math.cos(math.radians(20)), rel_tol=1e-6)
    assert wheel.E_sn == 0.0
    assert (pinion.x, wheel.x, math.degrees(pinion.beta)) == (0.3, 0.1, pytest.approx(12.0))
    assert chosen.materials[0] == gf.Material(E=208e3, nu=0.28)
    assert chosen.flanks["pinion"].tip_relief == 0.02
    assert chosen.flanks["pinion"].tip_start_diameter == 77.0
    assert math.isclose(chosen.force, 250e3 / pinion.r_b, rel_tol=1e-9)
    assert unit.scene.machine["speed_rpm"] == 1200.0
    assert math.isclose(unit.scene.machine["torque_Nm"], 250.0)
    told = " ".join(note["what"] for note in unit.scene.assumptions)
    assert "left flank is loaded" in told
    assert "mean of" in " ".join(note["why"] for note in unit.scene.assumptions)
    assert "1 of lubricant" in unit.left_out


@pytest.mark.parametrize("key", ["tip_corner_radius_cutter", "tip_corner_radius_reference_profile"])
def test_a_tip_radius_of_the_tool_is_no_dedendum(tmp_path, key):
    """A tool may state the radius of its corner and no addendum."""
    unit = Unit()
    tool = unit.add("rack_shaped_tool", **{key: (0.6, "mm")})
    (one, pinion, _), (two, wheel, _) = (unit.gear(z, 3.0, 0.0, tool=tool) for z in (20, 40))
    unit.mesh(pinion, wheel, 90.0)
    unit.load(one, torque_around_u_axis=(250.0, "N m"))
    unit.load(two)
    pinion = import_rexs(unit.write(tmp_path / "box.rexs")).scene.pair().pair.gear_1
    assert (pinion.rack_tip_radius, pinion.dedendum) == (pytest.approx(0.2), 1.25)


def test_a_planetary_stage_closes_with_the_missing_shift_and_the_sign_of_the_ring(tmp_path):
    unit = import_rexs(planetary().write(tmp_path / "set.rexsj"))
    sun, ring = unit.scene.pairs["sun_planet"], unit.scene.pairs["planet_ring"]
    assert abs(sun.pair.backlash) < 1e-6
    assert abs(ring.pair.backlash) < 1e-6
    assert math.isclose(sun.force, 100e3 / 3 / sun.pair.gear_1.r_b, rel_tol=1e-6)
    assert math.isclose(sun.force, ring.force, rel_tol=1e-9)
    assert unit.scene.set is not None
    assert unit.scene.machine["n_planets"] == 3


def test_the_stiffness_is_that_of_gears_typed_by_hand(tmp_path):
    """Ring and planet of the stage, with the numbers that the file states or that it assumes."""
    unit = import_rexs(planetary().write(tmp_path / "set.rexsj"))
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 30.0}
    planet = gf.Gear(z=25, r_bore=unit.scene.gears["planet"].r_bore, addendum=unit.scene.gears["planet"].addendum, **rack)
    addendum = 0.20651052467175202 - (137.6 / 2 - 70) / 2
    ring = gf.Gear(
        z=70, x=0.20651052467175202, addendum=addendum, rack_tip_radius=0.2, r_rim=unit.scene.gears["ring"].r_rim, **rack
    )
    case = gf.Case(gf.GearPair(planet, ring, 45.4), unit.scene.pairs["planet_ring"].force, gf.Material(E=206e3, nu=0.3))
    solve = gf.Solve(method="ritz", phases=8)
    curves = [gf.solve(one, solve).k for one in (case, unit.scene.case("planet_ring"))]
    assert curves[1] == pytest.approx(curves[0], rel=1e-6)


def test_torque_goes_through_a_gearbox_and_speeds_follow(tmp_path):
    unit, shafts = Unit(), [1, 2, 3]
    shafts = [unit.add("shaft", rotational_speed=(1500.0, "1 / min")), unit.add("shaft"), unit.add("shaft")]
    gears = [unit.gear(z, m, 0.0, shaft=shafts[i])[1] for z, m, i in ((20, 2.0, 0), (60, 2.0, 1), (19, 3.0, 1), (57, 3.0, 2))]
    unit.mesh(gears[0], gears[1], 80.0)
    unit.mesh(gears[2], gears[3], 114.0)
    unit.load(shafts[0], torque_around_u_axis=(50.0, "N m"))
    unit.load(shafts[2])
    pairs = import_rexs(unit.write(tmp_path / "box.rexs")).scene.pairs
    radii = [pair.pair.gear_1.r_b for pair in pairs.values()]
    assert [pair.force * r for pair, r in zip(pairs.values(), radii, strict=True)] == pytest.approx([50e3, 150e3])


def test_the_load_case_is_chosen(tmp_path):
    unit = helical()
    load = next(number for number, (kind, *_, values) in unit.components.items() if kind == "external_load" and values)
    unit.components[load][2].clear()
    unit.cases = [{load: {"torque_around_u_axis": (value, "N m")}} for value in (100.0, 40.0)]
    path = unit.write(tmp_path / "box.rexs")
    forces = [import_rexs(path, load_case=number).scene.pair().force for number in (1, 2)]
    assert math.isclose(forces[0], 2.5 * forces[1], rel_tol=1e-9)
    with pytest.raises(ValueError, match=r"load_case = 3, but .* has 2 load cases"):
        import_rexs(path, load_case=3)


def test_the_command_writes_a_scene_that_check_accepts(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    helical().write(tmp_path / "box.rexs")
    assert main(["import", "rexs", "box.rexs"]) == 0
    printed = capsys.readouterr().out
    assert "assumed: gear" in printed
    assert "not read: 1 of lubricant" in printed
    assert "written: box.toml" in printed
    assert main(["check", "box.toml"]) == 0
    assert "backlash" in capsys.readouterr().out
    assert main(["import", "rexs", "box.rexs"]) == 1
    assert "exists and is not overwritten" in capsys.readouterr().err


WHOLE = helical().xml()
DAMAGED = {
    "empty": "", "text": "no gears", "html": "<html><body/></html>", "cut": WHOLE[: len(WHOLE) // 2], "list": "[1, 2]",
    "no model": '{"a": 1}', "null": '{"model": null}', "model list": '{"model": []}',
    "no components": '{"model": {"version": "1.6"}}',
    "components text": '{"model": {"version": "1.6", "components": "x"}}',
    "no id": '{"model": {"version": "1", "components": [{"type": "a"}]}}',
    "nested": "[" * 100_000, "deep": '{"model": ' + "[" * 100_000, "entity": '<!DOCTYPE model [<!ENTITY a "b">]>' + WHOLE,
    "no version": WHOLE.replace('version="1.6"', ""), "id": WHOLE.replace('component id="1"', 'component id="one"'),
    "twice": WHOLE.replace('component id="2"', 'component id="1"'), "dangling": WHOLE.replace('ref id="7"', 'ref id="700"'),
    "no teeth": WHOLE.replace("number_of_teeth", "teeth"), "teeth": WHOLE.replace(">23<", ">23.5<"),
    "few": WHOLE.replace(">23<", ">2<"),
    "negative": WHOLE.replace(">23<", ">-23<"), "words": WHOLE.replace(">23<", ">many<"), "nan": WHOLE.replace(">3.0<", ">nan<"),
    "unit": WHOLE.replace('id="normal_module" unit="mm"', 'id="normal_module" unit="m"'),
    "module": WHOLE.replace(">3.0<", ">1e300<", 1),
    "angle": WHOLE.replace('unit="deg">20.0<', 'unit="deg">0.35<'), "distance": WHOLE.replace(">108.5<", ">90<"),
    "other distance": WHOLE.replace(">108.5<", ">1e9<"), "no stage": WHOLE.replace('type="stage"', 'type="assembly"'),
    "hands": WHOLE.replace(">-12.0<", ">-20.0<"), "code": WHOLE.replace(">108.5<", '><array code="utf8">AAAA</array><'),
    "flanks": WHOLE.replace('unit="deg">20.0<', 'unit="deg">25.0<', 1), "width": WHOLE.replace('id="face_width"', 'id="width"'),
}  # fmt: skip


@pytest.mark.parametrize("name", DAMAGED)
def test_damaged_and_foreign_files_are_answered_by_a_message(tmp_path, name):
    path = tmp_path / "box.rexs"
    path.write_text(DAMAGED[name], encoding="utf-8")
    with pytest.raises(ValueError, match=r"box|gear|pair"):
        import_rexs(path)


def test_files_that_are_none_are_refused(tmp_path):
    (tmp_path / "binary.rexs").write_bytes(bytes(range(256)))
    (tmp_path / "broken.zip").write_bytes(b"PK\x03\x04" + bytes(100))
    with zipfile.ZipFile(tmp_path / "none.zip", "w") as archive:
        archive.writestr("readme.txt", "nothing")
    for name in ("binary.rexs", "broken.zip", "none.zip", "missing.rexs", ""):
        with pytest.raises(ValueError, match=r"REXS|has no model"):
            import_rexs(tmp_path / name)
    with pytest.raises(TypeError, match="REXS file = 5"):
        import_rexs(5)

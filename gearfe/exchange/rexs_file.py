"""Files of REXS 1.0 to 2.0.0, the exchange format of the FVA for gear units: XML, JSON, or a zip file with one of them."""

import base64
import json
import re
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from ..core.file_readers import check_path
from ..geometry.aliases import StrPath

LARGEST = 50_000_000  # largest model file [bytes]
MODELS = (".rexs", ".rexs.xml", ".rexsj", ".rexs.json", ".xml", ".json")
ZIPPED = (".rexsz", ".zip")
RENAMED = {  # attribute ids of older REXS versions: present ids
    "tip_radius_factor": "tip_corner_radius_factor_reference_profile",
    "tip_radius": "tip_corner_radius_reference_profile",
    "load_duration_fraction": "operating_time_fraction",
    "din_3967_deviation_tolerance_series": "tooth_thickness_deviation_tolerance_series_din_3967_1978",
}
TYPES = {"flank_geometry": "cylindrical_gear_flank", "stage_gear_data": "cylindrical_stage_gear_data"}
UNITS = {"°": "deg", "N / mm^2": "MPa", "": "none", None: "none"}
CODES = {"int32": "<i4", "float32": "<f4", "float64": "<f8"}
NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")


@dataclass
class Component:
    """Component of a model: attributes as ``(value, unit)`` by id, and the ids that were read."""

    id: int
    type: str
    name: str
    values: dict[str, tuple[Any, str]] = field(default_factory=dict)
    read: set[str] = field(default_factory=set)

    def value(self, name: str, *units: str) -> Any:
        """Return the value of an attribute in one of these units. It is None if missing or in another unit."""
        value, unit = self.values.get(name, (None, "none"))
        if value is None or unit not in (*units, "none"):
            return None
        self.read.add(name)
        return value

    def number(self, name: str, *units: str) -> float | None:
        """Return the finite number of an attribute, or None if it is missing or something else."""
        value = self.value(name, *units)
        return float(value) if isinstance(value, (int, float)) and np.isfinite(value) else None


@dataclass
class Relation:
    """Relation between components, which are named by their roles."""

    type: str
    order: int
    refs: dict[str, int]


@dataclass
class Model:
    """Gear unit: components by id, relations, load cases of the spectrum, and metadata of the file."""

    version: str
    application: str
    components: dict[int, Component]
    relations: list[Relation]
    cases: list[dict[int, dict[str, tuple[Any, str]]]]
    notes: list[str] = field(default_factory=list)

    def of_type(self, *types: str) -> list[Component]:
        """Components of these types, in file order."""
        return [component for component in self.components.values() if component.type in types]

    def related(self, kind: str, role: str, own: int, wanted: str) -> list[Component]:
        """Return components with role `wanted` in relations of a kind in which component `own` has a `role`, in file order."""
        found = [one for one in self.relations if one.type == kind and one.refs.get(role) == own and wanted in one.refs]
        return [self.components[one.refs[wanted]] for one in sorted(found, key=lambda one: one.order)]


def read_model(path: StrPath) -> Model:
    """Read a REXS file.

    Raises
    ------
    ValueError
        If it is no file, larger than 50 MB, not REXS, or a relation names a component that is not there.
    """
    check_path("REXS file", path)
    if not Path(path).is_file():
        raise ValueError(f"no REXS file {str(path)!r}: give a file {' or '.join((*MODELS[:4], *ZIPPED))}")
    name, text = _text(Path(path))
    try:
        model = _of_json(json.loads(text)) if text.lstrip().startswith("{") else _of_xml(text)
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError, ElementTree.ParseError) as error:
        said = f"no {error}" if isinstance(error, KeyError) else error
        raise ValueError(f"{name}: not a REXS model: {said}; give a file of REXS 1.0 to 2.0.0") from error
    for relation in model.relations:
        for role, other in relation.refs.items():
            if other not in model.components:
                raise ValueError(
                    f"{name}: a relation of type {relation.type!r} has component {other} as {role}, which is missing"
                )
    return model


def _text(path):
    """Return name and text of the model in a file. For a zip file it is the first model."""
    if zipfile.is_zipfile(path):
        try:
            with zipfile.ZipFile(path) as archive:
                names = [
                    name for name in archive.namelist() if name.lower().endswith(MODELS) and not name.startswith("__MACOSX/")
                ]
                if not names:
                    raise ValueError(f"{path}: the zip file has no model: give one with an entry {' or '.join(MODELS[:4])}")
                _check_size(path, archive.getinfo(names[0]).file_size)
                content = archive.read(names[0])
        except (zipfile.BadZipFile, RuntimeError, NotImplementedError, EOFError, OSError) as error:
            raise ValueError(f"{path}: not a readable zip file: {error}") from error
    else:
        _check_size(path, path.stat().st_size)
        content = path.read_bytes()
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError(f"{path}: not a REXS model: {error}; REXS files are UTF-8") from error
    if "<!DOCTYPE" in text or "<!ENTITY" in text:
        raise ValueError(f"{path}: not a REXS model: it declares a document type, which REXS does not allow")
    return path, text


def _check_size(path, size):
    if size > LARGEST:
        raise ValueError(f"{path}: {size / 1e6:.0f} MB, but a REXS model has at most {LARGEST / 1e6:.0f} MB here")


def _of_xml(text):
    root = ElementTree.fromstring(text)
    for one in root.iter():
        one.tag = one.tag.rpartition("}")[2]
    if root.tag != "model":
        raise ValueError(f"the root element is {root.tag!r} and not 'model'")
    relations = [_relation(one.attrib, [ref.attrib for ref in one.iter("ref")]) for one in root.iterfind("relations/relation")]
    components = [_xml_component(one) for one in root.iterfind("components/component")]
    cases = [
        {int(one.attrib["id"]): _xml_values(one) for one in case.iterfind("component")}
        for case in root.iterfind("load_spectrum/load_case")
    ]
    return _model(root.attrib, relations, components, cases)


def _xml_component(element):
    return _component(element.attrib, _xml_values(element))


def _xml_values(element):
    return dict(_attribute(one.attrib["id"], one.get("unit"), _xml_value(one)) for one in element.iterfind("attribute"))


def _xml_value(element):
    for kind in ("array", "matrix", "array_of_arrays"):
        if (found := element.find(kind)) is not None:
            return _decoded(found.text, found.get("code")) if found.get("code") else [_plain(one.text) for one in found.iter("c")]
    return _plain(element.text)


def _plain(text):
    """Return the number, truth value or text of an attribute, or None if it is empty."""
    text = (text or "").strip()
    if NUMBER.fullmatch(text):
        return float(text) if set(text) & set(".eE") else int(text)
    return {"true": True, "false": False, "": None}.get(text, text)


def _decoded(text, code):
    if code not in CODES:
        raise ValueError(f"an array has the code {code!r}, but it must be one of {', '.join(CODES)}")
    return np.frombuffer(base64.b64decode(text or "", validate=False), CODES[code]).tolist()


def _of_json(data):
    model = data["model"]
    relations = [_relation(one, one["refs"]) for one in model.get("relations") or ()]
    components = [_component(one, _json_values(one)) for one in model.get("components") or ()]
    cases = [
        {int(one["id"]): _json_values(one) for one in case.get("components") or ()}
        for case in (model.get("load_spectrum") or {}).get("load_cases") or ()
    ]
    return _model(model, relations, components, cases)


def _json_values(component):
    return dict(_json_attributes(component.get("attributes") or ()))


def _json_attributes(attributes) -> Iterator[tuple[str, tuple[Any, str]]]:
    for one in attributes:
        value = next((stated for key, stated in one.items() if key not in ("id", "unit")), None)
        if isinstance(value, dict):
            value = _decoded(value["value"], value["code"])
        yield _attribute(one["id"], one.get("unit"), value)


def _attribute(name, unit, value):
    return RENAMED.get(name, name), (value, UNITS.get(unit, unit))


def _component(stated, values):
    return Component(int(stated["id"]), TYPES.get(stated["type"], stated["type"]), stated.get("name") or "", values)


def _relation(stated, refs):
    return Relation(stated["type"], int(stated.get("order") or 0), {one["role"]: int(one["id"]) for one in refs})


def _model(stated, relations, components, cases):
    if not components:
        raise ValueError("it has no components")
    by_id = {component.id: component for component in components}
    if len(by_id) < len(components):
        raise ValueError("two components have the same id")
    if "version" not in stated:
        raise ValueError("it states no version")
    application = f"{stated.get('applicationId', 'unknown program')} {stated.get('applicationVersion', '')}".strip()
    notes = [
        f"component {one.id} ({one.type}) refers to another file, which is not read: {one.values['data_source'][0]}"
        for one in components
        if "data_source" in one.values
    ]
    return Model(str(stated["version"]), application, by_id, relations, cases, notes)

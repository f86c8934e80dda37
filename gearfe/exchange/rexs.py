"""`import_rexs`: a gear unit of a REXS file as a scene."""

from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

from ..core.table import Column, Table
from ..geometry.aliases import StrPath
from ..geometry.pair.gear_pair import free_centre_distance
from ..scene.load import Scene, scene_of
from .rexs_file import Model, read_model
from .rexs_gear import GEARS, GearReader
from .rexs_power import Power
from .rexs_unit import POSITION, GearUnit

SILENT = {"gear_unit", "gear_casing", "cylindrical_stage", "planetary_stage", "shaft", "shaft_section", "material"}
SILENT |= {"external_load", "cylindrical_gear_manufacturing_settings", "cylindrical_stage_gear_data"}


class Imported(NamedTuple):
    """Gear unit as tables of a scene and as a scene, and contents of the file that gearfe does not model."""

    tables: dict[str, Any]
    scene: Scene
    left_out: tuple[str, ...]

    def closing(self) -> Table:
        """Compare the centre distance of each pair with that of its nominal profile shifts without backlash."""
        columns = [Column("pair"), Column("a", "mm", "{:.4f}"), Column("without backlash", "mm", "{:.4f}")]
        columns += [Column("difference", "um", "{:.3f}"), Column("backlash", "um", "{:.1f}")]
        rows = []
        for name, chosen in self.scene.pairs.items():
            pair = chosen.pair
            free = free_centre_distance(*pair.gears)
            rows.append([name, pair.a, free, 1e3 * (pair.a - free), 1e3 * pair.backlash])
        return Table(columns, rows)


def import_rexs(path: StrPath, *, load_case: int = 1) -> Imported:
    """Read a gear unit of a REXS file (versions 1.0 to 2.0.0; XML, JSON or zip) as a scene.

    Cylindrical gears, rings, stages, planetary stages, tools, materials, flank modifications, tooth thickness allowances and a
    point of the load spectrum are read. A value that the file lacks becomes an assumption of the scene. An allowance is the mean
    of its limits. Forces follow from the torques that the file states, without losses.

    Parameters
    ----------
    path : path
        File ``.rexs``, ``.rexsj`` or a zip file with one of them.
    load_case : int
        Number of the load case in the load spectrum, from 1.

    Returns
    -------
    Imported
        Tables of the scene, the scene, and what gearfe does not model.

    Raises
    ------
    ValueError
        If the file is not REXS, has no cylindrical stage or no such load case, lacks a number without which no gear exists, or
        describes gears that cannot mesh.
    """
    model = read_model(path)
    if load_case != 1 and not 1 <= load_case <= len(model.cases):
        raise ValueError(f"load_case = {load_case}, but {path} has {len(model.cases) or 'no'} load cases")
    reader = GearReader(model)
    unit = GearUnit(reader, Power(model, load_case))
    if not unit.pairs:
        raise ValueError(
            f"{path}: no stage of two cylindrical gears: gearfe reads spur and helical gears, rings and planetary stages"
        )
    tables: dict[str, Any] = {"title": model.of_type("gear_unit")[0].name if model.of_type("gear_unit") else Path(path).stem}
    tables["title"] = tables["title"] or Path(path).stem
    case = f", load case {load_case} of {len(model.cases)}" if model.cases else ""
    tables["source"] = f"REXS {model.version} file {Path(path).name} of {model.application}{case}"
    try:
        tables |= unit.tables()
    except ArithmeticError as error:
        raise ValueError(f"{path}: a number of the file is far out of range: {error}") from error
    assumed = [{"what": what, "why": why} for what, why in reader.assumed]
    tables |= {"assumption": assumed} if assumed else {}
    return Imported(tables, scene_of(f"{Path(path).stem}.toml", tables), tuple(_left_out(model, unit.copies)))


def _left_out(model: Model, copies: set[int]) -> Iterator[str]:
    """Describe contents of a model that gearfe does not read. `copies` are components equal to one that was read."""
    yield from model.notes
    looked_at = [one for one in model.components.values() if one.id not in copies]
    unread = Counter(one.type for one in looked_at if not one.read and one.type not in SILENT)
    yield from (f"{count} of {kind}" for kind, count in sorted(unread.items()))
    for kind in (*GEARS, "cylindrical_gear_flank", "cylindrical_stage"):
        names = {name for one in looked_at if one.type == kind for name in _unread(one)}
        if names:
            yield f"of {kind}: {', '.join(sorted(names))}"


def _unread(component):
    """Return the attributes of a component that have a value but were not read."""
    return {name for name, (value, _) in component.values.items() if value not in (None, 0, False)} - component.read - POSITION

"""A gear pair as an FMU 2.0, compiled from C, for Simulink, Modelica tools, Simpack and other programs."""

import hashlib
import platform
import shutil
import subprocess
import sys
import tempfile
import zipfile
from datetime import UTC, datetime
from importlib import resources
from pathlib import Path

from ..core.case import Case
from ..core.files import written
from ..geometry.aliases import Floats, StrPath
from ..stiffness.solve import Solve
from .mesh_table import mesh_table
from .xml_template import filled


def write_fmu(path: StrPath, case: Case, how: Solve | None = None) -> None:
    """Write a gear pair as an FMU 2.0 for model exchange and co-simulation, with its damage.

    Inputs are angles and speeds of both gears. Outputs are the torques on them, force, stiffness and deflection. The stiffness is
    that of the case's load. It is linear between the phases and repeats when the same teeth meet again. Back flanks have the same
    stiffness. The FMU contains the library for the system of this computer and the C source.

    Parameters
    ----------
    path : path
        File ``.fmu``.
    case : Case
        Pair, load and damage.
    how : Solve, optional
        Method, and phases per mesh cycle. Further ones are added where pairs enter or leave.

    Raises
    ------
    ValueError
        If the path has another suffix or cannot be written; as `gearfe.mesh_cycle`.
    RuntimeError
        If no C compiler is there.
    """
    if Path(path).suffix.lower() != ".fmu":
        raise ValueError(f"{path}: the name of an FMU must end in .fmu")
    compiler = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
    if compiler is None:
        raise RuntimeError("an FMU is compiled from C: install a C compiler, such as gcc")
    table = mesh_table(case, how)
    pair, play = case.pair, 1e-3 * max(case.pair.backlash, 0.0)
    numbers: dict[str, float] = {"ROWS": table.phase.size, "CYCLES": table.cycles, "Z_1": pair.gear_1.z}
    numbers |= {"R_1": 1e-3 * pair.gear_1.r_b, "R_2": 1e-3 * pair.gear_2.r_b, "BACKLASH": play if play > 1e-9 else 0.0}
    arrays = {"PHASE": table.phase, "K": table.k, "E": table.unloaded}
    lines = [*(f"#define {name} {value:.17g}" for name, value in numbers.items())]
    body = "\n".join([*lines, *(_array(name, values) for name, values in arrays.items())])
    guid = hashlib.sha256(body.encode()).hexdigest()[:32]
    source = f'#define GUID "{guid}"\n{body}\n' + resources.files(__package__).joinpath("fmu.c").read_text(encoding="utf-8")
    with tempfile.TemporaryDirectory() as folder, written(path) as name:
        library = _compiled(compiler, source, Path(folder))
        with zipfile.ZipFile(name, "w", zipfile.ZIP_DEFLATED) as archive:
            archive.writestr("modelDescription.xml", _description(Path(path).stem, guid, float(numbers["BACKLASH"])))
            archive.write(library, f"binaries/{_system()}/gear_pair{library.suffix}")
            archive.writestr("sources/gear_pair.c", source)


def _array(name: str, values: Floats) -> str:
    return f"static const double {name}[] = {{{','.join(map(repr, values.tolist()))}}};"


def _system() -> str:
    bits = 64 if sys.maxsize > 2**32 else 32
    return {"Linux": "linux", "Darwin": "darwin", "Windows": "win"}[platform.system()] + str(bits)


def _compiled(compiler, source, folder):
    """Compile the source to a shared library."""
    library = (
        folder / f"gear_pair{'.dll' if platform.system() == 'Windows' else '.dylib' if platform.system() == 'Darwin' else '.so'}"
    )
    (folder / "gear_pair.c").write_text(source, encoding="utf-8")
    command = [compiler, "-shared", "-fPIC", "-O2", "-o", str(library), str(folder / "gear_pair.c"), "-lm"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"the C compiler failed: {done.stderr.strip()[:500]}")
    return library


def _description(name, guid, backlash):
    """Return the text of ``modelDescription.xml``."""
    date = datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")
    return filled("fmu.xml", name=name, guid=guid, backlash=backlash, date=date)

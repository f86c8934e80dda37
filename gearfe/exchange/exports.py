"""`export`: a pair or a gear of a scene for other programs, in the format of the file suffix."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from ..core.checks import one_of
from ..core.files import new_file
from ..geometry.aliases import StrPath
from ..geometry.mesh.step_file import write_step
from ..scene.load import load_scene
from ..stiffness.solve import Solve, solve
from .fmu import write_fmu
from .mesh_table import write_mesh_table
from .outline_file import write_outline
from .rexs_write import write_rexs


def export(
    scene: StrPath, path: StrPath, *, pair: str | None = None, case: str | None = None, gear: str = "pinion", **how: Any
) -> Iterator[str]:
    """Write a pair or a gear of a scene for another program. Yield descriptions of contents that the format lacks.

    ``.fmu`` `gearfe.write_fmu`; ``.mat, .txt`` `gearfe.write_mesh_table`; ``.rexs`` `gearfe.write_rexs` with the stiffness of a
    healthy mesh cycle of each pair; ``.dxf, .svg`` `gearfe.write_outline`; ``.step`` `gearfe.write_step`.

    Parameters
    ----------
    scene : path
        Built-in scene or file.
    path : path
    pair, case : str, optional
        Of the scene; default: its first pair, healthy.
    gear : {"pinion", "wheel"}
        Of an outline or a solid.
    **how
        Of `gearfe.Solve`: ``method, phases, refine``.

    Raises
    ------
    ValueError
        If the suffix is another, the file cannot be written, or the scene has no such pair or case.
    """
    suffix = Path(path).suffix.lower()
    if suffix not in WRITERS:
        raise ValueError(f"{path}: give a file {', '.join(WRITERS)}")
    one_of("gear", gear, ("pinion", "wheel"))
    Path(new_file(path)).unlink()
    made = load_scene(scene)
    yield from WRITERS[suffix](path, made, made.pair(pair).case(case), gear, how)


def _pair(write):
    def run(path, scene, case, gear, how):
        write(path, case, Solve(**how))
        return ()

    return run


def _rexs(path, scene, case, gear, how):
    curves = {name: solve(chosen.case(), Solve(**how)) for name, chosen in scene.pairs.items()}
    write_rexs(path, scene, curves)
    left = [kind for kind in ("damage", "flanks", "supports") if any(getattr(chosen, kind) for chosen in scene.pairs.values())]
    return [f"not written: {', '.join(left)}"] if left else []


def _outline(path, scene, case, gear, how):
    write_outline(path, getattr(case.pair, f"gear_{1 if gear == 'pinion' else 2}"), (case.damage or {}).get(gear, ()))
    return ()


def _solid(path, scene, case, gear, how):
    write_step(path, getattr(case.pair, f"gear_{1 if gear == 'pinion' else 2}"))
    return ["not written: damage, flank modifications"] if case.damage or case.flanks else []


WRITERS: dict[str, Callable[..., Any]] = {
    ".fmu": _pair(write_fmu), ".mat": _pair(write_mesh_table), ".txt": _pair(write_mesh_table), ".rexs": _rexs,
    ".dxf": _outline, ".svg": _outline, ".step": _solid, ".stp": _solid,
}  # fmt: skip

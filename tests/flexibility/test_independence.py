"""What the energy method and finite elements share is what the theory pages list."""

import ast
from pathlib import Path

import gearfe

HOME = Path(gearfe.__file__).parent
SECTIONS = {
    *("core.material", "geometry.aliases", "geometry.kept", "geometry.tooth.gear", "geometry.tooth.profile"),
    *("geometry.damage.chip", "geometry.damage.crack", "geometry.damage.front", "geometry.damage.missing"),  # how they are drawn
    *("geometry.cubic", "flexibility.plane", "flexibility.hertz"),  # splines, teeth solved, across the normal; half-plane
    *("flexibility.solid", "flexibility.halfspace", "flexibility.solved"),  # patches of flanks; what was solved before
}
MESHES = {"geometry.mesh.mesher", "geometry.mesh.outline", "geometry.tooth.profile"}
MESHES |= {"geometry.damage.crack", "geometry.damage.seam"}


def imported(files):
    """Modules of gearfe that files import, by their names below it."""
    out = set()
    for file in files:
        package = file.relative_to(HOME).parent.parts
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.level:
                out.add(".".join([*package[: len(package) - node.level + 1], *(node.module or "").split(".")]))
    return out


def of(folder):
    """Modules that a folder of `flexibility` imports from outside of itself."""
    return {name for name in imported((HOME / "flexibility" / folder).glob("*.py")) if folder.replace("/", ".") not in name}


def test_both_methods_import_what_the_theory_lists_and_no_more():
    assert of("energy/ritz") & of("finite_elements") == SECTIONS


def test_their_meshes_share_outlines_seams_and_gmsh():
    both = [imported([HOME / "geometry" / "mesh" / f"{name}.py"]) for name in ("sector", "section_mesh")]
    assert both[0] & both[1] == MESHES


def test_no_side_imports_elements_or_elimination_of_the_other():
    assert not {name for name in of("energy/ritz") if "finite_elements" in name or "skfem" in name}
    assert not {name for name in of("finite_elements") if "energy" in name or "plane_elements" in name or "condense" in name}

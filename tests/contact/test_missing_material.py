"""The part of the error estimate for the material that pits and spalls lack, against solutions of gears with real recesses."""

from dataclasses import replace

import numpy as np
import pytest

import gearfe as gf
from gearfe.contact.missing_material import missing_material
from gearfe.contact.wide_contact import pair_stiffness3d
from gearfe.core.case_parts import overlap
from validation.shared import outsider

# largest loss of k by cut-out pits against the same tetrahedra filled, under equal loads: validation/pages/holes.md
CUT = {
    ("herringbone_contact_line", "case2"): 0.951e-2,
    ("planetary_pitting", "severe_rows"): 0.439e-2,
    ("helical_pitting", "severe"): 0.252e-2,
}


def relative(scene, case, **changes):
    """Estimated loss of k at 16 phases, relative; `changes` of every pit."""
    found = gf.load_scene(scene).pair()
    pits = {side: [replace(one, **changes) for one in own if isinstance(one, gf.Pit)] for side, own in found.damage[case].items()}
    run = {"face": found.face or "spur", "groove": found.groove}
    phases = (found.pair.eps_alpha + overlap(found.pair, **run)) * (np.arange(16) + 0.5) / 16
    pitted = gf.Case(found.pair, found.force, found.materials, damage=pits, **run)
    contact = pair_stiffness3d(pitted, phases)
    return missing_material(pitted, contact) / contact.k


@pytest.mark.slow
@pytest.mark.parametrize(("scene", "case"), list(CUT))
def test_what_finite_elements_with_recesses_lose_is_covered(scene, case):
    """Under loads that do not choose anew; the estimate is at most five times that."""
    assert CUT[scene, case] < relative(scene, case).max() < 5 * CUT[scene, case]


def test_what_calculix_finds_around_recesses_is_covered():
    """CalculiX solves the contact around the recesses, and on the same tetrahedra with the recesses full but without contact."""
    k = {name: row["theirs"] for (name, mesh), row in outsider.stored().items() if "refine 1.4" in mesh}
    lost = 1 - k["helical, two pits cut out"] / k["helical, two pits as lost contact"]
    one = outsider.cases()["helical, two pits cut out"]
    case = gf.Case(one.pair, one.load * one.pair.gear_1.b, gf.Material(), damage=one.damage)
    contact = pair_stiffness3d(case, [one.phase])
    assert 0.005 < lost < float((missing_material(case, contact) / contact.k)[0])


def test_shallow_recesses_and_whole_teeth_lack_nothing():
    deep, shallow = (relative("helical_pitting", "severe", depth=depth).max() for depth in (0.2, 0.002))
    assert 0 < shallow < 0.05 * deep
    found = gf.load_scene("helical_pitting").pair()
    contact = pair_stiffness3d(found.case(), [0.5], error=True)
    assert not missing_material(found.case(), contact).any()


def test_the_estimate_of_both_solid_methods_contains_it():
    found = gf.load_scene("helical_pitting").pair()
    case = found.case("severe")
    phase = [1.61]
    contact = pair_stiffness3d(case, phase, error=True)
    assert contact.error[0] > missing_material(case, contact)[0]
    curve = gf.solve(case, gf.Solve("ritz3d", np.array(phase), error=True))
    assert curve.error[0] > missing_material(case, contact)[0]

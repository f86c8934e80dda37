"""Slots and holes in the bodies of gears with growing cracks."""

import math

import numpy as np
import pytest
from skfem import Basis, ElementTriP1, Functional
from usual import RACK

import gearfe as gf
from gearfe.app.cli import main
from gearfe.geometry.mesh.outline import stations
from gearfe.geometry.mesh.section_mesh import section
from gearfe.geometry.mesh.slotted_sector import check_sides
from gearfe.geometry.tooth.profile import fillet_length
from gearfe.strength.tip_response import fe_response, ritz_response

GEAR = gf.Gear(z=21, r_bore=9.2, **RACK)
STEEL = gf.Material(E=206e3, nu=0.3)
CASE = gf.Case(gf.GearPair(GEAR, gf.Gear(z=31, r_bore=11.4, **RACK)), 2000.0, STEEL)


def random_slots(rng):
    """One or two slots under tooth 0 of `GEAR` and elsewhere, some across the sides of its sector."""
    out = []
    for middle in rng.permutation([0.0, 2.5])[: rng.integers(1, 3)]:
        width = rng.uniform(0.8, 2.5)
        radius = rng.uniform(GEAR.r_bore + width / 2 + 0.8, GEAR.r_f - width / 2 - 1.5)
        half = rng.choice([0.0, rng.uniform(0.02, 1.0)])
        out.append(gf.Slot(radius, width, middle - half, middle + half * rng.uniform(0.3, 1.0)))
    try:
        check_sides(GEAR, out)
    except ValueError:  # `ritz` refuses ends that nearly touch a side of a sector.
        return random_slots(rng)
    return tuple(out)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(12))
def test_slots_cut_out_and_filled_with_soft_material_agree(seed):
    """`fe` has holes in its mesh. `ritz` has a soft material in sectors that differ."""
    slots, crack, roll = random_slots(np.random.default_rng(seed)), gf.Crack(length=0.8), np.array([0.7 * GEAR.roll_a])
    soft = ritz_response(GEAR, STEEL, crack, (-1, 0, 1), 1.0, None, slots)
    cut = fe_response(GEAR, STEEL, crack, (-1, 0, 1), 1.5, (roll[0] - 0.5, roll[0] + 0.5), None, slots)
    size = abs(cut.under[0](roll)[0, -2])
    for tooth in (-1, 0, 1):
        assert soft.under[tooth](roll)[0, -2:] == pytest.approx(cut.under[tooth](roll)[0, -2:], abs=3e-3 * size)


def test_the_mesh_has_the_area_of_a_slot():
    slots = (gf.Slot(13.5, 2.0, -0.6, 0.4), gf.Slot(13.0, 3.0, 2.5, 2.5))
    teeth = {0: stations(GEAR, 0.4)}
    meshes = [section(GEAR, teeth, fillet_size=0.5, size=0.8, far_size=1.0, slots=some).mesh for some in (slots, ())]
    cut, whole = (Functional(lambda w: 1.0 + 0.0 * w.x[0]).assemble(Basis(mesh, ElementTriP1(), intorder=6)) for mesh in meshes)
    assert whole - cut == pytest.approx(1.0 * 13.5 * 2.0 + math.pi + 2.25 * math.pi, rel=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize(("backup", "part", "outcome"), [
    (1.0, 0.9, "tooth lost"), (0.5, 0.9, "tooth lost"), (0.5, 0.1, "rim cut"), (0.3, 0.9, "rim cut"), (0.3, 0.1, "rim cut"),
])  # fmt: skip
def test_a_slot_makes_a_thin_rim(backup, part, outcome):
    """As in the tests of NASA below, with a slot of 60 degrees and a bore that is held all around."""
    rack = {"m_n": 3.175, "alpha_n": math.radians(20), "b": 6.35}
    outer = (14 - 1.25) * 3.175 - backup * 2.25 * 3.175
    gear = gf.Gear(z=28, r_bore=12.0, **rack)
    case = gf.Case(gf.GearPair(gear, gf.Gear(z=28, r_bore=15.0, **rack)), 1500.0, STEEL)
    model = gf.CrackModel(slots=[gf.Slot(outer - 2.0, 4.0, -math.radians(30), math.radians(30))])
    growth = gf.grow_crack(case, gf.Crack(length=0.26, start=part * fillet_length(gear)), step=0.5, model=model)
    assert growth.outcome == outcome
    if outcome == "rim cut":
        assert "slot" in growth.why


def test_angles_of_slots_count_from_the_cracked_tooth_towards_its_loaded_flank():
    """A slot on one side only: equal for every tooth, another for the mirrored slot, and of the wheel its own."""
    slot, mirrored = gf.Slot(14.0, 2.0, 0.1, 0.9), gf.Slot(14.0, 2.0, -0.9, -0.1)
    options = {"steps": 1, "refine": 0.7}

    def largest(crack, side, *slots):
        return gf.grow_crack(CASE, crack, side, model=gf.CrackModel(slots=slots), **options).K_I[0]

    zero, fifth = gf.Crack(length=0.6), gf.Crack(length=0.6, tooth=5)
    assert largest(fifth, "pinion", slot) == largest(zero, "pinion", slot)
    loaded, unloaded, none = (largest(zero, "pinion", *slots) for slots in ([slot], [mirrored], []))
    assert abs(loaded - unloaded) > 0.01 * none
    wheel = gf.Slot(25.5, 3.0, -0.4, 0.4)
    assert largest(zero, "wheel", wheel) > 1.01 * largest(zero, "wheel")


@pytest.mark.parametrize(("slot", "message"), [
    ((15.0, -1.0, 0.0, 1.0), "width = -1.0, but it must be positive"), ((15.0, 1.0, 1.0, 0.0), "exchange them"),
    ((15.0, 1.0, 0.0, 6.28), "its ends overlap"), ((15.0, 1.0, math.nan, 1.0), "start = nan"),
    ((20.0, 4.0, 0.0, 1.0), "lies between the radii 18 and 22 mm"),
    ((10.0, 2.0, 0.0, 1.0), "the body of z = 21 reaches from 9.2"),
    ((16.9, 3.0, -0.5, 0.5), "the crack reaches a slot"),
])  # fmt: skip
def test_impossible_slots_are_refused(slot, message):
    with pytest.raises(ValueError, match=message):
        gf.grow_crack(CASE, gf.Crack(length=0.8), model=gf.CrackModel(slots=[gf.Slot(*slot)]))


def test_the_verb_has_slots(tmp_path, capsys):
    """A slot in degrees and mm raises K as in Python, and a slot at the teeth is refused."""
    scene = str(gf.new_scene(tmp_path / "mine.toml"))
    case = gf.load_scene(scene).case(case="cracked")
    ((side, (crack,)),) = case.damage.items()
    radius = case.pair.gear_1.r_f - 5.0
    told = ["crack", scene, "--case", "cracked", "--steps", "1", "--slot", str(radius), "3", "-30", "30"]
    assert main([*told, "--plot", str(tmp_path / "grown.png")]) == 0
    slots = [gf.Slot(radius, 3.0, -math.radians(30), math.radians(30))]
    want, whole = (gf.grow_crack(case, crack, side, steps=1, model=model) for model in (gf.CrackModel(slots=slots), None))
    assert f"{want.K_I[0]:.1f}" in capsys.readouterr().out
    assert want.K_I[0] > 1.02 * whole.K_I[0]
    assert main([*told[:-4], str(radius + 4), "3", "-30", "30"]) != 0
    assert "slot 0 lies between the radii" in capsys.readouterr().err

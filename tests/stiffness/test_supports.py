"""Gears on springs and shafts: identities, springs in series, and tilt against an iteration over misalignment."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from usual import RACK_15 as RACK
from usual import STEEL, pair_24_30

import gearfe as gf

PAIR = gf.GearPair(gf.Gear(z=24, r_bore=15.0, **RACK), gf.Gear(z=30, r_bore=18.0, **RACK))
PHASES = [0.1, 0.75]
SPRINGS = {"pinion": gf.Support(radial=1e5, torsion=3e8, tilt=1e9), "wheel": gf.Support(radial=2e5)}
SERIES = 1e-3 * (1 / 1e5 + 1 / 2e5 + PAIR.gear_1.r_b**2 / 3e8)  # m/N
OVERHUNG = gf.Shaft(segments=[(80, 30)], bearings=(0, 50), gear=70, material=STEEL, torque=0)


def solved(supports=None, force=2000.0, pair=PAIR, method="ritz3d", **options):
    options |= {"order": 2} if method == "ritz3d" else {}
    return gf.mesh_stiffness(pair, force, STEEL, method=method, supports=supports, **({"phases": PHASES} | options))


@pytest.mark.parametrize("method", ["ritz", "ritz3d", "coupled", "textbook"])
def test_rigid_supports_are_those_of_before(method):
    plain = solved(method=method)
    for given in ({"pinion": None}, {"pinion": gf.Support(), "wheel": gf.Support()}):
        found = solved(given, method=method)
        assert_allclose(found.k, plain.k, rtol=1e-14)
        assert_allclose(found.k_tangent, plain.k_tangent, rtol=1e-12)


@pytest.mark.parametrize("method", ["ritz", "ritz3d", "textbook"])
def test_centred_supports_are_springs_in_series(method):
    plain, found = solved(method=method), solved(SPRINGS, method=method)
    assert_allclose(1 / found.k - 1 / plain.k, SERIES, rtol=1e-9)
    assert_allclose(1 / found.k_tangent - 1 / plain.k_tangent, SERIES, rtol=1e-6)
    assert_allclose(found.support_deflection, 2000 * SERIES, rtol=1e-9)
    assert_allclose(found.force, plain.force, rtol=1e-6, atol=1e-6)
    teeth = found.without_supports()
    assert_allclose([teeth.k, teeth.deflection], [plain.k, plain.deflection], rtol=1e-9)
    assert_allclose(teeth.k_tangent, plain.k_tangent, rtol=1e-6)
    assert plain.without_supports() is plain


def test_modified_flanks_on_springs():
    flanks = {"pinion": gf.Flank(tip_relief=0.02, tip_start_roll=PAIR.gear_1.roll_a - 4)}
    plain, found = (solved(given, flanks=flanks, method="ritz", phases=8) for given in (None, SPRINGS))
    assert_allclose(found.te - plain.te, 2000 * SERIES, rtol=1e-9)
    assert_allclose(found.unloaded, plain.unloaded, rtol=1e-12)


def test_a_tilting_shaft_is_the_misalignment_it_makes():
    """The gear pair alone, askew by what the beam tilts under the moment of its load, until both agree."""
    springs, gear = OVERHUNG.support(), PAIR.gear_1
    found = gf.contact_pattern(PAIR, 2000.0, STEEL, phases=PHASES[:1], supports={"pinion": OVERHUNG})
    askew = 0.0
    for _ in range(30):
        alone = gf.contact_pattern(PAIR, 2000.0, STEEL, phases=PHASES[:1], misalignment=gf.Misalignment(F_beta_x=askew))
        cells = alone.cells[0]
        moment = cells.load @ (cells.z - gear.b / 2)
        before, askew = askew, gear.b * (springs.coupling * 2000.0 + moment / springs.tilt)
        if abs(askew - before) < 1e-12:
            break
    assert askew > 1e-3  # mm; the overhung end z = b gives way
    assert moment < 0  # so the load moves to z = 0
    middle = 2000.0 / springs.radial + springs.coupling * moment + gear.r_b**2 * 2000.0 / springs.torsion
    assert_allclose(found.approach, alone.approach + middle, rtol=1e-6)
    assert_allclose(found.cells[0].load, cells.load, atol=1e-5 * cells.load.max())


@pytest.mark.slow
def test_the_load_of_helical_gears_moves_to_the_stiff_side_and_mirrors():
    right = gf.Shaft(segments=[(80, 30)], bearings=(30, 80), gear=10, material=STEEL, torque=80)
    one, two = (
        gf.contact_pattern(pair_24_30(hand, 14), 2000.0, STEEL, phases=PHASES[:1], supports={"pinion": shaft})
        for hand, shaft in ((1, OVERHUNG), (-1, right))
    )
    assert_allclose(one.approach, two.approach, rtol=1e-7)
    assert_allclose(one.supports, two.supports, rtol=1e-6)
    middle = [found.cells[0].load @ found.cells[0].z / found.cells[0].load.sum() for found in (one, two)]
    assert_allclose(sum(middle), RACK["b"], rtol=1e-6)
    plain = gf.contact_pattern(pair_24_30(1, 14), 2000.0, STEEL, phases=PHASES[:1]).cells[0]
    assert middle[0] < plain.load @ plain.z / plain.load.sum() - 0.2


@pytest.mark.slow
def test_reactions_of_a_helical_gear_do_the_work_of_its_load():
    """The hub's displacements by hand: force, axial force and moments of all cells about the middle of the gear."""
    held = gf.Support(radial=3e5, tilt=4e7, torsion=2e8, axial=2e5, coupling=5e-8)
    pair, force = pair_24_30(1, 14), 2000.0
    for side, gear, sense in (("pinion", pair.gear_1, 1), ("wheel", pair.gear_2, -1)):
        found = gf.contact_pattern(pair, force, STEEL, phases=[0.3], supports={side: held})
        cells, beta_b = found.cells[0], abs(pair.gear_1.beta_b)
        along = cells.roll_1 if sense > 0 else -cells.roll_2
        place = np.stack([along, np.full(along.size, gear.r_b), cells.z - gear.b / 2], axis=1)  # line of action, off it, axis
        push = math.cos(beta_b) * np.array([1, 0, 0]) + math.sin(beta_b) * np.array([0, 0, 1])  # z = 0 touches first
        total, moment = cells.load.sum() * push, (cells.load[:, None] * np.cross(place, push)).sum(axis=0)
        assert_allclose(total[0], force, rtol=1e-9)
        work = total[0] ** 2 / held.radial + 2 * held.coupling * total[0] * moment[1] + total[2] ** 2 / held.axial
        work += (moment[0] ** 2 + moment[1] ** 2) / held.tilt + moment[2] ** 2 / held.torsion
        assert_allclose(found.supports, work / force, rtol=1e-9)


def test_herringbone_halves_share_a_hub():
    """Mirrored halves cancel each other's axial force, so that an axial spring and one that tilts change nothing."""
    pair = pair_24_30(1, 14, b=12.0)
    run = {"pair": pair, "face": "herringbone", "phases": [0.3], "force": 1600.0}
    plain = solved(**run)
    found = solved({"pinion": gf.Support(radial=2e5, tilt=1e8, axial=1e4)}, **run)
    assert_allclose(1 / found.k - 1 / plain.k, 1e-3 / 2e5, rtol=1e-6)


def test_a_crack_and_auto_and_poses_take_them():
    crack = {"pinion": [gf.Crack(level=0.4)]}
    plain, found = (solved(given, damage=crack, method="ritz", phases=[0.5, 1.2]) for given in (None, SPRINGS))
    assert_allclose(1 / found.k - 1 / plain.k, SERIES, rtol=1e-9)
    chosen = solved({"pinion": OVERHUNG}, method="auto", order=2)
    assert chosen.meta["method"] == "ritz3d"
    assert "tilt" in chosen.meta["why"]
    turned = solved(SPRINGS, method="ritz", pose="pinion")
    assert_allclose(turned.support_deflection, 2000 * SERIES, rtol=1e-9)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"sun": gf.Support()}, "give supports for 'pinion' and 'wheel'"),
        ({"pinion": 2e5}, "= 200000.0, but give a Support or a Shaft"),
        (gf.Support(), "supports = Support.*but give a dict"),
        ({"pinion": OVERHUNG}, "tilts it under a force, with method = 'ritz'"),
    ],
)
def test_wrong_supports_are_refused(given, message):
    with pytest.raises(ValueError, match=message):
        solved(given, method="ritz")


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"radial": 0.0}, "radial = 0 N/mm, but the stiffness of a spring must be positive"),
        ({"tilt": -1.0}, "tilt = -1 N mm/rad"),
        ({"torsion": math.nan}, "torsion = nan"),
        ({"axial": "soft"}, "axial = 'soft'"),
        ({"radial": 1e5, "tilt": 1e9, "coupling": 1e-6}, "is not positive definite"),
        ({"coupling": 1e-9}, "is not positive definite"),
    ],
)
def test_impossible_springs_are_refused(given, message):
    with pytest.raises(ValueError, match=message):
        gf.Support(**given)


def shaft(parts, middle, length, **more):
    return {"pinion": gf.Shaft(segments=parts, bearings=(0, length), gear=middle, material=STEEL, torque=0, **more)}


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"pinion": gf.Support(radial=150)}, r"radial = 150 N/mm: under 2000 N .* 13.3 mm.*150 N/um are 150000 N/mm"),
        ({"wheel": gf.Support(tilt=1e4)}, r"the wheel's support has tilt = 10000 N mm/rad.*10000 N m/rad are 1e\+07 N mm/rad"),
        ({"wheel": gf.Support(torsion=4e5)}, r"torsion = 400000 N mm/rad: under 2000 N it twists by 0.21"),
        (shaft([(0.08, 0.03)], 0.04, 0.08), r"shaft is 0.08 mm long, but its gear is 15 mm wide: .*0.08 m are 80 mm"),
        (shaft([(300, 300)], 150, 300), r"shaft is 300 mm thick at the gear, but the bore is 30 mm wide"),
        (shaft([(300, 3)], 150, 300), r"shaft is 300 mm long and 3 to 3 mm thick.*give lengths and diameters in mm"),
        (shaft([(80, 30)], 40, 80, bearing_stiffness=150), r"bearings \(150.0, 150.0\) N/mm: .*1 N/um is 1000 N/mm"),
    ],
)
@pytest.mark.parametrize("ask", [solved, lambda given: gf.contact_pattern(PAIR, 2000.0, STEEL, phases=[0.3], supports=given)])
def test_supports_in_other_units_are_refused(ask, given, message):
    with pytest.raises(ValueError, match=message):
        ask(given)


def test_how_far_a_hub_may_give_way():
    """2000 N on a spring whose way is the module's quarter, just inside and outside; without load nothing is asked."""
    quarter = 0.25 * RACK["m_n"]
    solved({"pinion": gf.Support(radial=2000.0 / (0.99 * quarter))}, method="ritz")
    with pytest.raises(ValueError, match="25 % of the module"):
        solved({"pinion": gf.Support(radial=2000.0 / (1.01 * quarter))}, method="ritz")
    solved({"pinion": gf.Support(radial=150)}, force=2.0, method="ritz")
    with pytest.raises(ValueError, match=r"axial = 150 N/mm: under 2000 N its teeth move by 3\.11 mm"):
        solved({"pinion": gf.Support(axial=150)}, pair=pair_24_30(1, 14))
    twist = 0.1 / (2000.0 * PAIR.gear_1.r_b)  # rad per N mm
    solved({"pinion": gf.Support(torsion=1.01 / twist)}, method="ritz")
    with pytest.raises(ValueError, match=r"shafts twist by less than 0\.1 rad"):
        solved({"pinion": gf.Support(torsion=0.99 / twist)}, method="ritz")


def test_the_shaft_in_the_bore_is_the_one_at_the_gear():
    """Thicker beside the gear is a shoulder; a gear at a step has the thinner part in its bore; rings have no bore."""
    stepped = shaft([(30, 60), (20, 30), (30, 60)], 40, 80)
    solved(stepped, method="ritz")
    solved(shaft([(40, 30), (40, 60)], 40, 80))
    with pytest.raises(ValueError, match="60 mm thick at the gear"):
        solved(shaft([(40, 30), (40, 60)], 41, 80))


def test_the_error_of_the_teeth_alone():
    """A k off by its error, on the same springs: 1 / k_teeth = 1 / k - way / F is off by as much as the error told."""
    found = solved(SPRINGS, method="ritz", error=True)
    teeth = found.without_supports()
    off = 1e-6 * found.error
    moved = 1 / (1 / (found.k + off) - SERIES) - 1 / (1 / found.k - SERIES)
    assert_allclose(teeth.error, 1e6 * moved, rtol=1e-4)
    assert (teeth.error > 1.5 * found.error).all()

"""Modified flanks beside CalculiX in nonlinear contact: loads on file that it found (page `flanks`)."""

import pytest
from usual import PAIR_24_36 as PAIR

import gearfe as gf
from validation.shared.kept_rows import stored
from validation.shared.outsider import STEEL, TABLE, pair_of

CASES = (  # relief [um] of both gears, its roll length [mm], exponent, phase
    (10.0, 4.7, 1.0, 0.1), (10.0, 4.7, 1.0, 0.55), (10.0, 4.7, 1.0, 0.8), (30.0, 4.0, 1.0, 0.1), (30.0, 4.0, 1.0, 0.55),
    (30.0, 4.0, 2.0, 0.55), (10.0, 4.7, 1.0, 0.3), (30.0, 4.0, 2.0, 0.25),
)  # fmt: skip


def told(case):
    """Name of a case's row."""
    return f"section, {case[0]:g} um over {case[1]:g} mm, {'linear' if case[2] == 1 else 'parabolic'}, phase {case[3]:g}"


def difference(pair, force, approach, load, **options):
    """Deflection beside that of CalculiX, relative to the latter.

    CalculiX was turned by an approach [um] and gave a load [N] near the one meant; the tangent stiffness carries it there.
    """
    curve = gf.mesh_stiffness(pair, force, STEEL, **options)
    unloaded = 0.0 if curve.unloaded is None else 1e6 * float(curve.unloaded[0])
    theirs = approach + 1e6 * (force - load) / float(curve.k_tangent[0])
    return (1e6 * float(curve.te[0]) - theirs) / (theirs - unloaded)


@pytest.mark.parametrize("case", CASES, ids=told)
def test_tip_relief_of_sections(case):
    """Tip relief on both gears, 150 N/mm."""
    amount, length, exponent, phase = case
    flanks = {
        name: gf.Flank(tip_relief=1e-3 * amount, tip_start_roll=gear.roll_a - length, tip_exponent=exponent)
        for name, gear in (("pinion", PAIR.gear_1), ("wheel", PAIR.gear_2))
    }
    row = stored("flanks_calculix")[told(case)]
    found = difference(PAIR, 3000.0, row["approach"], 20 * row["load"], method="ritz", phases=[phase], flanks=flanks)
    assert abs(found) < 0.003


@pytest.mark.slow
@pytest.mark.parametrize("name", ["crowned, relieved, askew", "involutes"])
@pytest.mark.parametrize("phase", [0.45, 0.1])
def test_crowned_and_askew_helical_flanks(name, phase):
    """13/16 teeth, 15 degrees, 6 mm wide, 300 N/mm, on the finer mesh, which is too stiff itself."""
    pair, flanks = pair_of(15.0), {}
    if name != "involutes":
        relief = {"tip_relief": 0.008, "tip_start_roll": pair.gear_1.roll_a - 2.0, "tip_exponent": 2.0}
        flanks["flanks"] = {"pinion": gf.Flank(helix_crowning=0.006, **relief), "wheel": gf.Flank(helix_crowning=0.004)}
        flanks["misalignment"] = gf.Misalignment(F_beta_x=0.008)
    row = stored("flanks_three")[f"1.5 edges, {name}, phase {phase:g}"]
    found = difference(pair, 1800.0, row["approach"], row["load"], method="ritz3d", phases=[phase], **flanks)
    assert abs(found) < 0.006


LINEAR = "{} edges, refine {}, linear reliefs, phase 0.45"


@pytest.mark.slow
def test_linear_reliefs_with_crowning_and_a_large_misalignment():
    """The helical pair on four meshes: the two finest agree within 0.02 %, and `ritz3d` with them within its estimate.

    The limit of CalculiX remains undecided. With edges and refine of 0.7, 1 and 1.4 its load falls with the power 1.8 of the edge
    lengths. The limit of these meshes would be 1780 N, a deflection 0.8 % above that of `ritz3d`. The mesh of refine 1.3 does not
    confirm it. Involutes on two of the meshes show that modifications are not the cause of the differences on coarse meshes.
    """
    pair, askew = pair_of(15.0), gf.Misalignment(F_beta_x=0.014)
    start = [2 * gear.r_a - 1.2 for gear in pair.gears]
    flanks = {
        "pinion": gf.Flank(tip_relief=0.010, tip_start_diameter=start[0], helix_crowning=0.004),
        "wheel": gf.Flank(tip_relief=0.008, tip_start_diameter=start[1]),
    }
    run = {"method": "ritz3d", "phases": [0.45], "flanks": flanks, "misalignment": askew}
    curve = gf.mesh_stiffness(pair, 1800.0, STEEL, error=True, **run)
    estimate = float(curve.error[0] / curve.k[0])
    meshes = [("0.7", "0.7"), ("1", "1"), ("1", "1.3"), ("1.4", "1.4")]
    rows = [stored("flanks_three")[LINEAR.format(*mesh)] for mesh in meshes]
    found = [difference(pair, 1800.0, row["approach"], row["load"], **run) for row in rows]
    print(found, estimate)
    assert all(abs(one) < estimate for one in found[2:])
    coarse = stored("flanks_three")["1 edges, involutes, phase 0.45"]
    fine = stored(TABLE)["helical, healthy, per_width 1, refine 1.3"]
    involutes = (coarse["approach"], coarse["load"]), (1e3 * fine["approach"], 1e3 * fine["approach"] * fine["theirs"])
    for with_them, row in zip(found[1:3], involutes, strict=True):
        without = difference(pair, 1800.0, *row, method="ritz3d", phases=[0.45])
        print(with_them, without)
        assert abs(with_them - without) < estimate

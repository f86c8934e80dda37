"""Modified flanks beside CalculiX in nonlinear contact: loads on file that it found (page `flanks`)."""

import pytest
from usual import PAIR_24_36 as PAIR

import gearfe as gf
from validation.shared.kept_rows import stored
from validation.shared.outsider import STEEL, pair_of

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

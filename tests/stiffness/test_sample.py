"""Rows of the samples of random pairs, made anew: what the pages count is what this code gives."""

import math

import numpy as np
import pytest

import gearfe as gf
from validation.make import sample
from validation.shared.kept_rows import stored
from validation.shared.table_rows import rows_of

ROWS = rows_of(sample.TABLE)
NUMBERS = ("difference", "fe_error", "fe_estimate", "ritz_error", "ritz_estimate")
COVERED = ("apart_covered", "fe_covered", "ritz_covered")


def check(row):
    found = sample.row(int(row["seed"]))
    assert found["pair"] == row["pair"]
    for name in NUMBERS:
        assert float(found[name]) == pytest.approx(float(row[name]), rel=0.02, abs=5e-4), (
            f"seed {row['seed']}, {name}: remake the page"
        )
    for name in COVERED:
        assert found[name] == row[name], f"seed {row['seed']}, {name}: remake the page"


def test_the_cheapest_row_made_anew():
    check(min(ROWS, key=lambda row: float(row["cpu_s"])))


def gear(z, x, r_bore, beta=0.0, **rack):
    return gf.Gear(z=z, x=x, r_bore=r_bore, beta=beta, rack_tip_radius=0.2, **rack)


SPUR = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 6.952762145412464}
HELICAL = {"m_n": 1.0, "alpha_n": math.radians(22.5), "b": 3.2650641217500134}
SOLID = {  # gears, damage
    "narrow 195004": (
        gear(12, 0.47800155953080786, 7.226961286731128, **SPUR), gear(12, 0.16507766485036005, 7.505603093175955, **SPUR), None,
    ),
    "crack 198003": (
        gear(14, 0.3265829586470603, 3.867788382785348, 0.4308828013036158, **HELICAL),
        gear(15, 0.13739883120281673, 3.2082135658836197, -0.4308828013036158, **HELICAL),
        {"wheel": [gf.Crack(level=0.591296846634586, angle=0.8810418717369756)]},
    ),
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("name", SOLID)
def test_pairs_of_the_frozen_sample_in_three_dimensions(name):
    """The estimate of today covers the distance from the finer solution on file, and is at most half as large again."""
    (one, two, damage), row = SOLID[name], stored("sample_three")[name]
    run = {"method": "ritz3d", "phases": row["phase"], "damage": damage, "error": True, "cache": False}
    found = gf.mesh_stiffness(gf.GearPair(one, two), row["load"] * one.b, gf.Material(), **run)
    np.testing.assert_allclose(found.k, row["ritz3d"], rtol=1e-3)
    assert (np.abs(found.k - row["fine"]) <= found.error).all()
    assert (found.error <= 1.5 * np.array(row["ritz3d_error"])).all()

"""Forces that are not along the involute's normal: what a tooth yields to them, against loads solved in that very direction."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.flexibility.energy.ritz import plane as ritz
from gearfe.flexibility.finite_elements import fe
from gearfe.flexibility.finite_elements.elasticity import HeldSection
from gearfe.flexibility.hertz import half_plane, hat_logarithm
from gearfe.flexibility.plane import towards
from gearfe.geometry.tooth.profile import roll_at_arc

STEEL = gf.Material(E=206e3, nu=0.3)
GEARS = [
    gf.Gear(z=12, m_n=1.0, alpha_n=math.radians(20), b=1.0, r_bore=2.7),
    gf.Gear(z=60, m_n=1.0, alpha_n=math.radians(20), b=1.0, r_rim=34.25, rack_tip_radius=0.2),
]


@pytest.mark.slow
@pytest.mark.parametrize(("angle", "gear"), list(zip((0.1, -0.07), GEARS, strict=True)), ids=["undercut", "ring"])
def test_a_tooth_yields_to_the_direction_of_a_force(gear, angle):
    mesh = fe.mesh_gear(gear, refine=1.4)
    on = fe.hats(mesh, 0, corner=True, tilt=angle)
    found = np.diag(HeldSection(mesh.mesh, STEEL).between(on.load.tocoo()))
    want = found - half_plane(STEEL) * np.diag(hat_logarithm(on.knots, on.knots))
    parts = np.array([[math.cos(angle)], [math.sin(angle)]])
    for found, part in ((ritz.flexibility(gear, STEEL), 0.02), (fe.flexibility(gear, STEEL), 0.03)):
        for arc, one in zip(on.arc[:3], want[:3], strict=True):  # at the tip corner itself meshes differ
            roll = roll_at_arc(gear, np.array([arc]))
            assert_allclose(
                towards(found, found.within([roll], [0])[0], roll, 0, parts, np.ones(1), 0.0),
                one,
                rtol=part,
                atol=0.05 * half_plane(STEEL),
            )
        assert abs(found.within([roll], [0])[0][0, 0] / one - 1) > 2 * part, "else the direction would not matter"

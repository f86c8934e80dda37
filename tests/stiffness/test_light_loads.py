"""Modified flanks under any load: a millionth of a newton closes a millionth of what the flanks lie apart."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk
from usual import PAIR_24_36 as PAIR
from usual import STEEL

import gearfe as gf
from gearfe.geometry.pair.flanks import flank_forms
from gearfe.geometry.pair.modified import flank_contacts

LOADS = 10.0 ** np.arange(-6, 3.1, 0.5)  # N
PITCH = tuple(0.004 * math.sin(2 * math.pi * 5 * k / 24) for k in range(24))


def both(**given):
    """The same flank on both gears, reliefs over 4.7 mm of roll length."""
    own = {name: gear.roll_a - 4.7 for name, gear in (("pinion", PAIR.gear_1), ("wheel", PAIR.gear_2))}
    return {name: gf.Flank(**given, **({"tip_start_roll": roll} if "tip_relief" in given else {})) for name, roll in own.items()}


FLANKS = {
    "linear relief": both(tip_relief=0.01),
    "parabolic relief": both(tip_relief=0.01, tip_exponent=2),
    "crowning and slope": both(profile_crowning=0.005, profile_slope=-0.004),
    "rounded tips": both(tip_rounding=0.3),
    "chamfered tips": both(tip_chamfer=0.3),
    "pitch": {"pinion": gf.Flank(pitch=PITCH)},
    "pitch and relief": both(tip_relief=0.01) | {"pinion": gf.Flank(pitch=PITCH, tip_relief=0.02, tip_start_roll=15.0)},
}


def solved(name, phase, loads=LOADS, **options):
    return gf.mesh_stiffness(PAIR, loads, STEEL, flanks=FLANKS[name], phases=phase, **options)


@pytest.mark.parametrize(
    ("name", "pose"), [*((name, "mean") for name in FLANKS), pytest.param("pitch", "pinion", marks=pytest.mark.slow)]
)
def test_what_a_load_more_closes_is_between_its_tangents(name, pose):
    """The deflection is concave, since contacts only join: it grows by between dF / k_tangent of both loads."""
    curves = solved(name, 3 * np.arange(24) / 24 + 1e-3, pose=pose)
    k, tangent, deflection = (np.array([getattr(one, what) for one in curves]) for what in ("k", "k_tangent", "deflection"))
    assert (np.diff(k, axis=0) > 0).all()
    step, grown = np.diff(LOADS)[:, None], np.diff(deflection, axis=0)
    slack = np.where(LOADS[1:] <= 0.1, 0.01, 0.03)[:, None]  # another law takes over where a contact reaches a corner or kink
    assert (grown < (1 + slack) * step / tangent[:-1]).all()
    assert (grown > (1 - slack) * step / tangent[1:]).all()
    assert_allclose([one.te - one.unloaded for one in curves], deflection, rtol=1e-4, atol=1e-17)


@pytest.mark.parametrize(
    ("name", "method", "first", "rtol"),
    [
        ("parabolic relief", "ritz", 0, 5e-6),
        ("parabolic relief", "fe", 0, 5e-6),
        ("crowning and slope", "ritz", 0, 5e-6),
        pytest.param("crowning and slope", "ritz3d", 4, 2e-3, marks=pytest.mark.slow),
    ],
)
def test_light_loads_follow_the_half_planes_logarithm(name, method, first, rtol):
    """One contact: x / F = S + c (ln(2 / a) + 1/2) / b, with a as the root of F; 0.03 N does not close the next pair's gap.

    In the section F is what the force N along the flanks' common normal does for both gears, and N closes less than the approach
    by the same part. Where a flank leans away from its involute by C' of the roll length, that part is 1 - C' on its gear. In 3-D
    forces keep the involutes' normals, and the gaps of cells 1e-14 mm, which from 1e-4 N on is little.
    """
    curves = solved(name, np.array([0.4, 0.5, 0.6, 0.8]), LOADS[first:10], method=method)
    way = np.array([1e3 * one.deflection / one.meta["force_N"] for one in curves])  # mm/N
    own = -2 * 2 * (1 - 0.3**2) / (math.pi * 207e3) / 20.0 / 2  # two gears, the width, the root
    if method != "ritz3d":
        forms = flank_forms(PAIR, FLANKS[name])
        found = flank_contacts(PAIR, curves[0].phase, flanks=forms)
        at = np.argmin(found.gap, axis=1), np.arange(curves[0].phase.size)
        slopes = [form.removed(roll[at[::-1]], 1) for form, roll in zip(forms, (found.roll_1, found.roll_2), strict=True)]
        own = own / (1 - sum(slopes) / 2) ** 2
        assert (np.abs(slopes) < 2e-3).all(), "what is left is a square of it"
    assert_allclose(
        np.diff(way, axis=0) / np.diff(np.log(LOADS[first:10]))[:, None], np.broadcast_to(own, way[1:].shape), rtol=rtol
    )


@pytest.mark.parametrize(("name", "factor"), [("pitch", 0.5), ("linear relief", 1.0)])
def test_corners_and_kinks_too(name, factor):
    """At the very corner, whose pair alone is in its place, and on a relief's ridge, which a contact touches in proportion.

    Rows of a few hats, placed anew for each load: a step of k by 1e-3 is 3 % of this slope.
    """
    phase = {"pitch": 0.0, "linear relief": 0.125}[name]
    curves = solved(name, np.array([phase]), LOADS[:6])
    way = np.array([1e3 * one.deflection[0] / one.meta["force_N"] for one in curves])
    own = -2 * 2 * (1 - 0.3**2) / (math.pi * 207e3) / 20.0 * factor
    assert_allclose(np.diff(way) / np.diff(np.log(LOADS[:6])), own, rtol=0.05)


@pytest.mark.slow
def test_crowned_widths_touch_in_hertzs_ellipse():
    """One tooth pair, so light that the tooth gives nothing: K. L. Johnson, Contact Mechanics, 4.26-4.28."""
    loads, crowning = 10.0 ** np.array([-6.0, -4.5, -3.0]), 0.01
    flanks = {"pinion": gf.Flank(helix_crowning=crowning)}
    curves = gf.mesh_stiffness(PAIR, loads, STEEL, method="ritz3d", phases=np.array([0.8]), flanks=flanks, error=False)
    modulus, radius = 207e3 / (1 - 0.3**2) / 2, float(PAIR.relative_radius(*PAIR.curvature_radii(0.8)))
    along, across = 4 * crowning / 20.0**2, 1 / (2 * radius)

    def ratio(e2):  # of the two curvatures of the gap, for an ellipse of the square e2 of its eccentricity
        return (ellipe(e2) / (1 - e2) - ellipk(e2)) / (ellipk(e2) - ellipe(e2))

    e2 = brentq(lambda e2: ratio(e2) - across / along, 1e-6, 1 - 1e-13)
    long = (3 * loads * (ellipk(e2) - ellipe(e2)) / (2 * math.pi * modulus * e2 * along)) ** (1 / 3)
    want = 3 * loads * ellipk(e2) / (2 * math.pi * long * modulus)
    assert_allclose([1e3 * one.deflection[0] for one in curves], want, rtol=0.02)

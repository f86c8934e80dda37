"""The floor of a pit shallower than the local approach carries: between no pit and a deep one, without a jump."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from usual import PAIR, STEEL

import gearfe as gf
from gearfe.contact.pieces import pieces_of

RUN = {"pair": PAIR, "force": 2000.0, "material": STEEL, "method": "ritz3d", "phases": [0.3, 0.5]}


def pit(depth, **options):
    return gf.Pit(**({"radius": PAIR.pitch_radius_1, "z": 10.0, "axes": (1.0, 2.0), "depth": depth} | options))


def k_of(*pinion, wheel=()):
    return gf.mesh_stiffness(**RUN, damage={"pinion": list(pinion), "wheel": list(wheel)}).k


@pytest.fixture(scope="module")
def healthy():
    return gf.mesh_stiffness(**RUN).k


def test_a_pit_of_no_depth_is_none(healthy):
    assert_allclose(k_of(pit(1e-300)), healthy, rtol=2e-5)


def test_k_falls_with_the_depth_to_that_of_a_hole(healthy):
    depths = np.array([1e-9, *np.geomspace(1e-4, 0.01, 12), 0.5])
    k = np.array([k_of(pit(depth)) for depth in depths.tolist()])
    assert (np.diff(k, axis=0) < 2e-6 * healthy).all()
    assert np.abs(np.diff(k, axis=0)).max() < 0.012 * healthy.max(), "no jump where the floor first carries"
    loss = 1 - k[-1] / healthy
    assert (loss > 0.005).all()
    first = (k[0] - k[1]) / (depths[1] - depths[0])
    assert_allclose(1 - (healthy - first * 1e-6) / healthy, 1 - k_of(pit(1e-6)) / healthy, atol=2e-5)


def test_floors_of_both_gears_add_and_of_one_the_deepest_counts():
    bands, one = [(0.0, 20.0)], (pit(1e-3), pit(2e-3, z=11.0))
    other = (pit(4e-3, radius=PAIR.pitch_radius_2, z=12.0),)
    at = PAIR.pitch_phase
    pieces = pieces_of(PAIR, [at], (one, other), bands, 0.0, closing=0.01)[0]
    own = [piece for piece in pieces if piece.order == 0]
    assert_allclose([piece.floor for piece in own], [0.0, 1e-3, 2e-3, 6e-3, 4e-3, 0.0])
    assert_allclose(
        [(piece.first, piece.last) for piece in own], [(0, 8), (8, 9), (9, 10), (10, 13), (13, 14), (14, 20)], atol=1e-6
    )
    left = [piece for piece in pieces_of(PAIR, [at], (one, other), bands, 0.0)[0] if piece.order == 0]
    assert_allclose([(piece.first, piece.last) for piece in left], [(0, 8), (14, 20)], atol=1e-6)
    some = [piece for piece in pieces_of(PAIR, [at], (one, other), bands, 0.0, closing=0.003)[0] if piece.order == 0]
    assert_allclose([piece.floor for piece in some], [0.0, 1e-3, 2e-3, 0.0])


def test_a_shallow_pit_over_a_whole_line_is_touched_at_its_floor(healthy):
    """All of the flank 4 um lower: the gears approach by just so much more."""
    lower = [pit(4e-3, axes=(8.0, 40.0), tooth=k) for k in range(-2, 3)]
    with pytest.warns(UserWarning, match="removes the whole flank"):
        found = gf.mesh_stiffness(**RUN, damage={"pinion": lower}).deflection
    assert_allclose(found - 4e-6, RUN["force"] / healthy, rtol=2e-3)
    assert_array_equal(k_of(pit(4e-3, side="unloaded")), healthy)

"""The stored finite elements of pairs in three dimensions: plausible by themselves, and the energy model against them."""

import numpy as np
import pairs_three
import pytest
from pairs_three import CASES, COARSE, MAIN

KNOWN = pairs_three.stored()


def test_the_table_has_a_ring_and_a_steep_pair_healthy_and_damaged():
    names = {name for name, case, _ in KNOWN if case == "healthy"}
    assert set(pairs_three.pairs()) == names
    assert sum("ring" in name for name in names) == 1
    assert set(KNOWN) == set(pairs_three.wanted())


@pytest.mark.parametrize("key", [key for key in KNOWN if key[1] != "healthy"], ids=str)
def test_damage_softens(key):
    name, case, refine = key
    healthy = KNOWN.get((name, "healthy", refine))
    loss = 1 - KNOWN[key]["k"] / healthy["k"]
    assert loss.min() > -1e-4
    assert 0.03 < loss.max() < 0.6
    if case == "crack 60 %":
        assert loss.max() > 1.5 * (1 - KNOWN[name, "crack 30 %", refine]["k"] / healthy["k"]).max()


@pytest.mark.parametrize("key", [key for key in KNOWN if key[2] == COARSE and (*key[:2], MAIN) in KNOWN], ids=str)
def test_coarser_meshes_are_stiffer(key):
    away = KNOWN[key]["k"] / KNOWN[*key[:2], MAIN]["k"] - 1
    assert 0 < away.mean() < 0.01
    assert np.abs(away).max() < 0.01


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("name", pairs_three.pairs())
def test_the_energy_model_is_near_the_hexahedra_as_the_page_states(name, case):
    """Within 0.24 % on average and 0.64 % at a phase, faces of cracks that are pressed together left out."""
    k, apart = pairs_three.model_curve(pairs_three.pairs()[name][1], case)
    away = (k / KNOWN[name, case, MAIN]["k"] - 1)[apart]
    assert abs(away.mean()) < 0.00245
    assert np.abs(away).max() < 0.00645

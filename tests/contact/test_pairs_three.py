"""The stored finite elements of pairs in three dimensions: plausible by themselves, and the energy model against them."""

import functools

import numpy as np
import pytest

from validation.make import pairs_three
from validation.make.pairs_three import COARSE, MAIN

KNOWN = pairs_three.stored()


def test_the_table_has_rings_steep_and_wide_gears_healthy_and_damaged():
    names = {name for name, case, _ in KNOWN if case == "healthy"}
    assert len(names) * 2 >= 6
    assert sum("ring" in name for name in names) == 2
    assert set(pairs_three.pairs()) >= names
    for case in pairs_three.CASES:
        assert sum(key[1] == case for key in KNOWN) >= 3
    assert sum((name, case, COARSE) in KNOWN for name, case, refine in KNOWN if refine == MAIN) >= 2


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


# mean and largest difference of those that miss a target, recorded; the other cases of `KNOWN` meet both
MISSED = {
    ("18/27", "crack 60 %"): (-0.0029, 0.0103),
    ("12/20", "crack 60 %"): (-0.0037, 0.0116),
    ("17/ring 42", "healthy"): (-0.0061, 0.0095),
    ("17/ring 42", "crack 30 %"): (-0.0053, 0.0111),
    ("17/ring 42", "crack 60 %"): (-0.0057, 0.0155),
    ("17/ring 42", "7 pits"): (-0.0060, 0.0095),
    ("20/ring 45", "healthy"): (-0.0060, 0.0080),
    ("20/ring 45", "crack 30 %"): (-0.0063, 0.0097),
    ("20/ring 45", "crack 60 %"): (-0.0061, 0.0109),
    ("20/ring 45", "7 pits"): (-0.0062, 0.0088),
}


def finest(name, case):
    """Stored k, and that of the healthy pair, of the finest mesh up to `MAIN`."""
    refine = MAIN if (name, case, MAIN) in KNOWN else COARSE
    return KNOWN[name, case, refine]["k"], KNOWN[name, "healthy", refine]["k"]


@functools.cache
def differences(name, case):
    """Mean and largest difference of the energy model from the hexahedra, where the hexahedra are to be trusted."""
    k, apart = pairs_three.model_curve(pairs_three.pairs()[name][1], case)
    assert apart.sum() > 10
    away = (k / finest(name, case)[0] - 1)[apart]
    print("mean", away.mean(), "largest", np.abs(away).max())
    return away.mean(), np.abs(away).max()


@pytest.mark.slow
@pytest.mark.parametrize(("name", "case"), sorted({key[:2] for key in KNOWN}))
def test_verdict_on_the_energy_model_against_the_hexahedra(name, case):
    """The targets, 0.5 % in the mean and 1 % at every phase, are met but by the cases recorded, and these by as much."""
    mean, largest = differences(name, case)
    assert (abs(mean) < 5e-3 and largest < 1e-2) == ((name, case) not in MISSED)
    if (name, case) in MISSED:
        np.testing.assert_allclose((mean, largest), MISSED[name, case], atol=2e-4)


@pytest.mark.slow
@pytest.mark.xfail(
    strict=True,
    reason="The energy model is 0.53 to 0.63 % softer than the hexahedra of pairs with a ring. Both are too stiff by what they "
    "do not resolve, so the softer one is nearer; one refinement of the hexahedra takes away 0.09 % only, and finer ones do not "
    "fit into memory: validation/pages/pairs_three.md.",
)
def test_rings_are_within_half_a_percent_of_the_hexahedra():
    """Mean k of the energy model within 0.5 % of the hexahedra, for pairs with a ring as for others."""
    assert max(abs(differences(*key[:2])[0]) for key in KNOWN if "ring" in key[0]) < 5e-3


@pytest.mark.slow
@pytest.mark.xfail(
    strict=True,
    reason="Beside the phases at which the faces of a deep crack meet, one phase of 18/27 and one of 12/20 are 1.03 and 1.16 % "
    "away: the hexahedra let the faces pass through each other, the energy model keeps them apart, and the phases to leave out "
    "are those of the energy model: validation/pages/pairs_three.md.",
)
def test_deep_cracks_are_within_a_percent_at_every_phase():
    """k of external pairs with a crack of 60 % within 1 % of the hexahedra at every phase."""
    assert max(differences(name, "crack 60 %")[1] for name in ("18/27", "12/20")) < 1e-2


@pytest.mark.slow
@pytest.mark.parametrize(("name", "case"), sorted({key[:2] for key in KNOWN if key[1] != "healthy"}))
def test_the_loss_by_damage_is_that_of_the_hexahedra(name, case):
    """Within 5 % of itself where it is largest."""
    pair = pairs_three.pairs()[name][1]
    k, apart = pairs_three.model_curve(pair, case)
    damaged, healthy = finest(name, case)
    loss, at_most, mean = pairs_three.drop(
        healthy[apart], damaged[apart], pairs_three.model_curve(pair, "healthy")[0][apart], k[apart]
    )
    print("drop", loss, "of itself", at_most, "mean", mean)
    assert abs(at_most) < 0.05

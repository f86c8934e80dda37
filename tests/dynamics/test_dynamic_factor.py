"""Dynamic factor of a run: against closed forms."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import gearfe as gf

pytestmark = pytest.mark.quick


def test_a_constant_error_wave_gives_the_factor_of_its_amplitude():
    """k constant, error e cos(w t) below the natural frequency: the force swings by k e / (1 - (f_n / f)**-2 ...)."""
    k, mass, f, e, load = 1e8, 1.0, 400.0, 1e-6, 1000.0
    made = gf.single_mesh(mass, k, f, force=load, zeta=0.05)
    made = gf.with_errors(made, profile=e)
    run = gf.simulate(made, 0.2, rate=4e4)
    run = run.part(slice(4000, None))
    natural = gf.natural_frequencies(made)[0][0]
    r = f / natural
    # a force -m x'' acts on the mesh: the relative motion x - e is driven by m e w**2
    swing = mass * e * (2 * np.pi * f) ** 2 * abs(1 + 2j * 0.05 * r) / abs(1 - r**2 + 2j * 0.05 * r)
    assert_allclose(gf.dynamic_factors(run)["mesh"], 1 + swing / load, rtol=2e-4)


def test_a_load_that_changes_is_no_dynamics_if_it_is_slow():
    made = gf.single_mesh(1.0, 1e8, 500.0, zeta=0.1)
    slow = gf.Load("slow", made.row(made.dofs[0]), (np.array([0.0, 0.2]), np.array([500.0, 1500.0])))
    made = gf.Machine(made.dofs, made.mass, made.springs, made.meshes, (slow,))
    assert_allclose(gf.dynamic_factors(gf.simulate(made, 0.2, rate=2e4))["mesh"], 1.0, atol=2e-3)


def test_a_mesh_without_load_has_none():
    made = gf.single_mesh(1.0, 1e8, 500.0, force=0.0)
    run = gf.simulate(made, 0.002, initial=([1e-6], [0.0]), rate=2e4)
    with pytest.raises(ValueError, match="mesh mesh is unloaded at rest"):
        gf.dynamic_factors(run)

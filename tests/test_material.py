"""Elastic constants: what a bar in tension says of them, and unit slips, which are asked about."""

import pytest
from numpy.testing import assert_allclose

import gearfe as gf


@pytest.mark.parametrize("E", [207e9, 207e6 * 10, 1e300])
def test_pascals_are_refused(E):
    with pytest.raises(ValueError, match="in MPa, not Pa"):
        gf.Material(E=E)


def test_gigapascals_are_asked_about():
    with pytest.warns(UserWarning, match="in MPa, not GPa"):
        assert gf.Material(E=207).E == 207.0


@pytest.mark.parametrize("E", [1500.0, 3000.0, 70e3, 207e3, 450e3])
def test_plastics_and_metals_pass_in_silence(E):
    assert gf.Material(E=E).E == E


@pytest.mark.parametrize(("state", "modulus", "ratio"), [("plane stress", 200e3, 0.3), ("plane strain", 200e3 / 0.91, 0.3 / 0.7)])
def test_a_bar_in_tension_has_the_modulus_and_contracts_by_poissons_ratio(state, modulus, ratio):
    """Free at its sides: sigma_y = (lam + 2 mu) e_y + lam e_x = 0; in plane strain with E / (1 - nu**2) and nu / (1 - nu)."""
    material = gf.Material(E=200e3, nu=0.3)
    lam, mu = material.lame(state)
    across = -lam / (lam + 2 * mu)
    assert_allclose([-across, lam + 2 * mu + lam * across], [ratio, modulus], rtol=1e-12)
    assert_allclose(material.plane_modulus(state), modulus, rtol=1e-12)

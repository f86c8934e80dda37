"""Elastic constants: unit slips are asked about."""

import pytest

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

import math

from validation import machine  # noqa: F401 first: one thread, which suits small matrices

import pytest  # isort: skip

import gearfe as gf  # isort: skip

RACK = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 20.0}


@pytest.fixture(scope="session")
def steel():
    return gf.Material(E=207e3, nu=0.3)


@pytest.fixture(scope="session")
def pair():
    """The pair of the planetary_pitting scene."""
    return gf.GearPair(gf.Gear(z=21, r_bore=7.4, **RACK), gf.Gear(z=31, r_bore=11.4, **RACK))


@pytest.fixture(autouse=True, scope="session")
def _own_cache(tmp_path_factory):
    """Tests neither read nor fill the user's cache."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("GEARFE_CACHE", str(tmp_path_factory.mktemp("cache")))
        yield

import gc
import math
import os
from pathlib import Path

import validation  # noqa: F401 first: one thread, which suits small matrices

import pytest  # isort: skip

import gearfe as gf  # isort: skip
from usual import HERRINGBONE, RACK

gc.disable()  # until all tests are collected, nothing of which is garbage

ROOT = Path(__file__).parents[1]  # of the repository


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config, log):
    """Tests of a file stay together: what they share is computed once."""
    from xdist.scheduler import LoadFileScheduling

    return LoadFileScheduling(config, log)


def pytest_collection_finish():
    """What is there by now stays: the collector of garbage need not look at it again and again."""
    gc.freeze()
    gc.enable()


@pytest.fixture(scope="session")
def root():
    """The repository."""
    return ROOT


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
    folder = tmp_path_factory.getbasetemp()
    folder = folder.parent if "PYTEST_XDIST_WORKER" in os.environ else folder  # one for all processes of this run
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("GEARFE_CACHE", str(folder / "gears"))
        yield


@pytest.fixture(scope="session")
def herringbone_stage():
    return HERRINGBONE


@pytest.fixture(scope="session")
def spur_stage():
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 20.0}
    sun, planet = gf.Gear(z=21, r_bore=7.4, **rack), gf.Gear(z=31, r_bore=11.4, **rack)
    ring = gf.Gear(z=84, r_rim=95.0, x=-0.4617, addendum=0.859, rack_tip_radius=0.2, **rack)
    return gf.PlanetarySet(sun, planet, ring, 3, 52.0)

import gc
import math
import os
from pathlib import Path

import validation  # noqa: F401 first: one thread, which suits small matrices

import pytest  # isort: skip

import gearfe as gf  # isort: skip

gc.disable()  # until all tests are collected, nothing of which is garbage

RACK = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 20.0}
ROOT = Path(__file__).parents[1]  # of the repository
QUICK = {  # room: tests (or whole files) that `-m quick` runs, cheap ones whose failure says that the room is broken
    "geometry": ("geometry/tooth/test_gear.py", "geometry/pair/test_pair.py", "geometry/damage/test_pit.py"),
    "flexibility": ("flexibility/test_condense.py", "flexibility/test_hertz.py", "flexibility/test_halfspace.py"),
    "supports": ("supports/test_beam.py",),
    "elements": ("elements/test_elasticity.py", "elements/test_fe3d.py::test_plane_strain_is_the_two_dimensional_fe"),
    "decks": ("decks/test_mesh_file.py",),
    "strength": ("strength/test_fracture.py::test_growth_angle",),
    "energy": (
        "energy/test_energy.py",
        "test_literature.py::test_healthy_curves",
        "test_literature.py::test_beam_code_with_its_conventions",
        "test_literature.py::test_iso_stiffness",
    ),
    "contact": (
        "contact/test_sharing.py",
        "stiffness/test_stiffness.py::test_load_stiffens",
    ),
    "stiffness": ("stiffness/test_export.py",),
    "machine": ("machine/test_contact_law.py", "machine/test_models.py"),
    "motion": ("motion/test_response.py",),
    "signal": ("signal/test_signals.py", "signal/test_spectral_lines.py", "signal/test_demodulation.py"),
    "scene": ("scene/test_scene.py", "scene/test_references.py", "test_golden.py::test_verdicts_follow_from_the_numbers"),
    "studies": ("studies/test_case_table.py",),
    "many": (
        *("many/datasets/test_dataset_plan.py", "many/surrogates/test_space.py"),
        *("many/store/test_store.py", "many/sweeps/test_study.py"),
    ),
    "cli": ("cli/test_cli.py::test_stiffness_writes_curve_and_plot",),
    "validation": ("validation/test_arbiter.py::test_flank_is_the_involute",),
    "literature": (
        "test_literature.py::test_verdict_on_a_printed_number[planetary_pitting-hertz_coefficient",
        "test_literature.py::test_verdict_on_a_printed_number[compound_planetary-mean_stiffness",
        "test_literature.py::test_verdict_on_a_printed_number[helical_pitting-contact_ratios",
        "test_literature.py::test_verdict_on_a_printed_number[herringbone_machine-mesh_frequency",
    ),
    "reports": ("reports/test_page.py::test_unknown_case_and_suffix_are_refused_before_work",),
    "docs": ("docs/test_tutorials.py::test_scripts_are_found", "docs/test_site.py"),
    "pictures": ("pictures/test_look.py",),
    "layout": ("test_layout.py", "test_types.py"),
    "hostile": ("hostile/test_hostile.py::test_gears", "hostile/test_hostile.py::test_damage"),
}


def pytest_collection_modifyitems(items):
    """Mark the quick tests."""
    quick = tuple(f"tests/{start}" for starts in QUICK.values() for start in starts)
    for item in items:
        if item.nodeid.startswith(quick) and not item.get_closest_marker("slow"):
            item.add_marker(pytest.mark.quick)


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
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 30.0, "beta": math.radians(16)}
    sun, planet = gf.Gear(z=18, r_bore=8.0, **rack), gf.Gear(z=27, r_bore=12.0, **rack)
    return gf.PlanetarySet(sun, planet, gf.Gear(z=72, r_rim=90.0, addendum=0.8, tip_radius=0.2, **rack), 3)


@pytest.fixture(scope="session")
def spur_stage():
    rack = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 20.0}
    sun, planet = gf.Gear(z=21, r_bore=7.4, **rack), gf.Gear(z=31, r_bore=11.4, **rack)
    ring = gf.Gear(z=84, r_rim=95.0, x=-0.4617, addendum=0.859, tip_radius=0.2, **rack)
    return gf.PlanetarySet(sun, planet, ring, 3, 52.0)

"""Root stress under the load of a pair's contact: the load adds up, refusals, against a uniform line load."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from usual import STEEL

import gearfe as gf
from gearfe.strength.root_of_contact import _along

RACK = {"m_n": 2.0, "alpha_n": math.radians(20), "b": 6.0}
PAIR = gf.GearPair(gf.Gear(z=13, x=0.3, r_bore=8.0, beta=0.26, **RACK), gf.Gear(z=16, x=0.2, r_bore=10.0, beta=-0.26, **RACK))


@pytest.fixture(scope="module")
def contact():
    return gf.contact_pattern(PAIR, 1800.0, STEEL, phases=[0.6])


def test_the_load_adds_up(contact):
    cells = contact.cells[0]
    own = np.flatnonzero((cells.order == 0) & (cells.load > 0))
    own = own[np.argsort(cells.depth[own])]
    load = _along(cells.depth[own], cells.width[own], cells.load[own], 6.0)
    z = np.linspace(0.0, 6.0, 4001)
    assert_allclose(np.trapezoid(load(z), z), cells.load[own].sum(), rtol=1e-3)
    assert load(np.array([0.5]))[0] > 1.1 * load(np.array([5.5]))[0], "more at the end that touched first"


@pytest.mark.parametrize(
    ("index", "change", "message"),
    [(3, {}, "has 1 phases"), (0, {"gear": "ring"}, "'pinion' or 'wheel'"), (0, {"order": 7}, "carries no load")],
)
def test_bad_input_is_refused(contact, index, change, message):
    with pytest.raises(ValueError, match=message):
        gf.root_stress_of_contact(PAIR, contact, index, STEEL, **change)


@pytest.mark.slow
def test_the_standard_is_above_the_largest_stress_of_the_engagement_by_a_little():
    """By 2.3 %: ISO 6336-3 puts the load on one line, contact shares it and gives the rest to the other pairs."""
    contact = gf.contact_pattern(PAIR, 1800.0, STEEL, phases=[0.75, 0.9, 1.05])
    largest = max(gf.root_stress_of_contact(PAIR, contact, k, STEEL, refine=0.5).largest for k in range(3))
    assert 0.0 < gf.iso_root_stress(PAIR, 1800.0).stress / largest - 1 < 0.06

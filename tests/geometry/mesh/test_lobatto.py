import numpy as np
import pytest
from numpy.polynomial import legendre
from numpy.testing import assert_allclose

from gearfe.geometry.mesh import triangle


@pytest.mark.parametrize("kind", [float, complex], ids=["numpy before 2.5", "numpy from 2.5 on"])
def test_points_are_real_whatever_the_type_of_numpys_roots(kind, monkeypatch):
    roots = legendre.legroots
    monkeypatch.setattr(legendre, "legroots", lambda c: roots(c).astype(kind))
    found = triangle.lobatto.__wrapped__(4)
    assert found.dtype == np.float64
    assert_allclose(found, [-1, -np.sqrt(3 / 7), 0, np.sqrt(3 / 7), 1], atol=1e-14)  # Abramowitz and Stegun, table 25.6

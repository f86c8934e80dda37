"""Records are compared with the shapes and exceptions that their docstrings state."""

import dataclasses
import math

import numpy as np
import pytest

import gearfe as gf
from gearfe.core.stated_shapes import check_stated

THREE = np.ones(3)


@pytest.mark.parametrize(
    ("made", "message"),
    [
        (lambda: gf.Samples(THREE, np.ones(4)), r"Samples: k has the shape \(4,\), but give \(n,\) with n = 3"),
        (lambda: gf.Samples(THREE, np.array([1.0, math.nan, 1.0])), "Samples: k has nan or infinite values"),
        (lambda: gf.Samples("no", THREE), "Samples: phase = 'no', but give an array of real numbers"),
        (lambda: gf.TransmissionError(THREE, THREE, np.ones((3, 2)), THREE, ()), r"te has the shape \(3, 2\)"),
        (lambda: gf.RootStress(THREE, THREE, np.ones((3, 1)), 5), r"radius has the shape \(3, 1\)"),
        (lambda: gf.LawError(0.1, math.inf, 0.1, 0.1), "LawError: phases = inf, but give finite numbers"),
        (lambda: gf.ParisLaw(math.inf, 3.0), "ParisLaw: C = inf"),
        (lambda: gf.BackFlanks(0.1, -1e8), "not negative"),
    ],
)
def test_records_that_contradict_their_docstring(made, message):
    with pytest.raises(ValueError, match=message):
        made()


def test_stated_exceptions_are_allowed():
    assert gf.Support(radial=1e5).tilt == math.inf
    assert gf.ParisLaw(1e-13, 3.0).K_Ic == math.inf


def test_without_docstrings_nothing_is_compared(monkeypatch):
    @dataclasses.dataclass
    class Plain:
        value: float

    monkeypatch.setattr(Plain, "__doc__", None)
    check_stated(Plain(math.nan))

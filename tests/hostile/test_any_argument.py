"""One hostile value for any argument of any public function or record: an error of gearfe, or a finite result that repeats."""

import dataclasses
import math
import traceback
import warnings
from decimal import Decimal
from fractions import Fraction

import calls
import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

SLOW = (  # more than a tenth of a second for a valid call
    "Dataset", "Growth", "animate_planetary_set", "compare", "contact_pattern", "convergence", "dataset", "error_map",
    "export_mesh", "face_load_distribution", "fit_surrogate", "Surrogate", "grow_crack", "open_dataset", "plot_planetary_set",
    "render_mesh", "render_stress", "report", "root_stress", "root_stress_along_width", "root_stress_of_contact", "sobol_indices",
    "stress_intensity", "stress_intensity_along_front", "sweep_report", "with_estimated_speed", "write_contact_inp",
    "write_line_inp", "write_set_inp", "write_step", "SetCurves", "planetary_stiffness", "with_set", "plot_contact", "plot_pair",
    "Runs", "curve_bands", "main_effects", "open_runs", "plan_sweep", "sweep", "batch", "Convergence",
    "MachineFit", "fit_machine",
)  # fmt: skip
NAMES = sorted(set(calls.CALLS) - set(SLOW))
WORDS = st.sampled_from(["no", "1", "", "a\0b", "a$b$"])
ODD = st.sampled_from([
    math.nan, math.inf, -math.inf, -1.0, 0, 1e300, 1e-300, 10**400, True, None, 1j, b"x", Decimal("0.5"), Fraction(1, 2),
    np.float32(0.5), np.int64(2), np.array(0.5), np.zeros((2, 3, 4)), np.ma.array([1.0, 2.0], mask=[False, True]),
    np.array(["a"]), np.datetime64("2020-01-01"), {"a": math.nan}, {1.0}, [[1.0], [2.0, 3.0]],
    ["a", "b"], [math.nan, 1.0], object(),
])  # fmt: skip
VALUES = st.one_of(ODD, WORDS, st.floats(), st.lists(st.floats(), max_size=3))
QUIET = {"deadline": None, "database": None, "derandomize": True, "suppress_health_check": list(HealthCheck)}


@pytest.fixture(scope="module")
def _place(tmp_path_factory):
    calls.PLACE = tmp_path_factory.mktemp("hostile")


def numbers_in(result):
    """Floats of a result, but of nested records and lists too; arrays may have nan where a pair does not exist."""
    if isinstance(result, (float, np.floating)):
        return [float(result)]
    if isinstance(result, (list, tuple)):
        return [value for part in result for value in numbers_in(part)]
    if isinstance(result, dict):
        return numbers_in(list(result.values()))
    if isinstance(result, np.ndarray) and result.dtype.kind == "f":
        return result.ravel().tolist()
    return []


def stated_by_gearfe(error):
    """Whether the last line of the traceback is gearfe's, and raises."""
    last = traceback.extract_tb(error.__traceback__)[-1]
    own = "raise" in (last.line or "") and "site-packages" not in last.filename
    return own and isinstance(error, (ValueError, TypeError, RuntimeError))


@pytest.mark.slow
@pytest.mark.usefixtures("_place")
@pytest.mark.parametrize(("names", "count"), [(NAMES, 400), (SLOW, 600)], ids=["quick", "slow"])
def test_any_argument_of_any_public_name(names, count):
    told = {"answered": 0, "refused": 0}

    def check(name, place, value):
        arguments = calls.arguments_of(name)
        chosen = sorted(arguments)[place % len(arguments)] if arguments else ""
        assume(chosen and not (chosen in ("path", "folder") and isinstance(value, str)))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)
            try:
                result, again = (calls.call(name, arguments | {chosen: value}) for _ in range(2))
            except Exception as error:
                assert stated_by_gearfe(error), f"{name}({chosen}={value!r}): {type(error).__name__}: {error}"
                told["refused"] += 1
                return
        told["answered"] += 1
        assert not dataclasses.is_dataclass(result) or repr(result)
        np.testing.assert_array_equal(numbers_in(result), numbers_in(again), err_msg=f"{name}({chosen}={value!r})")

    drawn = given(name=st.sampled_from(names), place=st.integers(0, 40), value=VALUES)
    settings(max_examples=count, **QUIET)(drawn(check))()
    assert min(told.values()) > 10, told

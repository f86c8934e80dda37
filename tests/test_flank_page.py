"""Modified flanks against CalculiX in nonlinear contact: rows on file beside today's gearfe, and one computed anew."""

import shutil

import pytest

from validation.make import flanks

ROWS = flanks.read()


@pytest.mark.parametrize("case", list(ROWS), ids=str)
def test_rows_on_file_hold(case):
    _, _, deflection, reference, _ = flanks.differences(case, ROWS[case])
    assert abs(deflection / reference - 1) < 0.003


@pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX (ccx) is not installed: apt-get install calculix-ccx")
@pytest.mark.slow
def test_calculix_on_a_modified_pair():
    case = (10.0, 4.7, 1.0, 0.3)
    _, theirs, deflection, reference, _ = flanks.differences(case, flanks.calculix(case))
    print(f"{case}: {theirs:.3f} um, difference {100 * (deflection / reference - 1):+.3f} % of the deflection")
    assert abs(deflection / reference - 1) < 0.003

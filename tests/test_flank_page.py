"""Modified flanks against CalculiX in nonlinear contact: rows on file beside today's gearfe."""

import pytest

from validation.make import flanks
from validation.shared.kept_rows import stored


@pytest.mark.parametrize("case", flanks.CASES, ids=flanks.told)
def test_rows_on_file_hold(case):
    _, _, deflection, reference, _ = flanks.differences(case, stored(flanks.TABLE)[flanks.told(case)])
    assert abs(deflection / reference - 1) < 0.003

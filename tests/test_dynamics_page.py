"""The page of the dynamics: it says what its tables say, and they what the code gives."""

from numpy.testing import assert_allclose

from gearfe.dynamics.motion.simulate import simulate
from validation.make import dynamics
from validation.shared.kept_rows import stored
from validation.shared.places import PAGES
from validation.shared.stages import machines, stage

TEXT = (PAGES / "dynamics.md").read_text(encoding="utf-8")


def test_the_page_says_what_its_tables_say():
    lines = [line for line in dynamics.accuracy() if line.startswith("|")]
    assert [line for line in lines if line not in TEXT] == []
    assert len(stored("dynamics_steps")) == len(list(machines()))


def test_estimates_cover_the_errors_in_95_of_100_runs():
    rows = stored("dynamics_steps").values()
    inside = [max(d, f) <= e for row in rows for d, f, e in zip(row["displacement"], row["force"], row["estimate"], strict=True)]
    assert len(inside) >= 100
    assert sum(inside) >= 0.95 * len(inside)


def test_a_step_and_an_estimate_on_file_are_those_of_the_code():
    row = stored("dynamics_steps")["herringbone, damaged"]
    got = simulate(stage(True), 0.005, rate=dynamics.RATES[0])
    assert_allclose([1e6 * got.stats["dt"], got.stats["error"]], [row["step"][0], row["estimate"][0]], rtol=0.01)

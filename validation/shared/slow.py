"""Slow tests of a file, run in this process so that the state can say what they imported."""

from collections import Counter

from . import places, state

MISSING = "not computed, something is missing here"


def files():
    """Test files with a test marked slow, as paths below the root."""
    there = sorted((places.ROOT / "tests").rglob("test_*.py"))
    return [path.relative_to(places.ROOT).as_posix() for path in there if "pytest.mark.slow" in path.read_text(encoding="utf-8")]


class Outcomes:
    """A plugin of pytest that counts outcomes; an expected failure is one of its own."""

    def __init__(self):
        self.count = Counter()

    def pytest_runtest_logreport(self, report):
        """Of setup, call and teardown: the call, and what fails or skips before or after it."""
        if report.when == "call" or report.outcome != "passed":
            word = "expected failure" if hasattr(report, "wasxfail") and report.skipped else report.outcome
            self.count[word] += 1


def run(file):
    """Run the slow tests of a file and record them, unless one is skipped; RuntimeError if one fails."""
    import pytest

    if file not in files():
        raise ValueError(f"no slow test in {file}: give one of {', '.join(files())}")
    started, seen = state.cpu(), Outcomes()
    code = pytest.main(["-q", "-m", "slow", "-p", "no:cacheprovider", str(places.ROOT / file)], plugins=[seen])
    if code or not seen.count.keys() <= {"passed", "expected failure", "skipped"}:
        raise RuntimeError(f"slow tests of {file} that did not pass: {dict(seen.count)}")
    told = ", ".join(f"{many} {word}" for word, many in sorted(seen.count.items()))
    if seen.count["skipped"]:
        print(f"{MISSING}: {told}")
        return
    state.record(f"slow {file}", state.cpu() - started, seen.count.total(), "", outcome=told)

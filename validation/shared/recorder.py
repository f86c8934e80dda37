"""A pytest plugin: one line of JSON per finished test (``pytest -p validation.shared.recorder --record FILE``)."""

import json
import time

from . import code, machine


def pytest_addoption(parser):
    """The file to append to."""
    parser.addoption("--record", help="append a line of JSON per finished test to this file")


def pytest_configure(config):
    """Record if a file is given."""
    if config.getoption("record"):
        config.pluginmanager.register(Recorder(config.getoption("record")))


class Recorder:
    """Outcome, seconds and printed lines of each test, with the code and the machine it ran on."""

    def __init__(self, file):
        """`file`: appended to as soon as a test ends, so that nothing is lost if the run is stopped."""
        self.file, self.found, self.seconds = file, None, 0.0

    def pytest_runtest_logreport(self, report):
        """Of setup, call and teardown: the call decides, or the first of them that fails or skips."""
        if report.when == "setup":
            self.found, self.seconds = None, 0.0
        self.seconds += report.duration
        if self.found is None or report.failed:
            outcome = outcome_of(report)
            if report.when == "call" or outcome != "passed":
                self.found = outcome, report.capstdout.splitlines()
        if report.when == "teardown":
            self._append(report.nodeid)

    def _append(self, node):
        outcome, printed = self.found
        row = {"test": node, "outcome": outcome, "seconds": round(self.seconds, 1), "printed": printed}
        row |= {"code": code.fingerprint(node.partition("::")[0]), "commit": code.commit(), "machine": machine.describe()}
        with open(self.file, "a", encoding="utf-8") as file:
            file.write(json.dumps(row | {"date": time.strftime("%Y-%m-%d")}) + "\n")


def outcome_of(report):
    """One word; an expected failure is a word of its own."""
    if hasattr(report, "wasxfail"):
        return "expected failure" if report.skipped else "unexpected pass"
    return report.outcome

"""Rows are of the present code by the functions that their process called."""

import json
import os
import shutil
import subprocess
import sys

import pytest
from trial_project import KEPT, MAKE, MODULE, old, told, trial


@pytest.fixture
def project(tmp_path):
    return trial(tmp_path)


CALLED = '''
import functools
LIMIT = 3

def one(more=0, inner=None):
    """Give 1."""
    def deep():
        return 1
    return deep() + more + Square().area + len(list(steps()))

def other(more=1):
    return more

def steps():
    yield 0

class Square:
    side = 0

    @functools.cached_property
    def area(self):
        return self.side * filled() - 1

    def grow(self):
        self.side += 1

@functools.cache
def filled():
    sides = [side for side in (1, 3) if side < LIMIT + 1]
    first, last = sides
    return first + last
'''


@pytest.fixture(scope="module")
def once(tmp_path_factory):
    """A project whose page has called some of these functions."""
    project = trial(tmp_path_factory.mktemp("computed"))
    (project / "gearfe/used.py").write_text(CALLED)
    told(project, "cracks")
    assert old(project) == 0
    return project


@pytest.fixture
def computed(once, tmp_path):
    return shutil.copytree(once, tmp_path / "project")


THREADED = """
    import threading
    from gearfe.idle import one as far
    thread = threading.Thread(target=far)
    thread.start()
    thread.join()
"""
DISPATCHER = "class Dispatcher:\n    def __init__(self, function):\n        self.py_func = function\n"


@pytest.mark.parametrize(
    ("was", "now", "rows"),
    [
        pytest.param("return more\n", "return more + 1\n", 0, id="function that was not called"),
        pytest.param("self.side += 1", "self.side += 2", 0, id="method that was not called"),
        pytest.param("deep() + more", "deep() + 2 * more", 2, id="function that was called"),
        pytest.param("[side for side in (1, 3) if side <", "[n for n in (1, 3) if n <", 0, id="another word for a variable"),
        pytest.param("first, last = sides\n    return first +", "a, last = sides\n    return a +", 0, id="another word, twice"),
        pytest.param("return first + last", "return last + first", 2, id="variables exchanged"),
        pytest.param("return first + last", "return first + first", 2, id="another variable"),
        pytest.param("if side < LIMIT", "if LIMIT < side", 2, id="variable and constant exchanged"),
        pytest.param("first, last = sides\n    return first +", "LIMIT, last = sides\n    return LIMIT +", 2, id="a word taken"),
        pytest.param("more=0, inner=None", "less=0, inner=None", 2, id="another word for an argument"),
        pytest.param("        return 1", "        return 2", 2, id="function inside it"),
        pytest.param("* filled() - 1", "* filled() - 2", 2, id="property that was read"),
        pytest.param("(1, 3) if", "(1, 4) if", 2, id="function behind a memory cache"),
        pytest.param("yield 0", "yield 1", 2, id="generator"),
        pytest.param("LIMIT = 3", "LIMIT = 4", 2, id="constant"),
        pytest.param("side = 0", "side = 1", 2, id="constant of a class"),
        pytest.param("more=0", "more=5", 2, id="default"),
        pytest.param("def other(more=1)", "def other(more=2)", 0, id="default of a function that was not called"),
        pytest.param("def other", "def another", 0, id="name of a function that was not called"),
        pytest.param("def other", "@functools.cache\ndef other", 2, id="decorator of a function that was not called"),
        pytest.param("def other", "def len", 2, id="function of the name of a builtin"),
        pytest.param("def grow(self)", "def grow(self, more=1)", 2, id="default of a method that was not called"),
        pytest.param("    def grow", "    @property\n    def grow", 2, id="decorator of a method that was not called"),
        pytest.param("def filled", "def filled_up", 2, id="name of a function that was called"),
        pytest.param("def grow(self)", "def __len__(self)", 2, id="name of a method that was not called"),
    ],
)
def test_rows_are_old_when_a_function_they_called_means_something_else(computed, was, now, rows):
    assert CALLED.count(was) == 1
    (computed / "gearfe/used.py").write_text(CALLED.replace(was, now))
    assert old(computed) == rows


@pytest.mark.parametrize(
    ("more", "rows"),
    [
        pytest.param("    from gearfe.idle import one as far\n", 0, id="imported only"),
        pytest.param("    from gearfe.idle import one as far; far()\n", 2, id="called"),
        pytest.param(THREADED, 2, id="called in a thread"),
        pytest.param(
            "    import gearfe.idle, subprocess, sys; subprocess.run([sys.executable, '--version'])\n", 2, id="in a process"
        ),
        pytest.param("    import gearfe.idle, os; os.system('true')\n", 2, id="in a shell"),
        pytest.param("    import gearfe.idle; print((TABLES / 'far.csv').read_text())\n", 2, id="a table of other jobs was read"),
    ],
)
def test_modules_count_whole_where_calls_are_not_seen(project, more, rows):
    (project / "validation/make/cracks.py").write_text(MAKE.replace("    more =", f"{more}    more ="))
    (project / "validation/pages/tables/far.csv").write_text("far\n")
    told(project, "cracks")
    assert old(project) == 0
    (project / "gearfe/idle.py").write_text(MODULE.replace("return 1", "return 2"))
    assert old(project) == rows


@pytest.mark.parametrize("text", ["from numba import njit\n", "# numba compiles this\n"])
def test_modules_that_speak_of_numba_count_whole(project, text):
    (project / "gearfe/used.py").write_text(MODULE + "\n\ndef other():\n    return 1\n" + text)
    (project / "numba.py").write_text("njit = None\n")
    told(project, "cracks")
    (project / "gearfe/used.py").write_text(
        (project / "gearfe/used.py").read_text().replace("():\n    return 1\n", "():\n    return 2\n")
    )
    assert old(project) == 2


def test_modules_whose_functions_are_compiled_elsewhere_count_whole(project):
    (project / "numba/core").mkdir(parents=True)
    for name, text in {"__init__": "", "core/__init__": "", "core/dispatcher": DISPATCHER}.items():
        (project / f"numba/{name}.py").write_text(text)
    (project / "gearfe/loop.py").write_text(
        "from numba.core.dispatcher import Dispatcher\nfrom .idle import one\nloop = Dispatcher(one)\n"
    )
    (project / "validation/make/cracks.py").write_text(MAKE.replace("    more =", "    import gearfe.loop\n    more ="))
    told(project, "cracks")
    assert old(project) == 0
    (project / "gearfe/idle.py").write_text(MODULE.replace("return 1", "return 2"))
    assert old(project) == 2


FIRST = "    first = kept('dynamics_rows', 'one', lambda: {'value': one()}, parts)\n"
SECOND = "    kept('dynamics_rows', 'two', lambda: {'value': LOOK}, parts)\n"


@pytest.mark.parametrize(
    ("look", "rows"),
    [
        ("first['value']", 2),
        ("{**first}['value']", 2),
        ("({} | first)['value']", 2),
        ("stored('dynamics_rows')['one']['value']", 2),
        ("1", 1),
    ],
)
def test_what_made_a_row_on_file_counts_for_a_row_that_is_made_of_it(project, look, rows):
    text = KEPT.partition("    for name")[0].replace("import kept", "import kept, stored") + FIRST + SECOND.replace("LOOK", look)
    text += KEPT[KEPT.index("\n\ndef reference") :]
    (project / "validation/make/dynamics.py").write_text(f"from gearfe.used import one\n{text}")
    for words in ((), ("--reference",), ("two",)):
        told(project, "dynamics", *words)
    assert "dynamics " not in told(project, "--stale")
    (project / "gearfe/used.py").write_text(MODULE.replace("return 1", "return 5"))
    assert f"{rows} of     4 rows old" in told(project, "--stale")


def test_a_method_that_an_earlier_row_of_the_process_called_for_a_cache_counts_for_later_rows(project):
    """Row two finds the value in memory and calls nothing: yet it is old when the method that made it says something else."""
    cached = "import functools\n\nclass Made:\n    @functools.cache\n    def one(self):\n        return 1\n\nMADE = Made()\n"
    (project / "gearfe/used.py").write_text(cached)
    text = KEPT.replace("lambda: {'value': 1}, parts", "lambda: {'value': MADE.one()}, parts")
    (project / "validation/make/dynamics.py").write_text(f"from gearfe.used import MADE\n{text}")
    told(project, "dynamics")
    told(project, "dynamics", "--reference")
    assert "dynamics " not in told(project, "--stale")
    (project / "gearfe/used.py").write_text(cached.replace("return 1", "return 2"))
    assert "2 of     4 rows old" in told(project, "--stale")


def test_lines_of_before_calls_were_noted_count_files_whole(project):
    told(project, "cracks")
    path = project / "validation/pages/tables/state.jsonl"
    lines = [json.loads(line) for line in path.read_text().splitlines()]
    files = {"gearfe": "data.csv used", "validation/make": "cracks"}
    ask = "from validation.shared.state import digest, files_of; told = {'f': {'files': " + repr(files) + "}}"
    ask += "; print(digest(list(files_of({'files': 'f'}, told))))"
    own = {"cwd": project, "env": os.environ | {"PYTHONPATH": ""}, "capture_output": True, "text": True}
    code = subprocess.run([sys.executable, "-c", ask], check=True, **own).stdout.strip()
    line = next(line for line in lines if line.get("job") == "cracks") | {"code": code, "files": "0123abcd"}
    path.write_text("".join(json.dumps(one) + "\n" for one in (line, {"key": "0123abcd", "files": files})))
    assert old(project) == 0
    (project / "gearfe/used.py").write_text(MODULE + "\n\ndef other():\n    pass\n")
    assert old(project) == 2

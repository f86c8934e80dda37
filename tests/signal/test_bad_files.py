"""Files that never end, heads that would take minutes, records with holes, deep groups: refused or read at once."""

import os
import time

import h5py
import numpy as np
import pytest

import gearfe as gf
from gearfe.core.files import suffixes

pytestmark = pytest.mark.quick
ROWS = "\n".join(f"{i / 1000:.3f},{i % 7}" for i in range(40))


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes on this system")
@pytest.mark.parametrize("suffix", suffixes("signal", reading=True))
def test_pipes_and_devices_are_refused_by_every_reader(tmp_path, suffix):
    os.mkfifo(tmp_path / f"a{suffix}")
    (tmp_path / f"zero{suffix}").symlink_to("/dev/zero")
    for name in ("a", "zero"):
        with pytest.raises(ValueError, match="is no regular file"):
            gf.read_signal(tmp_path / f"{name}{suffix}", rate=1.0, unit="g")


@pytest.mark.parametrize(
    "head",
    [
        "a" + " " * 20_000 + "b [g],c [g]",
        "# rate" + " " * 20_000 + "x\ntime [s],c [g]",
        "# a" + "[" * 20_000 + "\ntime [s],c [g]",
        "x" + "\t " * 10_000 + "=\ntime [s],c [g]",
        "time [s],c" + " " * 20_000 + "(g",
    ],
)
def test_a_head_of_thousands_of_blanks_takes_no_time(tmp_path, head):
    path = tmp_path / "a.csv"
    path.write_text(f"{head}\n{ROWS}\n")
    started = time.process_time()
    found = gf.read_signals(path, rate=1000.0, unit="g")
    assert time.process_time() - started < 1.0
    assert all(signal.values.size == 40 for signal in found.values())


def test_groups_that_stand_too_deep_in_each_other_are_refused(tmp_path):
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file.create_dataset("/".join("g" * 200), data=np.arange(9.0))
    with pytest.raises(ValueError, match="more than 64 deep"):
        gf.read_signal(tmp_path / "a.h5", rate=1.0, unit="g")


@pytest.mark.parametrize("where", ["values", "angle", "tachometer", "average"])
def test_masked_values_are_refused(where):
    row = np.linspace(0.0, 9.0, 600) + 0.1
    hole = np.ma.array(row, mask=np.arange(600) == 7)
    make = {
        "values": lambda: gf.Signal(hole, 100.0, "g"),
        "angle": lambda: gf.Signal(row, 100.0, "g", angle=hole),
        "tachometer": lambda: gf.with_tachometer(gf.Signal(row, 100.0, "g"), hole),
        "average": lambda: gf.gear_indicators(hole, 20),
    }
    with pytest.raises(ValueError, match="masked"):
        make[where]()

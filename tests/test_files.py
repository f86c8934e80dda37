"""The one table of formats: everything that can be written or read has its row, and outputs are checked beforehand."""

import contextlib
import json
import os
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from gearfe.core.files import FORMATS, Content, check_output, read, save, save_figure, suffix_of, suffixes, written
from gearfe.signal.signal_file import READERS

CONTENT = Content(
    "gearfe test, version 1",
    {"t [s]": np.array([0.0, 0.1]), "x [m]": np.array([1 / 3, np.nan])},
    {"t": np.array([0.0, 0.1]), "x": np.array([1 / 3, np.nan]), "names": np.array(["t", "x"])},
    {"why": "test"},
    {"t": "s", "x": "m", "names": "-"},
)


def test_the_table_can_write_and_read_what_it_says():
    for suffix, row in FORMATS.items():
        assert suffix == suffix.lower()
        assert suffix.startswith(".")
        assert row.writes or row.reads, f"{suffix} holds nothing"
        assert row.read is not None or not row.reads or suffix in READERS, f"{suffix} has no reader"
        assert row.write is not None or not {"curve", "response"} & set(row.writes), f"{suffix} has no writer"
    assert suffixes("curve") == [".csv", ".npz", ".mat", ".json"]
    assert suffixes("response") == [".csv", ".npz", ".mat"]
    assert set(suffixes("signal", reading=True)) == {".csv", ".txt", ".lvm", *READERS}
    with pytest.raises(ValueError, match="kind = 'sound'"):
        suffixes("sound")


def test_every_format_of_numbers_gives_back_what_was_written(tmp_path):
    for suffix in suffixes("curve"):
        save(tmp_path / f"x{suffix}", "curve", CONTENT)
    lines = read(tmp_path / "x.csv", "signal")
    assert lines[:3] == ["# gearfe test, version 1", '# meta: {"why": "test"}', "t [s],x [m]"]
    assert [float(cell) for cell in lines[3].split(",")] == [0.0, 1 / 3]
    for suffix in (".npz", ".mat"):
        found = read(tmp_path / f"x{suffix}", "signal")
        assert_array_equal(found["x"].ravel(), CONTENT.arrays["x"])
        assert json.loads(str(found["meta"].item())) == CONTENT.meta
    data = json.loads((tmp_path / "x.json").read_text())
    assert data["x"] == [1 / 3, None]
    assert data["units"] == CONTENT.units


def test_suffixes_are_taken_in_any_case_and_refused_by_kind():
    assert suffix_of("K.CSV", "curve") == ".csv"
    for path, kind in (("k.png", "curve"), ("k.json", "response"), ("k.csv", "picture"), ("k.svg", "stress"), ("k", "deck")):
        with pytest.raises(ValueError, match=r"no format for .*use one of"):
            suffix_of(path, kind)


def test_a_check_touches_nothing(tmp_path):
    target = tmp_path / "k.csv"
    target.write_text("old")
    check_output(target, "curve")
    check_output(str(tmp_path / "new.csv"), "curve")
    assert [path.name for path in tmp_path.iterdir()] == ["k.csv"]
    assert target.read_text() == "old"


def test_outputs_that_cannot_be_written_are_refused(tmp_path):
    (tmp_path / "folder.csv").mkdir()
    for path, message in (
        ("", "empty file name for a curve: give one that ends in .csv"),
        (tmp_path / "k.xlsx", "no format for '.xlsx'"),
        (tmp_path / "folder.csv", "it is a folder"),
        (tmp_path / "none" / "k.csv", "give an existing, writable folder"),
        (f"{tmp_path}/a\0b.csv", "cannot write"),
        (f"{tmp_path}/{'x' * 300}.csv", "cannot write"),
    ):
        with pytest.raises(ValueError, match=message):
            check_output(path, "curve")


@pytest.fixture
def nobody():
    """Root writes everywhere: for the time of a test it is nobody."""
    root = hasattr(os, "geteuid") and os.geteuid() == 0
    if root:
        os.seteuid(65534)
    yield
    if root:
        os.seteuid(0)


def test_a_folder_without_the_right_to_write_is_refused(tmp_path, nobody):
    closed = tmp_path.parent / "closed"  # of root, if the test began as root
    with contextlib.suppress(PermissionError):
        closed.mkdir(mode=0o500)
    with pytest.raises(ValueError, match="writable folder"):
        check_output(closed / "k.csv", "curve")


def test_a_file_system_that_refuses_is_found_out(tmp_path, monkeypatch):
    def full(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("gearfe.core.files.open", full, raising=False)
    with pytest.raises(ValueError, match="No space left on device"):
        check_output(tmp_path / "k.csv", "curve")


def test_a_write_that_fails_leaves_the_old_file(tmp_path):
    target = tmp_path / "k.csv"
    target.write_text("old")

    def write():
        with written(target) as name:
            Path(name).write_text("half")
            raise RuntimeError("stop")

    with pytest.raises(RuntimeError, match="stop"):
        write()
    assert [path.name for path in tmp_path.iterdir()] == ["k.csv"]
    assert target.read_text() == "old"


def test_a_figure_is_drawn_only_into_pictures(tmp_path):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(1, 1))
    assert save_figure(figure, None, 50) is figure
    for suffix in suffixes("picture"):
        save_figure(figure, tmp_path / f"x{suffix}", 50)
        assert (tmp_path / f"x{suffix}").stat().st_size > 50
    with pytest.raises(ValueError, match=r"no format for '\.csv'"):
        save_figure(figure, tmp_path / "x.csv", 50)


def test_a_suffix_in_capitals_is_written_by_libraries_that_know_small_ones(tmp_path):
    with written(tmp_path / "x.PNG") as name:
        assert name.endswith(".png")
    assert [path.name for path in tmp_path.iterdir()] == ["x.PNG"]

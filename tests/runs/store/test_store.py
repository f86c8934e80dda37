"""Folders of shards: whole or not there, one writer, damage found."""

import errno
import json
import os
from pathlib import Path

import numpy as np
import pytest

import gearfe as gf
from gearfe.runs.store import folder as place
from gearfe.runs.store import shards
from gearfe.runs.store.shards import ShardColumn

pytestmark = pytest.mark.quick

ABOUT = {"format": "test 1", "of": "x"}
SHAPE = {"of": str}
FIELDS = {
    "case": ShardColumn("whole"),
    "k": ShardColumn("list", "N/m"),
    "mean": ShardColumn("number", "N/m"),
    "text": ShardColumn("text"),
    "any": ShardColumn("json"),
}


@pytest.fixture
def folder(tmp_path):
    """Three shards of two rows."""
    place.begin(tmp_path / "runs", ABOUT, {"of": str})
    for i in range(3):
        rows = [{"case": 2 * i + j, "k": np.full(300, i + 0.1 * j), "mean": None if i == 0 else 1.5} for j in range(2)]
        shards.write_shard(tmp_path / "runs", f"s{i}", shards.encoded(shards.table(rows, FIELDS)))
    return tmp_path / "runs"


def test_what_was_written_is_read(folder):
    found = shards.read(folder, ["case", "mean"], where=None)
    assert found.column_names == ["case", "mean"]
    assert sorted(found["case"].to_pylist()) == list(range(6))
    assert found["mean"].to_pylist() == [None, None, 1.5, 1.5, 1.5, 1.5]
    assert shards.fields_of(shards.opened(folder).schema) == FIELDS
    assert place.begin(folder, ABOUT | {"of": "y"}, SHAPE) == ABOUT  # what stands there, for the caller to compare
    some = shards.read(folder, None, shards.arrow().dataset.field("case") == 3)
    np.testing.assert_allclose(some["k"][0].as_py(), np.full(300, 1.1))


def test_a_range_holds_both_its_ends(folder):
    for where, cases in (
        ({"case": (1, 3)}, [1, 2, 3]),
        ({"case": (2, 2)}, [2]),
        ({"case": (0, 5), "mean": (1.5, 1.5)}, [2, 3, 4, 5]),
    ):
        found = shards.read(folder, ["case"], shards.where_of(where, list(FIELDS)))
        assert sorted(found["case"].to_pylist()) == cases


def test_a_write_that_fails_leaves_the_old_shard(folder, monkeypatch):
    before = (folder / "s1.parquet").read_bytes()

    def full(handle):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(ValueError, match="No space left"):
        shards.write_shard(folder, "s1", b"half")
    assert (folder / "s1.parquet").read_bytes() == before
    assert not list(folder.glob(f"{place.PART}*"))


def test_one_writer_at_a_time_and_leftovers_go(folder):
    (folder / f"{place.PART}old").write_bytes(b"half a shard")
    with place.locked(folder):
        assert not list(folder.glob(f"{place.PART}*"))
        with pytest.raises(ValueError, match="another process is writing"), place.locked(folder):
            pass
    with place.locked(folder):
        pass


@pytest.mark.parametrize("harm", ["cut", "flipped"])
def test_damage_is_found_and_named(folder, harm):
    file = folder / "s1.parquet"
    data = bytearray(file.read_bytes())
    if harm == "cut":
        file.write_bytes(data[:-40])
        with pytest.raises(ValueError, match=r"s1\.parquet is damaged"):
            shards.check_shards(folder)
    else:
        at = data.find(np.full(2, 1.0).tobytes())
        data[(at if at > 0 else 60)] ^= 0xFF
        file.write_bytes(data)
        with pytest.raises(ValueError, match=r"s1\.parquet is damaged"):
            shards.read(folder)


def test_a_changed_bit_is_harmless_or_named(folder):
    """Also in the metadata of a shard whose columns are those of a previous shard."""
    file, rng = sorted(folder.glob("*.parquet"))[-1], np.random.default_rng(0)
    data, found = file.read_bytes(), {shards.row_count: 0, shards.read: 0}
    end = data.rfind(b"ARROW:schema")
    for at in [*rng.integers(len(data), size=60), *rng.integers(end - 400, end, size=60)]:
        changed = bytearray(data)
        changed[at] ^= 1 << int(rng.integers(8))
        file.write_bytes(changed)
        for reading in found:
            try:
                reading(folder)
            except ValueError as error:
                found[reading] += "is damaged" in str(error)
    assert min(found.values()) > 20


def test_foreign_folders_are_refused_and_untouched(tmp_path):
    (tmp_path / "letter.txt").write_text("mine")
    with pytest.raises(ValueError, match=r"letter\.txt"):
        place.begin(tmp_path, ABOUT, {})
    assert [one.name for one in tmp_path.iterdir()] == ["letter.txt"]
    place.begin(tmp_path / "a", ABOUT, {})
    with pytest.raises(ValueError, match="has format = 'test 1'"):
        place.begin(tmp_path / "a", {"format": "other 1"}, {})
    (tmp_path / "a" / place.ABOUT).write_text("{")
    with pytest.raises(ValueError, match="is damaged"):
        place.begin(tmp_path / "a", ABOUT, {})
    with pytest.raises(ValueError, match="cannot make the folder"):
        place.begin(tmp_path / "letter.txt" / "x", ABOUT, {})
    with pytest.raises(ValueError, match="cannot write"):
        shards.write_shard(tmp_path / "none", "s", b"")


def test_a_shard_with_other_columns_and_unknown_columns_are_refused(folder):
    with pytest.raises(ValueError, match="no column 'q'"):
        shards.read(folder, ["q"])
    with pytest.raises(ValueError, match="rows have z"):
        shards.table([{"z": 1}], FIELDS)
    shards.write_shard(folder, "t", shards.encoded(shards.table([{"case": 1}], {"case": ShardColumn("whole")})))
    with pytest.raises(ValueError, match="other columns"):
        shards.check_shards(folder)


def test_nothing_to_read(tmp_path):
    place.begin(tmp_path / "new", ABOUT, {})
    with pytest.raises(ValueError, match="no results yet"):
        shards.opened(Path(tmp_path / "new"))


def test_a_copied_shard_is_found_and_named(folder):
    content = (folder / "s1.parquet").read_bytes()
    for name in ("s1 (copy).parquet", "s2.parquet"):
        (folder / name).write_bytes(content)
        for look in (shards.opened, shards.read, shards.check_shards):
            with pytest.raises(ValueError, match=r"holds s1.*\.parquet and s.*\.parquet with the same rows: one is a copy"):
                look(folder)
        (folder / "s1 (copy).parquet").unlink(missing_ok=True)


def test_shards_of_one_size_with_other_numbers_are_no_copies(folder):
    """Their ends may agree too, where what differs are neither the smallest nor the largest numbers."""
    for name, middle in (("a", 1.25), ("b", 1.5)):
        rows = [{"case": 9, "k": [0.0, middle, 2.0]}]
        shards.write_shard(folder, name, shards.encoded(shards.table(rows, FIELDS)))
    one, other = ((folder / f"{name}.parquet").read_bytes() for name in "ab")
    assert len(one) == len(other)
    assert shards.read(folder, ["case"]).num_rows == 8


@pytest.mark.parametrize(
    ("name", "value", "told"),
    [
        ("mean", "abc", "mean = 'abc', but the column holds numbers"),
        ("case", 2**70, "holds whole numbers of 64 bits"),
        ("k", [[1.0], [2.0]], "holds lists of numbers"),
        ("k", "a" * 500, r"k = 'aaa.*\.\.\., but the column holds lists of numbers"),
        ("text", 5, "text = 5, but the column holds texts"),
        ("text", "\ud800", "holds texts"),
        ("any", object, "holds values of JSON"),
    ],
)
def test_a_value_that_its_column_cannot_hold_is_refused(name, value, told):
    with pytest.raises(ValueError, match=told):
        shards.table([{name: value}], FIELDS)


def test_text_in_a_number_column_of_a_shard_is_refused_even_where_it_reads_as_a_number(folder):
    fields = FIELDS | {"mean": ShardColumn("text")}
    shards.write_shard(folder, "t", shards.encoded(shards.table([{"case": 7, "mean": "1.5"}], fields)))
    for look in (shards.opened, shards.read, shards.check_shards):
        with pytest.raises(ValueError, match=r"t\.parquet has other columns than the previous shards"):
            look(folder)


@pytest.mark.parametrize(
    ("where", "told"),
    [
        ({"mean": "abc"}, "compare a column with values of its type"),
        ({"case": [1, "b"]}, "where: case = .* give a value, a range"),
        ({"case": (1, 2, 3)}, "where: case = .* a range as a tuple of two"),
    ],
)
def test_conditions_that_a_column_cannot_have_are_refused(folder, where, told):
    with pytest.raises(ValueError, match=told):
        shards.read(folder, None, shards.where_of(where, list(FIELDS)))


def edited(**values):
    return lambda about: about | values


EDITS = {
    "no study": lambda about: {name: value for name, value in about.items() if name != "study"},
    "no versions": lambda about: {name: value for name, value in about.items() if name != "made"},
    "text for a number": edited(cases="three"),
    "another title": edited(title=5),
    "study without axes": lambda about: about | {"study": {**about["study"], "axes": None}},
    "no table": lambda about: [about],
    "another kind": lambda about: about | {"study": {**about["study"], "kind": "x"}},
    "text for the block": lambda about: about | {"study": {**about["study"], "block": "x"}},
}


@pytest.mark.parametrize("edit", EDITS.values(), ids=list(EDITS))
def test_a_note_that_was_edited_is_refused(edit, tmp_path):
    study = {"scene": "planetary_pitting", "options": {"method": "textbook", "phases": 4}, "vary": {"gear.sun.r_bore_mm": [6.0]}}
    gf.sweep(study, tmp_path, workers=1)
    note = tmp_path / place.ABOUT
    note.write_text(json.dumps(edit(json.loads(note.read_text()))))
    for use in (gf.open_runs, lambda folder: gf.sweep(study, folder, workers=1)):
        with pytest.raises(ValueError, match=r"about\.json is damaged"):
            use(tmp_path)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes on this system")
def test_a_pipe_is_no_shard(folder):
    os.mkfifo(folder / "s9.parquet")
    assert shards.shard_names(folder) == ["s0", "s1", "s2"]
    assert shards.read(folder, ["case"]).num_rows == 6

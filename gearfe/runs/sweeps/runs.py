"""`open_runs`: results of a sweep as pandas and xarray. Only requested columns and rows are read."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.extras import needing
from ...core.record import check_keys
from ...geometry.aliases import StrPath
from ..store.folder import COUNT, read_about
from ..store.shards import ShardColumn, fields_of, frame, opened, read, row_count, shard_names
from .kinds import KINDS
from .study import count_of, inputs_of

if TYPE_CHECKING:
    import pandas
    import xarray

FORMAT = "gearfe sweep 1"
STUDY = {
    "kind": tuple(KINDS), "pair": str, "case": str, "options": dict, "axes": [dict], "sample": dict, "seed": int, "block": COUNT,
}  # fmt: skip
SHAPE = {"title": str, "cases": COUNT, "study": STUDY, "made": dict}  # types of the entries of the study's note


@dataclass(frozen=True, slots=True)
class Runs:
    """Results of a sweep in a folder.

    `about` has title, study, number of cases and versions; `fields` kind and unit by column, of kind ``list`` curves and signals.
    """

    folder: Path
    about: dict[str, Any]
    fields: dict[str, ShardColumn]

    def __post_init__(self) -> None:
        """Raise ValueError if a description is missing, or the number of cases is not that of the study."""
        check_keys("Runs: about", self.about, ("title", "cases", "study"))
        check_keys("Runs: study", self.about["study"], ("axes", "sample"))
        axes = self.about["study"]["axes"]
        if not all(axis and all(isinstance(values, (list, tuple)) for values in axis.values()) for axis in axes):
            raise ValueError(f"{self.folder}: the axes of its study are no lists of values: the folder was changed")
        count = count_of(axes, self.about["study"]["sample"])
        if count != self.about["cases"]:
            raise ValueError(f"{self.folder}: cases = {self.about['cases']}, but its study has {count}: the folder was changed")

    def __repr__(self):
        """Return one line: the study and the number of finished cases."""
        return f"<Runs of {self.about['title']!r}: {len(self)} of {self.about['cases']} cases in {self.folder}>"

    def __len__(self) -> int:
        """Return the number of cases in the folder."""
        return row_count(self.folder)

    @property
    def units(self) -> dict[str, str]:
        """Units by column."""
        return {name: field.unit for name, field in self.fields.items()}

    @property
    def inputs(self) -> list[str]:
        """Columns of the inputs that vary in this study, by dotted key."""
        study = self.about["study"]
        known = inputs_of(study["axes"], study["sample"])
        return [name for name in self.fields if name in known]

    def table(self, columns: Sequence[str] | None = None, where: Any = None) -> "pandas.DataFrame":
        """Return rows as a pandas table, indexed by case number.

        Parameters
        ----------
        columns : sequence of str, optional
            Default: all but curves and signals.
        where : dict or pyarrow expression, optional
            Which rows, by column: ``{"status": "done", "crack.cracked.level": (0.1, 0.3)}`` takes a value, a range as a tuple of
            two, or a list of values.

        Returns
        -------
        pandas.DataFrame
            ``attrs["units"]`` has the units by column.

        Raises
        ------
        ValueError
            If there is no such column, no result yet, or a file is damaged.
        RuntimeError
            If pandas is missing; the message names what to install.
        """
        if columns is None:
            columns = [name for name, field in self.fields.items() if field.kind != "list"]
        wanted = ["number", *(name for name in columns if name != "number")]
        return frame(read(self.folder, wanted, where), self.fields, "number")

    def curves(self, names: Sequence[str] | None = None, where: Any = None) -> "xarray.Dataset":
        """Return curves and signals as arrays with named axes.

        Parameters
        ----------
        names : sequence of str, optional
            Columns of kind ``list``; default: all of them.
        where
            See `table`.

        Returns
        -------
        xarray.Dataset
            Over ``number`` (of the case) and ``place``, shorter curves filled up with nan, units in ``attrs``; what varies, and
            ``status``, are coordinates. Where all cases have the same phases, ``phase`` is a coordinate of ``place``.

        Raises
        ------
        ValueError
            If a name is no curve of this study, no result is there yet, or a file is damaged.
        RuntimeError
            If xarray is missing; the message names what to install.
        """
        with needing("xarray"):
            import xarray
        known = [name for name, field in self.fields.items() if field.kind == "list"]
        names = known if names is None else list(names)
        for name in names:
            if name not in known:
                raise ValueError(f"{name!r} is no curve of this study; it has {', '.join(known)}")
        beside = ["number", *self.inputs, "status"]
        lists = dict.fromkeys([*names, *(["phase"] if "phase" in known else [])])
        rows = read(self.folder, [*beside, *lists], where).sort_by("number")
        values = {name: padded(rows[name]) for name in lists}
        coords: dict[str, Any] = {name: ("number", rows[name].to_pandas().to_numpy()) for name in beside}
        if "phase" in lists and "phase" not in names:
            phase = values["phase"]
            longest = phase[np.argmax(np.isfinite(phase).sum(axis=1))] if phase.size else np.empty(0)
            if (np.isnan(phase) | (phase == longest)).all():  # All curves have the same first phases.
                coords["phase"] = ("place", longest, {"units": "-"})
            else:
                names = ["phase", *names]
        data = {name: (("number", "place"), values[name], {"units": self.fields[name].unit}) for name in names}
        return xarray.Dataset(data, coords=coords, attrs={"title": self.about["title"]})


def padded(column: Any) -> np.ndarray:
    """Return lists of a column as an array ``(n, longest)``, padded with nan. A null becomes nan."""
    lists = [() if values is None else values for values in column.to_numpy(zero_copy_only=False)]
    return np.array(list(zip_longest(*lists, fillvalue=math.nan)), dtype=float).T.reshape(len(lists), -1)


def open_runs(folder: StrPath) -> Runs:
    """Open the folder of a sweep, finished or not.

    Raises
    ------
    ValueError
        If it is no such folder.
    RuntimeError
        If pyarrow is missing; the message names what to install.
    """
    about = read_about(folder, FORMAT, SHAPE)
    fields = fields_of(opened(folder).schema) if shard_names(folder) else {}
    return Runs(Path(folder), about, fields)

"""`Dataset`: windows and labels of a folder, as pandas and numpy, and one file for each side of the split."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...core.extras import needing
from ...core.files import written
from ...core.record import check_keys
from ...geometry.aliases import StrPath
from ..store.folder import COUNT, read_about
from ..store.shards import arrow, fields_of, frame, opened, read, row_count

if TYPE_CHECKING:
    import pandas

FORMAT = "gearfe data set 1"
WINDOWS = "windows"  # folder of the window files
# types of the entries of the data set's note
SHAPE = {"title": str, "conditions": COUNT, "plan": dict, "units": dict, "made": dict}
FAILED = "failed"  # folder of the errors of conditions that could not be simulated
MOST_MAT = 2**31 - 2**20  # largest array of a MATLAB 5 file [bytes]


@dataclass(frozen=True, slots=True)
class Dataset:
    """A data set in a folder. `about` has title, plan, number of conditions, units of the sensors and versions."""

    folder: Path
    about: dict[str, Any]

    def __post_init__(self) -> None:
        """Raise ValueError if the title is missing."""
        check_keys("Dataset: about", self.about, ("title",))

    def __repr__(self):
        """Return one line with title, number of windows and folder."""
        return f"<Dataset {self.about['title']!r}: {len(self)} windows in {self.folder}>"

    def __len__(self) -> int:
        """Return the number of windows."""
        return row_count(self.folder / WINDOWS)

    def labels(self, where: Mapping[str, Any] | None = None) -> "pandas.DataFrame":
        """Return labels and metadata, one row per window.

        Parameters
        ----------
        where : dict, optional
            Which windows, by column: ``{"side": "train", "sensor": "sun", "severity": (0.1, 0.3)}``: a value, a range as a tuple
            of two, or a list of values.

        Returns
        -------
        pandas.DataFrame
            ``attrs["units"]`` has the units by column.

        Raises
        ------
        ValueError
            If there is no such column, no window yet, or a file is damaged.
        RuntimeError
            If pandas is missing; the message names what to install.
        """
        return self._read(where, signal=False)[0]

    def windows(self, where: Mapping[str, Any] | None = None) -> tuple[NDArray[np.float32], "pandas.DataFrame"]:
        """Return signals ``(n, samples)`` and the labels of the same rows.

        Parameters
        ----------
        where : dict, optional
            See `labels`. Other rows are not read.

        Returns
        -------
        signals : ndarray of float32, shape (n, samples)
            In the unit of the column ``unit``, `rate_Hz` samples a second.
        labels : pandas.DataFrame
        """
        labels, signals = self._read(where, signal=True)
        return signals, labels

    def failed(self) -> dict[str, str]:
        """Return the errors of conditions that could not be simulated, by name."""
        return {path.stem: path.read_text(encoding="utf-8") for path in sorted((self.folder / FAILED).glob("condition-*.txt"))}

    def _read(self, where, *, signal):
        shards = opened(self.folder / WINDOWS)
        fields = fields_of(shards.schema)
        names = [name for name in fields if name != "signal"]
        rows = read(self.folder / WINDOWS, [*names, *(["signal"] if signal else [])], where)
        labels = frame(rows.select(names), fields)
        if not signal:
            return labels, None
        size = shards.schema.field("signal").type.list_size
        flat = rows.column("signal").combine_chunks().flatten().to_numpy(zero_copy_only=False)
        return labels, flat.reshape(-1, size)

    def export(self, form: str) -> list[Path]:
        """Write each non-empty side of the split as one file, with ``signals`` and each column of labels.

        Parameters
        ----------
        form : {"mat", "hdf5"}
            MATLAB 5 (texts are cell arrays), or HDF5.

        Raises
        ------
        ValueError
            If the form is another, the file cannot be written, or is larger than MATLAB 5 files are.
        RuntimeError
            If h5py is missing; the message names what to install.
        """
        if form not in WRITERS:
            raise ValueError(f"form = {form!r}, but it must be one of {', '.join(WRITERS)}")
        suffix, write = WRITERS[form]
        out = []
        for side in self.labels()["side"].unique():
            signals, labels = self.windows({"side": side})
            path = self.folder / f"{side}{suffix}"
            with written(path) as name:
                write(name, signals, labels, self.about)
            out.append(path)
        return out


def _mat(name, signals, labels, about):
    from scipy.io import savemat

    if signals.nbytes > MOST_MAT:
        raise ValueError(f"{signals.nbytes / 1e9:.3g} GB of signals, but an array of a MATLAB 5 file has at most 2: take hdf5")
    columns = {key.replace(".", "_"): _column(labels[key]) for key in labels}
    notes = {"about": json.dumps(about), "units_json": json.dumps(labels.attrs["units"])}
    savemat(name, {"signals": signals} | columns | notes, appendmat=False, oned_as="column", long_field_names=True)


def _hdf5(name, signals, labels, about):
    with needing("h5py"):
        import h5py
    with h5py.File(name, "w") as file:
        file.attrs["about"] = json.dumps(about)
        file.create_dataset("signals", data=signals, chunks=(1, signals.shape[1]), compression="gzip", shuffle=True)
        for key in labels:
            values = _column(labels[key])
            column = file.create_dataset(key, data=values, dtype=h5py.string_dtype() if values.dtype == object else None)
            column.attrs["units"] = labels.attrs["units"][key]


def _column(values):
    """Return a column of labels as an array of numbers or texts. Missing texts are empty."""
    if values.dtype.kind in "iufb":
        return values.to_numpy()
    return np.array(["" if value is None or value != value else str(value) for value in values], dtype=object)


WRITERS = {"mat": (".mat", _mat), "hdf5": (".h5", _hdf5)}


def open_dataset(folder: StrPath) -> Dataset:
    """Open a data set, finished or not.

    Raises
    ------
    ValueError
        If it is no such folder.
    RuntimeError
        If pyarrow is missing; the message names what to install.
    """
    arrow()
    about = read_about(folder, FORMAT, SHAPE)
    return Dataset(Path(folder), about)

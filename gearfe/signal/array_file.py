"""Channels of files with named arrays: numpy archives, MATLAB files of all versions, HDF5. Nothing is unpickled."""

import json
from typing import Any

import numpy as np

from ..core.extras import needing
from ..core.files import read
from ..core.matlab_file import MOST_PACKED, Unread
from ..geometry.aliases import StrPath
from .found import ANGLES, TIMES, Found, numeric, plain

PARTS = 64  # largest number of entries of a cell or struct array, or columns of a matrix, that count as channels
LONGER = 2  # least ratio of samples to channels in a matrix, so that its axes are clear
MATLAB_CLASS = "MATLAB_class"
HDF = b"\x89HDF\r\n\x1a\n"


def array_file(path: StrPath) -> Found:
    """Return the channels of a ``.npz`` or ``.mat`` file (also version 7.3).

    Vectors are channels by name; a matrix that is at least twice as long as wide holds one in each column (or row), ``name 1``,
    ``name 2``...; structs and cell arrays are opened, ``run.acc``, ``run{2}``. Scalars and texts state rate, unit and shaft
    frequency.
    """
    with open(path, "rb") as file:  # The HDF5 signature is at 0 or after the MATLAB header.
        start = file.read(512 + len(HDF))
    if HDF in (start[: len(HDF)], start[512:]):
        return hdf_file(path)
    arrays, units = _response(read(path, "signal"))
    units |= json.loads(str(np.ravel(arrays["units_json"])[0])) if "units_json" in arrays else {}
    recording = Found({}, units, nested="." if any(_opens(value) for value in arrays.values()) else "")
    for name, value in arrays.items():
        _take(recording, name, value)
    _axes(recording)
    return recording


def hdf_file(path: StrPath) -> Found:
    """Return the channels of an HDF5 file, also of MATLAB version 7.3. Attributes ``unit`` and ``rate`` are read."""
    with needing("h5py"):
        import h5py
    recording = Found({})
    try:
        with h5py.File(path, "r") as file:
            if wrong := file.visititems_links(_wrong_link):
                raise ValueError(wrong)
            if None in file.values():
                raise OSError("a part of it cannot be opened")
            matlab = any(MATLAB_CLASS in entry.attrs for entry in file.values())
            recording.nested = "." if matlab else "/"
            for key, value in file.attrs.items():
                recording.state(str(key), _text(value))
            file.visititems(lambda name, item: _hdf_item(recording, name, item, h5py.Dataset, matlab))
    except (OSError, RuntimeError, KeyError, ValueError, TypeError, MemoryError, OverflowError) as error:
        reason = str(getattr(error, "strerror", None) or error).splitlines()[0]
        raise ValueError(f"{path} is not a whole HDF5 file: {reason}") from error
    _axes(recording)
    return recording


def _wrong_link(name, link):
    """Return the reason for rejection if a name links to another file or is nested too deeply, otherwise None."""
    if hasattr(link, "filename"):
        return f"{name!r} is a link to another file, {link.filename}; copy its data into this file"
    return f"groups are nested more than {PARTS} deep" if name.count("/") > PARTS else None


def _hdf_values(item):
    """Return the values of a dataset stored in the file itself.

    ValueError if it is read from other files, or announces more values than the bytes stored can hold.
    """
    if item.external or item.is_virtual:
        kind = "in other files" if item.external else "a virtual dataset of other datasets"
        raise ValueError(f"the values of {item.name!r} are {kind}, which are not read: copy them into this file")
    stored = item.id.get_storage_size()
    if item.nbytes > MOST_PACKED * (stored + 1024):
        raise ValueError(f"{item.name!r} states {item.nbytes} bytes, but only {stored} are stored")
    return item[()]


def _hdf_item(found, name, item, dataset, matlab):
    """Add a `dataset`, or the metadata in attributes of a group."""
    if name.startswith("#"):  # contents of MATLAB cells, which are read by their own names
        return
    name = name.replace("/", ".") if matlab else name
    values = isinstance(item, dataset)
    for key, value in item.attrs.items():
        if values and plain(key) in ("unit", "units"):
            found.units[name] = str(_text(value))
        elif found.nested not in key:
            found.state(key, _text(value))
    if values and _text(item.attrs.get(MATLAB_CLASS)) == "cell":
        whole = [item.file[cell] for cell in np.ravel(_hdf_values(item))[:PARTS] if cell]
        for i, cell in enumerate(whole, 1):
            if isinstance(cell, dataset):
                _take(found, f"{name}{{{i}}}", _matlab(cell))
    elif values:
        _take(found, name, _matlab(item) if matlab else _hdf_values(item))


def _matlab(item):
    """Return a dataset as the array that MATLAB shows: axes reversed, characters as text."""
    values = np.asarray(_hdf_values(item))
    if _text(item.attrs.get(MATLAB_CLASS)) == "char":
        return np.array("".join(map(chr, np.ravel(values))))
    return np.empty(0) if "MATLAB_empty" in item.attrs else values.T


def _text(value):
    """Return an attribute as text or a number."""
    value = value.reshape(-1)[0] if isinstance(value, np.ndarray) and value.size == 1 else value
    if isinstance(value, bytes):
        return value.decode("utf-8", "replace")
    return value.item() if isinstance(value, np.generic) else value


def _opens(value):
    return isinstance(value, np.ndarray) and (value.dtype.names is not None or value.dtype == object)


def _take(found: Found, name: str, value: Any) -> None:
    """Add the contents of an array to the channels or to the metadata."""
    if isinstance(value, Unread):
        found.other.append(f"{name!r} ({value.why})")
        return
    if _opens(value):
        _open(found, name, value)
        return
    array = np.asarray(value)
    if array.size == 1 and array.dtype.kind in "USfiu":
        found.state(name, _text(array) if array.dtype.kind in "US" else float(array.reshape(-1)[0]))
    elif numeric(value) and value.size > 1:
        _columns(found, name, value)
    else:
        found.other.append(f"{name!r} ({getattr(value, 'dtype', type(value).__name__)}{list(np.shape(value))})")


def _columns(found, name, value):
    """Add a vector, or the columns of a matrix."""
    if value.size == max(value.shape):
        found.vectors[name] = value.reshape(-1)
    elif value.ndim == 2 and max(value.shape) >= LONGER * min(value.shape) and min(value.shape) <= PARTS:
        unit = found.units.get(name)
        for i, column in enumerate(value.T if value.shape[0] > value.shape[1] else value, 1):
            found.vectors[f"{name} {i}"] = column
            found.units |= {f"{name} {i}": unit} if unit else {}
    else:
        found.other.append(f"{name!r} ({value.dtype}{list(value.shape)}: which side is time?)")


def _open(found, name, value):
    """Add fields of structs and entries of cell arrays."""
    names = value.dtype.names
    if value.size > PARTS:
        found.other.append(f"{name!r} ({value.size} {'structs' if names else 'cells'}: more than {PARTS})")
        return
    for i, entry in enumerate(value.reshape(-1), 1):
        full_name = name if value.size == 1 else f"{name}({i})" if names else f"{name}{{{i}}}"
        for key, part in [(f"{full_name}.{key}", entry[key]) for key in names] if names else [(full_name, entry)]:
            _take(found, key, part)


def _axes(found):
    """Set the units s for times and rad for angles unless the file states units."""
    for kind, unit in ((TIMES, "s"), (ANGLES, "rad")):
        found.units |= {name: found.units.get(name) or unit for name in found.axes(kind)}


def _response(arrays):
    """Return columns of ``values`` by ``names`` with ``units``, as written by `gearfe.Response.save`."""
    values, *texts = (np.asarray(arrays.get(key, ())) for key in ("values", "names", "units"))
    if values.ndim != 2 or {values.shape[1]} != {text.size for text in texts}:
        return arrays, {}
    names, units = ([str(np.ravel(text)[0]).strip() for text in part.reshape(-1)] for part in texts)
    rest = {key: value for key, value in arrays.items() if key not in ("values", "names", "units")}
    return rest | dict(zip(names, values.T, strict=True)), dict(zip(names, units, strict=True))

"""Channels of files that hold arrays by name: numpy archives, MATLAB files of every version, HDF5. Nothing is unpickled."""

import os
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.extras import needing
from ..core.files import read
from ..core.matlab_file import MOST_PACKED, Unread
from .found import ANGLES, TIMES, Found, numeric, plain

PARTS = 64  # entries of a cell array or a struct array, and columns of a matrix, that are taken for channels
LONGER = 2  # least ratio of samples to channels in a matrix, so that it is plain which are which
MATLAB_CLASS = "MATLAB_class"
HDF = b"\x89HDF\r\n\x1a\n"


def array_file(path: str | os.PathLike[str]) -> Found:
    """Channels of a ``.npz`` or ``.mat`` file (of version 7.3 too).

    Vectors are channels by name; a matrix that is at least twice as long as wide holds one in each column (or row), ``name 1``,
    ``name 2``...; structs and cell arrays are opened, ``run.acc``, ``run{2}``. Scalars and texts state rate, unit and shaft
    frequency.
    """
    if is_hdf(path):
        return hdf_file(path)
    arrays = read(path, "signal")
    arrays, units = _response(arrays)
    recording = Found({}, units, nested="." if any(_opens(value) for value in arrays.values()) else "")
    for name, value in arrays.items():
        _take(recording, name, value)
    _axes(recording)
    return recording


def is_hdf(path: str | os.PathLike[str]) -> bool:
    """Whether a file has HDF5's mark at 0, or behind the header that MATLAB writes."""
    try:
        with open(path, "rb") as file:
            start = file.read(512 + len(HDF))
    except OSError:
        return False
    return HDF in (start[: len(HDF)], start[512:])


def hdf_file(path: str | os.PathLike[str]) -> Found:
    """Channels of an HDF5 file, MATLAB's version 7.3 among them; attributes ``unit`` and ``rate`` are read."""
    with needing("h5py"):
        import h5py
    recording = Found({})
    try:
        with h5py.File(path, "r") as file:
            _check_links(file, h5py)
            if None in file.values():
                raise OSError("a part of it cannot be opened")
            matlab = any(MATLAB_CLASS in entry.attrs for entry in file.values())
            recording.nested = "." if matlab else "/"
            for key, value in file.attrs.items():
                recording.state(str(key), _text(value))
            file.visititems(lambda name, item: _hdf_item(recording, name, item, h5py, matlab))
    except (OSError, RuntimeError, KeyError, ValueError, TypeError, MemoryError, OverflowError) as error:
        reason = str(getattr(error, "strerror", None) or error).splitlines()[0]
        raise ValueError(f"{path} is not a whole HDF5 file: {reason}") from error
    _axes(recording)
    return recording


def _check_links(file, h5py):
    """ValueError if a name is a link to another file."""

    def first(name, link):
        return f"{name!r} is a link to another file, {link.filename}" if isinstance(link, h5py.ExternalLink) else None

    external = file.visititems_links(first)
    if external:
        raise ValueError(f"{external}; copy what it means into this one")


def _hdf_values(item):
    """Values of a dataset that stands in the file itself.

    ValueError if it is read from other files, or announces more values than the bytes stored can hold.
    """
    if item.external or item.is_virtual:
        kind = "in other files" if item.external else "put together from datasets, maybe of other files"
        raise ValueError(f"the values of {item.name!r} stand {kind}, which are not read: copy them into this one")
    stored = item.id.get_storage_size()
    if item.nbytes > MOST_PACKED * (stored + 1024):
        raise ValueError(f"{item.name!r} says it has {item.nbytes} bytes, but {stored} are stored, which cannot become so many")
    return item[()]


def _hdf_item(found, name, item, h5py, matlab):
    """Take a dataset, or what a group states in attributes."""
    if name.startswith("#"):  # what MATLAB's cells refer to, taken by their own names
        return
    name = name.replace("/", ".") if matlab else name
    attributes = {str(key): _text(value) for key, value in item.attrs.items()}
    for key, value in attributes.items():
        if plain(key) in ("unit", "units") and isinstance(item, h5py.Dataset):
            found.units[name] = str(value)
        elif found.nested not in key:
            found.state(key, value)
    if not isinstance(item, h5py.Dataset):
        return
    if attributes.get(MATLAB_CLASS) == "cell":
        whole = [item.file[cell] for cell in np.ravel(_hdf_values(item))[:PARTS] if cell]
        for i, cell in enumerate(whole, 1):
            if isinstance(cell, h5py.Dataset):
                _take(found, f"{name}{{{i}}}", _matlab(cell))
        return
    _take(found, name, _matlab(item) if matlab else _hdf_values(item))


def _matlab(item):
    """Array of a dataset as MATLAB shows it: axes turned round, characters as text."""
    values = np.asarray(_hdf_values(item))
    if _text(item.attrs.get(MATLAB_CLASS, "")) == "char":
        return np.array("".join(map(chr, np.ravel(values))))
    return np.empty(0) if "MATLAB_empty" in item.attrs else values.T


def _text(value):
    """An attribute as text or a number."""
    if isinstance(value, bytes):
        return value.decode("utf-8", "replace")
    if isinstance(value, np.ndarray) and value.size == 1:
        return _text(value.reshape(-1)[0])
    return value.item() if isinstance(value, np.generic) and not isinstance(value, bytes) else value


def _opens(value):
    return isinstance(value, np.ndarray) and (value.dtype.names is not None or value.dtype == object)


def _take(found: Found, name: str, value: Any) -> None:
    """Add what an array holds to the channels, or to what is stated."""
    if isinstance(value, Unread):
        found.other.append(f"{name!r} ({value.why})")
    elif _opens(value):
        _open(found, name, value)
    elif np.size(value) == 1 and np.asarray(value).dtype.kind in "US":
        found.state(name, _text(np.asarray(value).reshape(-1)[0]))
    elif np.size(value) == 1 and np.asarray(value).dtype.kind in "fiu":
        found.state(name, float(np.asarray(value).reshape(-1)[0]))
    elif numeric(value) and value.size > 1:
        _columns(found, name, value)
    else:
        dtype = getattr(value, "dtype", type(value).__name__)
        found.other.append(f"{name!r} ({dtype}{list(np.shape(value))})")


def _columns(found: Found, name: str, value: NDArray[Any]) -> None:
    """A vector, or the columns of a matrix."""
    if value.size == max(value.shape):
        found.vectors[name] = value.reshape(-1)
    elif value.ndim == 2 and max(value.shape) >= LONGER * min(value.shape) and min(value.shape) <= PARTS:
        long = value if value.shape[0] > value.shape[1] else value.T
        found.vectors |= {f"{name} {i}": column for i, column in enumerate(long.T, 1)}
        if name in found.units:
            found.units |= dict.fromkeys([f"{name} {i}" for i in range(1, long.shape[1] + 1)], found.units[name])
    else:
        found.other.append(f"{name!r} ({value.dtype}{list(value.shape)}: which side is time?)")


def _open(found: Found, name: str, value: NDArray[Any]) -> None:
    """Fields of structs, entries of cell arrays."""
    names = value.dtype.names
    if value.size > PARTS:
        found.other.append(f"{name!r} ({value.size} {'structs' if names else 'cells'}: more than {PARTS})")
        return
    for i, entry in enumerate(value.reshape(-1), 1):
        full_name = name if value.size == 1 else f"{name}({i})" if names else f"{name}{{{i}}}"
        for key, part in [(f"{full_name}.{key}", entry[key]) for key in names] if names else [(full_name, entry)]:
            _take(found, key, part)


def _axes(found: Found) -> None:
    """Times are in s and angles in rad where the file states no other unit."""
    for kind, unit in ((TIMES, "s"), (ANGLES, "rad")):
        found.units |= {name: found.units.get(name) or unit for name in found.axes(kind)}


def _response(arrays):
    """Columns of ``values`` as vectors by ``names``, and their ``units``: a response as `gearfe.Response.save` writes it."""
    if not {"values", "names", "units"} <= arrays.keys() or np.ndim(arrays["values"]) != 2:
        return arrays, {}
    names, units = ([str(np.ravel(text)[0]).strip() for text in arrays[key].reshape(-1)] for key in ("names", "units"))
    if not len(names) == len(units) == arrays["values"].shape[1]:
        return arrays, {}
    columns = dict(zip(names, arrays["values"].T, strict=True))
    rest = {key: value for key, value in arrays.items() if key not in ("values", "names", "units")}
    return rest | columns, dict(zip(names, units, strict=True))

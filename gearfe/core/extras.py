"""Optional packages from the project's metadata, and messages on missing optional libraries."""

import contextlib
import functools
import importlib.metadata
import re
from collections.abc import Iterator

from .version import VERSION

MISSING = "not installed"  # shown in place of the version of a missing package
COLLECTIONS = ("all", "docs", "test")  # extras that combine several libraries


@functools.cache
def requirements() -> dict[str, tuple[str, ...]]:
    """Return the required packages by extra ("" for every installation). The result is empty if gearfe is not installed."""
    out: dict[str, list[str]] = {}
    try:
        lines = importlib.metadata.requires("gearfe") or []
    except importlib.metadata.PackageNotFoundError:
        lines = []
    for line in lines:
        extra = re.search(r"""extra *== *['"]([^'"]+)""", line)
        name = re.match(r"[\w.-]+", line)
        if name:
            out.setdefault(extra[1] if extra else "", []).append(name[0])
    return {extra: tuple(names) for extra, names in out.items()}


@functools.cache
def installed_version(package: str) -> str:
    """Return the version of a package, or "not installed". That of gearfe is also known in a checkout without installation."""
    try:
        return VERSION if package == "gearfe" else importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return MISSING


def bringing(package: str) -> tuple[str, ...]:
    """Return the extras that contain a package, except those in `COLLECTIONS`.

    Examples
    --------
    >>> bringing("scikit-fem")
    ()
    """
    return tuple(
        extra
        for extra, names in requirements().items()
        if extra and extra not in COLLECTIONS and _plain(package) in map(_plain, names)
    )


def _plain(name):
    return re.sub(r"[-_.]+", "-", name).lower()


def command(package: str) -> str:
    """Return the command that installs an optional package, alone or with the extras that contain it."""
    return ", or ".join([f"pip install {package}", *(f"pip install 'gearfe[{extra}]'" for extra in bringing(package))])


def missing(package: str, error: ImportError) -> RuntimeError:
    """Return the RuntimeError for an optional package that cannot be imported, with the command that installs it."""
    return RuntimeError(f"this needs {package} ({error}): {command(package)}")


@contextlib.contextmanager
def needing(package: str) -> Iterator[None]:
    """Context for imports of an optional package. A failed import raises RuntimeError with the command that installs it."""
    try:
        yield
    except ImportError as error:
        raise missing(package, error) from error

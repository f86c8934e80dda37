"""Gear mesh stiffness with its error: finite elements beside energy methods.

Everything public is a name of this package, loaded on first use. `__init__.pyi` states where each is defined. The packages, and
which imports which, are listed in `docs/where.md`.
"""

from typing import Any

import lazy_loader

_load, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)


def __getattr__(name: str) -> Any:
    """Load a public name; AttributeError with the nearest names if there is none of this name."""
    if name == "__version__":
        from importlib.metadata import version

        return version("gearfe")
    if name not in __all__:
        from difflib import get_close_matches

        near = get_close_matches(name, __all__, cutoff=0.5) or __all__
        raise AttributeError(f"gearfe has no {name!r}; it has {', '.join(near)}")
    from .core.threads import loading

    with loading:
        return _load(name)

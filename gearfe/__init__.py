"""Gear mesh stiffness with an error estimate, transmission error and gearbox dynamics.

Everything public is a name of this package, loaded on first use. `__init__.pyi` states the module of each name. `docs/where.md`
lists the packages and their imports.
"""

import os.path
from typing import Any

import lazy_loader

if not os.path.isfile(__file__):
    raise ImportError(
        f"gearfe reads data files beside its code, but {__file__} is in a zip archive: unpack it or use pip install"
    )
RENAMED = {  # former names and their replacements
    "told_apart": "roc_auc", "with_own_speed": "with_estimated_speed", "disc": "gear_member", "gear_pair": "gear_pair_machine",
    "face_load": "face_load_distribution", "law_within": "converged_force_law",
}  # fmt: skip
SYNONYMS = {  # abbreviations of the literature and the functions that provide them
    "tvms": ("mesh_stiffness",), "gms": ("mesh_stiffness",), "te": ("transmission_error",), "lte": ("transmission_error",),
    "ste": ("transmission_error",), "tsa": ("synchronous_average",), "psd": ("spectrum",), "fft": ("spectrum",),
    "bpfo": ("bearing_lines",), "bpfi": ("bearing_lines",), "bsf": ("bearing_lines",), "ftf": ("bearing_lines",),
    "med": ("deconvolve",), "mckd": ("deconvolve",), "fm0": ("gear_indicators",), "fm4": ("gear_indicators",),
    "na4": ("gear_indicators",), "auc": ("roc_auc",), "loadsharing": ("mesh_stiffness",), "load_sharing": ("mesh_stiffness",),
}  # fmt: skip
_load, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)


def __getattr__(name: str) -> Any:
    """Load a public name. Raises AttributeError with the nearest public names if the name does not exist."""
    if name == "__version__":
        from .core.extras import installed_version

        return installed_version("gearfe")
    if name in RENAMED:
        from .geometry.renamed import warn_renamed

        warn_renamed(f"gearfe.{name}", RENAMED[name])
        name = RENAMED[name]
    if name not in __all__:
        from difflib import get_close_matches

        near = SYNONYMS.get(name.lower(), ()) or get_close_matches(name, __all__, cutoff=0.5)
        raise AttributeError(f"gearfe has no {name!r}; {'nearest: ' if near else 'see dir(gearfe)'}{', '.join(near)}")
    from .core.threads import loading

    with loading:
        from .core.border import bordered

        globals()[name] = bordered(_load(name), name)
        return globals()[name]

"""Gear mesh stiffness with an error estimate, transmission error and gearbox dynamics.

Everything public is a name of this package, loaded on first use. `__init__.pyi` states the module of each name. `docs/where.md`
lists the packages and their imports.
"""

import os.path

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


def _by_module() -> dict[str, list[str]]:
    """Return the public names by module, from the lines ``from .module import name as name`` of `__init__.pyi`.

    `lazy_loader.attach_stub` returns the same, but imports the parser of Python for it, which takes longer than all the rest.
    """
    out: dict[str, list[str]] = {}
    with open(f"{os.path.splitext(__file__)[0]}.pyi", encoding="utf-8") as lines:
        for line in lines:
            if line.startswith("from ."):
                _, module, _, name, *_ = line.split()
                out.setdefault(module[1:], []).append(name)
    return out


_load, __dir__, __all__ = lazy_loader.attach(__name__, submod_attrs=_by_module())


def __getattr__(name: str) -> object:
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

"""Report of ``gearfe info``: versions, threads, memory, solvers, renderer, cache, and missing packages."""

import importlib.util
import os
import platform
import shutil

from ...core.extras import MISSING, command, installed_version, requirements

OPTIONAL = {  # package: (module, its use); optional ones of the project's extras
    "pandas": ("pandas", "curve.to_pandas()"),
    "xarray": ("xarray", "curve.to_xarray()"),
    "h5py": ("h5py", "signals in HDF5 and MATLAB 7.3"),
    "pyuff": ("pyuff", "signals in universal files (UFF58)"),
    "npTDMS": ("nptdms", "signals in TDMS"),
    "ezdxf": ("ezdxf", "outlines of gears as DXF"),
    "fmpy": ("fmpy", "running FMUs of gear pairs"),
    "lvm-read": ("lvm_read", "LabVIEW measurement files"),
    "pyarrow": ("pyarrow", "sweeps, and signals in Parquet"),
    "dask": ("dask", "sweeps on a cluster"),
    "distributed": ("distributed", "sweeps on a cluster"),
    "starlette": ("starlette", "gearfe app"),
    "uvicorn": ("uvicorn", "gearfe app"),
}


def citation():
    """Return the lines of the BibTeX entry of the installed version."""
    yield "@software{gearfe,"
    yield "  author = {{The gearfe developers}},"
    yield "  title = {{gearfe}: gear mesh stiffness and gear-fault dynamics},"
    yield f"  version = {{{installed_version('gearfe')}}},"
    yield "  year = {2026}"
    yield "}"


def lines():
    """Return the lines of the report."""
    from ...core.memory import free_memory
    from ...flexibility.finite_elements.solver import dissects
    from ...stiffness.disk import folder

    yield f"Python {platform.python_version()} on {platform.system()} {platform.machine()}"
    yield from (f"{name} {installed_version(name)}" for name in ("gearfe", *requirements().get("", ())))
    yield from (f"{name} {installed_version(name)}" for name in OPTIONAL if installed_version(name) != MISSING)
    yield f"threads: {os.environ.get('OMP_NUM_THREADS', 'all')} of {os.cpu_count()} cores (OMP_NUM_THREADS)"
    yield f"memory: {free_memory() / 1e9:.1f} GB free"
    ordered = "by METIS" if dissects() else "by least degree: pip install pymetis, where there is one, for an order twice as good"
    yield f"solvers: sections dense Cholesky and SuperLU (scipy); three dimensions CHOLMOD (cvxopt), ordered {ordered}"
    yield mesher()
    yield renderer()
    yield f"CalculiX for decks: {shutil.which('ccx') or 'ccx is not installed'}"
    yield cache(folder())
    yield from advice()


def mesher():
    """Return a line that states whether gmsh starts."""
    from ...geometry.mesh.mesher import gmsh_session

    try:
        with gmsh_session():
            return "mesher: gmsh starts"
    except RuntimeError as error:
        return f"mesher: {error}"


def renderer():
    """Return the name of the renderer of stress pictures."""
    from ...strength.window import renderer_name

    try:
        return f"renderer: {renderer_name()}"
    except RuntimeError as error:
        return f"renderer: none, only 'gearfe render' and the stress pictures of a report need one: {error}"


def cache(place):
    """Return a line with the cache folder of solved gears and its size."""
    if place is None:
        return "cache of solved gears: switched off (GEARFE_CACHE is empty)"
    sizes = [file.stat().st_size for file in place.glob("*.gear")] if place.is_dir() else []
    return f"cache of solved gears: {place}, {len(sizes)} files, {sum(sizes) / 1e6:.1f} MB (GEARFE_CACHE sets the place)"


def advice():
    """Yield advice on faster computation on this computer, and on missing optional packages."""
    for name, (module, good) in OPTIONAL.items():
        if importlib.util.find_spec(module) is None:
            yield f"not installed: {name}, for {good}: {command(name)}"

"""What this machine has, for ``gearfe info``: versions, threads, memory, solvers, renderer, cache; and what it lacks."""

import importlib.metadata
import importlib.util
import os
import platform
import shutil

LIBRARIES = ("gearfe", "numpy", "scipy", "scikit-fem", "gmsh", "meshio", "pyvista", "vtk", "matplotlib", "rich", "threadpoolctl")
EXTRAS = {  # package: (module, extra, what it is good for)
    "numba": ("numba", "fast", "vibration under impact laws in seconds instead of an hour"),
    "pypardiso": ("pypardiso", "solvers", "a faster solver for fe3d than SuperLU"),
    "scikit-sparse": ("sksparse", "solvers", "a faster solver for fe3d than SuperLU"),
    "plotly": ("plotly", "report", "gearfe report"),
    "jinja2": ("jinja2", "report", "gearfe report"),
    "pandas": ("pandas", "data", "curve.to_pandas()"),
    "xarray": ("xarray", "data", "curve.to_xarray()"),
    "h5py": ("h5py", "signals", "signals in HDF5 and MATLAB 7.3"),
    "pyuff": ("pyuff", "signals", "signals in universal files (UFF58)"),
    "npTDMS": ("nptdms", "signals", "signals in TDMS"),
    "pyarrow": ("pyarrow", "signals", "signals in Parquet"),
}


def lines():
    """Lines of text, one thing each."""
    from ..elements.solver import available, free_memory
    from ..stiffness.cache import folder

    yield f"Python {platform.python_version()} on {platform.system()} {platform.machine()}"
    yield from (f"{name} {version(name) or 'is not installed'}" for name in LIBRARIES)
    yield from (f"{name} {found}" for name in EXTRAS if (found := version(name)))
    yield f"threads: {os.environ.get('OMP_NUM_THREADS', 'all')} of {os.cpu_count()} cores (OMP_NUM_THREADS; more help fe3d only)"
    yield f"memory: {free_memory() / 1e9:.1f} GB free"
    yield f"solvers: sections dense Cholesky and SuperLU (scipy); three dimensions, the best first: {', '.join(available())}"
    yield mesher()
    yield renderer()
    yield f"CalculiX for decks: {shutil.which('ccx') or 'ccx is not installed'}"
    yield cache(folder())
    yield from advice()


def version(name):
    """Version of an installed package, None if it is not."""
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return None


def mesher():
    """Whether gmsh starts."""
    from geometry.mesh.mesher import gmsh_session

    try:
        with gmsh_session():
            return "mesher: gmsh starts"
    except RuntimeError as error:
        return f"mesher: {error}"


def renderer():
    """What draws stress pictures."""
    from ..stress.window import renderer_name

    try:
        return f"renderer: {renderer_name()}"
    except RuntimeError as error:
        return f"renderer: none, only 'gearfe render' and the stress pictures of a report need one: {error}"


def cache(place):
    """Where solved gears are kept, and how much they take."""
    if place is None:
        return "cache of solved gears: switched off (GEARFE_CACHE is empty)"
    sizes = [file.stat().st_size for file in place.glob("*.npz")] if place.is_dir() else []
    return f"cache of solved gears: {place}, {len(sizes)} files, {sum(sizes) / 1e6:.1f} MB (GEARFE_CACHE sets the place)"


def advice():
    """What would make it faster, or is not possible yet."""
    for name, (module, extra, good) in EXTRAS.items():
        if importlib.util.find_spec(module) is None:
            yield f"not installed: {name}: pip install 'gearfe[{extra}]' for {good}"

"""Drawing library with an offscreen window, or the command that installs what is missing."""

import contextlib
import ctypes
import os
import sys
import threading

from ..core.memory import free_memory

ADDRESSES = 0.8e9  # address space that VTK and its software renderer map for a picture of 1400 x 1050 pixels, measured [bytes]
RENDERER_HELP = (
    "rendering needs pyvista and, without a screen, EGL or OSMesa: "
    "'pip install pyvista' and, on Debian, 'apt-get install libgl1 libegl1'"
)
_turn = threading.RLock()  # lock for threads: pyvista loads in parts, and VTK windows belong to the process
OFFSCREEN = {"libEGL.so.1": "vtkEGLRenderWindow", "libOSMesa.so.8": "vtkOSOpenGLRenderWindow"}


def drawing_library():
    """Return pyvista, prepared with a window that this computer can open.

    Raises RuntimeError with the package to install if something is missing.
    """
    with _turn:
        try:
            import pyvista
        except (ImportError, OSError) as error:
            raise RuntimeError(f"{RENDERER_HELP} ({error})") from error
        choose_window()
        pyvista.Plotter  # noqa: B018 - loads all that draws, which two threads at once fail to do
        return pyvista


@contextlib.contextmanager
def plotting(**options):
    """Context of a plotter that requires no display. The plotter is closed at the end. Other threads wait until then."""
    free = free_memory()
    if free < ADDRESSES:
        raise RuntimeError(
            f"VTK needs about {ADDRESSES / 1e9:.1f} GB to draw, but {free / 1e9:.1f} GB are free: raise the limit of memory "
            "(`ulimit -v`)"
        )
    with _turn:
        library = drawing_library()
        with library.vtk_verbosity("off"):  # The messages of VTK contain terminal control characters.
            plotter = library.Plotter(off_screen=True, **options)
            try:
                yield plotter
            finally:
                plotter.close()


def aim(plotter, focus, position, half, up=None):
    """Set the camera of a plotter without perspective. `half` is the half height of the picture in the unit of the places."""
    camera = plotter.camera
    camera.focal_point, camera.position, camera.up = focus, position, camera.up if up is None else up
    camera.parallel_projection, camera.parallel_scale = True, half


def renderer_name():
    """Return the name of the window type used for pictures, without opening a window."""
    drawing_library()
    return os.environ.get("VTK_DEFAULT_OPENGL_WINDOW", "the display's" if os.environ.get("DISPLAY") else "the system's")


def choose_window():
    """Choose an offscreen window for computers without display, because VTK would otherwise end the process.

    RuntimeError if neither EGL nor OSMesa can be loaded.
    """
    if sys.platform != "linux" or os.environ.get("DISPLAY") or os.environ.get("VTK_DEFAULT_OPENGL_WINDOW"):
        return
    for library, window in OFFSCREEN.items():
        try:
            ctypes.CDLL(library)
        except OSError:
            continue
        os.environ["VTK_DEFAULT_OPENGL_WINDOW"] = window
        return
    raise RuntimeError(f"no display, and neither of {', '.join(OFFSCREEN)} can be loaded: {RENDERER_HELP}")

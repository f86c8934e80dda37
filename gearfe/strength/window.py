"""The library that draws, and its window: found without a screen, or what is missing is said with the command for it."""

import contextlib
import ctypes
import os
import sys
import threading

from ..core.memory import free_memory

ADDRESSES = 0.8e9  # bytes that VTK and its software renderer map for a picture of 1400 x 1050 pixels, measured
RENDERER_HELP = (
    "rendering needs pyvista and, without a screen, EGL or OSMesa: "
    "'pip install pyvista' and, on Debian, 'apt-get install libgl1 libegl1'"
)
_turn = threading.RLock()  # of the threads: pyvista is loaded part by part, and VTK's windows are the process's
OFFSCREEN = {"libEGL.so.1": "vtkEGLRenderWindow", "libOSMesa.so.8": "vtkOSOpenGLRenderWindow"}


def drawing_library():
    """Give pyvista, with a window it can open; RuntimeError that says what to install if it, VTK or a window is missing."""
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
    """A plotter without a screen, closed whatever happens; that of another thread waits until then."""
    free = free_memory()
    if free < ADDRESSES:
        raise RuntimeError(
            f"VTK needs about {ADDRESSES / 1e9:.1f} GB to draw, but {free / 1e9:.1f} GB are free: raise the limit of memory "
            "(`ulimit -v`)"
        )
    with _turn:
        plotter = drawing_library().Plotter(off_screen=True, **options)
        try:
            yield plotter
        finally:
            plotter.close()


def renderer_name():
    """Name of the window that pictures would be drawn in; nothing is opened."""
    drawing_library()
    return os.environ.get("VTK_DEFAULT_OPENGL_WINDOW", "the display's" if os.environ.get("DISPLAY") else "the system's")


def choose_window():
    """Without a display, pick the offscreen window this machine can open: VTK itself ends the process if there is none.

    RuntimeError if there is neither.
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

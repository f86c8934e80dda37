"""The library that draws, and its window: found without a screen, or what is missing is said with the command for it."""

import ctypes
import os
import sys

RENDERER_HELP = (
    "rendering needs pyvista and, without a screen, EGL or OSMesa: "
    "'pip install pyvista' and, on Debian, 'apt-get install libgl1 libegl1'"
)
OFFSCREEN = {"libEGL.so.1": "vtkEGLRenderWindow", "libOSMesa.so.8": "vtkOSOpenGLRenderWindow"}


def drawing_library():
    """Give pyvista, with a window it can open.

    Raises
    ------
    RuntimeError
        If pyvista, VTK or a window is missing; the message says what to install.
    """
    try:
        import pyvista
    except (ImportError, OSError) as error:
        raise RuntimeError(f"{RENDERER_HELP} ({error})") from error
    choose_window()
    return pyvista


def renderer_name():
    """Name of the window that pictures would be drawn in; nothing is opened."""
    drawing_library()
    return os.environ.get("VTK_DEFAULT_OPENGL_WINDOW", "the display's" if os.environ.get("DISPLAY") else "the system's")


def choose_window():
    """Without a display, pick the offscreen window this machine can open: VTK itself ends the process if there is none.

    Raises
    ------
    RuntimeError
        If there is neither.
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

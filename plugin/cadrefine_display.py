"""Whether pictures can be drawn here."""

import ctypes
import ctypes.util
import os

from vtkmodules.vtkRenderingCore import vtkRenderWindow

from cadrefine_session import Failure


def check_display():
    """Where VTK draws through X, a picture needs an X server, and VTK crashes without one. EGL and OSMesa need none."""
    import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  (makes the window one that draws)

    if not vtkRenderWindow().IsA("vtkXOpenGLRenderWindow"):
        return
    if not os.environ.get("DISPLAY"):
        raise Failure("a screenshot needs a display, and DISPLAY is not set; run it under xvfb-run")
    name = ctypes.util.find_library("X11")
    if name:
        x11 = ctypes.CDLL(name)
        x11.XOpenDisplay.restype = ctypes.c_void_p
        display = x11.XOpenDisplay(None)
        if not display:
            raise Failure(f"a screenshot needs a display, and {os.environ['DISPLAY']} cannot be opened")
        x11.XCloseDisplay(ctypes.c_void_p(display))

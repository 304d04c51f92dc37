"""Whether pictures can be drawn here."""

import os
import re
import socket

from vtkmodules.vtkRenderingCore import vtkRenderWindow

from cadrefine.session import Failure

FIRST_PORT = 6000  # Of X servers; display N has port 6000 + N.


def check_display():
    """Where VTK draws through X, a picture needs an X server, and VTK crashes without one. EGL and OSMesa need none."""
    import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  (makes the window one that draws)

    if not vtkRenderWindow().IsA("vtkXOpenGLRenderWindow"):
        return
    display = os.environ.get("DISPLAY")
    if not display:
        raise Failure("a screenshot needs a display, but DISPLAY is not set; put xvfb-run before the command")
    if not answers(display):
        raise Failure(f"a screenshot needs a display, but {display} cannot be opened")


def answers(display):
    """Whether an X server listens there."""
    parts = re.fullmatch(r"(?:unix/?|(.*)):(\d+)(?:\.\d+)?", display)
    if not parts:
        return False
    host, number = parts.group(1), int(parts.group(2))
    local = f"/tmp/.X11-unix/X{number}"
    places = [(socket.AF_INET, (host, FIRST_PORT + number))] if host else [
        (socket.AF_UNIX, path) for path in (local, "\0" + local)]
    for family, address in places:
        with socket.socket(family, socket.SOCK_STREAM) as connection:
            connection.settimeout(5)
            if connection.connect_ex(address) == 0:
                return True
    return False
